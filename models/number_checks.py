"""Checks of numbers: one clear line for bad input."""

from __future__ import annotations

import math
from typing import Any

from .shown import brief

_MOST = 70  # characters of a value that is quoted


def require_positive(name: str, value: float, unit: str = "") -> float:
    """Return `value` as a float, or raise ValueError unless it is positive and finite."""
    number = require_finite(name, value, unit)
    if number <= 0.0:
        raise ValueError(f"{name} must be positive{_in(unit)}, got {quoted(value)}")
    return number


def require_finite(name: str, value: float, unit: str) -> float:
    """Return `value` as a float, or raise ValueError unless it is a finite real number."""
    try:
        # text is refused even where it spells a number, because it would be kept as text
        number = math.nan if isinstance(value, str | bytes) else float(value)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be a finite number{_in(unit)}, got {quoted(value)}") from None
    if not math.isfinite(number):
        raise ValueError(f"{name} must be a finite number{_in(unit)}, got {quoted(value)}")
    return number


def quoted(value: Any) -> str:
    """Return a bad value as it is told: itself, or what it is where that would be longer than a line."""
    text = repr(value)
    return text if len(text) <= _MOST and "\n" not in text else brief(value)


def _in(unit: str) -> str:
    return f" [{unit}]" if unit else ""
