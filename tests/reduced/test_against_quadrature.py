"""The integrated recess model against its exact solution, on random cylinders and releases."""

import math

import numpy as np
import pytest
from accuracy_table import is_stated

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState

COUNT = 200


def random_release(rng):
    """A cylinder, a release at rest in tilt, and a spin from 1e-8 to that of steady wobble."""
    tan_alpha = math.exp(rng.uniform(math.log(0.05), math.log(5.0)))
    cylinder = Cylinder(
        semidiagonal=math.exp(rng.uniform(math.log(0.1), math.log(50.0))), tan_alpha=tan_alpha
    )
    tilt = rng.uniform(0.1, 0.9) * cylinder.alpha
    steady = reduced.steady_wobble_rate(cylinder, tilt)
    spin = math.exp(rng.uniform(math.log(1e-8), math.log(0.9 * steady)))
    return cylinder, InitialState(tilt, rolling_rate=spin)


def test_period_and_turn_are_as_close_as_the_readme_says():
    rng, errors = np.random.default_rng(0), []
    for _ in range(COUNT):
        cylinder, initial = random_release(rng)
        exact = reduced.free_response(cylinder, initial)
        response = reduced.simulate(
            Case(cylinder, initial=initial, duration=1.01 * exact.period), rtol=1e-10, rest_tilt=0.0
        )
        maxima = response.extrema[response.extrema[:, 3] > 0.0]
        errors += [maxima[1, 0] / exact.period - 1.0, maxima[1, 2] / exact.angle_of_turn - 1.0]
    assert is_stated(np.max(np.abs(errors)), f"{COUNT} random cylinders", r"within (\S+)")


def test_steady_wobble_turns_at_the_exact_rate():
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.7)
    for share in (0.01, 0.5, 0.99):
        tilt = share * cylinder.alpha
        rate = reduced.steady_wobble_rate(cylinder, tilt)
        response = reduced.simulate(
            Case(cylinder, initial=InitialState(tilt, rolling_rate=rate), duration=10.0), rtol=1e-11
        )
        assert response.rolling_angle[-1] == pytest.approx(10.0 * rate, rel=1e-9)
        assert reduced.wobbling_period(cylinder, tilt) == pytest.approx(2.0 * math.pi / rate, rel=1e-14)
