"""Claims of Sects. 1 to 4: what the model is built on."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trum_sym.inputs.checks import Array
from trum_sym.inputs.drive import STARTS, Drive, Start
from trum_sym.inputs.motor import Motor
from trum_sym.inputs.units import ARCSEC
from trum_sym.model.cycle import modal_values, response
from trum_sym.model.kernels import call
from trum_sym.model.levels import Levels
from trum_sym.model.operating_point import prepare
from trum_sym.model.rotor import history, solve_orbit, surface_and_contact
from trum_sym.model.stator import solve_stator
from trum_sym.paper import microstepping
from trum_sym.paper.findings import LOADS, ByInertia, Check, Context, Finding, by_load, falls, of_rotor
from trum_sym.paper.readings import (
    COMBINATIONS,
    DEFAULT,
    LEADS,
    LOAD_INERTIA,
    MEASURED,
    PHASES,
    POINTS,
    RIG,
    ROTOR_LEVELS,
)
from trum_sym.paper.section_5 import ADD, ADDREDU, REDU, half_angles

__all__ = ["CHECKS"]

_PULSES = (20, 14)  # m and n of Table 3
_SECTION_5 = (100, 55)
_STEADY: Start = "steady"
_NEAR = 0.05
_FORCED = COMBINATIONS.index(("winkler", "quartic", "harmonic", "forced"))


def _cells(values: Array, form: str) -> str:
    """Values by (start, phase lead) in words."""
    return "; ".join(
        f"{start} {lead:+.0f}: {values[i, j]:{form}}" for i, start in enumerate(STARTS) for j, lead in enumerate(LEADS)
    )


# --- Sect. 1 ----------------------------------------------------------------------------------------------------
def _jitter(c: Context) -> Finding:
    """The swing over the mean; small is what Table 4 itself prints, 400 arcsec/s of 633."""
    share = 400 / 633
    found = c.loaded(c.motor, np.array(180.0), np.array(3000.0))
    ratio = found["swing"] / np.abs(found["mean_speed"])
    corners = c.ranges["swing"][..., POINTS.table_3] / np.abs(c.ranges["mean_speed"][..., POINTS.table_3]) <= share
    holds = (ratio <= share)[..., None]
    return of_rotor(
        ByInertia(holds, corners, holds[0], corners[0], measured=True),
        f"swing of the speed in a cycle over its mean {LOADS}: {by_load(ratio[:, :, :, 0], '.2g')}; small is said up "
        f"to {share:.2f}, which Table 4 has for the encoder's readings",
        (DEFAULT,),
    )


def _steadier(c: Context) -> Finding:
    """Pulses and bursts at the same mean speeds, where the wave feels the rotor: no reading has that."""
    found = microstepping.compared(c.motor)
    shown = [
        f"{at.setting}: {at.pulses / ARCSEC:.2g} / {at.bursts / ARCSEC:.2g}"
        for at in found
        if at.holds or at.mean == microstepping.MEANS[1]
    ]
    return Finding(
        False,
        "standard deviations in arcsec/s of Table 3's pulses / bursts, with the rotor's reaction on the wave, its "
        f"flange, no mass and no load, at means of {', '.join(f'{mean:g}' for mean in microstepping.MEANS)} arcsec/s; "
        f"where the pulses are steadier, and all at {microstepping.MEANS[1]:g}: " + "; ".join(shown),
        settings={at.setting: at.holds for at in found},
    )


# --- Sect. 2 ----------------------------------------------------------------------------------------------------
def _sections(c: Context, amplitude: str = "measured") -> tuple[Mapping[str, float], Mapping[str, float]]:
    """The free stator with its teeth, and the ring that is left when they are cut off, without prepressure."""
    height = float(c.motor.beam_thickness.value) - float(c.motor.tooth_height.value)
    bare = c.motor.with_values({"tooth_height": 1e-9, "beam_thickness": height})
    free = Levels("winkler", "quartic", "none", amplitude)  # type: ignore[arg-type]
    found = []
    for motor in (c.motor, bare):
        stator = solve_stator(motor, Drive(), free)
        v = {name: float(np.asarray(value)) for name, value in stator.values.items()}
        found.append({**v, "stiffness": v["E"] * v["I_z"], "f_n": v["omega_n"] / (2 * np.pi)})
    return found[0], found[1]


def _teeth(c: Context) -> Finding:
    toothed, bare = _sections(c)
    stiffness, frequency = (toothed[name] / bare[name] - 1 for name in ("stiffness", "f_n"))
    return Finding(
        np.full((1, 1, 1, 1), max(abs(stiffness), abs(frequency)) < 0.01),
        f"eqs. (1), (2) with the teeth and with h_t = 0 on the ring that is left, h_e - h_t: bending stiffness "
        f"{bare['stiffness']:.3f} to {toothed['stiffness']:.3f} N m^2 ({100 * stiffness:+.1f} %), resonance without "
        f"prepressure {1e-3 * bare['f_n']:.2f} to {1e-3 * toothed['f_n']:.2f} kHz ({100 * frequency:+.1f} %); "
        "unaffected is said up to 1 %",
        levels=(DEFAULT,),
    )


def _teeth_amplitude(c: Context) -> Finding:
    """By eq. 7, put right, at the same frequency difference."""
    toothed, bare = _sections(c, "forced")
    across = [v["W"] * v["D"] * v["k_c"] for v in (toothed, bare)]
    return Finding(
        np.full((1, 1, 1, 1), across[0] > across[1]),
        f"eq. (7) put right, 3000 Hz above resonance, without and with the teeth: vertical amplitude "
        f"{1e6 * bare['W']:.3f} to {1e6 * toothed['W']:.3f} um ({100 * (toothed['W'] / bare['W'] - 1):+.0f} %), along "
        f"the circumference, D k_c W, {1e6 * across[1]:.3f} to {1e6 * across[0]:.3f} um "
        f"({100 * (across[0] / across[1] - 1):+.0f} %)",
        levels=(_FORCED,),
        undecidable=None
        if toothed["W"] > bare["W"]
        else "which amplitude is meant is not said: the teeth raise the one "
        "along the circumference and not the vertical one",
    )


def _affects(c: Context) -> Finding:
    levels = tuple(i for i, level in enumerate(COMBINATIONS) if level[1] != MEASURED)
    curves = c.readings.resonance_frequency[list(levels), POINTS.figure_23]
    change = curves[:, -1] / curves[:, 0] - 1
    one = 100 * change[levels.index(DEFAULT)]
    return Finding(
        np.abs(change) > 1e-9,
        f"resonance from 160 to 210 N: {one:+.3f} % at the default level, {100 * change.min():+.3f} to "
        f"{100 * change.max():+.3f} % over all",
        levels=levels,
    )


def _linear_stator(c: Context) -> Finding:
    """What half of the voltage makes of amplitude and resonance under 180 N."""
    levels = tuple(i for i, level in enumerate(COMBINATIONS) if level[1] != MEASURED)
    halved = {name: 0.5 * float(getattr(c.motor, name).value) for name in ("voltage", "free_amplitude")}
    ratio, shift = np.empty((2, len(levels)))
    for i, index in enumerate(levels):
        full, half = (
            solve_stator(motor, Drive(), Levels(*COMBINATIONS[index]))  # type: ignore[arg-type]
            for motor in (c.motor, c.motor.with_values(halved))
        )
        ratio[i] = np.asarray(half.W) / np.asarray(full.W)
        shift[i] = np.asarray(half.omega_n) / np.asarray(full.omega_n) - 1
    at, forced = levels.index(DEFAULT), levels.index(_FORCED)
    return Finding(
        (np.abs(ratio / 0.5 - 1) < 0.01) & (np.abs(shift) < 1e-3),
        f"half of the voltage at 180 N: the amplitude falls to {100 * ratio[forced]:.1f} % of itself and the resonance "
        f"moves by {100 * shift[forced]:+.1f} % (forced amplitude, harmonic foundation), by {100 * shift[at]:+.2f} % "
        f"with eq. (8)'s amplitude; over all levels {100 * ratio.min():.1f} to {100 * ratio.max():.1f} % and "
        f"{100 * shift.min():+.1f} to {100 * shift.max():+.1f} %, exactly 50 % and 0 % without a foundation",
        levels=levels,
        undecidable="under prepressure the amplitude was measured at one voltage, 400 V peak to peak, and no resonance "
        "is given with its amplitude; linear without the layer, and not with it",
    )


def _amplitude_falls(c: Context) -> Finding:
    levels = tuple(i for i, level in enumerate(COMBINATIONS) if level[1] != MEASURED)
    curves = 1e6 * c.readings.amplitude[list(levels), POINTS.figure_23]
    one, forced = curves[levels.index(DEFAULT)], curves[levels.index(_FORCED)]
    return Finding(
        falls(curves),
        f"amplitude of a phase from 160 to 210 N, six prepressures: {one[0]:.2f} to {one[-1]:.2f} um by eq. (8) on the "
        f"measured one, {forced[0]:.3f} to {forced[-1]:.3f} um forced",
        levels=levels,
    )


# --- Sect. 3 ----------------------------------------------------------------------------------------------------
def _rigid_metal(c: Context) -> Finding:
    """The paper's own contact length, eq. 26, as it is and with a stator that does not give."""
    stator = solve_stator(c.motor, Drive(), Levels("hertz", "quartic", "none", "measured"))
    values = {**c.motor.symbols(), **stator.values, "F_c": 180.0}
    both, layer = (
        float(np.asarray(call("trum_hertz_half_angle", v)["theta"]))
        for v in (values, {**values, "E_eq": 1e9 * np.asarray(values["E_eq"])})
    )
    return Finding(
        np.full((1, 1, 1, 1), abs(both / layer - 1) < 0.01),
        f"by eq. (26) a contact on the layer alone is {100 * (1 - layer / both):.1f} % shorter than with the stator's "
        "own compliance, which the equation counts; no deformation is said below 1 %",
        levels=(DEFAULT,),
        undecidable="the rotor, which would give beside the stator, is not described",
    )


def _amplitudes(c: Context, pulses: tuple[int, int], region: int, before: bool = False) -> tuple[Array, Array]:
    """Amplitude of each phase over a region, and that of its free part, over W_maxf, by (phase, ..., time).

    The forced part is that of a drive that is never switched; what it has at the drive's frequency and the rest at the
    resonance's make up the phase's own.  ``before`` takes the phase that the region switches off as still driven, for
    the region's first instant.
    """
    f_n = float(c.readings.resonance_frequency[DEFAULT, POINTS.table_3])
    m, n = pulses
    lead, phase = np.array(LEADS)[:, None, None], np.array([*PHASES.values()])[:, None]
    driven = {"A": before or region != REDU, "B": before or region != ADDREDU}
    both = []
    for start in STARTS:
        values, forced = (
            modal_values(
                2 * np.pi * f_n,
                c.motor.damping_ratio.value,
                Drive(start=begin, periods=m, on_periods=on, phase_lead=lead, switching_phase=phase),
            )
            for begin, on in ((start, n), (_STEADY, m))
        )
        regions = call("trum_regions", values)
        lengths = [float(np.asarray(regions[f"time_{name}"]).flat[0]) for name in ("redu", "addredu", "add")]
        time = sum(lengths[:region]) + lengths[region] * (np.arange(2000) + 0.5) / 2000
        now, still = response(time, values), response(time, forced)
        for p in "AB":
            w, v = (np.asarray(now[f"{k}_{p}"]) for k in "wv")
            w_q, v_q = (np.asarray(still[f"{k}_{p}"]) * driven[p] for k in "wv")
            turn = 2 * np.pi * np.array([f_n, f_n + 3000.0])
            free = np.stack([w - w_q, (v - v_q) / turn[0]])
            both.append(np.linalg.norm([free, free + np.stack([w_q, v_q / turn[1]])], axis=1))
    found = np.stack(both).reshape(len(STARTS), 2, *both[0].shape)  # (start, phase, free or all, lead, psi, time)
    found = np.moveaxis(found, (1, 2), (0, 1))[..., None, :]
    return found[:, 1], found[:, 0]


def _before_t1(c: Context) -> Finding:
    size = _amplitudes(c, _PULSES, REDU, before=True)[0][0, ..., 0]
    return Finding(
        np.abs(size - 1) < _NEAR,
        f"amplitude of phase A as it is switched off over W_maxf: {_cells(size[:, :, 0, 0], '.2f')}",
        levels=(DEFAULT,),
    )


def _constant(c: Context) -> Finding:
    size = _amplitudes(c, _PULSES, REDU)[0][1]
    low, high = size.min(axis=-1), size.max(axis=-1)
    return Finding(
        (low > 1 - _NEAR) & (high < 1 + _NEAR),
        f"amplitude of phase B over W_maxf within T_redu of Table 3, least: {_cells(low[:, :, 0, 0], '.2f')}; "
        f"largest: {_cells(high[:, :, 0, 0], '.2f')}",
        levels=(DEFAULT,),
    )


def _grows(region: int, phase: str, name: str) -> Check:
    """Whether a phase's amplitude rises from each drive period of a region to the next."""
    m, n = _PULSES
    periods = 2 * n - m if region == ADD else m - n

    def check(c: Context) -> Finding:
        size = _amplitudes(c, _PULSES, region)[0]["AB".index(phase)]
        size = size[..., np.linspace(0, size.shape[-1] - 1, periods + 1).astype(int)]
        rising = np.asarray((np.diff(size, axis=-1) > 0).mean(axis=-1))
        first, last = size[:, :, 0, 0, 0], size[:, :, 0, 0, -1]
        return Finding(
            rising == 1,
            f"share of the {periods} periods of {name} of Table 3 in which the amplitude of phase {phase} rises: "
            f"{_cells(100 * rising[:, :, 0, 0], '.0f')} %; over W_maxf it goes from {_cells(first, '.2f')} to "
            f"{_cells(last, '.2f')}",
            levels=(DEFAULT,),
        )

    return check


def _keeps(c: Context) -> Finding:
    """Phase A over T_add, where its free part beats with the forced one."""
    size = np.stack([_amplitudes(c, pulses, ADD)[0][0] for pulses in (_PULSES, (100, 75))])
    low, high = size.min(axis=(0, -1)), size.max(axis=(0, -1))
    return Finding(
        (low > 1 - _NEAR) & (high < 1 + _NEAR),
        f"amplitude of phase A over W_maxf in T_add, m = 20 with n = 14 and m = 100 with n = 75, least: "
        f"{_cells(low[:, :, 0, 0], '.2f')}; largest: {_cells(high[:, :, 0, 0], '.2f')}",
        levels=(DEFAULT,),
    )


def _same_frequency(c: Context) -> Finding:
    free = _amplitudes(c, _PULSES, ADD)[1].max(axis=0)
    first, last = free[..., 0], free[..., -1]
    return Finding(
        first < _NEAR,
        f"amplitude of the free part, which has the resonance's frequency, over the forced one in T_add of Table 3, "
        f"the larger of both phases, at its start: {_cells(first[:, :, 0, 0], '.2f')}; at its end: "
        f"{_cells(last[:, :, 0, 0], '.2f')}",
        levels=(DEFAULT,),
    )


def _drive_frequency(c: Context) -> float:
    return float(c.readings.resonance_frequency[DEFAULT, POINTS.table_3]) + 3000.0


def _at_the_crest(c: Context) -> Finding:
    """The rate of the crest's height, as the surface's velocity there, against the size of the surface's velocity."""
    parts = [c.beat(_PULSES, region, np.inf, 64) for region in (REDU, ADDREDU, ADD)]
    w_A, w_B, v_A, v_B = (np.concatenate([getattr(p, k) for p in parts], -1) for k in ("w_A", "w_B", "v_A", "v_B"))
    up = (w_A * v_A + w_B * v_B) / np.hypot(w_A, w_B)
    share = np.sqrt((up**2).mean(axis=-1) / (v_A**2 + v_B**2).mean(axis=-1))
    return Finding(
        share < 0.01,
        f"vertical velocity of the surface at the crest over that velocity's amplitude along the wave, root mean "
        f"squares over Table 3's cycle: {_cells(share[:, :, 0, 0], '.2f')}; zero in a wave of constant height only",
        levels=(DEFAULT,),
    )


def _half(c: Context) -> Finding:
    """Share of forward rotation over the whole beats of Sect. 5.2's regions."""
    beats = np.floor((_SECTION_5[0] - _SECTION_5[1]) * 3000.0 / _drive_frequency(c))
    shares = [(c.beat(_SECTION_5, region, beats, 64).Q > 0).mean(axis=-1) for region in (REDU, ADDREDU)]
    return Finding(
        np.all([np.abs(share - 0.5) < 0.02 for share in shares], axis=0),
        f"share of forward rotation over the first {beats:.0f} beats, m = 100, n = 55, in T_redu: "
        f"{_cells(shares[0][:, :, 0, 0], '.2f')}; in T_addredu: {_cells(shares[1][:, :, 0, 0], '.2f')}",
        levels=(DEFAULT,),
    )


def _clockwise(c: Context) -> Finding:
    back = (c.beat(_PULSES, ADD, np.inf, 32, all_levels=True).Q < 0).mean(axis=-1)
    return Finding(
        back == 0,
        f"share of T_add of Table 3 in which the particle turns backward: {_cells(100 * back[:, :, 0, DEFAULT], '.3g')}"
        " %",
    )


# --- Sect. 4 ----------------------------------------------------------------------------------------------------
def _crest_height(c: Context) -> Finding:
    size = np.concatenate(
        [np.hypot(b.w_A, b.w_B) for b in (c.beat(_PULSES, region, np.inf, 64) for region in (REDU, ADDREDU, ADD))], -1
    )
    low, high = size.min(axis=-1), size.max(axis=-1)
    return Finding(
        high / low > 1 + _NEAR,
        f"height of the crest over W_maxf in Table 3's cycle: {low.min():.2g} to {high.max():.2g} over starts, leads "
        f"and switching phases, {(high / low).min():.2g} times at least",
        levels=(DEFAULT,),
    )


def _curvature(c: Context) -> Finding:
    """The wave's curvature at the contact's edge over that at its crest, which is the cosine of the half-angle."""
    angles = half_angles(c)
    worst = np.cos(angles.max(axis=-1))
    steady = float(np.cos(_steady_angle(c)))
    less = (np.cos(angles) < 0.9).mean(axis=-1)
    return Finding(
        worst >= 0.9,
        f"curvature of the wave at the contact's edge over that at its crest: {steady:.2f} in the plain travelling "
        f"wave; in Table 3's cycle it falls to {worst.min():+.2f}, and lies below 0.9 for "
        f"{100 * less.min():.0f} to {100 * less.max():.0f} % of the time over starts, leads and switching phases",
        levels=(DEFAULT,),
    )


def _steady_angle(c: Context) -> float:
    values = {
        "F_c": 180.0,
        "W": c.readings.amplitude[DEFAULT, POINTS.table_3],
        "n_j": c.motor.crests.value,
        "k_N": call("trum_layer_stiffness", c.motor.symbols())["k_N"],
        "k_c": call("trum_wavenumber", c.motor.symbols())["k_c"],
    }
    return float(np.asarray(call("contact_half_angle", values)["theta"]))


def _points(motor: Motor) -> Array:
    """Share of Table 3's cycle with one place that is as fast as the rotor between crest and edge."""
    found = []
    for start in STARTS:
        lead, phase = np.array(LEADS)[:, None], np.array([*PHASES.values()])
        drive = Drive(start=start, phase_lead=lead, switching_phase=phase)
        case = prepare(motor, drive, Levels("winkler", "quartic", "harmonic", "measured"), 1e-4)
        orbit = solve_orbit({**case.arguments, "held": 0.0}, case.symbols)
        count = 20 * 64
        speed = history(case.arguments, orbit.raw, count)["speed"]
        cycle = np.asarray(call("trum_drive", case.values)["T"])[..., None]
        time = np.minimum(cycle * (np.arange(count) + 1) / count, np.nextafter(cycle, 0))
        wide = {
            name: value if np.ndim(value) == 0 else np.asarray(value)[..., None]
            for name, value in case.arguments.items()
        }
        now = surface_and_contact(wide, response(time, wide, wide["D"], wide["k_c"]))
        place = np.linspace(0, 1, 129) * np.asarray(now["theta"])[..., None]
        slip = np.asarray(now["R_v"])[..., None] * np.cos(place + np.asarray(now["phi"])[..., None]) - speed[..., None]
        roots = (np.sign(slip[..., 1:]) != np.sign(slip[..., :-1])).sum(axis=-1)
        found.append((roots == 1).mean(axis=-1))
    return np.stack(found)


def _one_point(c: Context) -> Finding:
    inertia = np.asarray(c.motor.rotor_inertia.value) + LOAD_INERTIA
    share = np.stack([_points(c.motor.with_values({"rotor_inertia": value})) for value in inertia])
    holds = (share == 1)[..., None]
    return of_rotor(
        ByInertia(holds, None, holds[0], None, measured=False),
        f"percentage of Table 3's cycle with exactly one point between crest and edge that is as fast as the rotor "
        f"{LOADS}: {by_load(100 * share[:, :, :, 0], '.0f')}; friction and contact radius assumed",
        (DEFAULT,),
    )


def _reverses(c: Context) -> Finding:
    """Turns of the crest's speed in Table 3's cycle and under a continuous drive."""
    parts = [c.beat(_PULSES, region, np.inf, 64) for region in (REDU, ADDREDU, ADD)]
    Q = np.concatenate([part.Q for part in parts], axis=-1)
    turns = (np.sign(Q[..., 1:]) * np.sign(Q[..., :-1]) < 0).sum(axis=-1)
    f_n = c.readings.resonance_frequency[DEFAULT, POINTS.table_3]
    plain = modal_values(2 * np.pi * f_n, c.motor.damping_ratio.value, Drive(on_periods=20))
    still = np.asarray(response((np.arange(1280) + 0.5) / 1280 * 20 / (f_n + 3000), plain)["Q"])
    return Finding(
        (turns >= 2) & (still.min() > 0),
        f"the crest's speed changes its sign in Table 3's cycle {_cells(turns[:, :, 0, 0], '.0f')} times, under a "
        f"continuous drive {int((np.diff(np.sign(still)) != 0).sum())} times",
        levels=(DEFAULT,),
    )


def _rotor_alone(c: Context) -> Finding:
    """Mean speed and encoder's volatility by eq. 38 with the weight's inertia, over those with J alone."""
    change, corners = (
        np.stack(
            [
                np.asarray(figures[name])[RIG, ..., POINTS.table_3] / figures[name][:1, ..., POINTS.table_3] - 1
                for name in ("mean_speed", "encoder_volatility")
            ]
        )
        for figures in (c.readings.loaded, c.ranges)
    )
    holds, at = np.all(np.abs(change) < _NEAR, axis=(0, 1)), change[:, 0, :, :, 0, DEFAULT]
    J = float(np.asarray(c.motor.rotor_inertia.value))
    light, heavy = LOAD_INERTIA[RIG]
    words = (
        f"a torque plate adds {light:.1e} to {heavy:.1e} kg m^2, {light / J:.0f} to {heavy / J:.0f} times Table 1's J; "
        f"with the lightest the mean speed changes by {_cells(100 * at[0], '+.1f')} %, the encoder's volatility by "
        f"{_cells(100 * at[1], '+.1f')} %; alone is said up to {100 * _NEAR:.0f} %"
    )
    within = np.asarray(np.all(np.abs(corners) < _NEAR, axis=(0, 1)))
    return Finding(np.asarray(holds)[..., ROTOR_LEVELS], words, ROTOR_LEVELS, within)


CHECKS: Mapping[str, Check] = {
    "small-jitter": _jitter,
    "steadier": _steadier,
    "teeth-amplitude": _teeth_amplitude,
    "teeth-stiffness": _teeth,
    "affects-resonance": _affects,
    "linear-stator": _linear_stator,
    "amplitude-falls": _amplitude_falls,
    "rigid-metal": _rigid_metal,
    "steady-before": _before_t1,
    "steady-other": _constant,
    "grows-addredu": _grows(ADDREDU, "A", "T_addredu"),
    "keeps-add": _keeps,
    "grows-add": _grows(ADD, "B", "T_add"),
    "same-frequency": _same_frequency,
    "crest-at-rest": _at_the_crest,
    "half-beat": _half,
    "clockwise-add": _clockwise,
    "crest-height": _crest_height,
    "equal-curvature": _curvature,
    "one-point": _one_point,
    "reverses": _reverses,
    "rotor-alone": _rotor_alone,
}
