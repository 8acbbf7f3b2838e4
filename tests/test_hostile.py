"""Whatever is handed to a public function in place of what it takes: an answer, or one clear line."""

from __future__ import annotations

import inspect
import warnings
from decimal import Decimal
from fractions import Fraction
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from lazily import lazily
from refusals import assert_one_clear_line

import trum_sym as ts

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")

xr = lazily("xarray")
MOTOR = ts.load_motor("trum60")
TABLE = {"prepressure": [100.0, 140.0, 180.0], "amplitude": [8.5e-6, 6.6e-6, 5.6e-6]}
BOX = {"prepressure": (170.0, 171.0), "frequency_difference": (3000.0, 3001.0)}


class Raises:
    """Answers every question with an error, even what it is called."""

    def __getattr__(self, name):
        raise RuntimeError(name)

    def __repr__(self):
        raise RuntimeError("repr")

    def __array__(self, *_args, **_kwargs):
        raise RuntimeError("array")

    def __eq__(self, other):
        raise RuntimeError("eq")

    __hash__ = None


class Endless:
    """A sequence that does not end, and a mapping of anything."""

    def __getitem__(self, key):
        return self

    def __len__(self):
        return 3

    def keys(self):
        return ["a"]


def deep(count):
    value = []
    for _ in range(count):
        value = [value]
    return value


@cache
def hostile():
    return {
        "object": object(),
        "type": int,
        "function": len,
        "module": np,
        "bytes": b"180",
        "bytearray": bytearray(b"1"),
        "complex": 1j,
        "nan": float("nan"),
        "inf": -float("inf"),
        "huge": 10**400,
        "digits": 10**5000,
        "minus": -1,
        "zero": 0,
        "half": 0.5,
        "true": True,
        "text": "nonsense\x00\n\x1b[31m",
        "long text": "9" * 5000,
        "surrogate": "\udcff",
        "empty text": "",
        "empty list": [],
        "empty tuple": (),
        "empty dict": {},
        "dict": {"prepressure": object()},
        "dict of numbers": {1: 2},
        "dict of None": {None: None},
        "set": {1.0},
        "list of None": [None, None],
        "list of lists": [[1.0], [1.0, 2.0]],
        "list of text": ["a", "b"],
        "mixed list": [1.0, "a", None],
        "deep list": deep(200),
        "generator": (x for x in ()),
        "range": range(3),
        "decimal": Decimal("NaN"),
        "fraction": Fraction(1, 3),
        "path": Path("/nowhere/x"),
        "folder": Path("/"),
        "slice": slice(None),
        "ellipsis": ...,
        "not implemented": NotImplemented,
        "exception": ValueError("x"),
        "raises": Raises(),
        "endless": Endless(),
        "object array": np.array([None, 1], object),
        "empty array": np.zeros((0, 3)),
        "text array": np.array(["a"]),
        "dates": np.array(["2021-10-01"], "datetime64[D]"),
        "structured": np.zeros(2, [("a", float)]),
        "masked": np.ma.masked_array([1.0, 2.0], [True, False]),
        "cube": np.ones((2, 3, 4)),
        "matrix": np.asarray([[1.0, 2.0]]),
        "0-d text": np.array("x"),
        "data array": xr.DataArray([[1.0]], dims=("a", "b")),
        "data array of text": xr.DataArray(["x"], dims="a"),
        "data array with a wrong unit": xr.DataArray(1.0, attrs={"units": object()}),
        "data set": xr.Dataset({"a": ("b", [1.0])}),
        "motor": MOTOR,
        "parameter": MOTOR.radius,
        "drive": ts.Drive(),
        "distribution": ts.Distribution("uniform", 1, 2),
    }


@cache
def table():
    return ts.speed_table(MOTOR, slowest=0.5, fastest=0.6, points=2, bounds={"prepressure": (160, 210)})


@cache
def fitted():
    return ts.calibrate(TABLE)


GOOD = {
    "evaluate": (ts.evaluate, {"motor": MOTOR, "drive": ts.Drive()}),
    "simulate": (ts.simulate, {"motor": MOTOR, "drive": ts.Drive(), "samples_per_period": 4}),
    "sensitivities": (ts.sensitivities, {"motor": MOTOR, "drive": ts.Drive()}),
    "characteristics": (ts.characteristics, {"motor": MOTOR, "drive": ts.Drive(), "points": 2, "tolerance": 1e-2}),
    "drive_orbit": (
        ts.drive_orbit,
        {
            "motor": MOTOR,
            "drive": ts.Drive(),
            "schedule": ts.Schedule(kind="burst", periods=200, on_periods=1),
            "rotor_mass": 0.0,
            "tolerance": 1e-2,
        },
    ),
    "Schedule": (ts.Schedule, {"kind": "burst", "periods": 3, "on_periods": 2}),
    "admittance": (ts.admittance, {"motor": MOTOR, "drive": ts.Drive(), "points": 2}),
    "sweep": (ts.sweep, {"motor": MOTOR, "outputs": ["amplitude"], "prepressure": [170.0, 180.0]}),
    "spread": (
        ts.spread,
        {"motor": MOTOR, "samples": 64, "spreads": ["friction_coefficient"], "outputs": ["stall_torque"]},
    ),
    "calibrate": (ts.calibrate, {"data": TABLE}),
    "optimize": (ts.optimize, {"motor": MOTOR, "objective": "amplitude", "bounds": BOX}),
    "pareto": (ts.pareto, {"motor": MOTOR, "objective": "wear", "bounds": BOX, "points": 3}),
    "robust": (
        ts.robust,
        {"motor": MOTOR, "objective": "wear", "bounds": BOX, "tolerances": {"friction_coefficient": 0.05}},
    ),
    "speed_table": (
        ts.speed_table,
        {"motor": MOTOR, "slowest": 0.5, "fastest": 0.6, "points": 2, "bounds": {"prepressure": (160, 210)}},
    ),
    "load_motor": (ts.load_motor, {"source": "trum60"}),
    "Drive": (ts.Drive, {}),
    "Motor.with_values": (MOTOR.with_values, {"values": {"radius": 0.03}}),
    "SpeedTable.at": (lambda speed: table().at(speed), {"speed": 0.55}),
    "SpeedTable.save": (lambda target: table().save(target), {"target": "/nowhere/x.csv"}),
    "Calibration.save": (lambda target, base: fitted().save(target, base), {"target": "/nowhere/x.toml", "base": "x"}),
}
NOT_ASKED = ("progress",)  # any truth will do
EXTRA = {
    "evaluate": ("contact", "resonance", "foundation", "amplitude", "compliance", "tangential", "coupling"),
    "sweep": ("frequency_difference", "contact_radius", "phase_lead", "contact", "amplitude", "sampling_period"),
    "calibrate": ("contact",),
}


def parameters(name):
    function, _ = GOOD[name]
    kinds = inspect.Parameter
    names = [p.name for p in inspect.signature(function).parameters.values() if p.kind is not kinds.VAR_KEYWORD]
    return [n for n in (*names, *EXTRA.get(name, ())) if n not in NOT_ASKED]


def calls():
    for name in GOOD:
        for parameter in parameters(name):
            for label, value in hostile().items():
                yield name, {parameter: value}, f"{parameter}={label}"
    for label, value in hostile().items():
        for key in ("radius", "crests", "amplitude"):
            yield "Motor.with_values", {"values": {key: value}}, f"values[{key}]={label}"
        yield "calibrate", {"data": {**TABLE, "amplitude": value}}, f"data[amplitude]={label}"
        yield "optimize", {"bounds": {"prepressure": value}}, f"bounds[prepressure]={label}"
        yield "optimize", {"bounds": {"prepressure": (160.0, value)}}, f"bounds[prepressure][1]={label}"
        yield "optimize", {"constraints": [value]}, f"constraints[0]={label}"
        yield "robust", {"tolerances": {"friction_coefficient": value}}, f"tolerances[friction]={label}"
        yield "robust", {"tolerances": None, "samples": [value]}, f"samples[0]={label}"
        yield (
            "robust",
            {"tolerances": None, "samples": [{"friction_coefficient": value}]},
            f"samples[0][friction]={label}",
        )
        yield "spread", {"spreads": {"friction_coefficient": value}}, f"parameters[friction]={label}"
        for field in ("kind", "low", "high", "mean", "standard_deviation", "mode"):
            for kind in ("uniform", "triangular", "normal", "lognormal"):
                given = {"kind": kind, "low": 0.2, "high": 0.3, "mean": 0.25, "standard_deviation": 0.01, "mode": 0.25}
                study = {"friction_coefficient": ts.Distribution(**{**given, field: value})}
                yield "spread", {"spreads": study}, f"Distribution({kind}, {field}={label})"


def answer(name, changed):
    """None if the call was answered or refused in a clear line, else what came out."""
    function, good = GOOD[name]
    try:
        function(**{**good, **changed})
    except (ts.ParameterError, ts.ConvergenceError, ts.MissingExtraError, ts.UnfinishedError) as error:
        try:
            assert_one_clear_line(str(error))
        except AssertionError:
            return f"not one clear line: {error}"
    except Exception as error:
        return f"{type(error).__name__}: {str(error)[:100]}"
    return None


def wrong(chosen):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", ts.ValidityWarning)
        found = {f"{name}({label})": answer(name, changed) for name, changed, label in chosen}
    return {call: what for call, what in found.items() if what is not None}


SLOW = ("pareto", "robust", "speed_table", "spread", "optimize", "SpeedTable.at", "SpeedTable.save")


def test_a_sample_of_hostile_calls_is_answered_or_refused():
    quick = [call for call in calls() if call[0] not in SLOW]
    rng = np.random.default_rng(0)
    assert wrong(quick[i] for i in rng.choice(len(quick), 400, replace=False)) == {}


@pytest.mark.slow
def test_all_hostile_calls_are_answered_or_refused():
    assert wrong(calls()) == {}
