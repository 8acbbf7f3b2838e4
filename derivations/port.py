"""The electrical port of a phase: charge, current, admittance and power, free and under the rotor (our own).

The ceramic strains along the ring and is free across it, its electrodes drive it along the poling:

    S_1 = s_11E T_1 + d_31 E_3,    D_3 = d_31 T_1 + eps_33T E_3.

What eq. 7's modal force is per volt, the charge is per displacement: the force factor.  The capacitance is that of a
stator that is held still, and stays where the rotor acts back on the wave, since the contact's forces are not the
ceramic's.  A phase draws the current of both.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derivations import amplitude, coupling
from derivations.nomenclature import sym

__all__ = ["PortError", "admittance", "charge", "circuit", "driven", "opened", "ring"]

M_q, F_q, Theta_q, C_0, omega_n0, omega_q, xi, W, lead = sym("M_q F_q Theta_q C_0 omega_n0 omega_q xi W lead")
n_j, k_c, beta, D, h_e, h_p, b_p, c_p = sym("n_j k_c beta D h_e h_p b_p c_p")
d_31, s_11E, U_s, eps_33T, tan_delta = sym("d_31 s_11E U_s eps_33T tan_delta")
x = sym("x")[0]
_E, _w, _z = sp.symbols("E_s w_s z_s", real=True)


class PortError(ArithmeticError):
    """A result is not what the ceramic's equations, or the balance of energy, make it."""


def _zero(expression: sp.Expr, what: str) -> None:
    if sp.simplify(sp.expand(expression)) != 0:
        raise PortError(f"{what}: {sp.simplify(expression)} is not 0")


def ring() -> sp.Expr:
    """Length of the circumference."""
    return 2 * sp.pi * n_j / k_c


@cache
def charge() -> dict[str, sp.Expr]:
    """Of a phase's electrodes: per displacement at no voltage, and per voltage at no displacement.

    D_3 is the same through the thickness, so the strain counts by its mean there, at the middle of the ceramic; the
    half waves are poled in turn and have one electrode.

    Raises
    ------
    PortError
        If the charge per displacement is not the modal force per volt.
    """
    stress, strain, field = sp.symbols("T_s S_s E_s", real=True)
    given = sp.solve(sp.Eq(strain, s_11E * stress + d_31 * field), stress)[0]
    density = sp.expand(d_31 * given + eps_33T * field)
    by_strain, by_field = sp.simplify(density.diff(strain)), sp.simplify(density.diff(field))
    _zero(by_field - (eps_33T - d_31**2 / s_11E), "the permittivity of ceramic that does not strain")
    middle = sp.integrate(_z, (_z, h_e - D, h_e + h_p - D)) / h_p
    bending = beta * k_c * sp.cos(k_c * x)  # of the mode at unit height
    quarter = sp.pi / 2 / k_c
    segment = sp.integrate(bending, (x, -quarter, quarter)) - sp.integrate(bending, (x, quarter, 3 * quarter))
    # d_31's sign turns the charge's as it turns the force's, half a period on
    moved = sp.Abs(d_31) * sp.simplify(by_strain / d_31) * middle * b_p * segment * n_j * c_p
    found = {"Theta_q": sp.simplify(moved), "C_0": c_p * ring() * b_p * by_field / h_p}
    _zero(found["Theta_q"] - coupling.modal()["F_ceramic"] / U_s, "the charge per displacement")
    _zero(amplitude.piezo_moment().diff(U_s, 2), "a moment that is not of first order in the voltage")
    return found


@cache
def circuit() -> dict[str, sp.Expr]:
    """A phase without a rotor as a circuit: C_0 beside L_m, C_m and R_m in series; what open electrodes do.

    ``Theta_q`` is that of the modal force at hand, which may be a measured one.  With open electrodes the charge stays,
    the voltage -Theta_q w / C_0 stiffens the phase, and it swings at ``omega_open``; ``k_eff_square`` is the share
    of the energy put in at low frequency that is stored in the stator.

    Raises
    ------
    PortError
        If the circuit does not draw a phase's current, or does not resonate where the open phase swings.
    """
    inductance, resistance = M_q / Theta_q**2, 2 * xi * omega_n0 * M_q / Theta_q**2
    capacitance = Theta_q**2 / (M_q * omega_n0**2)
    open_ = sp.sqrt(omega_n0**2 + Theta_q**2 / (M_q * C_0))
    series = resistance + sp.I * omega_q * inductance + 1 / (sp.I * omega_q * capacitance)
    mode = M_q * (omega_n0**2 - omega_q**2 + 2 * sp.I * xi * omega_n0 * omega_q)
    _zero(1 / series - sp.I * omega_q * Theta_q**2 / mode, "the branch's admittance")
    lossless = sp.I * omega_q * C_0 + 1 / series.subs(xi, 0)
    _zero(sp.together(lossless.subs(omega_q, open_)), "the admittance where the open phase swings")
    coupled = sp.simplify(capacitance / (C_0 + capacitance))
    _zero(coupled - (1 - omega_n0**2 / open_**2), "the effective coupling factor")
    return {
        "L_m": inductance,
        "C_m": capacitance,
        "R_m": resistance,
        "omega_open": open_,
        "k_eff_square": coupled,
    }


@cache
def opened() -> dict[str, sp.Expr]:
    """What the charge does that open electrodes hold: the stiffness K_o that its voltage adds to a phase.

    Terminals that open at a displacement and a voltage keep the charge Theta_q w + C_0 V of that instant.  From then on
    the modal force Theta_q V is that of the instant less K_o times the way since: an infinite capacitance keeps the
    voltage, and with no voltage at that instant it is a short.

    Raises
    ------
    PortError
        If that is not the force, if it does another work than the capacitance's energy loses, or if the phase does not
        swing about its new rest as :func:`circuit` says.
    """
    w, voltage, w_off, V_off = sp.symbols("w_s V_s w_o V_o", real=True)
    held = sp.Eq(Theta_q * w + C_0 * voltage, Theta_q * w_off + C_0 * V_off)
    then = sp.solve(held, voltage)[0]
    stiffness = Theta_q**2 / C_0
    force = Theta_q * then
    _zero(force - (Theta_q * V_off - stiffness * (w - w_off)), "the force of the charge")
    _zero(sp.integrate(force, (w, w_off, w)) - C_0 / 2 * (V_off**2 - then**2), "the energy of the charge")
    swing = (M_q * omega_n0**2 - force.diff(w)) / M_q
    _zero(swing - circuit()["omega_open"] ** 2, "the open phase's swing")
    return {"K_o": stiffness}


@cache
def admittance() -> dict[str, sp.Expr]:
    """Conductance and susceptance of a phase without a rotor, at omega_q.

    Raises
    ------
    PortError
        If they are not the circuit's, its capacitance with the ceramic's loss.
    """
    gap, damping = omega_n0**2 - omega_q**2, 2 * xi * omega_n0 * omega_q
    swing = omega_q * Theta_q**2 / (M_q * (gap**2 + damping**2))
    found = {
        "conductance": swing * damping + omega_q * C_0 * tan_delta,
        "susceptance": swing * gap + omega_q * C_0,
    }
    parts = circuit()
    series = parts["R_m"] + sp.I * (omega_q * parts["L_m"] - 1 / (omega_q * parts["C_m"]))
    whole = sp.I * omega_q * C_0 * (1 - sp.I * tan_delta) + 1 / series
    _zero(found["conductance"] + sp.I * found["susceptance"] - whole, "the admittance")
    return found


@cache
def driven() -> dict[str, sp.Expr]:
    """What a phase and both phases draw where they make a plain wave of height W, the modal force ahead of it by lead.

    ``conductance``, ``susceptance`` and ``current`` (amplitude) are of one phase; the powers are means of both.
    ``P_reactive`` is positive where the current is behind the voltage.

    Raises
    ------
    PortError
        If the power drawn is not that of the modal forces and the ceramic's loss.
    """
    t = sp.Symbol("t", real=True)
    wave = W * sp.cos(omega_q * t - lead)
    voltage = U_s * sp.cos(omega_q * t)
    flows = Theta_q * wave.diff(t) + C_0 * voltage.diff(t) + omega_q * C_0 * tan_delta * voltage
    period = (t, 0, 2 * sp.pi / omega_q)
    moving = omega_q * Theta_q * W / U_s
    conductance = moving * sp.sin(lead) + omega_q * C_0 * tan_delta
    susceptance = moving * sp.cos(lead) + omega_q * C_0
    _zero(
        sp.integrate(sp.expand(sp.expand_trig(voltage * flows)), period) * omega_q / (2 * sp.pi)
        - U_s**2 * conductance / 2,
        "the power of a phase",
    )
    quarter = voltage.subs(t, t - sp.pi / (2 * omega_q))  # what lags the voltage by a quarter of a period
    _zero(
        sp.integrate(sp.expand(sp.expand_trig(quarter * flows)), period) * omega_q / (2 * sp.pi)
        + U_s**2 * susceptance / 2,
        "the reactive power of a phase",
    )
    size = sp.sqrt(conductance**2 + susceptance**2)
    found = {
        "conductance": conductance,
        "susceptance": susceptance,
        "current": U_s * size,
        "P_electric": U_s**2 * conductance,
        "P_dielectric": U_s**2 * omega_q * C_0 * tan_delta,
        "P_reactive": -(U_s**2) * susceptance,
        "power_factor": conductance / size,
    }
    # the modal forces' power where the wave's balance holds
    parts = coupling.balance()
    balanced = {sp.sin(lead): parts["ahead"] / (Theta_q * U_s)}
    given = (found["P_electric"] - found["P_dielectric"]).expand().subs(balanced)
    _zero(given - coupling.powers()["P_in"], "the electrical power less the ceramic's loss")
    return found
