"""Every parser of what users write, under inputs that grow towards code not yet seen (coverage-guided fuzzing).

    python -m studies.fuzz_parsers [NAME ...] [--seconds 180]     with atheris installed: pip install atheris
    python -m studies.fuzz_parsers --mutate [NAME ...]             without: seeded mutations of good inputs

A parser may answer or refuse in one clear line.  Anything else is a finding and ends the run: another exception, an
answer that is not finite where nothing flags it, more than 10 s, more than 2 GiB.  Inputs that were kept lie in
FOLDER/NAME, if ``--corpus FOLDER`` is given, and a next run begins with them.
"""

from __future__ import annotations

import argparse
import contextlib
import math
import random
import resource
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from importlib.resources import files
from pathlib import Path
from types import FunctionType
from typing import Any

MOTOR = files("trum_sym").joinpath("data/trum60.toml").read_text("utf-8")
SHORT = MOTOR[MOTOR.index("name =") : MOTOR.index("[[published]]")]
SLOWEST = 10.0  # seconds
_FOLLOWED = (
    "trum_sym.inputs",
    "trum_sym.sweeps.notation",
    "trum_sym.optimiser.",
    "trum_sym.console.optimize",
    "tomllib",
)


def _fits(error: Exception) -> None:
    text = str(error)
    assert len(text.splitlines()) == 1, text
    assert len(text) < 2000, text


def _scratch(content: bytes, suffix: str) -> Path:
    path = Path(_FOLDER.name) / f"input{suffix}"
    path.write_bytes(content)
    return path


_FOLDER = tempfile.TemporaryDirectory(prefix="trum-fuzz-")


def motor(content: bytes) -> None:
    """A motor file."""
    from trum_sym.inputs.motor_file import load_motor

    found = load_motor(_scratch(content, ".toml"))
    assert all(math.isfinite(p.value) for _, p in found.parameters())


def data(content: bytes) -> None:
    """A data file of calibrate."""
    import numpy as np

    from trum_sym.inputs.measurements import read_measurements

    found = read_measurements(_scratch(content, ".csv"))
    assert all(np.isfinite(column).all() for column in found.columns.values())


def column(content: bytes) -> None:
    """A column of a file, as a sweep takes it; infinite values are for the domain to refuse."""
    from trum_sym.sweeps.notation import Column, parse

    assert isinstance(parse("prepressure", f"@{_scratch(content, '.csv')}", "N"), Column)


def unit(content: bytes) -> None:
    """A unit, and a number with it."""
    from trum_sym.inputs.units import parse_quantity, parse_unit

    text = content.decode("utf-8", "replace")
    for wanted in ("Hz", "rad/s", "N*m", "1"):
        try:
            parse_quantity("value", text, wanted)
        except ValueError as error:
            _fits(error)
    try:
        found = parse_unit(text)
    except ValueError as error:
        _fits(error)
    else:
        assert 0 < found.factor < math.inf
        assert parse_unit(str(found.kind)).kind == found.kind or found.angle.denominator != 1


def distribution(content: bytes) -> None:
    """A distribution of tolerance --spread."""
    import numpy as np

    from trum_sym.inputs.distributions import checked, from_text
    from trum_sym.inputs.motor import spec

    found = checked(
        "contact_radius", from_text("contact_radius", content.decode("utf-8", "replace"), "m"), spec("contact_radius")
    )
    drawn = found.quantile(np.array([0.0, 0.25, 0.5, 1.0]))
    assert ((drawn >= found.low) & (drawn <= found.high) & (np.diff(drawn, prepend=-math.inf) >= 0)).all()


def swept(content: bytes) -> None:
    """A range of a sweep; a file is not opened."""
    from trum_sym.sweeps.notation import parse

    text = content.decode("utf-8", "replace")
    if not text.lstrip().startswith("@"):
        parse("frequency_difference", text, "Hz")


def bounds(content: bytes) -> None:
    """Values and ranges of what optimize may vary, an option a line."""
    import numpy as np

    from trum_sym.console.options import FREED, chosen_box
    from trum_sym.inputs.drive import Drive
    from trum_sym.inputs.motor_file import load_motor
    from trum_sym.optimiser.search import box_of

    lines = dict.fromkeys(FREED) | dict(zip(FREED, content.decode("utf-8", "replace").split("\n"), strict=False))
    drive = {**vars(Drive()), "phase_lead": 1, **lines}
    box, pulses, _ = box_of(load_motor(), *chosen_box(drive))
    assert np.isfinite(box.low).all()
    assert (box.low < box.high).all()
    assert pulses


def expression(content: bytes) -> None:
    """An objective, a constraint and a target."""
    from trum_sym.errors import ParameterError
    from trum_sym.optimiser.expressions import parse_constraint, parse_expression
    from trum_sym.uncertainty.study import read_target

    text = content.decode("utf-8", "replace")
    for read in (lambda: parse_expression("objective", text), lambda: read_target(text)):
        try:
            read()
        except ParameterError as error:
            _fits(error)
    found = parse_constraint("constraint", text)
    assert math.isfinite(found.low) or math.isfinite(found.high)


TARGETS: dict[str, tuple[Callable[[bytes], None], list[str]]] = {
    "motor": (motor, [MOTOR, SHORT, MOTOR.replace("{ value", "{ distribution = 'normal', value", 3)]),
    "data": (
        data,
        [
            "prepressure [N],amplitude [um]\n100,8.5\n120,7.25e0\n",
            "sep=;\nload_torque [Nm];mean_speed [arcsec/s];mean_speed_uncertainty [rad s-1]\n0,1;6,5;1,25\n",
            "# synthetic\ntime [ms]\tdisplacement [µm]\n0\t1.5\n0.5\t-1\n",
        ],
    ),
    "column": (column, ['prepressure [kN],load_torque\n".16",1\n.17,2\n', "a;prepressure\n1;160 N\n2;1,5e2\n"]),
    "unit": (
        unit,
        ["3 kHz", "kg m-3", "1/(N s)", "mNm", "5.5 µm", "arcsec / s", "kilogram / meter ** 3", "g cm²", "-1e-3 rpm"],
    ),
    "distribution": (
        distribution,
        ["uniform:25 mm:27 mm", "triangular:.025:.026:.027", "normal:26 mm:1 mm:25 mm:27 mm"],
    ),
    "swept": (swept, ["160:210:51", "1 kHz:3 kHz:by=500 Hz", "1,2,3e3"]),
    "bounds": (bounds, ["160:210\n2.8 kHz:3.3 kHz", "180\n2800:3300\n0:1 rad\n18:22\n14"]),
    "expression": (
        expression,
        [
            "stall_torque - load_torque >= 0.05 N*m",
            "max(speed_volatility, sqrt(q_ratio**2)) + 0.1*abs(mean_speed)",
            "mean_speed >= 600 arcsec/s",
        ],
    ),
}


def once(name: str, content: bytes) -> None:
    """One input for a parser; raises if what comes out is neither an answer nor a refusal."""
    from trum_sym.errors import ParameterError

    begin = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", category=UserWarning, module="")
        try:
            TARGETS[name][0](content)
        except ParameterError as error:
            _fits(error)
    assert time.perf_counter() - begin < SLOWEST


def mutated(rng: random.Random, name: str) -> bytes:
    """A good input with some of it cut out, doubled, changed or taken from another."""
    pieces = [seed.encode() for seed in TARGETS[name][1]]
    content = bytearray(rng.choice(pieces))
    for _ in range(rng.randint(1, 6)):
        place = rng.randrange(len(content) + 1)
        end = min(len(content), place + rng.choice((1, 2, 5, 30)))
        match rng.randrange(5):
            case 0:
                del content[place:end]
            case 1:
                content[place:place] = content[place:end] * rng.choice((1, 2, 200))
            case 2:
                content[place:end] = bytes(rng.randrange(256) for _ in range(end - place))
            case 3:
                other = rng.choice(pieces)
                begin = rng.randrange(len(other))
                content[place:end] = other[begin : begin + rng.randint(1, 40)]
            case _:
                content[place:end] = rng.choice(
                    (
                        "=",
                        ":",
                        ";",
                        ",",
                        "\n",
                        '"',
                        "[",
                        "{",
                        "e999",
                        "-",
                        "nan",
                        "inf",
                        "٣",
                        "１",
                        "µ",
                        "^",
                        "(",
                        "/",
                        "0x1",
                    )
                ).encode()
    return bytes(content)


def _functions() -> Iterator[Any]:
    """The functions and methods of the package's modules for input, and of the TOML reader."""
    for module in [m for name, m in sys.modules.items() if name.startswith(_FOLLOWED)]:
        for value in list(vars(module).values()):
            for one in [value, *(vars(value).values() if isinstance(value, type) else ())]:
                inner = getattr(one, "fget", None) or getattr(one, "__func__", one)
                if isinstance(inner, FunctionType) and inner.__module__ == module.__name__:
                    yield inner


def guided(name: str, seconds: int, corpus: str | None) -> None:
    """Fuzz one parser in this process, which ends with it."""
    import atheris

    once(name, TARGETS[name][1][0].encode())  # imports what the parser needs
    for function in list(_functions()):
        with contextlib.suppress(Exception):  # code that cannot be patched is not followed
            atheris.instrument_func(function)
    with tempfile.TemporaryDirectory() as folder:
        seeds = Path(folder)
        for count, seed in enumerate(TARGETS[name][1]):
            (seeds / str(count)).write_bytes(seed.encode())
        kept = [] if corpus is None else [str(Path(corpus) / name)]
        for path in kept:
            Path(path).mkdir(parents=True, exist_ok=True)
        limits = [
            f"-max_total_time={seconds}",
            "-timeout=10",
            "-rss_limit_mb=2048",
            "-max_len=20000",
            "-print_final_stats=1",
            f"-artifact_prefix={folder}/",
        ]
        atheris.Setup([sys.argv[0], *limits, "-verbosity=1", *kept, folder], lambda content: once(name, content))
        atheris.Fuzz()


def main() -> int:
    """Run the parsers one after the other, each in a process of its own."""
    reader = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    reader.add_argument("names", nargs="*", choices=[*TARGETS, []], metavar="NAME")
    reader.add_argument("--seconds", type=int, default=180)
    reader.add_argument("--corpus")
    reader.add_argument("--mutate", action="store_true")
    reader.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    chosen = reader.parse_args()
    names = chosen.names or list(TARGETS)
    if chosen.child:
        guided(names[0], chosen.seconds, chosen.corpus)
        return 0
    failed = 0
    for name in names:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        if chosen.mutate:
            rng, count, end = random.Random(0), 0, time.perf_counter() + chosen.seconds
            while time.perf_counter() < end:
                once(name, mutated(rng, name))
                count += 1
            print(f"{name}: {count} inputs, no finding", flush=True)
            continue
        command = [sys.executable, "-m", "studies.fuzz_parsers", name, "--child", f"--seconds={chosen.seconds}"]
        command += [] if chosen.corpus is None else ["--corpus", chosen.corpus]
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        lines = (done.stdout + done.stderr).splitlines()
        units = next((line.split()[-1] for line in lines if "number_of_executed_units" in line), "?")
        cover = next((line for line in reversed(lines) if " cov: " in line), "").partition(" cov: ")[2].split(" ")[0]
        print(f"{name}: {units} inputs, {cpu:.0f} CPU s, coverage {cover}, exit {done.returncode}", flush=True)
        if done.returncode:
            failed += 1
            print("\n".join(lines[-40:]), flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
