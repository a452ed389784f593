"""A trace has a sample at every multiple of the sample step, and at its end."""

from __future__ import annotations

import numpy as np
import pytest

from rockwobble.models import Case, Cylinder, InitialState
from rockwobble.multibody import simulate

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = InitialState(0.5 * PIER.alpha, rolling_rate=0.5)


# six times 0.05 s rounds beyond 3000 steps of 1e-4 s, and so do others
@pytest.mark.parametrize(("count", "sample_step"), [(6, 0.05), (3, 0.1), (7, 0.01), (14, 0.025), (3, 0.07)])
def test_the_end_of_a_run_is_its_last_sample(count: int, sample_step: float) -> None:
    found = simulate(
        Case(PIER, initial=RELEASE, duration=round(count * sample_step, 12)), sample_step=sample_step
    )
    assert found.time == pytest.approx(sample_step * np.arange(count + 1), abs=1e-12)
    assert found.tilt[-1] < found.tilt[-2] < found.tilt[0]
