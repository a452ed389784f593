"""Consistency of a trace with itself: place in the recess, turning points and passes, rates."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case

from .motion import Array, largest, turning_points
from .result import Result, at_most
from .scenes import PIER, RELEASE, SHOCK, SHOCK_TIMES, polyline
from .subject import Subject

_SAMPLE = 0.002  # [s] 1/400 of 1/p, and 1/20 of the shortest pass
_SHAKEN = Case(PIER, polyline(SHOCK_TIMES, SHOCK, 0.5), duration=8.0)


def place(subject: Subject, support: str) -> Iterator[Result]:
    """No twist and no roll-out in a recess: psi = -phi (14), and the contact stays on its circle.

    The base centre is off its place by b (1 - cos theta), (10), and the mass centre h further along the axis.
    """
    found = subject.simulate(RELEASE, support)
    b, h = PIER.base_radius, PIER.mass_centre_height
    yield at_most("twist phi + psi", largest(found.twist), subject.within(10.0, "none in a recess", "rad"))
    moving = np.isfinite(found.rolling_angle) & (found.tilt > 0.0)
    off = np.hypot(*found.contact_point[moving].T) / b - 1.0
    bound = subject.within(10.0, "it stays in its place", "b")
    yield at_most("contact point on the original circle", largest(off), bound)
    s, c = np.sin(found.tilt)[:, None], np.cos(found.tilt)
    ahead = np.column_stack([np.cos(found.rolling_angle), np.sin(found.rolling_angle)])
    base = np.hypot(*(found.centre_of_mass[:, :2] - h * s * ahead).T)
    yield at_most("base centre in its place", largest(base - b * (1.0 - c)) / b, bound)


def slip(subject: Subject, support: str) -> Iterator[Result]:
    """The rim rolls without slip, in a recess and on flat ground; a rim that is held by contact creeps."""
    found = subject.simulate(RELEASE, support)
    bound = subject.within(100.0, "creep of a rim that rolls for 3 s", "b")
    yield at_most("slip", largest(found.slip) / PIER.base_radius, bound)


def turning(subject: Subject, support: str) -> Iterator[Result]:
    """Turning points, passes and peak are those of the sampled tilt: vertices of polynomials through it."""
    case = RELEASE if "stepper" in subject.options else _SHAKEN
    found = subject.simulate(case, support, sample_step=_SAMPLE, rest_tilt=0.0)
    moving = np.flatnonzero(np.isfinite(found.rolling_angle))
    turns = turning_points(*(values[moving] for values in (found.time, found.tilt, found.rolling_angle)))
    rows, bound = found.extrema, subject.within(100.0, "vertex of samples 0.002 s apart", "s, rad")
    if case.initial is not None and len(rows) == len(turns) + 1:
        rows = rows[1:]  # a release from rest begins with a turning point
    yield at_most("turning points", _apart(rows, turns), bound)
    tops = [*turns[turns[:, 3] > 0.0, 1], found.tilt[0], found.tilt[-1]]
    peak = subject.within(1.0, "the highest turning point of the samples", "rad")
    yield at_most("peak of the continuous motion", abs(found.peak_tilt - max(tops)), peak)
    starts = np.vstack([[found.time[0], found.tilt[0], found.rolling_angle[0], 1.0], turns])
    listed = starts if case.initial is not None else turns
    passes = [
        [low[0], low[1], after[2] - before[2]]
        for before, low, after in zip(listed, listed[1:], listed[2:], strict=False)
        if low[3] < 0.0
    ]
    stated = found.passes[["time", "minimum_tilt", "angle_of_turn"]].to_numpy(dtype=float)
    yield at_most("passes", _apart(stated, np.array(passes).reshape(-1, 3)), bound, note=f"{len(passes)}")


def _apart(stated: Array, sampled: Array) -> float:
    return largest(stated - sampled) if len(sampled) and stated.shape == sampled.shape else np.nan
