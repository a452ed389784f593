from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble.compare.external.motion import AZIMUTH_BOUND, Motion, Part, Reference, explains
from rockwobble.models import Cylinder

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
TIME = np.linspace(0.0, 4.0, 401)


def motion(tilt, azimuth, *, noise=0.0, time=TIME):
    return Motion(time=time, tilt=tilt, lean=np.sin(tilt) * np.exp(1j * azimuth), path=None, noise=noise)


def swings(*peaks):
    """Tilt in swings of one second each, with given peaks, nearly upright in between."""
    each = np.minimum(TIME.astype(int), len(peaks) - 1)
    return 1e-4 + np.array(peaks)[each] * np.sin(np.pi * TIME) ** 2


def model(motion):
    return Reference(
        motion=motion,
        alpha=PIER.alpha,
        base_radius=PIER.base_radius,
        time_scale=0.78,
        start=0.0,
        is_free=True,
        tilt_bound=0.01,
        least_lean=0.05,
    )


def held(reference, other):
    return model(reference).difference(other)


TILT = swings(0.1, 0.08, 0.06, 0.1)


def test_an_azimuth_differs_by_its_bound_and_from_its_first_sample():
    for degrees in (2.0, 4.0):
        difference = held(motion(TILT, TIME), motion(TILT, TIME + math.radians(degrees)))
        assert difference.azimuth.size == pytest.approx(math.radians(degrees))
        assert difference.azimuth.differs == (math.radians(degrees) > AZIMUTH_BOUND)
    # 5 % of the largest tilt
    assert difference.azimuth.first_time == pytest.approx(math.asin(math.sqrt(0.05)) / math.pi, abs=0.01)


def test_azimuth_near_upright_and_after_the_agreement_is_ignored():
    upright = motion(TILT, TIME + np.where(TILT < 0.003, 2.0, 0.0))
    assert not held(motion(TILT, TIME), upright).azimuth.differs
    divergence = TILT + np.where(TIME > 3.5, 0.01 * PIER.alpha * 1.5, 0.0)
    after = motion(divergence, TIME + np.where(TIME > 3.5, 2.0, 0.0))
    assert held(motion(TILT, TIME), after).differs_in == ("tilt",)
    # azimuths differ before the divergence: the last fifth does not count
    before = motion(divergence, TIME + np.where(TIME > 2.9, 2.0, 0.0))
    assert held(motion(TILT, TIME), before).differs_in == ("tilt",)
    # without a divergence all of it counts
    assert held(motion(TILT, TIME), motion(TILT, TIME + np.where(TIME > 2.9, 2.0, 0.0))).differs_in == (
        "azimuth",
    )


def test_a_difference_that_only_just_vanishes_is_not_explained():
    def part(size):
        return Part(first_time=math.nan if size < 1.0 else 0.0, size=size, bound=1.0)

    assert explains(part(3.0), part(0.5))
    assert not explains(part(1.1), part(0.9))
    assert not explains(part(9.0), part(1.5))
    assert not explains(part(9.0), None)
