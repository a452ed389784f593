"""Uplift: its time within a sample and the regular solution after it, for any ground acceleration."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940
from rockwobble.reduced.body import body_of
from rockwobble.reduced.equations import recess_rhs
from rockwobble.reduced.integration import stepping, uplift
from rockwobble.reduced.integration.record import ground
from rockwobble.reduced.integration.resisted import RESISTED_RECESS

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
BODY = body_of(PIER, 9.81)
THRESHOLD = 9.81 * 0.2


def test_a_ramp_lifts_where_it_crosses_the_threshold():
    """Threshold g b/h of the mass centre, in the direction of the inertia force (26)."""
    ramp = np.linspace(0.0, 4.0, 41)
    decked = Cylinder.from_dimensions(base_radius=1.0, height=8.0, mass_centre_height=6.0)
    for cylinder, azimuth in ((PIER, 0.0), (PIER, 1.0), (decked, -2.5)):
        motion = GroundMotion(np.outer(ramp, [math.cos(azimuth), math.sin(azimuth)]), 0.1)
        response = reduced.simulate(Case(cylinder, motion))
        assert response.uplift_time == pytest.approx(9.81 * cylinder.tan_alpha, abs=1e-13)
        assert math.cos(response.uplift_direction - azimuth) == pytest.approx(-1.0, abs=1e-14)
    assert decked.tan_alpha == pytest.approx(1.0 / 6.0)


def test_the_vertical_component_decides_the_uplift():
    horizontal, vertical = np.full(201, 0.98 * THRESHOLD), np.linspace(0.0, -9.81 * 0.04, 201)
    up, level = (
        reduced.simulate(Case(PIER, GroundMotion(np.column_stack([horizontal, 0.0 * horizontal, z]), 0.01)))
        for z in (vertical, 0.0 * vertical)
    )
    # |a| = (g + az) tan(alpha) where az = -0.02 g, halfway
    assert up.uplift_time == pytest.approx(1.0, abs=1e-12)
    assert level.rests


def test_a_step_lifts_at_once_with_the_acceleration_of_a_jump():
    motion = GroundMotion(np.tile([3.0, 1.0], (101, 1)), 0.01)
    response = reduced.simulate(Case(PIER, motion), sample_step=0.001)
    assert response.uplift_time == 0.0
    size = math.hypot(3.0, 1.0)
    jump = BODY.p2 * (math.cos(PIER.alpha) * size / 9.81 - math.sin(PIER.alpha))
    # theta = K0 t^2/2 but for the softening, p^2 t^2/12 of it
    assert response.tilt[5] == pytest.approx(0.5 * jump * 0.005**2, rel=1e-5)


SERIES = [(0.0, 0.0), (-30.0, 0.0), (3000.0, 0.0), (3000.0, 1.0), (3.0, 1.0)]


@pytest.mark.parametrize(
    ("turning", "jump", "share"),
    [
        *(pytest.param(*each, 0.0, marks=pytest.mark.slow) for each in SERIES),
        (-30.0, 1.0, 0.02),
        (3.0, 1.0, 0.1),
    ],
)
def test_the_solution_is_independent_of_the_length_of_the_series(turning, jump, share):
    """Integration from a tenth of the length of the series to its end, which gives the state there.

    With rolling resistance, a share of b, it lifts against the couple.
    """
    from scipy.integrate import solve_ivp

    body = BODY._replace(delta=share * BODY.b)
    # contact next to azimuth zero: about pi its small lag would be lost in the rounding of the angle
    a, slope = (-THRESHOLD * (1.0 + share) - jump, 0.0, 0.0), (-20.0, turning, 1.0)
    end = uplift.start_length(body, 1e-9, a, slope, 0.0)
    begin = 0.1 * end
    theta, omega, phi, rate = uplift.start(body, 0.01, a, slope, 0.0, begin)

    def rates(t, y):
        if share:
            return RESISTED_RECESS.derivative(body, (*y, 0.0), ground(a, slope, t))[:4]
        return recess_rhs(body, *y, *ground(a, slope, t))

    # 1e-10 leaves less than 1e-12 of the tilt
    state = [theta, omega, phi, spin_momentum(theta, rate)]
    run = solve_ivp(rates, (begin, end), state, "DOP853", rtol=1e-10, atol=1e-40)
    theta, omega, phi, rate = uplift.start(body, 0.01, a, slope, 0.0, end)
    # The terms left out are at most x^3 of the others, x = 1e-3 of the shortest time scale at the end; each
    # power of t weighs by its exponent: the first term left out has twice that of the leading one. The couple
    # of so small a rate is less, by eps.
    limits = (1e-4, 1e-4) if share else (3e-9, 6e-9)
    assert run.y[0, -1] == pytest.approx(theta, rel=limits[0], abs=0.0)
    assert run.y[1, -1] == pytest.approx(omega, rel=limits[1], abs=0.0)
    # the lag is x^2 of the turn of the ground meanwhile, and its error a thousandth of it; after a jump it
    # grows with the turn, with an error of x = 1e-6 of that
    turned = abs(turning) * end / abs(a[0])
    assert run.y[2, -1] == pytest.approx(
        phi, rel=0.0, abs=(1e-6 if share else 3e-7 if jump else 2e-8) * turned
    )
    if share:
        assert run.y[3, -1] == pytest.approx(spin_momentum(theta, rate), rel=1e-6)


def spin_momentum(theta, rate):
    t = math.tan(0.5 * theta)
    return math.sin(theta) ** 2 * (BODY.J + 2.0 * BODY.E * t + BODY.C * t * t) * rate


def test_uplift_is_continuous_at_a_sample_time():
    for miss in (1e-15, 1e-12, 1e-9, 1e-7):
        crossing = np.array([0.0, THRESHOLD * (1.0 + miss), 3.0, 3.5])
        late = reduced.simulate(Case(PIER, GroundMotion(np.column_stack([crossing, 0.1 * crossing**2]), 0.2)))
        exact = np.array([0.0, THRESHOLD, 3.0, 3.5])
        at = reduced.simulate(Case(PIER, GroundMotion(np.column_stack([exact, 0.1 * exact**2]), 0.2)))
        assert late.peak_tilt == pytest.approx(at.peak_tilt, rel=1e-5)


def test_a_later_uplift_takes_the_branch_of_the_angle_nearest_to_the_last():
    motion = el_centro_1940().scaled(0.8)
    response = reduced.simulate(Case(PIER, motion), rest_tilt=0.01)
    moving = ~np.isnan(response.rolling_angle)
    lifts = np.flatnonzero(~moving[:-1] & moving[1:])
    stands = np.flatnonzero(moving[:-1] & ~moving[1:])
    assert len(lifts) > 1
    for stand, lift in zip(stands, lifts[1:], strict=False):
        change = response.rolling_angle[lift + 1] - response.rolling_angle[stand]
        # the contact may roll on by a little within the two samples
        assert abs(change) < math.pi + 0.5


def test_the_runge_kutta_pair_satisfies_its_order_conditions():
    rows = [(), stepping.A2, stepping.A3, stepping.A4, stepping.A5, stepping.A6, stepping.B5]
    A = np.array([row + (0.0,) * (7 - len(row)) for row in rows])
    c = np.array([0.0, stepping.C2, stepping.C3, stepping.C4, stepping.C5, 1.0, 1.0])
    b, low = A[6], A[6] - np.array(stepping.ERROR)
    assert A.sum(axis=1) == pytest.approx(c, abs=1e-14)
    trees = {  # elementary weights of all rooted trees to order 5
        1: [(np.ones(7), 1)],
        2: [(c, 2)],
        3: [(c**2, 3), (A @ c, 6)],
        4: [(c**3, 4), (c * (A @ c), 8), (A @ c**2, 12), (A @ A @ c, 24)],
        5: [
            (c**4, 5),
            (c**2 * (A @ c), 10),
            ((A @ c) ** 2, 20),
            (c * (A @ c**2), 15),
            (c * (A @ A @ c), 30),
            (A @ c**3, 20),
            (A @ (c * (A @ c)), 40),
            (A @ A @ c**2, 60),
            (A @ A @ A @ c, 120),
        ],
    }
    for order, weights in trees.items():
        for phi, gamma in weights:
            assert b @ phi == pytest.approx(1.0 / gamma, abs=1e-13)
            if order <= 4:
                assert low @ phi == pytest.approx(1.0 / gamma, abs=1e-13)


def test_sine_and_cosine_are_those_of_the_math_library():
    from rockwobble.reduced.trigonometry import sin_cos

    x = np.concatenate([np.linspace(-50.0, 50.0, 4001), 10.0 ** np.linspace(-300.0, 8.0, 2000)])
    pairs = np.array([sin_cos(value) for value in x])
    # one unit in the last place of the larger of the two
    assert np.abs(pairs[:, 0] - np.sin(x)).max() <= 2.3e-16
    assert np.abs(pairs[:, 1] - np.cos(x)).max() <= 2.3e-16
    small = x[np.abs(x) < 0.7]
    assert np.array([sin_cos(v)[0] for v in small]) == pytest.approx(np.sin(small), rel=4e-16)
