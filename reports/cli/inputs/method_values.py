"""Values of the options that state a method: from text to numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import typer

if TYPE_CHECKING:
    from rockwobble.models.case import TimeStep

_MOST_VALUES = 100_000


def time_step(text: str) -> TimeStep:
    """Return a time step [s], "auto" or "extrapolated"; whether an engine can use the number is said later.

    Raises
    ------
    BadParameter
        If the text is neither.
    """
    from rockwobble.models.case import WAYS_TO_A_STEP

    for way in WAYS_TO_A_STEP:
        if text == way:
            return way
    return _number(text, 'a number [s], "auto" or "extrapolated"')


def restitution(text: str) -> float | Literal["momentum"]:
    """Return a coefficient of restitution, or "momentum".

    Raises
    ------
    BadParameter
        If the text is neither.
    """
    return "momentum" if text == "momentum" else _number(text, 'a number or "momentum"')


def numbers(text: str) -> list[float]:
    """Return the numbers of "6", "1,2,6" or "0.5:30:100", a range with both ends.

    Raises
    ------
    BadParameter
        If the text is none of these.
    """
    try:
        if ":" not in text:
            return [float(part) for part in text.split(",")]
        first, last, count = text.split(":")
        low, high, number = float(first), float(last), int(count)
    except ValueError:
        low = high = number = 0
    if not (2 <= number <= _MOST_VALUES and math.isfinite(low - high)):
        allowed = "a number, a list such as 1,2,6 or a range FROM:TO:COUNT"
        raise typer.BadParameter(f"must be {allowed}, got {text!r}")
    import numpy as np

    return [float(value) for value in np.linspace(low, high, number)]


def levels(text: str) -> list[float]:
    """Return the numbers of a list, or of a range, which is even in the logarithm."""
    found = numbers(text)
    if ":" not in text or not 0.0 < found[0] < found[-1]:
        return found
    ratio, last = math.log(found[-1] / found[0]), len(found) - 1
    return [found[0] * math.exp(ratio * place / last) for place in range(len(found))]


def _number(text: str, allowed: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise typer.BadParameter(f"must be {allowed}, got {text!r}") from None


def settings(given: Sequence[str] | None) -> dict[str, Any]:
    """Return settings from texts of the form name=value: a whole number, a number, or the text itself.

    Raises
    ------
    ValueError
        If a text has another form, or a name comes twice.

    Examples
    --------
    >>> settings(["ring_facets=64", "ring_clearance=1e-2", "cone=pyramidal"])
    {'ring_facets': 64, 'ring_clearance': 0.01, 'cone': 'pyramidal'}
    """
    found: dict[str, Any] = {}
    for text in given or ():
        name, sign, value = (part.strip() for part in text.partition("="))
        if not (name and sign and value):
            raise ValueError(f"--set must be NAME=VALUE, got {text!r}")
        if name in found:
            raise ValueError(f"--set {name} is given twice")
        found[name] = _value(value)
    return found


def _value(text: str) -> int | float | str:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
