"""Several searches side by side, whose questions are answered in batches.

Orbits cost the least when several run in the lanes of one SIMD register.  So every search has a thread; one of them
works at a time, and when all of them wait for an answer, one call answers them all.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

__all__ = ["StoppedError", "in_lockstep"]

Task = TypeVar("Task")
Question = TypeVar("Question")
Answer = TypeVar("Answer")
Found = TypeVar("Found")


class StoppedError(Exception):
    """Another search, or an answer, has failed."""


class _Rounds(Generic[Question, Answer]):
    """Collects questions until all searches wait, and lets one search work at a time."""

    def __init__(self, answer: Callable[[list[tuple[int, Question]]], Sequence[Answer]], count: int) -> None:
        self._answer, self._running = answer, count
        self._changed = threading.Condition()
        self._asked: list[tuple[int, Question]] = []
        self._answers: dict[int, Answer] = {}
        self._turn = threading.Lock()
        self.error: BaseException | None = None

    def begin(self) -> None:
        """Wait for the turn to work."""
        self._turn.acquire()

    def end(self) -> None:
        """The search is done."""
        self._turn.release()
        with self._changed:
            self._running -= 1
            self._serve()

    def ask(self, number: int, question: Question) -> Answer:
        """Have a question answered together with those of the other searches."""
        self._turn.release()
        with self._changed:
            self._asked.append((number, question))
            self._serve()
            self._changed.wait_for(lambda: number in self._answers or self.error is not None)
        self._turn.acquire()
        if self.error is not None:
            raise StoppedError
        return self._answers.pop(number)

    def _serve(self) -> None:
        if not self._asked or len(self._asked) < self._running:
            return
        asked, self._asked = sorted(self._asked, key=lambda entry: entry[0]), []
        try:
            answers = self._answer(asked) if self.error is None else []
            self._answers |= {number: answer for (number, _), answer in zip(asked, answers, strict=True)}
        except BaseException as error:
            self.error = self.error or error
        self._changed.notify_all()


def in_lockstep(
    search: Callable[[Task, Callable[[Question], Answer]], Found],
    tasks: Sequence[Task],
    answer: Callable[[list[tuple[int, Question]]], Sequence[Answer]],
) -> list[Found]:
    """Run a search for every task.

    Parameters
    ----------
    search : callable
        Given a task and whom to ask, who raises StoppedError where another search or an answer has failed.
    tasks : sequence
        What each search is given.
    answer : callable
        Given the questions of a round, each with its task's number, in their order; its answers are in the same order.

    Returns
    -------
    list
        What the searches found, in the order of the tasks.  The first error of a search or an answer is raised.
    """
    table = _Rounds(answer, len(tasks))
    found: dict[int, Found] = {}

    def work(number: int) -> None:
        table.begin()
        try:
            found[number] = search(tasks[number], lambda question: table.ask(number, question))
        except BaseException as error:
            table.error = table.error or error
        finally:
            table.end()

    threads = [threading.Thread(target=work, args=(k,), daemon=True) for k in range(len(tasks))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if table.error is not None:
        raise table.error
    return [found[k] for k in range(len(tasks))]
