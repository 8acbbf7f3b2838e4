"""Proofs of the kernels of the electrical port: force factor, capacitance, circuit, admittance, what a wave draws."""

from __future__ import annotations

from collections.abc import Mapping

import mpmath as mp

from derivations.proofs.maths import Maths, Number, Point
from derivations.proofs.proof import Proof, grid

__all__ = ["PROOFS"]

Found = Mapping[str, Number | None]


def _port(p: Point, m: Maths) -> Found:
    """A force's work per volt; the charge at one volt of ceramic that is held by its stress, over the electrodes."""
    field = 1 / p.h_p  # at one volt
    stress = -p.d_31 * field / p.s_11E  # at which it does not strain
    density = p.d_31 * stress + p.eps_33T * field
    around = m.integral(lambda angle: density * angle**0, 0 * p.k_c, 2 * m.pi) / p.k_c
    return {"Theta_q": p.F_q / p.U_s, "C_0": p.c_p * p.n_j * p.b_p * around}


def _circuit(p: Point, m: Maths) -> Found:
    """Energies and times of the mode at a current of Theta_q times its speed, and of its stiffness at a charge."""
    inductance = p.M_q / p.Theta_q**2  # L i^2 = M v^2
    held = p.M_q * p.omega_n0**2 / p.Theta_q**2  # q^2 / C = K w^2
    # the open phase: its own stiffness and that of the voltage its charge makes
    stiffness = m.derivative(lambda w: (p.M_q * p.omega_n0**2) * w + p.Theta_q * (p.Theta_q * w / p.C_0), 0 * p.C_0)
    at_rest = p.Theta_q / (p.M_q * p.omega_n0**2)  # displacement of one volt
    stored, whole = p.Theta_q * at_rest, p.C_0 + p.Theta_q * at_rest
    return {
        "L_m": inductance,
        "C_m": 1 / held,
        "R_m": 2 * p.xi * m.sqrt(inductance * held),
        "omega_open": m.sqrt(stiffness / p.M_q),
        "k_eff_square": stored / whole,
    }


def _opened(p: Point, m: Maths) -> Found:
    """Slope of the force that is the slope of the energy of a capacitance whose charge stays."""

    def force(w: Number) -> Number:
        return -m.derivative(lambda at: (p.C_0 - p.Theta_q * at) ** 2 / (2 * p.C_0), w)  # of the charge of one volt

    return {"K_o": -m.derivative(force, 0 * p.C_0)}


def _free(p: Point, m: Maths) -> Found:  # noqa: ARG001
    """Motional and held charge as complex numbers, times i omega_q."""
    mode = p.M_q * mp.mpc(p.omega_n0**2 - p.omega_q**2, 2 * p.xi * p.omega_n0 * p.omega_q)
    drawn = mp.mpc(0, p.omega_q) * (p.Theta_q * (p.Theta_q / mode) + p.C_0 * mp.mpc(1, -p.tan_delta))
    return {"conductance": drawn.real, "susceptance": drawn.imag}


def _plain(p: Point, m: Maths) -> Found:
    """Means over a period of voltage times current, of the voltage a quarter of a period before, and of the squares."""
    period = 2 * m.pi / p.omega_q

    def voltage(t: Number) -> Number:
        return p.U_s * m.cos(p.omega_q * t)

    def leaking(t: Number) -> Number:
        return p.omega_q * p.C_0 * p.tan_delta * voltage(t)

    def current(t: Number) -> Number:
        wave = -p.omega_q * p.W * m.sin(p.omega_q * t - p.lead)
        return p.Theta_q * wave - p.C_0 * p.omega_q * p.U_s * m.sin(p.omega_q * t) + leaking(t)

    def mean(first: Number, second: Number) -> Number:
        return m.integral(lambda t: first(t) * second(t), 0 * period, period) / period

    active, size = mean(voltage, current), mean(current, current)
    behind = mean(lambda t: p.U_s * m.sin(p.omega_q * t), current)
    square = mean(voltage, voltage)
    return {
        "conductance": active / square,
        "susceptance": -behind / square,
        "current": m.sqrt(2 * size),
        "P_electric": 2 * active,
        "P_dielectric": 2 * mean(voltage, leaking),
        "P_reactive": 2 * behind,
        "power_factor": active / m.sqrt(square * size),
    }


_RESTS = "electrical-port"
PROOFS = (
    Proof(
        "trum_port",
        "Theta_q C_0",
        f"7 {_RESTS}",
        "force per volt; charge per volt of ceramic that does not strain, over the electrodes",
        _port,
        grid("F_q U_s b_p c_p d_31 eps_33T h_p k_c n_j s_11E"),
        "random points around TRUM-60",
        symbolic=True,
    ),
    Proof(
        "trum_port_circuit",
        "L_m C_m R_m omega_open k_eff_square",
        _RESTS,
        "energies of the mode at a current; stiffness of a phase that keeps its charge; energy stored at rest",
        _circuit,
        grid("C_0 M_q Theta_q omega_n0 xi"),
        "random points around TRUM-60",
    ),
    Proof(
        "trum_port_open",
        "K_o",
        _RESTS,
        "curvature of the energy of a capacitance whose charge stays",
        _opened,
        grid("C_0 Theta_q"),
        "random points around TRUM-60",
    ),
    Proof(
        "trum_free_admittance",
        "conductance susceptance",
        _RESTS,
        "motional and held charge as complex numbers",
        _free,
        grid("C_0 M_q Theta_q omega_n0 omega_q tan_delta xi", 12),
        "random points around TRUM-60",
    ),
    Proof(
        "trum_plain_port",
        "conductance susceptance current P_electric P_dielectric P_reactive power_factor",
        _RESTS,
        "means over a period of voltage times current, now and a quarter of a period before",
        _plain,
        grid("C_0 Theta_q U_s W lead omega_q tan_delta", 12),
        "random points around TRUM-60",
    ),
)
