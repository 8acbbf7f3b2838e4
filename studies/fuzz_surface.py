"""Every public function and every option of the console, called with hostile and nearly right values.

python -m studies.fuzz_surface [COUNT] [--seed N]

Hypothesis makes the calls.  Each has to end within 10 s: with a result whose figures are numbers wherever no flag says
otherwise, or with one of the package's own errors on one line.  Anything else is printed once for each place it comes
from, with how often and an example; the exit code is then 1.  Ctrl-C ends it after the call under way, and shows
what was found; how far it is stands on the standard error.
"""

from __future__ import annotations

import argparse
import contextlib
import decimal
import fractions
import io
import math
import os
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import numpy as np
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

import trum_sym as ts
from trum_sym import console

LONGEST = 10.0  # s
_TELL = 1000  # calls
OURS = (ts.ParameterError, ts.ConvergenceError, ts.UnfinishedError, ts.MissingExtraError)
MOTOR = ts.load_motor()
PARAMETERS = tuple(name for name, _ in MOTOR.parameters())
FIELDS = tuple(ts.Drive().numbers())

TEXTS = (
    "", " ", "nan", "inf", "-inf", "1e400", "1e-320", "1_90", "１８０", "180 N", "0.18 kN", "3 kHz", "26 mm", "10 %",
    "0x10", "--", "-", "1:2:3", "160:200:3", "1:2:by=0", "2:1:by=1", "@", "@/dev/zero", "@nofile.csv", "=", "a=b",
    "prepressure=170:190", "friction_coefficient=0.2", "friction_coefficient=normal:0.2:0.01", "contact_radius=26 mm",
    "x" * 1000, "\x1b[2J", "\n", "\0", "ß", "\ud800", "1/0", "mean_speed", "mean_speed >= 1", "q_average + 1",
    "__import__('os')", "(" * 200, "9" * 5000, "%s{0}$x", "~", "/", ".", "a.nc", "a.csv", "a.zarr", "a.png", "a.toml",
    "/dev/full", "/dev/zero", "x" * 300 + ".nc", "uniform:0:1", "triangular:0:1", "periodic", "winkler", "6", "erratum",
)  # fmt: skip
OBJECTS: tuple[Any, ...] = (
    None, True, b"180", 1j, math.nan, math.inf, -1, 0, 10**400, [], {}, set(), (), [1.0, math.nan], [[1.0], [1.0, 2.0]],
    len, object(), np.zeros((0, 3)), np.array([1.0, None]), np.array(["1"]), np.float32(180), np.ma.masked, np.int64(3),
    np.array(180.0), fractions.Fraction(180), decimal.Decimal(180), range(3), "180 N", "x", MOTOR, ts.Drive(),
)  # fmt: skip
texts = st.sampled_from(TEXTS) | st.text(max_size=12) | st.floats().map(str)
near = st.floats(0.0, 400.0) | st.integers(-3, 40) | st.sampled_from([180.0, 3000.0, 20, 14, 0.05, -1, 1, 1e-6, 0.0265])
arrays = st.lists(near, min_size=1, max_size=3).map(np.array)
values = near | arrays | st.sampled_from(OBJECTS) | texts
WORDS = {
    "start": ("periodic", "steady", "rest"),
    "contact": ("winkler", "hertz"),
    "resonance": ("quartic", "eq6", "printed", "euler"),
    "foundation": ("harmonic", "smeared", "printed", "none"),
    "amplitude": ("measured", "forced"),
    "compliance": ("layer", "flange"),
    "tangential": ("rigid", "brush"),
    "coupling": ("none", "contact"),
}


def some(names: tuple[str, ...], given_values: st.SearchStrategy[Any], most: int) -> st.SearchStrategy[dict[str, Any]]:
    return st.dictionaries(st.sampled_from(names), given_values, max_size=most)


levels = st.fixed_dictionaries(
    {}, optional={name: st.sampled_from(words) | texts for name, words in WORDS.items() if name != "start"}
)


def drive(fields: dict[str, Any]) -> ts.Drive:
    return ts.Drive(**{"load_torque": 0.05, **fields})


def evaluate(motor: dict[str, Any], fields: dict[str, Any], options: dict[str, Any]) -> Any:
    point = ts.evaluate(MOTOR.with_values(motor), drive(fields), **{"tolerance": 1e-2, **options})
    good = np.asarray(point.converged)
    figures = [np.broadcast_to(getattr(point, name), good.shape) for name in ("mean_speed", "min_speed", "max_speed")]
    coupled = isinstance(point, ts.CoupledPoint)  # of which no amplitude is prescribed
    known = ("resonance_frequency", "cycle_time", *(() if coupled else ("amplitude", "q_average")))
    always = [np.asarray(getattr(point, name)) for name in known]
    if not all(np.isfinite(figure[good]).all() for figure in figures) or not all(np.isfinite(x).all() for x in always):
        raise FloatingPointError(f"a figure is no number, and nothing says so: {point}")
    return point


def simulate(fields: dict[str, Any], options: dict[str, Any]) -> Any:
    return ts.simulate(MOTOR, drive(fields), **{"samples_per_period": 8, **options})


def sweep(ranges: dict[str, Any], options: dict[str, Any]) -> Any:
    return ts.sweep(MOTOR, **{"outputs": ["amplitude"], **options, **ranges})


def load(text: str) -> Any:
    Path("motor.toml").write_bytes(text.encode("utf-8", "surrogatepass"))
    return ts.load_motor("motor.toml")


def calibrate(columns: dict[str, Any]) -> Any:
    return ts.calibrate(columns, MOTOR)


def optimise(function: Callable[..., Any]) -> Callable[[dict[str, Any]], Any]:
    small = {"objective": "q_volatility", "bounds": {"prepressure": (179.0, 181.0), "frequency_difference": 3000.0}}
    return lambda options: function(MOTOR, ts.Drive(load_torque=0.05), **{**small, **options})


def tolerance(options: dict[str, Any]) -> Any:
    small = {"spreads": ["friction_coefficient"], "samples": 64, "tolerance": 1e-2}
    return ts.spread(MOTOR, ts.Drive(load_torque=0.05), **{**small, **options})


def optimise_speeds(options: dict[str, Any]) -> Any:
    small = {"slowest": 2.0, "fastest": 2.02, "points": 2, "error": 0.5, "direction": "positive"}
    box = {"prepressure": (175.0, 185.0), "frequency_difference": 3000.0}
    return ts.speed_table(MOTOR, ts.Drive(load_torque=0.05), bounds=box, **{**small, **options})


TOML = MOTOR.text
edits = st.tuples(st.integers(0, len(TOML)), st.integers(0, 40), texts)
broken = st.lists(edits, min_size=1, max_size=3).map(
    lambda found: "".join(_edited(TOML, at, gone, new) for at, gone, new in found[:1])
)
columns = some(("prepressure", "amplitude", "resonance_frequency", "time", "displacement", "x"), values, 3)
evaluations = some(("tolerance", "sampling_period"), values, 1) | levels


def _edited(text: str, at: int, gone: int, new: str) -> str:
    return text[:at] + new + text[at + gone :]


def called(name: str, function: Callable[..., Any], *arguments: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.tuples(st.just(name), st.just(function), st.tuples(*arguments))


COMMANDS = {name: command for name, command in console._cli.commands.items() if not isinstance(command, click.Group)}
COMMANDS |= {
    f"{group} {name}": command
    for group, commands in console._cli.commands.items()
    if isinstance(commands, click.Group)
    for name, command in commands.commands.items()
}
BOX = ["--frequency-difference", "3000", "--prepressure", "179:181", "--load-torque", "0.05"]
SMALL = {
    "spread": ["--load-torque", "0.05", "--spread", "friction_coefficient", "--samples", "64", "--tolerance", "1e-2"],
    "optimize": ["--objective", "q_volatility", *BOX],
    "pareto": ["--points", "3", *BOX],
    "robust": BOX,
    "speed-table": ["--points", "2", "--error", "0.5", *BOX],
    "sweep": ["--outputs", "amplitude"],
    "characteristics": ["--points", "2"],
}
SLOW = (
    "characteristics", "admittance", "drive", "spread",
    "optimize", "pareto", "robust", "speed-table", "calibrate", "report",
)  # fmt: skip


def console_calls(name: str) -> st.SearchStrategy[Any]:
    """Up to three options of a command, with texts for their values."""
    options = [p for p in COMMANDS[name].params if isinstance(p, click.Option) and "--scheduler" not in p.opts]
    arguments = [p for p in COMMANDS[name].params if isinstance(p, click.Argument)]
    option = st.sampled_from(options or [None]).flatmap(
        lambda p: (
            st.just([p.opts[0]])
            if p.is_flag
            else (st.sampled_from(p.type.choices) | texts if isinstance(p.type, click.Choice) else texts).map(
                lambda text: [p.opts[0], text]
            )
        )
    )
    found = st.lists(option, max_size=3 if options else 0).map(lambda parts: [word for part in parts for word in part])
    rest = st.tuples(*(texts for _ in arguments)).map(list)
    return called(
        f"trum-sym {name}",
        lambda given_options, given_rest: run_console(
            [*name.split(), *SMALL.get(name, []), *given_options, *given_rest]
        ),
        found,
        rest,
    )


def run_console(arguments: list[str]) -> int:
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = console.main(arguments)
    lines = [line for line in err.getvalue().splitlines() if not line.startswith("trum-sym: warning:")]
    lines = [line for line in lines if " points (" not in line]
    traced = "Traceback (most" in err.getvalue()
    if code not in (0, 1, 2) or traced or len(lines) > 1 or (code == 2 and len(lines) != 1):
        raise AssertionError(f"exit code {code}, {lines}")
    return code


POINT = [
    called("Drive", lambda fields: ts.Drive(**fields), some((*FIELDS, "start"), values, 4)),
    called("with_values", MOTOR.with_values, some((*PARAMETERS, "x"), values, 3)),
    called("evaluate", evaluate, some(PARAMETERS, near | texts, 2), some((*FIELDS, "start"), values, 2), evaluations),
    called(
        "sensitivities", lambda given: ts.sensitivities(MOTOR, drive(given), tolerance=1e-2), some(FIELDS, values, 2)
    ),
    called("simulate", simulate, some(FIELDS, values, 2), some(("cycles", "samples_per_period"), values, 1)),
    called("load_motor", load, broken),
    called("load_motor of anything", ts.load_motor, values),
    called("save_motor", ts.save_motor, st.just(MOTOR) | values, values),
    called("Distribution", ts.Distribution, texts, values, values),
    called("evaluate anything", ts.evaluate, values, values),
    *(console_calls(name) for name in COMMANDS if name not in SLOW),
    console_calls("evaluate"),
]
OTHERS = [
    called("sweep", sweep, some(("prepressure", "periods", "x"), values, 2), some(("chunk",), values, 1)),
    called("calibrate", calibrate, columns),
    called("optimize", optimise(ts.optimize), some(("objective", "bounds", "constraints", "target_speed"), values, 2)),
    called("pareto", optimise(ts.pareto), some(("against", "bounds"), values, 2)),
    called("pareto's points", optimise(ts.pareto), some(("points",), st.integers(-1, 4) | st.sampled_from(OBJECTS), 1)),
    called("robust", optimise(ts.robust), some(("spreads", "samples", "bounds"), values, 2)),
    called("spread", tolerance, some(("spreads", "samples", "seed"), values, 2)),
    called("speed_table", optimise_speeds,
           some(("slowest", "fastest", "points", "error", "direction"), st.sampled_from(OBJECTS) | texts, 3)),
    *(console_calls(name) for name in SLOW),
]  # fmt: skip
calls = st.integers(0, 49).flatmap(lambda k: st.one_of(OTHERS) if k == 0 else st.one_of(POINT))


class HangError(Exception):
    """A call took too long."""


def ring(*_: object) -> None:
    raise HangError


class Found:
    """What was found, by place."""

    def __init__(self) -> None:
        self.count: Counter[str] = Counter()
        self.places: Counter[str] = Counter()
        self.examples: dict[str, str] = {}
        self.refused = 0
        self.interrupted = False
        self.begin = time.monotonic()

    def call(self, name: str, function: Callable[..., Any], arguments: tuple[Any, ...]) -> None:
        if self.interrupted:  # and not within a call, as commands take it for themselves
            raise KeyboardInterrupt
        self.count[name] += 1
        done = self.count.total()
        if done % _TELL == 0:
            print(f"{done} calls, {time.monotonic() - self.begin:.0f} s, {len(self.places)} places", file=sys.stderr)
        signal.setitimer(signal.ITIMER_REAL, LONGEST)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                function(*arguments)
        except OURS as error:
            self.refused += 1
            if len(str(error).splitlines()) != 1:
                self.note(name, error, arguments)
        except BaseException as error:
            self.note(name, error, arguments)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)

    def note(self, name: str, error: BaseException, arguments: tuple[Any, ...]) -> None:
        frames = [f for f in traceback.extract_tb(error.__traceback__) if f"{os.sep}trum_sym{os.sep}" in f.filename]
        where = f"{Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else "outside"
        key = f"{type(error).__name__} in {name} at {where}"
        self.places[key] += 1
        with contextlib.suppress(Exception):
            self.examples.setdefault(key, f"{str(error)[:160]!r} from {repr(arguments)[:200]}")


def run(count: int, number: int) -> int:
    """Make that many calls; print what they found."""
    import trum_sym.report.output

    trum_sym.report.output.page = lambda *_, **__: "a page"  # which takes a minute to draw
    found, before = Found(), Path.cwd()
    signal.signal(signal.SIGALRM, ring)
    signal.signal(signal.SIGINT, lambda *_: setattr(found, "interrupted", True))

    fresh = {"database": None, "deadline": None, "phases": [Phase.generate], "suppress_health_check": list(HealthCheck)}

    @seed(number)
    @settings(max_examples=count, **fresh)
    @given(calls)
    def fuzz(call: tuple[str, Callable[..., Any], tuple[Any, ...]]) -> None:
        found.call(*call)

    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            fuzz()
        except KeyboardInterrupt:
            print("interrupted; up to here:")
        finally:
            os.chdir(before)
    done, took = found.count.total(), time.monotonic() - found.begin
    print(f"{done} calls of {len(found.count)} surfaces in {took:.0f} s, {found.refused} refused in Python")
    print(", ".join(f"{name} {times}" for name, times in sorted(found.count.items())))
    for key, times in found.places.most_common():
        print(f"{times} times: {key}: {found.examples.get(key, '')}")
    print(f"{sum(found.places.values())} calls at {len(found.places)} places were not as they should be")
    return int(bool(found.places))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int, nargs="?", default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    given_arguments = parser.parse_args()
    sys.exit(run(given_arguments.count, given_arguments.seed))
