"""The error falls in proportion to the tolerance, over five decades."""

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
TOLERANCES = 10.0 ** np.arange(-5.0, -10.5, -1.0)


def pulse():
    """Pulse of a sine of 2 s in one direction, and half of its size across it."""
    time = np.linspace(0.0, 2.0, 101)
    a = 2.6 * np.column_stack([np.sin(math.pi * time), 0.3 * np.sin(0.5 * math.pi * time)])
    return GroundMotion(a, 0.02)


PROBLEMS = {
    "free response": {"initial": InitialState(0.5 * PIER.alpha, rolling_rate=0.05), "duration": 20.0},
    "El Centro": {"motion": el_centro_1940(), "duration": 12.0},
    "one-sine pulse": {"motion": pulse(), "duration": 15.0},
    "resisted": {
        "initial": InitialState(0.5 * PIER.alpha, rolling_rate=0.05),
        "duration": 8.0,
        "rolling_resistance": 0.01,
    },
}


@pytest.mark.parametrize("model", ["recess", "flat"])
@pytest.mark.parametrize("problem", PROBLEMS)
def test_error_is_proportional_to_the_tolerance(model, problem):
    options, method = PROBLEMS[problem], reduced.MODELS[model]
    case = Case(PIER, **options)
    exact = reduced.simulate(case, rtol=1e-13, **method).tilt
    tilts = [reduced.simulate(case, rtol=rtol, **method).tilt for rtol in TOLERANCES]
    errors = [np.abs(tilt - exact).max() for tilt in tilts]
    slope = np.polyfit(np.log10(TOLERANCES), np.log10(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.2)
