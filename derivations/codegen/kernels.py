"""The kernels: which expressions become C functions, with their arguments and outputs.

One kernel is one C function in one file of the same name.  Arguments are the symbols that the
expressions contain, sorted by name, so that nothing is listed twice.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache

import sympy as sp

from derivations import (
    amplitude,
    beam,
    bench,
    brush,
    contact,
    coupling,
    determinant,
    flange,
    layer,
    phases,
    port,
    rotor,
    section,
    square_roots,
    surface,
)
from derivations.nomenclature import CONSTANTS, NOMENCLATURE, sym

__all__ = ["Kernel", "kernels"]


def _quotient(unit: str, by: str) -> str:
    """Of units; the second has one name, or is a quotient of two."""
    above, _, below = by.partition("/")
    return f"{below}*{unit}/{above}" if below else f"{unit}/{above}"


@dataclass(frozen=True)
class Kernel:
    """Expressions that are evaluated together.

    Attributes
    ----------
    name : str
        Of the C function and its file.
    title : str
        What it computes, with the paper's equation numbers.
    outputs : mapping of str to sympy.Expr
        Named results, in order.
    units : mapping of str to str
        Their SI units.
    inconsistent : tuple of str
        Outputs that the paper prints with inconsistent dimensions, kept to show what they give.
    along : mapping of str to mapping of Symbol to Expr
        Directions by name, each with the rates at which symbols of the outputs change along it (the others stay).  A
        kernel with directions computes the outputs' derivatives along them, and not the outputs.
    """

    name: str
    title: str
    outputs: Mapping[str, sp.Expr]
    units: Mapping[str, str]
    inconsistent: tuple[str, ...] = ()
    along: Mapping[str, Mapping[sp.Symbol, sp.Expr]] = field(default_factory=dict)

    @property
    def results(self) -> dict[str, str]:
        """Names of what the kernel computes, with units."""
        if not self.along:
            return {name: self.units[name] for name in self.outputs}
        return {
            f"{name}_{direction}": _quotient(self.units[name], NOMENCLATURE[direction].unit)
            for direction in self.along
            for name in self.outputs
        }

    @property
    def inputs(self) -> tuple[sp.Symbol, ...]:
        """The free symbols, sorted by name, without the constants."""
        rates = [sp.sympify(rate) for direction in self.along.values() for rate in direction.values()]
        found = set().union(*(sp.sympify(expr).free_symbols for expr in [*self.outputs.values(), *rates]))
        return tuple(sorted(found - set(CONSTANTS), key=lambda symbol: symbol.name))


def _section() -> list[Kernel]:
    units = {"E": "Pa", "rho": "kg/m^3", "I_z": "m^4", "G": "Pa", "A": "m^2", "E_eq": "Pa"}
    return [
        Kernel("trum_neutral_axis", "Neutral axis (eq. 1)", {"D": section.neutral_axis()}, {"D": "m"}),
        Kernel("trum_section", "Composite section (eq. 2)", section.section(), units),
        Kernel("trum_wavenumber", "Wavenumber (below eq. 4)", {"k_c": contact.wavenumber()}, {"k_c": "1/m"}),
    ]


def _resonance() -> list[Kernel]:
    levels = beam.resonance()
    omega_n = sym("omega_n")[0]
    beta = beam.rotation_ratio().subs(omega_n, levels["quartic"])
    return [
        Kernel(
            "trum_resonance",
            "Resonance at every level (eqs. 3 to 6) and the mode's rotation ratio",
            {**levels, "beta": beta},
            {**dict.fromkeys(levels, "rad/s"), "beta": "1/m"},
            inconsistent=("printed",),
        )
    ]


def _amplitude() -> list[Kernel]:
    forced = amplitude.under_prepressure(amplitude.forced())
    return [
        Kernel("trum_amplitude_measured", "Measured amplitude (eq. 8)", {"W": amplitude.measured()}, {"W": "m"}),
        Kernel("trum_amplitude_forced", "Forced amplitude (eqs. 7, 8)", {"W": forced}, {"W": "m"}),
    ]


def _contact() -> list[Kernel]:
    residual, slope = contact.winkler_balance()
    theta = contact.hertz_half_angle()
    units = {"harmonic": "N/m^2", "smeared": "N/m^2", "printed": "N/m"}
    return [
        Kernel(
            "trum_layer_stiffness", "Layer stiffness (eq. 30)", {"k_N": contact.layer_stiffness()}, {"k_N": "N/m^2"}
        ),
        Kernel(
            "trum_winkler_balance",
            "Load balance of the Winkler layer and its slope (eq. 31)",
            {"residual": residual, "slope": slope},
            {"residual": "1", "slope": "1"},
        ),
        Kernel("trum_hertz_half_angle", "Hertz half-angle (eqs. 25, 26)", {"theta": theta}, {"theta": "rad"}),
        Kernel("trum_foundation", "Foundation stiffness by level", contact.foundation(), units),
        Kernel(
            "trum_contact_stiffness",
            "Stiffness of layer, tooth and rotor flange in series",
            flange.contact_stiffness(),
            dict.fromkeys(flange.contact_stiffness(), "N/m^2"),
        ),
        Kernel(
            "trum_tangential_stiffness",
            "Stiffness of the layer in shear along the circumference",
            {"k_T": flange.tangential_stiffness()},
            {"k_T": "N/m^2"},
        ),
    ]


def _brush() -> list[Kernel]:
    return [
        Kernel(
            "trum_brush_coefficient",
            "Grip of the layer as a brush, and the surface speed's amplitude of a plain wave (eqs. 16, 20)",
            {"grip": brush.coefficient(), "R_v": brush.speed_amplitude()},
            {"grip": "1", "R_v": "m/s"},
        ),
        Kernel(
            "trum_brush_passage",
            "Stress of a bristle that sticks and friction's limit, and their integrals from where it began to",
            brush.passage(),
            {"stress": "1", "limit": "1", "stuck": "rad", "slid": "rad"},
        ),
        Kernel(
            "trum_brush_turns",
            "Where a sliding bristle could begin to stick",
            brush.turns(),
            {"delay": "rad", "span": "rad"},
        ),
    ]


def _coupling() -> list[Kernel]:
    newtons = ("central", "along", "in_phase", "ahead", "F_ceramic", "F_measured", "F_z", "F_x", "Q_A", "Q_B")
    units = {
        **dict.fromkeys(newtons, "N"),
        **dict.fromkeys(coupling.powers(), "N*m/s"),
        "M_q": "kg",
        "engagement_per_height": "1/m",
        **{"w_w": "1", "w_v": "s", "v_w": "1/s", "v_v": "1"},
        "f": "1",
        "f_alpha": "1/rad",
        "residual": "N^2",
        "lead": "rad",
        "omega_r": "rad/s",
        "R_v": "m/s",
        **dict.fromkeys(("W_c", "W_held", "swing"), "m"),
        **dict.fromkeys(("phi", "theta"), "rad"),
        **dict.fromkeys(("sin_crest", "cos_crest", "cos_phi", "sin_phi", "sin_theta", "cos_theta"), "1"),
        **dict.fromkeys(("engagement", "share"), "1"),
    }
    made = (
        ("trum_modal", "Modal mass of a phase, and its modal force by the ceramic and as measured", coupling.modal()),
        ("trum_plain_reaction", "What the contact of a plain wave does to the wave", coupling.reaction()),
        (
            "trum_plain_balance",
            "Balance of a plain wave with the contact, and its resonance",
            {**coupling.balance(), "omega_r": coupling.resonance()},
        ),
        ("trum_plain_powers", "Mean powers of a plain wave", coupling.powers()),
        (
            "trum_mode_swing",
            "Steady swing of a phase under its modal force alone, and the force's lead",
            coupling.swing(),
        ),
        (
            "trum_held_wave",
            "Height of a wave that nothing drives and that friction holds still",
            {"W_held": coupling.held_height()},
        ),
        (
            "trum_engagement",
            "The layer's force at full wave over the prepressure, per height of the wave",
            {"engagement_per_height": rotor.coefficients()["engagement_per_height"]},
        ),
        ("trum_mode_flow", "Free motion of a phase: displacement and velocity after a time, of each", coupling.flow()),
        ("trum_coupled_instant", "Wave, surface speed and contact of two phases at any instant", coupling.instant()),
        ("trum_coupled_forces", "What the contact does to rotor and both phases at any instant", coupling.forces()),
    )
    return [Kernel(name, title, found, {of: units[of] for of in found}) for name, title, found in made]


def _layer() -> list[Kernel]:
    units = {
        **dict.fromkeys(("central", "along", "across", "lossy", "in_phase", "ahead"), "N"),
        **dict.fromkeys(layer.powers(), "N*m/s"),
        **dict.fromkeys(("gap", "carried", "share", "f", "stress", "limit"), "1"),
        **dict.fromkeys(("gap_free", "carried_leaving", "f_alpha", "stress_u", "limit_u"), "1/rad"),
        **dict.fromkeys(("u_in", "u_out", "lead", "stuck", "slid", "stuck_ratio"), "rad"),
        **dict.fromkeys(("f_ratio", "ratio_most"), "1"),
        **dict.fromkeys(("stuck_cos", "stuck_sin", "slid_cos", "slid_sin", "sheared_sin"), "1"),
        **{"residual": "N^2", "omega_r": "rad/s", "omega_n0": "rad/s", "W_stick": "m"},
    }
    made = (
        ("trum_layer_meeting", "Surface over a lossy layer that recovers freely", layer.meeting()),
        ("trum_layer_carried", "What a lossy contact carries of the prepressure", layer.carried()),
        ("trum_layer_reaction", "What the lossy contact of a plain wave does to the wave", layer.reaction()),
        (
            "trum_layer_balance",
            "Balance of a plain wave with a layer that loses or is sheared, and its resonance",
            {**layer.balance(), "omega_r": layer.resonance()},
        ),
        (
            "trum_without_contact",
            "Natural frequency without a rotor, from the one with a plain wave's contact",
            {"omega_n0": layer.without_contact()},
        ),
        ("trum_layer_powers", "Mean powers of a plain wave over such a layer", layer.powers()),
        ("trum_shear_passage", "Stress and limit of a bristle, their integrals times cos u and sin u", layer.passage()),
        ("trum_shear_reaction", "What the contact of a plain wave with bristles does to the wave", layer.sheared()),
        ("trum_stuck_layer", "Height of the wave up to which all of the layer sticks", layer.stuck()),
    )
    return [Kernel(name, title, found, {of: units[of] for of in found}) for name, title, found in made]


def _port() -> list[Kernel]:
    units = {
        **{"Theta_q": "N/V", "C_0": "F", "L_m": "H", "C_m": "F", "R_m": "ohm", "omega_open": "rad/s"},
        **dict.fromkeys(("conductance", "susceptance"), "S"),
        **dict.fromkeys(("P_electric", "P_dielectric", "P_reactive"), "W"),
        **{"k_eff_square": "1", "current": "A", "power_factor": "1", "K_o": "N/m"},
    }
    made = (
        (
            "trum_port",
            "Force factor of a phase for its modal force, and its capacitance",
            {"Theta_q": port.F_q / port.U_s, "C_0": port.charge()["C_0"]},
        ),
        ("trum_port_circuit", "A phase without a rotor as a circuit, and with open electrodes", port.circuit()),
        ("trum_port_open", "Stiffness of a phase by the charge that open electrodes hold", port.opened()),
        ("trum_free_admittance", "Admittance of a phase without a rotor", port.admittance()),
        ("trum_plain_port", "What the phases of a plain wave draw", port.driven()),
    )
    return [Kernel(name, title, found, {of: units[of] for of in found}) for name, title, found in made]


def _cycle() -> list[Kernel]:
    free_units = {"a": "m", "b": "m/s"}
    periodic = {p: phases.periodic_start(p) for p in phases.PHASES}
    rest = {p: phases.rest_start(p) for p in phases.PHASES}
    region_free: dict[str, sp.Expr] = {}
    before = {p: sym(f"a_{p} b_{p}") for p in phases.PHASES}
    states = {p: phases.propagate_cycle(p, before[p]) for p in phases.PHASES}
    for index, region in enumerate((*phases.REGIONS, "end")):
        for p in phases.PHASES:
            region_free[f"a_{p}_{region}"], region_free[f"b_{p}_{region}"] = states[p][index]

    durations = {f"time_{r}": time for r, time in zip(phases.REGIONS, phases.region_times(), strict=True)}

    def start(state: Mapping[str, phases.State]) -> tuple[dict[str, sp.Expr], dict[str, str]]:
        outputs = {f"{letter}_{p}": value for p in phases.PHASES for letter, value in zip("ab", state[p], strict=True)}
        return outputs, {name: free_units[name[0]] for name in outputs}

    w_A, v_A, acceleration_A = phases.response("A")
    w_B, v_B, acceleration_B = phases.response("B")
    periodic_outputs, start_units = start(periodic)
    rest_outputs, _ = start(rest)
    return [
        Kernel(
            "trum_drive",
            "Drive frequency and cycle time",
            {"omega_q": phases.drive_frequency(), "T": phases.cycle_time()},
            {"omega_q": "rad/s", "T": "s"},
        ),
        Kernel(
            "trum_start_periodic",
            "Free motion before t1 that repeats itself every cycle, and how firmly the cycle fixes it",
            {**periodic_outputs, "repetition": phases.repetition()},
            {**start_units, "repetition": "1"},
        ),
        Kernel("trum_start_rest", "Free motion before t1 of phases at rest", rest_outputs, start_units),
        Kernel(
            "trum_regions",
            "Duration of each region; free motion at its start and at the cycle's end (eqs. 9, 10)",
            {**durations, **region_free},
            {**dict.fromkeys(durations, "s"), **{name: free_units[name[0]] for name in region_free}},
        ),
        Kernel(
            "trum_region_phasors",
            "Both phases' motions at the start of the regions as phasors (eqs. 9, 10)",
            phasors := _region_phasors(),
            dict.fromkeys(phasors, "m"),
        ),
        Kernel(
            "trum_response",
            "Both phases within a region (eqs. 9, 10), determinant and its rate (eqs. 24, A5)",
            {
                "w_A": w_A,
                "w_B": w_B,
                "v_A": v_A,
                "v_B": v_B,
                "Q": determinant.phase_determinant(w_A, v_A, w_B, v_B),
                "Q_rate": determinant.determinant_rate(w_A, acceleration_A, w_B, acceleration_B),
            },
            {"w_A": "m", "w_B": "m", "v_A": "m/s", "v_B": "m/s", "Q": "m^2/s", "Q_rate": "m^2/s^2"},
        ),
        _measures(),
    ]


def _measures() -> Kernel:
    q_ratio, q_square_ratio = determinant.ratios()
    q_average, q_volatility = determinant.measures()
    return Kernel(
        "trum_measures",
        "Speed determinants Q_aver, Q_vib (eqs. 43, 44) and their ratios X, Y",
        {
            "q_ratio": q_ratio,
            "q_square_ratio": q_square_ratio,
            "q_average": q_average,
            "q_volatility": q_volatility,
        },
        {"q_ratio": "1", "q_square_ratio": "1", "q_average": "1/s", "q_volatility": "1/s"},
    )


FREQUENCIES = ("omega_n", "Delta_omega")


def _frequencies(*following: str) -> dict[str, dict[sp.Symbol, sp.Expr]]:
    """Directions along which one frequency changes, and with it the symbols that are said to follow."""
    directions = {}
    for frequency in FREQUENCIES:
        rates = (
            {symbol: sym(f"{symbol.name}_{frequency}")[0] for symbol in sym(" ".join(following))} if following else {}
        )
        directions[frequency] = {sym(frequency)[0]: sp.Integer(1), **rates}
    return directions


def _region_phasors() -> dict[str, sp.Expr]:
    """Both phases' motions at the start of the three regions, from their free motion before t1."""
    found: dict[str, sp.Expr] = {}
    a, b = sym("a b")
    for phase in phases.PHASES:
        states = phases.propagate_cycle(phase, sym(f"a_{phase} b_{phase}"))
        for region, gate, state in zip(phases.REGIONS, phases.GATES[phase], states, strict=False):
            motion = (part.subs({a: state[0], b: state[1]}) for part in rotor.motion_phasor(phase, sp.Integer(gate)))
            found |= {f"{part}_{phase}_{region}": z for part, z in zip(("re", "im"), motion, strict=True)}
    return found


def _slopes() -> list[Kernel]:
    """How phases and wave change with the frequencies, at a fixed share of a drive period."""
    phasors = _region_phasors()
    starts: dict[str, Callable[[str], phases.State]] = {
        "periodic": phases.periodic_start,
        "rest": phases.rest_start,
    }
    tau, omega_n, Delta_omega = sym("tau omega_n Delta_omega")
    in_time = _frequencies("f_A_re", "f_A_im", "f_B_re", "f_B_im")
    for rates in in_time.values():
        rates[tau] = -tau / (omega_n + Delta_omega)
    in_time["tau"] = {tau: sp.Integer(1)}
    return [
        *(
            Kernel(
                f"trum_start_{name}_slopes",
                f"How the free motion before t1 follows the frequencies, start {name}",
                {f"{letter}_{p}": value for p in phases.PHASES for letter, value in zip("ab", start(p), strict=True)},
                {f"{letter}_{p}": unit for p in phases.PHASES for letter, unit in (("a", "m"), ("b", "m/s"))},
                along=_frequencies(),
            )
            for name, start in starts.items()
        ),
        Kernel(
            "trum_regions_slopes",
            "How the motion's phasors at the start of the regions follow the frequencies",
            phasors,
            dict.fromkeys(phasors, "m"),
            along=_frequencies("a_A", "b_A", "a_B", "b_B"),
        ),
        Kernel(
            "trum_wave_slopes",
            "How the wave follows the frequencies, at a fixed share of a drive period, and time",
            rotor.wave_in_time(),
            {"W_c": "m", "R_v": "m/s", "phi": "rad"},
            along=in_time,
        ),
        Kernel(
            "trum_friction_slopes",
            "How friction and contact change with the angle phi and the logarithm of the engagement",
            rotor.friction_slopes(),
            {"f_phi": "1/rad", "f_E": "1", "theta_E": "rad", "E_height": "1"},
        ),
        Kernel(
            "trum_friction_limit",
            "Friction's slope by the rim's speed, over a bent step, where the rotor is as fast as all of the surface",
            {"T_f_v": square_roots.friction_limit()},
            {"T_f_v": "s^2/m"},
        ),
        Kernel(
            "trum_contact_limit",
            "The half-angle's slope by the engagement's logarithm, over a bent step, where the whole wave touches",
            {"T_theta_E": square_roots.contact_limit()},
            {"T_theta_E": "s"},
        ),
    ]


def _rotor() -> list[Kernel]:
    phasor = dict(zip(("re", "im"), rotor.phasor(), strict=True))
    rotation = dict(zip(("e_re", "e_im", "d_re", "d_im"), rotor.rotation(), strict=True))
    wave_units = {"W_c": "m", "R_v": "m/s", "phi": "rad", "cos_phi": "1", "sin_phi": "1"}
    return [
        Kernel("trum_phasor", "Free motion as a phasor", phasor, dict.fromkeys(phasor, "m")),
        Kernel(
            "trum_rotation",
            "Turn of free motion, and the drive's beyond it, in a time",
            rotation,
            dict.fromkeys(rotation, "1"),
        ),
        Kernel(
            "trum_rotor_coefficients",
            "What the steps of a point share (eqs. 25, 26, 38)",
            {
                **rotor.coefficients(),
                "W_full_hertz": rotor.hertz_full_height(),
                "W_full_winkler": rotor.winkler_full_height(),
            },
            {
                "engagement_per_height": "1/m",
                "push": "m/s^2",
                "drag": "m/s^2",
                "W_full_hertz": "m",
                "W_full_winkler": "m",
            },
        ),
        Kernel("trum_wave", "Wave height and surface speed (eqs. 11, 16, 20)", rotor.wave(), wave_units),
        Kernel(
            "trum_filling",
            "How far the layer is engaged (eq. 31)",
            rotor.filling(),
            {"engagement": "1", "fullness": "1"},
        ),
        Kernel(
            "trum_contact_winkler",
            "Contact of the Winkler layer (eqs. 30, 31)",
            rotor.contact_winkler(),
            {"theta": "rad", "sin_theta": "1", "share": "1"},
        ),
        Kernel(
            "trum_contact_hertz",
            "Contact of the paper's Hertz width (eqs. 25, 26, 30)",
            rotor.contact_hertz(),
            {"theta": "rad", "sin_theta": "1", "share": "1", "engagement": "1"},
        ),
        Kernel(
            "trum_peak_pressure",
            "Contact pressure under a crest (eqs. 28, 30, 31)",
            {"pressure": rotor.peak_pressure()},
            {"pressure": "Pa"},
        ),
        Kernel(
            "trum_stall_torque", "Torque on a held rotor (eq. 38)", {"torque": rotor.stall_torque()}, {"torque": "N*m"}
        ),
        Kernel(
            "trum_total_inertia",
            "Moment of inertia of rotor, plate and weight (eq. 38, Sect. 8.1)",
            {"J_total": bench.inertia()},
            {"J_total": "kg*m^2"},
        ),
        Kernel(
            "trum_string_tension",
            "Tension of the string that bears the weight, over the weight (Sect. 8.1)",
            {"tension": bench.tension()},
            {"tension": "1"},
        ),
        Kernel(
            "trum_friction",
            "Net friction fraction, its slope, pressure where the surface is as fast as the rotor (eqs. 33 to 37)",
            rotor.friction(),
            {"f": "1", "f_v": "s/m", "p_1": "1", "p_2": "1"},
        ),
    ]


def _surface() -> list[Kernel]:
    return [
        Kernel(
            "trum_particle",
            "A point of the surface within a region: displacements, tangential velocity, envelope, crest "
            "(eqs. 11, 12, 16, 20)",
            surface.point(),
            {"zeta_z": "m", "zeta_x": "m", "v_x": "m/s", "A_Q": "m", "x_max": "m"},
        ),
        Kernel(
            "trum_displacement",
            "A point of the surface, from both phases' displacements (eq. 11)",
            surface.displacements(*sp.symbols("w_A w_B", real=True)),
            {"zeta_z": "m", "zeta_x": "m"},
        ),
        Kernel(
            "trum_interface",
            "Surface speed about the crest, line pressure, traction on the rotor (eqs. 16, 32, 36)",
            surface.interface(),
            {"v_x": "m/s", "v_x_slope": "1/s", "p": "N/m", "traction": "N/m"},
        ),
    ]


@cache
def kernels() -> tuple[Kernel, ...]:
    """All kernels, in the order of the manifest."""
    return tuple(
        _section()
        + _resonance()
        + _amplitude()
        + _contact()
        + _brush()
        + _coupling()
        + _layer()
        + _port()
        + _cycle()
        + _rotor()
        + _slopes()
        + _surface()
    )
