"""Roots of rising functions between bounds: where they are, and how many steps they take where rounding is large."""

from __future__ import annotations

import numpy as np

from trum_sym.model.roots import rising


def looked_for(function, wanted, last=1e-15):
    """Roots between 0 and 2, and how often the function was asked."""
    asked = []

    def at(place):
        asked.append(place)
        value, slope = function(place)
        return value - wanted, slope

    zero = np.zeros_like(wanted)
    return rising(at, zero, zero + 2, zero + 1, zero + 2, last), len(asked)


def test_roots_are_found_at_bounds_and_between():
    wanted = np.array([0.0, 1e-9, 0.3, 1.0, 7.9, 8.0])
    found, _ = looked_for(lambda x: (x**3, 3 * x**2), wanted)
    np.testing.assert_allclose(found, np.cbrt(wanted), rtol=1e-14, atol=1e-9)


def test_rounding_much_larger_than_the_last_step_ends_it_and_no_root_depends_on_the_others():
    def noisy(x):
        return np.exp(x) + 1e-13 * np.sin(1e16 * x), np.exp(x)

    wanted = np.exp(np.linspace(0.1, 1.9, 50))
    found, asked = looked_for(noisy, wanted, last=1e-17)
    np.testing.assert_allclose(found, np.log(wanted), rtol=0, atol=3e-13)
    assert asked <= 20  # of 60
    alone = np.concatenate([looked_for(noisy, wanted[k : k + 1], last=1e-17)[0] for k in range(50)])
    np.testing.assert_array_equal(alone, found)
