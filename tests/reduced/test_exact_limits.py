"""Limits and invariances of free response."""

import math

import pytest

from rockwobble.models import Cylinder, InitialState
from rockwobble.reduced.body import Body, body_of
from rockwobble.reduced.exact import (
    FreeResponse,
    angle_of_turn,
    free_response,
    limiting_angle_of_turn,
    planar_quarter_period,
    rocking_period,
    steady_wobble_rate,
    wobbling_period,
)

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
ROUNDING = 1e-14  # relative; some tens of operations in double precision
SLENDERNESS = [1e-3, 0.05, 0.2, 1.0, 5.0, 1e3]


def inertia(body: Body, tilt: float) -> float:
    """Return B [m^2], the inertia of the rolling angle."""
    t = math.tan(0.5 * tilt)
    return math.sin(tilt) ** 2 * (body.J + 2.0 * body.E * t + body.C * t * t)


def release(cylinder: Cylinder, fraction: float, spin: float, tilt_rate: float = 0.0) -> InitialState:
    return InitialState(tilt=fraction * cylinder.alpha, tilt_rate=tilt_rate, rolling_rate=spin)


@pytest.mark.parametrize("tan_alpha", SLENDERNESS)
@pytest.mark.parametrize("fraction", [1e-12, 0.01, 0.5, 0.99, 1.0 - 1e-9])
def test_vanishing_spin_has_its_own_angle_of_turn_and_the_planar_times(
    tan_alpha: float, fraction: float
) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    planar = free_response(cylinder, release(cylinder, fraction, 0.0))
    assert planar.angle_of_turn == math.pi
    assert planar.minimum_tilt == 0.0
    slow = 1e-18 * steady_wobble_rate(cylinder, fraction * cylinder.alpha)
    vanishing = free_response(cylinder, release(cylinder, fraction, slow))
    # the correction goes with the minimum tilt over the maximum, 1e-18
    assert vanishing.angle_of_turn == pytest.approx(limiting_angle_of_turn(cylinder), rel=ROUNDING)
    assert vanishing.period == pytest.approx(planar.period, rel=ROUNDING)
    # centrifugal energy L^2/(2 J theta^2) takes up all of it
    inertia = body_of(cylinder, 9.81).J
    expected = vanishing.angular_momentum / math.sqrt(2.0 * inertia * vanishing.energy)
    assert vanishing.minimum_tilt == pytest.approx(expected, rel=ROUNDING)


@pytest.mark.parametrize("spin", [1e-300, 1e-160, 1e-20, 1e-15])
def test_any_small_spin_is_the_limit(spin: float) -> None:
    response = free_response(PIER, release(PIER, 0.5, spin))
    assert response.angle_of_turn == pytest.approx(limiting_angle_of_turn(PIER), rel=ROUNDING)
    # the turning tilt goes with the spin down to the smallest of numbers
    at_one = free_response(PIER, release(PIER, 0.5, 1e-12)).minimum_tilt / 1e-12
    assert response.minimum_tilt == pytest.approx(
        at_one * spin, rel=1e-12, abs=0.0
    )  # next order: spin squared


@pytest.mark.parametrize("tan_alpha", SLENDERNESS)
@pytest.mark.parametrize("spin", [0.0, 1e-15, 1e-3, 0.5, 0.9])
def test_four_times_the_size_takes_twice_the_time_to_the_last_bit(tan_alpha: float, spin: float) -> None:
    small, large = (Cylinder(semidiagonal=size, tan_alpha=tan_alpha) for size in (1.7, 6.8))
    rate = spin * steady_wobble_rate(small, 0.4 * small.alpha)
    slow = 1e-3 * rate  # tilt rate
    one = free_response(small, release(small, 0.4, rate, slow * small.alpha))
    four = free_response(large, release(large, 0.4, 0.5 * rate, 0.5 * slow * small.alpha))
    assert four == FreeResponse(
        minimum_tilt=one.minimum_tilt,
        maximum_tilt=one.maximum_tilt,
        half_period=2.0 * one.half_period,
        period=2.0 * one.period,
        angle_of_turn=one.angle_of_turn,
        energy=4.0 * one.energy,
        angular_momentum=8.0 * one.angular_momentum,
    )
    for period in (rocking_period, wobbling_period):
        assert period(large, 0.4 * large.alpha) == 2.0 * period(small, 0.4 * small.alpha)


@pytest.mark.parametrize(("size", "gravity"), [(1e-3, 9.81), (1e3, 9.81), (6.0, 0.1), (6.0, 30.0)])
def test_any_size_and_gravity(size: float, gravity: float) -> None:
    cylinder = Cylinder(semidiagonal=size, tan_alpha=0.2)
    time = math.sqrt(size / 6.0 * 9.81 / gravity)  # Froude
    expected = free_response(PIER, release(PIER, 0.5, 0.3))
    found = free_response(cylinder, release(cylinder, 0.5, 0.3 / time), gravity=gravity)
    assert found.angle_of_turn == pytest.approx(expected.angle_of_turn, rel=ROUNDING)
    assert found.period == pytest.approx(expected.period * time, rel=ROUNDING)


def test_mirror_image() -> None:
    left, right = (free_response(PIER, release(PIER, 0.5, spin)) for spin in (-0.3, 0.3))
    assert left.angle_of_turn == -right.angle_of_turn
    assert left.angular_momentum == -right.angular_momentum
    assert left.period == right.period
    assert left.minimum_tilt == right.minimum_tilt
    assert angle_of_turn(PIER, release(PIER, 0.5, -0.3)) == left.angle_of_turn


@pytest.mark.parametrize("tan_alpha", [1e-3, 0.2, 1e3])
@pytest.mark.parametrize("spin", [1e-12, 1e-2, 0.99, -0.5])
@pytest.mark.parametrize("way", [0.0, 1e-6, 1.0 - 1e-6])
@pytest.mark.parametrize("sense", [-1.0, 1.0])
def test_every_point_of_the_cycle_has_the_same_response(
    tan_alpha: float, spin: float, way: float, sense: float
) -> None:
    cylinder = Cylinder(semidiagonal=3.0, tan_alpha=tan_alpha)
    body = body_of(cylinder, 9.81)
    start = 0.6 * cylinder.alpha
    expected = free_response(
        cylinder, InitialState(tilt=start, rolling_rate=spin * steady_wobble_rate(cylinder, start))
    )

    low, high, L = expected.minimum_tilt, expected.maximum_tilt, expected.angular_momentum
    tilt = low + way * (high - low)
    # energy below the maximum, in differences
    fall = 2.0 * 9.81 * 3.0 * math.sin(body.alpha - 0.5 * (high + tilt)) * math.sin(0.5 * (high - tilt))
    climb = 0.5 * L**2 * (1.0 / inertia(body, tilt) - 1.0 / inertia(body, high))
    tilt_rate = sense * math.sqrt(2.0 * (fall - climb) / body.A) if way else 0.0
    found = free_response(
        cylinder,
        InitialState(tilt=tilt, tilt_rate=tilt_rate, rolling_rate=L / inertia(body, tilt)),
        gravity=9.81,
    )
    # the intermediate state is rounded; steady wobble at 0.6 alpha magnifies that by 1e2 at most
    budget = 1e-12
    for name in ("minimum_tilt", "maximum_tilt", "period", "angle_of_turn", "energy", "angular_momentum"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=budget), name


def test_small_rocking() -> None:
    # constant restoring moment: theta = tilt - (p^2 sin alpha) t^2/2
    p2 = body_of(PIER, 9.81).p2
    tilt = 1e-12 * PIER.alpha
    expected = math.sqrt(2.0 * tilt / (p2 * math.sin(PIER.alpha)))
    assert planar_quarter_period(PIER, tilt) == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize("tilt_rate", [-0.05, 0.05])
def test_planar_release_in_motion(tilt_rate: float) -> None:
    response = free_response(PIER, release(PIER, 0.3, 0.0, tilt_rate))
    back = free_response(PIER, InitialState(tilt=response.maximum_tilt))
    assert back.energy == pytest.approx(response.energy, rel=ROUNDING)
    assert back.period == pytest.approx(response.period, rel=ROUNDING)
    assert response.maximum_tilt > 0.3 * PIER.alpha


def test_planar_release_in_motion_keeps_small_tilts() -> None:
    tilt, tilt_rate = 1e-13, 1e-13
    p2 = body_of(PIER, 9.81).p2
    expected = tilt + tilt_rate**2 / (2.0 * p2 * math.sin(PIER.alpha))
    response = free_response(PIER, InitialState(tilt=tilt, tilt_rate=tilt_rate))
    assert response.maximum_tilt == pytest.approx(expected, rel=1e-12)  # next order: the tilt itself
