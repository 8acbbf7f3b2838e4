"""A kernel that writes over one of its arguments gives what it gives to an array of its own, as NumPy promises."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

import trum_sym as ts
from trum_sym import _kernels
from trum_sym.model import batch
from trum_sym.model.kernels import signature

ELEMENTWISE = [
    name for name in _kernels.signatures if getattr(_kernels, name).signature is None and name != "rotor_orbit"
]


def arguments(name, count):
    """Positive numbers of the size of one, another column for each argument; a kernel takes any."""
    rng = np.random.default_rng(17)
    return [rng.uniform(0.5, 1.5, count) for _ in range(getattr(_kernels, name).nin)]


def same(ours, theirs):
    return all(np.array_equal(a, b, equal_nan=True) for a, b in zip(ours, theirs, strict=True))


def called(ufunc, values, out):
    with np.errstate(all="ignore"):
        found = ufunc(*values, out=tuple(out))
    return list(found) if ufunc.nout > 1 else [found]


@pytest.mark.parametrize("name", ELEMENTWISE)
def test_every_output_may_take_the_place_of_every_argument(name):
    ufunc, count = getattr(_kernels, name), 5
    wanted = called(ufunc, arguments(name, count), [np.empty(count) for _ in range(ufunc.nout)])
    wrong = []
    for argument in range(ufunc.nin):
        for output in range(ufunc.nout):
            values = arguments(name, count)
            out = [np.empty(count) for _ in range(ufunc.nout)]
            out[output] = values[argument]
            if not same(called(ufunc, values, out), wanted):
                wrong.append((signature(name)[0][argument], signature(name)[1][output]))
    assert wrong == []


@pytest.mark.parametrize("name", ELEMENTWISE)
def test_outputs_may_overlap_arguments_out_of_step(name):
    """Shifted by one, backwards, with a stride, or all outputs on arguments at once."""
    ufunc, count = getattr(_kernels, name), 6
    places = min(ufunc.nin, ufunc.nout)
    for view in (lambda x: x[1:], lambda x: x[:-1][::-1], lambda x: x[::2]):
        values = arguments(name, count + 1)
        out = [view(values[j]) if j < places else np.empty(len(view(values[0]))) for j in range(ufunc.nout)]
        inputs = [x[: len(out[0])] for x in values]
        wanted = called(ufunc, [x.copy() for x in inputs], [np.empty(len(out[0])) for _ in out])
        assert same(called(ufunc, inputs, out), wanted)


@pytest.fixture
def of_points(trum60, monkeypatch):
    """The arguments of a kernel of the rotor as the package gives them, at three prepressures."""

    def of(kernel, compute):
        seen = {}

        def noted(name, values, *rest, **options):
            if name == kernel and not seen:
                names = signature(name)[0]
                seen.update(zip(names, map(np.copy, np.broadcast_arrays(*(values[k] for k in names))), strict=True))
            return original(name, values, *rest, **options)

        original = batch.call
        monkeypatch.setattr(batch, "call", noted)
        compute(trum60, ts.Drive(prepressure=np.array([170.0, 180.0, 190.0]), load_torque=0.05), tolerance=1e-3)
        return list(seen.values())

    return of


@pytest.mark.parametrize(
    ("name", "compute"),
    [
        ("rotor_orbit", partial(ts.evaluate, method="adaptive")),
        ("rotor_grid", partial(ts.evaluate, method="grid")),
        ("rotor_slopes", ts.sensitivities),
    ],
)
def test_an_orbit_may_take_the_place_of_what_it_is_found_from(of_points, name, compute):
    ufunc, values = getattr(_kernels, name), of_points(name, compute)
    with np.errstate(all="ignore"):
        wanted = ufunc(*values)
    assert np.isfinite(wanted[0]).all()
    for argument in range(ufunc.nin):
        given = [x.copy() for x in values]
        out = [np.empty_like(x) for x in wanted]
        out[argument % len(signature("rotor_orbit")[1])] = given[argument]
        assert same(called(ufunc, given, out), wanted), signature(name)[0][argument]
