"""Quantities and labelled arrays: their units convert or are refused, their labels pair or are refused, everywhere."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from lazily import lazily
from refusals import refusal

import trum_sym as ts
from trum_sym.inputs.measurements import from_columns

pytestmark = pytest.mark.filterwarnings("ignore::trum_sym.ImplausibleWarning")

pd, pint, xr = (lazily(name) for name in ("pandas", "pint", "xarray"))
MOTOR = ts.load_motor("trum60")
BOX = {"prepressure": (170.0, 171.0), "frequency_difference": (3000.0, 3001.0)}


class Astropy(np.ndarray):
    """What astropy's quantities are: an array that has a unit."""

    def __new__(cls, value, unit):
        found = np.asarray(value, float).view(cls)
        found.unit = unit
        return found

    def to_value(self, unit):
        raise AssertionError(unit)


class Unyt(Astropy):
    """unyt says ``units``."""

    def __new__(cls, value, unit):
        found = np.asarray(value, float).view(cls)
        found.units = unit
        return found


@dataclass
class Plain:
    """A magnitude and a unit, and no array."""

    magnitude: Any
    units: str

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.magnitude, dtype)


@cache
def registry():
    return pint.UnitRegistry()


def of_pint(value, unit):
    return registry().Quantity(value, unit)


def of_xarray(value, unit):
    return xr.DataArray(value, dims=["x"] * np.ndim(value), attrs={"units": unit})


KINDS = {"pint": of_pint, "astropy": Astropy, "unyt": Unyt, "plain": Plain, "xarray": of_xarray}
BOTH = pytest.mark.parametrize("kind", KINDS)


def value_of(kind, value, unit):
    return KINDS[kind](value, unit)


# --- Units -----------------------------------------------------------------------------------------------------------

FIELDS = {  # in a unit that is not SI, and what it is there
    "prepressure": (0.19, "kN", 190.0, "m"),
    "frequency_difference": (2.5, "kHz", 2500.0, "rad/s"),
    "load_torque": (200.0, "mN*m", 0.2, "s"),
    "switching_phase": (90.0, "deg", math.pi / 2, "Hz"),
}


@BOTH
@pytest.mark.parametrize("name", FIELDS)
def test_a_drive_converts_quantities_or_refuses_them(kind, name):
    value, unit, expected, wrong = FIELDS[name]
    assert getattr(ts.Drive(**{name: value_of(kind, value, unit)}), name) == pytest.approx(expected, rel=1e-15)
    many = getattr(ts.Drive(**{name: value_of(kind, [value, value / 2], unit)}), name)
    assert np.asarray(many).tolist() == pytest.approx([expected, expected / 2], rel=1e-15)
    with refusal(name, "need a quantity that converts to"):
        ts.Drive(**{name: value_of(kind, value, wrong)})


@BOTH
def test_a_motor_converts_quantities_or_refuses_them(kind):
    assert MOTOR.with_values({"contact_radius": value_of(kind, 26.0, "mm")}).contact_radius.value == 0.026
    changed = replace(MOTOR.contact_radius, value=value_of(kind, 26.0, "mm"))
    assert replace(MOTOR, contact_radius=changed).contact_radius.value == 0.026
    for wrong in (lambda q: MOTOR.with_values({"contact_radius": q}), lambda q: replace(changed, value=q)):
        with refusal("contact_radius", "converts to m"):
            found = wrong(value_of(kind, 26.0, "kg"))
            replace(MOTOR, contact_radius=found)


@BOTH
def test_functions_convert_quantities_or_refuse_them(kind):
    def q(value, unit):
        return value_of(kind, value, unit)

    plain = ts.evaluate(MOTOR, sampling_period=2e-3)
    assert ts.evaluate(MOTOR, sampling_period=q(2.0, "ms")).speed_volatility == plain.speed_volatility
    data = ts.simulate(MOTOR, cycles=q(2.0, "dimensionless"), samples_per_period=4, sampling_period=q(2, "ms"))
    assert (data.sizes["time"], data.attrs["sampling_period"]) == (160, 2e-3)
    swept = ts.sweep(MOTOR, outputs=["amplitude"], frequency_difference=q([2.5, 3.0], "kHz"))
    assert swept.frequency_difference.values.tolist() == [2500.0, 3000.0] if kind != "xarray" else True
    assert np.sort(np.ravel(swept["frequency_difference"])).tolist() == [2500.0, 3000.0]
    fitted = ts.calibrate({"prepressure": q([0.1, 0.14, 0.18], "kN"), "amplitude": q([8.5, 6.6, 5.6], "um")})
    bare = ts.calibrate({"prepressure": [100.0, 140.0, 180.0], "amplitude": [8.5e-6, 6.6e-6, 5.6e-6]})
    assert fitted["amplitude_factor"].value == pytest.approx(bare["amplitude_factor"].value, rel=1e-8)
    best = ts.optimize(MOTOR, objective="amplitude", bounds={**BOX, "prepressure": (q(0.17, "kN"), q(171.0, "N"))})
    assert best.prepressure == pytest.approx(171.0)
    for call in (
        lambda: ts.evaluate(MOTOR, sampling_period=q(2.0, "m")),
        lambda: ts.evaluate(MOTOR, tolerance=q(1e-3, "s")),
        lambda: ts.simulate(MOTOR, cycles=q(2, "s")),
        lambda: ts.sensitivities(MOTOR, tolerance=q(1e-3, "s")),
        lambda: ts.sweep(MOTOR, outputs=["amplitude"], frequency_difference=q([2.5, 3.0], "rad/s")),
        lambda: ts.sweep(MOTOR, outputs=["amplitude"], prepressure=[1, 2], sampling_period=q(1.0, "N")),
        lambda: ts.calibrate({"prepressure": q([100.0, 140.0, 180.0], "m"), "amplitude": [8.5e-6, 6.6e-6, 5.6e-6]}),
        lambda: ts.calibrate({"prepressure": [1.0, 2, 3], "mean_speed": q([1.0, 2.0, 3.0], "Hz")}),
        lambda: ts.calibrate({"prepressure": [1.0, 2, 3], "amplitude": [1e-6, 2e-6, 3e-6]}, confidence=q(0.9, "m")),
        lambda: ts.optimize(MOTOR, target_speed=q(0.5, "Hz")),
        lambda: ts.optimize(MOTOR, bounds={"frequency_difference": (q(2.8, "krad/s"), 3300.0)}),
        lambda: ts.pareto(MOTOR, target_speed=q(0.5, "Hz")),
        lambda: ts.robust(MOTOR, spreads={"contact_radius": (q(25, "kg"), 0.027)}),
        lambda: ts.robust(MOTOR, spreads={"contact_radius": q(0.1, "m")}),
        lambda: ts.robust(MOTOR, samples=[{"contact_radius": q(25, "kg")}]),
        lambda: ts.speed_table(MOTOR, slowest=q(0.5, "Hz"), fastest=1.0),
        lambda: ts.spread(MOTOR, spreads={"contact_radius": ts.Distribution("uniform", 0.025, q(27, "kg"))}),
        lambda: ts.spread(MOTOR, samples=q(64, "m")),
    ):
        with refusal("got", "need"):
            call()


def test_a_distribution_converts_quantities():
    mm = registry().Quantity(1.0, "mm")
    given = ts.Distribution("normal", 25 * mm, 27 * mm, 26 * mm, 0.5 * mm)
    outputs = {"samples": 64, "outputs": ["stall_torque"]}
    ours = ts.spread(MOTOR, spreads={"contact_radius": given}, **outputs)
    theirs = ts.spread(MOTOR, spreads={"contact_radius": "normal:26 mm:0.5 mm:25 mm:27 mm"}, **outputs)
    assert ours.propagation.values["stall_torque"].tolist() == theirs.propagation.values["stall_torque"].tolist()


def test_quantities_in_a_list_convert_one_by_one():
    q = registry().Quantity
    assert ts.Drive(frequency_difference=[q(2.5, "kHz"), q(3000, "Hz")]).frequency_difference.tolist() == [2500, 3000]
    with refusal("frequency_difference", "a unit on every number, or on none"):
        ts.Drive(frequency_difference=[q(2.5, "kHz"), 3000.0])


def test_what_is_no_unit_is_refused():
    for value in (
        pd.Timedelta("2ms"),
        np.timedelta64(2, "ms"),
        xr.DataArray(2e-3, attrs={"units": "fortnights"}),
        xr.DataArray(2e-3, attrs={"units": object()}),
        registry().Quantity(20.0, "degC"),
        registry().Quantity(2.0, "dimensionless"),
    ):
        with refusal("sampling_period"):
            ts.evaluate(MOTOR, sampling_period=value)


def test_pint_inside_an_array_that_has_labels_is_seen():
    data = xr.DataArray(registry().Quantity([2.5, 3.0], "kHz"), dims="f")
    assert np.asarray(ts.Drive(frequency_difference=data).frequency_difference).tolist() == [2500.0, 3000.0]


def test_a_coordinate_called_units_is_no_unit():
    data = xr.DataArray([180.0, 190.0], dims="x", coords={"units": ("x", ["a", "b"])})
    assert np.asarray(ts.Drive(prepressure=data).prepressure).tolist() == [180.0, 190.0]
    series = pd.Series([180.0, 190.0], index=["units", "unit"])
    assert np.asarray(ts.Drive(prepressure=series).prepressure).tolist() == [180.0, 190.0]


# --- Labels ----------------------------------------------------------------------------------------------------------


def along(name, values, index=None):
    return xr.DataArray(values, dims=name, coords=None if index is None else {name: index})


UNLIKE = {
    "dimensions": lambda: (along("F", [180.0, 190.0]), along("f", [3000.0, 3100.0])),
    "coordinates": lambda: (along("k", [180.0, 190.0], [0, 1]), along("k", [3000.0, 3100.0], [1, 2])),
    "transposed": lambda: (
        xr.DataArray(np.full((2, 2), 180.0), dims=("a", "b")),
        xr.DataArray(np.full((2, 2), 3000.0), dims=("b", "a")),
    ),
    "series reversed": lambda: (pd.Series([180.0, 190.0]), pd.Series([3000.0, 3100.0], index=[1, 0])),
    "series apart": lambda: (pd.Series([180.0, 190.0], index=[3, 4]), pd.Series([3000.0, 3100.0], index=[5, 6])),
    "series and array": lambda: (pd.Series([180.0, 190.0], index=["a", "b"]), along("f", [3000.0, 3100.0])),
    "frames": lambda: (pd.DataFrame({"a": [180.0]}), pd.DataFrame({"b": [3000.0]})),
}
ALIKE = {
    "dimensions": lambda: (along("F", [180.0, 190.0]), along("F", [3000.0, 3100.0])),
    "one index": lambda: (along("k", [180.0, 190.0], [0, 1]), along("k", [3000.0, 3100.0])),
    "series": lambda: (pd.Series([180.0, 190.0], index=[3, 4]), pd.Series([3000.0, 3100.0], index=[3, 4])),
    "series and plain": lambda: (pd.Series([180.0, 190.0], index=[3, 4]), [3000.0, 3100.0]),
    "array and number": lambda: (along("F", [180.0, 190.0]), 3000.0),
}


@pytest.mark.parametrize("case", UNLIKE)
def test_unlike_labels_are_refused_in_one_call_and_over_several(case):
    first, second = UNLIKE[case]()
    naming = ("labels", "go together by name")
    with refusal("frequency_difference", *naming):
        ts.Drive(prepressure=first, frequency_difference=second)
    with refusal("frequency_difference", *naming):
        replace(ts.Drive(prepressure=first), frequency_difference=second)
    motor = MOTOR.with_values({"fit_prepressure_max": first * 2})
    with refusal("labels"):
        motor.with_values({"resonance_frequency": second * 10})
    with refusal("labels"):
        ts.evaluate(motor, ts.Drive(frequency_difference=second))
    with refusal("sampling_period", *naming):
        ts.evaluate(MOTOR, ts.Drive(prepressure=first), sampling_period=second * 1e-6)
    with refusal("labels"):
        ts.sensitivities(motor, ts.Drive(frequency_difference=second))


@pytest.mark.parametrize("case", ALIKE)
def test_like_labels_pair_and_results_are_plain_arrays(case):
    first, second = ALIKE[case]()
    point = ts.evaluate(MOTOR, ts.Drive(prepressure=first, frequency_difference=second))
    expected = ts.evaluate(MOTOR, ts.Drive(prepressure=[180.0, 190.0], frequency_difference=np.asarray(second)))
    for name, value in point.figures.items():
        assert not isinstance(value, np.ndarray) or type(value) is np.ndarray, name
        np.testing.assert_array_equal(value, getattr(expected, name))


@pytest.mark.parametrize("case", ["series reversed", "series apart", "coordinates", "dimensions"])
def test_columns_of_data_pair_by_label_too(case):
    first, second = UNLIKE[case]()
    with refusal("labels"):
        from_columns("data", {"prepressure": first, "resonance_frequency": second}, {}, synthetic=False)


def test_a_sweep_refuses_one_dimension_with_two_indices_and_crosses_two_dimensions():
    first, second = UNLIKE["coordinates"]()
    with refusal("frequency_difference", "labels", "go together by name"):
        ts.sweep(MOTOR, outputs=["amplitude"], prepressure=first, frequency_difference=second)
    first, second = UNLIKE["dimensions"]()
    assert ts.sweep(MOTOR, outputs=["amplitude"], prepressure=first, frequency_difference=second).sizes == {
        "F": 2,
        "f": 2,
    }
