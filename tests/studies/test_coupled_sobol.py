"""What the Sobol study of the coupled wave varies and computes."""

from __future__ import annotations

import numpy as np
import pytest

import trum_sym as ts
from studies import coupled_sobol
from studies.coupled_sobol import amplitudes, main, own_resonance, spans
from trum_sym.model.coupling import coupled_values, plain_waves
from trum_sym.model.levels import Levels


@pytest.mark.parametrize("force", [160.0, 210.0])
def test_at_its_own_resonance_the_force_is_a_quarter_ahead_and_the_wave_the_highest(force):
    plain = ts.Drive(prepressure=force, on_periods=20, load_torque=0.0)
    values = coupled_values(ts.load_motor(), plain, Levels(coupling="contact", compliance="flange"))
    turn = own_resonance(values)
    heights = []
    for offset in (-40.0, 0.0, 40.0):
        waves = plain_waves({**values, "omega_q": turn + 2 * np.pi * offset})
        heights.append(waves.amplitude[waves.highest])
        if not offset:
            assert waves.lead[waves.highest] == pytest.approx(np.pi / 2, abs=1e-6)
    assert heights[1] > max(heights[0], heights[2])
    assert 100 < (turn - values["omega_n0"]) / (2 * np.pi) < 200


def test_what_is_assumed_lies_in_the_motor_files_ranges():
    motor = ts.load_motor()
    for one in (True, False):
        for name, (low, high, _) in spans(one=one).items():
            stated = getattr(motor, name, None)
            if stated is not None and stated.range is not None:
                assert stated.range[0] <= low < high <= stated.range[1], name


def test_a_run_takes_up_where_its_file_ends(tmp_path, monkeypatch):
    draws = {name: np.array([(low + high) / 2] * 2) for name, (low, high, _) in spans(one=True).items()}
    draws["offset"] = np.array([10.0, 20.0])
    file = tmp_path / "rows.jsonl"
    first = amplitudes((100.0, 120.0), {name: of[:1] for name, of in draws.items()}, file)
    whole = amplitudes((100.0, 120.0), draws, file)
    assert len(file.read_text().splitlines()) == 2
    assert whole["100 N"][0] == first["100 N"][0] > whole["120 N"][0] > 1
    monkeypatch.setattr(coupled_sobol, "one_phase", None)  # nothing is computed again
    again = amplitudes((100.0, 120.0), draws, file)
    assert all((again[name] == whole[name]).all() for name in whole)


def test_it_says_what_it_takes(capsys):
    assert main(["table-3", "64"]) == 2
    assert "table-2 or resonance" in capsys.readouterr().err
