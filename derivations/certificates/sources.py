"""What the certificates are made of: letters, what is given, and claims."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

__all__ = ["SOURCES", "Claim", "Source"]


@dataclass(frozen=True)
class Claim:
    """A goal that is 0, or above 0 where ``equals`` is not empty; both factors as in the checker."""

    name: str
    says: str
    goal: str
    times: tuple[tuple[str, tuple[int, ...], str], ...] = (("1", (), "1"),)
    equals: tuple[tuple[str, tuple[int, ...], str], ...] = ()


@dataclass(frozen=True)
class Source:
    """A certificate before its multipliers are found."""

    name: str
    title: str
    about: tuple[str, ...]  # entries
    letters: Mapping[str, str]  # letter -> its meaning in the ledger's symbols
    claims: tuple[Claim, ...]
    forms: Mapping[str, tuple[str, str]] = field(default_factory=dict)  # letter -> entry and form that it stands for
    given: tuple[str, ...] = ()
    positive: tuple[str, ...] = ()
    rates: Mapping[str, str] = field(default_factory=dict)
    domain: Mapping[str, tuple[float, float]] = field(default_factory=dict)  # of the symbols in the meanings
    refutes: tuple[str, ...] = ()  # claims that the printed form of a letter's erratum fails
    order: str = ""  # letters that what is given eliminates, first to last


_TURN = "s^2 + c^2 - 1"
SOURCES: tuple[Source, ...] = (
    Source(
        "determinant",
        "Q does not depend on the particle, and is the crest's height times its speed",
        ("A5", "24", "42", "22"),
        {
            "a": "w_A",
            "b": "w_B",
            "g": "v_A",
            "h": "v_B",
            "s": "sin(k_c*x)",
            "c": "cos(k_c*x)",
            "d": "D*k_c",
            "z": "w_A*sin(k_c*x) + w_B*cos(k_c*x)",
            "x": "D*k_c*(w_A*cos(k_c*x) - w_B*sin(k_c*x))",
            "l": "v_A*sin(k_c*x) + v_B*cos(k_c*x)",
            "k": "D*k_c*(v_A*cos(k_c*x) - v_B*sin(k_c*x))",
            "w": "sqrt(w_A**2 + w_B**2)",
            "S": "w_A/sqrt(w_A**2 + w_B**2)",
            "C": "w_B/sqrt(w_A**2 + w_B**2)",
        },
        (
            Claim(
                "anywhere",
                "(A5) with the displacements of (11): xi_x' xi_z - xi_z' xi_x is the same at every x",
                "k*z - l*x - d*(g*b - h*a)",
            ),
            Claim(
                "crest",
                "(42): at the crest, whose sine and cosine are S and C, height times tangential velocity is that Q",
                "w*d*(g*C - h*S) - d*(g*b - h*a)",
            ),
            Claim(
                "height", "(21): the wave's displacement there is its height", "(a*S + b*C) - w", (("1", (0,), "1"),)
            ),
        ),
        given=(
            _TURN,
            "z - (a*s + b*c)",
            "x - d*(a*c - b*s)",
            "l - (g*s + h*c)",
            "k - d*(g*c - h*s)",
            "w*S - a",
            "w*C - b",
            "w^2 - a^2 - b^2",
        ),
        positive=("w",),
        order="zxlks",
    ),
    Source(
        "two-phases",
        "The determinant of two harmonic phases as a slow and a fast term",
        ("A6",),
        {
            "P": "W_a",
            "R": "W_b",
            "m": "omega_a",
            "n": "omega_b",
            "s": "sin(omega_a*t + varphi_a)",
            "c": "cos(omega_a*t + varphi_a)",
            "S": "sin(omega_b*t + varphi_b)",
            "C": "cos(omega_b*t + varphi_b)",
            "d": "D*k_c",
            "u": "sin(omega_a*t + varphi_a + omega_b*t + varphi_b)",
            "v": "sin(omega_b*t + varphi_b - omega_a*t - varphi_a)",
        },
        (
            Claim(
                "sum and difference",
                "(A6): v_A w_B - v_B w_A, times D k_c, with sines of sum and difference of both angles",
                "2*Q - d*P*R*((n - m)*u + (n + m)*v)",
            ),
        ),
        forms={"Q": ("A6", "Q_q")},
        given=("Q - d*((-P*m*s)*(R*C) - (-R*n*S)*(P*c))", "u - (s*C + c*S)", "v - (S*c - C*s)"),
        order="Quv",
    ),
    Source(
        "speed-determinant",
        "Q_aver in X, and that it grows with X",
        ("43", "A14", "A15"),
        {
            "p": "q_plus",
            "q": "q_minus",
            "T": "T",
            "X": "q_plus/q_minus",
            "Q": "(q_plus - q_minus)/((q_plus + q_minus)*T)",
        },
        (Claim("in X", "(A14): Q_aver (X + 1) T = X - 1", "Q*(X + 1)*T - (X - 1)", (("1", (0,), "1"),)),),
        given=("X*q - p", "Q*(p + q)*T - (p - q)"),
        positive=("q", "p", "T"),
        domain={"q_plus": (0.1, 3), "q_minus": (0.1, 3), "T": (0.3, 2)},
    ),
    Source(
        "speed-slope",
        "The derivative of Q_aver by X, positive for every X > 0",
        ("A15",),
        {"X": "X", "T": "T", "Q": "(X - 1)/((X + 1)*T)"},
        (
            Claim("slope", "(A15): dQ_aver/dX (X + 1)^2 T = 2", "F*(X + 1)^2*T - 2"),
            Claim(
                "sign",
                "and it is positive",
                "F",
                (("1", (0, 0, 1), "1"), ("2", (0, 1), "1"), ("1", (1,), "1")),
                (("2", (), "1"),),
            ),
        ),
        forms={"F": ("A15", "dQ_aver/dX")},
        given=("Q*(X + 1)*T - (X - 1)",),
        positive=("X", "T"),
        rates={"X": "1", "Q": "F"},
        domain={"X": (0.1, 5), "T": (0.3, 2)},
    ),
    Source(
        "volatility-ratio",
        "Q_vib's root in Y: the same, real only with the magnitude",
        ("44", "A16"),
        {
            "p": "p_plus",
            "q": "p_minus",
            "Y": "p_plus/p_minus",
            "f": "sqrt((p_plus + p_minus)/(p_plus - p_minus))",
        },
        (
            Claim(
                "in Y",
                "(44) squared is (A16) squared: f^2 (Y - 1) = Y + 1",
                "f^2*(Y - 1) - (Y + 1)",
                (("1", (0,), "1"),),
            ),
        ),
        given=("Y*q - p", "f^2*(p - q) - (p + q)"),
        positive=("q", "p", "p - q"),
        domain={"p_plus": (2.1, 3), "p_minus": (0.1, 2)},
    ),
    Source(
        "imaginary",
        "The printed root has no real value for Y < 1",
        ("44", "A16"),
        {"f": "sqrt((Y + 1)/(Y - 1))", "Y": "Y"},
        (
            Claim(
                "no real f",
                "for 0 < Y < 1 no real f has f^2 (Y - 1) = Y + 1",
                "-1",
                (("1", (), "1"),),
                (("1", (1,), "f"), ("1", (0,), "1")),
            ),
        ),
        given=("f^2*(Y - 1) - (Y + 1)",),
        positive=("Y", "1 - Y"),
        domain={"Y": (0.1, 0.9)},
    ),
    Source(
        "root-above",
        "f = sqrt((Y + 1)/(Y - 1)) and its derivative for Y > 1",
        ("A16", "A17", "44"),
        {"Y": "Y", "f": "sqrt((Y + 1)/(Y - 1))", "r": "sqrt(Y**2 - 1)"},
        (
            Claim("f in r", "f (Y - 1) = sqrt(Y^2 - 1)", "f*(Y - 1) - r", (("1", (0, 1), "1"), ("1", (2,), "1"))),
            Claim("slope", "(A17) put right: df/dY (Y - 1) sqrt(Y^2 - 1) = -1", "F*(Y - 1)*r + 1", (("1", (1,), "1"),)),
            Claim("sign", "f falls", "-F", (("1", (1, 2), "1"),), (("1", (), "1"),)),
        ),
        forms={"F": ("A17", "df/dY")},
        given=("f^2*(Y - 1) - (Y + 1)", "r^2 - Y^2 + 1"),
        positive=("f", "Y - 1", "r"),
        rates={"Y": "1", "f": "F", "r": "G"},
        domain={"Y": (1.1, 5)},
        refutes=("slope",),
    ),
    Source(
        "root-below",
        "f = sqrt((Y + 1)/(1 - Y)) and its derivative for 0 < Y < 1",
        ("A16", "A17", "44"),
        {"Y": "Y", "f": "sqrt((Y + 1)/(1 - Y))", "r": "sqrt(1 - Y**2)"},
        (
            Claim("f in r", "f (1 - Y) = sqrt(1 - Y^2)", "f*(1 - Y) - r", (("1", (0, 1), "1"), ("1", (2,), "1"))),
            Claim("slope", "(A17) put right: df/dY (1 - Y) sqrt(1 - Y^2) = 1", "F*(1 - Y)*r - 1", (("1", (1,), "1"),)),
            Claim("sign", "f rises", "F", (("1", (1, 2), "1"),), (("1", (), "1"),)),
        ),
        forms={"F": ("A17", "df/dY")},
        given=("f^2*(1 - Y) - (Y + 1)", "r^2 + Y^2 - 1"),
        positive=("f", "1 - Y", "r"),
        rates={"Y": "1", "f": "F", "r": "G"},
        domain={"Y": (0.1, 0.9)},
        refutes=("slope",),
    ),
    Source(
        "friction",
        "The friction's closed form, and what doubling a half of the contact does to it",
        ("36", "transfer-cases"),
        {
            "s": "sin(phi)",
            "c": "cos(phi)",
            "S": "sin(u)",
            "C": "cos(u)",
            "e": "cos(theta)",
            "p": "phi",
            "a": "u",
            "L": "sin(theta) - theta*cos(theta)",
            "j": "(sin(phi + u) - (phi + u)*cos(theta) + sin(theta) - theta*cos(theta))/(2*(sin(theta) - "
            "theta*cos(theta)))",
            "k": "(sin(phi - u) - (phi - u)*cos(theta) + sin(theta) - theta*cos(theta))/(2*(sin(theta) - "
            "theta*cos(theta)))",
            "f": "2*(cos(phi)*sin(u) - u*cos(theta))/(sin(theta) - theta*cos(theta)) - 1",
            "h": "2*(sin(phi + u) - (phi + u)*cos(theta))/(sin(theta) - theta*cos(theta)) - 1",
        },
        (
            Claim(
                "closed form",
                "u from phi - a to phi + a drives, the rest brakes: L f = 2 (cos(phi) sin(a) - a cos(theta)) - L",
                "L*(2*(j - k) - 1) - (2*(c*S - a*e) - L)",
            ),
            Claim("the same f", "f is that share", "f - (2*(j - k) - 1)", (("1", (0,), "1"),)),
            Claim(
                "doubled half",
                "twice the half 0 < u < theta is off by 2 (sin(phi) cos(a) - phi cos(theta)) over L: nothing for phi "
                "= 0",
                "L*(h - f) - 2*(s*C - p*e)",
            ),
        ),
        given=(
            "2*L*j - ((s*C + c*S) - (p + a)*e + L)",
            "2*L*k - ((s*C - c*S) - (p - a)*e + L)",
            "L*f - (2*(c*S - a*e) - L)",
            "L*h - (2*((s*C + c*S) - (p + a)*e) - L)",
        ),
        positive=("L",),
        domain={"phi": (-0.2, 0.2), "u": (0.05, 0.3), "theta": (0.6, 1.4)},
    ),
    Source(
        "friction-slope",
        "A faster rotor is never driven more: the closed form falls as its driving stretch narrows",
        ("rotor-orbit", "36"),
        {
            "s": "sin(phi)",
            "c": "cos(phi)",
            "S": "sin(u)",
            "C": "cos(u)",
            "e": "cos(theta)",
            "a": "u",
            "L": "sin(theta) - theta*cos(theta)",
            "f": "2*(cos(phi)*sin(u) - u*cos(theta))/(sin(theta) - theta*cos(theta)) - 1",
            "F": "2*(cos(phi)*cos(u) - cos(theta))/(sin(theta) - theta*cos(theta))",
        },
        (
            Claim(
                "slope",
                "L df/da is the pressure at both ends, cos(phi + a) - cos(theta) and cos(phi - a) - cos(theta)",
                "L*F - (((c*C - s*S) - e) + ((c*C + s*S) - e))",
            ),
            Claim(
                "sign",
                "which is positive where both ends lie in the contact",
                "F",
                (("1", (0,), "1"),),
                (("1", (1,), "1"), ("1", (2,), "1")),
            ),
        ),
        given=("L*f - (2*(c*S - a*e) - L)",),
        positive=("L", "c*C - s*S - e", "c*C + s*S - e"),
        rates={"a": "1", "S": "C", "C": "-S", "f": "F"},
        domain={"phi": (-0.2, 0.2), "u": (0.05, 0.3), "theta": (0.6, 1.4)},
    ),
    Source(
        "conic",
        "The printed conic: on the motion at every instant, but the square of a straight line",
        ("23", "A12", "A13"),
        {
            "a": "P_A",
            "b": "P_B",
            "s": "sin(k_c*x)",
            "c": "cos(k_c*x)",
            "d": "D*k_c",
            "z": "P_A*sin(k_c*x) + P_B*cos(k_c*x)",
            "x": "D*k_c*(P_A*cos(k_c*x) - P_B*sin(k_c*x))",
            "A": "P_A**2/(D*k_c)**2",
            "B": "2*P_A*P_B/(D*k_c)",
            "E": "P_B**2",
        },
        (
            Claim(
                "line",
                "(A12), summed: P_A zeta_x/(D k_c) + P_B zeta_z = (P_A^2 + P_B^2) cos(k_c x)",
                "a*x + d*b*z - d*(a^2 + b^2)*c",
            ),
            Claim(
                "conic",
                "squared, (A13): A zeta_x^2 + P_B^2 zeta_z^2 + B zeta_x zeta_z = ((P_A^2 + P_B^2) cos(k_c x))^2",
                "A*x^2 + E*z^2 + B*x*z - ((a^2 + b^2)*c)^2",
                (("1", (0, 0), "1"),),
            ),
            Claim(
                "degenerate",
                "B^2 - 4 A C = 0: parallel lines, not an ellipse",
                "B^2 - 4*A*E",
                (("1", (0, 0), "1"),),
            ),
        ),
        given=(_TURN, "z - (a*s + b*c)", "x - d*(a*c - b*s)", "A*d^2 - a^2", "B*d - 2*a*b", "E - b^2"),
        positive=("d",),
        order="ABExzs",
    ),
    Source(
        "ellipse",
        "The path's own conic, and that it is an ellipse",
        ("A13",),
        {
            "P": "W_a",
            "R": "W_b",
            "s": "sin(omega_a*t)",
            "c": "cos(omega_a*t)",
            "S": "sin(varphi_b)",
            "C": "cos(varphi_b)",
            "a": "W_a*cos(omega_a*t)",
            "b": "W_b*cos(omega_a*t + varphi_b)",
            "l": "1/W_a**2",
            "m": "-2*cos(varphi_b)/(W_a*W_b)",
            "n": "1/W_b**2",
        },
        (
            Claim(
                "invariant",
                "phases W_a cos(alpha), W_b cos(alpha + delta) keep a conic that is free of alpha",
                "R^2*a^2 + P^2*b^2 - 2*P*R*C*a*b - P^2*R^2*S^2",
            ),
            Claim(
                "discriminant",
                "of that conic B^2 - 4 A C is minus 4 sin(delta)^2 over (W_a W_b)^2",
                "P^2*R^2*(m^2 - 4*l*n) + 4*S^2",
            ),
        ),
        given=(_TURN, "S^2 + C^2 - 1", "a - P*c", "b - R*(c*C - s*S)", "l*P^2 - 1", "n*R^2 - 1", "m*P*R + 2*C"),
        positive=("P", "R"),
        order="mlnabsS",
    ),
)
