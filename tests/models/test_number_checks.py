"""Bounds of numbers: refusals and their messages, for any bounds and any number."""

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

# end of a range: words of the message, and the test of a number
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


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize(("low", "high"), list(itertools.product(LOW, HIGH)))
def test_a_number_beyond_its_bounds_is_refused_with_the_bounds(low: str, high: str, whole: bool) -> None:
    kind = (Integral,) if whole else ()
    for a, b in ((-7, -5), (0, 3)):
        options = {name: end for name, end in ((low, a), (high, b)) if name}
        ends = [f"{side[0]} {end}" for side, end in ((LOW[low], a), (HIGH[high], b)) if side[0]]
        allowed = ("a whole number, " if whole else "") + (" and ".join(ends) or "finite")
        if (low, high) == ("least", "most"):
            allowed = f"{'a whole number ' if whole else ''}from {a} to {b}"
        bad = [math.nan, math.inf, -math.inf, True, "3", None, *((a + 0.5,) if whole else ())]
        for value in (a - 1, a, a + 1, b, b + 1, *(() if whole else (a - 1e-9, b + 1e-9))):
            if LOW[low][1](value, a) and HIGH[high][1](value, b):
                require_in_range("size", value, *kind, **options)
            else:
                bad.append(value)
        for value in bad:
            with pytest.raises(ValueError, match=rf"^size must be {allowed}, got"):
                require_in_range("size", value, *kind, **options)


@pytest.mark.parametrize("value", [-1.0, -5e-324, 0.0, 5e-324, 1e9])
def test_a_positive_number_excludes_zero_and_a_nonnegative_one_includes_it(value: float) -> None:
    assert require_finite("size", value, "m") == value
    for require, holds in ((require_positive, value > 0.0), (require_not_negative, value >= 0.0)):
        if holds:
            assert require("size", value, "m") == value
        else:
            with pytest.raises(ValueError, match=rf"^size must .* \[m\], got {value!r}$"):
                require("size", value, "m")


def test_the_number_of_samples_of_a_trace_is_limited() -> None:
    """Limit: ten million samples."""
    assert require_sample_step(1.0001e-7, 1.0) == 1.0001e-7
    with pytest.raises(ValueError, match=r"at least 1e-07 s over 1 s \(10,000,000 samples"):
        require_sample_step(0.9999e-7, 1.0)


@pytest.mark.parametrize("place", range(3))
def test_numbers_that_do_not_increase_are_refused(place: int) -> None:
    values = np.cumsum(np.random.default_rng(place).uniform(0.1, 1.0, 3))
    assert require_increasing("levels", values).tolist() == values.tolist()
    for wrong in (values[place - 1] if place else 0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="levels must be positive, finite and increasing"):
            require_increasing("levels", np.where(np.arange(3) == place, wrong, values))


@pytest.mark.parametrize("length", [2, 70, 71])
def test_a_bad_value_is_quoted_up_to_a_line(length: int) -> None:
    """Quote of up to 70 characters; a longer text by its beginning, a list by its number of items."""
    for value, longer in (
        ("a" * (length - 2), repr("a" * 32 + "...")),
        (["a" * (length - 4)] if length > 4 else [], "1 item"),
    ):
        with pytest.raises(ValueError, match=r"^size must be a finite number, got") as caught:
            require_finite("size", value, "")
        assert str(caught.value).endswith(f", got {repr(value) if length <= 70 else longer}")
