"""Diagnostics of an uplift before its load, or of one that an engine does not follow."""

from __future__ import annotations

import numpy as np
import pytest
from engine_samples import scene_of

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, Diagnostic, GroundMotion
from rockwobble.multibody.engines.registry import engine_facts
from rockwobble.multibody.protocol import Steps
from rockwobble.multibody.reaction import EARLY, sure_tilt
from rockwobble.multibody.recorder import Recorder
from rockwobble.multibody.scene import scaled_body, starting_state
from rockwobble.multibody.simulation import diagnostics

STEP = 1e-4
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
BODY = scaled_body(PIER, 1.0)
GRAVITY = 9.81
TURN = BODY.base_radius * GRAVITY / (BODY.transverse_inertia + BODY.mass_centre_height**2)


def surplus_until_sure(rise: float) -> float:
    """Rise of a load beyond the uplift load until the base tilts beyond the noise of standing."""
    return float((6.0 * sure_tilt(BODY, 2.0**-53) / TURN * rise**2) ** (1.0 / 3.0)) + rise * STEP


def opening(share: float, rise: float) -> list[Diagnostic]:
    """Diagnostic of a base that opens at `share` of the load, which rises by `rise` a second."""
    time = STEP * np.arange(round(1.3 / rise / STEP))
    load = rise * time
    start = starting_state(BODY, None, 1.0)
    b, height = BODY.base_radius, BODY.mass_centre_height
    # the base carries the load up to there, and the excess turns it
    rate = STEP * np.cumsum(TURN * np.maximum(load - share, 0.0))
    angle = STEP * np.cumsum(rate)
    end = int(np.argmax(angle > 1e-4)) or len(time)
    zero = np.zeros(len(time))
    steps = Steps(
        start.position + np.column_stack([height * angle, zero, b * angle]),
        np.column_stack([np.cos(0.5 * angle), zero, np.sin(0.5 * angle), zero]),
        np.column_stack([height * rate, zero, zero]),
        np.column_stack([zero, rate, zero]),
    )
    acceleration = np.column_stack([-load * GRAVITY * PIER.tan_alpha, zero, zero])
    scene = scene_of(PIER, time_step=STEP)
    recorder = Recorder(scene, np.array([0.0, STEP * (end - 2)]), 0.0, False)
    parts = (steps.position, steps.quaternion, steps.velocity, steps.angular_velocity)
    recorder.take(Steps(*(each[:end] for each in parts)), acceleration[:end])
    assert recorder.uplift is not None
    passes = {"time": np.empty(0), "minimum_tilt": np.empty(0)}
    return [each for each in diagnostics(recorder, passes, 0.0, 1.0) if each.code == "early_uplift"]


@pytest.mark.parametrize("rise", [1.0, 4.0])
def test_a_base_that_opens_before_its_load_reports_the_missing_share(rise: float) -> None:
    least = surplus_until_sure(rise)
    for share in np.random.default_rng(11).uniform(0.8, 1.0 - least - EARLY, 6):
        (early,) = opening(float(share), rise)
        assert early.bound == EARLY
        # never more than there was
        assert 1.0 - share - least <= early.size <= 1.0 - share


@pytest.mark.parametrize("rise", [1.0, 4.0])
@pytest.mark.parametrize("share", [1.0 - EARLY, 0.998, 1.0])
def test_a_base_that_opens_at_its_load_has_no_diagnostic(share: float, rise: float) -> None:
    assert not opening(share, rise)


def pulse(over: float) -> Case:
    """Case whose load rises in 0.5 s to `over` of the uplift load, and falls as slowly."""
    peak = over * GRAVITY * PIER.tan_alpha
    return Case(PIER, GroundMotion([[0.0, 0.0], [peak, 0.0], [0.0, 0.0]], 0.5), duration=1.1)


@pytest.mark.slow
@pytest.mark.parametrize("over", [1.001, 1.1])
def test_an_engine_opens_at_its_load_or_reports_it(engine: str, over: float) -> None:
    case = pulse(over)
    run, model = multibody.simulate(case, engine=engine), reduced.simulate(case)
    assert np.isfinite(run.uplift_time)
    codes = {fact.code for fact in run.facts}
    if engine_facts(engine).rounding < 1e-12:
        assert "early_uplift" not in codes
    assert codes or np.abs(run.tilt - model.tilt).max() < 0.05 * model.peak_tilt
