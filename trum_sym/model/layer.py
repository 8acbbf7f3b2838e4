"""A layer that loses energy, or is sheared, under plain waves that the rotor acts back on (derivations/layer.py).

For waves of given heights: the contact that carries the prepressure, and what it does to the wave.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trum_sym.inputs.checks import Array, ArrayLike
from trum_sym.model.kernels import call
from trum_sym.model.roots import rising

__all__ = ["Bristles", "lossy_contact", "lossy_reaction", "sheared_reaction"]

Values = Mapping[str, ArrayLike]
Found = dict[str, Array]

_TURN = 2 * np.pi
_LAST = 1e-14  # of an angle, over the greatest that it could be: rounding is about a tenth of it
_PIECES = 16  # on which a bristle sticks or slides, at most; it is three for a partial contact
_RISES = 12  # stretches of one piece between places where stress and limit grow alike, at most


def _called(kernel: str, values: Values) -> Found:
    return {name: np.asarray(value) for name, value in call(kernel, values).items()}


def lossy_contact(values: Values, engagement: Array) -> Found:
    """The lossy contact that carries the prepressure.

    The wider it is the more it carries, up to where the whole wave touches; an element that has left meets the surface
    once (:func:`derivations.layer.meeting`, :func:`derivations.layer.carried`), so that both roots are the only ones.

    Parameters
    ----------
    values : mapping
        With ``eta_m``, more than 0.
    engagement : (k,) array
        Of the waves.

    Returns
    -------
    dict
        ``engagement``, ``share``, ``u_in``, ``u_out`` and ``theta``, half of their distance, pi where all touches.
    """
    eta = np.broadcast_to(np.asarray(values["eta_m"], float), engagement.shape)

    def ends(leaving: Array, engaged: Array, lossy: Array) -> Found:
        around = {"eta_m": lossy, "leaving": leaving}
        most = _TURN + _called("trum_layer_meeting", {**around, "free": 1.0})["u_out"]

        def gap(free: Array) -> tuple[Array, Array]:
            found = _called("trum_layer_meeting", {**around, "free": free})
            return found["gap"], found["gap_free"]

        free = rising(gap, np.zeros_like(most), most, most / 2, most, _LAST)
        met = _called("trum_layer_meeting", {**around, "free": free})
        return {**met, **_called("trum_layer_carried", {**around, "free": free, "engagement": engaged})}

    whole = _called("trum_layer_carried", {**_all_round(eta), "engagement": engagement})["carried"] <= 1
    share, u_in, u_out = np.full_like(engagement, 1 / np.pi), np.full_like(engagement, np.pi), np.zeros_like(engagement)
    u_out -= u_in
    if not whole.all():
        engaged, lossy = engagement[~whole], eta[~whole]
        widest = np.full_like(engaged, np.pi)
        narrowest = widest + _called("trum_layer_meeting", _all_round(lossy))["u_out"]

        def lacks(leaving: Array) -> tuple[Array, Array]:
            found = ends(leaving, engaged, lossy)
            return found["carried"] - 1, found["carried_leaving"]

        partial = ends(rising(lacks, narrowest, widest, (narrowest + widest) / 2, widest, _LAST), engaged, lossy)
        share[~whole], u_in[~whole], u_out[~whole] = partial["share"], partial["u_in"], partial["u_out"]
    return {"engagement": engagement, "share": share, "u_in": u_in, "u_out": u_out, "theta": (u_in - u_out) / 2}


def _all_round(eta: Array) -> dict[str, ArrayLike]:
    """A layer that leaves and meets the surface again at once, opposite to its greatest pressure."""
    return {"eta_m": eta, "leaving": np.pi, "free": 0.0}


def lossy_reaction(values: Values, engagement: Array, fraction: float | None) -> Found:
    """Lossy contact and its reaction on waves, under a rotor that carries a friction fraction, or is held still.

    Parameters
    ----------
    values, engagement
        As for :func:`lossy_contact`.
    fraction : float, optional
        Of friction; none for a rotor that is held.
    """
    wanted = 0.0 if fraction is None else fraction
    contact = lossy_contact(values, engagement)
    around = {**values, **contact}
    widest = np.minimum(np.maximum(contact["u_in"], -contact["u_out"]), np.pi)

    def at(alpha: Array) -> Found:
        return _called("trum_layer_reaction", {**around, "zone_low": -alpha, "zone_high": alpha})

    def drives(alpha: Array) -> tuple[Array, Array]:
        found = at(alpha)
        return found["f"] - wanted, found["f_alpha"]

    if fraction is None:
        alpha = np.minimum(widest, np.pi / 2)
    else:
        alpha = rising(drives, np.zeros_like(widest), widest, widest / 2, widest, _LAST)
    return {**contact, "alpha": alpha, **at(alpha)}


class Bristles:
    """A row of contacts whose bristles pass from where they enter to where they leave, or once round the wave.

    Parameters
    ----------
    grip, level, theta : (k,) array
        Of the contact, whose bristles enter at -theta; the whole wave touches where that is pi.
    """

    def __init__(self, grip: Array, level: Array, theta: Array) -> None:
        self._grip, self._level, self._theta = grip, level, theta
        self._whole = theta >= np.pi

    def passed(self, ratio: Array) -> Found:
        """Integrals of the stress at speeds of the rotor over the surface's, ``sheared``, ``sheared_cos`` and so on.

        Where the whole wave touches, bristles of a rotor that is faster than the surface on average end to slide back
        in one place of each turn, of a slower one to slide on; from there their stress repeats itself
        (:func:`derivations.brush.turns`).
        """
        turns = _called("trum_brush_turns", {"grip": self._grip, "ratio": ratio})
        delay, span = turns["delay"], turns["span"]
        sliding = np.where(span > 0, np.where(span < np.pi, 0, 1), -1)  # all the way
        first = np.where(ratio > 0, -1, 1)
        begin = np.where(self._whole, first * (delay + span), -self._theta)
        end = np.where(self._whole, begin + _TURN, self._theta)
        stress = np.where(self._whole, first * self._at(ratio, begin, begin, 0.0)["limit"], 0.0)
        on, back = np.cos(begin - delay) > np.cos(span), np.cos(begin + delay) < np.cos(span)
        place, sense = begin, np.where(self._whole | (sliding != 0), sliding, np.where(on, 1, np.where(back, -1, 0)))
        sums = dict.fromkeys(("sheared", "sheared_cos", "sheared_sin", "sheared_ratio"), np.zeros_like(place))
        for _ in range(_PIECES):
            if not (place < end).any():
                break
            sticks = sense == 0
            until, starts = self._slides(ratio, place, stress, np.where(sticks, end, place), delay, span)
            after = np.minimum(_next(sense * (delay + span), place), end)
            stop = np.where(sliding != 0, end, np.where(sticks, until, after))
            found = self._at(ratio, stop, place, stress)
            for of in ("", "_cos", "_sin"):
                piece = np.where(sticks, found[f"stuck{of}"], sense * found[f"slid{of}"])
                sums[f"sheared{of}"] = sums[f"sheared{of}"] + piece
            sums["sheared_ratio"] = sums["sheared_ratio"] + np.where(sticks, found["stuck_ratio"], 0.0)
            stress = np.where(sticks, found["stress"], sense * found["limit"])
            place, sense = stop, np.where(sticks, starts, 0)
        return sums

    def _at(self, ratio: Array, u: Array, u_0: Array, t_0: ArrayLike) -> Found:
        values = {"grip": self._grip, "level": self._level, "ratio": ratio, "u": u, "u_0": u_0, "t_0": t_0}
        return _called("trum_shear_passage", values)

    def _slides(
        self, ratio: Array, start: Array, stress: Array, end: Array, delay: Array, span: Array
    ) -> tuple[Array, Array]:
        """Where bristles that stick from ``start`` begin to slide, ``end`` at the latest, and in which sense."""
        low, high, sense, least = start, start, np.ones_like(start), np.zeros_like(start)
        seeking = start < end
        for _ in range(_RISES):  # between two of these places a gap only grows or only falls
            if not seeking.any():
                break
            places = [_next(one * delay + other * span, low) for one in (1, -1) for other in (1, -1)]
            high = np.where(seeking, np.minimum(end, np.minimum.reduce(places)), high)
            there = self._at(ratio, high, start, stress)
            on, back = there["limit"] - there["stress"], there["limit"] + there["stress"]
            sense = np.where(seeking, np.where(on < back, 1.0, -1.0), sense)
            least = np.minimum(on, back)
            seeking = seeking & (high < end) & ~(least < 0)
            low = np.where(seeking, high, low)
        closes = (start < end) & (least < 0)
        found = high.copy()
        if closes.any():
            row = Bristles(self._grip[closes], self._level[closes], self._theta[closes])
            found[closes] = row._meets(*(of[closes] for of in (ratio, start, stress, low, high, sense)))
        return found, sense

    def _meets(self, ratio: Array, start: Array, stress: Array, low: Array, high: Array, sense: Array) -> Array:
        """Where stress and limit meet in one sense, between two places between which they only come nearer."""

        def closes(u: Array) -> tuple[Array, Array]:
            found = self._at(ratio, u, start, stress)
            return sense * found["stress"] - found["limit"], sense * found["stress_u"] - found["limit_u"]

        return rising(closes, low, high, (low + high) / 2, np.full_like(low, np.pi), _LAST)


def _next(at: Array, u: Array) -> Array:
    """The first place after u that equals ``at`` but for whole turns."""
    found = at + _TURN * np.floor((u - at) / _TURN)
    found = np.where(found <= u, found + _TURN, found)
    return np.where(found <= u, found + _TURN, found)


def _bristles(values: Values, contact: Mapping[str, Array]) -> Bristles:
    """Those of a Winkler contact that carries the prepressure."""
    theta = contact["theta"]
    with np.errstate(all="ignore"):
        level = np.where(contact["engagement"] > 0, -contact["share"] / contact["engagement"], -1.0)
    return Bristles(np.full_like(theta, float(np.asarray(values["grip"]))), level, theta)


def sheared_reaction(values: Values, contact: Mapping[str, Array], heights: Array, fraction: float | None) -> Found:
    """Reaction of a contact with bristles on waves, under a rotor that carries a friction fraction or is held still.

    Parameters
    ----------
    values : mapping
        With ``grip``.
    contact : mapping
        The Winkler contact of the waves, ``engagement``, ``share``, ``theta``.
    heights : (k,) array
        Of the waves, in m.
    fraction : float, optional
        Of friction; none for a rotor that is held.

    Returns
    -------
    dict
        With ``ratio``, the rotor's speed over the surface's, and ``stuck``, 1 where all of the layer sticks; where a
        held rotor's friction could then be any, none is taken.
    """
    wanted = 0.0 if fraction is None else fraction
    limits = _called("trum_stuck_layer", {**values, "f": wanted})
    stuck = heights <= limits["W_stick"]
    still: dict[str, ArrayLike] = {
        "sheared": 0.0,
        "sheared_cos": 0.0,
        "sheared_ratio": 0.0,
        "sheared_sin": limits["sheared_sin"],
    }
    sticking = _called("trum_shear_reaction", {**values, **contact, **still})
    found = {name: np.array(np.broadcast_to(value, heights.shape)) for name, value in sticking.items()}
    found["f"][:], ratio = wanted, np.zeros_like(heights)
    if not stuck.all():
        moving = {name: value[~stuck] for name, value in contact.items()}
        rows = _bristles(values, moving)

        def at(share: Array) -> Found:
            return _called("trum_shear_reaction", {**values, **moving, **rows.passed(share)})

        def slows(share: Array) -> tuple[Array, Array]:
            acts = at(share)
            return wanted - acts["f"], -acts["f_ratio"]

        if fraction is not None:
            most = np.full(moving["theta"].shape, float(limits["ratio_most"]))
            ratio[~stuck] = rising(slows, -most, most, most / 2, most, _LAST)
        for name, value in at(ratio[~stuck]).items():
            found[name][~stuck] = value
    return {**contact, **found, "ratio": ratio, "alpha": np.arccos(np.clip(ratio, -1, 1)), "stuck": stuck.astype(float)}
