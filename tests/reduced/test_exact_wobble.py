"""Steady wobble, and where it stops being stable."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from rockwobble.models import Cylinder, InitialState
from rockwobble.reduced.body import Body, body_of
from rockwobble.reduced.exact import (
    free_response,
    steady_wobble_rate,
    wobbling_period,
)

ROUNDING = 1e-14  # relative; some tens of operations in double precision
SLENDERNESS = [1e-3, 0.05, 0.2, 1.0, 5.0, 1e3]


def inertia(body: Body, tilt: float) -> float:
    """Return B [m^2], the inertia of the rolling angle."""
    t = math.tan(0.5 * tilt)
    return math.sin(tilt) ** 2 * (body.J + 2.0 * body.E * t + body.C * t * t)


@pytest.mark.parametrize("tan_alpha", SLENDERNESS)
def test_steady_wobble_is_where_the_turning_tilts_meet(tan_alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    tilt = 0.4 * cylinder.alpha
    rate = steady_wobble_rate(cylinder, tilt)
    steady = free_response(cylinder, InitialState(tilt=tilt, rolling_rate=rate))
    assert steady.minimum_tilt == pytest.approx(tilt, rel=ROUNDING)
    assert steady.maximum_tilt == pytest.approx(tilt, rel=ROUNDING)
    assert steady.angle_of_turn == pytest.approx(rate * steady.period, rel=ROUNDING)
    for change in (-1e-7, 1e-7):  # first order: period and turn go with the mean tilt
        near = free_response(cylinder, InitialState(tilt=tilt, rolling_rate=rate * (1.0 + change)))
        assert near.period == pytest.approx(steady.period, rel=1e-6)
        assert near.angle_of_turn == pytest.approx(steady.angle_of_turn, rel=1e-6)
        # more spin than steady wobble lifts the maximum, less lowers the minimum
        moved = near.maximum_tilt if change > 0.0 else near.minimum_tilt
        assert 0.1 * abs(change) < (moved / tilt - 1.0) / math.copysign(1.0, change) < 10.0 * abs(change)


def test_momentum_of_steady_wobble_has_one_maximum_between_upright_and_alpha() -> None:
    # the search for the overturning barrier rests on it
    random = np.random.default_rng(7)
    fractions = np.concatenate([np.geomspace(1e-6, 0.5, 300), 1.0 - np.geomspace(0.5, 1e-6, 300)[1:]])
    for _ in range(300):
        transverse = 10.0 ** random.uniform(-5.0, 1.0)
        axial = 2.0 * transverse * 10.0 ** random.uniform(-5.0, 0.0)
        cylinder = Cylinder(
            semidiagonal=1.0,
            tan_alpha=10.0 ** random.uniform(-3.0, 3.0),
            transverse_inertia=transverse,
            axial_inertia=axial,
        )
        body = body_of(cylinder, 9.81)
        tilt = fractions * body.alpha
        t = np.tan(0.5 * tilt)
        momentum = (
            np.sin(tilt) ** 2
            * (body.J + 2.0 * body.E * t + body.C * t * t)
            * steady_wobble_rate(cylinder, tilt)
        )
        rising = np.diff(momentum) > 0.0
        assert rising[0]
        assert not rising[-1]
        assert np.count_nonzero(np.diff(rising)) == 1


@pytest.mark.parametrize("tan_alpha", [0.05, 0.2, 1.0, 5.0])
def test_wobbling_period_is_equation_24_corrected(tan_alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    alpha = cylinder.alpha
    tilt = np.linspace(0.1, 0.95, 18) * alpha
    s, c, sa, ca = np.sin(tilt), np.cos(tilt), math.sin(alpha), math.cos(alpha)
    bracket = (
        (5 / 4 * sa**2 - 4 / 3 * ca**2) * c * s - 3 / 2 * sa**2 * s - sa * ca * (1 + c) + 2 * sa * ca * c**2
    )
    inertia = 5 / 4 + ca**2 / 12
    p = math.sqrt(9.81 / 6.0 / inertia)
    expected = 2.0 * math.pi / p * np.sqrt(-bracket / (np.sin(alpha - tilt) * inertia))
    # the bracket of the paper cancels to the order of the tilt
    np.testing.assert_allclose(wobbling_period(cylinder, tilt), expected, rtol=1e-12)


def test_steady_wobble_of_a_thin_disc() -> None:
    radius, flatness = 0.1, 1e-9  # the height of the mass centre enters to first order
    disc = Cylinder(
        semidiagonal=radius,
        tan_alpha=1.0 / flatness,
        transverse_inertia=radius**2 / 4,
        axial_inertia=radius**2 / 2,
    )
    for tilt in (1e-3, 0.3, 1.2):
        expected = math.sqrt(
            4.0 * 9.81 * math.cos(tilt) / (radius * math.sin(tilt) * (6.0 - 5.0 * math.cos(tilt)))
        )
        assert steady_wobble_rate(disc, tilt) == pytest.approx(expected, rel=20.0 * flatness)


@pytest.mark.parametrize("tan_alpha", SLENDERNESS)
def test_steady_wobble_is_held_up_to_the_largest_momentum(tan_alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    alpha, body = cylinder.alpha, body_of(cylinder, 9.81)
    crest = minimize_scalar(
        lambda fraction: -inertia(body, fraction * alpha) * steady_wobble_rate(cylinder, fraction * alpha),
        bounds=(0.3, 0.95),
        method="bounded",
        options={"xatol": 1e-9},  # a maximum is found to the square root of rounding
    ).x
    tilt = crest * (1.0 - 1e-4) * alpha
    wobble = free_response(
        cylinder, InitialState(tilt=tilt, rolling_rate=(1.0 + 1e-10) * steady_wobble_rate(cylinder, tilt))
    )
    assert wobble.maximum_tilt == pytest.approx(tilt, rel=1e-5)
    beyond = crest * (1.0 + 1e-4) * alpha
    with pytest.raises(ValueError, match="overturns"):
        free_response(
            cylinder,
            InitialState(tilt=beyond, rolling_rate=(1.0 + 1e-10) * steady_wobble_rate(cylinder, beyond)),
        )
