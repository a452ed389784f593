from __future__ import annotations

import numpy as np
import pytest

from rockwobble.models import el_centro_1940

HALF_A_DIGIT = 0.5e-5  # [g] the published peaks have five decimals


def test_peaks_their_times_and_signs_are_those_of_the_files() -> None:
    """Published in records/README.md; the first sample of each file, and the last of the shortest."""
    flat, full = el_centro_1940(), el_centro_1940(vertical=True)
    assert (flat.acceleration.shape, full.acceleration.shape) == ((5346, 2), (5346, 3))
    assert np.array_equal(flat.acceleration, full.acceleration[:, :2])
    assert flat.time_step == full.time_step == 0.01
    assert flat.peak / 9.81 == pytest.approx(0.28648, abs=HALF_A_DIGIT)
    samples = full.acceleration / 9.81
    for values, peak, time in zip(
        np.abs(samples.T), (0.21074, 0.28080, 0.17814), (11.51, 2.18, 3.37), strict=True
    ):
        assert values.max() == pytest.approx(peak, abs=HALF_A_DIGIT)
        assert values.argmax() * full.time_step == pytest.approx(time, abs=1e-9)
    assert samples[0] == pytest.approx([-0.9429229e-03, 0.9984852e-03, -0.8338791e-03], rel=1e-14)
    assert samples[[-1, 1151], 0] == pytest.approx([0.8012335e-03, -0.2107430], rel=1e-14)
