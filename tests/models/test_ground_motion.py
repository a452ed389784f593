from __future__ import annotations

import copy
import dataclasses
import math
import pickle
from typing import Any

import numpy as np
import pytest

from rockwobble.models import GroundMotion, p695_far_field
from rockwobble.models.records.p695 import missing_packages

ROUNDING = 4e-16  # two products and a sum
SAMPLES = np.array([[0.0, 0.0], [3.0, -4.0], [1.0, 2.0]])


def test_duration_spans_the_samples_and_peak_is_the_horizontal_resultant() -> None:
    motion = GroundMotion(np.column_stack([SAMPLES, [90.0, 0.0, -90.0]]), 0.5)
    assert (motion.duration, motion.peak, motion.has_vertical) == (1.0, 5.0, True)
    assert not GroundMotion(SAMPLES, 0.5).has_vertical


@pytest.mark.parametrize(
    "send", [lambda motion: motion, copy.deepcopy, lambda motion: pickle.loads(pickle.dumps(motion))]
)
def test_samples_are_a_read_only_copy_of_floats(send: Any) -> None:
    samples = np.asfortranarray(SAMPLES.astype(np.int32))
    motion = send(GroundMotion(samples, np.float32(0.5), "pulse"))
    samples[1] = 0
    assert np.array_equal(motion.acceleration, SAMPLES)
    assert (motion.time_step, type(motion.time_step), motion.name) == (0.5, float, "pulse")
    assert (motion.acceleration.dtype, motion.acceleration.flags.c_contiguous) == (np.float64, True)
    with pytest.raises(ValueError, match="read-only"):
        motion.acceleration[0, 0] = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        motion.time_step = 1.0


def test_scaling_takes_all_three_components_and_keeps_the_name() -> None:
    motion = GroundMotion([[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]], 0.1, "short")
    scaled = motion.scaled(-2.0)
    assert np.array_equal(scaled.acceleration, [[0.0, -2.0, -4.0], [-6.0, -8.0, -10.0]])
    assert (scaled.time_step, scaled.name) == (0.1, "short")
    assert np.array_equal(motion.acceleration[1], [3.0, 4.0, 5.0])


def test_rotation_is_counter_clockwise_seen_from_above_and_leaves_the_vertical() -> None:
    east = GroundMotion([[0.0, 0.0, 0.0], [1.0, 0.0, 7.0]], 0.1)
    north = east.rotated(0.5 * math.pi)
    assert north.acceleration[1] == pytest.approx([0.0, 1.0, 7.0], abs=ROUNDING)
    assert east.rotated(math.pi / 6.0).acceleration[1] == pytest.approx(
        [math.sqrt(0.75), 0.5, 7.0], abs=ROUNDING
    )


@pytest.mark.parametrize("bad", [[], [[1.0, 2.0]], [1.0, 2.0], np.ones((3, 4)), np.ones((2, 2, 2))])
def test_refuses_a_shape_that_is_no_motion(bad: Any) -> None:
    with pytest.raises(ValueError, match=r"^acceleration must have shape \(n, 2\) or \(n, 3\) with n >= 2"):
        GroundMotion(bad, 0.1)


@pytest.mark.parametrize("value", [math.nan, -math.inf])
def test_the_first_sample_that_is_not_finite_is_named(value: float) -> None:
    samples = np.zeros((5, 3))
    samples[3, 2] = samples[4, 0] = value
    with pytest.raises(ValueError, match=f"must be finite, got {value} in sample 3 of component z$"):
        GroundMotion(samples, 0.1)


@pytest.mark.parametrize("degrees", [7.0, -90.0, 360.0])
def test_an_angle_in_degrees_is_refused_with_its_likely_meaning(degrees: float) -> None:
    motion = GroundMotion(SAMPLES, 0.1)
    message = rf"^angle must be from -2 pi to 2 pi \[rad\], got {degrees}: .* math.radians\({degrees:g}\)$"
    with pytest.raises(ValueError, match=message):
        motion.rotated(degrees)
    assert motion.rotated(math.radians(degrees)).peak == pytest.approx(motion.peak, rel=ROUNDING)


def test_refuses_to_scale_beyond_what_a_float_holds() -> None:
    for factor, words in (
        (1e308, "acceleration must be finite, got inf"),
        (math.nan, "factor must be a finite"),
    ):
        with pytest.raises(ValueError, match=f"^{words}"):
            GroundMotion(SAMPLES, 0.1).scaled(factor)


# FEMA P-695, tables A-4A (larger peak of the two components [g]) and A-4D (factor of normalisation)
FAR_FIELD = (
    (0.52, 0.65), (0.48, 0.83), (0.82, 0.63), (0.34, 1.09), (0.35, 1.31), (0.38, 1.01), (0.51, 1.03),
    (0.24, 1.10), (0.36, 0.69), (0.22, 1.36), (0.24, 0.99), (0.42, 1.15), (0.53, 1.09), (0.56, 0.88),
    (0.51, 0.79), (0.36, 0.87), (0.45, 1.17), (0.55, 0.82), (0.44, 0.41), (0.51, 0.96), (0.21, 2.10),
    (0.35, 1.44),
)  # fmt: skip
PRINTED = 0.006  # two digits


@pytest.mark.skipif(bool(missing_packages()), reason="the records of FEMA P-695 are an extra")
def test_the_far_field_pairs_have_the_peaks_and_factors_of_their_tables() -> None:
    for pair, (peak, factor) in enumerate(FAR_FIELD, start=1):
        recorded, normalised = (p695_far_field(pair, normalised=either) for either in (False, True))
        assert np.abs(recorded.acceleration).max() / 9.81 == pytest.approx(peak, abs=PRINTED), pair
        assert normalised.peak / recorded.peak == pytest.approx(factor, abs=PRINTED), pair
    steps = [p695_far_field(pair).time_step for pair in (1, 6, 11, 12)]
    assert steps == [0.01, 0.005, 0.02, 0.0025]
