"""Free response against a quadrature in high precision, from the paper's equations as printed.

Nothing is shared with the code under test: energies (17) and the coefficient of phi'' in (19) stand
here as in the paper, and the digits that they lose are supplied by the arithmetic.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import pytest

from rockwobble.models import Cylinder, InitialState
from rockwobble.reduced.exact import free_response, steady_wobble_rate

WORKING_DIGITS = 100  # of the integrand: (19) cancels to theta^2 at tilts of 1e-16, the radicand once more
QUADRATURE_DIGITS = 20  # of nodes, weights and sum: eight more than are compared
AGREEMENT = 1e-12  # relative; measured 1.1e-15


class Reference(NamedTuple):
    minimum_tilt: mp.mpf
    maximum_tilt: mp.mpf
    period: mp.mpf
    angle_of_turn: mp.mpf


def quadrature(cylinder: Cylinder, initial: InitialState, gravity: float) -> Reference:
    with mp.workdps(WORKING_DIGITS):
        R, alpha, g = mp.mpf(cylinder.semidiagonal), mp.mpf(cylinder.alpha), mp.mpf(gravity)
        b, h = R * mp.sin(alpha), R * mp.cos(alpha)
        I1 = (
            (3 * b**2 + 4 * h**2) / 12
            if cylinder.transverse_inertia is None
            else mp.mpf(cylinder.transverse_inertia)
        )
        I2 = b**2 / 2 if cylinder.axial_inertia is None else mp.mpf(cylinder.axial_inertia)
        A = I1 + h**2 + b**2

        def B(s: mp.mpf, c: mp.mpf) -> mp.mpf:
            return (I1 - I2 + h**2 - b**2) * s**2 + 2 * (I2 + b**2) * (1 - c) + 2 * h * b * s * (1 - c)

        def V(s: mp.mpf, c: mp.mpf) -> mp.mpf:
            return g * (b * s + h * c)

        def at(theta: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
            """B and V of a tilt, from sine and cosine computed once, as they take longest."""
            c, s = mp.cos_sin(theta)
            return B(s, c), V(s, c)

        tilt, tilt_rate = mp.mpf(initial.tilt), mp.mpf(initial.tilt_rate)
        inertia, potential = at(tilt)
        L = inertia * mp.mpf(initial.rolling_rate)
        energy = A * tilt_rate**2 / 2 + L**2 / (2 * inertia) + potential

        def rates(theta: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
            """Return theta'^2 and phi'."""
            inertia, potential = at(theta)
            return 2 * (energy - potential - L**2 / (2 * inertia)) / A, L / inertia

        def tilt_rate_squared(theta: mp.mpf) -> mp.mpf:
            return rates(theta)[0]

        def deflated(theta: mp.mpf) -> mp.mpf:
            return tilt_rate_squared(theta) / (theta - tilt)

        if tilt_rate:
            lower = root(tilt_rate_squared, tilt * mp.mpf(10) ** -40, tilt)
            upper = next_root(tilt_rate_squared, tilt, alpha)
        elif mp.diff(tilt_rate_squared, tilt, h=mp.mpf(10) ** -40) < 0:
            lower, upper = root(deflated, tilt * mp.mpf(10) ** -40, tilt * (1 - mp.mpf(10) ** -40)), tilt
        else:
            lower, upper = tilt, next_root(deflated, tilt * (1 + mp.mpf(10) ** -40), alpha)

        # theta = mid - half cos u, u = eps sinh v; a second scale of nodes towards the maximum
        eps = 2 * mp.sqrt(lower / (upper - lower))
        end = mp.asinh(mp.pi / eps)

        def time_and_turn(v: mp.mpf) -> mp.mpc:
            with mp.workdps(WORKING_DIGITS):
                grown = mp.exp(v)
                c, s = mp.cos_sin(eps * (grown - 1 / grown) / 4)  # of u/2
                squared, rolling_rate = rates(lower + (upper - lower) * s**2)
                dt = eps * (grown + 1 / grown) / 2 * (upper - lower) * s * c / mp.sqrt(squared)
                return mp.mpc(dt, rolling_rate * dt)

    with mp.workdps(QUADRATURE_DIGITS):
        panels = [0, end / 2] + [end * (1 - mp.mpf(10) ** -k) for k in range(1, 7)] + [end]
        integral, error = mp.quad(time_and_turn, panels, error=True, method="gauss-legendre", maxdegree=7)
        assert abs(error) < AGREEMENT / 100 * abs(integral)
        return Reference(lower, upper, 2 * integral.real, 2 * integral.imag)


def root(f: Callable[[mp.mpf], mp.mpf], lower: mp.mpf, upper: mp.mpf) -> mp.mpf:
    """Root between two points of different sign, by bisection in the logarithm first, as they may be far
    apart."""
    below = f(lower) > 0
    assert (f(upper) > 0) != below
    for _ in range(24):
        middle = mp.sqrt(lower * upper)
        lower, upper = (middle, upper) if (f(middle) > 0) == below else (lower, middle)
    return mp.findroot(
        f, (lower, upper), solver="anderson", tol=mp.mpf(10) ** -150, maxsteps=100, verify=False
    )


def next_root(f: Callable[[mp.mpf], mp.mpf], start: mp.mpf, end: mp.mpf) -> mp.mpf:
    """First root beyond `start`, where `f` is positive."""
    points = [start * (end / start) ** (mp.mpf(k) / 200) for k in range(201)]
    beyond = next(k for k, point in enumerate(points) if k and f(point) < 0)
    return root(f, points[beyond - 1], points[beyond])


def drawn() -> Iterator[Any]:
    """Random cylinders, releases and gravities, uniform in the logarithm where they span decades."""
    for kind, seeds in (("maximum", range(16)), ("minimum", range(100, 106)), ("between", range(200, 206))):
        for seed in seeds:
            random = np.random.default_rng(seed)
            size, tan_alpha = 10.0 ** random.uniform((-3.0, math.log10(0.05)), (3.0, math.log10(5.0)))
            cylinder, gravity = Cylinder(semidiagonal=size, tan_alpha=tan_alpha), random.uniform(0.1, 30.0)
            near = seed % 4 == 0  # near the steady wobble, or near a turning point
            highest = 0.4 if kind != "maximum" else 0.6 if near else 0.95
            tilt = random.uniform(0.01, highest) * cylinder.alpha
            rate = steady_wobble_rate(cylinder, tilt, gravity=gravity)
            if kind == "minimum":
                initial = InitialState(tilt=tilt, rolling_rate=random.uniform(1.0, 1.15) * rate)
            elif kind == "between":
                spin = rate * 10.0 ** random.uniform(-15.0, 0.0)
                moving = random.uniform(-0.5, 0.5) * rate * tilt * (1e-6 if near else 1.0)
                initial = InitialState(tilt=tilt, tilt_rate=moving, rolling_rate=spin)
            else:
                share = 10.0 ** (random.uniform(-6.0, -0.5) if near else random.uniform(-15.0, -0.3))
                share = 1.0 - share if near else share
                initial = InitialState(tilt=tilt, rolling_rate=share * rate)
            slow = [pytest.mark.slow] if kind == "maximum" else []
            yield pytest.param(cylinder, initial, gravity, id=f"{kind}-{seed}", marks=slow)
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    for spin in (1e-15, 1e-6):
        initial = InitialState(tilt=pier.alpha * (1.0 - 1e-9), rolling_rate=spin)
        yield pytest.param(pier, initial, 9.81, id=f"next to alpha, {spin:g} rad/s")
    for tan_alpha, share in ((1e-3, 1e-12), (1e3, 0.3), (1e-3, 0.3)):
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        tilt = 0.5 * cylinder.alpha
        initial = InitialState(tilt=tilt, rolling_rate=share * steady_wobble_rate(cylinder, tilt))
        yield pytest.param(cylinder, initial, 9.81, id=f"tan alpha {tan_alpha:g}, {share:g}")
    for seed in range(300, 304):
        random = np.random.default_rng(seed)
        transverse = 10.0 ** random.uniform(-3.0, 0.5)
        body = Cylinder(
            semidiagonal=1.0,
            tan_alpha=10.0 ** random.uniform(-1.0, 1.0),
            height=2.5,
            transverse_inertia=transverse,
            axial_inertia=transverse * random.uniform(0.01, 2.0),
        )
        tilt = random.uniform(0.1, 0.7) * body.alpha
        spin = 10.0 ** random.uniform(-8.0, -0.3) * steady_wobble_rate(body, tilt)
        yield pytest.param(body, InitialState(tilt=tilt, rolling_rate=spin), 9.81, id=f"body-{seed}")


@pytest.mark.parametrize(("cylinder", "initial", "gravity"), list(drawn()))
def test_a_release_turns_as_the_quadrature_of_the_printed_energies(
    cylinder: Cylinder, initial: InitialState, gravity: float
) -> None:
    expected = quadrature(cylinder, initial, gravity)
    response = free_response(cylinder, initial, gravity=gravity)
    errors = {
        name: abs(float(getattr(response, name) / value - 1)) for name, value in expected._asdict().items()
    }
    assert max(errors.values()) < AGREEMENT, errors
    assert response.half_period == 0.5 * response.period
