"""Tables of words, against those of tabulate."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from tabulate import tabulate

from trum_sym.output.text_table import text_table

WORD = st.text("abc 1.-+µ%*", max_size=9) | st.none()
TITLE = st.lists(st.text("abc .", max_size=9).map(str.strip), min_size=1, max_size=3).map("\n".join)


@st.composite
def tables(draw):
    """Rows, headers and sides of some columns."""
    count = draw(st.integers(1, 5))
    row = st.tuples(*[WORD] * count).filter(lambda words: any(word and word.strip() for word in words))
    rows = draw(st.lists(row, min_size=1, max_size=4))
    headers = draw(st.tuples(*[TITLE] * count))
    return rows, headers, draw(st.text("lr", min_size=count, max_size=count))


@settings(derandomize=True, deadline=None, max_examples=200)
@given(tables())
def test_a_table_is_what_tabulate_makes_of_it(drawn):
    rows, headers, align = drawn
    sides = [{"l": "left", "r": "right"}[side] for side in align]
    assert text_table(rows, headers, align) == tabulate(rows, headers, disable_numparse=True, colalign=sides)
    assert text_table(rows, align=align) == tabulate(rows, disable_numparse=True, colalign=sides, tablefmt="plain")


def test_sides_that_are_not_given_are_left():
    assert text_table([("a", "b", 1)], ("x", "y", "z"), "r") == "  x  y    z\n---  ---  ---\n  a  b    1"
