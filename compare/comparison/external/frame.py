"""The horizontal axes that an external trajectory was given in, fitted to a model where their tilts agree.

A turn of the axes by beta multiplies the lean by exp(i beta); axes of the other sense, such as x and y
exchanged, an azimuth counted clockwise or a mirrored table, conjugate it first. In planar motion both do
the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...traces.file import Array
from ...traces.motion import Complex, Motion, on_samples_of
from .difference import leans

# an axis is meant where the fit comes so close to it, and the rest is another difference [rad]
_NAMED_WITHIN = math.radians(1.5)
# a turn of the axes is the same all the time: that of each part of the motion may differ by this angle [rad],
# and by what noise and other small differences of the lean make of it
_STEADY = math.radians(2.0)
# such differences, over the largest tilt
_SMALL = 1e-3
# standard deviations of the noise
_CONFIDENCE = 3.0
# an angle that is known no better than this is not known [rad]
_OPEN = 0.5
# two models that a first pass turned apart are off by the same angle in one swing, by chance in two
_SWINGS = 3
# samples that lean without which there is no fit
_FEWEST = 8

_TURNS = {math.pi: "turned_back"}
_MIRRORS = {
    0.0: "y_reversed",
    math.pi: "x_reversed",
    0.5 * math.pi: "axes_exchanged",
    -0.5 * math.pi: "axes_exchanged_reversed",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Mistake:
    """One likely mistake.

    Attributes
    ----------
    code : str
        "time_offset" (value: to be added to the times [s]), "angle_unit" (value: the angles are too large by
        this factor), "turned" (by value [deg], counter-clockwise), "turned_back" (by half a turn),
        "x_reversed", "y_reversed", "axes_exchanged", "axes_exchanged_reversed", "mirrored" (value: azimuth
        of the line [deg]), "length_unit" (value: too large by this factor), "z_reversed", "origin" (value:
        its distance from the right one [m]).
    concerns : str
        "time", "tilt", "azimuth", "tilt and azimuth", "path", or "axes", which are azimuth and path.
    value : float
        NaN where there is none to tell.
    """

    code: str
    concerns: str
    value: float = math.nan


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """Change of a trajectory into the axes of the model: y reversed if mirrored, then a turn.

    The angle is counter-clockwise, in (-pi, pi] [rad].
    """

    angle: float = 0.0
    mirrored: bool = False

    def apply(self, motion: Motion) -> Motion:
        """Return the motion in the axes of the model."""
        return motion.turned(self.angle, mirrored=self.mirrored)

    @property
    def code(self) -> str:
        """Name of the mistake that it takes back; empty where there is none."""
        if self == Frame():
            return ""
        named = _MIRRORS if self.mirrored else _TURNS
        return named.get(self.angle, "mirrored" if self.mirrored else "turned")

    @property
    def value(self) -> float:
        """Angle by which it is turned, or azimuth of the line that it is mirrored in [deg]; else NaN."""
        if self.code == "turned":
            return -math.degrees(self.angle)
        return 0.5 * math.degrees(self.angle) if self.code == "mirrored" else math.nan

    def mistake(self, concerns: str) -> Mistake:
        """Return the mistake that it takes back."""
        return Mistake(code=self.code, concerns=concerns, value=self.value)


def fitted_frames(reference: Motion, motion: Motion, *, start: float, end: float) -> list[Frame]:
    """Return the turn and the mirroring that bring the lean of a motion closest to that of the reference.

    Only those that are the same in each part of the time from start to end [s]. A part is a quarter of it,
    or lies between two passes by the upright position: a difference that comes with a pass is none of the
    axes.
    """
    model, trial = on_samples_of(reference, motion)
    if model.lean is None or trial.lean is None:
        return []
    within = (model.time >= start) & (model.time <= end + 1e-9)
    counts = leans(model, trial, within)
    if np.count_nonzero(counts) < _FEWEST:
        return []
    moves = np.flatnonzero(within & (np.abs(model.lean) > 0.0))
    swings = np.split(moves, np.searchsorted(moves, _minima(model.tilt[moves[0] : moves[-1] + 1]) + moves[0]))
    small = _SMALL * float(reference.tilt.max())
    found = []
    for mirrored in (False, True):
        products = model.lean * (trial.lean if mirrored else trial.lean.conj())
        angle = float(np.angle(products[counts].sum()))
        quarters = np.array_split(np.flatnonzero(counts), 4)
        off = [
            _off(products[part], angle, model.lean[part], trial.noise, small)
            for part in (*quarters, *swings)
            if len(part)
        ]
        # a part whose angle noise leaves open tells nothing either way
        if any(apart > _STEADY + doubt for apart, doubt in off if doubt < _OPEN):
            continue
        told = [doubt < (_OPEN if mirrored else min(_OPEN, 0.5 * abs(angle))) for _, doubt in off[4:]]
        # before the first pass, or in so many swings that no pass can be the reason
        if told and not told[0] and sum(told) < _SWINGS:
            continue
        named = _MIRRORS if mirrored else _TURNS
        near = [exact for exact in named if abs(math.remainder(angle - exact, 2.0 * math.pi)) < _NAMED_WITHIN]
        found.append(Frame(angle=near[0] if near else angle, mirrored=mirrored))
    return found


def _off(products: Complex, angle: float, lean: Complex, noise: float, small: float) -> tuple[float, float]:
    """Return how far the turn of a part is from that of the whole, and how well it is known [rad]."""
    strength = math.sqrt(float(np.mean(np.abs(lean) ** 2)))
    doubt = (_CONFIDENCE * noise / math.sqrt(len(lean)) + small) / strength
    return abs(float(np.angle(products.sum() * np.exp(-1j * angle)))), doubt


def _minima(tilt: Array) -> NDArray[np.intp]:
    """Return the samples of least tilt: a first pass may hardly be one, and still turn one of two motions."""
    return np.flatnonzero((tilt[1:-1] <= tilt[:-2]) & (tilt[1:-1] < tilt[2:])) + 1
