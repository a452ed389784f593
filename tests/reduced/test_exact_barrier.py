"""Where the exact solutions end: overturning, standing, and bad input."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from rockwobble.models import Cylinder, InitialState
from rockwobble.reduced.body import Body, body_of
from rockwobble.reduced.exact import (
    angle_of_turn,
    free_response,
    planar_quarter_period,
    rocking_period,
    steady_wobble_rate,
    wobbling_period,
)

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SLENDERNESS = [1e-3, 0.05, 0.2, 1.0, 5.0, 1e3]


def inertia(body: Body, tilt: float) -> float:
    """Return B [m^2], the inertia of the rolling angle."""
    t = math.tan(0.5 * tilt)
    return math.sin(tilt) ** 2 * (body.J + 2.0 * body.E * t + body.C * t * t)


def release(cylinder: Cylinder, fraction: float, spin: float, tilt_rate: float = 0.0) -> InitialState:
    return InitialState(tilt=fraction * cylinder.alpha, tilt_rate=tilt_rate, rolling_rate=spin)


@pytest.mark.parametrize(
    ("fraction", "tilt_rate", "spin"),
    [
        (1.0, 0.0, 0.0),
        (1.0, 0.0, 1e-15),
        (1.2, -0.1, 0.1),
        (0.5, 0.5, 0.0),
        (0.5, 0.5, 0.1),
        (0.5, -0.5, 0.1),
        (0.5, 0.0, 2.0),
        (0.99, 0.0, 1.0),
        (0.99, 1e-3, 0.3),
        (1e-9, 1.0, 0.0),
        (1e-9, 1.0, 1.0),
    ],
)
def test_a_release_that_overturns_has_no_next_maximum(fraction: float, tilt_rate: float, spin: float) -> None:
    for solution in (free_response, angle_of_turn):
        with pytest.raises(ValueError, match=r"tilt=.* overturns .* it has no tilt maximum"):
            solution(PIER, release(PIER, fraction, spin, tilt_rate))


@pytest.mark.parametrize("tan_alpha", SLENDERNESS)
@pytest.mark.parametrize("spin", [1e-9, 0.1, 0.5])
@pytest.mark.parametrize("sense", [-1.0, 1.0])
def test_overturning_begins_where_the_energy_passes_the_barrier(
    tan_alpha: float, spin: float, sense: float
) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    tilt = 0.4 * cylinder.alpha
    rate = spin * steady_wobble_rate(cylinder, tilt)
    at_rest = free_response(cylinder, InitialState(tilt=tilt, rolling_rate=rate))
    body = body_of(cylinder, 9.81)

    def height(gap: float) -> float:  # V + L^2/(2 B)
        theta = cylinder.alpha - gap
        return at_rest.angular_momentum**2 / (2.0 * inertia(body, theta)) - 9.81 * 6.0 * (
            math.cos(cylinder.alpha) - math.cos(gap)
        )

    top = -minimize_scalar(
        lambda gap: -height(gap),
        bounds=(0.0, 0.5 * cylinder.alpha),
        method="bounded",
        options={"xatol": 1e-10},
    ).fun
    # cos(gap) is rounded to 1e-16 where the whole barrier is alpha^2/2
    margin = 1e-9 + 1e-15 / cylinder.alpha**2
    reach = math.sqrt(2.0 * (top - at_rest.energy) / body.A)
    slow, fast = (
        InitialState(tilt=tilt, tilt_rate=sense * reach * (1.0 + change), rolling_rate=rate)
        for change in (-margin, margin)
    )
    assert free_response(cylinder, slow).maximum_tilt < cylinder.alpha
    with pytest.raises(ValueError, match="overturns"):
        free_response(cylinder, fast)


def test_the_barrier_is_where_the_period_grows_without_bound() -> None:
    tilt = 0.95 * PIER.alpha  # steady wobble is unstable here
    rate = steady_wobble_rate(PIER, tilt)
    periods = [
        free_response(PIER, InitialState(tilt=tilt, rolling_rate=rate * (1 - d))).period
        for d in (1e-4, 1e-6, 1e-8)
    ]
    steps = np.diff(periods)
    assert steps[1] == pytest.approx(steps[0], rel=0.02)  # logarithmic
    with pytest.raises(ValueError, match="overturn"):
        free_response(PIER, InitialState(tilt=tilt, rolling_rate=rate * (1 + 1e-8)))
    with pytest.raises(ValueError, match="overturn"):
        free_response(PIER, InitialState(tilt=tilt, rolling_rate=rate))


@pytest.mark.parametrize(
    "function", [planar_quarter_period, rocking_period, steady_wobble_rate, wobbling_period]
)
def test_over_an_array_of_tilts(function) -> None:  # type: ignore[no-untyped-def]
    tilts = np.array([[0.1, 0.5], [0.9, 1.0 - 1e-9]]) * PIER.alpha
    values = function(PIER, tilts)
    assert values.shape == (2, 2)
    for value, tilt in zip(values.ravel(), tilts.ravel(), strict=True):
        single = function(PIER, float(tilt))
        assert type(single) is float
        assert single == value
    np.testing.assert_array_equal(function(PIER, list(tilts[0])), values[0])
    np.testing.assert_allclose(
        function(PIER, tilts, gravity=4 * 9.81) / values, 2.0 if function is steady_wobble_rate else 0.5
    )


def test_standing_has_no_free_response() -> None:
    with pytest.raises(ValueError, match="tilt above 0"):
        free_response(PIER, InitialState(tilt=0.0))


@pytest.mark.parametrize(
    "function", [planar_quarter_period, rocking_period, steady_wobble_rate, wobbling_period]
)
@pytest.mark.parametrize("tilt", [0.0, -0.1, 0.2, math.nan, [0.1, 0.3]])
def test_tilt_is_checked(function, tilt) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(ValueError, match="tilt must be above 0 and below alpha"):
        function(PIER, tilt)
