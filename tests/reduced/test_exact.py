"""The exact solutions: limits, invariances, where they end, steady wobble, tables made without this code."""

import math
from dataclasses import fields

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from stating import table

from rockwobble.models import Cylinder, InitialState
from rockwobble.reduced.body import Body, body_of
from rockwobble.reduced.exact import (
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
FOUR_DECIMALS = 0.5e-4 + 1e-9  # half a digit of a table of 4 decimals
TABLE_ROUNDING = 1e-13  # of a quarter period, next to half a unit in the last printed digit
FLATTEST = 1e-9  # height over radius standing for the table's disc of no height: changes the turn by 1e-16


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
    # the correction is proportional to the minimum tilt over the maximum, 1e-18
    assert vanishing.angle_of_turn == pytest.approx(limiting_angle_of_turn(cylinder), rel=ROUNDING)
    assert vanishing.period == pytest.approx(planar.period, rel=ROUNDING)
    # the centrifugal energy L^2/(2 J theta^2) equals all of it
    inertia = body_of(cylinder, 9.81).J
    expected = vanishing.angular_momentum / math.sqrt(2.0 * inertia * vanishing.energy)
    assert vanishing.minimum_tilt == pytest.approx(expected, rel=ROUNDING)


@pytest.mark.parametrize("spin", [1e-300, 1e-160, 1e-20, 1e-15])
def test_any_small_spin_turns_by_the_limiting_angle(spin: float) -> None:
    response = free_response(PIER, release(PIER, 0.5, spin))
    assert response.angle_of_turn == pytest.approx(limiting_angle_of_turn(PIER), rel=ROUNDING)
    # the turning tilt is proportional to the spin down to the smallest double
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
    factors = {"half_period": 2.0, "period": 2.0, "energy": 4.0, "angular_momentum": 8.0}
    for field in fields(one):
        assert getattr(four, field.name) == factors.get(field.name, 1.0) * getattr(one, field.name)
    for period in (rocking_period, wobbling_period):
        assert period(large, 0.4 * large.alpha) == 2.0 * period(small, 0.4 * small.alpha)


def test_a_mirrored_release_turns_the_other_way() -> None:
    left, right = (free_response(PIER, release(PIER, 0.5, spin)) for spin in (-0.3, 0.3))
    assert left.angle_of_turn == -right.angle_of_turn
    assert left.angular_momentum == -right.angular_momentum
    assert left.period == right.period
    assert left.minimum_tilt == right.minimum_tilt
    assert angle_of_turn(PIER, release(PIER, 0.5, -0.3)) == left.angle_of_turn


def test_a_planar_release_in_motion_rises_to_the_tilt_of_its_energy() -> None:
    for tilt_rate in (-0.05, 0.05):
        response = free_response(PIER, release(PIER, 0.3, 0.0, tilt_rate))
        back = free_response(PIER, InitialState(tilt=response.maximum_tilt))
        assert back.energy == pytest.approx(response.energy, rel=ROUNDING)
        assert back.period == pytest.approx(response.period, rel=ROUNDING)
        assert response.maximum_tilt > 0.3 * PIER.alpha
    tilt, tilt_rate = 1e-13, 1e-13
    p2 = body_of(PIER, 9.81).p2
    expected = tilt + tilt_rate**2 / (2.0 * p2 * math.sin(PIER.alpha))
    response = free_response(PIER, InitialState(tilt=tilt, tilt_rate=tilt_rate))
    assert response.maximum_tilt == pytest.approx(expected, rel=1e-12)  # next order: the tilt itself


@pytest.mark.parametrize(
    ("fraction", "tilt_rate", "spin"),
    [
        (1.0, 0.0, 0.0),
        (1.0, 0.0, 1e-15),
        (1.2, -0.1, 0.1),
        (0.5, -0.5, 0.1),
        (0.5, 0.0, 2.0),
        (1e-9, 1.0, 0.0),
    ],
)
def test_a_release_that_overturns_has_no_next_maximum(fraction: float, tilt_rate: float, spin: float) -> None:
    for solution in (free_response, angle_of_turn):
        with pytest.raises(ValueError, match=r"tilt=.* overturns .* it has no tilt maximum"):
            solution(PIER, release(PIER, fraction, spin, tilt_rate))


@pytest.mark.parametrize("tan_alpha", SLENDERNESS)
@pytest.mark.parametrize("spin", [1e-9, 0.1, 0.5])
@pytest.mark.parametrize("sense", [-1.0, 1.0])
def test_overturning_begins_where_the_energy_exceeds_the_barrier(
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


@pytest.mark.parametrize(
    "function", [planar_quarter_period, rocking_period, steady_wobble_rate, wobbling_period]
)
def test_periods_of_an_array_are_those_of_its_tilts(function) -> None:  # type: ignore[no-untyped-def]
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


@pytest.mark.parametrize(
    "function", [planar_quarter_period, rocking_period, steady_wobble_rate, wobbling_period]
)
@pytest.mark.parametrize("tilt", [0.0, -0.1, 0.2, math.nan, [0.1, 0.3]])
def test_a_tilt_outside_its_range_is_refused(function, tilt) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(ValueError, match="tilt must be above 0 and below alpha"):
        function(PIER, tilt)
    with pytest.raises(ValueError, match="tilt above 0"):
        free_response(PIER, InitialState(tilt=0.0))


@pytest.mark.parametrize("tan_alpha", SLENDERNESS)
def test_steady_wobble_is_where_the_turning_tilts_meet(tan_alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    tilt = 0.4 * cylinder.alpha
    rate = steady_wobble_rate(cylinder, tilt)
    steady = free_response(cylinder, InitialState(tilt=tilt, rolling_rate=rate))
    assert steady.minimum_tilt == pytest.approx(tilt, rel=ROUNDING)
    assert steady.maximum_tilt == pytest.approx(tilt, rel=ROUNDING)
    assert steady.angle_of_turn == pytest.approx(rate * steady.period, rel=ROUNDING)
    for change in (-1e-7, 1e-7):  # first order: period and turn change with the mean tilt
        near = free_response(cylinder, InitialState(tilt=tilt, rolling_rate=rate * (1.0 + change)))
        assert near.period == pytest.approx(steady.period, rel=1e-6)
        assert near.angle_of_turn == pytest.approx(steady.angle_of_turn, rel=1e-6)
        # more spin than steady wobble lifts the maximum, less lowers the minimum
        moved = near.maximum_tilt if change > 0.0 else near.minimum_tilt
        assert 0.1 * abs(change) < (moved / tilt - 1.0) / math.copysign(1.0, change) < 10.0 * abs(change)


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


def half_unit(printed: str) -> float:
    return 0.5 * 10.0 ** -len(printed.partition(".")[2])


@pytest.mark.parametrize("row", table("angle_of_turn_limit.csv"), ids=lambda row: row["h_over_b"])
def test_angle_of_turn_of_vanishing_spin_is_its_closed_form(row: dict[str, str]) -> None:
    cylinder = Cylinder.from_dimensions(base_radius=1.0, height=2.0 * max(float(row["h_over_b"]), FLATTEST))
    expected = pytest.approx(float(row["turn_deg"]), rel=0, abs=FOUR_DECIMALS)
    assert math.degrees(cylinder.alpha) == pytest.approx(float(row["alpha_deg"]), rel=0, abs=1e-3)
    assert math.degrees(limiting_angle_of_turn(cylinder)) == expected
    initial = InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=1e-15)
    assert math.degrees(angle_of_turn(cylinder, initial)) == expected


@pytest.mark.parametrize("alpha", [0.1, 0.2, 0.3])
def test_planar_quarter_period_is_the_quadrature(alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=math.tan(alpha))
    p = math.sqrt(body_of(cylinder, 9.81).p2)
    rows = table("planar_quarter_period.csv")
    tilts = np.array([float(row["theta0_over_alpha"]) for row in rows]) * cylinder.alpha
    quarters, cycles = planar_quarter_period(cylinder, tilts), rocking_period(cylinder, tilts)
    for row, quarter, cycle in zip(rows, quarters, cycles, strict=True):
        printed = row[f"alpha_{alpha}"]
        assert p * quarter == pytest.approx(float(printed), rel=0, abs=half_unit(printed) + TABLE_ROUNDING)
        assert cycle == 4.0 * quarter


def test_planar_quarter_period_of_a_slender_block_is_housners() -> None:
    slenderness = 1e-5
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=slenderness)
    p = math.sqrt(body_of(cylinder, 9.81).p2)
    for row in table("planar_quarter_period.csv"):
        quarter = p * planar_quarter_period(cylinder, float(row["theta0_over_alpha"]) * cylinder.alpha)
        # the correction goes with alpha^2, by 0.05 at most in the columns of the table
        budget = half_unit(row["linear"]) + 0.1 * slenderness**2
        assert quarter == pytest.approx(float(row["linear"]), rel=0, abs=budget)
