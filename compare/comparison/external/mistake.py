"""A likely mistake in an external trajectory, by its code."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .frame import Frame
from .part import Part

# what is left of a difference that is explained, of the difference
_LEFT = 1.0 / 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Mistake:
    """One likely mistake.

    Parameters
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


def mistake_of(frame: Frame, concerns: str) -> Mistake:
    """Return the mistake that a frame takes back."""
    return Mistake(code=frame.code, concerns=concerns, value=frame.value)


def explains(before: Part, after: Part | None) -> bool:
    """Whether a difference is gone, and not only just."""
    return after is not None and not after.differs and after.size <= _LEFT * before.size
