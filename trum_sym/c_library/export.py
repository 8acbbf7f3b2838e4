"""``trum-sym c-library``: a folder that builds the C library for one motor."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from trum_sym.c_library.numbers import CHOICES, chosen, motor_header
from trum_sym.c_library.sources import (
    amalgamated,
    configured,
    derivations_hash,
    example,
    library,
)
from trum_sym.errors import ParameterError
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.model.levels import LevelChoice
from trum_sym.output.files import found, write_bytes

__all__ = ["BITS", "check_folder", "exported", "write_folder"]

BITS = {"double": 64, "float": 32}
"""Types of number by their names, and their bits."""

_NAMES = ("TRUM_MY_MOTOR_H", "MY_MOTOR_NAME", "my_motor", "my_drive")


def exported(
    motor: Motor, drive: Drive, levels: LevelChoice, *, real: str = "double", fixed: bool = False, single: bool = False
) -> dict[str, str]:
    """The files of the folder by name.

    Parameters
    ----------
    motor, drive
        Of one point, which the example computes: no arrays.
    levels : LevelChoice
        Words of the model's levels; the first of each where one is not given.
    real : str
        ``"double"`` or ``"float"``.
    fixed : bool
        Compile the levels, start and load in: the rest of the code is left out, and other words are refused.
    single : bool
        One pair ``trum.h``, ``trum.c`` in place of the folder ``trum``.

    Raises
    ------
    ParameterError
        For another type of number, or arrays.
    """
    if real not in BITS:
        raise ParameterError("real", real, " or ".join(BITS))
    values = {**drive.numbers(), **{key: parameter.value for key, parameter in motor.parameters()}}
    for key, value in values.items():
        if np.ndim(value):
            raise ParameterError(key, "an array", "one number: the folder is for one point")
    settings = {"TRUM_REAL_BITS": str(BITS[real])}
    if fixed:
        given = chosen(drive, levels)
        for name, words in CHOICES.items():
            place = next(k for k, word in enumerate(words) if given[name] == f"TRUM_{name}_{word}".upper())
            settings[f"TRUM_FIXED_{name}".upper()] = str(place)
    texts = configured(library(), settings)
    del texts["trum60.h"]
    files = amalgamated(texts) if single else {f"trum/{name}": text for name, text in texts.items()}
    sources = sorted(name for name in files if name.endswith(".c"))
    folder = "." if single else "trum"
    numbers = [f"/* Written by trum-sym; {'levels are compiled in' if fixed else 'levels are free'}. */"]
    files["motor.h"] = "\n".join([*numbers, *motor_header(motor, drive, levels, _NAMES), ""])
    files["example.c"] = _example()
    files["Makefile"] = _MAKEFILE.format(folder=folder, sources=" ".join(sources))
    files["CMakeLists.txt"] = _CMAKE.format(folder=folder, sources="\n  ".join(sources))
    files["README.md"] = _README.format(
        motor=" ".join(motor.name.split()),
        real=real,
        hash=derivations_hash(),
        where="`trum.h`" if single else "`trum/trum_math.h`",
        levels=", ".join(f"{name} {given_word(name, settings)}" for name in CHOICES) if fixed else "free",
        pair=_ONE if single else _MANY,
    )
    return files


def given_word(name: str, settings: Mapping[str, str]) -> str:
    """The word of a choice that is compiled in."""
    return CHOICES[name][int(settings[f"TRUM_FIXED_{name}".upper()])]


def _example() -> str:
    """The example on the folder's own motor."""
    text = example().replace("#define TRUM_IMPLEMENTATION\n", "")
    for old, new in zip(("trum60.h", "TRUM60_NAME", "trum60", "trum_table3"), ("motor.h", *_NAMES[1:]), strict=True):
        if old not in text:
            raise ValueError(f"the example does not use {old}")
        text = text.replace(old, new)
    return text.replace("the paper's Table 3, or what", "that of motor.h, or what").replace("./trum ", "./example ")


def check_folder(name: str, folder: Path, force: bool) -> None:
    """Refuse, before any work is done, a folder that cannot be made, or that has something in it.

    Raises
    ------
    ParameterError
        For a file, a folder that is not empty and no ``--force``, or a place that cannot be written to.
    """
    there = found(name, folder)
    if there is not None and not folder.is_dir():
        raise ParameterError(name, str(folder), "a folder; this is a file")
    if there is not None and any(folder.iterdir()) and not force:
        raise ParameterError(
            name, str(folder), "a new or empty folder, or --force to write into it: this one has files"
        )
    parent = folder if there is not None else Path(os.path.realpath(folder)).parent
    if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
        raise ParameterError(name, str(folder), "a folder in one that exists and can be written to")


def write_folder(name: str, files: Mapping[str, str], folder: Path) -> None:
    """Write the files; a folder that was not there appears with all of them or not at all.

    Raises
    ------
    ParameterError
        If they cannot be written.
    """
    try:
        if folder.is_dir():  # which may be where somebody stands
            _fill(name, files, folder)
            return
        real = Path(os.path.realpath(folder))
        beside = Path(tempfile.mkdtemp(prefix=f".{real.name[:40]}-", suffix=".partial", dir=real.parent))
        try:
            _fill(name, files, beside)
            mask = os.umask(0)
            os.umask(mask)
            beside.chmod(0o777 & ~mask)
            beside.rename(real)
        finally:
            shutil.rmtree(beside, ignore_errors=True)
    except OSError as error:
        raise ParameterError(name, str(folder), f"a folder that can be written ({error.strerror or error})") from None


def _fill(name: str, files: Mapping[str, str], folder: Path) -> None:
    for file, text in files.items():
        place = folder / file
        place.parent.mkdir(exist_ok=True, parents=True)
        write_bytes(name, text.encode(), place)


_MAKEFILE = """\
# Written by trum-sym.  `make` builds the library and the example; for another machine, for example
#   make CC=arm-none-eabi-gcc CFLAGS="-O2 -mcpu=cortex-m4 -mfpu=fpv4-sp-d16 -mfloat-abi=hard" libtrum.a
CFLAGS ?= -O2
WARNINGS = -std=c99 -Wall -Wextra -Wconversion -Wdouble-promotion -pedantic -Werror
SECTIONS = -ffunction-sections -fdata-sections
ifeq ($(origin AR),default)
AR := $(patsubst %gcc,%,$(filter %-gcc,$(CC)))ar
endif
SOURCES = {sources}
OBJECTS = $(SOURCES:.c=.o)
HEADERS = $(wildcard *.h trum/*.h trum/orbit/*.h)
BUILD = $(CC) $(CPPFLAGS) $(WARNINGS) $(SECTIONS) $(CFLAGS) -I{folder} -I.

all: example

example: example.c libtrum.a $(HEADERS)
\t$(BUILD) $(LDFLAGS) example.c libtrum.a $(LDLIBS) -lm -o $@

libtrum.a: $(OBJECTS)
\t$(AR) rcs $@ $(OBJECTS)

%.o: %.c $(HEADERS)
\t$(BUILD) -c $< -o $@

clean:
\trm -f example libtrum.a $(OBJECTS)

.PHONY: all clean
"""

_CMAKE = """\
# Written by trum-sym.
cmake_minimum_required(VERSION 3.13)
project(trum C)
set(CMAKE_C_STANDARD 99)
add_library(trum STATIC
  {sources})
target_include_directories(trum PUBLIC {folder})
find_library(MATHEMATICS m)
if(MATHEMATICS)
  target_link_libraries(trum PUBLIC ${{MATHEMATICS}})
endif()
add_executable(example example.c)
target_include_directories(example PRIVATE .)
target_link_libraries(example PRIVATE trum)
"""

_ONE = "`trum.h` and `trum.c` are all of it."
_MANY = "`trum/trum.h` is the header, `trum/trum.c` the driver, every other `.c` one kernel."
_README = """\
# {motor} in C

Written by `trum-sym c-library`.  Numbers are {real}; levels: {levels}.  {pair}
`make && ./example` prints the operating point of `motor.h`; `./example prepressure=170` changes it.

C99 or C++, no allocation, no globals, no recursion; nothing but the C library's mathematics.

| you want | call | compile |
|---|---|---|
| one formula | a kernel: `trum_wave(arg, res, 0, 0, 0)`; its source begins with arguments and units | that source |
| the determinants | `trum_evaluate_determinants` | everything; the linker leaves out what is not called |
| an operating point | `trum_evaluate`, `trum_simulate` | everything |
| a drive for a speed | `trum-sym speed-table --out table.h` | that header, which needs nothing else |

With `-ffunction-sections -Wl,--gc-sections` (the Makefile has the first) only what is called is linked.  What that
takes of flash, RAM, stack and time, what the results mean and how exact they are: `docs/c-library.md` of the project.

`drive.max_steps` bounds the time of a call; `point.steps` is what it took.  The type of the numbers is written into
{where}: another `TRUM_REAL_BITS` on a command line is refused.

SHA-256 of the derivations: {hash}
"""
