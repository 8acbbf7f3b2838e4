"""Proofs that what is compiled is what was derived: one for every output of every kernel, and every table of numbers.

``prove`` raises where a kernel or a table is not what its statement says, or has none; ``python -m derivations
generate`` calls it before it writes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from derivations.codegen.kernels import Kernel
from derivations.proofs import contact, coupling, cycle, friction, layer, port, stator, wave
from derivations.proofs.proof import Proof, Subject, check, reference
from derivations.proofs.tables import HEADERS, TABLES, read, wrong

__all__ = ["PROOFS", "numbers", "of_kernel", "prove", "unproved"]

PROOFS: tuple[Proof, ...] = (
    *stator.PROOFS,
    *cycle.PROOFS,
    *wave.PROOFS,
    *contact.PROOFS,
    *friction.PROOFS,
    *coupling.PROOFS,
    *layer.PROOFS,
    *port.PROOFS,
)


def of_kernel(name: str) -> tuple[Proof, ...]:
    """The proofs of a kernel's outputs."""
    return tuple(proof for proof in PROOFS if proof.kernel == name)


def numbers(files: Mapping[str, str]) -> dict[str, list[object]]:
    """All tables of numbers of the generated headers by name."""
    return {name: values for header in HEADERS for name, values in read(files[header]).items()}


def unproved(kernels: Iterable[Kernel], tables: Iterable[str]) -> list[str]:
    """Outputs and tables that no proof states, and proofs of what does not exist, in words."""
    stated = {(proof.kernel, name) for proof in PROOFS for name in proof.names}
    computed = {(kernel.name, name) for kernel in kernels for name in kernel.results}
    known = {table.name for table in TABLES}
    return [
        *(f"{kernel}.{name} has no proof" for kernel, name in sorted(computed - stated)),
        *(f"the proof of {kernel}.{name} has no such output" for kernel, name in sorted(stated - computed)),
        *(f"{name} has no proof" for name in sorted(set(tables) - known)),
        *(f"the proof of {name} has no such table" for name in sorted(known - set(tables))),
    ]


def prove(kernels: Iterable[Kernel], files: Mapping[str, str]) -> None:
    """Prove every output of every kernel, and every table of the generated headers.

    Parameters
    ----------
    kernels : iterable of Kernel
        What is compiled.
    files : mapping of str to str
        The generated files by name.

    Raises
    ------
    ArithmeticError
        If an output or a table is not what its statement says, or has none; names it.
    """
    every, tables = tuple(kernels), numbers(files)
    problems = unproved(every, tables)
    for kernel in every if not problems else ():
        subject = Subject(kernel)
        for proof in of_kernel(kernel.name):
            found = check(proof, subject, reference(proof))
            if found:
                problems.append(f"{kernel.name}: {found}")
                break
    problems += [found for table in TABLES if (found := wrong(table, tables))]
    if problems:
        raise ArithmeticError("; ".join(problems))
