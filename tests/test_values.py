"""Every public value is frozen, equal by what it holds, hashable, and equal to its copies and to itself unpickled."""

from __future__ import annotations

import copy
import dataclasses
import functools
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest
from refusals import refusal

import trum_sym as ts
from trum_sym.values import FrozenDict, Value, _restored

QUICK = {"prepressure": (175, 185), "frequency_difference": 3000.0}
ERRORS = {
    "ParameterError": lambda: ts.ParameterError("prepressure", -1, "more"),
    "ParameterError of a function": lambda: ts.ParameterError("prepressure", lambda: 0, "a number"),
    "MissingExtraError": lambda: ts.MissingExtraError("a picture", "matplotlib", "report"),
    "ConvergenceError": lambda: ts.ConvergenceError("did not settle"),
    "UnfinishedError": lambda: ts.UnfinishedError("the disk is full"),
}


@functools.cache
def motor():
    return ts.load_motor()


def optimum():
    return ts.optimize(motor(), ts.Drive(load_torque=0.05), objective="volatility", bounds=QUICK)


def calibration():
    data = {"prepressure": [140.0, 160.0, 180.0, 200.0], "amplitude": [6.3e-6, 5.9e-6, 5.5e-6, 5.3e-6]}
    return ts.calibrate(data, motor(), parameters=["amplitude_factor"])


def speed_table():
    drive = ts.Drive(load_torque=0.05, frequency_difference=3000.0)
    return ts.speed_table(
        motor(), drive, slowest=2.0, fastest=2.02, points=2, error=0.5, bounds=QUICK, direction="positive"
    )


def robust():
    return ts.robust(
        motor(), ts.Drive(load_torque=0.05), spreads={"friction_coefficient": 0.01}, objective="wear", bounds=QUICK
    )


VALUES = {
    "Motor": motor,
    "Motor of arrays": lambda: motor().with_values({"contact_radius": np.array([0.026, 0.0265])}),
    "Parameter": lambda: motor().radius,
    "Published": lambda: motor().published[0],
    "Drive": ts.Drive,
    "Drive of arrays": lambda: ts.Drive(prepressure=[170.0, 180.0]),
    "Schedule": lambda: ts.Schedule(kind="burst", periods=3, on_periods=2),
    "DriveOrbit": lambda: ts.drive_orbit(
        motor(),
        ts.Drive(load_torque=0.0),
        ts.Schedule(kind="burst", periods=300, on_periods=1),
        rotor_mass=0.0,
        tolerance=1e-4,
    ),
    "Distribution": lambda: ts.Distribution("normal", mean=1.0, standard_deviation=0.1),
    "OperatingPoint": lambda: ts.evaluate(motor()),
    "OperatingPoint without a speed": lambda: ts.evaluate(motor(), ts.Drive(load_torque=2.0)),
    "OperatingPoint of arrays": lambda: ts.evaluate(motor(), ts.Drive(load_torque=[0.1, 2.0])),
    "CoupledPoint": lambda: ts.evaluate(motor(), coupling="contact", compliance="flange", tolerance=1e-2),
    "CoupledPoint of arrays": lambda: ts.evaluate(
        motor(), ts.Drive(load_torque=[0.1, 2.0]), coupling="contact", compliance="flange", tolerance=1e-2
    ),
    "Optimum": optimum,
    "Calibration": calibration,
    "ParetoFront": lambda: ts.pareto(
        motor(), ts.Drive(load_torque=0.05), points=3, objective="wear", against="torque-margin", bounds=QUICK
    ),
    "RobustPoint": robust,
    "SpeedTable": speed_table,
    "Study": lambda: ts.spread(
        motor(),
        ts.Drive(load_torque=0.05),
        spreads={"friction_coefficient": None},
        samples=64,
        outputs=["mean_speed"],
    ),
}
made = functools.cache(lambda name: VALUES[name]())


def fresh(name):
    """The same again where that costs nothing, else what pickle makes of it."""
    return (
        VALUES[name]() if name.startswith(("Motor", "Drive", "Operating")) else pickle.loads(pickle.dumps(made(name)))
    )


@pytest.fixture(scope="module")
def other_process():
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        yield pool


@pytest.mark.filterwarnings("ignore::trum_sym.ValidityWarning")
@pytest.mark.parametrize("name", VALUES)
def test_a_value_is_equal_to_its_copies_and_hashes_as_they_do(name):
    value = made(name)
    copies = [copy.copy(value), copy.deepcopy(value), fresh(name)]
    copies += [pickle.loads(pickle.dumps(value, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)]
    for other in copies:
        assert other == value
        assert hash(other) == hash(value)
        assert repr(other) == repr(value)
    assert len({value, *copies}) == 1
    assert value != object()


@pytest.mark.parametrize("name", VALUES)
def test_a_value_is_frozen_all_the_way_down(name):
    def check(held):
        assert not isinstance(held, dict | list | set)
        if isinstance(held, np.ndarray):
            with pytest.raises(ValueError, match="read-only"):
                held[...] = 0
        elif dataclasses.is_dataclass(held):
            for field in dataclasses.fields(held):
                check(getattr(held, field.name))
            with pytest.raises(dataclasses.FrozenInstanceError):
                setattr(held, dataclasses.fields(held)[0].name, 0)
        elif isinstance(held, tuple):
            for inner in held:
                check(inner)
        elif isinstance(held, FrozenDict):
            for inner in held.values():
                check(inner)
            with pytest.raises(TypeError):
                held["new"] = 0

    check(made(name))
    check(pickle.loads(pickle.dumps(made(name))))


def test_another_process_takes_and_gives_values(other_process):
    point = other_process.submit(ts.evaluate, motor(), ts.Drive(load_torque=2.0)).result()
    assert point == ts.evaluate(motor(), ts.Drive(load_torque=2.0))


def test_a_cache_takes_a_motor_and_a_drive():
    cached = functools.lru_cache(ts.evaluate)
    assert cached(ts.load_motor(), ts.Drive()) is cached(ts.load_motor(), ts.Drive())


def test_what_differs_is_unequal():
    assert ts.load_motor() != ts.load_motor().with_values({"contact_radius": 0.026})
    assert ts.Drive(prepressure=[170.0, 180.0]) != ts.Drive(prepressure=[170.0, 181.0])
    assert ts.Drive(prepressure=[170.0]) != ts.Drive(prepressure=170.0)
    assert ts.Drive(switching_phase=0.0) == ts.Drive(switching_phase=-0.0)
    assert hash(ts.Drive(switching_phase=[0.0])) == hash(ts.Drive(switching_phase=[-0.0]))


def test_an_optimum_out_of_a_pickle_answers_more_questions_of_its_kind():
    ours, theirs = made("Optimum"), pickle.loads(pickle.dumps(made("Optimum")))
    from trum_sym.optimiser.chart import chart

    rows = [chart(problem.model(), 3).figures for problem in (ours.problem, theirs.problem)]
    assert all(np.array_equal(rows[0][name], rows[1][name], equal_nan=True) for name in rows[0])


@pytest.mark.parametrize("make", ERRORS.values(), ids=ERRORS)
def test_an_error_is_pickled_with_its_message(make):
    error = make()
    for other in (pickle.loads(pickle.dumps(error)), copy.copy(error), copy.deepcopy(error)):
        assert type(other) is type(error)
        assert str(other) == str(error)


def test_a_pickle_of_another_version_is_refused_by_name():
    rebuild, (kind, _, state) = ts.Drive().__reduce__()
    assert rebuild is _restored
    with refusal("pickle", "a Drive of trum-sym 0.0.9, which differs in phase_lead", "one of this version"):
        rebuild(kind, "0.0.9", {name: value for name, value in state.items() if name != "phase_lead"})


def test_every_public_class_of_results_is_a_value():
    import trum_sym

    classes = [getattr(trum_sym, name) for name in trum_sym.__all__]
    values = [kind for kind in classes if dataclasses.is_dataclass(kind)]
    assert len(values) >= 7
    assert all(issubclass(kind, Value) for kind in values)
