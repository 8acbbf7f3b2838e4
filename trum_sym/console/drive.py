"""``trum-sym drive``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from trum_sym.console.options import (
    COUPLED_LEVELS,
    check_plot,
    choice_option,
    chosen_motor,
    examples,
    number_option,
    plot_options,
    schedule_options,
)
from trum_sym.console.say import say

__all__ = ["drive"]


@click.command(
    epilog=examples(
        "trum-sym drive --compliance flange --certify",
        "trum-sym drive --schedule burst --periods 200 --on-periods 1 --load-torque 0 --set rotor_mass=0",
        "trum-sym drive --schedule continuous --phase-difference '5 deg' --load-torque 0.05 --compliance flange",
        "trum-sym drive --compliance flange --sampling-period '2 ms' --plot drive.png",
    )
)
@schedule_options
@choice_option("--start", ("rest", "steady"), "Where the laps begin that lead to the orbit: rest, or the steady swing.")
@number_option("--sampling-period", "s", None, "Averaging period of the speed's encoder.  [default: none]", "S")
@number_option("--samples-per-period", "1", 8, "Parts of a drive period, for encoder and picture.", "K")
@number_option("--tolerance", "1", 1e-6, "Largest error of speeds over the largest speed, 1e-9 to 1e-2.", "T")
@click.option("--certify", is_flag=True, help="Say what is certain of the orbit; takes about as long again.")
@plot_options("Draw the rotor's speed and the wave over the orbit")
@click.option("--json", "as_json", is_flag=True, help="One JSON object instead of a table; SI units, speeds in rad/s.")
def drive(
    motor: str,
    overrides: tuple[str, ...],
    schedule: str,
    start: str,
    sampling_period: float | None,
    samples_per_period: float,
    tolerance: float,
    certify: bool,
    plot: Path | None,
    force: bool,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> int:
    """Any drive of both phases with the rotor's reaction on the wave: pulses, bursts, a phase difference, one phase.

    The orbit that the drive comes back to (docs/coupling.md), with errors that are estimates.  Exit code 1 where none
    attracts, or the errors miss the tolerance.
    """
    from dataclasses import fields

    from trum_sym.inputs.drive import Drive
    from trum_sym.inputs.schedule import Schedule
    from trum_sym.model.drive_orbit import drive_orbit

    check_plot(plot, force)
    numbers = {q.name: options.pop(q.name) for q in fields(Schedule) if q.name in options}
    levels = {name: options.pop(name) for name in COUPLED_LEVELS}
    found = drive_orbit(
        chosen_motor(motor, overrides),
        Drive(**{**options, "phase_lead": int(options["phase_lead"])}),
        Schedule(kind=schedule, **numbers),  # type: ignore[arg-type]  # click has checked the word
        start=start,
        sampling_period=sampling_period,
        samples_per_period=samples_per_period,
        tolerance=tolerance,
        certify=certify,
        **levels,
    )
    say(found.to_json() if as_json else found.to_text())
    if plot is not None:
        from trum_sym.plots.style import write_picture
        from trum_sym.plots.transients import driven

        write_picture("--plot", driven(found), plot)
    return 0 if found.converged else 1
