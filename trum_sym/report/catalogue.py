"""The pictures of the report, in the order of the paper: anchor, title, caption, and how each is drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from trum_sym import plots
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.paper.cycle import READINGS, pulling
from trum_sym.paper.published import ENCODER

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["PICTURES", "Picture", "picture"]


@dataclass(frozen=True)
class Picture:
    """One picture of the report.

    Attributes
    ----------
    anchor : str
        Its id on the page: ``figure-`` and the paper's number, or a word.
    place : str
        The paper's section that it belongs to, or what else.
    title : str
    caption : str
        How to read it.
    alt : str
        What is drawn, for who does not see it.
    draw : callable
        Figure from a motor.
    """

    anchor: str
    place: str
    title: str
    caption: str
    alt: str
    draw: Callable[[Motor], Figure]

    @property
    def number(self) -> str:
        """``Figure 9``, or nothing."""
        name = self.anchor.removeprefix("figure-")
        return f"Figure {name}" if name != self.anchor else ""


_DRIVE = "The drive (Sect. 3)"
_CONTACT = "Contact and transfer (Sect. 4)"
_MOTION = "Motion of a surface point (Sect. 5)"
_OUTPUT = "Speed and determinants (Sect. 6)"
_STATOR = "The stator alone (Sect. 7)"
_MOTOR = "The motor (Sect. 8)"
_MORE = "What the paper does not show"
_LEADS = (
    "Each start is drawn with the phase lead that makes Q_aver positive at Table 3; the other lead mirrors the "
    "determinants and the speed without load."
)
_WEIGHT = (
    "The motor as it was measured, with a load's inertia of 9.2e-4 kg m² (of a torque plate; or of the weight, had its "
    "string at the stator's radius not given), and the volatility that the encoder of 2 ms reads."
)
_REGIONS = (
    ("A off", "the region T_reduT: A decays freely, B is driven; m = 100, n = 55"),
    ("B off", "the region T_addreduT: B decays freely, A builds up again; m = 100, n = 55"),
    ("both on", "the region T_addT: both phases are driven, B builds up; m = 100, n = 75"),
)


def _section_5() -> Iterator[Picture]:
    for region, (name, meaning) in enumerate(_REGIONS):
        first = 9 + 3 * region
        settings = f"{meaning}, 180 N, 3000 Hz, each cycle begun in steady state."
        yield Picture(
            f"figure-{first}",
            _MOTION,
            f"Path of a surface point, {name}",
            f"In {settings} The four panels are the quarters of the region's first beat, 1/(4 Δf) each; the dot is "
            "where the quarter begins. Blue turns clockwise (Q > 0), orange counter-clockwise. The point lies "
            "at k_c x = π/4.",
            f"Four small plots of the surface point's path in the quarters of a beat while {name}.",
            partial(plots.ellipse, region=region),
        )
        yield Picture(
            f"figure-{first + 1}",
            _MOTION,
            f"Vertical displacement, {name}",
            f"In {settings} The orange envelope is the length of the rotating vectors' sum (eq. 12), in closed form.",
            f"Vertical displacement of a surface point over the region {name}, oscillating inside a beating envelope.",
            partial(plots.vertical_displacement, region=region),
        )
        yield Picture(
            f"figure-{first + 2}",
            _MOTION,
            f"Direction determinant, {name}",
            f"In {settings} Above Q, the exact determinant of eq. A5; below, the crest's tangential velocity, whose "
            "sign is Q's (eq. 42).",
            f"Determinant Q and tangential velocity of the crest over the region {name}, with the signs of Q shaded.",
            partial(plots.determinant, region=region),
        )


PICTURES: tuple[Picture, ...] = (
    Picture(
        "figure-3",
        _DRIVE,
        "Both phases over a drive cycle",
        "Table 3's drive: 20 periods, 14 on, in its periodic state. A phase that is switched off rings down at the "
        "resonance; one that is switched on beats before it settles. Dashed: envelopes.",
        "Displacements of phase A and phase B over a drive cycle in three shaded regions: A off, B off, both on.",
        plots.phase_responses,
    ),
    Picture(
        "figure-6",
        _CONTACT,
        "Tangential velocity along the surface",
        "One wavelength in the middle of each region, at Table 3's drive. The velocity is a sine along x; dots mark "
        "the crest, which is the fastest point only when the wave does not grow or shrink.",
        "Three sine curves of the tangential velocity over one wavelength, with dots at the wave's crest.",
        plots.tangential_velocity,
    ),
    *(
        Picture(
            f"figure-{number}",
            _CONTACT,
            f"Transfer models, rotor running {word}",
            "The half zone from the crest to the contact's edge. Line: surface speed; dashed: the rotor's. Blue (+) "
            "drives the rotor, orange (−) brakes it, by the sign of the kernel's traction. Each panel says which share "
            "of Table 3's cycle the rotor's orbit spends in the model; both figures together make 100 %.",
            f"Eight panels of surface speed against the angle from the crest, driving and braking zones, rotor {word}.",
            partial(plots.transfer_models, forward=forward),
        )
        for number, word, forward in ((7, "forward", True), (8, "backward", False))
    ),
    *_section_5(),
    Picture(
        "figure-18",
        _OUTPUT,
        "Instantaneous speed, its mean and deviation",
        "Two cycles at Table 3's drive on the periodic orbit, the rotor without a load's inertia. v_s is the mean over "
        "time (eq. 39), S_k the standard deviation (eq. 41); sigma_s is their ratio (eq. 40).",
        "Rotor speed over two cycles with its mean as a dashed line and a band of one standard deviation.",
        plots.instantaneous_speed,
    ),
    Picture(
        "figure-19",
        _OUTPUT,
        "Forward and backward parts of the determinant",
        "Table 3's drive. Blue and orange areas are the sums of eqs. 43 and 44; dotted lines separate the regions.",
        "Determinant Q over a cycle with its positive parts shaded blue and its negative parts orange.",
        plots.forward_and_backward,
    ),
    Picture(
        "figure-20",
        _OUTPUT,
        "Speed and determinant over a cycle, by frequency difference",
        "180 N, load 0.3 N m without inertia, as in eq. 38. Left as the motor keeps running, right as if every cycle "
        "began from rest with the other "
        "phase leading, which is the reading closest to Table 4.",
        "Rotor speed and determinant over a cycle for six frequency differences, two readings side by side.",
        plots.cycles,
    ),
    Picture(
        "figure-21",
        _OUTPUT,
        "Trends with the frequency difference",
        f"180 N, load 0.3 N m without inertia, as in eq. 38. {_LEADS} Stars: what Table 4 prints.",
        "Mean speed, Q_aver, volatility and Q_vib against the frequency difference for three starts.",
        plots.trends,
    ),
    Picture(
        "figure-22",
        _OUTPUT,
        "Speed and determinant over a cycle, by prepressure",
        "3000 Hz, load 0.3 N m without inertia; left and right as in Figure 20.",
        "Rotor speed and determinant over a cycle for six prepressures, two readings side by side.",
        partial(plots.cycles, variable="prepressure"),
    ),
    Picture(
        "figure-23",
        _OUTPUT,
        "Trends with the prepressure",
        f"3000 Hz, load 0.3 N m without inertia, as in eq. 38. {_LEADS} Stars: what Table 4 prints.",
        "Mean speed, Q_aver, volatility and Q_vib against the prepressure for three starts.",
        partial(plots.trends, variable="prepressure"),
    ),
    Picture(
        "figure-25b",
        _STATOR,
        "Resonance against prepressure, every level",
        "Colour: level of the resonance; line: how the friction layer stiffens the stator. The grey line was measured "
        "(prepressure not stated). The paper's own points are not printed as numbers.",
        "Resonance frequency against prepressure for sixteen combinations of levels, with the measured 39703 Hz.",
        plots.resonance_levels,
    ),
    Picture(
        "figure-26b",
        _STATOR,
        "Power-off of one phase",
        "45 kHz until t_off, then free at the measured resonance of 39.703 kHz with Table 1's damping ratio. The "
        "amplitude at 80 V is not printed, so velocity is over its amplitude.",
        "Velocity of phase A, constant amplitude until power-off, then decaying.",
        plots.power_off,
    ),
    Picture(
        "figure-27b",
        _STATOR,
        "Beat after power-off of one of two phases",
        "Both phases at 45 kHz until A is switched off; bands last 1/(f_q − f_n), the paper's 0.188 ms.",
        "Velocity of a surface point: steady until power-off, then a beat that dies away.",
        plots.beat,
    ),
    Picture(
        "figure-29",
        _MOTOR,
        "Speed as the encoder reads it",
        f"Sixty readings of 2 ms at Table 3's drive, for each start. {_WEIGHT} Table 4 prints a mean of 633 arcsec/s "
        "and a volatility of 17.3 %.",
        "Deviation of sixty encoder readings from their mean for three starts.",
        lambda motor: plots.measured_speed(pulling(motor)),
    ),
    Picture(
        "figure-30",
        _MOTOR,
        "Trends with the frequency difference, as measured",
        f"As Figure 21. {_WEIGHT} {_LEADS} Stars: what Table 4 prints.",
        "Mean speed, Q_aver, volatility of a 2 ms encoder and Q_vib against the frequency difference.",
        lambda motor: plots.trends(pulling(motor), sampling_period=ENCODER),
    ),
    Picture(
        "figure-31",
        _MOTOR,
        "Trends with the prepressure, as measured",
        f"At 3300 Hz, as the paper's experiment. {_WEIGHT} {_LEADS}",
        "Mean speed, Q_aver, volatility of a 2 ms encoder and Q_vib against the prepressure at 3300 Hz.",
        lambda motor: plots.trends(
            pulling(motor), Drive(frequency_difference=3300.0), variable="prepressure", sampling_period=ENCODER
        ),
    ),
    Picture(
        "figure-32",
        _MOTOR,
        "The six points of Table 5",
        f"Prepressure and frequency difference change together. {_WEIGHT} {_LEADS}",
        "Mean speed, Q_aver, volatility and Q_vib at the six numbered points of Table 5.",
        lambda motor: plots.multivariable(pulling(motor)),
    ),
    Picture(
        "map-periodic",
        _MORE,
        "The box as the motor keeps running",
        "Above the paper's box, below its surroundings with the box outlined; start periodic, lead +1, load 0.3 N m "
        "without inertia. The orange line is zero speed, where the volatility has no bound.",
        "Maps of mean speed, volatility and Q_aver over frequency difference and prepressure, periodic start.",
        plots.maps,
    ),
    Picture(
        "map-rest",
        _MORE,
        "The box in the reading closest to Table 4",
        "As above, but every cycle begins from rest and the other phase leads.",
        "Maps of mean speed, volatility and Q_aver over frequency difference and prepressure, start rest, lead −1.",
        lambda motor: plots.maps(motor, READINGS[-1].of(Drive())),
    ),
    Picture(
        "speed-determinant",
        _MORE,
        "Do the determinants predict speed and volatility?",
        f"Each dot is an operating point at 0.3 N m. {_WEIGHT} The paper concludes that v_s and sigma_s follow them; "
        "the legend gives the rank correlation in each reading (+1: always; 0: not at all).",
        "Scatter of mean speed against Q_aver and of volatility against Q_vib, over the box and around it.",
        lambda motor: plots.prediction(pulling(motor), sampling_period=ENCODER),
    ),
    Picture(
        "torque-speed",
        _MORE,
        "Torque against speed",
        "Up to 98 % of what friction can hold. A dot is the mean torque on the rotor held still: a larger load drives "
        "it back. Dotted: Table 3's load.",
        "Mean speed against load torque for three starts, falling curves, with the stall torque on the axis.",
        plots.torque_speed,
    ),
    Picture(
        "load-region",
        _MORE,
        "What inertia and friction give Table 4",
        "From rest with phase lead -1. Left: the friction coefficient at which v_s is 633 arcsec/s; it has to be right "
        "to about 1.5 in 10 000 for 5 % of that. Right: what the encoder of 2 ms reads there. Friction and contact "
        "radius count as their product, and the inertia is where the curve meets Table 4.",
        "Friction coefficient against inertia for three contact radii; the encoder's volatility against inertia, "
        "one falling curve for all three.",
        plots.load_region,
    ),
    Picture(
        "contact-zone",
        _MORE,
        "The contact over a cycle",
        "Above: where the layer presses, and which way its friction pulls (blue forward, red backward), at Table 3's "
        "drive. Below: half-angle over π, 1 where the whole wave touches.",
        "Traction over time and angle from the crest, and the contact's half-angle over time.",
        plots.contact_zone,
    ),
)


def picture(anchor: str) -> Picture:
    """The picture of an anchor; a KeyError for none."""
    return {found.anchor: found for found in PICTURES}[anchor]
