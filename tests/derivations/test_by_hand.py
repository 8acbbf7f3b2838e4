"""Formulas that stand outside derivations/, held against it symbol by symbol: gates, product and chain rules, cubics.

What of the driver is compared is read from its source, so a changed line there is noticed here.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from lazily import lazily

import trum_sym as ts
from trum_sym.model import sensitivities
from trum_sym.model.kernels import SLOPE_FIGURES, SLOPE_PARAMETERS, signature
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.paper import cycle

sp = lazily("sympy")
phases = lazily("derivations.phases")
rotor = lazily("derivations.rotor")
brush = lazily("derivations.brush")
nomenclature = lazily("derivations.nomenclature")

DRIVER = Path(ts.__file__).parent / "_driver"


def driver():
    """The driver's source as one text, white space evened out."""
    files = sorted(path for path in DRIVER.rglob("*") if path.suffix in (".h", ".hpp", ".inc"))
    return re.sub(r"\s+", " ", "\n".join(path.read_text("utf-8") for path in files))


def c_expression(text):
    """A polynomial in C as a SymPy expression: members and elements by their own names."""
    plain = re.sub(r"\b[cs]->", "", text)
    plain = re.sub(r"\b([pe])\[(\d)\]", r"\1\2", plain)
    while "REAL(" in plain:
        plain = re.sub(r"REAL\(([^()]*)\)", r"(\1)", plain)
    plain = re.sub(r"(\d)\.0\b", r"\1", plain)
    names = {name: sp.Symbol(name) for name in re.findall(r"[A-Za-z_]\w*", plain)}
    return sp.nsimplify(sp.sympify(plain, locals=names))


def found(pattern):
    match = re.search(pattern, driver())
    assert match, f"the driver no longer has {pattern}"
    return match.groups()


def test_the_pictures_gates_and_regions_are_those_of_the_phases():
    assert {phase: tuple(int(g) for g in gates) for phase, gates in cycle._GATES.items()} == phases.GATES
    assert cycle._STATES == phases.REGIONS


# --- sensitivities.py: from the driver's slopes to those of the figures --------------------------------------------
def chained(follow):
    """Derivatives of the rotor's figures, as SymPy finds them, for unknown functions of what the driver is given.

    The driver's slopes are by ln F_c, Delta_omega, drag, ln mu, ln W and omega_n with the others held; ``follow`` gives
    the rates of omega_n and W along prepressure and difference.
    """
    F_c, mu, r_c, T_load, W, omega_n, Delta_omega = nomenclature.sym("F_c mu r_c T_load W omega_n Delta_omega")
    arguments = {
        "prepressure": sp.log(F_c),
        "difference": Delta_omega,
        "drag": rotor.coefficients()["drag"],
        "friction": sp.log(mu),
        "amplitude": sp.log(W),
        "resonance": omega_n,
    }
    order = [arguments[name] for name in SLOPE_PARAMETERS]
    figure = {name: sp.Function(name)(*order) for name in SLOPE_FIGURES}
    deviation = sp.sqrt(figure["variance"])
    outputs = {
        "mean_speed": figure["mean"] / r_c,
        "min_speed": figure["low"] / r_c,
        "max_speed": figure["high"] / r_c,
        "speed_deviation": deviation / r_c,
        "speed_volatility": deviation / sp.Abs(figure["mean"]),
        "contact_fraction": figure["contact"],
        "stall_torque": rotor.stall_torque().subs(nomenclature.sym("f")[0], figure["held"]),
    }
    turn = 2 * sp.pi  # frequencies are in Hz
    by = {
        "prepressure": ((F_c, 1), (omega_n, follow["prepressure"][0]), (W, follow["prepressure"][1])),
        "frequency_difference": (
            (Delta_omega, turn),
            (omega_n, follow["frequency_difference"][0]),
            (W, follow["frequency_difference"][1]),
        ),
        "load_torque": ((T_load, 1),),
        "friction_coefficient": ((mu, 1),),
        "amplitude": ((W, 1),),
        "resonance_frequency": ((omega_n, turn),),
    }
    return {
        name: {parameter: sum(expr.diff(symbol) * rate for symbol, rate in rates) for parameter, rates in by.items()}
        for name, expr in outputs.items()
    }


def numbers_for(expr, values, raw):
    """A chained derivative at a point: the unknown functions and their slopes are the driver's numbers."""
    done = {}
    for part in expr.atoms(sp.Subs, sp.Derivative):
        function = part.expr if isinstance(part, sp.Subs) else part
        name = function.expr.func.__name__
        place = function.expr.args.index(function.variables[0])
        done[part] = raw["slopes"][SLOPE_FIGURES.index(name), place]
    expr = expr.xreplace(done)
    expr = expr.replace(
        lambda e: isinstance(e, sp.core.function.AppliedUndef), lambda e: sp.Float(float(raw[e.func.__name__]))
    )
    return float(expr.subs(values).evalf())


def test_product_and_chain_rules_of_the_slopes_are_sympys(trum60, monkeypatch):
    draw = np.random.default_rng(18)
    case = prepare(trum60, ts.Drive(load_torque=0.05), Levels(), 1e-6)
    raw = {name: np.asarray(draw.uniform(0.1, 0.9)) for name in SLOPE_FIGURES}
    raw["mean"] = -raw["mean"]  # a rotor that runs backward
    raw |= {name: np.asarray(0.0) for name in signature("rotor_orbit")[1] if name not in raw}
    raw["slopes"] = draw.uniform(-1, 1, (len(SLOPE_FIGURES), len(SLOPE_PARAMETERS)))
    follow = {name: tuple(draw.uniform(-1, 1, 2)) for name in ("prepressure", "frequency_difference")}
    monkeypatch.setattr(sensitivities, "call_in_blocks", lambda *_, **__: raw)
    monkeypatch.setattr(
        sensitivities, "_following", lambda _: {k: tuple(map(np.asarray, v)) for k, v in follow.items()}
    )
    _, ours = sensitivities.orbit_with_slopes(case)

    symbols = {**case.symbols, "T_load": 0.05, "W": case.stator.W, "omega_n": case.stator.omega_n}
    values = {
        nomenclature.NOMENCLATURE[name].symbol: float(np.asarray(value))
        for name, value in symbols.items()
        if name in nomenclature.NOMENCLATURE
    }
    wanted = chained(follow)
    assert set(wanted) == set(ours)
    for name, derivatives in wanted.items():
        for parameter, expr in derivatives.items():
            expected = numbers_for(expr.doit(), values, raw)
            assert float(ours[name][parameter]) == pytest.approx(expected, rel=1e-12), (name, parameter)


# --- the driver's chain rules: how wave and contact follow prepressure and amplitude -------------------------------
def logarithmic(expr, symbol):
    return sp.simplify(expr.diff(symbol) * symbol / expr)


def test_height_over_full_height_falls_with_the_prepressure_and_rises_with_the_amplitude():
    (F_c,) = nomenclature.sym("F_c")
    for full in (rotor.winkler_full_height(), rotor.hertz_full_height()):
        assert logarithmic(full, F_c) == 1  # so ln(W_c / W_full) has the slope -1
    scale = sp.Symbol("scale", positive=True)
    free = {symbol: scale * symbol for symbol in nomenclature.sym("W f_A_re f_A_im f_B_re f_B_im")}
    symbols = sorted(rotor.wave()["R_v"].free_symbols | rotor.wave()["phi"].free_symbols, key=str)
    point = {symbol: sp.Rational(3 + k, 7 + 2 * k) for k, symbol in enumerate(symbols)}
    for name, slope in (("W_c", 1), ("R_v", 1), ("phi", 0)):  # homogeneous: height and speed 1, phase 0
        expr = rotor.wave()[name]
        once, twice = (float(expr.subs(free).subs(scale, k).subs(point).evalf(30)) for k in (1, 2))
        assert twice == pytest.approx(2**slope * once, rel=1e-14)
    (by_prepressure,) = found(r"TRUM_BY_PREPRESSURE\) height = REAL\((-?\d+)\);")
    (by_amplitude,) = found(r"TRUM_BY_AMPLITUDE\) height = speed = REAL\((-?\d+)\);")
    assert (int(by_prepressure), int(by_amplitude)) == (-1, 1)
    engaged = rotor.filling()["engagement"]
    (of_layer,) = found(r"if \(!hertz\) friction\.E_height = REAL\((-?\d+)\);")
    assert logarithmic(engaged, nomenclature.sym("W_c")[0]) == int(of_layer)


def test_a_steps_rate_of_time_is_the_derivative_of_its_time():
    location, rate = found(r"->z\[j\] = (sigma [^;]*); trial->T\[j\] = lanes->step\.h \* (\([^;]*\));")
    plain = [c_expression(text.replace("lanes->step.curvature", "curvature")) for text in (location, rate)]
    assert sp.expand(plain[0].diff(sp.Symbol("sigma")) - plain[1]) == 0


def test_the_events_cubic_passes_through_its_values_and_its_slope_is_its_derivative():
    value = c_expression(found(r"real trum_cubic_at\(const trum_cubic\* c, real z\) \{ return ([^;]*);")[0])
    inner, slope = found(r"real trum_cubic_slope\([^)]*\) \{ const real inner = ([^;]*); return ([^;]*);")
    slope = c_expression(slope).subs(sp.Symbol("inner"), c_expression(inner))
    z = sp.Symbol("z")
    assert sp.expand(value.diff(z) - slope) == 0
    d01, d12, d23, d012, d123, d3 = (
        c_expression(text)
        for text in found(
            r"const real d01 = ([^,]*), d12 = ([^,]*), d23 = ([^;]*); "
            r"const real d012 = ([^,]*), d123 = ([^;]*); c\.e0 = e0, c\.d1 = d01, c\.d2 = d012, c\.d3 = ([^,]*),"
        )
    )
    z1, z2 = sp.symbols("z1 z2")
    places = dict(zip(("0", "1", "2", "3"), (0, z1, z2, 1), strict=True))
    inverse = {sp.Symbol(f"of_{a}{b}"): 1 / (places[b] - places[a]) for a, b in ("01", "12", "23", "02", "13")}
    first = dict(zip(sp.symbols("d01 d12 d23"), (d01, d12, d23), strict=True))
    second = dict(zip(sp.symbols("d012 d123"), (d.subs(first) for d in (d012, d123)), strict=True))
    parts = {"d1": d01, "d2": second[sp.Symbol("d012")], "d3": d3.subs(second)}
    cubic = value.subs({sp.Symbol(name): part for name, part in parts.items()}).subs(inverse)
    for k, place in enumerate((0, z1, z2, 1)):
        assert sp.cancel(sp.together(cubic.subs(z, place) - sp.Symbol(f"e{k}"))) == 0


def test_the_events_cubic_has_its_minimum_where_its_slope_is_zero_and_rises():
    value = c_expression(found(r"real trum_cubic_at\(const trum_cubic\* c, real z\) \{ return ([^;]*);")[0])
    *coefficients, square, root, at = found(
        r"real trum_cubic_minimum\([^)]*\) \{ const real c3 = ([^,]*), c2 = ([^;]*); const real c1 = ([^,]*), "
        r"square = ([^;]*); const real below = c2 \+ (square_root\(maximum\(square, REAL\(0\)\)\)); .*?"
        r"return where\(exists, (-c1) \* reciprocal\(where\(exists, below, REAL\(1\)\)\), REAL\(-1\)\);"
    )
    assert root
    z, side, c1, c2, c3 = sp.symbols("z side c1 c2 c3")
    typed = [c_expression(text) for text in coefficients]
    assert [
        sp.expand(side * sp.Poly(value, z).coeff_monomial(z**n) - c) for n, c in zip((3, 2, 1), typed, strict=True)
    ] == [0] * 3
    below = c2 + sp.sqrt(c_expression(square))
    slope = c1 + 2 * c2 * z + 3 * c3 * z**2
    place = c_expression(at) / below
    assert sp.simplify(slope.subs(z, place)) == 0
    rise = slope.diff(z).subs(z, place)
    for case in ((1, -2, 1), (-3, 1, 2), (2, -3, -1)):  # it rises, whichever way the cubic turns
        assert rise.subs(dict(zip((c1, c2, c3), case, strict=True))).evalf() > 0


def test_the_margin_of_saturation_is_by_how_much_another_speed_is_as_fast_as_the_surface():
    (least,) = found(
        r"(\(absolute\(v\) \+ square_root\(v \* v \+ least\)\) \* reciprocal\(least \+ REAL\(trum_tiny\)\))\);"
    )
    p, v = sp.symbols("least v", positive=True)
    typed = least.replace("absolute", "Abs").replace("square_root", "sqrt").replace("REAL(trum_tiny)", "0")
    inverse = sp.sympify(typed.replace("reciprocal", "1/"), locals={"v": v, "least": p})
    assert sp.simplify((v + 1 / inverse) ** 2 - v**2 - p) == 0


def test_extremes_are_zeros_of_the_rate_by_its_derivative_and_the_speed_is_its_integral():
    slope, rate = (
        c_expression(text) for text in found(r"const real slope = (p\[1\][^;]*); const real rate = ([^;]*);")
    )
    value = c_expression(found(r"value = x\[0\] \+ (at \* \(p\[0\][^;]*);")[0])
    at = sp.Symbol("at")
    assert sp.expand(rate.diff(at) - slope) == 0
    assert sp.expand(sp.integrate(rate, (at, 0, at)) - value) == 0


def test_no_bristle_sticks_from_the_speed_on_that_the_brush_takes_for_it():
    """There the span in which one would slide on is nothing, and all of the circle at its negative."""
    (square,) = found(r"trum_brush_fastest\(trum_real grip\) \{ return trum_sqrt\(([^;]*)\);")
    grip, ratio = nomenclature.sym("grip ratio")
    fastest = sp.sqrt(c_expression(square).subs(sp.Symbol("grip"), grip))
    for value in (sp.Rational(1, 7), 3, 1000):
        for sign, span in ((1, 0), (-1, sp.pi)):
            at = {grip: value, ratio: sign * fastest.subs(grip, value)}
            assert sp.simplify(brush.turns()["span"].subs(at)) == span
        slower = {grip: value, ratio: fastest.subs(grip, value) - sp.Rational(1, 1000)}
        assert 0 < float(brush.turns()["span"].subs(slower)) < float(sp.pi)
