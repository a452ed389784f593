"""Likely mistakes in a trajectory, of units, order of columns, clock and axes, with their corrections.

A table of plain ones is tried: another reading of the columns, another clock, the axes turned by quarter
turns or mirrored, and of the path also its unit and its origin. One is named only where the trajectory
follows the reference without it and did not with it; what none explains is a difference of the body, its
start, the ground motion or the method.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from .motion import SAME_TIME, Difference, Motion, Reference, explains, on_samples_of
from .table import POSITION, QUATERNION, Values

DEGREES = math.degrees(1.0)
CLOCK_FACTORS = tuple(factor**sign for factor in (2.0, 3.0, 4.0, 5.0, 8.0, 10.0) for sign in (1, -1))
# order and signs in place of qw, qx, qy, qz; where z is reversed the axis of the body points down
QUATERNION_ORDERS = {
    "quaternion_scalar_last": ("qz", "qw", "qx", "qy"),
    "quaternion_inverse": ("qw", "-qx", "-qy", "-qz"),
    "z_reversed": ("-qx", "qw", "qz", "-qy"),
}
# transformation of a tilt vector to the axes of the reference: a rotation, after a mirror image if mirrored.
# In planar motion both are the same, and the rotation is named
FRAMES: Mapping[tuple[float, bool], str] = {
    (math.pi, False): "turned_back",
    (0.5 * math.pi, False): "turned_clockwise",
    (-0.5 * math.pi, False): "turned_counterclockwise",
    (0.0, True): "y_reversed",
    (math.pi, True): "x_reversed",
    (0.5 * math.pi, True): "axes_exchanged",
    (-0.5 * math.pi, True): "axes_exchanged_reversed",
}
ENERGY_LOSS, ROLLING_RESISTANCE = "energy_loss", "rolling_resistance"
LENGTHS = {
    1e3: "in mm, read as m",
    1e2: "in cm, read as m",
    1e-2: "in m, read as cm",
    1e-3: "in m, read as mm",
}
# words of each code, or those of a value below 1 and above it
WORDS: Mapping[str, str | tuple[str, str]] = {
    "time_offset": "its clock is off: an offset of {value:.3f} s takes that back",
    "time_scale": "it takes {value:.4f} times as long, as with R {size:+.2f} %, g {weight:+.2f} % or another "
    "slenderness",
    "clock": (
        "it runs in fast motion: times are {value:g} of the right ones",
        "it runs in slow motion: times are {value:g} times too long",
    ),
    "spin": "it spins about its axis by {value:.3g} deg/s, so that its base must slip",
    "time_unit": ("times are in s, read as ms", "times are in ms, read as s"),
    "angle_unit": ("{its} in radians, read as degrees", "{its} in degrees, read as radians"),
    "length_unit": "x, y and z are {length}",
    "origin": "x, y and z are counted from a point {value:.3g} m from the original base centre",
    "turned_back": "{its} turned by 180 deg, as where the side that lifts is given for the side it leans "
    "to, or the ground acceleration has the other sign",
    "turned_clockwise": "{its} turned by 90 deg clockwise",
    "turned_counterclockwise": "{its} turned by 90 deg counter-clockwise",
    "x_reversed": "{its} mirrored: x has the other sign",
    "y_reversed": "{its} mirrored: y has the other sign, or azimuths are counted clockwise",
    "axes_exchanged": "{its} mirrored: x and y are exchanged, or azimuths are counted clockwise from y "
    "(north)",
    "axes_exchanged_reversed": "{its} mirrored: x and y are exchanged and have the other sign, as where x "
    "is north, y east and z down",
    "z_reversed": "z points down",
    "y_up": "y points up",
    "quaternion_scalar_last": "the quaternion has its scalar last, not first",
    "quaternion_inverse": "the quaternion is inverse: from world to body",
    ENERGY_LOSS: "it loses energy, {percent:.2g} % of its tilt from each swing to the next",
    ROLLING_RESISTANCE: "as with a rolling resistance of {value:.2g} m",
}
# factor by which the agreement must be longer without the mistake, and tilt in it, in bounds
MORE_MOTION, LEANING = 4.0, 5.0
LONG = 3.0  # least agreement over the time scale of rocking, unless to the end
SHORTEST_OFFSET = 0.01  # smallest offset of a clock that is named, over the time scale
# smallest and largest relative difference of a time scale that is named
SMALLEST_RATE, LARGEST_RATE = 2.5e-3, 0.15
# share of the tilt difference of a release left by the right clock: another tilt or spin leaves a fifth
SAME_MOTION = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class Mistake:
    """One likely mistake.

    Attributes
    ----------
    code : str
        One of `WORDS`. With a value: "time_offset" (to be added to the times [s]), "time_scale" (the motion
        is slower by this factor), "clock" (times are too large by this factor), "spin" [deg/s], "time_unit",
        "angle_unit", "length_unit" (too large by this factor), "origin" (distance from the right one [m]);
        and losses that the model does not have: "energy_loss" (share of the tilt from one maximum to the
        next), "rolling_resistance" [m].
    concerns : str
        "time", "tilt", "azimuth", "tilt and azimuth", "quaternion", "path", "twist", or "axes": azimuth
        and path.
    value : float
        NaN where there is none.
    """

    code: str
    concerns: str
    value: float = math.nan

    @property
    def changes_tilt(self) -> bool:
        """Whether it changes tilts; mistakes in horizontal axes, azimuth or path (beside a tilt) do not."""
        return self.code == "y_up" or self.concerns not in ("azimuth", "path", "axes", "twist")

    @property
    def words(self) -> str:
        """The mistake in words."""
        value, concerns = self.value, self.concerns
        words = WORDS.get(self.code, self.code)  # an older result may name another code
        its = f"its {concerns} {'are' if ' and ' in concerns or concerns == 'axes' else 'is'}"
        size, weight = 100.0 * (value**2 - 1.0), 100.0 * (value**-2 - 1.0) if value else math.nan
        return (words if isinstance(words, str) else words[value > 1.0]).format(
            value=value, its=its, size=size, weight=weight, percent=100.0 * value, length=LENGTHS.get(value)
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """Correction of a mistake: of the columns, or of the motion in them."""

    mistake: Mistake
    values: Callable[[Values], Values] = field(default=lambda values: values)
    motion: Callable[[Motion], Motion] = field(default=lambda motion: motion)


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """Mistakes that together explain a difference, if any, and the difference without them."""

    changes: tuple[Change, ...]
    left: Difference

    @property
    def mistakes(self) -> tuple[Mistake, ...]:
        """The likely mistakes."""
        return tuple(change.mistake for change in self.changes)


Read = Callable[[Values], Motion | None]  # motion in the columns; None where they hold none
Changed = tuple[tuple[Change, ...], Motion]  # changes, and the motion after them


def correct(values: Values, read: Read, changes: Sequence[Change]) -> Motion | None:
    """Motion in the columns after some changes."""
    for change in changes:
        values = change.values(values)
    motion = read(values)
    return None if motion is None else _with_changes(motion, changes)


def _with_changes(motion: Motion, changes: Sequence[Change]) -> Motion:
    for change in changes:
        motion = change.motion(motion)
    return motion


def readings(values: Values) -> Iterator[Change]:
    """Mistakes in units, order and vertical axis of columns, with their corrections."""

    def in_unit(code: str, concerns: str, names: Sequence[str], factor: float) -> Change:
        def correct(given: Values) -> Values:
            return given | {name: given[name] / factor for name in names}

        return Change(mistake=Mistake(code=code, concerns=concerns, value=factor), values=correct)

    def in_order(code: str, concerns: str, signed: dict[str, str]) -> Change:
        def correct(given: Values) -> Values:
            known = {name: own for name, own in signed.items() if name in given}
            return given | {
                name: -given[own[1:]] if own[0] == "-" else given[own] for name, own in known.items()
            }

        return Change(mistake=Mistake(code=code, concerns=concerns), values=correct)

    by_position = not {"qw", "tilt"} & set(values)
    if "qw" in values:
        for code, own in QUATERNION_ORDERS.items():
            yield in_order(code, "quaternion", dict(zip(QUATERNION, own, strict=True)))
    elif by_position:
        yield in_order("z_reversed", "path", {"z": "-z"})
        for factor in LENGTHS:
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
    for factor in CLOCK_FACTORS:
        yield in_unit("clock", "time", ("time",), factor)


def in_time_scale(rate: float) -> Change:
    """Correction of a motion that is slower by a factor."""
    mistake = Mistake(code="time_scale", concerns="time", value=rate)
    return Change(mistake=mistake, motion=partial(Motion.with_clock, rate=1.0 / rate))


def _in_frame(frame: tuple[float, bool], concerns: str) -> Change:
    """Correction of the axes of "azimuth", "path", or both ("axes")."""

    def correct(motion: Motion) -> Motion:
        other = motion.rotated(frame[0], mirrored=frame[1])
        if concerns == "azimuth":
            return replace(motion, lean=other.lean, twist=other.twist)
        return replace(motion, path=other.path) if concerns == "path" else other

    return Change(mistake=Mistake(code=FRAMES[frame], concerns=concerns), motion=correct)


def explanations(values: Values, read: Read, reference: Reference) -> Iterator[Explanation]:
    """Explanations of a difference between columns and a reference, the likeliest first.

    The last explains the least, maybe nothing; there is none where the columns tell no motion.
    """
    motion = read(values)
    if motion is None:
        return
    for changes, other in _tilts_explained(values, read, reference, motion):
        for more, frame in _azimuths_explained(values, read, reference, changes, other):
            whole = (*changes, *more)
            turned = correct(values, read, whole) if more else other
            assert turned is not None
            of_axes = _path_explained(reference, turned, frame)
            if frame is not None and "axes" not in (change.mistake.concerns for change in of_axes):
                of_axes = (_in_frame(frame, "azimuth"), *of_axes)
            of_axes += _spin_explained(reference, _with_changes(turned, of_axes))
            left = reference.difference(_with_changes(turned, of_axes))
            yield Explanation(changes=(*whole, *of_axes), left=left)


def _tilts_explained(values: Values, read: Read, reference: Reference, motion: Motion) -> Iterator[Changed]:
    """Changes with which the tilt follows the reference, the closest first; no change last."""
    before = reference.difference(motion)
    if before.tilt.differs:
        others = [(change, read(change.values(values))) for change in readings(values)]
        others += [(change, change.motion(motion)) for change in _clocks(reference, motion)]
        tried = [
            (reference.difference(other), change, other) for change, other in others if other is not None
        ]
        for after, change, other in sorted(tried, key=lambda one: one[0].tilt.size):
            fitted = reference.is_free and change.mistake.code in ("time_scale", "time_offset")
            if _follows(reference, before, after, other, fitted=fitted):
                more, frame = next(_azimuths_explained(values, read, reference, (change,), other))
                # tilts of two different motions may agree longer by chance, but not azimuths, too
                if after.azimuth is None or not after.azimuth.differs or more or frame is not None:
                    yield (change,), other
            elif fitted:
                break  # no clock makes one motion of another
    yield (), motion


def _follows(
    reference: Reference, before: Difference, after: Difference, motion: Motion, *, fitted: bool
) -> bool:
    """Whether the tilts agree for longer than chance allows."""
    if after.agreed_peak < LEANING * after.tilt.bound * reference.alpha:
        return False
    # over as much of the run as was compared before
    to_the_end = not after.tilt.differs and after.compared >= 0.5 * before.compared
    if fitted:
        noise = (1.0 + 3.0 / math.sqrt(2.0 * len(motion.time))) * motion.noise / reference.alpha
        return to_the_end and after.tilt.size <= math.hypot(SAME_MOTION * before.tilt.size, noise)
    long_enough = to_the_end or after.length >= LONG * reference.time_scale
    return long_enough and after.agreed_motion >= MORE_MOTION * before.agreed_motion


def _clocks(reference: Reference, motion: Motion) -> Iterator[Change]:
    """Candidate clocks: an offset by the first passage of half the peak, and the rate of a free motion."""

    def size(other: Motion, model: Motion) -> float:
        return (
            replace(reference, motion=model)
            .difference(replace(other, lean=None, path=None, twist=None))
            .tilt.size
        )

    whole, unit = replace(reference.motion, lean=None, path=None, twist=None), reference.time_scale
    level = 0.5 * float(whole.tilt.max(initial=0.0))
    passages = [np.flatnonzero(np.diff(each.tilt > level)) for each in (whole, motion)]
    if all(map(len, passages)):
        offset = float(whole.time[passages[0][0]] - motion.time[passages[1][0]])
        for width in (0.1, 0.03, 0.01, 0.003, 0.001):
            tried = offset + width * unit * np.linspace(-1.0, 1.0, 7)
            offset = float(min(tried, key=lambda at: size(motion.with_clock(offset=float(at)), whole)))
        # an offset below one sample is within the interpolation and noise of the samples
        if abs(offset) > max(motion.step, SHORTEST_OFFSET * unit):
            mistake = Mistake(code="time_offset", concerns="time", value=offset)
            yield Change(mistake=mistake, motion=partial(Motion.with_clock, offset=offset))
    if reference.is_free:
        rate, width = 1.0, LARGEST_RATE
        for window in (3.0, 6.0, 12.0, math.inf, math.inf):  # in longer windows, over the time scale
            model = whole.at(whole.time[whole.time <= reference.start + window * unit])
            rates = rate + width * np.linspace(-1.0, 1.0, 41)
            rate = float(min(rates, key=lambda one: size(motion.with_clock(rate=1.0 / one), model)))
            width *= 0.3
        if abs(rate - 1.0) > SMALLEST_RATE:
            yield in_time_scale(rate)


def _azimuths_explained(
    values: Values, read: Read, reference: Reference, changes: tuple[Change, ...], motion: Motion
) -> Iterator[tuple[tuple[Change, ...], tuple[float, bool] | None]]:
    """Other readings of columns, or axes, with which the azimuth follows; no change last."""
    before = reference.difference(motion).azimuth
    if before is not None and before.differs:
        # columns have at most one other reading
        if all(change.mistake.concerns == "time" for change in changes):
            for one in readings(values):
                if one.mistake.concerns in ("quaternion", "azimuth"):
                    other = correct(values, read, (*changes, one))
                    if other is not None and explains(before, reference.difference(other).azimuth):
                        yield (one,), None
        for frame in FRAMES:
            if explains(before, reference.difference(_in_frame(frame, "azimuth").motion(motion)).azimuth):
                yield (), frame
    yield (), None


def _path_explained(
    reference: Reference, motion: Motion, axes: tuple[float, bool] | None
) -> tuple[Change, ...]:
    """Fewest changes that explain a path; expected are those of the axes of the tilt vector."""
    before = reference.difference(motion)
    part = before.path
    if motion.path is None or part is None or not (part.differs or axes):
        return ()
    own = [
        (_of_path(one),)
        for one in readings(dict.fromkeys(POSITION, motion.time))
        if one.mistake.concerns != "time"
    ]
    passing: list[tuple[float, float, tuple[Change, ...]]] = []
    for frame, reading, moved in itertools.product((None, *FRAMES), ((), *own), (False, True)):
        turn = [] if frame is None else [_in_frame(frame, "axes" if frame == axes else "path")]
        # y up is no horizontal axis
        changes = tuple(sorted((*turn, *reading), key=lambda one: one.mistake.code != "y_up"))
        if moved:
            changes += (_origin(reference, _with_changes(motion, changes), before.covered),)
        left = reference.difference(_with_changes(motion, changes)).path
        if left is not None and not left.differs and (explains(part, left) or not part.differs):
            # a constant offset fits three numbers, so it is tried after changes that fit none
            count = (frame not in (None, axes)) + len(reading) + 1.5 * moved
            passing.append((count, left.size, changes))
    return min(passing, key=lambda one: one[:2])[2] if passing else ()


def _of_path(reading: Change) -> Change:
    """Change of the path alone that corresponds to another reading of its columns."""
    mistake = replace(reading.mistake, concerns="path")

    def correct(motion: Motion) -> Motion:
        assert motion.path is not None
        columns = reading.values(dict(zip(POSITION, motion.path.T, strict=True)))
        noise = motion.path_noise / (mistake.value if mistake.code == "length_unit" else 1.0)
        return replace(motion, path=np.column_stack([columns[name] for name in POSITION]), path_noise=noise)

    return Change(mistake=mistake, motion=correct)


def _origin(reference: Reference, motion: Motion, end: float) -> Change:
    """Change that corrects another origin of the path."""
    wanted, own = on_samples_of(reference.motion, motion)
    assert wanted.path is not None
    assert own.path is not None
    origin = np.median((own.path - wanted.path)[wanted.time <= end + SAME_TIME], axis=0)

    def correct(given: Motion) -> Motion:
        assert given.path is not None
        return replace(given, path=given.path - origin)

    mistake = Mistake(code="origin", concerns="path", value=float(np.linalg.norm(origin)))
    return Change(mistake=mistake, motion=correct)


def _spin_explained(reference: Reference, motion: Motion) -> tuple[Change, ...]:
    """Steady spin about the axis that explains the remaining twist, if there is one."""
    before = reference.difference(motion)
    if before.twist is None or not before.twist.differs:
        return ()
    model, trial = on_samples_of(reference.motion, motion)
    assert model.twist is not None
    assert trial.twist is not None
    within = model.time <= before.covered + SAME_TIME
    time, apart = (model.time - model.time[0])[within], (trial.twist - model.twist)[within]
    rate = float(time @ apart / (time @ time))

    def correct(given: Motion) -> Motion:
        assert given.twist is not None
        return replace(given, twist=given.twist - rate * (given.time - given.time[0]))

    change = Change(mistake=Mistake(code="spin", concerns="twist", value=math.degrees(rate)), motion=correct)
    return (change,) if explains(before.twist, reference.difference(correct(motion)).twist) else ()
