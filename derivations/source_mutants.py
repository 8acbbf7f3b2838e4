"""``python -m derivations.source_mutants``: one slip in the Python of a formula module, and who refuses it.

Slips of someone who types: an operator, a sign, a number, a comparison, a name for another, sine for cosine, arguments
exchanged.  Each is made in memory, in a fork of a process that has everything loaded: the changed module and what
imports it are run again, then come, from cheap to dear, the proofs of ``generate``, the ledger's entries that depend on
the module, and the fast tests.  Files stay as they are.

A slip that none of them refuses is shown to change nothing: every kernel, table and derived form of the ledger comes
out as the very same expression.  What is left survives, and the exit code is 1.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import importlib.util
import inspect
import io
import json
import os
import random
import signal
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import redirect_stderr, redirect_stdout
from copy import deepcopy
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import ModuleType

import sympy as sp

from derivations.codegen import emit
from derivations.codegen import kernels as kernel_module
from derivations.dimensions import DimensionError
from derivations.ledger import ENTRIES
from derivations.ledger.model import Entry, confirm
from derivations.proofs import PROOFS, numbers, of_kernel, unproved
from derivations.proofs.proof import Subject, check, reference
from derivations.proofs.tables import TABLES, wrong

__all__ = ["FORMULA_MODULES", "Edit", "edits", "main"]

FOLDER = Path(__file__).parent
FORMULA_MODULES = (
    "amplitude",
    "beam",
    "collocation",
    "contact",
    "determinant",
    "ellipse",
    "line_contact",
    "phases",
    "rotor",
    "section",
    "square_roots",
    "supplement",
    "surface",
    "transfer",
    "codegen.kernels",
)
_TESTS = ("tests/derivations/test_ledger_transfer.py", "tests/derivations/test_ledger_supplement.py")
_LIMIT = 120  # seconds of processor time that one mutant may take; what takes longer is left undecided
_FREE = {
    ("rotor", "_guess"): "another fit of the first guess; the kernel keeps the accuracy that its proof states",
}
"""Functions whose numbers may be others as long as the proofs hold, and why."""
_SWAPPED = {"sin": "cos", "cos": "sin", "Min": "Max", "Max": "Min", "acos": "asin", "asin": "acos"}
_OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Pow: ast.Mult,
}
_COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.Gt,
    ast.Gt: ast.Lt,
    ast.LtE: ast.GtE,
    ast.GtE: ast.LtE,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
}


@dataclass(frozen=True)
class Edit:
    """One slip: the module, the function and line, what stood there and stands now, a function for the whole source."""

    module: str
    function: str
    line: int
    old: str
    new: str
    source: Callable[[], str]


# --- making them ------------------------------------------------------------------------------------------------
def _skipped(tree: ast.Module) -> set[ast.AST]:
    """Nodes that are no formula: docstrings, annotations, decorators, ``__all__``, messages of errors."""
    found: set[ast.AST] = set()
    for node in ast.walk(tree):
        parts: list[ast.AST | None] = []
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            parts += node.decorator_list
        if isinstance(node, ast.FunctionDef):
            parts.append(node.returns)
        if isinstance(node, ast.AnnAssign):
            parts.append(node.annotation)
        if isinstance(node, ast.arg):
            parts.append(node.annotation)
        if isinstance(node, (ast.Raise, ast.Import, ast.ImportFrom)):
            parts.append(node)
        if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == "__all__" for t in node.targets):
            parts.append(node)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            parts.append(node)
        for part in parts:
            if part is not None:
                found |= set(ast.walk(part))
    return found


def _symbols(tree: ast.Module) -> set[str]:
    """Names that a module gives to symbols."""
    found: set[str] = set()
    for node in tree.body:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call | ast.Subscript):
            call = node.value.value if isinstance(node.value, ast.Subscript) else node.value
            maker = ast.unparse(call.func) if isinstance(call, ast.Call) else ""
            if maker in ("sym", "sp.symbols", "sp.Symbol", "symbols"):
                found |= {n.id for target in node.targets for n in ast.walk(target) if isinstance(n, ast.Name)}
    return found


def _names(tree: ast.Module) -> dict[ast.AST, list[str]]:
    """For each name that is read within a function, names for which it may be taken.

    A symbol for the symbols that its function reads or, if there are none, the module's; what is assigned in a function
    for what is assigned above it.
    """
    found: dict[ast.AST, list[str]] = {}
    symbols = _symbols(tree)
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef):
            continue
        nodes = [node for node in ast.walk(function) if isinstance(node, ast.Name)]
        assigned = {node.id: node.lineno for node in reversed(nodes) if isinstance(node.ctx, ast.Store)}
        read = [node for node in nodes if isinstance(node.ctx, ast.Load)]
        for node in read:
            if node.id in symbols:
                near = sorted({other.id for other in read} & symbols - {node.id})
                found[node] = near or sorted(symbols - {node.id})
            elif node.id in assigned:
                found[node] = sorted(n for n, line in assigned.items() if n != node.id and line < node.lineno)
    return found


def _changes(node: ast.AST, others: list[str]) -> Iterator[Callable[[ast.AST], ast.AST]]:
    """Functions that change a copy of a node."""

    def with_(**fields: object) -> Callable[[ast.AST], ast.AST]:
        def change(copy: ast.AST) -> ast.AST:
            for name, value in fields.items():
                setattr(copy, name, value)
            return copy

        return change

    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        yield with_(op=_OPERATORS[type(node.op)]())
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield lambda copy: copy.operand  # type: ignore[attr-defined]
    elif isinstance(node, ast.Constant) and isinstance(node.value, int | float) and not isinstance(node.value, bool):
        yield with_(value=node.value + 1)
        yield with_(value=node.value - 1)
    elif isinstance(node, ast.Compare) and type(node.ops[0]) in _COMPARISONS:
        yield with_(ops=[_COMPARISONS[type(node.ops[0])](), *node.ops[1:]])
    elif isinstance(node, ast.Attribute) and node.attr in _SWAPPED:
        yield with_(attr=_SWAPPED[node.attr])
    elif isinstance(node, ast.Call) and len(node.args) == 2 and ast.dump(node.args[0]) != ast.dump(node.args[1]):
        yield with_(args=node.args[::-1])
    elif isinstance(node, ast.Name):
        for other in others[:: max(1, len(others) // 2)][:2]:
            yield with_(id=other)


def _put(module: str, place: int, change: Callable[[ast.AST], ast.AST]) -> str:
    """A module's source with the node at a place of its walk changed."""
    tree = ast.parse(_source(module))
    target = list(ast.walk(tree))[place]
    new = ast.fix_missing_locations(change(deepcopy(target)))

    class Put(ast.NodeTransformer):
        def visit(self, node: ast.AST) -> ast.AST:
            return new if node is target else self.generic_visit(node)

    return ast.unparse(Put().visit(tree))


def edits(module: str) -> Iterator[Edit]:
    """Every slip in a module."""
    tree = ast.parse(_source(module))
    names, skipped = _names(tree), _skipped(tree)
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    owners = {node: function.name for function in functions for node in ast.walk(function)}
    for place, node in enumerate(ast.walk(tree)):
        for change in _changes(node, names.get(node, [])) if node not in skipped else ():
            old, new = ast.unparse(node), ast.unparse(change(deepcopy(node)))
            where = owners.get(node, ""), getattr(node, "lineno", 0)
            yield Edit(module, *where, old, new, partial(_put, module, place, change))


# --- who refuses them -------------------------------------------------------------------------------------------
_KEPT = ("derivations.proofs", "derivations.source_mutants", "derivations.__main__", "derivations.ledger.command")


def _imports(module: ModuleType) -> set[str]:
    """The project's modules that one imports, at its head or within functions."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(Path(str(module.__file__)).read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("derivations"):
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found & set(sys.modules)


def _importers() -> dict[str, set[str]]:
    """For each loaded module, those that import it and can be run again."""
    found: dict[str, set[str]] = {}
    for other, module in list(sys.modules.items()):
        if other.startswith("derivations.") and not other.startswith(_KEPT):
            for imported in _imports(module):
                found.setdefault(imported, set()).add(other)
    return found


def _dependents(name: str, importers: Mapping[str, set[str]]) -> set[str]:
    """What imports a module, by whatever way."""
    found: set[str] = set()
    front = {name}
    while front:
        front = set().union(*(importers.get(n, set()) for n in front)) - found
        found |= front
    return found - {name, "derivations.ledger"}


def _headers() -> Mapping[str, list[object]]:
    """The tables of numbers, of the emitter as it is loaded now."""
    now = sys.modules[emit.__name__]
    makers = {
        "collocation": now._collocation,
        "quadrature": now._quadrature,
        "elementary": now._elementary,
        "runge_kutta": now._runge_kutta,
    }
    return numbers({**{f"trum_{name}.h": make() for name, make in makers.items()}, "trum_kernels.h": now._header()})


def _forms(entry: Entry) -> dict[str, str]:
    """An entry's derived forms, for comparison."""
    return {name: sp.srepr(form) for name, form in entry.derive().forms.items()}


class Loaded:
    """What is computed once, before any fork: kernels, tables, what the proofs want, how long each entry takes."""

    def __init__(self, *, timed: bool) -> None:
        self.hashes = {kernel.name: emit._source_hash(kernel) for kernel in kernel_module.kernels()}
        self.tables = _headers()
        self.wanted = {proof: reference(proof) for proof in PROOFS}
        importers = _importers()
        self.importers = {name: _dependents(f"derivations.{name}", importers) for name in FORMULA_MODULES}
        self.given = {name: _given(name) for name in FORMULA_MODULES}
        self.owners = {e.id: e.judge.__module__ for e in ENTRIES}
        self.seconds = dict.fromkeys(self.owners, 0.0)
        self.forms: dict[str, dict[str, str]] = {}
        for entry in ENTRIES if timed else ():
            start = time.process_time()
            confirm(entry)
            self.seconds[entry.id] = time.process_time() - start
            self.forms[entry.id] = _forms(entry)

    def entries(self, module: str) -> list[str]:
        """The entries of modules that depend on one, the cheapest first."""
        found = [name for name, owner in self.owners.items() if owner in self.importers[module]]
        return sorted(found, key=lambda name: self.seconds[name])


def _run_again(edit: Edit, others: set[str]) -> None:
    """Run a module's changed source in its place, and everything that imports it."""
    name = f"derivations.{edit.module}"
    for other in others | {name}:
        sys.modules.pop(other, None)
    package = sys.modules[name.rpartition(".")[0]]
    spec = importlib.util.spec_from_loader(name, loader=None)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    module.__file__ = f"<{name} with a slip>"
    sys.modules[name] = module
    setattr(package, name.rpartition(".")[2], module)
    exec(compile(edit.source(), module.__file__, "exec"), module.__dict__)
    for other in sorted(others):
        importlib.import_module(other)


def _by_generate(loaded: Loaded) -> str:
    """What ``generate`` refuses, '' if nothing: dimensions and proofs of what is not as it was."""
    now = sys.modules[kernel_module.__name__].kernels()
    missing = unproved(now, loaded.tables)
    if missing:
        return f"proof: {missing[0]}"
    for kernel in now:
        if emit._source_hash(kernel) == loaded.hashes[kernel.name] and kernel.results == _results[kernel.name]:
            continue
        emit.check_dimensions(kernel)
        subject = Subject(kernel)
        for proof in of_kernel(kernel.name):
            found = check(proof, subject, loaded.wanted[proof])
            if found:
                return f"proof: {kernel.name}: {found}"
    tables = _headers()
    if tables != loaded.tables:
        for table in TABLES:
            found = wrong(table, tables)
            if found:
                return f"proof: {found}"
    return ""


_results = {kernel.name: kernel.results for kernel in kernel_module.kernels()}


def _by_ledger(names: list[str], forms: Mapping[str, dict[str, str]]) -> str:
    """What ``verify`` refuses, '' if nothing: first of the entries that have come out other than before."""
    by_id = {entry.id: entry for entry in sys.modules["derivations.ledger"].ENTRIES}
    for name in sorted(names, key=lambda name: name in forms and _now_of(by_id[name]) == forms[name]):
        entry = by_id[name]
        try:
            problems = list(confirm(entry).problems)
        except Exception as error:  # whatever a changed source raises
            problems = [f"{type(error).__name__}: {error}"]
        if problems:
            return f"ledger: ({name}) {problems[0]}"
    return ""


def _now_of(entry: Entry) -> dict[str, str]:
    """An entry's derived forms, none where they cannot be made."""
    try:
        return _forms(entry)
    except Exception:  # whatever a changed source raises
        return {}


def _by_tests() -> str:
    import pytest

    with redirect_stdout(io.StringIO()) as said, redirect_stderr(said):
        code = pytest.main(["-q", "-x", "-n", "0", "-p", "no:cacheprovider", *_TESTS])
    failed = [line for line in said.getvalue().splitlines() if line.startswith(("FAILED", "ERROR"))]
    return f"test: {failed[0] if failed else code}" if code else ""


def _refusal(edit: Edit, loaded: Loaded) -> dict[str, object]:
    """Who refuses a slip; if nobody does so cheaply and the function that it is in gives the same, that."""
    dependents = loaded.importers[edit.module]
    of_ledger = {name for name in dependents if name.startswith("derivations.ledger")}
    try:
        _run_again(edit, dependents - of_ledger)
        found = _by_generate(loaded)
        if found:
            return {"refused": found}
        if edit.function in loaded.given[edit.module] and _given(edit.module) == loaded.given[edit.module]:
            return {"refused": "", "same": f"all functions of {edit.module} without arguments return the same"}
        for name in of_ledger:
            sys.modules.pop(name, None)
        sys.modules.pop("derivations.ledger", None)
        importlib.import_module("derivations.ledger")
        found = _by_ledger(loaded.entries(edit.module), loaded.forms) or _by_tests()
        return {"refused": found} if found else {"refused": "", "now": _now(edit, loaded)}
    except DimensionError as error:
        return {"refused": f"dimension: {error}"}
    except ArithmeticError as error:
        return {"refused": f"own check: {error}"}
    except Exception as error:  # whatever a changed source raises
        last = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{Path(last.filename).name}:{last.lineno}"
        return {"refused": f"does not run: {type(error).__name__}: {error} ({where})"}


def _text(value: object) -> str:
    """An expression, or a collection of them, in full."""
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return str(sp.srepr(value))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_text(k)}: {_text(v)}" for k, v in value.items()) + "}"
    if isinstance(value, tuple | list):
        return "(" + ", ".join(map(_text, value)) + ")"
    return repr(value)


def _given(name: str) -> dict[str, str]:
    """What the functions of a module return that need no arguments."""
    module, found = sys.modules[f"derivations.{name}"], {}
    for key, function in vars(module).items():
        own = callable(function) and getattr(function, "__module__", "") == module.__name__
        if own and not isinstance(function, type) and not inspect.signature(function).parameters:
            found[key] = _text(function())
    return found


@dataclass(frozen=True)
class Outcome:
    """What became of a slip: refused by whom, or why it changes nothing; neither if it survives."""

    edit: Edit
    refused: str
    equivalent: str
    seconds: float
    undecided: str = ""


def try_(edit: Edit, loaded: Loaded) -> Outcome:
    """One slip, in a fork."""
    start = time.perf_counter()
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        signal.setitimer(signal.ITIMER_PROF, _LIMIT)
        try:
            answer = _refusal(edit, loaded)
        except BaseException as error:  # the parent must hear of it
            answer = {"refused": f"does not run: {type(error).__name__}: {error}"}
        with os.fdopen(writing, "w") as out:
            json.dump(answer, out)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as said:
        text = said.read()
    os.waitpid(child, 0)
    seconds = time.perf_counter() - start
    if not text:
        return Outcome(edit, "", "", seconds, f"does not end within {_LIMIT} s")
    answer = json.loads(text)
    reason = answer.get("same", "")
    if not answer["refused"] and (edit.module, edit.function) in _FREE:
        reason = _FREE[edit.module, edit.function]
    if "now" in answer and answer["now"] == _before(edit, loaded):
        reason = "every kernel, table and derived form of the ledger is the same"
    return Outcome(edit, str(answer["refused"]), str(reason), seconds)


def _now(edit: Edit, loaded: Loaded) -> dict[str, object]:
    """What the derivations give with a slip: hashes of the kernels, whether tables changed, the ledger's forms."""
    hashes = {kernel.name: emit._source_hash(kernel) for kernel in sys.modules[kernel_module.__name__].kernels()}
    by_id = {entry.id: entry for entry in sys.modules["derivations.ledger"].ENTRIES}
    forms = {name: _forms(by_id[name]) for name in loaded.entries(edit.module)}
    return {"kernels": hashes, "tables": _headers() == loaded.tables, "forms": forms}


def _before(edit: Edit, loaded: Loaded) -> dict[str, object]:
    by_id = {entry.id: entry for entry in ENTRIES}
    forms = {name: _forms(by_id[name]) for name in loaded.entries(edit.module)}
    return {"kernels": loaded.hashes, "tables": True, "forms": forms}


def _table(outcomes: list[Outcome]) -> str:
    """Counts per module and by whom, as Markdown."""
    kinds = ("own check", "dimension", "proof", "ledger", "test", "does not run")
    lines = [
        "| module | slips | " + " | ".join(kinds) + " | change nothing | undecided | survive |",
        "|---|" + "---:|" * 10,
    ]
    for module in (*FORMULA_MODULES, "all"):
        own = [o for o in outcomes if module in (o.edit.module, "all")]
        by = Counter(next((kind for kind in kinds if o.refused.startswith(kind)), "") for o in own)
        same, undecided = sum(bool(o.equivalent) for o in own), sum(bool(o.undecided) for o in own)
        counts = [len(own), *(by[kind] for kind in kinds), same, undecided, by[""] - same - undecided]
        lines.append(f"| {module} | " + " | ".join(str(count) for count in counts) + " |")
    return "\n".join(lines)


def _drawn(seed: str, count: int) -> list[Edit]:
    every = [edit for module in FORMULA_MODULES for edit in edits(module)]
    if not 1 <= count <= len(every):
        raise ValueError(f"--count is {count}; allowed is 1 to {len(every)}, all there are")
    print(f"{count} of {len(every)} slips, seed {seed}", flush=True)
    return random.Random(seed).sample(every, count)


def _typed(module: str, old: str, new: str) -> Edit:
    """A change that someone typed: the first place in a module that has ``old``."""
    if module not in FORMULA_MODULES:
        raise ValueError(f"--edit's module is {module}; allowed are {', '.join(FORMULA_MODULES)}")
    text = _source(module)
    if old not in text:
        raise ValueError(f"--edit's old text is {old}; allowed is what stands in {module}")
    line = text[: text.index(old)].count("\n") + 1
    return Edit(module, "", line, old, new, partial(text.replace, old, new, 1))


def _source(module: str) -> str:
    return FOLDER.joinpath(*module.split(".")).with_suffix(".py").read_text("utf-8")


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m derivations.source_mutants", description=__doc__)
    parser.add_argument("--seed", default=time.strftime("%Y-%m-%d"), help="of the choice; today's date if not given")
    parser.add_argument("--count", type=int, default=10, help="how many slips; 10 if not given")
    parser.add_argument(
        "--numbers", nargs=2, type=int, metavar=("FIRST", "LAST"), help="of the slips chosen, try only these"
    )
    parser.add_argument(
        "--edit", nargs=3, action="append", metavar=("MODULE", "OLD", "NEW"), help="try this change of a line instead"
    )
    options = parser.parse_args(arguments)
    try:
        chosen = [_typed(*edit) for edit in options.edit] if options.edit else _drawn(options.seed, options.count)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    first, last = options.numbers or (1, len(chosen))
    if not 1 <= first <= last <= len(chosen):
        print(f"--numbers is {first} {last}; allowed is 1 to {len(chosen)}, rising", file=sys.stderr)
        return 2
    loaded, outcomes = Loaded(timed=last - first > 50), []
    for number, edit in list(enumerate(chosen, 1))[first - 1 : last]:
        outcome = try_(edit, loaded)
        outcomes.append(outcome)
        state = outcome.refused or outcome.equivalent or outcome.undecided or "SURVIVES"
        where = f"{edit.module}:{edit.line}: {edit.old} -> {edit.new}"
        print(f"[{number}] {where[:150]}: {state[:150]}, {outcome.seconds:.1f} s", flush=True)
    print(_table(outcomes))
    survivors = [o for o in outcomes if not (o.refused or o.equivalent or o.undecided)]
    print(f"{len(outcomes)} slips, {len(survivors)} surviving")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
