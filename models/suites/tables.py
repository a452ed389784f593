"""Tables of a suite file, as pydantic models: which keys there are, and which go together.

A number is one, a list, or a range; each becomes the tuple of its values.

===================================================  ====================
0.2                                                  one value
[0.1, 0.2, 0.5]                                      a list
{ from = 1, to = 3, step = 0.5 }                     1, 1.5, 2, 2.5, 3
{ from = 1, to = 3, count = 5 }                      the same
{ from = 1, to = 100, count = 3, spacing = "log" }   1, 10, 100
===================================================  ====================
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import fields
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    model_validator,
)

from ..bounds import Bounds
from ..case import WAYS_TO_A_STEP, TimeStep
from ..records.component import UNITS
from ..records.reading import LENGTHS
from ..support import RECESS
from ..synthetic import PULSES
from .errors import KeyedError, brief, nearest

# more than a suite will ever hold: a slip such as step = 1e-9 must not fill the memory
_MOST = 10_000
_RANGE = ("from", "to", "step", "count", "spacing")
# a step divides its range up to the rounding of decimal fractions
_ROUNDING = 1e-9

#: Refuses a value out of range.
Check = Callable[[float], None]


def any_number(_: float) -> None:
    """Refuse nothing."""


def positive(value: float) -> None:
    """Refuse zero and below."""
    if not value > 0.0:
        raise ValueError(f"must be positive, got {value:g}")


def not_negative(value: float) -> None:
    """Refuse what is below zero."""
    if not value >= 0.0:
        raise ValueError(f"must not be negative, got {value:g}")


def whole(value: float) -> None:
    """Refuse fractions and what is below one."""
    if not (value >= 1.0 and value == math.floor(value)):
        raise ValueError(f"must be a positive whole number, got {value:g}")


def values_of(given: object, check: Check = any_number) -> tuple[float, ...]:
    """Return the values of a number, a list or a range.

    Raises
    ------
    KeyedError, ValueError
        If it is none of them, a value is refused by `check`, or one stands there twice.
    """
    if isinstance(given, dict):
        values = _range(given)
        for value in values:
            check(value)
        return values
    if not isinstance(given, list):
        return (_number(given, check),)
    if not given:
        raise ValueError("must hold at least one value, got []")
    values = ()
    for index, item in enumerate(given):
        try:
            value = _number(item, check)
        except ValueError as error:
            raise KeyedError(f"[{index}]", str(error)) from None
        if value in values:
            raise KeyedError(f"[{index}]", f"must differ from the others, got {value:g} twice")
        values = (*values, value)
    return values


def _number(given: object, check: Check) -> float:
    if isinstance(given, bool) or not isinstance(given, int | float):
        raise ValueError(  # noqa: TRY004 - a wrong type in a file is bad input like any other
            "must be a number, a list, or a range such as { from = 1, to = 3, step = 0.5 }, "
            f"got {brief(given)}"
        )
    try:
        value = float(given)
    except OverflowError:  # a whole number of hundreds of digits
        value = math.inf
    if not math.isfinite(value):
        raise ValueError(f"must be a finite number, got {brief(given)}")
    check(value)
    return value


def _range(given: Mapping[str, object]) -> tuple[float, ...]:
    for key in given:
        if key not in _RANGE:
            raise KeyedError(key, nearest(key, _RANGE))
    for key in ("from", "to"):
        if key not in given:
            raise KeyedError(key, "must be given in a range")
    numbers = {}
    for key in ("from", "to", "step", "count"):
        if key in given:
            try:
                numbers[key] = _number(given[key], whole if key == "count" else any_number)
            except ValueError as error:
                raise KeyedError(key, str(error)) from None
    low, high = numbers["from"], numbers["to"]
    if not low < high:
        raise KeyedError("to", f"must be above from = {low:g}, got {high:g}")
    if ("step" in given) == ("count" in given):
        raise ValueError(f"a range must have either step or count, got {brief(given)}")
    spacing = given.get("spacing", "linear")
    if spacing not in ("linear", "log"):
        raise KeyedError("spacing", f"must be linear or log, got {brief(spacing)}")
    if "step" in given:
        if spacing == "log":
            raise KeyedError("spacing", "log needs count, not step")
        count = _steps_in(low, high, numbers["step"]) + 1
    else:
        count = int(numbers["count"])
        if not 2 <= count <= _MOST:
            raise KeyedError("count", f"must be from 2 to {_MOST}, got {count}")
    if spacing == "log" and low <= 0.0:
        raise KeyedError("from", f"must be positive where spacing is log, got {low:g}")
    spaced = np.geomspace if spacing == "log" else np.linspace
    # 0.3 and not 0.30000000000000004
    return tuple(float(f"{value:.12g}") for value in spaced(low, high, count))


def _steps_in(low: float, high: float, step: float) -> int:
    if step <= 0.0:
        raise KeyedError("step", f"must be positive, got {step:g}")
    intervals = (high - low) / step
    if intervals > _MOST:
        raise KeyedError("step", f"must give at most {_MOST} values, got {intervals:.3g}")
    if abs(intervals - round(intervals)) > _ROUNDING * intervals:
        raise KeyedError("step", f"must divide the range from {low:g} to {high:g}, got {step:g}")
    return round(intervals)


def _values(check: Check) -> BeforeValidator:
    return BeforeValidator(lambda given: values_of(given, check))


Numbers = Annotated[tuple[float, ...], _values(any_number)]
Positives = Annotated[tuple[float, ...], _values(positive)]
NotNegatives = Annotated[tuple[float, ...], _values(not_negative)]
Wholes = Annotated[tuple[float, ...], _values(whole)]


WAYS_OF_READING = (
    *("units", "record_columns", "record_step", "lengths", "remove_mean", "rotate", "resample"),
)
RECORDS = ("el_centro_1940", "p695")


def _one_of(*allowed: str) -> AfterValidator:
    def check(value: str) -> str:
        if value not in allowed:
            raise ValueError(f"must be one of {', '.join(allowed)}, got {brief(value)}")
        return value

    return AfterValidator(check)


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    def present(self, *names: str) -> list[str]:
        """Keys that the file gives."""
        return [name for name in names if getattr(self, name) is not None]

    def require_one_of(self, *names: str) -> str:
        """Return the one key of these that is given."""
        given = self.present(*names)
        if len(given) != 1:
            raise ValueError(
                f"must have exactly one of {', '.join(names)}, got {' and '.join(given) or 'none of them'}"
            )
        return given[0]

    def refuse(self, reason: str, *names: str) -> None:
        """Refuse keys that mean nothing here."""
        for name in self.present(*names):
            raise KeyedError(name, f"must be left out: it {reason}")


class CylinderTable(_Table):
    """The body: semidiagonal and tan_alpha, or outline; with a slab, one of its columns."""

    semidiagonal: Positives | None = None
    tan_alpha: Positives | None = None
    base_radius: Positives | None = None
    diameter: Positives | None = None
    height: Positives | None = None
    mass_centre_height: Positives | None = None
    transverse_inertia: Positives | None = None
    axial_inertia: Positives | None = None
    slab_mass_ratio: NotNegatives | None = None
    columns: Wholes | None = None

    @model_validator(mode="after")
    def _one_way_to_say_it(self) -> CylinderTable:
        outline = "base_radius or diameter, and height"
        if self.present("base_radius", "diameter"):
            self.refuse(f"does not go with {outline}", "semidiagonal", "tan_alpha")
            needed = (self.require_one_of("base_radius", "diameter"), "height")
        else:
            needed = ("semidiagonal", "tan_alpha")
            self.refuse(f"belongs to {outline}", "mass_centre_height")
        for name in needed:
            if not self.present(name):
                raise KeyedError(
                    name,
                    f"must be given: either semidiagonal and tan_alpha, or {outline}",
                )
        return self


def _one_positive(given: object) -> float:
    if isinstance(given, list | dict):
        raise ValueError(f"must be one number, got {brief(given)}")  # noqa: TRY004 (bad input)
    return values_of(given, positive)[0]


class MotionTable(_Table):
    """The ground motion: a record that ships, files of a record, or a pulse."""

    record: Annotated[str, _one_of(*RECORDS)] | None = None
    vertical: bool | None = None
    pair: Wholes | None = None
    x: str | None = None
    y: str | None = None
    z: str | None = None
    files: str | None = None
    units: Annotated[str, _one_of(*UNITS)] | None = None
    record_columns: str | None = None
    record_step: Annotated[float, BeforeValidator(_one_positive)] | None = None
    lengths: Annotated[str, _one_of(*LENGTHS)] | None = None
    remove_mean: bool | None = None
    rotate: float | str | None = None
    resample: bool | None = None
    pulse: Annotated[str, _one_of(*PULSES)] | None = None
    amplitude: Positives | None = None
    period: Positives | None = None
    azimuth_deg: Numbers | None = None
    scale: Positives | None = None
    times_uplift: Positives | None = None
    rotation_deg: Numbers | None = None
    time_shift: Numbers | None = None

    @model_validator(mode="after")
    def _keys_go_together(self) -> MotionTable:
        kind = "x" if self.present("x", "y") else self.require_one_of("record", "x", "files", "pulse")
        self.refuse_others(kind)
        if self.record == "p695" and not self.present("pair"):
            raise KeyedError("pair", "must be given: 1 to 22")
        if kind == "x":
            for name in ("x", "y"):
                if not self.present(name):
                    raise KeyedError(name, "must be given: a record has two horizontal components")
        if kind == "pulse":
            if not self.present("period"):
                raise KeyedError("period", "must be given with a pulse [s]")
            self.require_one_of("amplitude", "times_uplift")
        if len(self.present("scale", "times_uplift")) > 1:
            raise KeyedError("times_uplift", "must be left out: it replaces scale")
        return self

    def refuse_others(self, kind: str) -> None:
        """Refuse the keys of the other kinds of motion."""
        pulse = ("pulse", "amplitude", "period", "azimuth_deg")
        if kind != "record":
            self.refuse("belongs to a record that ships", "record", "vertical", "pair")
        if kind != "x":
            self.refuse("belongs to files of a record, with x and y", "x", "y", "z")
        if kind not in ("x", "files"):
            self.refuse("belongs to files of a record", *WAYS_OF_READING)
        if kind != "files":
            self.refuse("holds all components of a record: without x and y", "files")
        if kind != "pulse":
            self.refuse("belongs to a pulse", *pulse)
        else:
            self.refuse("belongs to a record; a pulse has amplitude and azimuth_deg", "scale", "rotation_deg")
        if self.record != "p695":
            self.refuse('belongs to record = "p695"', "pair")
        if self.record != "el_centro_1940":
            self.refuse('belongs to record = "el_centro_1940"', "vertical")


class ReleaseTable(_Table):
    """The start: tilted, and with rates where they are given."""

    tilt: Positives | None = None
    tilt_deg: Positives | None = None
    tilt_over_alpha: Positives | None = None
    tilt_rate: Numbers | None = None
    rolling_angle_deg: Numbers | None = None
    rolling_rate: Numbers | None = None

    @model_validator(mode="after")
    def _one_tilt(self) -> ReleaseTable:
        self.require_one_of("tilt", "tilt_deg", "tilt_over_alpha")
        return self


class TendonTable(_Table):
    """The restraint: an unbonded tendon along the axis."""

    prestress: NotNegatives | None = None
    stiffness: NotNegatives | None = None
    yield_force: Positives | None = None


class CaseTable(_Table):
    """One problem, or as many as its lists and ranges make."""

    name: str = Field(min_length=1)
    cylinder: CylinderTable
    motion: MotionTable | None = None
    release: ReleaseTable | None = None
    tendon: TendonTable | None = None
    duration: Positives | None = None
    gravity: Positives | None = None
    friction: NotNegatives | None = None
    rolling_resistance: NotNegatives | None = None

    @model_validator(mode="after")
    def _something_moves_for_some_time(self) -> CaseTable:
        if ":" in self.name:
            raise KeyedError("name", f"must not hold a colon, values follow one, got {self.name!r}")
        if self.motion is None and self.release is None:
            raise ValueError("must have a motion or a release, got neither: nothing would move")
        if self.duration is None and (self.motion is None or self.motion.pulse is not None):
            raise KeyedError("duration", "must be given [s]: only a record has a length of its own")
        return self


def _texts(given: object) -> object:
    return given if isinstance(given, list) else [given]


def _steps(given: object) -> tuple[object, ...]:
    """Values of a time step; the ways to one are left to the engine."""
    if given in WAYS_TO_A_STEP:
        return (given,)
    return values_of(given, positive)


Texts = Annotated[list[str], BeforeValidator(_texts), Field(min_length=1)]


class RunTable(_Table):
    """One method, or as many as its lists make."""

    engine: Texts
    support: Texts = [RECESS]
    time_step: Annotated[tuple[TimeStep, ...] | None, BeforeValidator(_steps)] = None
    settings: dict[str, Any] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _settings_of_the_method(self) -> RunTable:
        for name in self.settings:
            if name in type(self).model_fields:
                raise KeyedError(f"settings.{name}", "must be left out: it is a key of the run")
        return self


def _bounds(given: object) -> object:
    """Bounds on columns of the summary, which tests ask of every run."""
    if not isinstance(given, dict):
        return given
    names = [field.name for field in fields(Bounds)]
    values: dict[str, Any] = {}
    for key, value in given.items():
        if key not in names:
            raise KeyedError(key, nearest(key, names))
        try:
            values[key] = value if key == "reference" else _one_positive(value)
        except ValueError as error:
            raise KeyedError(key, str(error)) from None
    return Bounds(**values)


class SuiteTable(_Table):
    """The whole file."""

    cases: list[CaseTable] = Field(min_length=1)
    runs: list[RunTable] = Field(default_factory=list)
    bounds: Annotated[Bounds | None, BeforeValidator(_bounds)] = None


# tables by their keys, "" for the whole file
TABLES: Mapping[str, type[BaseModel]] = MappingProxyType(
    {
        "": SuiteTable,
        "cases": CaseTable,
        "cylinder": CylinderTable,
        "motion": MotionTable,
        "release": ReleaseTable,
        "tendon": TendonTable,
        "runs": RunTable,
    }
)
