"""A lap joined from segments side by side is the lap with its segments in turn, to the first order in the jumps."""

from __future__ import annotations

import json
import subprocess

import c_coverage
import pytest

POINTS = {
    "Table 3": ["tolerance=1e-9"],
    "from rest": ["tolerance=1e-9", "start=rest", "load_torque=0.1"],
    "Hertz": ["tolerance=1e-9", "contact=hertz", "load_torque=-0.05", "switching_phase=1", "periods=7", "on_periods=5"],
    "heavy": ["tolerance=1e-9", "rotor_inertia=1e-3", "load_torque=0.05"],
}
# Counted only where segments are joined, or not read of a joined lap
APART = ("kept", "kept_sum", "jumps")
# Of single steps, whose lengths are not quite the same; and what steps of a free rotor do not resolve
BY_STEPS = ("stiffest", "sum_abs", "d_angle")


@pytest.fixture(scope="module")
def harness(tmp_path_factory):
    return c_coverage.build(tmp_path_factory.mktemp("segments"), ["-O1", "-DTRUM_SEGMENTS=16"], "segments")


def laps(harness, point, level, beside):
    done = subprocess.run(
        [harness, *POINTS[point]], input=f"{level} {beside}\n", capture_output=True, text=True, check=True
    )
    found = json.loads(done.stdout.splitlines()[1])
    return found["in turn"], found["joined"]


@pytest.mark.parametrize("point", POINTS)
def test_segments_that_begin_where_the_lap_passes_give_its_sums_bounds_and_slopes(harness, point):
    in_turn, joined = laps(harness, point, 1e-7, 0)
    assert joined["jumps"] <= 1e-9 * max(abs(in_turn["low"]), abs(in_turn["high"]), abs(in_turn["speed"]))
    for name, value in in_turn.items():
        if name in APART:
            continue
        if name in ("low_error", "high_error"):  # magnitudes of a segment's own error and of what it began with add up
            assert joined[name] >= 0.7 * value, name
            continue
        bound = "error" in name or "remainder" in name or name == "inside"
        rel = 0.3 if bound else 0.05 if name.startswith(BY_STEPS) else 2e-6
        # signed errors of steps that are not quite the same cancel otherwise, to a share of what bounds their rest
        other = in_turn.get(name.replace("error", "remainder"), 0) if bound else 0
        assert joined[name] == pytest.approx(value, rel=rel, abs=max(0.2 * other, 1e-15 if bound else 1e-11)), name


@pytest.mark.parametrize("beside", [1e-5, 1e-4, 1e-3])
@pytest.mark.parametrize("point", POINTS)
def test_jumps_change_the_lap_by_no_more_than_is_counted(harness, point, beside):
    in_turn, joined = laps(harness, point, 1e-7, beside)
    assert joined["jumps"] > 0
    own = in_turn["remainder"] + abs(in_turn["error"]) + joined["remainder"]
    assert abs(joined["speed"] - in_turn["speed"]) <= own
    for name in ("low", "high"):
        off = joined[f"{name}_remainder"] + in_turn[f"{name}_remainder"] + 2 * in_turn[f"{name}_error"]
        assert abs(joined[name] - in_turn[name]) <= off
    off = joined["remainder_sum"] + in_turn["remainder_sum"] + 2 * abs(in_turn["error_sum"])
    assert abs(joined["x"] - in_turn["x"]) <= off
    assert joined["lowest"] <= in_turn["low"] + own
    assert joined["highest"] >= in_turn["high"] - own


LIGHT = (
    "rotor_inertia=2.4650745390656517e-08 friction_coefficient=0.29410926170092805 prepressure=201.811990563277 "
    "frequency_difference=4969.522202630917 periods=138 on_periods=83 load_torque=0.7060443155499986 start=steady "
    "tolerance=6.852293158164847e-08",
    "rotor_inertia=3.626182313368922e-09 friction_coefficient=0.22107143562846368 prepressure=112.27882345552209 "
    "frequency_difference=1367.5886747509112 periods=60 on_periods=47 load_torque=-0.4924354942344897 start=periodic "
    "tolerance=4.731087727939563e-09 contact=hertz phase_lead=-1",
)


@pytest.mark.parametrize("light", LIGHT)
def test_the_first_lap_overrules_coarse_ones_that_are_wrong(harness, light):
    """Rotors so light that they follow the wave within a coarse step: 8 and 13 laps by the coarse laps' bracket."""
    done = subprocess.run([harness, *light.split()], input="", capture_output=True, text=True, check=True)
    assert json.loads(done.stdout)["laps"] == 3
