"""Headers of the hand-written driver: calls of kernels on named structs, and the one list of the orbit's fields.

A kernel takes pointers by position.  What the driver calls are the functions written here, which take the driver's
structs and pass their members by the names that the kernel's arguments have; a name that no struct has, or two have,
stops the generation.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from derivations.codegen.kernels import Kernel
from derivations.nomenclature import NOMENCLATURE

__all__ = ["Call", "Struct", "called", "headers", "orbit_fields"]


@dataclass(frozen=True)
class Struct:
    """A C struct whose members are named as the kernels' arguments and results.

    Attributes
    ----------
    name : str
        The C type.
    role : str
        Its parameter's name in the calls.
    members : tuple of str
        Symbols of the kernels.
    meaning : str
        A comment.
    """

    name: str
    role: str
    members: tuple[str, ...]
    meaning: str


@dataclass(frozen=True)
class Call:
    """A kernel, the structs that its arguments and results are members of, and arguments by themselves.

    With ``array`` the results go into an array in the kernel's order.
    """

    kernel: str
    structs: tuple[str, ...]
    alone: str = ""
    array: bool = False


def _struct(name: str, role: str, members: str, meaning: str) -> Struct:
    return Struct(name, role, tuple(members.split()), meaning)


_FREQUENCIES = ("omega_n", "Delta_omega")
_PHASORS = "f_A_re f_A_im f_B_re f_B_im"


def _along(names: str, directions: Iterable[str] = _FREQUENCIES) -> str:
    return " ".join(f"{name}_{direction}" for direction in directions for name in names.split())


# Structs of the lanes: members are `real`, one number for each lane
_LANE_STRUCTS = (
    _struct(
        "trum_constants",
        "constants",
        "omega_n Delta_omega xi s W D k_c p_re p_im engagement_per_height W_full",
        "what all steps of a point share: frequencies, damping, geometry, drive phasor p, contact",
    ),
    _struct("trum_region", "region", f"{_PHASORS} g_A g_B", "motions' phasors at a region's start; the gates"),
    _struct("trum_region_slopes", "region_slopes", _along(_PHASORS), "the phasors' derivatives by the two frequencies"),
    _struct(
        "trum_phasors", "phasors", "e_re e_im d_re d_im", "free motion's rotation since then, and the drive's beyond it"
    ),
    _struct(
        "trum_surface",
        "surface",
        "R_v phi cos_phi sin_phi engagement theta sin_theta share W_c",
        "surface speed and its phase, contact and wave height at an instant",
    ),
    _struct("trum_filling_state", "filling", "fullness fullness_root", "how far the wave fills the Winkler layer"),
    _struct(
        "trum_friction_state",
        "friction",
        "f f_v p_1 p_2",
        "friction fraction, its derivative by v, pressure at the two points as fast as the rotor",
    ),
    _struct(
        "trum_friction_derivatives",
        "derivatives",
        "f_phi f_E theta_E E_height",
        "by the phase phi and by the logarithm of the engagement E; E's by the logarithm of the height",
    ),
    _struct(
        "trum_saturation",
        "saturation",
        "R_v R_v_rate v v_rate p_larger p_smaller step",
        "the rotor as fast as the fastest point of the surface, at the end of a step",
    ),
    _struct("trum_full_contact_state", "full", "W_c_rate step", "the whole wave in contact, at the end of a step"),
)
_LANE_CALLS = (
    Call("trum_rotation", ("trum_constants", "trum_phasors"), "tau"),
    Call("trum_wave", ("trum_constants", "trum_region", "trum_phasors", "trum_surface")),
    Call("trum_filling", ("trum_constants", "trum_surface", "trum_filling_state")),
    Call("trum_contact_winkler", ("trum_filling_state", "trum_surface")),
    Call("trum_contact_hertz", ("trum_constants", "trum_surface")),
    Call("trum_friction", ("trum_surface", "trum_friction_state"), "v"),
    Call("trum_friction_slopes", ("trum_surface", "trum_friction_derivatives"), "v"),
    Call("trum_wave_slopes", ("trum_constants", "trum_region", "trum_region_slopes"), "tau", array=True),
    Call("trum_friction_limit", ("trum_saturation",), "T_f_v"),
    Call("trum_contact_limit", ("trum_constants", "trum_full_contact_state"), "T_theta_E"),
)
# Structs of plain numbers, of a point or a drive cycle
_PLAIN_STRUCTS = (
    _struct("trum_balance", "balance", "F_c k_N W k_c n_j", "what the Winkler layer's load balance depends on"),
    _struct("trum_balance_values", "values", "residual slope", "the balance at a half-angle, and its slope"),
    _struct(
        "trum_cycle_constants",
        "constants",
        "omega_n Delta_omega xi psi s m n W D k_c",
        "a drive cycle: frequencies, damping, switching, pulses, amplitude, geometry",
    ),
    _struct("trum_free_motion", "motion", "a_A b_A a_B b_B", "both phases' free motion at an instant"),
    _struct(
        "trum_free_motion_slopes",
        "motion_slopes",
        _along("a_A b_A a_B b_B"),
        "its derivatives by the two frequencies",
    ),
    _struct("trum_gates", "gates", "g_A g_B", "which of the phases is driven, 1 or 0"),
    _struct("trum_phases", "phases", "w_A w_B v_A v_B Q Q_rate", "displacement and velocity of both, determinant"),
    _struct("trum_bristle", "bristle", "grip ratio theta u_0 t_0", "the layer as a brush; where a bristle sticks from"),
    _struct("trum_passage", "passage", "stress limit stuck slid", "its stress and friction's limit, their integrals"),
    _struct("trum_turns", "turns", "delay span", "where a sliding bristle could begin to stick"),
)
_PLAIN_CALLS = (
    Call("trum_winkler_balance", ("trum_balance", "trum_balance_values"), "theta"),
    Call("trum_regions", ("trum_cycle_constants", "trum_free_motion"), array=True),
    Call("trum_region_phasors", ("trum_cycle_constants", "trum_free_motion"), array=True),
    Call("trum_regions_slopes", ("trum_cycle_constants", "trum_free_motion", "trum_free_motion_slopes"), array=True),
    Call("trum_response", ("trum_cycle_constants", "trum_free_motion", "trum_gates", "trum_phases"), "tau"),
    Call("trum_brush_passage", ("trum_bristle", "trum_passage"), "u"),
    Call("trum_brush_turns", ("trum_bristle", "trum_turns")),
)
# Structs of lanes, of the coupled system
_COUPLED_STRUCTS = (
    _struct("trum_mode", "mode", "omega_n0 xi", "a phase's own frequency and damping"),
    _struct("trum_flow", "flow", "w_w w_v v_w v_v", "displacement and velocity after a time, of each"),
    _struct("trum_coupled_place", "place", "D F_c k_N k_c mu n_j", "geometry and contact of a coupled point"),
    _struct(
        "trum_coupled_state", "state", "w_A w_B v_A v_B height v", "both phases, the rotor's height, its rim's speed"
    ),
    _struct(
        "trum_coupled_surface",
        "surface",
        "W_c sin_crest cos_crest R_v phi cos_phi sin_phi theta sin_theta cos_theta engagement share",
        "wave, surface speed and contact at an instant",
    ),
    _struct("trum_coupled_acting", "acting", "F_z F_x Q_A Q_B", "what the contact does to rotor and phases"),
    _struct(
        "trum_carried",
        "carried",
        "engagement_per_height W_c engagement fullness fullness_root theta sin_theta share",
        "a contact that carries the prepressure",
    ),
)
_COUPLED_CALLS = (
    Call("trum_mode_flow", ("trum_mode", "trum_flow"), "tau"),
    Call("trum_engagement", ("trum_coupled_place", "trum_carried")),
    Call("trum_filling", ("trum_carried",)),
    Call("trum_contact_winkler", ("trum_carried",)),
    Call("trum_coupled_instant", ("trum_coupled_place", "trum_coupled_state", "trum_coupled_surface")),
    Call(
        "trum_coupled_forces",
        ("trum_coupled_place", "trum_coupled_state", "trum_coupled_surface", "trum_coupled_acting"),
    ),
)


def _wrapped(line: str) -> list[str]:
    """A statement on lines of at most 120 characters."""
    return textwrap.wrap(line, 120, initial_indent="  ", subsequent_indent="      ", break_long_words=False)


def _declared(struct: Struct, number: str) -> list[str]:
    members = _wrapped(f"{number} {', '.join(struct.members)};")
    return [f"/* {struct.meaning} */", "typedef struct {", *members, f"}} {struct.name};"]


def called(call: Call, kernel: Kernel, structs: Sequence[Struct], prefix: str, number: str, function: str) -> list[str]:
    """The C function that calls a kernel on structs."""
    inputs, outputs = [symbol.name for symbol in kernel.inputs], list(kernel.results)
    used = [struct for struct in structs if struct.name in call.structs]
    used.sort(key=lambda struct: call.structs.index(struct.name))

    def place(name: str) -> str:
        holders = [struct for struct in used if name in struct.members]
        if name == call.alone and not holders:
            return name if name in outputs else f"&{name}"
        if len(holders) != 1 or name == call.alone:
            raise ValueError(f"{kernel.name}: {name} is in {len(holders)} of the structs {', '.join(call.structs)}")
        return f"&{holders[0].role}->{name}"

    arguments, results = [place(name) for name in inputs], [] if call.array else [place(name) for name in outputs]
    written = set() if call.array else set(outputs)
    parameters = [f"{'' if written & set(struct.members) else 'const '}{struct.name}* {struct.role}" for struct in used]
    if call.alone:
        parameters.append(f"{number}* {call.alone}" if call.alone in outputs else f"{number} {call.alone}")
    if call.array:
        parameters.append(f"{number}* results")
    head = f"static inline void {prefix}{kernel.name.removeprefix('trum_')}({', '.join(parameters)}) {{"
    lines = textwrap.wrap(head, 120, break_on_hyphens=False, subsequent_indent="    ")
    lines += _wrapped(f"const {number}* arg[{kernel.name}_n_arg] = {{{', '.join(arguments)}}};")
    if call.array:
        lines += [f"  {number}* res[{kernel.name}_n_res];", "  int k;"]
        lines.append(f"  for (k = 0; k < {kernel.name}_n_res; ++k) res[k] = &results[k];")
    else:
        lines += _wrapped(f"{number}* res[{kernel.name}_n_res] = {{{', '.join(results)}}};")
    return [*lines, f"  (void){function.format(kernel.name)}(arg, res, 0, 0, 0);", "}"]


def _calls(
    guard: str, comment: str, structs: Sequence[Struct], calls: Iterable[Call], known: dict[str, Kernel], *how: str
) -> list[str]:
    prefix, number, function = how
    lines = [f"/* {comment} */", f"#ifndef {guard}", f"#define {guard}", ""]
    for struct in structs:
        lines += [*_declared(struct, number), ""]
    for call in calls:
        kernel = known[call.kernel]
        lines += [f"/* {kernel.title} */", *called(call, kernel, structs, prefix, number, function), ""]
    return [*lines, "#endif"]


@dataclass(frozen=True)
class Field:
    """A number that the orbit's driver takes or gives."""

    name: str
    unit: str
    meaning: str


def _named(names: str) -> tuple[Field, ...]:
    return tuple(Field(n, NOMENCLATURE[n].unit, NOMENCLATURE[n].meaning) for n in names.split())


_CYCLE = _named("omega_n Delta_omega xi psi s m n a_A b_A a_B b_B")
_SIZE = _named("W D k_c")
_ROTOR = (
    *_named("engagement_per_height W_full"),
    Field("hertz", "1", "whether the contact has the paper's Hertz width (1) or is the Winkler layer's (0)"),
    Field("push", "m/s^2", "mu F_c r_c^2 / J_total, the rim's acceleration by full friction (eq. 38)"),
    Field("drag", "m/s^2", "the load's T_load r_c / J_total (eq. 38)"),
    Field("tolerance", "1", "of mean and extremes, relative to the largest speed"),
    Field("held", "1", "whether (1 or 0) contact and stall torque of a rotor that is held are wanted"),
)
_OUT = (
    Field("mean", "m/s", "mean speed of the rim"),
    Field("low", "m/s", "its lowest"),
    Field("high", "m/s", "its highest"),
    Field("variance", "m^2/s^2", "its variance"),
    Field("contact", "1", "mean of theta/pi with the rotor held; NaN unless wanted"),
    Field("held", "1", "mean friction fraction with the rotor held; NaN unless wanted"),
    Field("start", "m/s", "speed at the start of the cycle"),
    Field("level", "1", "error that a step of the last lap was allowed, per drive period"),
    Field("error", "1", "the largest of the bounds below, over the largest speed"),
    Field("mean_error", "m/s", "bound of the error of mean"),
    Field("low_error", "m/s", "of low"),
    Field("high_error", "m/s", "of high"),
    Field("deviation_error", "m/s", "of the root of variance"),
    Field("contact_error", "1", "of contact"),
    Field("held_error", "1", "of held"),
    Field("flags", "1", "sum of the bits of TRUM_ORBIT_FLAGS"),
)
_SLOPES_IN = _named(_along("a_A b_A a_B b_B"))
_SLOPE_FIGURES = _OUT[:6]
_SLOPE_PARAMETERS = (
    Field("prepressure", "1", "by the logarithm of the prepressure"),
    Field("difference", "rad/s", "by the frequency difference Delta_omega"),
    Field("drag", "m/s^2", "by the drag, the load's share of the rotor's equation"),
    Field("friction", "1", "by the logarithm of the friction coefficient"),
    Field("amplitude", "1", "by the logarithm of the amplitude"),
    Field("resonance", "rad/s", "by the resonance omega_n"),
)
_SUMS = (
    Field("q_plus", "m^2", "integral of Q's positive part over a cycle"),
    Field("q_minus", "m^2", "of its negative part's magnitude"),
    Field("p_plus", "m^4/s", "of the positive part's square"),
    Field("p_minus", "m^4/s", "of the negative part's square"),
)
_PHASES = (
    Field("w_A", "m", "displacement of phase A"),
    Field("w_B", "m", "displacement of phase B"),
    Field("v_A", "m/s", "velocity of phase A"),
    Field("v_B", "m/s", "velocity of phase B"),
    Field("Q", "m^2/s", "direction determinant (eq. 24)"),
)
_PANELS = Field("panels", "1", "panels of the quadrature in a period of the faster of drive and resonance")
_FLAGS = (  # bits of `flags`, lowest first
    "converged",  # all bounds meet the tolerance
    "full_contact",
    "runaway",  # the load is at or beyond what friction can hold, whatever the speed
    "autonomous",  # friction depends on the speed alone, whose balance is a root
    "too_many_steps",  # not converged: a lap needs more steps than are allowed
    "too_many_laps",  # not converged: the search needs more laps than are allowed
    "failed_step",  # not converged: a step cannot be evaluated however short it is
    "rounding_limit",  # not converged: shorter steps make no bound smaller
)
_COUPLED_STATE = (
    Field("w_A", "m", "displacement of phase A"),
    Field("v_A", "m/s", "velocity of phase A"),
    Field("w_B", "m", "displacement of phase B"),
    Field("v_B", "m/s", "velocity of phase B"),
    Field("height", "m", NOMENCLATURE["height"].meaning),
    Field("climb", "m/s", "its rate"),
    *_named("v"),
)
_COUPLED_IN = (
    *_COUPLED_STATE,
    *_named("M_q omega_n0 xi F_q omega_q D k_c k_N n_j mu F_c r_c T_load J_total"),
    Field("m", "1", "drive periods in the lap; the last one may be a part"),
    Field("off_A", "1", "drive periods before A is off"),
    Field("on_A", "1", "drive periods before it is on again"),
    Field("off_B", "1", "drive periods before B is off"),
    Field("on_B", "1", "drive periods before it is on again"),
    Field("force_A", "1", "A's modal force over F_q"),
    Field("force_B_along", "1", "the part of B's over F_q that is in phase with A's"),
    Field("force_B_ahead", "1", "the part of it that is a quarter period ahead of A's"),
    Field("force_phase", "rad", "phase of A's modal force at the start of the cycle"),
    Field("K_o", "N/m", "stiffness of a phase that is off by the charge that it holds; 0: its terminals are short"),
    Field("driven_A", "1", "whether A is driven until the lap begins, 1 or 0"),
    Field("driven_B", "1", "whether B is"),
    Field("pull_A", "N", "A's modal force at no displacement by the charge held, where it is off before the lap"),
    Field("pull_B", "N", "B's"),
    Field("held", "m", "height of a wave that friction holds still, 0 if none"),
    Field("mass", "kg", "of the rotor that goes up and down; 0: it follows the wave"),
    Field("reaction", "1", "share of the contact's forces that acts on the phases, 1 or 0"),
    Field("size", "m", "height of a wave, by which and by the speeds that go with it errors are measured"),
    Field("tolerance", "1", "of a time step, relative to those sizes"),
)
_COUPLED_OUT = (
    *_COUPLED_STATE,
    Field("mean", "m/s", "mean speed of the rim"),
    Field("square", "m^2/s^2", "mean of its square"),
    Field("variance", "m^2/s^2", "mean of the square of its difference from the mean"),
    Field("low", "m/s", "its lowest"),
    Field("high", "m/s", "its highest"),
    Field("input", "kg*m^2/s^3", "mean power of the modal forces, those of charges held with them"),
    Field("touching", "1", "mean of theta/pi"),
    Field("highest", "m", "the highest wave"),
    Field("pull_A", "N", "A's modal force at no displacement by the charge that it held last, 0 if none"),
    Field("pull_B", "N", "B's"),
    Field("evaluations", "1", "of the rates"),
)
_LISTS = {
    "TRUM_CYCLE_IN": ("a drive cycle", _CYCLE),
    "TRUM_SIZE_IN": ("amplitude and geometry of its waves", _SIZE),
    "TRUM_HALF_ANGLE_IN": ("what the Winkler layer's half-angle depends on", _named("F_c k_N W k_c n_j")),
    "TRUM_BRUSH_IN": ("what the friction of a brush depends on", _named("theta grip ratio")),
    "TRUM_BRUSH_SPEED_IN": ("what the rotor's speed over a brush depends on", _named("theta grip f")),
    "TRUM_COUPLED_LAP_IN": ("a drive cycle of phases, contact and rotor as one system", _COUPLED_IN),
    "TRUM_COUPLED_LAP_OUT": ("what it comes to", _COUPLED_OUT),
    "TRUM_CYCLE_SUMS_IN": ("what the determinant's sums over a cycle need", (*_CYCLE, _PANELS)),
    "TRUM_CYCLE_SUMS_OUT": ("what a cycle's determinant sums to", _SUMS),
    "TRUM_CYCLE_RESPONSE_IN": ("an instant of a cycle", (*_named("t"), *_CYCLE, *_SIZE)),
    "TRUM_CYCLE_RESPONSE_OUT": ("both phases and their determinant there", _PHASES),
    "TRUM_ORBIT_IN": ("what an orbit needs of a point; angles in rad", (*_CYCLE, *_SIZE, *_ROTOR)),
    "TRUM_ORBIT_OUT": ("an orbit's figures", _OUT),
    "TRUM_SLOPES_IN": ("derivatives of the free motion before t1 by resonance and difference", _SLOPES_IN),
    "TRUM_SLOPE_FIGURES": ("figures that have slopes, the rows of the slopes' matrix", _SLOPE_FIGURES),
    "TRUM_SLOPE_PARAMETERS": ("what slopes are by, each with the others held: its columns", _SLOPE_PARAMETERS),
    "TRUM_HISTORY_IN": (
        "what a history needs of an orbit beside the point",
        tuple(field for field in _OUT if field.name in ("low", "high", "start", "level")),
    ),
}
# Lists that are structs as well
_STRUCTS = (
    "TRUM_BRUSH_IN",
    "TRUM_BRUSH_SPEED_IN",
    "TRUM_COUPLED_LAP_IN",
    "TRUM_COUPLED_LAP_OUT",
    "TRUM_CYCLE_SUMS_IN",
    "TRUM_CYCLE_SUMS_OUT",
    "TRUM_CYCLE_RESPONSE_IN",
    "TRUM_CYCLE_RESPONSE_OUT",
    "TRUM_ORBIT_IN",
    "TRUM_ORBIT_OUT",
    "TRUM_SLOPES_IN",
)


def orbit_fields() -> dict[str, list[dict[str, str]]]:
    """The lists for the manifest."""
    return {
        name.removeprefix("TRUM_").lower(): [vars(field) for field in fields] for name, (_, fields) in _LISTS.items()
    }


def _fields() -> list[str]:
    lines = ["/* What goes into the orbit's driver and comes out, each list once. */", "#ifndef TRUM_ORBIT_FIELDS_H"]
    lines += ["#define TRUM_ORBIT_FIELDS_H", "", '#include "trum_math.h"', "", "/* name, SI unit */"]
    for name, (meaning, fields) in _LISTS.items():
        rows = " \\\n".join(f'  X({field.name}, "{field.unit}")' for field in fields)
        lines += [f"/* {meaning} */", f"#define {name}(X) \\", rows, ""]
    for name in _STRUCTS:
        meaning, fields = _LISTS[name]
        members = [f"  trum_real {field.name}; /* {field.unit}: {field.meaning} */" for field in fields]
        lines += [f"/* {meaning} */", "typedef struct {", *members, f"}} {name.lower()};", ""]
    for prefix, name in (("OF", "TRUM_SLOPE_FIGURES"), ("BY", "TRUM_SLOPE_PARAMETERS")):
        names = [f"  TRUM_{prefix}_{field.name},".upper() for field in _LISTS[name][1]]
        lines += [f"/* {_LISTS[name][0]} */", "enum {", *names, f"  {name}_COUNT", "};", ""]
    slopes = "trum_real of[TRUM_SLOPE_FIGURES_COUNT][TRUM_SLOPE_PARAMETERS_COUNT];"
    lines += ["typedef struct {", f"  {slopes}", "} trum_slopes_out;"]
    bits = ", ".join(f"trum_{name} = {1 << bit}" for bit, name in enumerate(_FLAGS))
    lines += ["", "/* bits of an orbit's flags, and their names */", f"enum {{ {bits} }};"]
    return [*lines, f'#define TRUM_ORBIT_FLAGS "{" ".join(_FLAGS)}"', "", "#endif"]


def headers(kernels: Iterable[Kernel], note: str) -> dict[str, str]:
    """The headers by file name; ``note`` opens each.

    Raises
    ------
    ValueError
        If a kernel's argument or result is in none, or in more than one, of its call's structs.
    """
    known = {kernel.name: kernel for kernel in kernels}
    lanes = "Kernels on structs of lanes; include where `real` is a lane's number and TRUM_KERNEL names its kernels."
    plain = "Kernels on structs of plain numbers."
    texts = {
        "trum_lane_calls.h": _calls(
            "TRUM_LANE_CALLS_H", lanes, _LANE_STRUCTS, _LANE_CALLS, known, "trum_lanes_", "real", "TRUM_KERNEL({})"
        ),
        "trum_coupled_calls.h": _calls(
            *("TRUM_COUPLED_CALLS_H", lanes, _COUPLED_STRUCTS, _COUPLED_CALLS, known),
            *("trum_coupled_call_", "real", "TRUM_KERNEL({})"),
        ),
        "trum_plain_calls.h": _calls(
            "TRUM_PLAIN_CALLS_H", plain, _PLAIN_STRUCTS, _PLAIN_CALLS, known, "trum_plain_", "trum_real", "{}"
        ),
        "trum_orbit_fields.h": _fields(),
    }
    return {name: "\n".join([f"/* {note} */", *lines, ""]) for name, lines in texts.items()}
