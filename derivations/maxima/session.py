"""A Maxima process that answers one statement at a time, with a deadline for each."""

from __future__ import annotations

import os
import re
import selectors
import shutil
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

__all__ = ["JUDGES", "NO_VALUE", "SCRIPTS", "Finding", "MaximaError", "Session", "available", "preamble"]

JUDGES = Path(__file__).parent / "judges"
SCRIPTS = (
    "kernel.mac",
    "point.mac",
    "section_2.mac",
    "section_3.mac",
    "section_4.mac",
    "section_6.mac",
    "appendices.mac",
)
"""The judges, each after those whose functions it uses."""
NO_VALUE = "no value"
"""The method of a finding on forms that cannot be evaluated."""
_END = "@@end"
_FINDING = re.compile(r"^@@(yes|no)\|([^|]*)\|(.*)$", re.MULTILINE)
_QUESTION = re.compile(r"^Is .*\?\s*\Z", re.MULTILINE | re.DOTALL)


class MaximaError(RuntimeError):
    """Maxima is missing, or its judges cannot be loaded; says which, in one line."""


@dataclass(frozen=True)
class Finding:
    """Whether what was asked holds, by which means, and what it was."""

    ok: bool
    method: str
    detail: str


def available() -> bool:
    """Whether a Maxima can be started."""
    return shutil.which("maxima") is not None


class Session:
    """One process with the judges loaded; started when first asked, and anew after a statement that found no end.

    Parameters
    ----------
    preamble : str
        Statements before the judges: data that they use.
    seconds : float
        Deadline of a statement.
    """

    def __init__(self, preamble: str, seconds: float = 30.0) -> None:
        self._preamble = preamble
        self._seconds = seconds
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Session:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None

    def ask(self, judge: str, forms: str, *, hasty: bool = False) -> list[Finding] | str:
        """The findings of a judge on forms (text of a list of pairs), or in words why there is none.

        ``hasty`` ends with the first finding against the forms.
        """
        answer = self._said(f"opinion({judge}, {forms}, {str(hasty).lower()})$")
        if isinstance(answer, str) and answer.startswith("no answer"):
            return answer
        found = [Finding(ok == "yes", method, detail) for ok, method, detail in _FINDING.findall(answer)]
        return found or f"no finding: {' '.join(answer.split())[:200]}"

    def _start(self) -> subprocess.Popen[bytes]:
        program = shutil.which("maxima")
        if program is None:
            raise MaximaError("Maxima is not installed: `apt-get install maxima maxima-share`, or put it on the PATH")
        process = subprocess.Popen(
            [program, "--very-quiet"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        self._process = process
        loads = "".join(f'batchload("{JUDGES / name}")$\n' for name in SCRIPTS)
        answer = self._said(self._preamble + "\n" + loads, seconds=120)
        if "error" in answer.lower() or answer.startswith("no answer"):
            self.close()
            raise MaximaError(
                f"Maxima cannot load its judges (is maxima-share installed?): {' '.join(answer.split())[:300]}"
            )
        return process

    def _said(self, statements: str, seconds: float | None = None) -> str:
        """What is printed for statements; "no answer ..." if they ask back or take too long, the process ended then."""
        process = self._process or self._start()
        assert process.stdin is not None
        assert process.stdout is not None
        limit = self._seconds if seconds is None else seconds
        process.stdin.write(f'{statements}\nprintf(true, "~%{_END}~%")$\n'.encode())
        process.stdin.flush()
        deadline, said = time.monotonic() + limit, ""
        with selectors.DefaultSelector() as waiting:
            waiting.register(process.stdout, selectors.EVENT_READ)
            while f"\n{_END}" not in said:
                left = deadline - time.monotonic()
                asked = _QUESTION.search(said)
                if left <= 0 or asked:
                    self.close()
                    why = "Maxima asks " + " ".join(asked[0].split()) if asked else f"none within {limit:g} s"
                    return f"no answer: {why}"
                if waiting.select(left):
                    piece = os.read(process.stdout.fileno(), 65536).decode(errors="replace")
                    if not piece:
                        self.close()
                        return "no answer: Maxima ended"
                    said += piece
        return said


def preamble(positive: Sequence[str], signed: Sequence[str], values: Mapping[str, str]) -> str:
    """The data of the judges: symbols that are positive, those of either sign, and the motor's values."""
    listed = ", ".join(f"{name} = {value}" for name, value in values.items())
    assumed = "".join(f"assume({name} > 0)$\n" for name in positive)
    return f"{assumed}signed: [{', '.join(signed)}]$\nmotor: [{listed}]$"
