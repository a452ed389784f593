from __future__ import annotations

import math

import pytest

from rockwobble.models import InitialState


def test_only_the_tilt_is_needed() -> None:
    state = InitialState(tilt=0.1)
    assert (state.tilt, state.tilt_rate, state.rolling_angle, state.rolling_rate) == (0.1, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("tilt", [0.0, 1e-300, 1.5707])
def test_takes_any_tilt_from_standing_to_just_before_lying(tilt: float) -> None:
    assert InitialState(tilt=tilt, rolling_angle=-20.0).tilt == tilt


@pytest.mark.parametrize("tilt", [-1e-9, 0.5 * math.pi, 3.0])
def test_refuses_a_tilt_below_standing_or_at_lying(tilt: float) -> None:
    with pytest.raises(ValueError, match=r"^tilt must be at least 0 and below pi/2 \[rad\], got "):
        InitialState(tilt=tilt)


@pytest.mark.parametrize("rate", ["tilt_rate", "rolling_rate"])
def test_refuses_a_rate_without_a_tilt(rate: str) -> None:
    with pytest.raises(ValueError, match=r"^tilt must be above 0 where tilt_rate or rolling_rate is given"):
        InitialState(tilt=0.0, **{rate: 1e-3})
    InitialState(tilt=1e-12, **{rate: 1e-3})
