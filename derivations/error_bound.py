"""Why the rotor's orbit is known to within what its time steps' defects allow: theorems, each with a proof that raises.

The rim's speed obeys v' = F(v, t) = push f(v, t) - drag, and f falls as v rises (entry ``rotor-orbit`` of the ledger).
A continuous numerical solution u obeys u' = F(u, t) + r with the defect r.  Everything here rests on that monotony and
on nothing else; a model whose friction rises with the speed somewhere (where orbits need not be unique) has no such
bounds, and :func:`comparison` is where it would fail.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import sympy as sp

from derivations import collocation

__all__ = [
    "THEOREMS",
    "Theorem",
    "comparison",
    "contact_edge",
    "deviation",
    "excess",
    "hidden_peak",
    "kronrod",
    "monotone_weight",
    "pressure",
    "prove",
    "repetition",
    "reversal",
    "saturation",
    "segments",
    "start_speed",
    "surface",
]

x, t, tau, T = sp.symbols("x t tau T", positive=True)


class ProofError(ArithmeticError):
    """A step of a proof does not hold."""


def _zero(expression: sp.Expr, step: str) -> None:
    if sp.simplify(expression) != 0:
        raise ProofError(f"{step}: {sp.simplify(expression)} is not 0")


def comparison() -> sp.Expr:
    """The error e = u - v obeys e' = -a e + r with a >= 0, so that |e(T)| <= |e(0)| + integral |r|.

    Here a = -(F(u, t) - F(v, t))/(u - v).  Returns e(T) by variation of constants: e(0) exp(-A(0, T)) + integral of
    r(tau) exp(-A(tau, T)), A the integral of a.
    """
    a, r, start = sp.Function("a")(t), sp.Function("r"), sp.Symbol("e_0", real=True)
    until_t, until_tau = (sp.Integral(sp.Function("a")(x), (x, 0, end)) for end in (t, tau))
    kept = sp.exp(-until_t)
    error = start * kept + kept * sp.Integral(r(tau) * sp.exp(until_tau), (tau, 0, t))
    _zero(sp.expand(error.diff(t).doit() + a * error - r(t)), "variation of constants")
    _zero(error.subs(t, 0).doit() - start, "it begins at e(0)")
    exponent = sp.Symbol("A", nonnegative=True)
    _zero(sp.exp(-exponent).diff(exponent) + sp.exp(-exponent), "what is kept of an error falls as A grows")
    return error


def saturation() -> sp.Expr:
    """Friction takes from an error towards its nearer saturation no more than the integral of push (1 - |f|).

    With |f| <= 1 the speed of the exact solution v has f(v) <= 1, so the part a e = push (f(v) - f(u)) of e' is at most
    push (1 - f(u)), however steep f is at u; likewise push (f(u) - f(v)) <= push (1 + f(u)).  The smaller is
    push (1 - |f(u)|).  So no more of an error than this may be counted as drawn together.
    """
    push, f, short = sp.Symbol("push", positive=True), sp.Symbol("f", real=True), sp.Symbol("short", nonnegative=True)
    _zero(push * (1 - f) - push * ((1 - short) - f) - push * short, "f(v) = 1 - short is at most 1")
    _zero(push * (1 + f) - push * (f - (short - 1)) - push * short, "f(v) = short - 1 is at least -1")
    positive, negative = sp.Symbol("f_p", nonnegative=True), -sp.Symbol("f_n", nonnegative=True)
    _zero(sp.Min(1 - positive, 1 + positive) - (1 - sp.Abs(positive)), "the smaller, f >= 0")
    _zero(sp.Min(1 - negative, 1 + negative) - (1 - sp.Abs(negative)), "the smaller, f <= 0")
    return push * (1 - sp.Abs(f))


def excess() -> sp.Expr:
    """A rotor is ahead of the surface's largest speed R_v by no more than at a step's start, or than R_v gets away.

    Past R_v friction is saturated against the motion, so the excess X = |v| - R_v changes at
    -push - sign(v) drag - R_v' <= -(push - |drag|) + max |R_v'| while X > 0.  So X(h) is at most max(0, X(0)) + h times
    that rate, if it is positive; and the exact solution lies within R_v + X of 0, so that its distance to a numerical
    one u is at most R_v + X + |u|: where R_v passes zero this is small however steep friction is there.
    """
    push, drag = sp.Symbol("push", positive=True), sp.Symbol("drag", real=True)
    away, size, gap = sp.symbols(
        "away size gap", nonnegative=True
    )  # max |R_v'|, |drag|, by how much R_v' is above -away
    forward, backward = -push - drag, -(push - drag)  # d|v|/dt at f = -1 for v > R_v, at f = 1 for v < -R_v
    for slowed, name in ((forward, "v > R_v"), (backward, "v < -R_v")):
        for sign in (1, -1):
            rate = (slowed - (gap - away)).subs(drag, sign * size)
            slack = sp.expand(-(push - size) + away - rate)
            if not slack.is_nonnegative:
                raise ProofError(f"the excess, {name}: {slack} can be negative")
    return -(push - sp.Abs(drag)) + away


def hidden_peak() -> int:
    """What a peak of friction integrates to over a step's length times what it makes the nodes differ by, at most: 12.

    Next to a standing wave that passes zero at the rate s while the other phase is d, the cosine of the surface's
    phase is d / sqrt(d^2 + (s t)^2), and with it friction has a peak A / sqrt(1 + (t/w)^2) of half-width w = d/s. Its
    integral over a step h is 2 A w asinh(x) at most, x = h/(2 w), as the inverse hyperbolic sine is concave.
    Lobatto's middle nodes are h/(2 sqrt 5) from the step's middle, so that one node is no further from the peak, and
    one end is at least h/2 from it: the nodes differ by A (1/sqrt(1 + x^2/5) - 1/sqrt(1 + x^2)) at least, wherever
    the peak is. The quotient of both over h is asinh(x)/g(x) with g = x (1/sqrt(1 + x^2/5) - 1/sqrt(1 + x^2)), which
    rises with x. The phase counts as turning from a cosine below 0.4 between two nodes on, x > 1.46; up to x = 1e6
    the quotient is at most 12, as it is at most asinh(b)/g(a) between a and b.
    """
    X, half = sp.Symbol("x", positive=True), sp.Rational(1, 2)
    near, far = (1 + X**2 / 5) ** (-half), (1 + X**2) ** (-half)
    middle = collocation.nodes()[2] - half
    _zero(middle / half - 1 / sp.sqrt(5), "the middle nodes")
    g = X * (near - far)
    _zero(g.diff(X) - (near**3 - far**3), "the slope of g")
    angle = 2 * sp.atan(X / sp.sqrt(5))
    places = [sp.Rational(146, 100), *(sp.Integer(10) ** k for k in (1, 2, 6))]
    if not sp.cos(angle.subs(X, places[0])).evalf() > sp.Rational(4, 10):
        raise ProofError("a turn begins at a narrower peak")
    found = max(sp.asinh(b).evalf() / g.subs(X, a).evalf() for a, b in pairwise(places))
    return int(sp.ceiling(found))


def monotone_weight() -> sp.Expr:
    """With a weight w that rises from w_0 >= 0 to 1, |integral r w| <= w_0 |R(0)| + (1 - w_0) max |R|.

    R(s) is the integral of r from s to the end.

    By parts: integral r w = w_0 R(0) + integral R dw, and dw >= 0 adds up to 1 - w_0.  What friction keeps of a defect
    until the step's end is such a weight, whatever the slope of friction in between.
    """
    s = sp.Symbol("s", real=True)
    for degree in range(6):  # polynomials span what the step's interpolants are
        for power in range(4):
            r, w = s**degree, sp.Rational(1, 3) + sp.Rational(2, 3) * s**power
            R = sp.integrate(r.subs(s, tau), (tau, s, 1))
            by_parts = w.subs(s, 0) * R.subs(s, 0) + sp.integrate(R * w.diff(s), (s, 0, 1))
            if power:
                _zero(sp.integrate(r * w, (s, 0, 1)) - by_parts, f"by parts, degree {degree}, weight {power}")
    return sp.Symbol("w_0") * sp.Abs(sp.Symbol("R_0")) + (1 - sp.Symbol("w_0")) * sp.Symbol("R_max")


def kronrod() -> int:
    """Degree to which Lobatto's nodes and the check nodes integrate exactly, and to which Lobatto's alone do: 9 and 5.

    A defect vanishes at Lobatto's nodes, so three check nodes give its integral as exactly as seven nodes do.
    """
    points = [*collocation.nodes(), *collocation.check_nodes()]
    weights = [*collocation.check_full_weights(), *collocation.check_weights()]
    lobatto = collocation.integrals().row(collocation.COUNT - 1)
    for degree in range(10):
        exact = sp.Rational(1, degree + 1)
        found = sum(weight * point**degree for weight, point in zip(weights, points, strict=True))
        _zero(sp.radsimp(sp.expand(found - exact)), f"Kronrod, degree {degree}")
        plain = sum(lobatto[i] * point**degree for i, point in enumerate(collocation.nodes()))
        if degree <= 5:
            _zero(sp.radsimp(sp.expand(plain - exact)), f"Lobatto, degree {degree}")
    if sp.simplify(sum(lobatto[i] * p**6 for i, p in enumerate(collocation.nodes())) - sp.Rational(1, 7)) == 0:
        raise ProofError("Lobatto's rule is exact beyond degree 5")
    return 9


def start_speed() -> sp.Expr:
    """How far the start of the orbit is from that of a lap: (gain - e(T)) / (1 - S) to the first order.

    The lap map P is increasing with slope S between 0 and 1.  The exact lap from v_0 ends at v_0 + gain - e(T), where
    gain is the numerical one.  On the orbit P(v) = v, so v - v_0 = (P(v) - P(v_0)) + (gain - e(T)).  If the exact gain
    is positive, the orbit lies above v_0, and below if it is negative: v - P(v) rises strictly.
    """
    S, gain, error, change = sp.symbols("S gain e_T change", real=True)
    found = sp.solve(sp.Eq(change, S * change + gain - error), change)[0]
    _zero(found - (gain - error) / (1 - S), "the fixed point")
    slope = sp.Symbol("s", positive=True)  # of v - P(v), 1 - S > 0
    _zero(sp.integrate(slope, (x, 0, change)) - slope * change, "v - P(v) rises")
    return found


def deviation() -> sp.Expr:
    """Standard deviations of two speeds differ by no more than that of their difference (triangle inequality).

    With the mean over a lap as inner product, (sd(u) - sd(v))^2 <= var(u - v): the difference of both sides is
    2 (sd(u) sd(v) - cov(u, v)), which is not negative by Cauchy and Schwarz.
    """
    a, b, c = sp.symbols("sd_u sd_v cov", real=True)
    slack = (a**2 + b**2 - 2 * c) - (a - b) ** 2
    _zero(slack - 2 * (a * b - c), "the slack")
    return slack


def surface() -> sp.Expr:
    """A surface whose speed is off by at most c moves the rotor's speed by at most c, however long it lasts.

    Friction depends on the differences of surface and rotor's speed, so f at v with the surface off by at most c lies
    between f(v + c) and f(v - c) with the surface as it was, pressure being the same: f falls in v.  So with u the
    speed on the one surface, u + c rises at least as fast as the motion on the other does there, and u - c at most: a
    solution that begins between them stays between.  Returns the least excess of the rate of u + c, which is 0.

    Raises
    ------
    ProofError
        If a step does not hold.
    """
    w, c, v, push, drag = sp.symbols("w c v push drag", real=True)
    for side in (1, -1):  # all of the surface off to one side is the rotor's speed off to the other
        _zero(sp.sign((w + side * c) - v) - sp.sign(w - (v - side * c)), "a shift of the surface is one of the rotor")
    u, f, less = sp.Function("u")(t), sp.Function("f"), sp.Symbol("less", nonnegative=True)
    rate = push * f(u) - drag
    upper = u + c
    other = push * (f(upper - c) - less) - drag  # at most the rate with all of the surface faster by c
    excess = upper.diff(t).subs(u.diff(t), rate) - other
    _zero(excess - push * less, "u + c rises at least as fast")
    return excess.subs(less, 0)


def pressure() -> sp.Expr:
    """A layer whose surface is off in height by at most a has friction off by at most 2 a / W_full.

    The layer's pressure per angle is k max(0, z - h), with h where it carries the load.  Raising z everywhere by a
    raises h by a; h is monotone in z, so it is off by at most a, and the pressure by at most 2 k a; friction is a mean
    of signs over the pressure, so over the whole wave it is off by at most 2 pi times that over the load.  At the wave
    height W_full the whole wave just touches and the pressure, k (W_full + W_full cos u), carries 2 pi k W_full.

    Raises
    ------
    ProofError
        If a step does not hold.
    """
    k, a, h, z, W_full, u = sp.symbols("k a h z W_full u", positive=True)
    _zero(sp.Max(0, (z + a) - (h + a)) - sp.Max(0, z - h), "a shift of the height is one of the level")
    load = sp.integrate(k * (W_full + W_full * sp.cos(u)), (u, -sp.pi, sp.pi))
    _zero(load - 2 * sp.pi * k * W_full, "the load at full contact")
    bound = 2 * sp.pi * (2 * k * a) / load
    _zero(bound - 2 * a / W_full, "the bound")
    return bound


def reversal() -> sp.Expr:
    """The mean over a turn of min(1, c / |sin|) is at most c (1 - ln c), for c from 0 to 1; of 1/sqrt|cos| below 1.7.

    A standing wave's speed and height go through zero so.  A part of the wave below c of its speed turns its friction
    around, a part of the height below c its contact (``surface`` bounds neither, for a rotor that is held).

    Raises
    ------
    ProofError
        If a step does not hold.
    """
    c = sp.Symbol("c", positive=True)
    chord = 2 * x / sp.pi  # sin x is above its chord from 0 to pi/2, as it is concave there
    _zero(sp.sin(x).subs(x, sp.pi / 2) - chord.subs(x, sp.pi / 2), "the chord ends on the sine")
    meets = sp.solve(sp.Eq(chord, c), x)[0]
    mean = 2 / sp.pi * (meets + sp.integrate(c / chord, (x, meets, sp.pi / 2)))
    bound = c * (1 - sp.log(c))
    _zero(sp.expand_log(sp.simplify(mean - bound), force=True), "the mean under the chord")
    whole = 2 / sp.pi * sp.gamma(sp.Rational(1, 4)) * sp.sqrt(sp.pi) / (2 * sp.gamma(sp.Rational(3, 4)))
    if not whole.evalf(30) < sp.Rational(17, 10):
        raise ProofError(f"reversal: the mean of 1/sqrt|cos| is {whole.evalf(6)}")
    return bound


def contact_edge() -> sp.Expr:
    """A layer whose surface is off in height by at most a has theta/pi off by at most sqrt(2 a / W_c).

    What touches is where the wave is above the level; both are off by at most a, so what changes lies within 2 a of the
    level, 4 a of height, w = 4 a / W_c of the cosine.  Most of the circle lies within w of the cosine next to its
    crests, on each side arccos(1 - w), which is at most pi/2 sqrt(2 w).

    Raises
    ------
    ProofError
        If a step does not hold.
    """
    w, a, W_c = sp.symbols("w a W_c", positive=True)
    half = sp.Symbol("half", positive=True)  # of the angle: 1 - cos(2 half) = 2 sin(half)^2, sin above its chord
    _zero(1 - sp.cos(2 * half) - 2 * sp.sin(half) ** 2, "half angles")
    widest = 2 * sp.solve(sp.Eq(2 * (2 * half / sp.pi) ** 2, w), half)[0]
    _zero(widest - sp.pi / 2 * sp.sqrt(2 * w), "by the chord")
    bound = (widest / sp.pi).subs(w, 4 * a / W_c)
    _zero(bound - sp.sqrt(2 * a / W_c), "the bound")
    return bound


def repetition() -> sp.Expr:
    """A period that is repeated has, in each repetition, the errors of the first time but for drift / (1 - K) at most.

    A period takes the solution from x_0 to x_1 and its error from e_0 to e_1 = K e_0 + r.  Repeated from x_0 again, the
    solution jumps by x_0 - x_1 and its error with it: e' = K e + r - (x_1 - x_0).  From e_0 on this draws near to
    e_0 - drift / (1 - K), where drift = (x_1 - x_0) - (e_1 - e_0) is what the exact motion changes by in the period.
    Within a period errors differ by what is kept of their difference at its begin.  So remainders do, without drift.

    Raises
    ------
    ProofError
        If a step does not hold.
    """
    K, r, e_0, x_0, x_1, e = sp.symbols("K r e_0 x_0 x_1 e", real=True)
    k = sp.Symbol("k", integer=True, nonnegative=True)
    e_1 = K * e_0 + r
    step = K * e + r - (x_1 - x_0)
    limit = sp.solve(sp.Eq(step, e), e)[0]
    drift = (x_1 - x_0) - (e_1 - e_0)
    _zero(limit - (e_0 - drift / (1 - K)), "the limit")
    after = limit + K**k * (e_0 - limit)
    _zero(after.subs(k, k + 1) - step.subs(e, after), "the recursion")
    _zero(after.subs(k, 0) - e_0, "it begins at e_0")
    _zero((after - e_0) - (1 - K**k) * (limit - e_0), "it nears the limit from one side")
    return drift / (1 - K)


def segments() -> sp.Expr:
    """A lap in segments that begin beside where those before them end is the lap in one, changed by what jumps leave.

    Segment k takes a speed to P_k, which rises with a slope between 0 and 1 (comparison).  It was begun at b_k; the
    lap in one passes there at b_k + d_k.  Then d_(k+1) = s_k d_k + (P_k(b_k) - b_(k+1)), s_k the slope of a secant of
    P_k.  The tangent at b_k, S_k, stands for it, and as both lie between 0 and 1, |s_k - S_k| |d_k| is |d_k| at most;
    so it is for every speed within the segment.  Returns where a lap of three segments ends.

    Raises
    ------
    ProofError
        If a step does not hold.
    """
    begin, end = sp.symbols("b_1:4", real=True), sp.symbols("P_1:4", real=True)  # of each segment
    s = sp.symbols("s_1:4", nonnegative=True)
    in_one, change = begin[0], sp.Integer(0)
    for k in range(3):
        in_one = end[k] + s[k] * (in_one - begin[k])
        change = s[k] * change + end[k] - (begin[k + 1] if k < 2 else 0)
    _zero(in_one - change, "the lap in one")
    secant, tangent = (sp.Symbol(name, nonnegative=True) for name in ("s", "S"))
    apart = ((1 - secant) + tangent) * ((1 - tangent) + secant)  # two factors that are not negative
    _zero(1 - (secant - tangent) ** 2 - apart, "slopes between 0 and 1")
    return in_one


def brief_saturation() -> sp.Expr:
    """As a moment without saturation begins to be, S jumps, however brief it is.

    The points as fast as the rotor are at the phases +-acos(v/R_v), which move with v at 1/sqrt(R_v^2 - v^2), and
    friction with them.  Where R_v^2 - v^2 has a maximum p it is p - a t^2 next to it, and if p > 0 the integral of that
    rate over the moment is pi/sqrt(a), whatever p: the logarithm of S jumps there by a multiple of it, where friction
    itself, saturated but for the square root, changes no speed by more than a multiple of p.  So the slope of one lap
    says nothing of laps that have such a moment more, or less.  None has whose start differs by less than what a speed
    at the extremum would have to, sqrt(v^2 + p) - |v|, as no speed moves by more than the start (comparison); where
    p < 0, that is |v| - sqrt(v^2 - |p|), which is no less with |p| in place of p.  Returns the integral.

    Raises
    ------
    ProofError
        If a step does not hold.
    """
    v, t, unit = sp.Symbol("v", real=True), sp.Symbol("t", real=True), sp.Symbol("u", positive=True)
    R, p, a = sp.symbols("R_v p a", positive=True)
    _zero(sp.simplify(sp.acos(v / R).diff(v) + 1 / sp.sqrt(R**2 - v**2)), "how fast the phases move with v")
    edge = sp.sqrt(p / a)
    antiderivative = sp.asin(t / edge) / sp.sqrt(a)
    _zero(sp.simplify(antiderivative.diff(t) ** 2 - 1 / (p - a * t**2)), "the integrand")
    integral = antiderivative.subs(t, edge) - antiderivative.subs(t, -edge)
    _zero(integral.diff(p), "the integral does not depend on p")
    short = sp.integrate(sp.sqrt(p) * sp.sqrt(1 - unit**2), (unit, -1, 1)) * edge  # of the square root, t = u edge
    _zero(sp.simplify(short - sp.pi * p / (2 * sp.sqrt(a))), "what friction is less than saturated by")
    speed = sp.Symbol("|v|", nonnegative=True)
    above, below = sp.sqrt(speed**2 + p), sp.sqrt(speed**2 - p)
    _zero(sp.expand((above + below) ** 2 + (above - below) ** 2 - 4 * speed**2), "the margins' sum and difference")
    return sp.simplify(integral)


@dataclass(frozen=True)
class Theorem:
    """A statement, what it rests on, and its proof."""

    name: str
    rests_on: str
    proof: Callable[[], object]


THEOREMS = (
    Theorem("comparison", "friction does not rise with the rotor's speed", comparison),
    Theorem("saturation", "friction is at most mu times the pressure", saturation),
    Theorem("excess", "friction is saturated past the surface's speed", excess),
    Theorem("hidden peak", "a peak of the form that the phase of a nearly standing wave gives it", hidden_peak),
    Theorem("monotone weight", "comparison", monotone_weight),
    Theorem("kronrod", "nothing", kronrod),
    Theorem("start speed", "comparison", start_speed),
    Theorem("deviation", "nothing", deviation),
    Theorem("surface", "comparison", surface),
    Theorem("pressure", "a layer of bristles, each pressed by itself", pressure),
    Theorem("reversal", "nothing", reversal),
    Theorem("contact edge", "pressure", contact_edge),
    Theorem("repetition", "comparison", repetition),
    Theorem("segments", "comparison", segments),
    Theorem("brief saturation", "comparison", brief_saturation),
)


def prove() -> dict[str, object]:
    """Every theorem's result.

    Raises
    ------
    ProofError
        If a step does not hold.
    """
    return {theorem.name: theorem.proof() for theorem in THEOREMS}
