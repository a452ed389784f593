"""Likely mistakes in a trajectory: what, taken back, makes it follow the reference.

A small family is tried: units and order of the columns, the clock, the rate of a free motion, the horizontal
axes, and of the path also its unit, its origin and the vertical axis. One is named only where the trajectory
follows the reference without it and did not with it; what none explains is a difference of the body, its
start, the ground motion or the method.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from .difference import Difference, Reference, explains
from .motion import SAME_TIME, Complex, Motion, on_samples_of
from .table import POSITION, QUATERNION, Array, Values

DEGREES = math.degrees(1.0)
LENGTH_FACTORS = (1e3, 1e2, 1e-2, 1e-3)
# what stands where qw, qx, qy and qz should; where z is reversed the axis of the body points down
QUATERNION_ORDERS = {
    "quaternion_scalar_last": ("qz", "qw", "qx", "qy"),
    "quaternion_inverse": ("qw", "-qx", "-qy", "-qz"),
    "z_reversed": ("-qx", "qw", "qz", "-qy"),
}
# how much more motion must agree without the mistake, and how far it must lean while it does, in bounds
MORE_MOTION, LEANING = 4.0, 5.0
# how long it must agree, over the time scale of rocking, or up to the end
LONG = 3.0
# windows in which the clock is fitted, over that scale: the first motion agrees best, and may be too little
WINDOWS = (3.0, 6.0, 12.0)
SHORTEST_DELAY = 0.01  # an offset of the clock that is named, over the time scale
LARGEST_DELAY = 0.5  # the largest that is tried, over the length of the run
FINE = 40.0  # samples of the time scale in the first search of an offset
ALIKE = 1.5  # rocking repeats itself: of offsets whose misfit is at most this times the least, the smallest
SMALLEST_RATE, LARGEST_RATE = 2.5e-3, 0.15  # by which a rate that is named differs from 1
# what is left of the tilt difference in the right time scale: another tilt or spin at release leaves a fifth
SAME_MOTION = 0.1
FEWEST_FITTED = 3  # samples of a window
NO_MISFIT = 10.0  # of what is not there: more than any tilt [rad]
# an axis is meant where the fit comes so close to it, and the rest is another difference [rad]
NAMED_WITHIN = math.radians(1.5)
# a turn of the axes is the same all the time: that of each part of the motion may differ by this angle [rad],
# and by what noise and other small differences of the lean make of it
STEADY = math.radians(2.0)
SMALL_LEAN = 1e-3  # such differences, over the largest tilt
CONFIDENCE = 3.0  # standard deviations of the noise
OPEN = 0.5  # an angle that is known no better than this is not known [rad]
SWINGS = (
    3  # two models that a first pass turned apart are off by the same angle in one swing, by chance in two
)
FEWEST_LEANING = 8  # samples that lean without which there is no fit of the axes

TURNS = {math.pi: "turned_back"}
MIRRORS = {
    0.0: "y_reversed",
    math.pi: "x_reversed",
    0.5 * math.pi: "axes_exchanged",
    -0.5 * math.pi: "axes_exchanged_reversed",
}
AXES_WORDS = {
    "turned_back": "turned by 180 deg, as where the side that lifts is given for the side it leans to, or "
    "the ground acceleration has the other sign",
    "x_reversed": "mirrored: x has the other sign",
    "y_reversed": "mirrored: y has the other sign, or azimuths are counted clockwise",
    "axes_exchanged": "mirrored: x and y are exchanged, or azimuths are counted clockwise from y (north)",
    "axes_exchanged_reversed": "mirrored: x and y are exchanged and have the other sign, as where x is "
    "north, y east and z down",
}
WORDS = {
    "z_reversed": "z points down",
    "y_up": "y points up",
    "quaternion_scalar_last": "the quaternion has its scalar last, not first",
    "quaternion_inverse": "the quaternion is inverse: from world to body",
}
LENGTH_WORDS = {
    1e3: "in mm, read as m",
    1e2: "in cm, read as m",
    1e-2: "in m, read as cm",
    1e-3: "in m, read as mm",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Mistake:
    """One likely mistake.

    Attributes
    ----------
    code : str
        "time_offset" (value: to be added to the times [s]), "time_scale" (value: the motion is slower by
        this factor), "time_unit", "angle_unit", "length_unit" (value: too large by this factor), "turned"
        (by value [deg], counter-clockwise), "turned_back" (by half a turn), "x_reversed", "y_reversed",
        "axes_exchanged", "axes_exchanged_reversed", "mirrored" (value: azimuth of the line [deg]),
        "z_reversed", "y_up", "quaternion_scalar_last", "quaternion_inverse", "origin" (value: its distance
        from the right one [m]).
    concerns : str
        "time", "tilt", "azimuth", "tilt and azimuth", "quaternion", "path", or "axes": azimuth and path.
    value : float
        NaN where there is none.
    """

    code: str
    concerns: str
    value: float = math.nan

    @property
    def changes_tilt(self) -> bool:
        """Whether tilts differ by it; horizontal axes, azimuth and the path beside a tilt change none."""
        return self.code == "y_up" or self.concerns not in ("azimuth", "path", "axes")

    @property
    def words(self) -> str:
        """The mistake in words."""
        value, concerns = self.value, self.concerns
        its = f"its {concerns} {'are' if ' and ' in concerns or concerns == 'axes' else 'is'}"
        match self.code:
            case "time_offset":
                late = "late" if value < 0.0 else "early"
                return f"its clock is {abs(value):.3f} s {late}: an offset of {value:.3f} s takes that back"
            case "time_scale":
                size, weight = 100.0 * (value**2 - 1.0), 100.0 * (value**-2 - 1.0)
                rate = f"{100.0 * abs(value - 1.0):.2f} % {'slower' if value > 1.0 else 'faster'}"
                return f"it moves {rate}, as with R {size:+.2f} %, g {weight:+.2f} % or another slenderness"
            case "time_unit":
                return f"times are in {'ms, read as s' if value > 1.0 else 's, read as ms'}"
            case "angle_unit":
                return f"{its} in {'degrees, read as radians' if value > 1.0 else 'radians, read as degrees'}"
            case "length_unit":
                return f"x, y and z are {LENGTH_WORDS[value]}"
            case "origin":
                return f"x, y and z are counted from a point {value:.3g} m from the original base centre"
            case "turned":
                return f"{its} turned by {value:.1f} deg (counter-clockwise)"
            case "mirrored":
                return f"{its} mirrored in the line at {value:.1f} deg, so that it rolls the other way round"
            case code:
                return WORDS.get(code) or f"{its} {AXES_WORDS[code]}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """What takes a mistake back: of the columns, or of the motion that they tell."""

    mistake: Mistake
    values: Callable[[Values], Values] = field(default=lambda values: values)
    motion: Callable[[Motion], Motion] = field(default=lambda motion: motion)
    frame: Frame | None = None  # axes that lean and path have in common


Read = Callable[[Values], Motion | None]  # the motion that columns tell; None where they tell none


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """Mistakes that explain a difference all together, if any, and what is left without them."""

    changes: tuple[Change, ...]
    left: Difference

    @property
    def mistakes(self) -> tuple[Mistake, ...]:
        """The likely mistakes."""
        return tuple(change.mistake for change in self.changes)


def corrected(values: Values, read: Read, changes: Sequence[Change]) -> Motion | None:
    """Return the motion of columns after some changes."""
    for change in changes:
        values = change.values(values)
    motion = read(values)
    return None if motion is None else changed(motion, changes)


def changed(motion: Motion, changes: Sequence[Change]) -> Motion:
    """Return a motion after some changes, as far as they are of the motion."""
    for change in changes:
        motion = change.motion(motion)
    return motion


def readings(values: Values) -> Iterator[Change]:
    """Yield the mistakes in units, order and vertical axis of columns that change the pose."""

    def in_unit(code: str, concerns: str, names: Sequence[str], factor: float) -> Change:
        def taken_back(given: Values) -> Values:
            return given | {name: given[name] / factor for name in names}

        return Change(mistake=Mistake(code=code, concerns=concerns, value=factor), values=taken_back)

    def in_order(code: str, concerns: str, signed: dict[str, str]) -> Change:
        def taken_back(given: Values) -> Values:
            known = {name: own for name, own in signed.items() if name in given}
            return given | {
                name: -given[own[1:]] if own[0] == "-" else given[own] for name, own in known.items()
            }

        return Change(mistake=Mistake(code=code, concerns=concerns), values=taken_back)

    by_position = not {"qw", "tilt"} & set(values)
    if "qw" in values:
        for code, own in QUATERNION_ORDERS.items():
            yield in_order(code, "quaternion", dict(zip(QUATERNION, own, strict=True)))
    elif by_position:
        yield in_order("z_reversed", "path", {"z": "-z"})
        for factor in LENGTH_FACTORS:
            yield in_unit("length_unit", "path", POSITION, factor)
    else:
        for names in (("tilt", "azimuth"), ("azimuth",), ("tilt",)):
            if set(names) <= set(values):
                for factor in (DEGREES, 1.0 / DEGREES):
                    yield in_unit("angle_unit", " and ".join(names), names, factor)
    if "qw" in values or by_position:
        yield in_order("y_up", "axes", {"y": "-z", "z": "y", "qy": "-qz", "qz": "qy"})
    for factor in (1e3, 1e-3):
        yield in_unit("time_unit", "time", ("time",), factor)


def explanations(values: Values, read: Read, reference: Reference) -> Iterator[Explanation]:
    """Yield what explains that columns differ from a reference, the likeliest first.

    The last explains the least, maybe nothing; there is none where the columns tell no motion.
    """
    search = _Search(values=values, read=read, reference=reference)
    motion = read(values)
    if motion is None:
        return
    for changes, other in search.tilt_explained(motion):
        for more, frame, turned in search.azimuth_explained(changes, other):
            of_axes = _path_explained(reference, turned, frame)
            if frame != Frame() and frame not in (change.frame for change in of_axes):
                of_axes = (frame.change("azimuth"), *of_axes)
            left = reference.difference(changed(turned, of_axes))
            yield Explanation(changes=(*changes, *more, *of_axes), left=left)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Search:
    """The columns whose difference from a reference is to be explained."""

    values: Values
    read: Read
    reference: Reference

    def tilt_explained(self, motion: Motion) -> Iterator[tuple[tuple[Change, ...], Motion]]:
        """Yield changes with which the tilt follows the reference, fewest first; last none at all."""
        before = self.reference.difference(motion)
        if before.tilt.differs:
            otherwise = [(one, self.read(one.values(self.values))) for one in readings(self.values)]
            alone = [((change,), other) for change, other in otherwise if other is not None]
            clocks = [((clock,), clock.motion(motion)) for clock in _clocks(self.reference, motion)]
            yield from self._following(before, [*alone, *clocks])
            both = [
                ((*changes, clock), clock.motion(other))
                for changes, other in alone
                for clock in _clocks(self.reference, other)
            ]
            yield from self._following(before, both)
        yield (), motion

    def _following(
        self, before: Difference, tried: Sequence[tuple[tuple[Change, ...], Motion]]
    ) -> Iterator[tuple[tuple[Change, ...], Motion]]:
        """Yield those that follow the reference, the closest first."""
        found = [(changes, motion, self.reference.difference(motion)) for changes, motion in tried]
        for changes, motion, after in sorted(found, key=lambda one: one[2].tilt.size):
            by_rate = any(change.mistake.code == "time_scale" for change in changes)
            if self._follows(before, after, motion, by_rate=by_rate):
                first, frame, _ = next(self.azimuth_explained(changes, motion))
                # two motions that differ may have tilts that agree longer by chance, but not azimuths, too
                if after.azimuth is None or not after.azimuth.differs or first or frame != Frame():
                    yield changes, motion
            elif by_rate:
                # whose motion is another one, and no offset makes it the same
                return

    def _follows(self, before: Difference, after: Difference, motion: Motion, *, by_rate: bool) -> bool:
        """Whether the tilts agree over so much more motion that chance is no reason."""
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
        found = self.reference.difference(motion)
        part = found.azimuth
        if part is not None and part.differs:
            tried: list[tuple[tuple[Change, ...], Frame, Motion | None]] = []
            # columns are read otherwise once
            if all(change.mistake.concerns == "time" for change in changes):
                own = [
                    one for one in readings(self.values) if one.mistake.concerns in ("quaternion", "azimuth")
                ]
                tried = [((one,), Frame(), corrected(self.values, self.read, (*changes, one))) for one in own]
            fits = fitted_frames(self.reference, motion, start=found.start, end=found.covered)
            tried += [((), fit, motion) for fit in fits]
            for more, frame, other in tried:
                if other is not None:
                    left = self.reference.difference(frame.apply(other))
                    if explains(part, left.azimuth):
                        yield more, frame, other
        yield (), Frame(), motion


def _clocks(reference: Reference, motion: Motion) -> Iterator[Change]:
    """Yield offsets and rates of the clock, as the tilts tell them."""
    for offset in fitted_offsets(reference, motion):
        # a clock that is off by less than a sample cannot be told from what a model and noise make of samples
        if abs(offset) > max(motion.step, SHORTEST_DELAY * reference.time_scale):
            mistake = Mistake(code="time_offset", concerns="time", value=offset)
            yield Change(mistake=mistake, motion=partial(Motion.clocked, offset=offset))
    if reference.is_free:
        rate = fitted_rate(reference, motion)
        if abs(rate - 1.0) > SMALLEST_RATE:
            yield in_time_scale(rate)


def in_time_scale(rate: float) -> Change:
    """Return what takes back that a motion is slower by a factor."""
    mistake = Mistake(code="time_scale", concerns="time", value=rate)
    return Change(mistake=mistake, motion=partial(Motion.clocked, rate=1.0 / rate))


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
        # what leaves half of the motion is no fit
        if not len(inner) or misfits[inner].min() > 0.5 * math.sqrt(float(np.mean(model.tilt**2))):
            continue
        highest = float(model.tilt.max())
        near = inner[misfits[inner] <= 3.0 * misfits[inner].min() + 0.02 * highest]
        best = [_refined(partial(_misfit, model, motion), float(tried[at]), step) for at in near]
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
    return _refined(misfit, rate, width)[1]


def _beginning(reference: Reference, window: float) -> Motion:
    """The samples of the reference in so many time scales from its start."""
    motion, end = reference.motion, reference.start + window * reference.time_scale
    return motion.at(motion.time[(motion.time >= reference.start) & (motion.time <= end)])


def _misfit(model: Motion, motion: Motion, offset: float, slower: float = 1.0) -> float:
    """Root mean square difference of the tilts [rad] of a model and a motion that is late and slower."""
    time = (model.time - offset) * slower
    begin, end = int(time.searchsorted(motion.time[0])), int(time.searchsorted(motion.time[-1], side="right"))
    # most of the window must be there, or a few samples that agree by chance decide
    if end - begin < max(0.5 * len(time), FEWEST_FITTED):
        return NO_MISFIT
    apart = np.interp(time[begin:end], motion.time, motion.tilt) - model.tilt[begin:end]
    return math.sqrt(float(apart @ apart) / len(apart))


def _refined(misfit: Callable[[float], float], centre: float, width: float) -> tuple[float, float]:
    """Least misfit near a minimum, and where it is, by finer and finer steps."""
    least = math.inf
    for _ in range(5):
        least, centre = min((misfit(float(x)), float(x)) for x in centre + width * np.linspace(-1.0, 1.0, 7))
        width /= 3.0
    return least, centre


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """Change of a motion into the axes of the reference: y reversed if mirrored, then a turn.

    A turn by beta multiplies the lean by exp(i beta); axes of the other sense, such as x and y exchanged, an
    azimuth counted clockwise or a mirrored table, conjugate it first. In planar motion both do the same.
    The angle is counter-clockwise, in (-pi, pi] [rad].
    """

    angle: float = 0.0
    mirrored: bool = False

    def apply(self, motion: Motion) -> Motion:
        """Return the motion in the axes of the reference."""
        return motion.turned(self.angle, mirrored=self.mirrored)

    def change(self, concerns: str) -> Change:
        """Return what takes the mistake back in "azimuth", "path", or "axes", which are both."""
        named = MIRRORS if self.mirrored else TURNS
        code = named.get(self.angle, "mirrored" if self.mirrored else "turned")
        value = {"turned": -math.degrees(self.angle), "mirrored": 0.5 * math.degrees(self.angle)}.get(
            code, math.nan
        )

        def taken_back(motion: Motion) -> Motion:
            other = self.apply(motion)
            if concerns == "azimuth":
                return replace(motion, lean=other.lean)
            return replace(motion, path=other.path) if concerns == "path" else other

        mistake = Mistake(code=code, concerns=concerns, value=value)
        return Change(mistake=mistake, motion=taken_back, frame=self if concerns == "axes" else None)


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
    """Return how far the turn of a part is from that of the whole, and how well it is known [rad]."""
    strength = math.sqrt(float(np.mean(np.abs(lean) ** 2)))
    doubt = (CONFIDENCE * noise / math.sqrt(len(lean)) + small) / strength
    return abs(float(np.angle(products.sum() * np.exp(-1j * angle)))), doubt


def _minima(tilt: Array) -> NDArray[np.intp]:
    """Return the samples of least tilt: a first pass may hardly be one, and still turn one of two motions."""
    return np.flatnonzero((tilt[1:-1] <= tilt[:-2]) & (tilt[1:-1] < tilt[2:])) + 1


def _path_explained(reference: Reference, motion: Motion, axes: Frame) -> tuple[Change, ...]:
    """Return the fewest changes that explain a path; what is wrong with the axes of the lean is expected."""
    before = reference.difference(motion)
    part = before.path
    if motion.path is None or part is None or not (part.differs or axes != Frame()):
        return ()
    expected = (Frame(), axes)
    fits = fitted_frames(reference, _with_lean_of_path(motion), start=before.start, end=before.covered)
    own = [
        _of_path(one)
        for one in readings(dict.fromkeys(POSITION, motion.time))
        if one.mistake.code != "time_unit"
    ]
    pairs = [pair for pair in itertools.combinations(own, 2) if len({one.mistake.code for one in pair}) == 2]
    read_otherwise = [(), *((one,) for one in own), *pairs]

    def count(trial: tuple[Frame, tuple[Change, ...], bool]) -> float:
        frame, changes, moved = trial
        # a constant offset has three numbers to fit: it comes after what has none
        return (frame not in expected) + len(changes) + 1.5 * moved

    frames = dict.fromkeys((*expected, *fits))
    tried = sorted(itertools.product(frames, read_otherwise, (False, True)), key=count)
    for _, alike in itertools.groupby(tried, key=count):
        passing: list[tuple[float, tuple[Change, ...]]] = []
        for frame, changes, moved in alike:
            turn = [frame.change("axes" if frame == axes else "path")] if frame != Frame() else []
            # y up is no horizontal axis
            changes = tuple(sorted((*turn, *changes), key=lambda one: one.mistake.code != "y_up"))
            changes += (_origin(reference, changed(motion, changes), before.covered),) if moved else ()
            left = reference.difference(changed(motion, changes)).path
            if left is not None and not left.differs and (explains(part, left) or not part.differs):
                passing.append((left.size, changes))
        if passing:
            return min(passing, key=lambda one: one[0])[1]
    return ()


def _of_path(reading: Change) -> Change:
    """Return the change of a path alone that a reading of its columns is."""
    mistake = replace(reading.mistake, concerns="path")

    def taken_back(motion: Motion) -> Motion:
        assert motion.path is not None
        columns = reading.values(dict(zip(POSITION, motion.path.T, strict=True)))
        noise = motion.path_noise / (mistake.value if mistake.code == "length_unit" else 1.0)
        return replace(motion, path=np.column_stack([columns[name] for name in POSITION]), path_noise=noise)

    return Change(mistake=mistake, motion=taken_back)


def _origin(reference: Reference, motion: Motion, end: float) -> Change:
    """Return what takes back that a path is counted from elsewhere."""
    wanted, own = on_samples_of(reference.motion, motion)
    assert wanted.path is not None
    assert own.path is not None
    origin = np.median((own.path - wanted.path)[wanted.time <= end + SAME_TIME], axis=0)

    def taken_back(given: Motion) -> Motion:
        assert given.path is not None
        return replace(given, path=given.path - origin)

    mistake = Mistake(code="origin", concerns="path", value=float(np.linalg.norm(origin)))
    return Change(mistake=mistake, motion=taken_back)


def _with_lean_of_path(motion: Motion) -> Motion:
    """Return the motion with the direction of its mass centre for that of its axis."""
    assert motion.path is not None
    flat = motion.path[:, 0] + 1j * motion.path[:, 1]
    return replace(motion, lean=np.sin(motion.tilt) * np.exp(1j * np.angle(flat)))
