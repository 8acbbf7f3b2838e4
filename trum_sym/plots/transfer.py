"""Driving and braking zones of the contact: the sixteen transfer models (Figs. 7, 8), the zone over a cycle."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.inputs.drive import Drive
from trum_sym.inputs.motor import Motor
from trum_sym.model.kernels import call
from trum_sym.paper.cycle import Cycle, solve
from trum_sym.plots.style import COLOURS, INK, Panels, figure_of, panels, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["MODELS", "TransferModel", "contact_zone", "time_shares", "transfer_models"]


@dataclass(frozen=True)
class TransferModel:
    """What tells the sixteen models apart, on the half zone from the crest to the contact's right edge.

    Attributes
    ----------
    forward : bool
        The rotor runs forward (Fig. 7), or backward (Fig. 8).
    crest, edge : {1, -1}
        Sign of v_x - v at the crest and at the edge.
    extremum : bool
        Whether v_x has a peak or trough between them.
    """

    forward: bool
    crest: int
    edge: int
    extremum: bool

    @property
    def label(self) -> str:
        """Such as ``crest +, edge −, extremum``."""
        crest, edge = ("+" if sign > 0 else "−" for sign in (self.crest, self.edge))
        return f"crest {crest}, edge {edge}, {'extremum' if self.extremum else 'monotone'}"


MODELS = tuple(TransferModel(*of) for of in product((True, False), (1, -1), (1, -1), (False, True)))
_THETAS, _STEPS = (0.8, 1.4, 2.2), 48
_ON_MAP = "#000000"  # on a map that stays light where the page turns dark


def _surface(u: ArrayLike, phi: ArrayLike, v: ArrayLike, theta: ArrayLike = 1.0) -> dict[str, Array]:
    """The interface kernel in units of the surface's greatest speed and of the mean pressure, a Winkler contact."""
    scale = 1.0 / np.subtract(np.sin(theta), np.multiply(theta, np.cos(theta)))
    values = {
        "x": u,
        "x_max": 0.0,
        "k_c": 1.0,
        "R_v": 1.0,
        "cos_phi": np.cos(phi),
        "sin_phi": np.sin(phi),
        "v": v,
        "engagement": scale,
        "share": -scale * np.cos(theta),
        "F_c": 1.0,
        "n_j": 1.0,
        "mu": 1.0,
    }
    return {name: np.asarray(value) for name, value in call("trum_interface", values).items()}


def _matches(model: TransferModel, crest: dict[str, Array], edge: dict[str, Array], v: ArrayLike) -> Array:
    """Where the surface at crest and edge, and the rotor's speed, are the model's."""
    found = (np.asarray(v) > 0) == model.forward
    found &= np.sign(crest["v_x"] - v) == model.crest
    found &= np.sign(edge["v_x"] - v) == model.edge
    turned: Array = found & ((crest["v_x_slope"] * edge["v_x_slope"] < 0) == model.extremum)
    return turned


def _example(model: TransferModel) -> tuple[float, float, float]:
    """(phi, v/R_v, theta) of a model: on a grid, the one whose speeds and slopes are furthest from its limits."""
    phi, v, theta = np.meshgrid(
        -np.pi + 2 * np.pi * (np.arange(_STEPS) + 0.5) / _STEPS, np.linspace(-0.95, 0.95, 39), _THETAS, indexing="ij"
    )
    crest, edge = (_surface(u, phi, v, theta) for u in (0.0, theta))
    room = np.minimum.reduce([abs(part["v_x"] - v) for part in (crest, edge)])
    room = np.minimum.reduce([room, abs(crest["v_x_slope"]), abs(edge["v_x_slope"]), 2 * abs(v)])
    best = np.argmax(np.where(_matches(model, crest, edge, v), room, -1.0))
    return float(phi.flat[best]), float(v.flat[best]), float(theta.flat[best])


def time_shares(cycle: Cycle, samples_per_period: int = 512) -> dict[TransferModel, float]:
    """Share of a drive cycle that the rotor's orbit spends in each of the sixteen models."""
    time, speed, _ = cycle.rotor(int(np.asarray(cycle.case.drive.periods)) * samples_per_period)
    v = speed[:-1] * np.asarray(cycle.case.symbols["r_c"])
    theta = np.asarray(cycle.touching(time[:-1])["theta"])
    crest, edge = (cycle.interface(time[:-1], u, v) for u in (np.zeros_like(theta), theta))
    return {model: float(np.mean(_matches(model, crest, edge, v))) for model in MODELS}


@styled
def transfer_models(
    motor: Motor | None = None, drive: Drive | None = None, *, forward: bool = True, axes: Panels = None
) -> Figure:
    """Figs. 7 and 8: the eight models of a rotor that runs forward or backward.

    Each panel is the half zone from the crest to the edge: surface speed (line) and rotor speed (dashed) over the
    surface's greatest, zones that drive and that brake the rotor by the sign of the kernel's traction, and the share
    of the drive's cycle that the rotor spends in the model.

    Parameters
    ----------
    motor, drive
        Of the shares; TRUM-60 and the paper's Table 3 if not given.
    forward : bool
        Which of the two figures.
    axes : eight Axes, optional
        A new figure's if not given.
    """
    eight = panels(axes, 2, 4, 3.9, sharey=True)
    shares = time_shares(solve(motor, drive))
    for ax, model in zip(eight, [m for m in MODELS if m.forward == forward], strict=True):
        phi, v, theta = _example(model)
        u = np.linspace(0, theta, 241)
        found = _surface(u, phi, v, theta)
        helps = np.sign(found["traction"]) * np.sign(v)
        for sign, colour, mark in ((1, COLOURS[0], "+"), (-1, COLOURS[1], "−")):
            where = helps == sign
            ax.fill_between(u, found["v_x"], v, where=list(where), color=colour, alpha=0.4, linewidth=0)
            runs = np.flatnonzero(np.diff(np.concatenate([[False], where, [False]]).astype(int))).reshape(-1, 2)
            for begin, end in runs:
                ax.text(u[(begin + end - 1) // 2], -1.3, mark, ha="center", va="center", color=colour, fontsize=11)
        ax.plot(u, found["v_x"], color=INK, linewidth=1.0)
        ax.axhline(v, color=INK, linestyle="--", linewidth=0.8)
        ax.axhline(0, color=INK, linewidth=0.4)
        ax.set_ylim(-1.5, 1.15)
        ax.set_title(model.label.replace(", ", ",\n", 1) + f"\n{100 * shares[model]:.1f} % of the cycle", fontsize=8)
    for ax in eight[4:]:
        ax.set_xlabel("angle from crest u (rad)")
    for ax in eight[::4]:
        ax.set_ylabel("speed over R_v (1)")
    return figure_of(eight[0])


@styled
def contact_zone(motor: Motor | None = None, drive: Drive | None = None, *, axes: Panels = None) -> Figure:
    """The contact over a cycle: where it presses, and which way its friction pulls; below, half-angle over pi.

    Parameters
    ----------
    motor, drive
        TRUM-60 and the paper's Table 3 if not given.
    axes : two Axes, optional
        A new figure's if not given.
    """
    cycle = solve(motor, drive)
    upper, lower = panels(axes, 2, 1, 4.0, sharex=True, height_ratios=(3, 1))
    time, speed, _ = cycle.rotor(int(np.asarray(cycle.case.drive.periods)) * 32)
    v = speed * np.asarray(cycle.case.symbols["r_c"])
    inside = np.minimum(time, np.nextafter(time[-1], 0))
    theta = np.asarray(cycle.touching(inside)["theta"])
    u = np.linspace(-1, 1, 121) * min(np.pi, 1.15 * float(np.max(theta)))
    traction = cycle.interface(inside[None, :], u[:, None], v[None, :])["traction"]
    limit = float(np.quantile(abs(traction[traction != 0]), 0.98))
    mesh = upper.pcolormesh(
        1e3 * time,
        u,
        1e-3 * traction,
        cmap="RdBu",
        vmin=-1e-3 * limit,
        vmax=1e-3 * limit,
        shading="nearest",
        rasterized=True,
    )
    figure_of(upper).colorbar(mesh, ax=upper, label="traction (N/mm)", extend="both")
    for sign in (1, -1):
        label = "edge of the contact" if sign > 0 else None
        upper.plot(1e3 * time, sign * theta, color=_ON_MAP, linewidth=0.7, label=label)
    lower.plot(1e3 * time, theta / np.pi, color=COLOURS[0], linewidth=0.9)
    for ax, colour in ((upper, _ON_MAP), (lower, INK)):
        for edge in cycle.edges[1:3]:
            ax.axvline(1e3 * edge, color=colour, linewidth=0.6, linestyle=":")
    upper.grid(visible=False)
    upper.set_ylabel("angle from the crest u (rad)")
    lower.set_ylabel("ϑ/π (1)")
    lower.set_ylim(0, 1.02)
    lower.set_xlabel("time since t₁ (ms)")
    return figure_of(upper)
