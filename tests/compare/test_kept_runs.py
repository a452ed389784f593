"""An interrupted comparison resumes."""

from __future__ import annotations

import dataclasses

import numpy as np
import pandas as pd
import pytest

from rockwobble import comparison
from rockwobble.compare.runs import execution
from rockwobble.compare.runs.execution import Job, job_fingerprint, open_trace_cache, simulate_all
from rockwobble.models import Case, Cylinder, InitialState, Run, Trace

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
CASE = Case(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=0.5), duration=1.0, name="release")
# largest step that contact allows: the test is of storage, not of the motion
GUIDED, FREE = Run("mujoco", "recess", 1e-3), Run("mujoco", "flat", 1e-3)
MODEL = Run(None, "recess")


@pytest.fixture
def counted(monkeypatch) -> list[str]:
    """Labels of the jobs that run, not read from the cache."""
    ran: list[str] = []
    run_job = execution.run_job

    def counting(job: Job) -> Trace:
        ran.append(job.label)
        return run_job(job)

    monkeypatch.setattr(execution, "run_job", counting)
    return ran


def run(folder, *runs: Run) -> list[Trace]:
    with open_trace_cache(folder, "comparison") as cache:
        return simulate_all([Job(case=CASE, run=run) for run in runs], workers=1, cache=cache)


def test_a_second_comparison_runs_nothing_and_is_equal(tmp_path, counted):
    first = comparison(CASE, runs=[GUIDED], workers=1, resume=tmp_path)
    assert counted[:2] == ["recess model", "mujoco recess"]
    counted.clear()
    second = comparison(CASE, runs=[GUIDED], workers=1, resume=tmp_path)
    assert counted == []
    pd.testing.assert_frame_equal(first.summary, second.summary, check_exact=True)


@pytest.mark.parametrize("method", [GUIDED, MODEL])
def test_every_field_is_stored_to_the_last_bit(tmp_path, method):
    (trace,) = run(tmp_path, method)
    (kept,) = run(tmp_path, method)
    pd.testing.assert_frame_equal(trace.to_frame(), kept.to_frame(), check_exact=True)
    assert trace.assumptions == kept.assumptions
    for field in dataclasses.fields(trace):
        value, again = getattr(trace, field.name), getattr(kept, field.name)
        if isinstance(value, np.ndarray):
            assert value.dtype == again.dtype
            assert np.array_equal(value, again, equal_nan=True), field.name
        elif isinstance(value, pd.DataFrame):
            pd.testing.assert_frame_equal(value, again, check_exact=True)
        elif field.name not in ("case", "source", "settings"):
            assert value == again or (np.isnan(value) and np.isnan(again)), field.name
    assert dict(trace.settings) == dict(kept.settings)


def test_only_missing_runs_are_made_and_the_order_is_unchanged(tmp_path, counted):
    run(tmp_path, MODEL, FREE)
    counted.clear()
    results = run(tmp_path, GUIDED, FREE, MODEL)
    assert counted == ["mujoco recess"]
    assert [str(trace.run) for trace in results] == ["mujoco recess", "mujoco flat", "recess model"]


def test_a_cached_run_is_found_by_case_and_not_by_label():
    job = Job(case=CASE, run=GUIDED, label="mine")
    renamed = Job(case=dataclasses.replace(CASE, name="yours"), run=GUIDED)
    assert job_fingerprint(job) == job_fingerprint(renamed)
    other = Job(case=dataclasses.replace(CASE, friction=np.nextafter(1.0, 2.0)), run=GUIDED)
    assert job_fingerprint(job) != job_fingerprint(other)
