"""Branch coverage of the generated C and of its drivers, by gcov.

python tests/driver/c_coverage.py          prints a table, and every branch of the drivers that nothing takes

Every kernel is called with random arguments, with null arguments and results, and asked for its names; the drivers run
through operating points at every level and edge, and through coupled laps.  ``tests/derivations/test_generated.py``
compares the same kernels with 50 digits, ``tests/driver/test_c_library.py`` with these.
"""

from __future__ import annotations

import itertools
import json
import math
import random
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FLAGS = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-pedantic", "-Werror"]
DRIVER = ROOT / "trum_sym" / "_driver"
FOLDERS = [ROOT / "generated", DRIVER, ROOT / "examples" / "c"]

# Branches that no input takes, by their header (or its folder) and the beginning of their line, and why
ONE_LANE = "one lane: the batches of the Python package take it"
LAPS = "a limit of the search for the orbit that no point tried has met"
LONG = "none of the few long schedules that are run here takes it"
NEVER = {
    "trum_point.h": {
        "point->speed_volatility_error": "no mean speed that was tried has an open sign",
        "} else if (error <= drive->tolerance)": "rounding alone has met every tolerance that was tried",
        "return A > 10 || B > 10;": "free motion that lasts is much the same in both phases",
    },
    "trum_coupled.h": {
        "if (!(x >= 0 && x <= 1)) x = ": "no cubic that was tried has its extreme at another root",
        "if (!(s.h > 0)) break;": "rounding of an extreme where a step begins",
        "for (count = 0; count < trum_coupled_most": "no period that was tried takes two million steps",
        "if (count == trum_coupled_most) return 0;": "no period that was tried takes two million steps",
    },
    "trum_coupled_step.h": {"for (i = 0; i < TRUM_LANES && g * TRUM_LANES": ONE_LANE},
    "trum_brush.h": {"for (k = 0; k < 16": "a bristle sticks and slides three times at most"},
    "trum_cycle.h": {
        "for (i = 0; i < 200": "a bracket halved this often is closed before",
        "if (!(k->m > TRUM_C(0.5) + TRUM_REPEATS_BEYOND": "without damping a long schedule takes too long here",
        "time = size > 0 ? trum_log(size": "no region of a long schedule that was tried begins without free motion",
        "return time < 0 ? 0 : time < c->duration": "no region that was tried begins with almost no free motion",
    },
    "orbit": {
        "static int mask_in_lane(": ONE_LANE,
        "static mask where_mask(": ONE_LANE,
        "if (lanes->record && mask_in_lane(accepted, 0))": ONE_LANE,
        "if (!mask_in_lane(ended, i)) continue;": ONE_LANE,
        "busy[i] = trum_begin_coarse_orbit(": ONE_LANE,
        "if (i < count) found[i].found": ONE_LANE,
        "trum_search* search = &searches[work[i].search < 0": ONE_LANE,
        "return !search->done && (search->side_by_side": ONE_LANE,
        "batch->count - first < TRUM_LANES": ONE_LANE,
        "const long end = count - first < TRUM_AT_ONCE": ONE_LANE,
        "if (i > 0) set_lane_mask(": ONE_LANE,
        "const int beyond = r->written == r->count": "rounding of a history's last time, which may fall to either side",
        "z = z < 0 ? 0 : z > 1": "rounding of a history's times, which may fall to either side",
        "for (k = 0; k < 200": "a bracket halved this often is closed before",
        ": trum_sqrt(error / (lane_value(": "a balance at the contact's edge: no load tried is so near the largest",
        "if (error <= in->tolerance * trum_fabs(out->mean))": "rounding alone has met every tolerance that was tried",
        "out->low = out->low < out->mean": "rounding of nearly equal speeds, which may fall to either side",
        "out->variance = variance > 0": "rounding of a variance of nearly 0, which may fall to either side",
        "if (in[k].held > TRUM_C(0.5) && !known": "no lap of a held rotor that was tried has missed its bounds",
        "const int known = out[k].held_error": "no lap of a held rotor that was tried has missed its bounds to the end",
        "if (!(b->high > start": LAPS,
        "if (!(b->low < start": LAPS,
        "if (s->known && next > b->sure_low": LAPS,
        "if (!with_slopes(lanes) && !met": LAPS,
        "if (++search->refinements <= 12) search->level": LAPS,
        "if (s->certain || s->loose) return next;": LAPS,
        "} else if (search->laps == 1) {": LAPS,
        "if (width <= TRUM_C(0.5) * allowed": LAPS,
        "next = search->bracket.high - middle": LAPS,
        "if (next < search->bracket.high &&": LAPS,
        "return trum_fabs(change) > search->in->tolerance": LAPS,
        "if ((trum_fabs(change) <= nearly": LAPS,
        "search->bracket.high - search->bracket.low <= nearly": LAPS,
        "if (s->last) {": LAPS,
        "else if (s->last) search->out->flags": LAPS,
        "if (known_start) next = search->start_speed": LAPS,
        "} else if (!trum_finish_rough_lap(": LAPS,
        "if (in[k].held > TRUM_C(0.5) && isnan(out[k].held)": "a motion that cannot be followed held nor free",
        "if (s.last) {": LAPS,
        "return reach > trum_least_counted": LONG,
        "static int trum_is_long(": LONG,
        "const trum_real reversal = share < 1": LONG,
        "return (friction > contact ? friction": LONG,
        "trum_real length = r->waiting": LONG,
        "r->watched = length <": LONG,
        "if (length < 1) length = 1;": LONG,
        "if (length > r->left) length": LONG,
        "r->left -= length,": LONG,
        "for (k = 0; k < 60 && high": LONG,
        "r->waiting = !(a > low)": LONG,
        "const trum_real decay = held ? 1 : 1 - kept_error": LONG,
        "set_lane(&lap->remainder, i, (added": LONG,
        "if (r->left < TRUM_C(0.5)) return 0;": LONG,
        "if (search->repetition.is_long && record.written": "no long history ended with a step",
        "if (mask_in_lane(lanes->status.failed, 0)": "a history repeats a lap that came to its end",
    },
}

STARTS, CONTACTS = ("periodic", "steady", "rest"), ("winkler", "hertz")
RESONANCES = ("quartic", "eq6", "printed", "euler")
FOUNDATIONS = ("harmonic", "smeared", "printed", "none")
LINE_OF_CONTACT = (
    "layer_young_modulus=1e15 amplitude=5e-6 resonance_frequency=39e3 on_periods=20 start=steady load_torque=0"
)
HOSTILE = ("nan", "inf", "-inf", "0", "-1", "1e308", "-1e308", "1e-308", "1e30")


def levels() -> list[str]:
    """Table 3 at every level and start."""
    every = itertools.product(STARTS, CONTACTS, RESONANCES, FOUNDATIONS)
    found = [f"start={s} contact={c} resonance={r} foundation={f}" for s, c, r, f in every]
    return found + [f"start={s} contact={c} amplitude=forced load_torque=0.05" for s in STARTS for c in CONTACTS]


def edges() -> list[str]:
    """Points that reach what Table 3 does not."""
    return [
        "tolerance=1e-9 load_torque=0.05",
        "tolerance=1e-9 contact=hertz load_torque=0.05",
        "tolerance=1e-6 start=rest load_torque=0.1 phase_lead=-1",
        "load_torque=2",  # runaway
        "load_torque=-2",
        "load_torque=0 friction_coefficient=0",
        "load_torque=0.01 friction_coefficient=0",
        "prepressure=400 load_torque=0.1",
        "prepressure=20 load_torque=0.01",
        "prepressure=5000",  # the whole wave in contact
        "damping_ratio=1e-5 frequency_difference=2054.92 load_torque=0.05",  # free motion adds up from cycle to cycle
        "prepressure=5000 contact=hertz",
        "prepressure=50000 load_torque=0.1 start=rest",
        "prepressure=50000 load_torque=0.1 start=rest contact=hertz amplitude=5e-6",
        "on_periods=20 load_torque=0.05",
        "on_periods=10 load_torque=0.05",
        "periods=1 on_periods=1",
        "periods=100 on_periods=60 load_torque=-0.1 switching_phase=1.3",
        *(f"{LINE_OF_CONTACT} tolerance={x}" for x in (1e-2, 1e-4)),
        "load_torque=0.05 tolerance=1e-2",
        "rotor_inertia=1e-9 load_torque=0.05",
        "rotor_inertia=1e-9 load_torque=0.05 tolerance=1e-6",
        "rotor_inertia=10 load_torque=0.05",
        "rotor_inertia=1e-14 load_torque=0.05 tolerance=1e-9",
        "damping_ratio=0 start=rest",
        "damping_ratio=0",
        "damping_ratio=0 frequency_difference=0",
        "damping_ratio=0 resonance_frequency=40000 frequency_difference=2000 periods=42 on_periods=21",
        "frequency_difference=0 load_torque=0.05",
        "frequency_difference=-36000",
        "frequency_difference=-30000 load_torque=0.01",
        "frequency_difference=-3000 phase_lead=-1 switching_phase=0.5 load_torque=-0.05",
        "resonance_frequency=39703 amplitude=5.5e-6 neutral_axis=2.9e-3 wavenumber=300 layer_stiffness=3e10",
        "resonance_frequency=39703 frequency_difference=3000 amplitude=5.5e-6 foundation=none",
        "compliance=flange load_torque=0.05",
        "contact_stiffness=2e9 load_torque=0.05",
        *(f"compliance=flange flange_{x}=0" for x in ("thickness", "length", "young_modulus", "poisson_ratio")),
        "compliance=flange flange_young_modulus=1e-300",
        "compliance=flange flange_young_modulus=1e-320",
        "compliance=flange contact=hertz",
        "load=weight",
        "load_radius=0.03",
        *(f"load=weight load_radius=0.03 load_inertia={x} start=rest phase_lead=-1" for x in (0, 4e-3)),
        "compliance=flange contact_stiffness=2e9 load_torque=0.05",
        "on_periods=20 tangential=brush load_torque=-2",
        "flange_thickness=4.5e-3",
        "flange_length=0.03",
        *(f"on_periods=20 tangential=brush load_torque={x}" for x in (0, 0.4, 1.19, 1.1925, 2, -0.4)),
        *(f"on_periods=20 tangential=brush tangential_stiffness={x} load_torque=0.8" for x in (1e3, 1e9, 1e25)),
        "on_periods=20 tangential=brush layer_stiffness=1e9 load_torque=1.19 amplitude=2e-6 tangential_stiffness=1e8",
        "on_periods=20 tangential=brush contact=hertz",
        "on_periods=20 tangential=brush start=rest",
        "on_periods=20 tangential=brush friction_coefficient=0",
        "on_periods=20 tangential=brush prepressure=5000",  # the whole wave in contact
        "tangential=brush",
        "tooth_height=4.5e-3",
        "fit_prepressure_min=220",
        "slot_width=2.7e-3",
        "on_periods=9",
        "on_periods=21",
        "phase_lead=0",
        "tolerance=1",
        "tolerance=1e-12",
        *(f"max_steps={x}" for x in (-1, 1, 3000, 100000)),
        "beam_density=1e300",
        "voltage=1e30 amplitude=forced",
        "voltage=1e-30 amplitude=forced",
        "piezo_strain_constant=0 amplitude=forced",
        "amplitude_factor=1e300",
        "periods=20.5",
        "damping_ratio=0 frequency_difference=-3000 start=rest",
        "prepressure=1e5 resonance_frequency=40000",  # eq. 8 below zero
        "resonance_frequency=40000 amplitude=5e-6 foundation=none beam_young_modulus=1e308 piezo_young_modulus=1e308",
        "resonance_frequency=40000 amplitude=5e-6 foundation=none radius=1e-308 flange_length=1e-310",
        "amplitude=forced foundation=smeared frequency_difference=5.053 prepressure=205.2 damping_ratio=0.000116 "
        "voltage=1420 periods=4 on_periods=3",  # never settles
        "nothing=1",
        "prepressure",
        "prepressure=",
        "start=never",
        "start=period",
        *(f"{name}={value}" for name in ("prepressure", "periods", "load_torque", "radius") for value in HOSTILE),
        *(f"amplitude=forced damping_ratio={x} frequency_difference={d}" for x in (1e-6, 0.1) for d in (1, 300)),
        *(f"start=rest load_torque={x} prepressure={f}" for x in (0, 0.05, 0.2) for f in (120, 250)),
        # next to the largest load, where rounding is more than the tolerance
        "prepressure=126.63766228978255 frequency_difference=1739.2558872099016 periods=17 on_periods=13 "
        "switching_phase=0.7682100302699351 load_torque=0.8389724070748523 tolerance=1e-9",
        "prepressure=137.60855866840302 frequency_difference=-4037.919922805594 periods=4 on_periods=3 start=steady "
        "switching_phase=2.00537160082148 load_torque=0.9116529796267492 tolerance=1e-9",
    ]


def wild(count: int, seed: int = 20211110, inertia: tuple[float, float] = (-9, 0)) -> list[str]:
    """Points anywhere in a wide domain, of any tolerance; the inertia by its exponents."""
    rng = random.Random(seed)
    found = []
    for i in range(count):
        m = rng.randint(4, 40)
        load = rng.uniform(-0.9, 0.9) * 0.0265 * 0.25 * 180
        found.append(
            f"rotor_inertia={10 ** rng.uniform(*inertia)} friction_coefficient={rng.uniform(0.05, 0.5)} periods={m} "
            f"on_periods={rng.randint((m + 1) // 2, m)} prepressure={rng.uniform(20, 400)} load_torque={load} "
            f"frequency_difference={rng.uniform(-5000, 5000)} switching_phase={rng.uniform(0, 6.28)} "
            f"phase_lead={rng.choice((-1, 1))} start={STARTS[i % 3]} contact={CONTACTS[i % 2]} "
            f"tolerance={10 ** rng.uniform(-9, -2)}"
        )
    return found


def limits(count: int, seed: int = 20211110) -> list[str]:
    """Random points with loads near the largest, where the search for the orbit needs its brackets."""
    rng = random.Random(seed)
    found = []
    for i in range(count):
        m, force = rng.randint(1, 12), rng.uniform(100, 220)
        load = rng.choice((-1, 1)) * (1 - 10 ** rng.uniform(-6, -1)) * 0.0265 * 0.25 * force
        found.append(
            f"periods={m} on_periods={rng.randint((m + 1) // 2, m)} prepressure={force} load_torque={load} "
            f"frequency_difference={rng.uniform(-5000, 5000)} start={STARTS[i % 3]} contact={CONTACTS[i % 2]} "
            f"tolerance={10 ** rng.uniform(-9, -2)}"
        )
    return found


def friction() -> list[str]:
    """The friction kernels where the crest is more than a turn off: pi below and above the range of atan2."""
    found = []
    for phi, v in itertools.product((-6.0, -3.0, 0.3, 3.0, 6.0), (-2.0, -0.5, 0.3, 0.9, 2.0)):
        found.append(f"kernel trum_friction 1.2 {math.cos(phi)} 40 {phi} -38 {math.sin(phi)} 0.39 0.4 {v}")
        found.append(f"kernel trum_friction_slopes 1.2 {math.cos(phi)} 40 {phi} -38 {math.sin(phi)} 0.39 0.4 {v}")
        for theta in (0.4, 3.1):
            crest, contact = f"{math.cos(phi)} {math.cos(theta)} 1.2", f"{math.sin(phi)} {math.sin(theta)} {theta}"
            found.append(f"kernel trum_coupled_forces 0.003 180 1 1 {crest} 300 0.25 {phi} -0.4 0 {contact} {v}")
    return found + [f"kernel trum_interface 180 0.4 1 1.4 300 0.25 9 -0.4 0 {v} 1e-3 1e-3" for v in (-1, 1)]


def layer() -> list[str]:
    """A lossy layer whose zone of reversed slip lies inside the contact, and a turn above and below it."""
    zones = ((0.5, -0.5), (7.0, 0.0), (0.0, -7.0))
    return [f"kernel trum_layer_reaction 180 0.3 0.2 0.25 0.4 1.4 -1.3 {high} {low}" for high, low in zones]


def script() -> str:
    """What the harness is told to do."""
    lines = [f"point {line}" for line in ("", *levels(), *edges(), *wild(120), *wild(40, 7, (-14, 5)), *limits(60))]
    lines += friction() + layer()
    lines += [f"simulate {count} load_torque=0.05 {more}" for count in (0, 1, 1000) for more in ("", "contact=hertz")]
    lines += ["simulate 100 load_torque=0.05 on_periods=20 tangential=brush"]
    lines += [f"simulate 10 load_torque=0.05 tolerance=1e-3 max_steps={x}" for x in (2454, 4928)]
    lines += ["simulate 700 load_torque=0.05 start=rest tolerance=1e-6", "simulate 3 load_torque=2", "edges"]
    return "\n".join(lines) + "\n"


def laps() -> str:
    """What the harness of coupled laps is told to do."""
    coarse, moved = "lap.tolerance=1e-6", "lap.w_A=1e-6 lap.v_A=0.2 lap.w_B=-5e-7 lap.v_B=0.3 lap.v=0.05"
    burst = f"{coarse} {moved} lap.off_A=2 lap.off_B=2 compliance=flange load_torque=0 frequency_difference=500"
    refused = ("start=steady", "contact=hertz", "on_periods=20 tangential=brush", "amplitude=5e-6", "prepressure=-1")
    lines = [
        *(f"{mass} 1 {coarse} {more}" for mass in (0, 0.02) for more in ("", moved, f"{moved} compliance=flange")),
        *(f"{mass} 1 {coarse} {moved} lap.K_o=9e7 {more}" for mass in (0, 0.02) for more in ("", "lap.driven_B=0")),
        *(f"0.02 1 {coarse} resonance_frequency=39703 {more}" for more in ("", "amplitude=forced foundation=none")),
        f"0.1 0.4 amplitude=forced {coarse}",
        *(f"0 1 {coarse} {more}" for more in ("load_torque=1.5", "on_periods=10", "on_periods=20")),
        *(f"{mass} 1 {burst} lap.m=300 lap.on_A=299 lap.on_B=300" for mass in (0, 0.02)),
        f"0 1 {burst} lap.m=300 lap.on_A=300 lap.on_B=299",
        "0 1 lap.m=2.5",
        "0.02 1 lap.w_A=nan",
        "0.02 1 lap.tolerance=0 lap.m=1",
        f"0.02 1 lap.tolerance=1e-14 lap.m=1 {moved}",
        *(f"0.02 1 {word}" for word in (*refused, "friction_coefficient=0", "damping_ratio=0", "beam_density=1e300")),
        *("-1 1", "0.02 2", "0.02 1 resonance_frequency=1 frequency_difference=0"),
    ]
    return "\n".join(lines) + "\n"


def build(folder: Path, flags: Iterable[str] = (), name: str = "coverage") -> Path:
    """Compile a harness with the kernels."""
    sources = [ROOT / "tests" / "driver" / f"c_{name}.c", *sorted((ROOT / "generated").glob("trum_*.c"))]
    command = ["cc", *FLAGS, *flags, *(f"-I{path}" for path in FOLDERS), *map(str, sources), "-lm", "-o", "harness"]
    subprocess.run(command, cwd=folder, check=True)
    return folder / "harness"


Branch = tuple[str, int, int]


def measured(folder: Path) -> Mapping[str, Mapping[Branch, int]]:
    """How often each branch was taken: by file, then by function, line and the branch's place in it."""
    counts: dict[str, dict[Branch, int]] = defaultdict(lambda: defaultdict(int))
    for notes in sorted(folder.glob("*.gcno")):
        out = subprocess.run(
            ["gcov", "--json-format", "--stdout", "--branch-probabilities", notes.name],
            cwd=folder,
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for part in (json.loads(line) for line in out.splitlines() if line):
            for file in part["files"]:
                if ROOT not in Path(file["file"]).parents:
                    continue
                for line in file["lines"]:
                    for place, branch in enumerate(line["branches"]):
                        key = (line.get("function_name", ""), line["line_number"], place)
                        counts[Path(file["file"]).name][key] += branch["count"]
                    counts[Path(file["file"]).name]  # a file without branches is listed as well
    return counts


def ran(name: str, told: str) -> Mapping[str, Mapping[Branch, int]]:
    """How often each branch was taken by a harness that was told something."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        harness = build(folder, ["-O0", "--coverage", "-DTRUM_SEGMENTS=16"], name)
        subprocess.run([harness], input=told, text=True, check=True, cwd=folder, capture_output=True)
        return measured(folder)


def main() -> int:
    """Print the table; 1 if a branch of the generated C is never taken, or one of the drivers without a reason."""
    counts = {**ran("coupled", laps()), **ran("coverage", script())}  # what is in both counts by the second
    print(f"{'file':32}{'branches':>10}{'taken':>8}{'share':>9}")
    missing = 0
    for file, branches in sorted(counts.items()):
        taken = sum(count > 0 for count in branches.values())
        share = 100.0 * taken / len(branches) if branches else 100.0
        print(f"{file:32}{len(branches):10}{taken:8}{share:8.2f}%")
    for file, branches in sorted(counts.items()):
        if file in ("c_coverage.c", "c_coupled.c", "main.c"):  # their untaken branches are failures that did not happen
            continue
        path = next(folder / file for folder in (*FOLDERS, DRIVER / "orbit") if (folder / file).exists())
        text = path.read_text().splitlines()
        place = "orbit" if path.parent == DRIVER / "orbit" else file
        for line, sides in sorted(Counter(line for (_, line, _), count in branches.items() if not count).items()):
            code = text[line - 1].strip()
            reason = next((why for start, why in NEVER.get(place, {}).items() if code.startswith(start)), "")
            missing += not reason
            print(f"{file}:{line}, {sides} untaken, {reason or 'NO REASON'}: {code}")
    return int(missing > 0)


if __name__ == "__main__":
    sys.exit(main())
