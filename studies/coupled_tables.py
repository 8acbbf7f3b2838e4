"""What the coupling makes of the paper's tables: Table 2's amplitudes, the resonance, Table 3's point.

Nothing is fitted; docs/coupling.md has what they print.

    python -m studies.coupled_tables table-2
    python -m studies.coupled_tables resonance
    python -m studies.coupled_tables table-3
    python -m studies.coupled_tables open
    python -m studies.coupled_tables branches
    python -m studies.coupled_tables starts 40
    python -m studies.coupled_tables spread 32
    python -m studies.coupled_tables layers
"""

from __future__ import annotations

import math
import sys

import numpy as np
from scipy.stats import qmc
from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.schedule import TERMINALS, Schedule
from trum_sym.model.coupled_orbit import (
    CoupledOrbit,
    coupled_orbits,
    followed,
    lap_values,
    one_phase,
    orbit_from,
    random_start,
    same_orbit,
    start_of,
)
from trum_sym.model.coupling import coupled_values, plain_waves, standing
from trum_sym.model.levels import Levels
from trum_sym.paper.published import TABLE_2

__all__ = ["amplitudes", "main"]

_TURN = 2 * math.pi
_CONTACT = Levels(coupling="contact")
_SOFT = 22.0  # times softer than the layer: the contact stiffness of the public simulation USM_SIM
_MASSES = (0.0, 0.02, 0.1)  # kg: none; a rotor of the motor's size in aluminium; with a plate
_TOLERANCE = 1e-4  # of one phase


def _contacts(motor: ts.Motor) -> dict[str, tuple[ts.Motor, Levels]]:
    layer = float(coupled_values(motor, ts.Drive(on_periods=20), _CONTACT)["k_N"])
    return {
        "layer": (motor, Levels()),
        "flange": (motor, Levels(compliance="flange")),
        f"layer/{_SOFT:g}": (motor.with_values({"contact_stiffness": layer / _SOFT}), Levels()),
    }


def _at_free_resonance(motor: ts.Motor, levels: Levels, force: float, offset: float = 0.0) -> ts.Drive:
    """A drive at the resonance of the stator without a rotor, or off it by so many Hz."""
    plain = ts.Drive(prepressure=force, on_periods=20, frequency_difference=0.0)
    values = coupled_values(motor, plain, Levels(compliance=levels.compliance, coupling="contact"))
    free = (float(values["omega_n0"]) - float(values["omega_n"])) / _TURN
    return ts.Drive(prepressure=force, frequency_difference=free + offset)


def amplitudes(motor: ts.Motor, levels: Levels, mass: float) -> list[CoupledOrbit]:
    """Phase A alone at the free resonance, at Table 2's prepressures."""
    return [
        one_phase(motor, _at_free_resonance(motor, levels, float(force)), levels, mass, tolerance=_TOLERANCE)
        for force in TABLE_2
    ]


def _shown(orbit: CoupledOrbit) -> str:
    return _marked(f"{1e6 * orbit.highest_wave:.1f}", orbit)


def _marked(text: str, orbit: CoupledOrbit) -> str:
    """In brackets where no orbit attracts; with the number of its cycles if it has several."""
    if not (orbit.closed and orbit.stable):
        return f"({text})"
    return text if orbit.cycles == 1 else f"{text} /{orbit.cycles}"


def table_2() -> None:
    """Amplitudes by contact and rotor's mass; in brackets where no period repeats the one before stably."""
    rows = [("measured", "", *(f"{1e6 * size:.1f}" for size in TABLE_2.values()))]
    for label, (motor, levels) in _contacts(ts.load_motor()).items():
        rows += [(label, f"{mass:g}", *map(_shown, amplitudes(motor, levels, mass))) for mass in _MASSES]
    print(tabulate(rows, ("contact", "rotor, kg", *(f"{force:g} N" for force in TABLE_2)), disable_numparse=True))


def resonance() -> None:
    """Drive frequency of the largest response, of the plain wave and of one phase, and eq. 6's resonance."""
    rows = []
    for label, (motor, levels) in _contacts(ts.load_motor()).items():
        for force in (160.0, 180.0, 210.0):
            drive = ts.Drive(prepressure=force, on_periods=20, load_torque=0.0)
            values = coupled_values(motor, drive, Levels(compliance=levels.compliance, coupling="contact"))
            offsets = np.arange(0.0, 601.0, 10.0)
            free = float(values["omega_n0"])
            waves = [plain_waves({**values, "omega_q": free + _TURN * offset}) for offset in offsets]
            plain = offsets[int(np.argmax([wave.amplitude[-1] for wave in waves]))]
            sizes = [
                one_phase(
                    motor, _at_free_resonance(motor, levels, force, offset), levels, 0.02, tolerance=_TOLERANCE
                ).highest_wave
                for offset in offsets[::2]
            ]
            single = offsets[::2][int(np.argmax(sizes))]
            most = 1e6 * max(wave.amplitude[-1] for wave in waves), 1e6 * max(sizes)
            rows.append((label, force, free / _TURN, values["omega_n"] / _TURN, plain, most[0], single, most[1]))
    head = (
        "contact",
        "N",
        "free, Hz",
        "eq. 6, Hz",
        "plain wave: up by, Hz",
        "um",
        "one phase, 0.02 kg: up by, Hz",
        "um",
    )
    print(tabulate(rows, head, floatfmt=("", ".0f", ".0f", ".0f", ".0f", ".2f", ".0f", ".2f")))


def table_3() -> None:
    """Table 3's point: wave prescribed or coupled, without and with the bench's plate, by contact."""
    motor = ts.load_motor()
    plate = float(motor.bench["load_inertia"].value)
    rows = []
    for label, (machine, levels) in _contacts(motor).items():
        for inertia in (0.0, plate):
            drive = ts.Drive(load_inertia=inertia)
            point = ts.evaluate(machine, drive, compliance=levels.compliance)
            swing = point.speed_volatility * abs(point.mean_speed)
            rows.append((label, inertia, "none", "", point.mean_speed, swing, 1e6 * point.amplitude, "", "", ""))
            for mass in _MASSES:
                values = lap_values(machine, drive, levels, rotor_mass=mass)
                for orbit in coupled_orbits(values):
                    most = f"{np.abs(orbit.multipliers).max():.2f}"
                    rows.append(
                        (
                            *(label, inertia, f"contact, {mass:g} kg", orbit.start, orbit.mean_speed, orbit.deviation),
                            *(
                                1e6 * orbit.highest_wave,
                                orbit.cycles if orbit.closed else "none",
                                most,
                                f"{orbit.mean_speed_error:.0e}" if orbit.closed else "",
                            ),
                        )
                    )
    head = (
        "contact",
        "J_load",
        "coupling",
        "from",
        "mean, rad/s",
        "deviation",
        "wave, um",
        "cycles",
        "multiplier",
        "error",
    )
    print(tabulate(rows, head, floatfmt=("", "g", "", "", ".2f", ".3f", ".2f", "", "", "")))


def open_terminals() -> None:
    """Table 3's point with a phase that is off short and open, by contact, rotor's mass and modal force."""
    motor, rows = ts.load_motor(), []
    for label, (machine, levels) in _contacts(motor).items():
        for amplitude in ("measured", "forced"):
            for mass in _MASSES:
                both = Levels(compliance=levels.compliance, amplitude=amplitude)
                row: list[str] = [label, amplitude, f"{mass:g}"]
                for terminals in TERMINALS:
                    schedule = Schedule(off_terminals=terminals)
                    values = lap_values(machine, ts.Drive(), both, schedule, rotor_mass=mass)
                    orbit = orbit_from(values, start_of("steady", values), "steady")
                    row += [_marked(f"{orbit.mean_speed:.2f}", orbit), f"{orbit.deviation:.2f}", _shown(orbit)]
                rows.append(row)
    figures = ("mean, rad/s", "deviation", "wave, um")
    head = ("contact", "force", "rotor, kg", *(f"{of} {name}" for of in TERMINALS for name in figures))
    print(tabulate(rows, head, disable_numparse=True))


def branches() -> None:
    """Mean speed at Table 3's point while the frequency rises and falls.

    In brackets where no orbit attracts, with /2 or /3 where it repeats after two or three cycles.
    """
    motor, offsets = ts.load_motor(), np.arange(2500.0, 3501.0, 100.0)
    rows = []
    for label, levels in (("layer", Levels()), ("flange", Levels(compliance="flange"))):
        for mass in _MASSES:
            points = [
                lap_values(
                    motor, ts.Drive(frequency_difference=float(f)), levels, rotor_mass=mass, tolerance=_TOLERANCE
                )
                for f in offsets
            ]
            for way, orbits in (("up", followed(points)), ("down", followed(points[::-1])[::-1])):
                rows.append((label, f"{mass:g}", way, *(_marked(f"{o.mean_speed:.2f}", o) for o in orbits)))
    head = ("contact", "rotor, kg", "", *(f"{f:g}" for f in offsets))
    print(tabulate(rows, head, disable_numparse=True))


def starts(count: int) -> None:
    """Orbits at Table 3's point from starts at random, with how many lead to each."""
    motor, at = ts.load_motor(), np.random.default_rng(0)
    rows = []
    for label, levels in (("layer", Levels()), ("flange", Levels(compliance="flange"))):
        for mass in _MASSES:
            values = lap_values(motor, ts.Drive(), levels, rotor_mass=mass, tolerance=_TOLERANCE)
            begun = [random_start(values, at) for _ in range(count)]
            orbits = [orbit_from(values, start, "random") for start in begun]
            none = sum(not (orbit.closed and orbit.stable) for orbit in orbits)
            different: list[list[CoupledOrbit]] = []
            for orbit in (orbit for orbit in orbits if orbit.closed and orbit.stable):
                alike = next((group for group in different if same_orbit(values, group[0], orbit)), None)
                if alike is None:
                    different.append([orbit])
                else:
                    alike.append(orbit)
            shown = [
                f"{_marked(f'{group[0].mean_speed:.2f}', group[0])} ({len(group)})"
                for group in sorted(different, key=len, reverse=True)
            ]
            rows.append((label, f"{mass:g}", ", ".join(shown), none or ""))
    print(tabulate(rows, ("contact", "rotor, kg", "mean, rad/s (starts)", "none"), disable_numparse=True))


def spread(count: int) -> None:
    """Table 2's amplitudes over what is assumed: 5, 50 and 95 % of the samples, and what carries them by rank."""
    motor = ts.load_motor()
    names = ("contact stiffness", "rotor's mass", "friction", "damping", "off the free resonance")
    low = np.array([math.log(8e8), math.log(0.02), 0.2, 0.005, -50.0])
    high = np.array([math.log(3e10), math.log(0.1), 0.3, 0.007, 50.0])
    draws = low + (high - low) * qmc.Sobol(len(names), seed=0).random(count)
    found = np.zeros((count, len(TABLE_2)))
    for row, draw in enumerate(draws):
        at = {"contact_stiffness": math.exp(draw[0]), "friction_coefficient": draw[2], "damping_ratio": draw[3]}
        machine = motor.with_values({name: float(value) for name, value in at.items()})
        for column, force in enumerate(TABLE_2):
            drive = _at_free_resonance(machine, Levels(), float(force), float(draw[4]))
            found[row, column] = (
                1e6 * one_phase(machine, drive, Levels(), math.exp(draw[1]), tolerance=_TOLERANCE).highest_wave
            )
    quantiles = [(f"{share:.0%}", *np.quantile(found, share, axis=0)) for share in (0.05, 0.5, 0.95)]
    measured = ("measured", *(1e6 * size for size in TABLE_2.values()))
    print(tabulate([measured, *quantiles], ("", *(f"{force:g} N" for force in TABLE_2)), floatfmt=".1f"))
    ranks = draws.argsort(0).argsort(0)
    rows = []
    for column in (0, 4, 6):
        of = found[:, column].argsort().argsort()
        rows.append((f"{list(TABLE_2)[column]:g} N", *(np.corrcoef(ranks[:, k], of)[0, 1] for k in range(len(names)))))
    print(tabulate(rows, ("rank correlation at", *names), floatfmt=".2f"))


def layers() -> None:
    """The plain wave at +500 Hz, 180 N: a layer that loses, one that is sheared, without load and loaded."""
    rows = []
    motor = ts.load_motor()
    stall = float(motor.friction_coefficient.value) * 180.0 * float(motor.contact_radius.value)
    for compliance in ("layer", "flange"):
        for tangential, loss in (("rigid", 0.0), ("rigid", 0.05), ("rigid", 0.1), ("rigid", 0.2), ("brush", 0.0)):
            machine = motor.with_values({"layer_loss_factor": loss})
            levels = Levels(coupling="contact", compliance=compliance, tangential=tangential)  # type: ignore[arg-type]
            found = []
            for share in (0.0, 0.49):
                drive = ts.Drive(on_periods=20, frequency_difference=500.0, load_torque=share * stall)
                values = coupled_values(machine, drive, levels)
                waves = plain_waves(values)
                found.append((values, waves, waves.highest))
            (values, free, at), (_, loaded, under) = found
            height, force = standing(values)
            rows.append(
                (
                    compliance,
                    "sheared" if tangential == "brush" else f"{loss:g}",
                    1e6 * free.amplitude[at],
                    (free.resonance[at] - values["omega_n0"]) / _TURN,
                    free.speed[at],
                    free.layer_power[at],
                    1e6 * loaded.amplitude[under],
                    loaded.speed[under] / free.speed[at],
                    loaded.layer_power[under],
                    100 * loaded.output_power[under] / loaded.input_power[under],
                    1e9 * height,
                    force / values["F_q"] * values["U_s"],
                )
            )
    head = ("contact", "layer", "um", "up, Hz", "rad/s", "lost, W", "um", "kept", "lost, W", "%", "stands, nm", "V")
    print(tabulate(rows, head, floatfmt=".4g"))


def main(arguments: list[str]) -> int:
    """Print one of the tables."""
    tables = {"table-2": table_2, "resonance": resonance, "table-3": table_3, "open": open_terminals}
    tables["branches"] = branches
    tables["layers"] = layers
    counted = {"spread": (spread, 32), "starts": (starts, 40)}
    if arguments and arguments[0] in counted:
        run, usual = counted[arguments[0]]
        run(int(arguments[1]) if len(arguments) > 1 else usual)
    elif len(arguments) == 1 and arguments[0] in tables:
        tables[arguments[0]]()
    else:
        print(f"one of {', '.join([*tables, *counted])}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
