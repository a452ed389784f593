"""Means of a piecewise linear record over the steps of an engine."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble.models import GroundMotion
from rockwobble.multibody.excitation import StepMeans
from rockwobble.multibody.scene import froude_scale

UNIT = froude_scale(6.0, 9.81)
MOTION = GroundMotion([[0.0, 1.0], [2.0, -1.0], [1.0, 3.0], [1.0, 1.0]], 0.02)


def test_means_hold_the_impulse_of_the_record() -> None:
    step = 0.00137  # does not divide the sample step
    means = StepMeans(MOTION, UNIT, step)(0, 60)
    # trapezoids are exact for the record, and it is zero outside
    impulse = np.trapezoid(MOTION.acceleration, dx=0.02, axis=0)
    np.testing.assert_allclose(means.sum(axis=0)[:2] * step, impulse, rtol=1e-12)
    assert (means[:, 2] == 0.0).all()


@pytest.mark.parametrize("centre", [0.0, 0.5])
def test_means_about_a_pose_are_the_record_in_the_middle(centre: float) -> None:
    step = 1e-4
    means = StepMeans(MOTION, UNIT, step)(100, 50, centre)
    # within a straight piece the mean is the value in the middle
    time = (100 + centre + np.arange(50)) * step
    np.testing.assert_allclose(means[:, 0], time / 0.02 * 2.0, rtol=1e-9)


def test_excitation_in_chunks_equals_the_whole_record() -> None:
    means = StepMeans(MOTION, UNIT, 1e-3)
    np.testing.assert_array_equal(np.vstack([means(0, 13), means(13, 40)]), means(0, 53))
