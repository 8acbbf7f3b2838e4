"""What the tests of bad input share: the motor's text, and what counts as one clear line."""

from __future__ import annotations

import re
import subprocess
import sys
from contextlib import contextmanager
from importlib.resources import files

import numpy as np
import pytest
from hypothesis import Phase, settings

import trum_sym as ts

MOTOR = ts.load_motor("trum60")
MOTOR_TEXT = files("trum_sym").joinpath("data/trum60.toml").read_text("utf-8")
VOLTAGE_LINE = re.search(r"^voltage .*$", MOTOR_TEXT, re.MULTILINE)[0]
WITHOUT_PUBLISHED = MOTOR_TEXT[: MOTOR_TEXT.index("[[published]]")]
NUMERIC_FIELDS = tuple(ts.Drive().numbers())
MEASURED_NAMES = (
    "resonance_frequency",
    "amplitude",
    "neutral_axis",
    "wavenumber",
    "layer_stiffness",
    "contact_stiffness",
)
PARAMETER_NAMES = (*dict(MOTOR.parameters()), *MEASURED_NAMES)
POINT_NUMBERS = tuple(name for name, value in ts.evaluate(MOTOR).figures.items() if isinstance(value, float))
SEARCH = settings(
    derandomize=True, deadline=None, max_examples=80, phases=(Phase.explicit, Phase.generate, Phase.shrink)
)
WIDE_SEARCH = settings(SEARCH, max_examples=250)
SAMPLE, WIDE_SAMPLE = settings(SEARCH, max_examples=25), settings(SEARCH, max_examples=60)  # -m slow has them all


OPTIONS = {
    "--prepressure": ("in N", "Hz"),
    "--frequency-difference": ("in Hz", "N"),
    "--periods": ("need", "m"),
    "--on-periods": ("need", "Hz"),
    "--load-torque": ("in N*m", "V"),
    "--switching-phase": ("in rad", "s"),
    "--sampling-period": ("in s", "Hz"),
}

CHOICES = {
    "start": ("periodic", "steady", "rest"),
    "contact": ("winkler", "hertz"),
    "resonance": ("quartic", "eq6", "printed", "euler"),
    "foundation": ("harmonic", "smeared", "printed", "none"),
    "amplitude": ("measured", "forced"),
    "compliance": ("layer", "flange"),
    "tangential": ("rigid", "brush"),
    "coupling": ("none", "contact"),
}


NO_NUMBERS = [
    pytest.param(None, id="None"),
    pytest.param("strong", id="text"),
    pytest.param("", id="empty-text"),
    pytest.param(b"180", id="bytes"),
    pytest.param(180 + 0j, id="complex"),
    pytest.param(True, id="bool"),
    pytest.param({}, id="dict"),
    pytest.param({180.0}, id="set"),
    pytest.param(len, id="function"),
    pytest.param([], id="empty-list"),
    pytest.param(np.zeros((0, 3)), id="empty-array"),
    pytest.param([[1.0], [1.0, 2.0]], id="ragged"),
    pytest.param(np.array([1.0, None]), id="object-array"),
    pytest.param(np.array([True, False]), id="bool-array"),
    pytest.param(np.array([1j, 2j]), id="complex-array"),
    pytest.param(np.array(["1", "2"]), id="text-array"),
    pytest.param(np.array(["2021-10-01"], dtype="datetime64[D]"), id="dates"),
    pytest.param(np.zeros(2, dtype=[("force", float)]), id="structured-array"),
    pytest.param(10**400, id="400-digits"),
    pytest.param(10**5000, id="5000-digits"),
]


def assert_one_clear_line(message, *fragments):
    assert len(message.splitlines()) == 1
    assert "Traceback" not in message
    assert "got , need" not in message, "what was given must show, even if it is empty"
    assert not re.search(r"number in 1(?!/)", message), "a pure number has no unit"
    for fragment in fragments:
        assert fragment in message


@contextmanager
def refusal(*fragments):
    with pytest.raises(ts.ParameterError) as caught:
        yield
    assert_one_clear_line(str(caught.value), *fragments)


def run_console(*arguments):
    command = [sys.executable, "-m", "trum_sym", *arguments]
    return subprocess.run(command, capture_output=True, timeout=8, check=False)


def voltage(**changes):
    entry = {"value": "200.0", "unit": '"V"', "source": '"Table 1"', **changes}
    items = ", ".join(f"{key} = {value}" for key, value in entry.items() if value is not None)
    return MOTOR_TEXT.replace(VOLTAGE_LINE, f"voltage = {{ {items} }}")


def described(changes):
    return ", ".join(f"{key} = {value}" for key, value in changes.items())[:40]


def published(**changes):
    entry = {"output": '"amplitude"', "value": "5.5e-6", "unit": '"m"', "source": '"Table 2"', "drive": "{}", **changes}
    return f"{MOTOR_TEXT}\n[[published]]\n" + "\n".join(f"{k} = {v}" for k, v in entry.items() if v is not None)
