"""Explanation of a difference: the mistakes without which a trajectory follows the reference.

A small family is tried: units and order of the columns, the clock, the rate of a free motion, the horizontal
axes, and of the path also its unit, its origin and the vertical axis. One is named only where the trajectory
follows the reference without it and did not with it; what none explains is a difference of the body, its
start, the ground motion or the method.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .mistakes import (
    MIRRORS,
    TURNS,
    Change,
    Frame,
    Mistake,
    Read,
    correct,
    in_time_scale,
    of_path,
    readings,
    spinning,
    with_changes,
)
from .motion import SAME_TIME, Complex, Difference, Motion, Reference, explains, on_samples_of
from .table import POSITION, Array, Values

# how much more motion must agree without the mistake, and how far it must lean while it does, in bounds
MORE_MOTION, LEANING = 4.0, 5.0
# how long it must agree, over the time scale of rocking, or up to the end
LONG = 3.0
# lengths of the windows in which the clock is fitted, over the time scale of rocking
WINDOWS = (3.0, 6.0, 12.0)
SHORTEST_DELAY = 0.01  # an offset of the clock that is named, over the time scale
SAME_OFFSET = 0.1  # difference of the offsets in several windows, over the largest: a clock has one
LARGEST_DELAY = 0.5  # the largest that is tried, over the length of the run
FINE = 40.0  # samples of the time scale in the first search of an offset
ALIKE = 1.5  # rocking repeats itself: of offsets whose misfit is at most this times the least, the smallest
# smallest and largest relative difference of a clock rate that is reported
SMALLEST_RATE, LARGEST_RATE = 2.5e-3, 0.15
# share of the tilt difference left in the right time scale: another tilt or spin at release leaves a fifth
SAME_MOTION = 0.1
FEWEST_FITTED = 3  # samples of a window
NO_MISFIT = 10.0  # misfit of a missing quantity: more than any tilt [rad]
# an axis is meant where the fit comes so close to it, and the rest is another difference [rad]
NAMED_WITHIN = math.radians(1.5)
# a turn of the axes is the same all the time: that of each part of the motion may differ by this angle [rad],
# and by what noise and other small differences of the lean make of it
STEADY = math.radians(2.0)
SMALL_LEAN = 1e-3  # such differences, over the largest tilt
CONFIDENCE = 3.0  # standard deviations of the noise
OPEN = 0.5  # an angle that is known no better than this is not known [rad]
# two models that a first pass turned apart are off by the same angle in one swing, by chance in two
SWINGS = 3
FEWEST_LEANING = 8  # samples that lean without which there is no fit of the axes


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """Mistakes that explain a difference all together, if any, and what is left without them."""

    changes: tuple[Change, ...]
    left: Difference

    @property
    def mistakes(self) -> tuple[Mistake, ...]:
        """The likely mistakes."""
        return tuple(change.mistake for change in self.changes)


def explanations(values: Values, read: Read, reference: Reference) -> Iterator[Explanation]:
    """Explanations of a difference between columns and a reference, the likeliest first.

    The last explains the least, maybe nothing; there is none where the columns tell no motion.
    """
    search = _Search(values=values, read=read, reference=reference)
    motion = read(values)
    if motion is None:
        return
    for changes, other in search.tilt_explained(motion):
        for more, frame, turned in search.azimuth_explained(changes, other):
            of_axes = search.path_explained(turned, frame)
            if frame != Frame() and frame not in (change.frame for change in of_axes):
                of_axes = (frame.change("azimuth"), *of_axes)
            of_axes += search.spin_explained(turned, of_axes)
            yield Explanation(changes=(*changes, *more, *of_axes), left=search.left(turned, of_axes))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Search:
    """The columns whose difference from a reference is to be explained."""

    values: Values
    read: Read
    reference: Reference

    def left(self, motion: Motion, changes: Sequence[Change] = ()) -> Difference:
        """Difference from the reference after changes of a motion."""
        return self.reference.difference(with_changes(motion, changes))

    def tilt_explained(self, motion: Motion) -> Iterator[tuple[tuple[Change, ...], Motion]]:
        """Yield a change with which the tilt follows the reference, the closest first; last none at all."""
        before = self.left(motion)
        if before.tilt.differs:
            otherwise = [(one, self.read(one.values(self.values))) for one in readings(self.values)]
            alone = [((change,), other) for change, other in otherwise if other is not None]
            clocks = [((clock,), clock.motion(motion)) for clock in _clocks(self.reference, motion)]
            yield from self._following(before, [*alone, *clocks])
        yield (), motion

    def _following(
        self, before: Difference, tried: Sequence[tuple[tuple[Change, ...], Motion]]
    ) -> Iterator[tuple[tuple[Change, ...], Motion]]:
        """Changed motions that follow the reference, the closest first."""
        found = [(changes, motion, self.left(motion)) for changes, motion in tried]
        for changes, motion, after in sorted(found, key=lambda one: one[2].tilt.size):
            by_rate = any(change.mistake.code == "time_scale" for change in changes)
            if self._follows(before, after, motion, by_rate=by_rate):
                first, frame, _ = next(self.azimuth_explained(changes, motion))
                # two motions that differ may have tilts that agree longer by chance, but not azimuths, too
                if after.azimuth is None or not after.azimuth.differs or first or frame != Frame():
                    yield changes, motion
            elif by_rate:
                # no offset makes another motion the same
                return

    def _follows(self, before: Difference, after: Difference, motion: Motion, *, by_rate: bool) -> bool:
        """Whether the tilts agree for so much longer that it cannot be by chance."""
        alpha, scale = self.reference.alpha, self.reference.time_scale
        if after.agreed_peak < LEANING * after.tilt.bound * alpha:
            return False
        # over as much of the run as was compared before
        to_the_end = not after.tilt.differs and after.compared >= 0.5 * before.compared
        if by_rate:
            noise = (1.0 + 3.0 / math.sqrt(2.0 * len(motion.time))) * motion.noise / alpha
            return to_the_end and after.tilt.size <= math.hypot(SAME_MOTION * before.tilt.size, noise)
        long_enough = to_the_end or after.length >= LONG * scale
        return long_enough and after.agreed_motion >= MORE_MOTION * before.agreed_motion

    def azimuth_explained(
        self, changes: tuple[Change, ...], motion: Motion
    ) -> Iterator[tuple[tuple[Change, ...], Frame, Motion]]:
        """Yield columns read otherwise, or axes, with which the azimuth follows; last none at all."""
        found = self.left(motion)
        part = found.azimuth
        if part is not None and part.differs:
            tried: list[tuple[tuple[Change, ...], Frame, Motion | None]] = []
            # columns are read otherwise once
            if all(change.mistake.concerns == "time" for change in changes):
                own = [
                    one for one in readings(self.values) if one.mistake.concerns in ("quaternion", "azimuth")
                ]
                tried = [((one,), Frame(), correct(self.values, self.read, (*changes, one))) for one in own]
            fits = fitted_frames(self.reference, motion, start=found.start, end=found.covered)
            tried += [((), fit, motion) for fit in fits]
            for more, frame, other in tried:
                if other is not None:
                    left = self.left(frame.apply(other))
                    if explains(part, left.azimuth):
                        yield more, frame, other
        yield (), Frame(), motion

    def path_explained(self, motion: Motion, axes: Frame) -> tuple[Change, ...]:
        """The fewest changes that explain a path; what is wrong with the axes of the lean is expected."""
        before = self.left(motion)
        part = before.path
        if motion.path is None or part is None or not (part.differs or axes != Frame()):
            return ()
        expected = (Frame(), axes)
        fits = fitted_frames(
            self.reference, _with_lean_of_path(motion), start=before.start, end=before.covered
        )
        own = [
            (of_path(one),)
            for one in readings(dict.fromkeys(POSITION, motion.time))
            if one.mistake.concerns != "time"
        ]
        passing: list[tuple[float, float, tuple[Change, ...]]] = []
        for frame, read, moved in itertools.product((*expected, *fits), ((), *own), (False, True)):
            turn = [frame.change("axes" if frame == axes else "path")] if frame != Frame() else []
            # y up is no horizontal axis
            changes = tuple(sorted((*turn, *read), key=lambda one: one.mistake.code != "y_up"))
            changes += (
                (_origin(self.reference, with_changes(motion, changes), before.covered),) if moved else ()
            )
            left = self.left(motion, changes).path
            if left is not None and not left.differs and (explains(part, left) or not part.differs):
                # a constant offset has three numbers to fit: it comes after what has none
                count = (frame not in expected) + len(read) + 1.5 * moved
                passing.append((count, left.size, changes))
        return min(passing, key=lambda one: one[:2])[2] if passing else ()

    def spin_explained(self, motion: Motion, changes: tuple[Change, ...]) -> tuple[Change, ...]:
        """The steady spin about the axis that explains what turn is left with changes, if one does."""
        before = self.left(motion, changes)
        if before.twist is None or not before.twist.differs:
            return ()
        model, trial = on_samples_of(self.reference.motion, with_changes(motion, changes))
        assert model.twist is not None
        assert trial.twist is not None
        within = model.time <= before.covered + SAME_TIME
        time, apart = (model.time - model.time[0])[within], (trial.twist - model.twist)[within]
        change = spinning(float(time @ apart / (time @ time)))
        return (change,) if explains(before.twist, self.left(motion, (*changes, change)).twist) else ()


def _origin(reference: Reference, motion: Motion, end: float) -> Change:
    """Return the change that corrects another origin of the path."""
    wanted, own = on_samples_of(reference.motion, motion)
    assert wanted.path is not None
    assert own.path is not None
    origin = np.median((own.path - wanted.path)[wanted.time <= end + SAME_TIME], axis=0)

    def correct(given: Motion) -> Motion:
        assert given.path is not None
        return replace(given, path=given.path - origin)

    mistake = Mistake(code="origin", concerns="path", value=float(np.linalg.norm(origin)))
    return Change(mistake=mistake, motion=correct)


def _with_lean_of_path(motion: Motion) -> Motion:
    """Return the motion with the direction of its mass centre for that of its axis."""
    assert motion.path is not None
    flat = motion.path[:, 0] + 1j * motion.path[:, 1]
    return replace(motion, lean=np.sin(motion.tilt) * np.exp(1j * np.angle(flat)))


def _clocks(reference: Reference, motion: Motion) -> Iterator[Change]:
    """Yield offsets and rates of the clock, as the tilts tell them."""
    offsets = fitted_offsets(reference, motion)
    if reference.is_free and offsets and max(offsets) - min(offsets) > SAME_OFFSET * max(map(abs, offsets)):
        # a fall and a near pass magnify what differs, and are later by more the longer they last
        offsets = []
    for offset in offsets:
        # a clock that is off by less than a sample cannot be told from what a model and noise make of samples
        if abs(offset) > max(motion.step, SHORTEST_DELAY * reference.time_scale):
            mistake = Mistake(code="time_offset", concerns="time", value=offset)
            yield Change(mistake=mistake, motion=partial(Motion.with_clock, offset=offset))
    if reference.is_free:
        rate = fitted_rate(reference, motion)
        if abs(rate - 1.0) > SMALLEST_RATE:
            yield in_time_scale(rate)


def fitted_offsets(reference: Reference, motion: Motion) -> list[float]:
    """Return the offsets [s] that bring the tilt of a motion closest to the reference, smallest first."""
    found: list[float] = []
    largest = LARGEST_DELAY * float(reference.motion.time[-1])
    step = min(reference.time_scale / FINE, 0.5 * largest)
    tried = np.arange(-largest, largest + 0.5 * step, step)
    for window in WINDOWS:
        model = _beginning(reference, window)
        misfits = np.array([_misfit(model, motion, float(offset)) for offset in tried])
        inner = np.flatnonzero((misfits[1:-1] <= misfits[:-2]) & (misfits[1:-1] <= misfits[2:])) + 1
        # a fit that leaves half of the motion is none
        if not len(inner) or misfits[inner].min() > 0.5 * math.sqrt(float(np.mean(model.tilt**2))):
            continue
        highest = float(model.tilt.max())
        near = inner[misfits[inner] <= 3.0 * misfits[inner].min() + 0.02 * highest]
        best = [_refine(partial(_misfit, model, motion), float(tried[at]), step) for at in near]
        enough = ALIKE * min(best)[0] + 1e-3 * highest
        offset = min((offset for value, offset in best if value <= enough), key=abs)
        # the windows are there because one of them may be misled
        if offset and all(abs(offset - other) > 1e-3 * reference.time_scale for other in found):
            found.append(offset)
    return sorted(found, key=abs)


def fitted_rate(reference: Reference, motion: Motion) -> float:
    """Return the factor by which a free motion is slower than the reference, fitted in longer windows."""
    rate, width = 1.0, LARGEST_RATE
    for window in (*WINDOWS, math.inf):
        misfit = partial(_misfit, _beginning(reference, window), motion, 0.0)
        rate = float(min(rate + width * np.linspace(-1.0, 1.0, 41), key=misfit))
        width *= 0.3
    return _refine(misfit, rate, width)[1]


def _beginning(reference: Reference, window: float) -> Motion:
    """Samples of the reference within a number of time scales from its start."""
    motion, end = reference.motion, reference.start + window * reference.time_scale
    return motion.at(motion.time[(motion.time >= reference.start) & (motion.time <= end)])


def _misfit(model: Motion, motion: Motion, offset: float, slower: float = 1.0) -> float:
    """Root mean square difference of the tilts [rad] of a model and a motion, later and slower."""
    time = (model.time - offset) * slower
    begin, end = int(time.searchsorted(motion.time[0])), int(time.searchsorted(motion.time[-1], side="right"))
    # most of the window must be there, or a few samples that agree by chance decide
    if end - begin < max(0.5 * len(time), FEWEST_FITTED):
        return NO_MISFIT
    apart = np.interp(time[begin:end], motion.time, motion.tilt) - model.tilt[begin:end]
    return math.sqrt(float(apart @ apart) / len(apart))


def _refine(misfit: Callable[[float], float], centre: float, width: float) -> tuple[float, float]:
    """Least misfit near a minimum, and where it is, by finer and finer steps."""
    least = math.inf
    for _ in range(5):
        least, centre = min((misfit(float(x)), float(x)) for x in centre + width * np.linspace(-1.0, 1.0, 7))
        width /= 3.0
    return least, centre


def fitted_frames(reference: Reference, motion: Motion, *, start: float, end: float) -> list[Frame]:
    """Return the turn and the mirroring that bring the lean of a motion closest to that of the reference.

    Only those that are the same in each part of the time from start to end [s]. A part is a quarter of it,
    or lies between two passes by the upright position: a difference that comes with a pass is none of the
    axes.
    """
    model, trial = on_samples_of(reference.motion, motion)
    if model.lean is None or trial.lean is None:
        return []
    within = (model.time >= start) & (model.time <= end + SAME_TIME)
    counts = reference.leaning(model, trial, within)
    if np.count_nonzero(counts) < FEWEST_LEANING:
        return []
    moves = np.flatnonzero(within & (np.abs(model.lean) > 0.0))
    swings = np.split(moves, np.searchsorted(moves, _minima(model.tilt[moves[0] : moves[-1] + 1]) + moves[0]))
    small = SMALL_LEAN * float(reference.motion.tilt.max())
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
        if any(apart > STEADY + doubt for apart, doubt in off if doubt < OPEN):
            continue
        known = [doubt < (OPEN if mirrored else min(OPEN, 0.5 * abs(angle))) for _, doubt in off[4:]]
        # before the first pass, or in so many swings that no pass can be the reason
        if known and not known[0] and sum(known) < SWINGS:
            continue
        named = MIRRORS if mirrored else TURNS
        near = [exact for exact in named if abs(math.remainder(angle - exact, 2.0 * math.pi)) < NAMED_WITHIN]
        found.append(Frame(angle=near[0] if near else angle, mirrored=mirrored))
    return found


def _off(products: Complex, angle: float, lean: Complex, noise: float, small: float) -> tuple[float, float]:
    """Difference of the rotation of a part from that of the whole, and its uncertainty [rad]."""
    strength = math.sqrt(float(np.mean(np.abs(lean) ** 2)))
    doubt = (CONFIDENCE * noise / math.sqrt(len(lean)) + small) / strength
    return abs(float(np.angle(products.sum() * np.exp(-1j * angle)))), doubt


def _minima(tilt: Array) -> NDArray[np.intp]:
    """Return the samples of minimum tilt: even a shallow first pass may turn one of two motions."""
    return np.flatnonzero((tilt[1:-1] <= tilt[:-2]) & (tilt[1:-1] < tilt[2:])) + 1
