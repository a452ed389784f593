"""What a ring costs, and where the numbers come from."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare.metrics.pair import make_pair, tilt_rms_relative
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import Case, Cylinder, InitialState, Run, Trace
from rockwobble.studies.validity.measurements import has_room, losses

SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
# error of an engine at its default step, in the tilt against its own model, over 1.2 s
ENGINE = 1e-4
ROUNDING = 1e-9  # of a difference of two lengths of order one


def off_models(trace: Trace) -> dict[str, float]:
    """Relative RMS difference of the tilt from the models, by their support."""
    models = {support: reduced.simulate(trace.case, support=support) for support in ("recess", "flat")}
    return {name: tilt_rms_relative(make_pair(SQUAT, model, trace)) for name, model in models.items()}


def test_losses_and_model_differences_identify_the_support() -> None:
    case = Case(SQUAT, initial=InitialState(SQUAT.alpha / 2, rolling_rate=0.5), duration=1.2, friction=3.0)
    # the release would start inside of such walls
    assert not has_room(case, Run("mujoco", "ring", ring_inclination=0.1))
    assert has_room(case, Run("mujoco", "ring"))
    traces = {support: simulate_run(case, Run("mujoco", support)) for support in ("recess", "flat", "ring")}
    off = {support: off_models(trace) for support, trace in traces.items()}
    assert off["recess"]["recess"] < ENGINE < off["recess"]["flat"]
    assert off["flat"]["flat"] < ENGINE < off["flat"]["recess"]
    recess, flat, ring = (losses(trace) for trace in traces.values())
    # in a recess the cylinder would always come down in its place, on flat ground it rolls away from it
    assert float(recess["rolled_out"]) < 1e-5 < 1e-3 < float(flat["rolled_out"])
    free = traces["flat"]
    lean = np.array([math.cos(free.rolling_angle[-1]), math.sin(free.rolling_angle[-1])])
    moved = math.hypot(*(free.contact_point[-1] / SQUAT.base_radius - lean))
    assert flat["at_end"] == pytest.approx(moved, rel=ROUNDING)
    assert flat["first_contact"] == math.inf
    assert abs(float(flat["loss"])) < ENGINE
    assert 0.5 < float(ring["first_contact"]) < 1.2
    assert float(ring["contact_time"]) > 0.0
    assert float(ring["loss"]) > 100.0 * abs(float(flat["loss"]))
