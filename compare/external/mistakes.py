"""Mistakes in a trajectory, of units, order of columns, clock and axes, and what takes them back."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from .motion import Motion
from .table import POSITION, QUATERNION, Values

DEGREES = math.degrees(1.0)
CLOCK_FACTORS = tuple(factor**sign for factor in (2.0, 3.0, 4.0, 5.0, 8.0, 10.0) for sign in (1, -1))
LENGTH_FACTORS = (1e3, 1e2, 1e-2, 1e-3)
# order and signs in place of qw, qx, qy, qz; where z is reversed the axis of the body points down
QUATERNION_ORDERS = {
    "quaternion_scalar_last": ("qz", "qw", "qx", "qy"),
    "quaternion_inverse": ("qw", "-qx", "-qy", "-qz"),
    "z_reversed": ("-qx", "qw", "qz", "-qy"),
}

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
        this factor), "clock" (value: times are too large by this factor), "spin" (value: [deg/s]),
        "time_unit", "angle_unit", "length_unit" (value: too large by this factor), "turned"
        (by value [deg], counter-clockwise), "turned_back" (by half a turn), "x_reversed", "y_reversed",
        "axes_exchanged", "axes_exchanged_reversed", "mirrored" (value: azimuth of the line [deg]),
        "z_reversed", "y_up", "quaternion_scalar_last", "quaternion_inverse", "origin" (value: its distance
        from the right one [m]).
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
        its = f"its {concerns} {'are' if ' and ' in concerns or concerns == 'axes' else 'is'}"
        match self.code:
            case "time_offset":
                late = "late" if value < 0.0 else "early"
                return f"its clock is {abs(value):.3f} s {late}: an offset of {value:.3f} s takes that back"
            case "time_scale":
                size, weight = 100.0 * (value**2 - 1.0), 100.0 * (value**-2 - 1.0)
                rate = f"{100.0 * abs(value - 1.0):.2f} % {'slower' if value > 1.0 else 'faster'}"
                return f"it moves {rate}, as with R {size:+.2f} %, g {weight:+.2f} % or another slenderness"
            case "clock":
                factor, way = max(value, 1.0 / value), "long" if value > 1.0 else "short"
                motion = "slow" if value > 1.0 else "fast"
                return f"it runs in {motion} motion: times are {factor:g} times too {way}"
            case "spin":
                return f"it spins about its axis by {value:.3g} deg/s, so that its base must slip"
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
    """Correction of a mistake: of the columns, or of the motion that they tell."""

    mistake: Mistake
    values: Callable[[Values], Values] = field(default=lambda values: values)
    motion: Callable[[Motion], Motion] = field(default=lambda motion: motion)
    frame: Frame | None = None  # axes that lean and path have in common


Read = Callable[[Values], Motion | None]  # the motion that columns tell; None where they tell none


def correct(values: Values, read: Read, changes: Sequence[Change]) -> Motion | None:
    """Return the motion of columns after some changes."""
    for change in changes:
        values = change.values(values)
    motion = read(values)
    return None if motion is None else with_changes(motion, changes)


def with_changes(motion: Motion, changes: Sequence[Change]) -> Motion:
    """Return a motion after those of some changes that concern the motion."""
    for change in changes:
        motion = change.motion(motion)
    return motion


def readings(values: Values) -> Iterator[Change]:
    """Yield the mistakes in units, order and vertical axis of columns that change the pose."""

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
    for factor in CLOCK_FACTORS:
        yield in_unit("clock", "time", ("time",), factor)


def spinning(rate: float) -> Change:
    """Correction of a steady spin about the axis [rad/s]."""

    def correct(motion: Motion) -> Motion:
        assert motion.twist is not None
        return replace(motion, twist=motion.twist - rate * (motion.time - motion.time[0]))

    return Change(mistake=Mistake(code="spin", concerns="twist", value=math.degrees(rate)), motion=correct)


def of_path(reading: Change) -> Change:
    """Return the change of the path alone that corresponds to another reading of its columns."""
    mistake = replace(reading.mistake, concerns="path")

    def correct(motion: Motion) -> Motion:
        assert motion.path is not None
        columns = reading.values(dict(zip(POSITION, motion.path.T, strict=True)))
        noise = motion.path_noise / (mistake.value if mistake.code == "length_unit" else 1.0)
        return replace(motion, path=np.column_stack([columns[name] for name in POSITION]), path_noise=noise)

    return Change(mistake=mistake, motion=correct)


def in_time_scale(rate: float) -> Change:
    """Correction of a motion that is slower by a factor."""
    mistake = Mistake(code="time_scale", concerns="time", value=rate)
    return Change(mistake=mistake, motion=partial(Motion.with_clock, rate=1.0 / rate))


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
        return motion.rotated(self.angle, mirrored=self.mirrored)

    def change(self, concerns: str) -> Change:
        """Correction of the mistake in "azimuth", "path", or both ("axes")."""
        named = MIRRORS if self.mirrored else TURNS
        code = named.get(self.angle, "mirrored" if self.mirrored else "turned")
        value = {"turned": -math.degrees(self.angle), "mirrored": 0.5 * math.degrees(self.angle)}.get(
            code, math.nan
        )

        def correct(motion: Motion) -> Motion:
            other = self.apply(motion)
            if concerns == "azimuth":
                return replace(motion, lean=other.lean, twist=other.twist)
            return replace(motion, path=other.path) if concerns == "path" else other

        mistake = Mistake(code=code, concerns=concerns, value=value)
        return Change(mistake=mistake, motion=correct, frame=self if concerns == "axes" else None)
