"""A layer that loses energy or is sheared, under the coupled plain wave: witnesses, limits, bounds, all states."""

from __future__ import annotations

import math

import numpy as np
import pytest

import trum_sym as ts
from trum_sym.console import main
from trum_sym.model.coupled_orbit import lap_values
from trum_sym.model.coupling import _balance, _possible, coupled_values, plain_waves, standing, wave_at
from trum_sym.model.kernels import call
from trum_sym.model.layer import Bristles, lossy_contact
from trum_sym.model.levels import Levels

MOTOR = ts.load_motor()


def values_of(tangential="rigid", compliance="layer", motor=MOTOR, **changed):
    loss = changed.pop("loss", 0.0)
    drive = ts.Drive(**{"on_periods": 20, "frequency_difference": 500.0, "load_torque": 0.0, **changed})
    levels = Levels(coupling="contact", tangential=tangential, compliance=compliance)
    return coupled_values(motor.with_values({"layer_loss_factor": loss}), drive, levels)


def shinsei(offset, load, **layer):
    """Of a motor near whose resonance three states stand beside each other; load as a share of friction's most."""
    numbers = {"M_q": 0.01764, "omega_n0": 247_435.0, "F_q": 52.5, "xi": 0.0051, "D": 4e-3, "k_c": 300.0, "n_j": 9.0}
    numbers |= {"k_N": 4e7 / 0.03, "mu": 0.2, "F_c": 170.0, "r_c": 0.03, "J_total": 1e-5, "s": 1.0}
    turn = 2 * math.pi * (40.5e3 + offset)
    return {**numbers, "omega_q": turn, "T_load": load * 0.2 * 170 * 0.03, **layer}


LAYERS = ({"eta_m": 0.08}, {"grip": 2.0}, {"grip": 0.4}, {"grip": 40.0})


def test_a_lossy_layers_states_are_those_of_a_motion_in_time():
    """A sample; `python -m studies.layers loss 25` compares more."""
    from studies.layers import loss_differences

    (row,) = loss_differences(1)
    assert np.abs(row).max() < 1e-9


def test_a_sheared_layers_states_are_those_of_elements_that_stick_and_slide():
    """A sample; `python -m studies.layers shear 20` compares more, of more elements."""
    from studies.layers import shear_differences

    (rows,) = shear_differences(3, (60, 120))
    coarse, fine = rows
    large = np.abs(coarse) > 2e-5
    assert large.sum() >= 3
    assert (np.abs(coarse / fine)[large] > 3.3).all()  # of second order
    assert np.abs(fine + (fine - coarse) / 3).max() < 1e-5


def test_a_layer_that_hardly_loses_is_one_without_loss():
    for load in (0.4, -0.3):
        for compliance in ("layer", "flange"):
            bare = plain_waves(values_of(compliance=compliance, load_torque=load))
            gaps = []
            for loss in (1e-4, 1e-5):
                waves = plain_waves(values_of(compliance=compliance, load_torque=load, loss=loss))
                assert waves.names == bare.names
                gaps.append(
                    [
                        float((waves.amplitude - bare.amplitude)[0] / bare.amplitude[0]),
                        float((waves.speed - bare.speed)[0] / bare.speed[0]),
                        float(waves.layer_power[0] / waves.input_power[0]),
                    ]
                )
            assert np.array(gaps[1]) == pytest.approx(np.array(gaps[0]) / 10, rel=2e-2)
            assert np.abs(gaps[1]).max() < 3e-5


def test_a_layer_stiff_in_shear_is_rigid():
    """The stretch on which a bristle turns its stress round, and its effect, are as the root of one over the grip."""
    bare = plain_waves(values_of(load_torque=0.4))
    gaps = []
    for stiffness in (1e14, 1e16):
        motor = MOTOR.with_values({"tangential_stiffness": stiffness})
        waves = plain_waves(values_of("brush", motor=motor, load_torque=0.4))
        gaps.append(float(waves.amplitude[0] / bare.amplitude[0] - 1))
    assert gaps[1] == pytest.approx(gaps[0] / 10, rel=0.1)


def test_a_lossy_contact_carries_the_prepressure_and_begins_where_the_free_layer_is():
    engagement, eta = np.array([0.1, 0.3, 0.33, 0.5, 5.0, 60.0]), 0.2
    found = lossy_contact({"eta_m": eta}, engagement)
    for k, size in enumerate(engagement):
        out, into, share = (float(found[name][k]) for name in ("u_out", "u_in", "share"))
        u = out + (into - out) * (np.arange(100_000) + 0.5) / 100_000
        press = (size * (np.cos(u) + eta * np.sin(u)) + share) / 2
        assert press.min() > -1e-12
        assert press.mean() * (into - out) == pytest.approx(1, rel=1e-8)
        if into - out < 2 * np.pi - 1e-9:
            level = -share / size
            left = (math.cos(out) - level) * math.exp(-(2 * np.pi + out - into) / eta)
            assert math.cos(into) - level == pytest.approx(left, abs=1e-12)
            assert press[0] == pytest.approx(0, abs=1e-3 * size)
            assert press[-1] > 0.01 * size  # begins with a jump
    # all touches up to an engagement of 1 / (pi sqrt(1.04)) = 0.3121
    assert (found["theta"] == np.pi).tolist() == [True, True, False, False, False, False]


def test_what_the_layer_takes_is_the_heat_of_its_dashpots():
    """In contact eta k_N (W sin u)^2 omega, and what an element keeps as it leaves, less what it brings."""
    values = values_of(loss=0.1, load_torque=0.3)
    waves = plain_waves(values)
    size, eta = float(waves.amplitude[0]), 0.1
    per_height = float(np.asarray(call("trum_engagement", values)["engagement_per_height"]))
    contact = {name: float(v[0]) for name, v in lossy_contact(values, np.array([per_height * size])).items()}
    level = -contact["share"] / contact["engagement"]
    u = contact["u_out"] + (contact["u_in"] - contact["u_out"]) * (np.arange(100_000) + 0.5) / 100_000
    heat = eta * float((np.sin(u) ** 2).mean()) * (contact["u_in"] - contact["u_out"])
    heat += ((math.cos(contact["u_out"]) - level) ** 2 - (math.cos(contact["u_in"]) - level) ** 2) / 2
    heat *= values["k_N"] * size**2 * values["omega_q"] * values["n_j"] / values["k_c"]
    assert waves.layer_power[0] == pytest.approx(heat, rel=1e-8)
    # a wave that touches all round, by hand: pi eta k_N W^2 omega n_j / k_c
    low = wave_at(values, np.array([1e-8]))
    by_hand = math.pi * eta * values["k_N"] * 1e-16 * values["omega_q"] * values["n_j"] / values["k_c"]
    assert low.whole[0]
    assert low.layer_power[0] == pytest.approx(by_hand, rel=1e-10)


@pytest.mark.parametrize("kind", [{"loss": 0.1}, {"tangential": "brush"}])
def test_powers_add_up_and_the_force_puts_them_in(kind):
    waves = plain_waves(values_of(load_torque=0.5, **kind))
    parts = waves.stator_power + waves.layer_power + waves.slip_power + waves.output_power
    assert waves.input_power == pytest.approx(parts, rel=1e-12)
    assert waves.output_power[0] == pytest.approx(0.5 * waves.speed[0], rel=1e-10)
    assert abs(waves.residual).max() < 1e-12
    assert waves.slip_power[0] > 0
    assert (waves.layer_power[0] > 1) == ("loss" in kind)


def test_a_lossy_layer_brakes_the_rotor_and_does_not_turn_it():
    """Its pressure is ahead of the crest, where the surface is slower; friction still turns the rotor with the wave."""
    speeds = [float(wave_at(values_of(loss=loss), np.array([5e-6])).speed[0]) for loss in (0.0, 0.05, 0.1, 0.2)]
    assert (np.diff(speeds) < 0).all()
    assert speeds[-1] > 0


def test_bristles_are_those_of_the_prescribed_wave():
    at = np.random.default_rng(3)
    theta, grip, ratio = at.uniform(0.1, 3.1, 200), 10 ** at.uniform(-1, 2.5, 200), at.uniform(-1.2, 1.2, 200)
    found = Bristles(grip, np.cos(theta), theta).passed(ratio)["sheared"] / (
        2 * (np.sin(theta) - theta * np.cos(theta))
    )
    assert found == pytest.approx(
        call("brush_friction", {"theta": theta, "grip": grip, "ratio": ratio})["f"], abs=1e-13
    )


@pytest.mark.parametrize(
    ("grip", "level", "ratio"), [(2.4, -1.6, -0.8), (0.5, -2.9, -0.6), (10.0, -1.6, -0.11), (0.6, -3.8, 0.2)]
)
def test_bristles_that_never_leave_come_back_to_their_stress(grip, level, ratio):
    """Against stress that is moved in small steps, turn after turn, from none."""
    u = np.linspace(-np.pi, np.pi, 2001)
    limit, sheared = (np.cos(u) - level).tolist(), np.diff(grip * (np.sin(u) - ratio * u)).tolist()
    stress = [0.0]
    for _ in range(12):
        stress = stress[-1:]
        for most, by in zip(limit[1:], sheared, strict=True):
            stress.append(min(max(stress[-1] + by, -most), most))
    one = Bristles(np.array([grip]), np.array([level]), np.array([np.pi])).passed(np.array([ratio]))
    for name, weight in (("sheared", np.ones_like(u)), ("sheared_cos", np.cos(u)), ("sheared_sin", np.sin(u))):
        assert one[name][0] == pytest.approx(np.trapezoid(np.array(stress) * weight, u), abs=3e-5)


def test_below_the_dead_zone_the_rotor_stands_and_above_it_turns():
    for compliance, load in (("layer", 0.0), ("flange", 0.4)):
        values = values_of("brush", compliance, load_torque=load)
        height, force = standing(values)
        # mu (F_c / length) (1 - share of the load) / sqrt((k_T D k_c)^2 + (mu k_N)^2)
        length = 2 * math.pi * values["n_j"] / values["k_c"]
        normal = values["mu"] * values["k_N"]
        stiff = values["grip"] * normal
        share = 1 - load / (values["mu"] * values["F_c"] * values["r_c"])
        assert height == pytest.approx(
            values["mu"] * values["F_c"] / length * share / math.hypot(stiff, normal), rel=1e-12
        )
        below, above = (plain_waves(values | {"F_q": factor * force}) for factor in (0.999, 1.001))
        assert below.names[0] == "stuck"
        assert below.speed[0] == 0
        assert below.amplitude[0] == pytest.approx(0.999 * height, rel=1e-9)
        assert above.names[0] == "whole"
        assert above.speed[0] != 0
        assert (above.speed[0] > 0) == (load == 0)  # a load turns it back first
    rigid = values_of()
    assert standing(rigid)[0] == 0
    assert plain_waves(rigid | {"F_q": 0.999 * standing(rigid)[1]}).names == ("still",)


@pytest.mark.parametrize("layer", LAYERS)
def test_no_bracket_with_a_state_in_it_is_left_out(layer):
    """Random brackets, and the modal force that has its state at a random height within."""
    at = np.random.default_rng(8)
    for _ in range(40):
        values = shinsei(at.uniform(-2500, 1500), at.uniform(-0.95, 0.95), **layer)
        low = float(at.choice([0.0, 10 ** at.uniform(-8, -5)]))
        ends = np.array([low, low * (1 + 10 ** at.uniform(-3, 1)) if low else 10 ** at.uniform(-9, -7)])
        inside = _balance(values, ends[:1] + at.uniform(0, 1) * np.diff(ends), "loaded")
        values["F_q"] = float(np.hypot(inside["in_phase"], inside["ahead"])[0])
        sides = _balance(values, ends, "loaded")
        one, other = ({name: value[k : k + 1] for name, value in sides.items()} for k in (0, 1))
        assert _possible(values, one, other, (ends[:1], ends[1:])).all()


@pytest.mark.parametrize("layer", LAYERS)
def test_the_reaction_changes_no_faster_than_brackets_rest_on(layer):
    """By 2 F_c and 4 mu F_c for each e-fold of the height, under any load."""
    for load in (-0.9, 0.0, 0.6):
        values = shinsei(0.0, load, **layer)
        heights = np.geomspace(1e-8, 1e-4, 300)
        at = _balance(values, heights, "loaded")
        rates = {name: np.abs(np.diff(at[name]) / np.diff(np.log(heights))) for name in ("central", "along", "across")}
        assert rates["central"].max() < 2 * 170
        assert max(rates["along"].max(), rates["across"].max()) < 4 * 0.2 * 170
        if "lossy" in at:
            assert np.abs(np.diff(at["lossy"]) / np.diff(np.log(heights))).max() < 2 * 170
            assert (np.diff(at["u_in"]) <= 1e-12).all()
            assert (np.diff(at["u_out"]) >= -1e-12).all()


@pytest.mark.parametrize("layer", LAYERS[:2])
def test_all_steady_states_are_found(layer):
    """As many as a dense scan of the balance changes its sign; the one between two is unstable."""
    at, several = np.random.default_rng(4), 0
    for _ in range(5):
        values = shinsei(at.uniform(-350, 350), at.uniform(-0.2, 0.4), **layer) | {"F_q": at.uniform(50, 70)}
        waves = plain_waves(values)
        signs = np.sign(_balance(values, np.geomspace(1e-9, 1.5e-5, 150), "loaded")["residual"])
        assert np.count_nonzero(waves.amplitude) == np.count_nonzero(np.diff(signs))
        if waves.amplitude.size == 3:
            several += 1
            assert waves.stable.tolist() == [True, False, True]
    assert several > 0


def test_what_a_motion_that_changes_does_not_know_is_refused():
    lossy = MOTOR.with_values({"layer_loss_factor": 0.1})
    with pytest.raises(
        ts.ParameterError, match=r"layer_loss_factor: got 0\.1, need 0: characteristics alone knows a layer's loss"
    ):
        lap_values(lossy, ts.Drive(), Levels())
    with pytest.raises(ts.ParameterError, match="coupling: got contact, need none where tangential is brush"):
        lap_values(MOTOR, ts.Drive(), Levels(tangential="brush"))
    assert lap_values(MOTOR, ts.Drive(), Levels())["m"] == 20


def test_characteristics_have_loss_and_dead_zone(capsys):
    pytest.importorskip("xarray")
    drive = ts.Drive(on_periods=20, frequency_difference=500.0)
    lossy = MOTOR.with_values({"layer_loss_factor": 0.1})
    curves = ts.characteristics(lossy, drive, points=2, frequencies=[500.0], prepressures=[180.0], coupling="contact")
    one = plain_waves(values_of(loss=0.1, load_torque=float(curves["torque"][1])))
    assert curves["layer_power"].values[0, 1] == one.layer_power[-1]
    assert curves["layer_share"].values[0, 1] == one.layer_power[-1] / one.input_power[-1]
    words = ["--coupling", "contact", "--frequency-difference", "500", "--points", "2", "--on-periods", "20"]
    assert main(["characteristics", *words]) == 0
    assert "stands up to, V" in capsys.readouterr().out
