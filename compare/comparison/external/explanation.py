"""The likely mistakes in an external trajectory: what, taken back, makes it follow the model.

A small family is tried: the clock, the unit of the angles, the horizontal axes, and of the path also its
unit, its origin and the sense of z. One is named only where the trajectory follows the model without it and
did not with it; what none explains is a difference of the body, its start, the ground motion or the method.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from rockwobble.models import Case, Trace

from ...traces.motion import Motion
from ...traces.trajectory import external_motion, measurement, trajectory_of
from .clock import fitted_delays
from .difference import Difference, difference, explains
from .frame import Frame, Mistake, fitted_frames
from .path import explain_path, lean_of_path

# how much more motion must agree without the mistake, and how far it must lean while it does, in bounds
_MORE_MOTION, _LEANING = 4.0, 5.0
# how long it must agree, over the time scale of rocking sqrt(R/g), or up to the end
_LONG = 3.0
# an offset of the clock that is worth a word, over that time scale
_SHORTEST_DELAY = 0.01
_DEGREES = math.degrees(1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """The mistakes that explain a difference all together, if any, and what is left without them.

    Each of the alternatives explains the azimuth just as well as the mistake of the axes among those.
    """

    mistakes: tuple[Mistake, ...]
    alternatives: tuple[Mistake, ...]
    left: Difference


def explain(trajectory: Trace, reference: Motion, case: Case, *, start: float) -> Explanation:
    """Look for the mistakes that make a trajectory differ from a model that moves from `start` [s] on."""

    def hold(motion: Motion) -> Difference:
        return difference(reference, motion, cylinder=case.cylinder, start=start)

    def fits(motion: Motion, found: Difference) -> list[Frame]:
        return fitted_frames(reference, motion, start=found.start, end=found.covered)

    def turns(motion: Motion, found: Difference) -> list[Frame]:
        part = found.azimuth
        if part is None:
            return []
        return [fit for fit in fits(motion, found) if explains(part, hold(fit.apply(motion)).azimuth)]

    motion = external_motion(trajectory)
    found = hold(motion)
    mistakes: list[Mistake] = []
    if found.tilt.differs:
        tried = (*_in_other_units(trajectory, case), *_at_other_times(trajectory, reference, case, start))
        for mistake, other in tried:
            left = hold(other)
            if not _follows_longer(found, left, case):
                continue
            # two motions that differ may have tilts that agree longer by chance, but not azimuths, too
            if left.azimuth is None or not left.azimuth.differs or turns(other, left):
                motion, found, mistakes = other, left, [mistake]
                break
    frame = Frame()
    alternatives: tuple[Mistake, ...] = ()
    if found.azimuth is not None and found.azimuth.differs:
        frames = turns(motion, found)
        if frames:
            frame, *others = frames
            alternatives = tuple(other.mistake("azimuth") for other in others)
            mistakes.append(frame.mistake("azimuth"))
        else:
            for mistake, other in _in_other_units(trajectory, case):
                left = hold(other)
                if mistake.concerns == "azimuth" and explains(found.azimuth, left.azimuth):
                    motion, found = other, left
                    mistakes.append(mistake)
                    break
    own_fits = fits(lean_of_path(motion), found) if found.path is not None else []
    axes, more, motion = explain_path(reference, motion, found, axes=frame, fits=own_fits, hold=hold)
    if axes == frame != Frame():
        # one pair of axes for both: said once
        mistakes[-1] = replace(mistakes[-1], concerns="axes")
        more = more[1:]
    left = hold(replace(motion, lean=frame.apply(motion).lean))
    return Explanation(mistakes=(*mistakes, *more), alternatives=alternatives, left=left)


def _follows_longer(before: Difference, after: Difference, case: Case) -> bool:
    """Whether the tilts agree over so much more motion that chance is no reason."""
    enough = _LONG * math.sqrt(case.cylinder.semidiagonal / case.gravity)
    return (
        after.agreed_motion >= _MORE_MOTION * before.agreed_motion
        and after.agreed_peak >= _LEANING * after.tilt.bound * case.cylinder.alpha
        and (not after.tilt.differs or after.length >= enough)
    )


def _in_other_units(trajectory: Trace, case: Case) -> Iterator[tuple[Mistake, Motion]]:
    """Yield the trajectory in degrees for radians and the other way, of both angles and of one."""
    values = measurement(trajectory).columns.values
    if "tilt" not in values or "qw" in values:
        return
    for factor in (_DEGREES, 1.0 / _DEGREES):
        for names in (("tilt", "azimuth"), ("azimuth",), ("tilt",)):
            if not set(names) <= set(values):
                continue
            columns = measurement(trajectory).columns.scaled(dict.fromkeys(names, 1.0 / factor))
            try:
                other = trajectory_of(columns, measurement(trajectory).given, case)
            except ValueError:  # no trajectory at all in that unit
                continue
            yield (
                Mistake(code="angle_unit", concerns=" and ".join(names), value=factor),
                external_motion(other),
            )


def _at_other_times(
    trajectory: Trace, reference: Motion, case: Case, start: float
) -> Iterator[tuple[Mistake, Motion]]:
    """Yield the trajectory with its clock moved."""
    motion = external_motion(trajectory)
    scale = math.sqrt(case.cylinder.semidiagonal / case.gravity)
    for delay in fitted_delays(reference, motion, start=start, scale=scale):
        # a clock that is off by less than a sample cannot be told from what a model and noise make of samples
        if abs(delay) > max(trajectory.time_step, _SHORTEST_DELAY * scale):
            yield Mistake(code="time_offset", concerns="time", value=delay), motion.delayed(delay)
