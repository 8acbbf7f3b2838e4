"""Bad input to the optimiser: one clear line, exit code 2, no traceback."""

from __future__ import annotations

import math

import numpy as np
import pytest
from refusals import MOTOR, NO_NUMBERS, refusal

import trum_sym as ts
from trum_sym import console

BAD_LINES = [
    (("--prepressure", "210:160"), ("--prepressure: got 210 to 160", "low < high in N", "reversed")),
    (("--prepressure", "180:180"), ("--prepressure: got 180 to 180", "low < high", "holds it there")),
    (("--prepressure", ""), ("--prepressure: got empty text", "LOW:HIGH")),
    (("--prepressure", ":"), ("--prepressure: got :", "LOW:HIGH")),
    (("--prepressure", "1:2:3"), ("--prepressure: got 1:2:3", "LOW:HIGH")),
    (("--bounds", "prepressure=160:210"), ("No such option", "--bounds")),
    (("--load-torque", "0.2:0.1"), ("--load-torque: got 0.2 to 0.1", "low < high", "reversed")),
    (("--phase-lead", "0"), ("--phase-lead: got 0", "1 or -1")),
    (("--prepressure", "nan:200"), ("--prepressure: got nan", "a finite number", "in N")),
    (("--prepressure", "160:inf"), ("--prepressure: got inf", "in N")),
    (("--prepressure", "nan"), ("prepressure: got nan", "in N")),
    (("--prepressure", "-10:200"), ("--prepressure: got -10", "> 0", "in N")),
    (("--prepressure", "160 Hz:210"), ("--prepressure: got 160 Hz", "in N")),
    (("--prepressure", "low:high"), ("--prepressure: got low", "in N")),
    (("--frequency-difference", "2.8 N:3.3 kHz"), ("--frequency-difference: got 2.8 N", "in Hz")),
    (("--prepressure", "180", "--frequency-difference", "3 kHz"), ("every variable held",)),
    (("--periods", "20.5:30"), ("--periods: got 20.5", "an integer")),
    (("--on-periods", "2:5"), ("--on-periods: got 2 to 5", "periods/2")),
    (("--on-periods", "18:16"), ("--on-periods: got 18 to 16", "reversed")),
    (("--objective", "volatilty"), ("objective: got volatilty", "volatility, q-volatility", "speed_volatility")),
    (("--objective", ""), ("objective", "volatility")),
    (("--objective", "speed-error"), ("--target-speed: got none", "speed-error")),
    (("--objective", "1 + 1"), ("objective: got 1 + 1", "no figure occurs")),
    (("--objective", "mean_speed + prepressure"), ("objective", "do not add")),
    (("--objective", "mean_speed.real"), ("objective", "not attribute")),
    (("--objective", "mean_speed if 1 else 2"), ("objective", "not ifexp")),
    (("--objective", "__import__('os').system('true')"), ("objective", "not call")),
    (("--objective", "(lambda: mean_speed)()"), ("objective", "not call")),
    (("--objective", "mean_speed[0]"), ("objective", "not subscript")),
    (("--objective", "mean_speed; 1"), ("objective", "this is none")),
    (("--objective", "mean_speed ** 99"), ("objective", "exponents are integers")),
    (("--objective", "mean_speed ** mean_speed"), ("objective", "exponents are integers")),
    (("--objective", "sqrt(prepressure)"), ("objective", "the root of a unit is left")),
    (("--objective", "exp(prepressure)"), ("objective", "exp takes a pure number")),
    (("--objective", "min(mean_speed)"), ("objective", "min and max of several")),
    (("--objective", "mean_speed * 1e999"), ("objective", "finite")),
    (("--objective", "mean_speed * True"), ("objective", "not constant")),
    (("--objective", "(" * 3000 + "mean_speed" + ")" * 3000), ("objective", "500 characters")),
    (("--objective", "-" * 400 + "mean_speed"), ("objective", "nested too deeply")),
    (("--target-speed", "633 N"), ("--target-speed: got 633 N", "in rad/s")),
    (("--target-speed", "nan"), ("--target-speed: got nan", "rad/s")),
    (("--target-speed", "inf"), ("--target-speed: got inf", "rad/s")),
    (("--target-speed", "fast"), ("--target-speed: got fast", "rad/s")),
    (("--target-speed", "0"), ("--target-speed: got 0", "other than 0")),
    (("--constraint", "stall_torque > 0.35"), ("constraint: got stall_torque > 0.35", ">=, <= or ==")),
    (("--constraint", "0.1 <= stall_torque <= 0.2"), ("constraint", ">=, <= or ==")),
    (("--constraint", "stall_torque"), ("constraint", ">=, <= or ==")),
    (("--constraint", "stall_torque >= "), ("constraint stall_torque: got", "in N*m")),
    (("--constraint", "stall_torque >= 0.3 N"), ("constraint stall_torque: got 0.3 N", "in N*m")),
    (("--constraint", "stall_torque >= nan"), ("constraint: got stall_torque >= nan", "a finite value")),
    (("--constraint", "stal_torque >= 0.3"), ("constraint: got stal_torque", "close names: stall_torque")),
    (("--constraint", "stall_torque >= prepressure"), ("constraint", "do not add")),
    (("--sampling-period", "0"), ("--sampling-period: got 0", "> 0")),
    (("--holds", "-1"), ("--holds prepressure: got -1", "> 0")),
    (("--holds", "voltage=10 %"), ("--holds: got voltage", "an input with a spread: prepressure")),
    (("--holds", "10 %", "--holds", "5 %"), ("--holds: got 5 %", "one limit for all inputs")),
    (("--holds", "10 %", "--holds", "prepressure=5 %"), ("--holds: got prepressure=5 %", "one limit for all")),
    (("--holds", "10 N"), ("--holds prepressure: got 10 N", "rad/s")),
    (("--starts", "never"), ("--starts: got never",)),
    (("--starts", "0"), ("--starts: got 0", "> 0")),
    (("--spread", "prepressure"), ("--spread: got prepressure", "NAME=VALUE")),
    (("--spread", "prepressure=+-1 Hz"), ("--spread prepressure: got 1 Hz", "N")),
    (("--spread", "prepressure=+--1"), ("--spread prepressure: got -1", "> 0")),
    (("--spread", "prepressure=5:1"), ("--spread prepressure: got 5 to 1", "low < high")),
    (("--spread", "voltage=1 %"), ("--spread: got voltage", "prepressure")),
    (("--hold-within", "0"), ("--hold-within: got 0", "> 0")),
    (("--constraint", "load_inertia_drift <= 1"), ("--spread: got none", "a spread of load_inertia")),
    (("--plot", "box.txt"), ("--plot: got box.txt", ".png, .svg or .pdf")),
    (("--plot", "/nowhere/box.png"), ("--plot: got /nowhere/box.png", "a folder that exists")),
    (("--prepressure", "nan"), ("prepressure: got nan",)),
]


@pytest.mark.parametrize(("arguments", "naming"), BAD_LINES, ids=[" ".join(a)[:60] for a, _ in BAD_LINES])
def test_the_console_refuses(console_refuses, arguments, naming):
    console_refuses("optimize", "--objective", "volatility", *arguments, naming=naming)


@pytest.mark.parametrize("value", NO_NUMBERS)
def test_no_number_is_no_target(value):
    if value is None:
        return
    with refusal("target_speed: got"):
        ts.optimize(MOTOR, target_speed=value)


@pytest.mark.parametrize("value", NO_NUMBERS)
def test_no_number_is_no_bound(value):
    with refusal("prepressure: got"):
        ts.optimize(MOTOR, bounds={"prepressure": (160.0, value)})


BAD_CALLS = [
    ({"bounds": [160, 210]}, ("bounds: got [160, 210]", "a mapping")),
    ({"bounds": {"prepressure": (160, 170, 180)}}, ("bounds of prepressure", "two numbers")),
    ({"bounds": {1: (1, 2)}}, ("bounds: got 1", "prepressure")),
    ({"bounds": {"prepressure": (math.nan, 200)}}, ("bounds of prepressure: got nan",)),
    ({"objective": None}, ("objective: got None", "volatility")),
    ({"objective": 3}, ("objective: got 3", "volatility")),
    ({"constraints": "mean_speed >= 1"}, ("constraints: got mean_speed >= 1", "a sequence")),
    ({"constraints": [1]}, ("constraint: got 1", ">=, <= or ==")),
    ({"constraints": None}, ("constraints: got None", "a sequence")),
    ({"contact": "glue"}, ("contact: got glue", "winkler, hertz")),
    ({"drive": "fast"}, ("drive: got fast", "a Drive")),
    ({"drive": ts.Drive(load_torque=np.array([0.1, 0.2]))}, ("load_torque: got an array of shape (2,)", "one number")),
    ({"target_speed": 0.0, "objective": "ripple"}, ("target_speed: got 0.0", "other than 0")),
]


@pytest.mark.parametrize(("arguments", "naming"), BAD_CALLS, ids=[str(a)[:50] for a, _ in BAD_CALLS])
def test_python_is_refused(arguments, naming):
    with refusal(*naming):
        ts.optimize(MOTOR, **arguments)


def test_a_motor_of_arrays_is_refused():
    with refusal("friction_coefficient: got an array of shape (2,)", "one number"):
        ts.optimize(MOTOR.with_values({"friction_coefficient": np.array([0.2, 0.3])}))
    with refusal("motor: got trum60", "a Motor"):
        ts.optimize("trum60")


def test_without_casadi_the_extra_is_named(monkeypatch, capsys):
    import sys

    for name in [name for name in sys.modules if name.startswith("trum_sym.optimiser")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "casadi", None)
    assert console.main(["optimize", "--target-speed", "1"]) == 2
    error = capsys.readouterr().err
    assert error == "trum-sym: the optimiser needs casadi: pip install 'trum-sym[optimize]'\n"
