"""Makes the synthetic data sets of examples/data: the model with chosen parameters, and noise on it.

python examples/synthetic_data.py FOLDER
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import trum_sym as ts
from trum_sym.inputs.units import ARCSEC

DAMPING, RESONANCE = 0.0055, 39703.0
FREE_DAMPING, FREE_RESONANCE, FORCE_FACTOR, CAPACITANCE, LOSS_FACTOR = 0.0017, 38950.0, 0.53, 11e-9, 0.006
MODAL_MASS = 0.0331257  # kg, of TRUM-60
FRICTION, RADIUS, STIFFNESS = 0.23, "27.5 mm", 2.4e10


def write(folder: Path, name: str, made_with: str, header: str, *columns: np.ndarray) -> None:
    """One CSV file that says what it is."""
    rows = [",".join(f"{value:.7g}" for value in row) for row in zip(*columns, strict=True)]
    text = "\n".join([f"# synthetic: {made_with}", header, *rows])
    (folder / name).write_text(text + "\n", "utf-8")


def main(folder: Path) -> None:
    """Write all of them."""
    noise = np.random.default_rng(304)
    motor = ts.load_motor("trum60")

    time = np.arange(250) / 250e3
    # the damped oscillator's closed form, typed here on its own: a witness of the kernel that the fit uses
    omega = 2 * np.pi * RESONANCE
    decay = np.exp(-DAMPING * omega * time) * np.cos(omega * np.sqrt(1 - DAMPING**2) * time + 0.4)
    velocity = 120.0 * decay + noise.normal(0, 3.0, time.size)
    write(
        folder,
        "decay_synthetic.csv",
        f"damping_ratio {DAMPING}, resonance_frequency {RESONANCE:g} Hz, noise 3 mm/s",
        "time [us],velocity [mm/s]",
        1e6 * time,
        velocity,
    )

    known = motor.with_values({"friction_coefficient": FRICTION, "contact_radius": RADIUS})
    load = np.linspace(-0.1, 0.1, 11)
    speed = np.asarray(ts.evaluate(known, ts.Drive(load_torque=load), tolerance=1e-6).mean_speed) / ARCSEC
    write(
        folder,
        "torque_speed_synthetic.csv",
        f"friction_coefficient {FRICTION}, contact_radius {RADIUS}, Table 3's drive, noise 2000 arcsec/s",
        "load_torque [N*m],mean_speed [arcsec/s]",
        load,
        speed + noise.normal(0, 2000, load.size),
    )

    force = np.linspace(100, 220, 13)
    stall = np.asarray(ts.evaluate(known, ts.Drive(prepressure=force), tolerance=1e-6).stall_torque)
    write(
        folder,
        "stall_torque_synthetic.csv",
        f"friction_coefficient {FRICTION}, contact_radius {RADIUS}, Table 3's drive, noise 0.5 mN m",
        "prepressure [N],stall_torque [mN*m]",
        force,
        1e3 * stall + noise.normal(0, 0.5, force.size),
    )

    softer = motor.with_values({"layer_stiffness": STIFFNESS})
    resonance = np.asarray(ts.evaluate(softer, ts.Drive(prepressure=force)).resonance_frequency)
    write(
        folder,
        "resonance_synthetic.csv",
        f"layer_stiffness {STIFFNESS:g} N/m^2, noise 1 Hz",
        "prepressure [N],resonance_frequency [kHz]",
        force,
        1e-3 * (resonance + noise.normal(0, 1, 13)),
    )

    # the circuit's admittance, typed here on its own as the decay is
    hertz = np.linspace(37.5e3, 40.5e3, 101)
    omega, own = 2 * np.pi * hertz, 2 * np.pi * FREE_RESONANCE
    inductance = MODAL_MASS / FORCE_FACTOR**2
    series = 2 * FREE_DAMPING * own * inductance + 1j * inductance * (omega - own**2 / omega)
    admittance = 1 / series + 1j * omega * CAPACITANCE * (1 - 1j * LOSS_FACTOR)
    scatter = noise.normal(0, 2e-5, (2, hertz.size))
    write(
        folder,
        "admittance_synthetic.csv",
        f"damping_ratio {FREE_DAMPING}, resonance {FREE_RESONANCE:g} Hz, force factor {FORCE_FACTOR} N/V on "
        f"{1e3 * MODAL_MASS:g} g, {1e9 * CAPACITANCE:g} nF with loss factor {LOSS_FACTOR}, noise 0.02 mS",
        "frequency [kHz],conductance [mS],susceptance [mS]",
        1e-3 * hertz,
        1e3 * (admittance.real + scatter[0]),
        1e3 * (admittance.imag + scatter[1]),
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "data")
