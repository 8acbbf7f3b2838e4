"""What eq. 7 leaves out of the ceramic: the charge of its electrodes, and so a phase's current and power."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath as mp
import sympy as sp

from derivations import beam, coupling, port
from derivations.ledger.judge import Point, agrees, figure, vanishes
from derivations.ledger.model import Derivation, Entry, Evidence, Forms, evidence, step
from derivations.ledger.operating import at_point, operating_point
from derivations.nomenclature import sym

__all__ = ["ENTRIES"]

M_q, F_q, Theta_q, C_0, omega_n0, omega_q, xi, W, lead = sym("M_q F_q Theta_q C_0 omega_n0 omega_q xi W lead")
n_j, k_c, beta, D, h_e, h_p, b_p, c_p = sym("n_j k_c beta D h_e h_p b_p c_p")
d_31, s_11E, U_s, eps_33T, tan_delta = sym("d_31 s_11E U_s eps_33T tan_delta")
_RANGES = {
    "M_q": (0.03, 0.2),
    "Theta_q": (0.4, 1.6),
    "C_0": (5e-9, 3e-8),
    "omega_n0": (2.3e5, 2.6e5),
    "lead": (-3.0, 3.0),
    "tan_delta": (0.1, 0.9),
}


def _derive() -> Derivation:
    charge, circuit, free, driven = port.charge(), port.circuit(), port.admittance(), port.driven()
    forms = {
        "Theta_q": charge["Theta_q"],
        "C_0": charge["C_0"],
        "omega_open": circuit["omega_open"],
        "conductance": free["conductance"],
        "susceptance": free["susceptance"],
        "P_electric": driven["P_electric"],
        "P_reactive": driven["P_reactive"],
    }
    parts = coupling.balance()
    balanced = {sp.sin(lead): parts["ahead"] / (Theta_q * U_s)}
    given = (driven["P_electric"] - driven["P_dielectric"]).expand().subs(balanced)
    return Derivation(
        (
            step(
                "The strain along the ring is the mode's; solved for the stress, the ceramic's equations leave the "
                "charge on the electrodes, per displacement and per voltage of a stator that is held still:",
                sp.Eq(Theta_q, forms["Theta_q"]),
                sp.Eq(C_0, forms["C_0"]),
            ),
            step(
                "The charge per displacement is the modal force per volt of eq. 7 put right:",
                zero=charge["Theta_q"] - coupling.modal()["F_ceramic"] / U_s,
            ),
            step(
                "Without a rotor a phase draws the charge of its motion and that of its capacitance, with the loss of "
                "the ceramic; its real and imaginary part:",
                forms["conductance"],
                forms["susceptance"],
            ),
            step(
                "With open electrodes the charge stays, and the voltage that it makes stiffens the phase:",
                forms["omega_open"],
            ),
            step(
                "Both phases of a plain wave, whose modal force is ahead of it by an angle, draw, active and reactive:",
                forms["P_electric"],
                forms["P_reactive"],
            ),
            step(
                "Less the ceramic's loss, that is what the modal forces put in:",
                zero=given - coupling.powers()["P_in"],
            ),
        ),
        forms,
    )


def _held(q: Point, strain: mp.mpf, field: mp.mpf) -> mp.mpf:
    """Charge per area at a strain and a field, by the ceramic's two equations as a linear system."""
    matrix = mp.matrix([[q[s_11E], 0], [-q[d_31], 1]])
    _, density = mp.lu_solve(matrix, mp.matrix([strain - q[d_31] * field, q[eps_33T] * field]))
    return density


def _reference(name: str, q: Point) -> mp.mpf:
    if name == "Theta_q":
        low = q[h_e] - q[D]

        def on(angle: mp.mpf) -> mp.mpf:
            """Mean through the thickness, by Simpson's rule."""
            places = ((low, 1), (low + q[h_p] / 2, 4), (low + q[h_p], 1))
            parts = (weight * _held(q, z * q[beta] * mp.cos(angle), mp.mpf(0)) for z, weight in places)
            return abs(mp.fsum(parts)) / 6

        wave = mp.quad(on, [-mp.pi / 2, 0, mp.pi / 2]) * 2
        return q[n_j] * q[c_p] * q[b_p] * wave  # k_c of the curvature and of the angle cancel
    if name == "C_0":
        around = 2 * mp.pi * q[n_j] / q[k_c]
        return around * q[b_p] * q[c_p] * _held(q, mp.mpf(0), 1 / q[h_p])
    if name == "omega_open":

        def energy(w: mp.mpf) -> mp.mpf:
            return q[M_q] * (q[omega_n0] * w) ** 2 / 2 + (1 - q[Theta_q] * w) ** 2 / q[C_0] / 2

        with mp.workdps(80):
            return mp.sqrt(mp.diff(energy, 0, 2) / q[M_q])
    if name in ("conductance", "susceptance"):
        return _drawn(name, q)
    return _power(name, q)


def _drawn(name: str, q: Point) -> mp.mpf:
    """Displacement and charge at one volt, from the equations of motion and of the electrodes."""
    turn = q[omega_q]
    dynamic = mp.mpc(q[M_q] * (q[omega_n0] ** 2 - turn**2), 2 * q[xi] * q[omega_n0] * q[M_q] * turn)
    capacitance = q[C_0] * mp.mpc(1, -q[tan_delta])
    found = mp.lu_solve(mp.matrix([[dynamic, 0], [-q[Theta_q], 1]]), mp.matrix([q[Theta_q], capacitance]))
    current = mp.mpc(0, turn) * found[1]
    return current.real if name == "conductance" else current.imag


def _power(name: str, q: Point) -> mp.mpf:
    """Mean over a period of what both phases' voltages drive, or of what lags them by a quarter."""
    lag = 0 if name == "P_electric" else mp.pi / 2

    def at(angle: mp.mpf) -> mp.mpf:
        motion = -q[Theta_q] * q[omega_q] * q[W] * mp.sin(angle - q[lead])
        own = q[omega_q] * q[C_0] * q[U_s] * (q[tan_delta] * mp.cos(angle) - mp.sin(angle))
        return q[U_s] * mp.cos(angle - lag) * (motion + own)

    angles = mp.linspace(0, 2 * mp.pi, 9)[:-1]  # evenly spaced: exact for what has two harmonics
    return 2 * mp.fsum(map(at, angles)) / len(angles)


def _judge(forms: Forms) -> Iterator[Evidence]:
    symbols = {
        "Theta_q": (n_j, c_p, b_p, beta, D, h_e, h_p, d_31, s_11E, eps_33T),
        "C_0": (n_j, c_p, b_p, k_c, h_p, d_31, s_11E, eps_33T),
        "omega_open": (omega_n0, Theta_q, C_0, M_q),
        **dict.fromkeys(("conductance", "susceptance"), (omega_n0, omega_q, xi, Theta_q, C_0, M_q, tan_delta)),
        **dict.fromkeys(("P_electric", "P_reactive"), (omega_q, Theta_q, C_0, U_s, W, lead, tan_delta)),
    }
    against = {
        "Theta_q": "the charge summed over electrodes and thickness",
        "C_0": "the charge of ceramic that is held still",
        "omega_open": "the energy's curvature at a charge",
        "conductance": "both equations as a linear system",
        "susceptance": "both equations as a linear system",
        "P_electric": "voltage times current over a period",
        "P_reactive": "voltage a quarter of a period ago times current",
    }
    for name, words in against.items():
        yield agrees({name: forms[name]}, _reference, symbols=symbols[name], ranges=_RANGES, count=4, against=words)
    still = forms["susceptance"].subs(omega_q, sp.Symbol("e_s", positive=True))
    low = sp.limit(still / sp.Symbol("e_s", positive=True), sp.Symbol("e_s", positive=True), 0)
    yield evidence(
        "limit",
        vanishes(low - C_0 - Theta_q**2 / (M_q * omega_n0**2)),
        "at low frequency a phase is the capacitance of ceramic that is held, and of the motion beside it",
    )


def _effect() -> str:
    q = operating_point()
    own = at_point(beam.resonance()["quartic"], {**q, "k_f": mp.mpf(0)})
    whole = {**q, "omega_n0": own, "c_p": mp.mpf(1)}
    modal = {name: at_point(expr, whole) for name, expr in coupling.modal().items()}
    charge = {name: at_point(expr, whole) for name, expr in port.charge().items()}
    around = {**whole, "M_q": modal["M_q"], **charge}
    circuit = {name: at_point(expr, around) for name, expr in port.circuit().items()}
    drawn = q["U_s"] / circuit["R_m"]
    return (
        f"A phase that covers the whole ring has {figure(charge['Theta_q'])} N/V by the ceramic's data, and "
        f"{figure(modal['F_measured'] / q['U_s'])} N/V by the {figure(1e6 * q['W_max'])} um measured. Held still it is "
        f"a capacitor of {figure(1e9 * charge['C_0'])} nF, of {figure(1e9 * charge['C_0'] * 4 / 9)} nF under four of "
        f"nine waves. At resonance without a rotor its motion is {figure(circuit['R_m'])} ohm and draws "
        f"{figure(drawn)} A at {figure(q['U_s'])} V, {figure(q['U_s'] * drawn / 2)} W a phase. Open, it swings "
        f"{figure((circuit['omega_open'] - own) / (2 * mp.pi), 3)} Hz higher, by an effective coupling factor of "
        f"{figure(mp.sqrt(circuit['k_eff_square']), 3)}."
    )


ENTRIES = (
    Entry(
        id="electrical-port",
        section="2.3",
        title="The electrical port of a phase: force factor, capacitance, admittance, power",
        place="left out by eq. 7, which takes a voltage and asks for no current; ours",
        printed={},
        units={
            "Theta_q": "N/V",
            "C_0": "F",
            "omega_open": "rad/s",
            "conductance": "S",
            "susceptance": "S",
            "P_electric": "W",
            "P_reactive": "W",
        },
        verdict="reconstructed",
        reason="The paper drives the ceramic by a voltage. What the electrodes draw follows from the same integral: "
        "the charge per displacement is the modal force per volt.",
        judge=_judge,
        derive=_derive,
        effect=_effect,
    ),
)
