"""Tables of a suite file, as pydantic models: their keys, and which of these exclude each other.

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

import difflib
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import fields
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import ErrorDetails

from ..bounds import Bounds
from ..case import WAYS_TO_A_STEP, TimeStep
from ..support import RECESS

# more than the size of any suite: a slip such as step = 1e-9 must not fill the memory
_MOST = 10_000
_RANGE = ("from", "to", "step", "count", "spacing")
# a step divides its range up to the rounding of decimal fractions
_ROUNDING = 1e-9
# messages of pydantic, reworded as ours
_TABLE = "must be a table of keys and values, got {given}"
_WORDS = {
    "missing": "must be given",
    "string_type": "must be text, got {given}",
    "bool_type": "must be true or false, got {given}",
    **dict.fromkeys(("list_type", "tuple_type"), "must be a list, got {given}"),
    **dict.fromkeys(("dict_type", "model_type"), _TABLE),
}


class KeyedError(ValueError):
    """Error at a key below the one being read.

    Parameters
    ----------
    key : str
        Relative to the table or value being read, such as "tilt" or "[2]".
    message : str
    """

    def __init__(self, key: str, message: str) -> None:
        super().__init__(message)
        self.key = key


@contextmanager
def path_prefix(path: str) -> Iterator[None]:
    """Context manager that puts the path of a key before the message of any ValueError."""
    try:
        yield
    except KeyedError as error:
        raise ValueError(f"{join(path, error.key)}: {error}") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def join(path: str, key: str) -> str:
    """Path of a key below another."""
    return f"{path}{'' if key.startswith('[') or not path else '.'}{key}"


def nearest(key: str, allowed: Iterable[str]) -> str:
    """Advice on a key that is not allowed: the nearest one, or all."""
    names = list(allowed)
    close = difflib.get_close_matches(key, names, n=1, cutoff=0.65)
    if key in ("slab_mass_ratio", "columns") and "cylinder" in names:
        return "is not known here, it belongs into cylinder = { ... }"
    hint = f"did you mean {close[0]}?" if close else f"allowed are {', '.join(names)}"
    return f"is not known here, {hint}"


#: Words of a condition on a number, and its test.
Allowed = tuple[str, Callable[[float], bool]]
ANY: Allowed = ("be a number", lambda _: True)
POSITIVE: Allowed = ("be positive", lambda value: value > 0.0)
NOT_NEGATIVE: Allowed = ("not be negative", lambda value: value >= 0.0)
WHOLE: Allowed = ("be a positive whole number", lambda value: value >= 1.0 and value == math.floor(value))


def values_of(given: object, allowed: Allowed) -> tuple[float, ...]:
    """Return the values of a number, a list or a range.

    Raises
    ------
    KeyedError, ValueError
        If it is none of them, a value is not allowed, or one stands there twice.
    """
    if isinstance(given, dict):
        return tuple(_number(value, allowed) for value in _range(given))
    if not isinstance(given, list):
        return (_number(given, allowed),)
    if not given:
        raise ValueError("must hold at least one value, got []")
    values: tuple[float, ...] = ()
    for index, item in enumerate(given):
        try:
            value = _number(item, allowed)
        except ValueError as error:
            raise KeyedError(f"[{index}]", str(error)) from None
        if value in values:
            raise KeyedError(f"[{index}]", f"must differ from the others, got {value:g} twice")
        values = (*values, value)
    return values


def _number(given: object, allowed: Allowed) -> float:
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
    words, holds = allowed
    if not holds(value):
        raise ValueError(f"must {words}, got {value:g}")
    return value


def _range(given: Mapping[str, object]) -> tuple[float, ...]:
    keys = set(given)
    if not {"from", "to"} <= keys <= set(_RANGE) or len(keys & {"step", "count"}) != 1:
        raise ValueError(
            f"a range must have from, to, either step or count, and maybe spacing, got {brief(given)}"
        )
    spacing = given.get("spacing", "linear")
    if spacing != "linear" and (spacing != "log" or "step" in given):
        raise ValueError(f"spacing of a range must be linear, or log with count, got {brief(given)}")
    low, high = (_number(given[key], POSITIVE if spacing == "log" else ANY) for key in ("from", "to"))
    if not low < high:
        raise ValueError(f"the end of a range must be above its begin, {low:g}, got {high:g}")
    if "step" in given:
        step = _number(given["step"], POSITIVE)
        intervals = (high - low) / step
        if intervals > _MOST or abs(intervals - round(intervals)) > _ROUNDING * intervals:
            raise ValueError(
                f"step must divide the range from {low:g} to {high:g}, in at most {_MOST}, got {step:g}"
            )
        count = round(intervals) + 1
    else:
        count = int(_number(given["count"], WHOLE))
        if not 2 <= count <= _MOST:
            raise ValueError(f"count must be from 2 to {_MOST}, got {count}")
    spaced = np.geomspace if spacing == "log" else np.linspace
    # 0.3 and not 0.30000000000000004
    return tuple(float(f"{value:.12g}") for value in spaced(low, high, count))


def _values(allowed: Allowed) -> BeforeValidator:
    return BeforeValidator(lambda given: values_of(given, allowed))


Numbers = Annotated[tuple[float, ...], _values(ANY)]
Positives = Annotated[tuple[float, ...], _values(POSITIVE)]
NotNegatives = Annotated[tuple[float, ...], _values(NOT_NEGATIVE)]
Wholes = Annotated[tuple[float, ...], _values(WHOLE)]


WAYS_OF_READING = (
    *("units", "record_columns", "record_step", "lengths", "remove_mean", "rotate", "resample"),
)
RECORDS = ("el_centro_1940", "p695")


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    def present(self, *names: str) -> list[str]:
        """Keys in the file."""
        return [name for name in names if getattr(self, name) is not None]

    def require_one_of(self, *names: str) -> str:
        """The one of these keys that is in the file; refused where there is none or another."""
        given = self.present(*names)
        if len(given) != 1:
            raise ValueError(
                f"must have exactly one of {', '.join(names)}, got {' and '.join(given) or 'none of them'}"
            )
        return given[0]

    def refuse(self, reason: str, *names: str) -> None:
        """Refuse keys without a meaning beside the others."""
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


class MotionTable(_Table):
    """The ground motion: a record that ships, files of a record, or a pulse."""

    record: str | None = None
    vertical: bool | None = None
    pair: Wholes | None = None
    x: str | None = None
    y: str | None = None
    z: str | None = None
    files: str | None = None
    units: str | None = None
    record_columns: str | None = None
    record_step: float | None = None
    lengths: str | None = None
    remove_mean: bool | None = None
    rotate: float | str | None = None
    resample: bool | None = None
    pulse: str | None = None
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
        self._refuse_others(kind)
        if self.record not in (None, *RECORDS):
            raise KeyedError("record", f"must be one of {', '.join(RECORDS)}, got {brief(self.record)}")
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

    def _refuse_others(self, kind: str) -> None:
        """Refuse the keys of the other kinds of motion."""
        p695, el_centro = self.record == "p695", self.record == "el_centro_1940"
        for belongs, reason, names in (
            (kind == "record", "belongs to a record that ships", ("record", "vertical", "pair")),
            (kind == "x", "belongs to files of a record, with x and y", ("x", "y", "z")),
            (kind in ("x", "files"), "belongs to files of a record", WAYS_OF_READING),
            (kind == "files", "holds all components of a record: without x and y", ("files",)),
            (kind == "pulse", "belongs to a pulse", ("pulse", "amplitude", "period", "azimuth_deg")),
            (kind != "pulse", "belongs to a record; a pulse has amplitude", ("scale", "rotation_deg")),
            (p695 or kind != "record", 'belongs to record = "p695"', ("pair",)),
            (el_centro or kind != "record", 'belongs to record = "el_centro_1940"', ("vertical",)),
        ):
            if not belongs:
                self.refuse(reason, *names)


class ReleaseTable(_Table):
    """The start: tilted, with rates where they are given."""

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
    """One problem, or one for each combination in its lists and ranges."""

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
    """Values of a time step; names of methods are checked by the engine."""
    if given in WAYS_TO_A_STEP:
        return (given,)
    return values_of(given, POSITIVE)


Texts = Annotated[list[str], BeforeValidator(_texts), Field(min_length=1)]


class RunTable(_Table):
    """One method, or one for each combination in its lists."""

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
    unknown = next((key for key in given if key not in names), None)
    if unknown is not None:
        raise KeyedError(unknown, nearest(unknown, names))
    return Bounds(**given)


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


def first_line(error: ValidationError) -> str:
    """First error in one line, and the number of others."""
    errors = error.errors(include_url=False)
    more = len(errors) - 1
    also = f" (and {more} more error{'s' if more > 1 else ''})" if more else ""
    return f"{_line(errors[0])}{also}"


def _line(error: ErrorDetails) -> str:
    place: Sequence[str | int] = error["loc"]
    path = ""
    for part in place:
        path = join(path, f"[{part}]" if isinstance(part, int) else part)
    if error["type"] == "extra_forbidden":
        table = next((part for part in reversed(place[:-1]) if isinstance(part, str)), "")
        return f"{path}: {nearest(str(place[-1]), TABLES[table].model_fields)}"
    cause = error.get("ctx", {}).get("error")
    if isinstance(cause, KeyedError):
        return f"{join(path, cause.key)}: {cause}"
    if isinstance(cause, ValueError):
        return f"{path}: {cause}"
    words = _WORDS.get(error["type"])
    return f"{path}: {words.format(given=brief(error['input'])) if words else error['msg']}"


def brief(value: object) -> str:
    """Return a value for a message, short."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
