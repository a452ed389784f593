"""Checks of numbers and words: one clear line for bad input."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from numbers import Integral, Real
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .shown import brief

MOST_SAMPLES = 10_000_000  # limit for one trace: some gigabytes
_MOST = 70  # characters of a quoted value


def require_positive(name: str, value: object, unit: str = "") -> float:
    """Return `value` as a float, or raise ValueError unless it is positive and finite."""
    number = require_finite(name, value, unit)
    if number <= 0.0:
        raise ValueError(f"{name} must be positive{_in(unit)}, got {quoted(value)}")
    return number


def require_not_negative(name: str, value: object, unit: str = "") -> float:
    """Return `value` as a float, or raise ValueError unless it is finite and 0 or more."""
    number = require_finite(name, value, unit)
    if number < 0.0:
        raise ValueError(f"{name} must not be negative{_in(unit)}, got {quoted(value)}")
    return number


def require_finite(name: str, value: object, unit: str) -> float:
    """Return `value` as a float, or raise ValueError unless it is a finite real number."""
    try:
        # text is refused even where it spells a number, as it would be stored as text; a bool is no size
        number = math.nan if isinstance(value, str | bytes | bool | np.bool_) else float(cast("float", value))
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} must be a finite number{_in(unit)}, got {quoted(value)}") from None
    if not math.isfinite(number):
        raise ValueError(f"{name} must be a finite number{_in(unit)}, got {quoted(value)}")
    return number


def require_in_range(
    name: str,
    value: object,
    kind: type | tuple[type, ...] = Real,
    *,
    least: float = -math.inf,
    most: float = math.inf,
    above: float = -math.inf,
    below: float = math.inf,
) -> None:
    """Raise ValueError unless `value` is a finite number of a kind and in its range.

    Parameters
    ----------
    name : str
    value : object
    kind : type or tuple of type
        int or `numbers.Integral` for a whole number. A truth value is none.
    least, most : float
        Ends of the range that belong to it.
    above, below : float
        Ends that do not.
    """
    number = isinstance(value, kind) and not isinstance(value, bool)
    if number and least <= (given := cast("float", value)) <= most and above < given < below:
        return
    whole = kind in (int, Integral)
    if -math.inf < least and most < math.inf:
        allowed = f"{'a whole number ' if whole else ''}from {least:g} to {most:g}"
    else:
        low = f"at least {least:g}" if least > -math.inf else f"above {above:g}" if above > -math.inf else ""
        high = f"at most {most:g}" if most < math.inf else f"below {below:g}" if below < math.inf else ""
        ends = " and ".join(part for part in (low, high) if part) or "finite"
        allowed = f"{'a whole number, ' if whole else ''}{ends}"
    raise ValueError(f"{name} must be {allowed}, got {quoted(value)}")


def require_sample_step(sample_step: float, duration: float) -> float:
    """Return the spacing of samples [s], or raise ValueError unless `MOST_SAMPLES` cover the duration.

    Parameters
    ----------
    sample_step, duration : float
        [s]
    """
    step = require_positive("sample_step", sample_step, "s")
    if not duration <= MOST_SAMPLES * step:
        raise ValueError(
            f"sample_step must be at least {duration / MOST_SAMPLES:.3g} s over {duration:g} s "
            f"({MOST_SAMPLES:,} samples at most), got {quoted(sample_step)}"
        )
    return step


def require_numbers(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Array of real numbers in its shape; ValueError unless all are real."""
    try:
        # numpy would drop an imaginary part
        array = None if np.iscomplexobj(values) else np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        array = None
    if array is None:
        raise ValueError(f"{name} must be numbers, got {quoted(values)}")
    return array


def require_increasing(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Read-only array (n,); ValueError unless it is positive, finite and increasing."""
    array = require_numbers(name, values)
    good = array.ndim == 1 and array.size and array[0] > 0.0 and (np.diff(array) > 0.0).all()
    if not (good and np.isfinite(array).all()):
        raise ValueError(f"{name} must be positive, finite and increasing, got {quoted(values)}")
    array.flags.writeable = False
    return array


def require_one_of(name: str, value: object, allowed: Iterable[str]) -> None:
    """Raise ValueError unless `value` is one of the words that are allowed."""
    words = tuple(allowed)
    if not isinstance(value, str) or value not in words:
        raise ValueError(f"{name} must be one of {', '.join(words)}, got {quoted(value)}")


def require_each(name: str, values: object, kind: type) -> None:
    """Raise ValueError unless a value is a sequence whose members are all of a kind."""
    if isinstance(values, str | bytes) or not isinstance(values, Sequence):
        raise ValueError(f"{name} must be a sequence of {kind.__name__}, got {quoted(values)}")  # noqa: TRY004
    for value in values:
        if not isinstance(value, kind):
            raise ValueError(f"{name} must be a sequence of {kind.__name__}, got {quoted(value)} in it")  # noqa: TRY004


def quoted(value: object) -> str:
    """A bad value for a message: itself, or its kind where that would be longer than a line."""
    text = repr(value.tolist() if isinstance(value, np.ndarray) else value)
    return text if len(text) <= _MOST and "\n" not in text else brief(value)


def _in(unit: str) -> str:
    return f" [{unit}]" if unit else ""


def require_axis(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Array of one dimension of finite numbers that are not negative."""
    wanted = f"{name} must be a sequence of finite numbers, none negative, got"
    try:
        axis = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        axis = np.array(math.nan)
    if axis.ndim != 1:
        raise ValueError(f"{wanted} {quoted(values)}")
    wrong = np.flatnonzero(~(np.isfinite(axis) & (axis >= 0.0)))
    if wrong.size:
        raise ValueError(f"{wanted} {axis[wrong[0]]:g} at index {wrong[0]}")
    return axis
