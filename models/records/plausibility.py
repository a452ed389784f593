"""Doubts about a ground motion that was read: a unit that cannot be right."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from ..diagnostic import Diagnostic
from ..ground_motion import GroundMotion
from .units import METRES_PER_SECOND_SQUARED

LARGEST_PEAK = 5.0  # [g]; the largest that was ever recorded at the ground is about 4 g
LARGEST_RATIO = 50.0  # of the peaks of two components; gal taken for m/s^2 makes 100, for g 981
_USUAL = 0.4  # [g], peak of a strong motion: among the units the one that comes next to it makes sense
# a planar motion that was turned has components in proportion, the small one by its azimuth
_PROPORTIONAL = 1e-9


def doubts(motion: GroundMotion) -> tuple[Diagnostic, ...]:
    """Return what makes a record improbable: a peak beyond 5 g, and components 50 times apart.

    Returns
    -------
    tuple of Diagnostic
        "large_peak": size is the peak [g], detail the unit that would make sense; "unlike_components": size
        is the ratio of the peaks, detail the component that is larger.

    Examples
    --------
    >>> motion = GroundMotion([[0, 0], [981, 0.1], [-400, 0.02]], 0.01)
    >>> [(fact.code, fact.detail) for fact in doubts(motion)]
    [('large_peak', 'cm/s2'), ('unlike_components', 'x')]
    """
    return tuple(_doubts(motion))


def doubts_of(motions: Iterable[GroundMotion | None]) -> list[dict[str, Any]]:
    """Return the doubts about many motions as plain values, for a file: record and fields of each.

    Of a record that comes several times, as at several scales, each doubt is there once.
    """
    found: dict[tuple[str, str], dict[str, Any]] = {}
    for motion in motions:
        if motion is None:
            continue
        for fact in doubts(motion):
            fields = {name: getattr(fact, name) for name in ("code", "size", "bound", "detail")}
            found.setdefault((motion.name, fact.code), {"record": motion.name or "record"} | fields)
    return list(found.values())


def _doubts(motion: GroundMotion) -> Iterator[Diagnostic]:
    peaks = np.abs(motion.acceleration).max(axis=0)
    peak = float(max(motion.peak, peaks.max())) / METRES_PER_SECOND_SQUARED["g"]
    if peak > LARGEST_PEAK:
        yield Diagnostic(code="large_peak", size=peak, bound=LARGEST_PEAK, detail=likely_unit(peak)[0])
    moving = peaks[peaks > 0.0]
    ratio = float(moving.max() / moving.min()) if len(moving) else 1.0
    if ratio >= LARGEST_RATIO and not _in_one_plane(motion):
        axis = "xyz"[int(peaks.argmax())]
        yield Diagnostic(code="unlike_components", size=ratio, bound=LARGEST_RATIO, detail=axis)


def likely_unit(peak: float) -> tuple[str, float]:
    """Return the unit in which a peak that was read as `peak` [g] makes sense, and the peak in it [g]."""
    metre = METRES_PER_SECOND_SQUARED
    read_as_g = [(unit, peak * metre[unit] / metre["g"]) for unit in ("m/s2", "cm/s2")]
    read_as_metres = ("cm/s2", peak * metre["cm/s2"] / metre["m/s2"])
    return min((*read_as_g, read_as_metres), key=lambda unit: abs(math.log(unit[1] / _USUAL)))


def _in_one_plane(motion: GroundMotion) -> bool:
    x, y = motion.acceleration[:, :2].T
    across = math.sqrt(float(x @ x) * float(y @ y))
    return not motion.has_vertical and abs(across - abs(float(x @ y))) <= _PROPORTIONAL * across
