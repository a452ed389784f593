"""Parts of a difference, with controls that none counts as another."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pandas as pd
import pytest

from rockwobble import comparison, multibody, reduced
from rockwobble.compare.comparison.budget import (
    LARGEST_SHARE,
    WORTH_EXPLAINING,
    ErrorBudget,
    Limit,
    Refined,
    error_budget,
    extrapolated,
    limits,
    unexplained_rows,
)
from rockwobble.compare.metrics.pair import Agreement
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run, Suite
from rockwobble.models.trace import lost_trace

ROUNDING = 1e-12
STEP = 4e-4  # coarse, so that four runs take a second
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.5)
CASE = Case(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=0.5), duration=2.0, name="release")
TIME = np.arange(201) * 0.01
WHOLE_RUN = Agreement(length=2.0, end=2.0, diverged=False, tested=True)


def run(case: Case, step: float):
    return multibody.simulate(
        Case(case.cylinder, case.motion, initial=case.initial, duration=case.duration), time_step=step
    )


def simulate(jobs):
    return [run(job.case, job.run.time_step) for job in jobs]


@pytest.fixture(scope="module")
def engine():
    return run(CASE, STEP)


@pytest.fixture(scope="module")
def limit(engine) -> Limit:
    refined = Refined(
        case=CASE,
        run=Run("mujoco", "recess", STEP),
        label="x",
        trajectory=engine,
        end=2.0,
        difference=np.zeros(1),
    )
    return limits([refined], simulate)[0]


def budget(engine, limit: Limit, cylinder: Cylinder = PIER) -> ErrorBudget:
    model = reduced.simulate(Case(cylinder, initial=CASE.initial, duration=2.0), rtol=1e-11)
    return error_budget(engine, model, model, limit, WHOLE_RUN)


def test_the_parts_add_up_at_every_sample(engine, limit):
    parts = budget(engine, limit)
    total = parts.model_form + parts.numerics + parts.unexplained
    assert np.allclose(total, parts.whole, rtol=0.0, atol=ROUNDING)


def test_the_error_of_a_step_is_numerical_and_not_unexplained(engine, limit):
    parts = budget(engine, limit)
    assert parts.rms("numerics") > 1e-7  # far above the 1e-10 of the reduced model
    assert parts.columns()["unexplained_share"] < 0.01  # error of third order in the step


def test_a_coarser_step_increases_numerics_alone(engine, limit):
    coarse = run(CASE, 2.0 * STEP)
    finer, coarser = budget(engine, limit), budget(coarse, limit)
    assert coarser.rms("numerics") > 1.8 * finer.rms("numerics")  # first order doubles, less 10 %
    assert coarser.rms("unexplained") == finer.rms("unexplained")


def test_an_error_of_half_a_per_cent_in_size_is_unexplained(engine, limit):
    wrong = Cylinder(semidiagonal=1.005 * 6.0, tan_alpha=0.5)
    columns = budget(engine, limit, wrong).columns()
    assert columns["whole_rms"] > 1e-4
    assert columns["unexplained_share"] > 0.9
    rows = unexplained_rows(pd.DataFrame([columns]))
    assert len(rows) == 1


def test_the_difference_of_two_models_is_model_form(engine, limit):
    models = [
        reduced.simulate(Case(PIER, initial=CASE.initial, duration=2.0), support=m, rtol=1e-11)
        for m in ("flat", "recess")
    ]
    parts = error_budget(engine, *models, limit, WHOLE_RUN)
    expected = (models[1].tilt - models[0].tilt) / PIER.alpha
    assert np.allclose(parts.model_form, expected, rtol=0.0, atol=ROUNDING)
    assert parts.rms("unexplained") == budget(engine, limit).rms("unexplained")


def made_up_tilts(steps, first: float, second: float) -> list[np.ndarray]:
    return [np.cos(TIME) + first * h * np.sin(TIME) + second * h**2 * TIME for h in steps]


def test_first_and_second_order_vanish_from_three_smooth_runs():
    steps = [1.0, 0.5, 0.25]
    limit = extrapolated(TIME, made_up_tilts(steps, 0.3, 0.2), steps, smooth=True)
    assert np.allclose(limit.tilt, np.cos(TIME), rtol=0.0, atol=ROUNDING)
    assert limit.steps == (1.0, 0.5, 0.25)
    for first, second, order in ((0.3, 0.0, 1.0), (0.0, 0.3, 2.0)):
        measured = extrapolated(TIME, made_up_tilts(steps, first, second), steps, smooth=True).order
        assert measured == pytest.approx(order, abs=1e-9)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_the_first_order_vanishes_for_any_number_of_runs(count):
    steps = [0.5**k for k in range(count)]
    limit = extrapolated(TIME, made_up_tilts(steps, 0.3, 0.0), steps, smooth=False)
    assert np.allclose(limit.tilt, np.cos(TIME), rtol=0.0, atol=ROUNDING)
    with pytest.raises(ValueError, match="two steps or more, got 1"):
        extrapolated(TIME, [TIME], [1.0], smooth=True)


def test_the_end_of_the_agreement_is_excluded(make_trace):
    # all of the difference is in the last fifth
    model = make_trace(TIME, np.full_like(TIME, 0.1))
    late = make_trace(TIME, 0.1 + np.where(TIME > 1.6 + 1e-9, 1e-3, 0.0))
    limit = Limit(time=TIME, tilt=late.tilt, error=np.zeros_like(TIME), steps=(1.0,), order=math.nan)
    parts = error_budget(late, model, model, limit, WHOLE_RUN)
    assert parts.covered == pytest.approx(1.6)
    assert parts.rms("whole") == 0.0
    assert parts.whole[-1] > 0.0


# RMS of numerics, unexplained, model form and limit error; measured order; time of an unresolved pass [s]
@pytest.mark.parametrize(
    ("parts", "order", "unresolved", "reason"),
    [
        ((1e-3, 1e-4, 0.0, 1e-4), 1.0, math.inf, ""),
        ((1e-3, 1e-4, 0.0, 1e-4), math.nan, math.inf, ""),
        ((1e-3, 1e-4, 0.0, 1e-4), 0.49, math.inf, "order"),
        ((1e-3, 1e-4, 0.0, 1.1e-3), 1.0, math.inf, "error"),
        ((1e-3, 1e-4, 0.0, 1.1e-3), -1.4, 1.9, "unresolved_pass"),
        ((1e-3, 1e-4, 0.0, 1e-4), 1.0, 2.1, ""),
        ((1e-3, 1e-4, 1e-2, 1.1e-3), 1.0, 1.9, ""),
    ],
)
def test_unknown_differences_have_no_budget(parts, order, unresolved, reason) -> None:
    numerics, unexplained, model_form, error = (np.full_like(TIME, part) for part in parts)
    unsplit = ErrorBudget(
        time=TIME,
        whole=numerics + unexplained + model_form,
        numerics=numerics,
        unexplained=unexplained,
        model_form=model_form,
        limit_error=error,
        covered=1.6,
        steps=(2e-4, 1e-4),
        order=order,
        unresolved=unresolved,
    )
    assert unsplit.not_split == reason
    columns = unsplit.columns()
    assert columns["not_split"] == reason
    stated = [columns[name] for name in ("numerics_rms", "unexplained_rms", "unexplained_share")]
    assert np.isnan(stated).tolist() == [bool(reason)] * 3
    assert columns["model_form_rms"] == pytest.approx(parts[2], rel=ROUNDING)
    assert unexplained_rows(pd.DataFrame([columns])).empty  # an unknown part is not listed as unexplained


def test_the_finer_runs_end_with_the_agreement(engine):
    motion = GroundMotion([[0.0, 0.0], [3.0, 4.0], [0.0, 0.0]], 0.5)
    case = Case(PIER, motion, name="pulse")
    trajectory = dataclasses.replace(engine, uplift_direction=0.7)
    refined = Refined(
        case=case, run=Run("mujoco", "recess"), label="x", trajectory=trajectory, end=0.804, difference=0.0
    )
    jobs = []
    limits(
        [refined], lambda wanted: jobs.extend(wanted) or [lost_trace(case, refined.run, "stop")] * len(wanted)
    )
    for level, job in enumerate(jobs, 1):
        assert job.case.length == pytest.approx(0.81)  # agreement of the traces, up to a whole sample
        assert job.run.time_step == pytest.approx(trajectory.time_step * 0.5**level)


@pytest.mark.slow
def test_numerics_of_an_extrapolated_run_are_the_error_of_its_limit():
    runs = [Run("mujoco", "recess", STEP), Run("mujoco", "recess", "extrapolated", finest_step=STEP / 2)]
    case = dataclasses.replace(CASE, duration=1.0)
    results = comparison(Suite([case], runs), runs=runs, budget=True, workers=1)
    plain, extrapolated = results.budget_rms.to_dict("records")
    # both use the same finest run, at an eighth of the step
    assert extrapolated["numerics_rms"] < 0.1 * plain["numerics_rms"]
    assert extrapolated["unexplained_rms"] == pytest.approx(plain["unexplained_rms"], abs=1e-8)
    assert extrapolated["finest_step"] == pytest.approx(STEP / 8)


@pytest.mark.slow
def test_the_loss_of_a_base_that_lands_flat_is_model_form():
    # released without spin it falls on its other edge, where the engine has Housner's loss: at a tilt so
    # small that the two do not diverge
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    case = Case(pier, initial=InitialState(0.04 * pier.alpha), duration=0.5, name="release")
    run = Run("mujoco", "recess", 2e-4)
    results = comparison(Suite([case], [run]), runs=[run], budget=True, workers=1)
    (row,) = results.budget_rms.to_dict("records")
    assert row["whole_rms"] > WORTH_EXPLAINING
    assert row["model_form_rms"] == pytest.approx(row["whole_rms"], rel=0.1)
    # 1 %: the step is twice the default
    assert row["unexplained_share"] < 0.05


def test_unexplained_rows_are_sorted_with_the_worst_first():
    summary = pd.DataFrame(
        {
            "whole_rms": [1e-3, 5e-5, 1e-3, 1e-3, math.nan],
            "unexplained_share": [LARGEST_SHARE + 0.01, 0.9, 0.5, LARGEST_SHARE - 0.01, math.nan],
        }
    )
    assert unexplained_rows(summary).index.tolist() == [2, 0]
