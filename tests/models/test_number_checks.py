"""Bounds of numbers: what is refused is what the message says, for any bounds and any number."""

from __future__ import annotations

import itertools
import math
from numbers import Integral

import numpy as np
import pytest

from rockwobble.models.number_checks import (
    require_finite,
    require_in_range,
    require_increasing,
    require_not_negative,
    require_positive,
    require_sample_step,
)

# options: words of the message, and whether a number is in the range
LOW = {
    "": ("", lambda value, end: True),
    "least": ("at least", lambda value, end: value >= end),
    "above": ("above", lambda value, end: value > end),
}
HIGH = {
    "": ("", lambda value, end: True),
    "most": ("at most", lambda value, end: value <= end),
    "below": ("below", lambda value, end: value < end),
}


def words(low: str, high: str, a: int, b: int, *, whole: bool) -> str:
    """Return what the message allows."""
    if (low, high) == ("least", "most"):
        return f"a whole number from {a} to {b}" if whole else f"from {a} to {b}"
    ends = [f"{side[0]} {end}" for side, end in ((LOW[low], a), (HIGH[high], b)) if side[0]]
    return ("a whole number, " if whole else "") + (" and ".join(ends) or "finite")


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize(("low", "high"), list(itertools.product(LOW, HIGH)))
def test_a_number_beyond_its_bounds_is_refused_with_the_bounds(low: str, high: str, whole: bool) -> None:
    chance = np.random.default_rng(1)
    for a, width in chance.integers([-9, 2], [9, 9], (20, 2)).tolist():
        b = a + width
        options = {name: end for name, end in ((low, a), (high, b)) if name}
        kind = (Integral,) if whole else ()
        for value in (a - 1, a, a + 1, b - 1, b, b + 1, *(() if whole else (a - 1e-9, b + 1e-9, a + 0.5))):
            if LOW[low][1](value, a) and HIGH[high][1](value, b):
                require_in_range("size", value, *kind, **options)
                continue
            with pytest.raises(ValueError, match=r"^size must be") as caught:
                require_in_range("size", value, *kind, **options)
            assert str(caught.value) == (f"size must be {words(low, high, a, b, whole=whole)}, got {value!r}")
        for bad in (math.nan, math.inf, -math.inf, True, "3", None, *((a + 0.5,) if whole else ())):
            with pytest.raises(
                ValueError, match=rf"^size must be {words(low, high, a, b, whole=whole)}, got"
            ):
                require_in_range("size", bad, *kind, **options)


@pytest.mark.parametrize("value", [-1e9, -1.0, -5e-324, 0.0, 5e-324, 1.0, 1e9])
def test_zero_parts_what_is_positive_from_what_is_negative(value: float) -> None:
    assert require_finite("size", value, "m") == value
    if value > 0.0:
        assert require_positive("size", value, "m") == value
    else:
        with pytest.raises(ValueError, match=rf"^size must be positive \[m\], got {value!r}$"):
            require_positive("size", value, "m")
    if value >= 0.0:
        assert require_not_negative("size", value, "m") == value
    else:
        with pytest.raises(ValueError, match=rf"^size must not be negative \[m\], got {value!r}$"):
            require_not_negative("size", value, "m")


@pytest.mark.parametrize("duration", [0.5, 8.0, 1e4])
def test_samples_of_a_trace_have_a_limit_that_is_stated(duration: float) -> None:
    """Ten million of them."""
    least = duration / 1e7
    assert require_sample_step(1.0001 * least, duration) == 1.0001 * least
    with pytest.raises(ValueError, match=rf"at least {least:.3g} s over {duration:g} s \(10,000,000 samples"):
        require_sample_step(0.9999 * least, duration)


@pytest.mark.parametrize("place", range(5))
def test_numbers_that_must_rise_are_refused_wherever_they_do_not(place: int) -> None:
    values = np.cumsum(np.random.default_rng(place).uniform(0.1, 1.0, 5))
    assert require_increasing("levels", values).tolist() == values.tolist()
    for wrong in (values[place - 1] if place else 0.0, -1.0, math.nan, math.inf):
        bad = values.copy()
        bad[place] = wrong
        with pytest.raises(ValueError, match="levels must be positive, finite and increasing"):
            require_increasing("levels", bad)


@pytest.mark.parametrize("length", [2, 30, 69, 70, 71, 300])
def test_a_bad_value_is_quoted_where_a_line_has_room_for_it(length: int) -> None:
    """Up to 70 characters; a longer text by its beginning, a list by its number of items."""
    for value, longer in (
        ("a" * (length - 2), repr("a" * 32 + "...")),
        (["a" * (length - 4)] if length > 4 else [], "1 item"),
    ):
        assert len(repr(value)) == length
        with pytest.raises(ValueError, match=r"^size must be a finite number, got") as caught:
            require_finite("size", value, "")
        got = repr(value) if length <= 70 else longer
        assert str(caught.value) == f"size must be a finite number, got {got}"
