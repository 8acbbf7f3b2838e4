"""A proof of a kernel's outputs: what they are by an independent statement, and where the two are compared.

The statement never sees the kernel's expressions and shares no function with the modules that make them.  Every output
is compared with it in 50 digits at stated points; where a statement can be written for symbols too, their difference is
shown to vanish identically.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache

import mpmath as mp
import sympy as sp

from derivations.codegen.kernels import Kernel
from derivations.nomenclature import CONSTANTS, TINY
from derivations.proofs.graph import Graph, Values
from derivations.proofs.maths import DIGITS, NUMBERS, SYMBOLS, Maths, Number, Point
from trum_sym.inputs.motor_file import load_motor

__all__ = ["NONSENSE", "Proof", "Subject", "check", "draw", "grid", "identical", "reference"]

NONSENSE = (ArithmeticError, ValueError, TypeError, NotImplementedError)
"""What numbers raise where an expression has none."""
_STEP_DIGITS = DIGITS // 2

# Ranges of what is no motor parameter, around TRUM-60 at Table 3
_RANGES: dict[str, tuple[float, float]] = {
    "x": (-0.01, 0.01),
    "x_max": (-0.01, 0.01),
    "tau": (1e-6, 2e-4),
    "E": (6e10, 9e10),
    "rho": (7e3, 9e3),
    "I_z": (6e-11, 1e-10),
    "G": (3e10, 5e10),
    "A": (3e-5, 5e-5),
    "E_eq": (2e10, 4e10),
    "D": (2.4e-3, 3.2e-3),
    "k_c": (250.0, 350.0),
    "k_f": (1e8, 5e8),
    "k_dx": (1e8, 5e8),
    "k_N": (2e10, 4e10),
    "theta": (0.2, 3.0),
    "F_c": (100.0, 220.0),
    "W": (3e-6, 9e-6),
    "grip": (0.5, 60.0),
    "ratio": (-1.5, 1.5),
    "u": (-3.0, 3.0),
    "u_0": (-3.0, 3.0),
    "t_0": (-1.0, 1.0),
    "k_T": (5e9, 2e10),
    "h_f": (0.5e-3, 1.5e-3),
    "l_f": (2e-3, 6e-3),
    "E_f": (6e10, 2.1e11),
    "mu_f": (0.25, 0.4),
    "omega_n": (2.3e5, 2.6e5),
    "Delta_omega": (1.6e4, 2.2e4),
    "omega_q": (2.4e5, 2.8e5),
    "beta": (200.0, 320.0),
    "psi": (-3.0, 3.0),
    "T": (4e-4, 6e-4),
    "T_load": (-0.4, 0.4),
    "J_load": (1e-5, 1e-2),
    "r_s": (0.01, 0.2),
    "f": (-1.0, 1.0),
    **dict.fromkeys(("q_plus", "q_minus", "p_plus", "p_minus"), (0.5, 90.0)),
    **dict.fromkeys(("a", "a_A", "a_B", "w_A", "w_B", "f_A_re", "f_A_im", "f_B_re", "f_B_im"), (-5e-06, 5e-06)),
    **dict.fromkeys(("b", "b_A", "b_B", "p_re", "p_im", "e_re", "e_im", "d_re", "d_im"), (-1.0, 1.0)),
    "M_q": (0.03, 0.2),
    "F_q": (20.0, 400.0),
    "c_p": (0.3, 1.0),
    "Theta_q": (0.4, 1.6),
    "C_0": (5e-9, 3e-8),
    "lead": (-3.0, 3.0),
    "omega_n0": (2.3e5, 2.6e5),
    "central": (80.0, 220.0),
    "along": (-50.0, 60.0),
    "across": (-50.0, 60.0),
    "lossy": (-10.0, 60.0),
    "level": (-3.0, 0.9),
    **dict.fromkeys(("sheared", "sheared_cos", "sheared_ratio", "sheared_sin"), (-0.2, 0.2)),
    **dict.fromkeys(("u_in", "leaving", "free"), (0.3, 3.0)),
    **dict.fromkeys(("u_out", "zone_low"), (-3.0, -0.3)),
    "zone_high": (0.3, 3.0),
    "height": (-5e-6, 5e-6),
    "v_A": (-1.0, 1.0),
    "v_B": (-1.0, 1.0),
    "W_c": (1e-6, 9e-6),
    "W_full": (2e-7, 8e-7),
    "engagement_per_height": (5e6, 2e7),
    "engagement": (0.2, 40.0),
    "share": (-40.0, 0.3),
    "phi": (-3.1, 3.1),
    "R_v": (0.5, 2.0),
    "v": (-2.0, 2.0),
    "R_v_rate": (-3e4, 3e4),
    "v_rate": (-3e4, 3e4),
    "W_c_rate": (-0.5, 0.5),
    "p_larger": (-0.5, 3.0),
    "p_smaller": (-2.0, 2.0),
    "step": (1e-7, 1e-6),
}


@cache
def _usual() -> Mapping[str, float]:
    return {name: float(value) for name, value in load_motor("trum60").symbols().items()}


def draw(name: str, seed: object) -> Number:
    """A number for a symbol: a motor parameter 20 % to either side, a rate or a whole number, the rest by range."""
    at = random.Random(f"{name} {seed}")
    if name in ("n_j", "n_s"):
        return mp.mpf(int(_usual()[name]) + at.choice((-1, 0, 1)))
    if name in _RANGES:
        return mp.mpf(at.uniform(*_RANGES[name]))
    if name in _usual():
        return mp.mpf(_usual()[name] * at.uniform(0.8, 1.2))
    if name.endswith(("_omega_n", "_Delta_omega")):  # how free motion follows a frequency
        return mp.mpf(at.uniform(-1, 1) * (5e-6 if name.startswith("b") else 5e-11))
    raise LookupError(f"give a range for {name}")


def grid(
    names: str, count: int = 6, fit: Callable[[dict[str, Number], random.Random], None] | None = None
) -> Callable[[], list[Point]]:
    """Random points of some symbols, the same on every run; ``fit`` then makes a point's numbers agree.

    Parameters
    ----------
    names : str
        Symbols, separated by spaces.
    count : int
        Of points.
    fit : callable, optional
        Changes the numbers of a point, by its name, in place.
    """

    def points() -> list[Point]:
        found = []
        for index in range(count):
            at = random.Random(f"pulses {index}")
            m = at.randint(12, 40)
            whole = {"m": m, "n": at.randint(m // 2 + 1, m - 1), "s": 1 - 2 * (index % 2)}
            whole |= {"g_A": index // 2 % 2, "g_B": index // 4 % 2}  # eight points have every case
            values = {name: mp.mpf(whole[name]) if name in whole else draw(name, index) for name in names.split()}
            if fit is not None:
                fit(values, random.Random(f"{names} {index}"))
            found.append(Point(values))
        return found

    return points


def identical(one: sp.Expr, other: sp.Expr, *, but_for_sign: bool = False) -> bool:
    """Whether two expressions are the same for all values of their symbols.

    Rational functions are brought over one denominator.  ``but_for_sign`` compares squares as well, which settles
    expressions with a square root each; the sign is then left to the numbers at the points.
    """
    if sp.expand(one - other) == 0:
        return True
    gap = sp.cancel(sp.together(one - other))
    if gap == 0 or sp.cancel(sp.together(sp.expand_trig(gap))) == 0:
        return True
    if not but_for_sign or other == 0:
        return False
    square = sp.cancel(sp.together(sp.powdenest((one / other) ** 2, force=True)))
    return bool(square == 1 or sp.simplify(gap) == 0 or sp.simplify(square) == 1)


@dataclass(frozen=True)
class Proof:
    """What some outputs of a kernel are.

    Attributes
    ----------
    kernel : str
        The C function.
    outputs : str
        Names of the outputs, separated by spaces.
    rests_on : str
        Entries of the ledger that judge what the statement starts from, separated by spaces.
    statement : str
        What the outputs are, in words.
    wanted : callable
        (point, maths) -> the outputs by name; None where they only have to be finite.
    points : callable
        The points at which kernel and statement are compared.
    where : str
        Which those are, in words.
    symbolic : bool
        Whether the statement holds for symbols too, and is compared so as well.
    tolerance : float
        Relative, and of what should be 0 absolute.
    floor : float
        Size below which the tolerance is one of this size.
    """

    kernel: str
    outputs: str
    rests_on: str
    statement: str
    wanted: Callable[[Point, Maths], Mapping[str, Number | None]]
    points: Callable[[], list[Point]]
    where: str
    symbolic: bool = False
    tolerance: float = 1e-50
    floor: float = 0

    @property
    def names(self) -> tuple[str, ...]:
        """The outputs' names."""
        return tuple(self.outputs.split())

    @property
    def kind(self) -> str:
        """How the outputs are compared with the statement."""
        return "symbolic" if self.symbolic else "50 digits" if self.tolerance < 1e-40 else f"{self.tolerance:.0e}"

    def differs(self, found: Mapping[str, Number], wanted: Mapping[str, Number | None]) -> str:
        """The first output that is not what is wanted, with both numbers; '' if all are."""
        for name in self.names:
            is_, should = found[name], wanted[name]
            if isinstance(is_, mp.mpc) or not mp.isfinite(is_):
                return f"{name} is {is_}"
            if should is None:
                continue
            apart = abs(is_ - should)
            size = max(abs(should), abs(is_), self.floor) if should else 1
            if not apart <= self.tolerance * size:
                return f"{name} is {mp.nstr(is_, 17)}, by the statement {mp.nstr(should, 17)}"
        return ""


def _constants(point: Point) -> dict[str, Number]:
    """A point's values with the kernels' constants; what keeps quotients finite is below all compared digits."""
    constants = {symbol.name: mp.mpf(value) for symbol, value in CONSTANTS.items()}
    return {**constants, TINY.name: mp.mpf("1e-150"), **point.values}


class Subject:
    """A kernel's expressions, ready to be evaluated at points, whole or with one part replaced.

    Of a kernel with directions the results are derivatives: central differences of the outputs along the rates.
    """

    def __init__(self, kernel: Kernel) -> None:
        self.kernel = kernel
        self.graph = Graph(kernel.outputs)
        self.rates = {direction: Graph({s.name: r for s, r in of.items()}) for direction, of in kernel.along.items()}

    def _moved(self, base: dict[str, Number], rates: Mapping[str, Number], step: Number) -> dict[str, Number]:
        return {**base, **{name: base[name] + step * rate for name, rate in rates.items()}}

    def evaluations(self, point: Point) -> list[tuple[dict[str, Number], Values]]:
        """All parts at the points that the results need: the point itself, or one to either side per direction."""
        base = _constants(point)
        if not self.rates:
            return [(base, self.graph.values(base))]
        found = []
        with mp.workdps(2 * DIGITS):
            for direction, graph in self.rates.items():
                values = graph.values(base)
                rates = {name: values[i] for name, i in graph.outputs.items()}
                for step in self._steps(base, direction):
                    moved = self._moved(base, rates, step)
                    found.append((moved, self.graph.values(moved)))
        return found

    def _steps(self, base: Mapping[str, Number], direction: str) -> tuple[Number, Number]:
        step = abs(base[direction]) * mp.mpf(10) ** -_STEP_DIGITS
        return step, -step

    def _results(self, point: Point, outputs: list[dict[str, Number]]) -> dict[str, Number]:
        if not self.rates:
            return outputs[0]
        found = {}
        with mp.workdps(2 * DIGITS):
            for index, direction in enumerate(self.rates):
                step, _ = self._steps(point.values, direction)
                ahead, behind = outputs[2 * index], outputs[2 * index + 1]
                for name in self.kernel.outputs:
                    found[f"{name}_{direction}"] = (ahead[name] - behind[name]) / (2 * step)
        return found

    def results(self, point: Point) -> dict[str, Number]:
        """What the kernel computes at a point."""
        outputs = [{n: values[i] for n, i in self.graph.outputs.items()} for _, values in self.evaluations(point)]
        return self._results(point, outputs)

    def with_part(
        self,
        point: Point,
        evaluations: list[tuple[dict[str, Number], Values]],
        part: int,
        new: sp.Basic,
        affected: list[int],
    ) -> dict[str, Number]:
        """The same with ``new`` in place of a part of the outputs."""
        with mp.workdps(2 * DIGITS if self.rates else DIGITS):
            outputs = [self.graph.changed(values, at, part, new, affected) for at, values in evaluations]
        return self._results(point, outputs)


def check(proof: Proof, subject: Subject, reference: Iterable[tuple[Point, Mapping[str, Number | None]]]) -> str:
    """What is wrong with a kernel by a proof, '' if nothing."""
    with mp.workdps(DIGITS):
        for index, (point, wanted) in enumerate(reference):
            try:
                wrong = proof.differs(subject.results(point), wanted)
            except KeyError as error:
                wrong = f"{proof.outputs}: depends on {error.args[0]}, which the statement knows nothing of"
            except NONSENSE as error:
                wrong = f"{proof.outputs}: {str(error) or type(error).__name__}"
            if wrong:
                return f"{wrong}, at point {index + 1}"
    return _identically(proof, subject.kernel) if proof.symbolic else ""


def _identically(proof: Proof, kernel: Kernel) -> str:
    symbols = Point({symbol.name: symbol for symbol in kernel.inputs})
    wanted = proof.wanted(symbols, SYMBOLS)
    fixed = {symbol: sp.nsimplify(value) for symbol, value in CONSTANTS.items() if symbol != TINY} | {TINY: 0}
    for name in proof.names:
        if not identical(sp.sympify(kernel.outputs[name]).subs(fixed), sp.sympify(wanted[name]), but_for_sign=True):
            return f"{name} is not identically what is stated"
    return ""


def reference(proof: Proof) -> list[tuple[Point, Mapping[str, Number | None]]]:
    """The points of a proof and what is wanted there."""
    with mp.workdps(DIGITS):
        return [(point, proof.wanted(point, NUMBERS)) for point in proof.points()]
