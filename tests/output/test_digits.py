"""A printed value and error enclose whatever the unrounded ones enclose, and no digit lies beyond the error."""

from __future__ import annotations

import doctest
from decimal import Decimal

from hypothesis import given
from hypothesis import strategies as st

from trum_sym.output import digits
from trum_sym.output.digits import with_error

SIZES = st.floats(1e-12, 1e12)


@given(st.sampled_from([1, -1]), SIZES, st.floats(1e-13, 0.9), st.floats(-1, 1))
def test_the_printed_interval_holds_the_true_value(sign, size, share, place):
    value, error = sign * size, share * size
    text, bound = with_error(value, error)
    true = Decimal(value) + Decimal(place) * Decimal(error)
    assert abs(Decimal(text) - true) <= Decimal(bound)
    assert Decimal(bound) <= 12 * Decimal(error)


@given(SIZES, st.floats(1e-10, 0.3))
def test_the_last_digit_is_that_of_the_error(value, share):
    text, bound = with_error(value, share * value)
    last, first = (Decimal(number).as_tuple().exponent for number in (text, bound))
    assert last >= min(first, 0) or last == first
    assert len(Decimal(bound).normalize().as_tuple().digits) == 1


def test_the_examples_are_true():
    assert doctest.testmod(digits).failed == 0


def test_what_is_not_known_is_not_printed():
    assert with_error(float("nan"), 1.0) == ("-", "")
    assert with_error(1.25, float("nan")) == ("1.25", "")
    assert with_error(0.25, 0.0) == ("0.25", "0")
