"""Rapier beyond the checks of any engine: the limits of single precision, and their diagnostics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, InitialState

if "rapier" not in multibody.available_engines():
    pytest.skip("needs rapier3d", allow_module_level=True)

COLUMN = Cylinder(semidiagonal=6.0, tan_alpha=0.35)
RELEASE = Case(COLUMN, initial=InitialState(COLUMN.alpha / 2, rolling_rate=0.5), duration=5.0)


def error(support: str, time_step: float) -> float:
    """Largest difference of the tilt from the reduced model, over alpha."""
    trace = multibody.simulate(RELEASE, engine="rapier", support=support, time_step=time_step)
    return float(np.abs(trace.tilt - reduced.simulate(RELEASE, support=support).tilt).max()) / COLUMN.alpha


@pytest.mark.slow
@pytest.mark.parametrize("support", ["recess", "flat"])
def test_the_error_is_first_order_down_to_the_floor_of_single_precision(support: str) -> None:
    coarse = error(support, 1e-3)
    # 2.5e-4 at 1e-3 s and 8e-5 at 4e-4 s: a slope of 1.2
    assert math.log(coarse / error(support, 4e-4)) / math.log(2.5) == pytest.approx(1.2, abs=0.2)
    # the floor: 2e-5 to 9e-5 from 2e-4 to 5e-5 s
    assert 1e-6 < error(support, 1e-4) < 1e-4


@pytest.mark.parametrize("support", ["recess", "flat"])
@pytest.mark.parametrize("share", [0.3, 0.8])
@pytest.mark.parametrize("tan_alpha", [0.2, 0.5])
def test_a_release_begins_with_its_exact_energy(support: str, share: float, tan_alpha: float) -> None:
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    start = InitialState(share * cylinder.alpha, rolling_rate=0.5)
    run = multibody.simulate(
        Case(cylinder, initial=start, duration=0.01), engine="rapier", support=support, sample_step=1e-3
    )
    # of the sums of single precision 2e-7 at most; a pose a little inside the ground gives 5e-6 in one step
    assert np.abs(run.energy / run.energy[0] - 1.0).max() < 1e-6
