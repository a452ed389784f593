"""Numbers of a suite file: one, a list, or a range; each becomes the tuple of its values.

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
from collections.abc import Callable
from typing import Annotated, Any

from pydantic import BeforeValidator

from .errors import KeyedError, nearest, shown

# more than a suite will ever hold: a slip such as step = 1e-9 must not fill the memory
_MOST = 10_000
_RANGE = ("from", "to", "step", "count", "spacing")
# a step divides its range up to the rounding of decimal fractions
_ROUNDING = 1e-9

Check = Callable[[float], str]


def any_number(_: float) -> str:
    """Refuse nothing."""
    return ""


def positive(value: float) -> str:
    """Refuse zero and below."""
    return "" if value > 0.0 else f"must be positive, got {value:g}"


def not_negative(value: float) -> str:
    """Refuse what is below zero."""
    return "" if value >= 0.0 else f"must not be negative, got {value:g}"


def whole(value: float) -> str:
    """Refuse fractions and what is below one."""
    fine = value >= 1.0 and value == math.floor(value)
    return "" if fine else f"must be a positive whole number, got {value:g}"


def expanded(given: Any, check: Check = any_number) -> tuple[float, ...]:
    """Return the values of a number, a list or a range.

    Raises
    ------
    KeyedError, ValueError
        If it is none of them, a value is refused by `check`, or one stands there twice.
    """
    if isinstance(given, dict):
        values = _range(given)
        for value in values:
            _require(check(value))
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


def _number(given: Any, check: Check) -> float:
    if isinstance(given, bool) or not isinstance(given, int | float):
        raise ValueError(  # noqa: TRY004 - a wrong type in a file is bad input like any other
            "must be a number, a list, or a range such as { from = 1, to = 3, step = 0.5 }, "
            f"got {shown(given)}"
        )
    try:
        value = float(given)
    except OverflowError:  # a whole number of hundreds of digits
        value = math.inf
    if not math.isfinite(value):
        raise ValueError(f"must be a finite number, got {shown(given)}")
    _require(check(value))
    return value


def _require(complaint: str) -> None:
    if complaint:
        raise ValueError(complaint)


def _range(given: dict[str, Any]) -> tuple[float, ...]:
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
        raise ValueError(f"a range must have either step or count, got {shown(given)}")
    spacing = given.get("spacing", "linear")
    if spacing not in ("linear", "log"):
        raise KeyedError("spacing", f"must be linear or log, got {shown(spacing)}")
    if "step" in given:
        return _stepped(low, high, numbers["step"], spacing)
    return _counted(low, high, int(numbers["count"]), spacing)


def _stepped(low: float, high: float, step: float, spacing: str) -> tuple[float, ...]:
    if spacing == "log":
        raise KeyedError("spacing", "log must go with count, got step")
    if step <= 0.0:
        raise KeyedError("step", f"must be positive, got {step:g}")
    intervals = (high - low) / step
    if intervals > _MOST:
        raise KeyedError("step", f"must give at most {_MOST} values, got {intervals:.3g}")
    if abs(intervals - round(intervals)) > _ROUNDING * intervals:
        raise KeyedError("step", f"must divide the range from {low:g} to {high:g}, got {step:g}")
    return _tidy(low + step * index for index in range(round(intervals) + 1))


def _counted(low: float, high: float, count: int, spacing: str) -> tuple[float, ...]:
    if not 2 <= count <= _MOST:
        raise KeyedError("count", f"must be from 2 to {_MOST}, got {count}")
    if spacing == "linear":
        return _tidy(low + (high - low) * index / (count - 1) for index in range(count))
    if low <= 0.0:
        raise KeyedError("from", f"must be positive where spacing is log, got {low:g}")
    return _tidy(low * (high / low) ** (index / (count - 1)) for index in range(count))


def _tidy(values: Any) -> tuple[float, ...]:
    # 0.3 and not 0.30000000000000004
    return tuple(float(f"{value:.12g}") for value in values)


def _values(check: Check) -> Any:
    return BeforeValidator(lambda given: expanded(given, check))


Numbers = Annotated[tuple[float, ...], _values(any_number)]
Positives = Annotated[tuple[float, ...], _values(positive)]
NotNegatives = Annotated[tuple[float, ...], _values(not_negative)]
Wholes = Annotated[tuple[float, ...], _values(whole)]
