from __future__ import annotations

import numpy as np
import pytest

from rockwobble.models import el_centro_1940

HALF_A_DIGIT = 0.5e-5  # [g] the published peaks have five decimals

# component, column, peak [g], its time [s]: records/README.md
PEAKS = [("270", 0, 0.21074, 11.51), ("180", 1, 0.28080, 2.18), ("up", 2, 0.17814, 3.37)]


@pytest.mark.parametrize(("component", "column", "peak", "time"), PEAKS)
def test_peaks_and_their_times(component: str, column: int, peak: float, time: float) -> None:
    motion = el_centro_1940(vertical=True)
    samples = np.abs(motion.acceleration[:, column]) / 9.81
    assert samples.max() == pytest.approx(peak, abs=HALF_A_DIGIT)
    assert samples.argmax() * motion.time_step == pytest.approx(time, abs=1e-9)


def test_the_peak_of_the_resultant() -> None:
    assert el_centro_1940().peak / 9.81 == pytest.approx(0.28648, abs=HALF_A_DIGIT)


def test_the_vertical_comes_only_when_asked_for_and_changes_nothing_else() -> None:
    flat, full = el_centro_1940(), el_centro_1940(vertical=True)
    assert flat.acceleration.shape == (5346, 2)
    assert full.acceleration.shape == (5346, 3)
    assert np.array_equal(flat.acceleration, full.acceleration[:, :2])
    assert flat.time_step == full.time_step == 0.01
    assert flat.duration == pytest.approx(53.45, rel=1e-15)


def test_the_components_keep_their_signs() -> None:
    # as printed: the first sample of each file, and the last of the shortest
    motion = el_centro_1940(vertical=True).acceleration / 9.81
    assert motion[0] == pytest.approx([-0.9429229e-03, 0.9984852e-03, -0.8338791e-03], rel=1e-14)
    assert motion[-1, 0] == pytest.approx(0.8012335e-03, rel=1e-14)
    assert motion[1151, 0] == pytest.approx(-0.2107430, rel=1e-14)
