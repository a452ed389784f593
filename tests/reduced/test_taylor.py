"""The series of the recess model solve the equations that sympy proves (`test_symbolic.py`)."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble.models import Cylinder
from rockwobble.reduced._compile import jit
from rockwobble.reduced.body import body_of
from rockwobble.reduced.integration import taylor
from rockwobble.reduced.integration.record import ground
from rockwobble.reduced.integration.systems import RECESS

RTOL = 1e-12
# remainder of a step, over the largest term of each rate: the tolerance times the order, the factor of a
# derivative on the last terms, and ten for the length of the step in units of the time scale of the state
LEFT_OUT = 10.0 * 16.0 * RTOL

derivative = RECESS.derivative


@jit
def first_step(body, y, h, a, slope):
    """One step from `y`, with states and derivatives at its start, within and at its end."""
    work = taylor.workspace(y)
    y = taylor.restart(body, y, a, work)
    taken, _, _, _, _, path = taylor.advance(body, RTOL, y, y, work, h, h, a, slope)
    return taken, [taylor.partial(body, work, path, share * taken) for share in (0.0, 0.4, 1.0)]


def cases():
    random = np.random.default_rng(20261121)
    for number in range(60):
        tan_alpha = float(10.0 ** random.uniform(-1.3, 0.7))
        cylinder = Cylinder(semidiagonal=float(random.uniform(0.5, 20.0)), tan_alpha=tan_alpha)
        body = body_of(cylinder, 9.81)
        theta = body.alpha * float(10.0 ** random.uniform(-4.0, 0.0))
        speed = body.p * body.alpha * float(random.uniform(-1.0, 1.0))
        momentum = body.J * theta * body.p * body.alpha * float(random.uniform(-1.0, 1.0))
        y = (theta, speed, float(random.uniform(-9.0, 9.0)), momentum)
        a, slope = random.uniform(-4.0, 4.0, 3), random.uniform(-400.0, 400.0, 3)
        yield pytest.param(body, y, tuple(a), tuple(slope), id=str(number))


@pytest.mark.slow
@pytest.mark.parametrize(("body", "y", "a", "slope"), list(cases()))
def test_the_series_solve_the_equations(body, y, a, slope):
    h = 0.01
    taken, points = first_step(body, y, h, a, slope)
    assert 0.0 < taken <= h
    start = derivative(body, y, a)
    for share, (state, rates) in zip((0.0, 0.4, 1.0), points, strict=True):
        exact = derivative(body, state, ground(a, slope, share * taken))
        # tilt, tilt rate, rolling angle, momentum: each relative to its value at the start or here
        for rate, expected, first in zip(rates, exact, start, strict=True):
            assert rate == pytest.approx(expected, rel=LEFT_OUT, abs=LEFT_OUT * abs(first))


def test_a_smaller_tolerance_or_tilt_takes_a_higher_order():
    body = body_of(Cylinder(semidiagonal=6.0, tan_alpha=0.2), 9.81)
    a, slope = (1.0, -0.5, 0.0), (30.0, 10.0, 0.0)

    @jit
    def order_of(theta, rtol):
        y = (theta, 0.1, 0.3, 1e-3)
        work = taylor.workspace(y)
        _, _, _, _, _, path = taylor.advance(body, rtol, y, y, work, 0.01, 0.01, a, slope)
        return path[1]

    far = [order_of(0.1, 10.0**-k) for k in range(5, 13)]
    assert far == sorted(far)
    assert far[0] == 4
    assert far[3] < order_of(0.005, 1e-8)
    assert math.isfinite(far[-1])
