"""Which assumption carries Table 2's amplitudes and the resonance under prepressure: Sobol indices of the coupled wave.

    python -m studies.coupled_sobol table-2 64 sobol.jsonl
    python -m studies.coupled_sobol resonance 64

The design and its estimators are those of ``trum-sym spread`` (:mod:`trum_sym.uncertainty.propagation`); the number is
that of its rows, a power of two from 64 on.  A file keeps what Table 2's points come to, a line a point; a run takes up
where it ends, and one of more rows keeps those of fewer.  docs/coupling.md has what they print.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from tabulate import tabulate

import trum_sym as ts
from trum_sym.inputs.checks import Array
from trum_sym.inputs.plausible import unquestioned
from trum_sym.model.coupled_orbit import one_phase
from trum_sym.model.coupling import coupled_values, wave_at
from trum_sym.model.levels import Levels
from trum_sym.output.progress import shown
from trum_sym.paper.published import TABLE_2
from trum_sym.uncertainty.propagation import Propagation, propagate

__all__ = ["amplitudes", "main", "own_resonance", "spans"]

_TURN = 2 * math.pi
_CONTACT = Levels(coupling="contact")
_TOLERANCE = 1e-3  # of one phase's orbit
_ROUNDS = 6  # of a wave's height at its own resonance


def spans(*, one: bool) -> dict[str, tuple[float, float, bool]]:
    """Ends of what is assumed, and whether its logarithm is uniform; of ``one`` phase, or of a plain wave."""
    shared = {
        "contact_stiffness": (8e8, 3e10, True),  # from USM_SIM's to the layer's alone
        "friction_coefficient": (0.2, 0.3, False),
        "damping_ratio": (0.005, 0.007, False),
    }
    if one:
        return {**shared, "rotor_mass": (0.02, 0.1, True), "offset": (-50.0, 50.0, False)}  # kg; Hz off the free one
    return {**shared, "piezo_width": (6e-3, 8e-3, False)}  # the motor file's range: mass and free resonance


def _quantiles(chosen: Mapping[str, tuple[float, float, bool]]) -> dict[str, object]:
    def of(low: float, high: float, log: bool) -> object:
        if log:
            return lambda level: low * (high / low) ** np.asarray(level)
        return lambda level: low + (high - low) * np.asarray(level)

    return {name: of(*span) for name, span in chosen.items()}


def _free(values: Mapping[str, float]) -> float:
    """By how many Hz eq. 6's resonance is below that without a rotor."""
    return (float(values["omega_n0"]) - float(values["omega_n"])) / _TURN


def _amplitude(at: Mapping[str, float], force: float) -> float:
    """Of phase A alone at the free resonance or off it, um."""
    named = ("contact_stiffness", "friction_coefficient", "damping_ratio")
    machine = ts.load_motor().with_values({name: at[name] for name in named})
    plain = ts.Drive(prepressure=force, on_periods=20, frequency_difference=0.0)
    off = _free(coupled_values(machine, plain, _CONTACT)) + at["offset"]
    drive = ts.Drive(prepressure=force, frequency_difference=off)
    return 1e6 * one_phase(machine, drive, Levels(), at["rotor_mass"], tolerance=_TOLERANCE).highest_wave


def amplitudes(forces: tuple[float, ...], draws: Mapping[str, Array], file: Path | None = None) -> dict[str, Array]:
    """Phase A's amplitude in um at each draw, by prepressure in N; what a file has is taken from there."""
    rows = [dict(zip(draws, map(float, row), strict=True)) for row in zip(*draws.values(), strict=True)]
    known: dict[str, list[float]] = {}
    if file is not None and file.exists():
        lines = file.read_text(encoding="utf-8").splitlines()
        known = {json.dumps([line["at"], line["forces"]]): line["um"] for line in map(json.loads, lines)}
    for at in shown([at for at in rows if json.dumps([at, list(forces)]) not in known], "table-2"):
        found = [_amplitude(at, force) for force in forces]
        known[json.dumps([at, list(forces)])] = found
        if file is not None:
            with file.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps({"at": at, "forces": list(forces), "um": found}) + "\n")
    table = np.array([known[json.dumps([at, list(forces)])] for at in rows])
    return {f"{force:g} N": table[:, k] for k, force in enumerate(forces)}


def own_resonance(values: Mapping[str, float]) -> float:
    """Angular frequency at which the modal force is a quarter of a period ahead of a plain wave without load.

    There it makes up for damping and friction alone, which gives the height; pressure and height give the frequency.
    """
    height, own = 0.0, float(values["omega_n0"])
    turn = own
    friction = 0.0
    for _ in range(_ROUNDS):
        damper = 2 * float(values["xi"]) * own * float(values["M_q"]) * turn
        height = (float(values["F_q"]) - friction) / damper
        wave = wave_at({**values, "omega_q": turn}, np.array([height]))
        turn = float(wave.resonance[0])
        friction = float(wave.contact_power[0]) / (turn * height)
    return turn


def _shifts(forces: tuple[float, ...], draws: Mapping[str, Array]) -> dict[str, Array]:
    """Of the plain wave's own resonance over that without a rotor, Hz."""
    motor = ts.load_motor()
    rows = next(iter(draws.values())).size
    found = {f"{force:g} N": np.full(rows, np.nan) for force in forces}
    for k in range(rows):
        machine = motor.with_values({name: float(draws[name][k]) for name in draws})
        for force in forces:
            plain = ts.Drive(prepressure=force, on_periods=20, load_torque=0.0)
            values = coupled_values(machine, plain, _CONTACT)
            found[f"{force:g} N"][k] = (own_resonance(values) - float(values["omega_n0"])) / _TURN
    return found


def _printed(found: Propagation, unit: str, names: Mapping[str, object]) -> str:
    """Quantiles, and first and total index of each, with 95 % intervals."""
    rows = []
    for output, indices in found.indices.items():
        assert indices is not None
        spread = found.spread(output)
        low, middle, high = (spread.quantiles[level].value for level in (0.05, 0.5, 0.95))
        for name in names:
            first, total = indices.first[name], indices.total[name]
            rows.append(
                (
                    output if name == next(iter(names)) else "",
                    f"{low:.3g} {middle:.3g} {high:.3g}" if name == next(iter(names)) else "",
                    name.replace("_", " "),
                    f"{first.value:.2f} ({first.low:.2f} to {first.high:.2f})",
                    f"{total.value:.2f} ({total.low:.2f} to {total.high:.2f})",
                )
            )
    head = ("", f"5, 50, 95 %, {unit}", "assumed", "first order", "total")
    return str(tabulate(rows, head, disable_numparse=True))


def main(arguments: list[str]) -> int:
    """Print one of the studies."""
    file = Path(arguments[2]) if len(arguments) == 3 and arguments[0] == "table-2" else None
    studies: dict[str, tuple[bool, Callable[[Mapping[str, Array]], Mapping[str, Array]], str]] = {
        "table-2": (True, lambda draws: amplitudes(tuple(map(float, TABLE_2)), draws, file), "um"),
        "resonance": (False, lambda draws: _shifts((160.0, 180.0, 210.0), draws), "Hz above the free one"),
    }
    if len(arguments) != 2 + (file is not None) or arguments[0] not in studies or not arguments[1].isdecimal():
        print(
            f"{' or '.join(studies)}, the design's rows, a power of two from 64 on, and table-2's file", file=sys.stderr
        )
        return 2
    one, function, unit = studies[arguments[0]]
    chosen = spans(one=one)
    with unquestioned():  # samples go beyond what the motor file states
        found = propagate(function, _quantiles(chosen), samples=int(arguments[1]))  # type: ignore[arg-type]
    print(_printed(found, unit, chosen))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
