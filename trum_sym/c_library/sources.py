"""The C sources that ship with the package, and one pair of files made of them."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

__all__ = ["ONE_HEADER", "ONE_SOURCE", "amalgamated", "configured", "derivations_hash", "example", "library", "unit"]

ONE_HEADER, ONE_SOURCE = "trum.h", "trum.c"

_PACKAGE = Path(__file__).parents[1]
_INSTALLED = _PACKAGE / "data" / "c"
_TREE = _PACKAGE.parent
_OTHERS = {
    "trum_coupled_lanes.h",
    "trum_lanes.h",
    "trum_elementary.h",
    "trum_browser.c",
    "trum_unit.h",
    "trum_fmi2.c",
    "trum_fmi3.c",
}
_INCLUDE = re.compile(r'^#include "([^"]+)".*\n', re.M)
_CALL = re.compile(r"^static (?:inline )?void (trum_(?:call|plain)_\w+)\(.*?^}\n\n", re.M | re.S)
# What an exported copy is compiled for stands in the header that every other includes first
_CONFIGURED = "trum_math.h"


def _folders() -> tuple[Path, Path]:
    """Of the generated files and of the driver: in an installed package the same."""
    if _INSTALLED.is_dir():
        return _INSTALLED, _INSTALLED
    return _TREE / "generated", _PACKAGE / "_driver"


def library() -> dict[str, str]:
    """Every header and source of the library by its name, those of the search for the orbit as ``orbit/...``.

    ``trum.c`` is what compiles the driver; ``trum60.h`` has the numbers of the motor that ships.

    Raises
    ------
    FileNotFoundError
        If the package was installed without them.
    """
    generated, driver = _folders()
    paths = [*generated.glob("trum*.[ch]"), *driver.glob("trum*.h"), *driver.glob("orbit/*.h")]
    found = {path.relative_to(generated if path.parent == generated else driver).as_posix(): path for path in paths}
    found = {name: path for name, path in sorted(found.items()) if name not in _OTHERS}
    if _CONFIGURED not in found or "trum_wave.c" not in found:
        raise FileNotFoundError(f"no C sources in {generated} and {driver}")
    texts = {name: path.read_text("utf-8") for name, path in found.items()}
    return {**texts, ONE_SOURCE: f'#define TRUM_IMPLEMENTATION\n#include "{ONE_HEADER}"\n'}


def example() -> str:
    """The example's source, on the numbers of ``trum60.h``."""
    place = _INSTALLED / "main.c" if _INSTALLED.is_dir() else _TREE / "examples" / "c" / "main.c"
    return place.read_text("utf-8")


def unit(fmi: int) -> dict[str, str]:
    """The sources of the co-simulation unit around ``trum.c`` under FMI 2 or 3; the last one is compiled."""
    return {name: (_folders()[1] / name).read_text("utf-8") for name in ("trum_unit.h", f"trum_fmi{fmi}.c")}


def derivations_hash() -> str:
    """SHA-256 of the expressions that the kernels were written from."""
    text = library()["trum_kernels.h"]
    return json.loads(text.partition("#define TRUM_DERIVATIONS ")[2].partition("\n")[0])  # type: ignore[no-any-return]


def configured(texts: dict[str, str], settings: dict[str, str]) -> dict[str, str]:
    """The library with settings written in: a compiler that is told another is refused, file by file."""
    about = [
        f"/* trum-sym {version('trum-sym')}; the kernels' expressions have the SHA-256 that is TRUM_DERIVATIONS. */",
        "#ifndef TRUM_VERSION",
        f'#define TRUM_VERSION "{version("trum-sym")}"',
        "#endif",
    ]
    for name, value in settings.items():
        about += [f"#ifndef {name}", f"#define {name} {value}", f"#elif {name} != {value}"]
        about += [f'#error "trum: this copy of the library was made for {name} {value}"', "#endif"]
    text = texts[_CONFIGURED]
    guard = "#define TRUM_MATH_H\n"
    return {**texts, _CONFIGURED: text.replace(guard, guard + "\n" + "\n".join(about) + "\n", 1)}


def amalgamated(texts: dict[str, str]) -> dict[str, str]:
    """The library as one header and one source; what is included stands where it is included, once.

    Parameters
    ----------
    texts : dict of str to str
        As :func:`library` gives them.
    """
    header, body, kernels = _joined(texts)
    _, plain, _ = _joined({name: text for name, text in texts.items() if not name.startswith("trum_coupled")})
    return {ONE_HEADER: header, ONE_SOURCE: f'#include "{ONE_HEADER}"\n{_called(body, plain)}\n{kernels}'}


def _joined(texts: Mapping[str, str]) -> tuple[str, str, str]:
    """What users include, the point with what it includes, and the kernels; files that are not there are left out."""
    seen: set[str] = set()

    def inlined(name: str) -> str:
        if name in seen or name not in texts:
            return ""
        seen.add(name)
        return _INCLUDE.sub(lambda found: inlined(found[1]), texts[name])

    public, begin, _ = texts[ONE_HEADER].partition("#ifdef TRUM_IMPLEMENTATION")
    if not begin:
        raise ValueError(f"{ONE_HEADER} does not include its implementation")
    seen.add(ONE_HEADER)
    header = _INCLUDE.sub(lambda found: inlined(found[1]), public) + "#endif\n"
    body = inlined("trum_point.h")
    return (
        header,
        body,
        "\n".join(inlined(name) for name in sorted(texts) if name.endswith(".c") and name != ONE_SOURCE),
    )


def _called(text: str, plain: str) -> str:
    """A source without the calls of kernels that nothing in it makes, of which compilers warn outside headers.

    Those that the coupled system makes alone, which ``plain`` is without, are there where it is.
    """

    def kept(found: re.Match[str]) -> str:
        if plain.count(f"{found[1]}(") > 1:
            return found[0]
        return f"#ifdef TRUM_COUPLED\n{found[0]}#endif\n" if text.count(f"{found[1]}(") > 1 else ""

    return _CALL.sub(kept, text)
