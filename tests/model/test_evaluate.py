"""The operating point as users call it: broadcasting, JSON, table, exit codes, lean imports."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from refusals import WITHOUT_PUBLISHED

import trum_sym as ts
from trum_sym.console import main
from trum_sym.model.levels import LEVEL_NAMES

JSON_KEYS = [
    *("motor", "start", "contact", "prepressure", "frequency_difference", "resonance_frequency", "drive_frequency"),
    *("cycle_time", "amplitude", "neutral_axis", "wavenumber", "q_ratio", "q_square_ratio", "q_average"),
    *("q_volatility", "mean_speed", "min_speed", "max_speed", "speed_volatility", "stall_torque"),
    *("contact_fraction", "mean_speed_error", "min_speed_error", "max_speed_error", "speed_volatility_error"),
    *("stall_torque_error", "converged", "reason", "method"),
]
INPUTS = [
    *(
        "schema",
        "trum_sym",
        "motor",
        "motor_values",
        "assumed",
        "box",
        "allowed",
        "spreads",
        "drive",
        "levels",
        "sampling_period",
        "tolerance",
    ),
]
OPTIONS = [
    *("motor", "set", "prepressure", "frequency-difference", "periods", "on-periods", "load-torque", "start"),
    *("switching-phase", "phase-lead", "contact", "resonance", "foundation", "amplitude", "compliance", "tangential"),
    *("coupling", "sampling-period", "json"),
]


def run(capsys, *arguments):
    code = main(["evaluate", *arguments])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_json_has_the_fixed_keys_in_order(capsys):
    code, out, err = run(capsys, "--json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert list(found) == [*INPUTS, *JSON_KEYS[1:], "remarks", "units", "published"]
    assert [name for name in found if name in JSON_KEYS] == JSON_KEYS


def test_json_is_the_python_result(capsys, trum60):
    _, out, _ = run(capsys, "--json", "--start", "rest", "--phase-lead", "-1", "--frequency-difference", "-2.5 kHz")
    printed = json.loads(out)
    point = ts.evaluate(trum60, ts.Drive(start="rest", phase_lead=-1, frequency_difference=-2500.0))
    figures = point.figures
    assert {name: printed[name] for name in figures} == pytest.approx(figures)
    assert printed["drive"]["frequency_difference"] == -2500.0
    assert printed["levels"] == {name: getattr(point.inputs.levels, name) for name in LEVEL_NAMES}
    assert printed["motor_values"] == {name: parameter.value for name, parameter in trum60.parameters()}


def test_infinite_ratios_are_null_in_json(capsys):
    _, out, _ = run(capsys, "--json", "--on-periods", "20")
    printed = json.loads(out)
    assert printed["q_ratio"] is None
    assert printed["q_average"] > 0


def test_table_shows_ours_and_the_papers_values_at_table_3(capsys):
    code, out, _ = run(capsys)
    assert code == 0
    for text in ("1447.5", "3446.4", "39703", "5.5", "633", "17.3", "Table 4", "stall torque"):
        assert text in out


def test_a_figure_is_compared_with_its_own_kind_only(capsys):
    """Table 4's sigma_s is an encoder's, so the continuous one stands alone; -475,166 is no percentage of 633."""
    row = {line.split("  ")[0]: line for line in run(capsys)[1].splitlines()}
    assert "%  " in row["speed volatility sigma_s, continuous"]
    assert "Table 4" not in row["speed volatility sigma_s, continuous"]
    assert "-475799 arcsec/s" in row["mean speed v_s"]
    encoder = run(capsys, "--sampling-period", "2 ms")[1]
    (line,) = (line for line in encoder.splitlines() if line.startswith("speed volatility sigma_s, encoder of 2 ms"))
    assert "Table 4" in line
    assert "20.7" in line
    assert "Table 4" not in run(capsys, "--sampling-period", "3 ms")[1].split("speed volatility")[1].split("\n")[0]


def test_what_rests_on_assumed_values_is_marked(capsys):
    """Friction and contact radius are assumed; nothing of the wavenumber is; with all given, nothing."""
    rows = {line[:36].strip(): line[36:] for line in run(capsys)[1].splitlines()}
    assert "*" in rows["stall torque"]
    assert "*" not in rows["wavenumber k_c"]
    given = ("friction_coefficient=0.25", "contact_radius=26.5 mm", "piezo_width=8 mm")
    out = run(capsys, *(word for text in given for word in ("--set", text)))[1]
    assert "*" not in out.replace("N*m", "")


def test_the_reading_and_the_next_steps_are_named(capsys):
    out = run(capsys, "--start", "rest", "--contact", "hertz")[1]
    assert "reading: start rest, phase lead +1" in out
    assert "contact hertz" in out
    assert "next: trum-sym motor show" in out


def test_without_published_figures_there_are_no_columns_for_them(capsys, motor_file):
    own = WITHOUT_PUBLISHED.replace('name = "TRUM-60"', 'name = "own"')
    out = run(capsys, "--motor", str(motor_file(own)))[1]
    assert "published" not in out
    assert "printed in" not in out


def test_table_shows_no_published_value_at_another_drive(capsys):
    _, out, _ = run(capsys, "--prepressure", "170")
    assert "1447.5" not in out
    assert "Table 4" not in out


def test_set_overrides_take_units(capsys):
    _, bare, _ = run(capsys, "--json", "--set", "resonance_frequency=39703")
    _, unit, _ = run(capsys, "--json", "--set", "resonance_frequency=39.703 kHz")
    assert json.loads(bare)["mean_speed"] == pytest.approx(json.loads(unit)["mean_speed"])
    assert json.loads(bare)["resonance_frequency"] == pytest.approx(39703)


def test_prepressure_outside_the_fit_is_a_warning_on_stderr(capsys):
    code, out, err = run(capsys, "--json", "--prepressure", "50")
    assert code == 0
    assert json.loads(out)["amplitude"] > 0
    assert (
        err == "trum-sym: warning: prepressure: 50 N lies outside 100 to 220 N, where eq. 8's amplitude was measured\n"
    )


def test_fields_broadcast_like_arrays(trum60):
    force, difference = np.array([[160.0], [180.0]]), np.array([2800.0, 3000.0, 3300.0])
    grid = ts.evaluate(trum60, ts.Drive(prepressure=force, frequency_difference=difference))
    assert grid.q_average.shape == grid.wavenumber.shape == (2, 3)
    for i in range(2):
        for j in range(3):
            one = ts.evaluate(trum60, ts.Drive(prepressure=force[i, 0], frequency_difference=difference[j]))
            assert one.q_average == grid.q_average[i, j]
            assert one.resonance_frequency == grid.resonance_frequency[i, j]


def test_motor_values_broadcast_against_the_drive(trum60):
    motor = trum60.with_values({"damping_ratio": np.array([0.004, 0.006, 0.008])})
    grid = ts.evaluate(motor, ts.Drive(periods=np.array([[20], [30]]), on_periods=np.array([[14], [20]])))
    assert grid.q_average.shape == (2, 3)
    assert grid.q_average[0, 1] == ts.evaluate(trum60).q_average


def test_motor_and_drive_are_frozen(trum60):
    with pytest.raises(FrozenInstanceError):
        trum60.radius = None
    with pytest.raises(FrozenInstanceError):
        ts.Drive().periods = 3
    values = np.array([1000.0, 2000.0])
    drive = ts.Drive(frequency_difference=values)
    with pytest.raises(ValueError, match="read-only"):
        drive.frequency_difference[0] = 0
    values[0] = 5.0
    assert drive.frequency_difference[0] == 1000.0


def test_every_parameter_of_the_motor_has_a_unit_and_a_source(trum60):
    named = dict(trum60.parameters())
    assert len(named) == 46
    for name, parameter in named.items():
        assert parameter.unit, name
        assert parameter.source, name
        if parameter.source == "assumed":
            assert parameter.reason, name
            low, high = parameter.range
            assert low <= parameter.value <= high, name


def test_table_1_traps_are_settled_in_the_data(trum60):
    assert 2 * np.pi * trum60.radius.value == pytest.approx(trum60.perimeter.value, rel=1e-3)
    assert trum60.tooth_height.value < trum60.beam_thickness.value
    assert trum60.voltage.value == 200.0


def test_help_names_every_option_of_the_interface(capsys):
    _, out, _ = run(capsys, "--help")
    for option in OPTIONS:
        assert f"--{option}" in out


def test_module_runs_as_a_program():
    done = subprocess.run([sys.executable, "-m", "trum_sym", "evaluate", "--json"], capture_output=True, text=True)
    assert done.returncode == 0
    assert json.loads(done.stdout)["motor"] == "TRUM-60"
