"""Searches side by side: their questions come in rounds, and errors come out."""

from __future__ import annotations

import pytest

from trum_sym.optimiser.lockstep import in_lockstep


def halved(start, ask):
    """Ask for half of it until nothing is left; how often that took."""
    count = 0
    while start:
        start, count = ask(start), count + 1
    return count


def test_a_round_has_a_question_of_every_search_that_goes_on():
    rounds = []

    def answer(asked):
        rounds.append(asked)
        return [question // 2 for _, question in asked]

    assert in_lockstep(halved, [5, 1, 0, 2], answer) == [3, 1, 0, 2]
    assert rounds == [[(0, 5), (1, 1), (3, 2)], [(0, 2), (3, 1)], [(0, 1)]]


@pytest.mark.parametrize("fails", [0, 1, 2])
def test_an_error_of_an_answer_is_raised_and_ends_all_searches(fails):
    count = iter(range(9))

    def answer(asked):
        if next(count) == fails:
            raise ZeroDivisionError
        return [question // 2 for _, question in asked]

    with pytest.raises(ZeroDivisionError):
        in_lockstep(halved, [5, 7, 6], answer)


def test_an_error_of_a_search_is_raised_and_ends_the_others():
    def search(start, ask):
        if ask(start) == 1:
            raise KeyError(start)
        return halved(start, ask)

    with pytest.raises(KeyError, match="3"):
        in_lockstep(search, [9, 3, 8], lambda asked: [question // 2 for _, question in asked])
