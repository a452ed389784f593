"""A comparison that was ended goes on where it stopped."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockwobble import reduced
from rockwobble.compare import compare, simulate_all
from rockwobble.compare.runs import execution
from rockwobble.compare.runs.execution import Crash, Job
from rockwobble.compare.runs.run_store import RUNS, open_run_store
from rockwobble.compare.storage.stored_trace import from_parquet, stored, to_parquet
from rockwobble.models import Case, Cylinder, InitialState, Run

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
CASE = Case(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=0.5), duration=1.0, name="release")
# the largest step that contact allows: what is tested is what becomes of a run
GUIDED, FREE = Run("mujoco", "recess", 1e-3), Run("mujoco", "flat", 1e-3)


def runs_in(folder: Path) -> list[Path]:
    return sorted((folder / RUNS).iterdir())


@pytest.fixture
def counted(monkeypatch) -> list[str]:
    """Labels of the jobs that really run."""
    ran: list[str] = []
    simulate = execution.simulate

    def counting(job: Job):
        ran.append(job.label)
        return simulate(job)

    monkeypatch.setattr(execution, "simulate", counting)
    return ran


def jobs(*methods: str | Run, case: Case = CASE) -> list[Job]:
    return [
        Job(case=case, method=method, label=str(getattr(method, "support", method))) for method in methods
    ]


def run(folder: Path, wanted: list[Job], **options) -> list:
    with open_run_store(folder) as store:
        return simulate_all(wanted, workers=1, store=store, **options)


def test_a_second_comparison_repeats_nothing_and_finds_the_same(tmp_path, counted):
    first = compare(CASE, runs=[GUIDED], workers=1, resume=tmp_path)
    assert counted[:2] == ["recess", "mujoco recess"]
    counted.clear()
    second = compare(CASE, runs=[GUIDED], workers=1, resume=tmp_path)
    assert counted == []
    pd.testing.assert_frame_equal(first.summary, second.summary, check_exact=True)
    for found, kept in (
        *zip(first.responses.values(), second.responses.values(), strict=True),
        *zip(first.trajectories.values(), second.trajectories.values(), strict=True),
    ):
        pd.testing.assert_frame_equal(found.to_frame(), kept.to_frame(), check_exact=True)
        pd.testing.assert_frame_equal(found.passes, kept.passes, check_exact=True)


def test_every_field_of_a_trajectory_is_kept_to_the_last_bit(tmp_path):
    (trajectory,) = simulate_all([Job(case=CASE, method=GUIDED, label="x")], workers=1)
    kept = from_parquet(to_parquet(stored(trajectory), {}))
    for field in dataclasses.fields(trajectory):
        value, again = getattr(trajectory, field.name), getattr(kept, field.name)
        if isinstance(value, np.ndarray):
            assert value.dtype == again.dtype
            assert np.array_equal(value, again, equal_nan=True), field.name
        elif isinstance(value, pd.DataFrame):
            pd.testing.assert_frame_equal(value, again, check_exact=True)
        elif field.name == "settings":
            assert dict(value) == again
        else:
            assert value == again or (np.isnan(value) and np.isnan(again)), field.name
    assert not hasattr(kept, "assumptions")


def test_a_response_keeps_what_can_be_asked_of_it():
    response = reduced.simulate(Case(PIER, initial=CASE.initial, duration=1.0))
    kept = from_parquet(to_parquet(stored(response), {}))
    for name in (
        "contact_point",
        "centre_of_mass",
        "contact_force",
        "friction_needed",
        "signed_tilt",
        "energy",
    ):
        assert np.array_equal(getattr(response, name), getattr(kept, name), equal_nan=True), name
    assert kept.assumptions == response.assumptions
    assert (kept.model, kept.outcome, kept.peak_tilt) == ("recess", response.outcome, response.peak_tilt)
    with pytest.raises(AttributeError, match="no engine"):
        _ = kept.engine


def test_a_run_that_never_uplifts_is_kept_with_its_nan():
    response = reduced.simulate(Case(PIER, duration=0.5))
    kept = from_parquet(to_parquet(stored(response), {}))
    assert np.isnan(kept.uplift_time)
    assert kept.passes.dtypes.to_dict() == response.passes.dtypes.to_dict()


def test_only_what_is_missing_runs(tmp_path, counted):
    run(tmp_path, jobs("recess", FREE))
    counted.clear()
    events = []
    run(tmp_path, jobs("recess", GUIDED, FREE, "flat"), progress=events.append)
    assert counted == ["recess", "flat"]
    assert [(event.state, event.done, event.total) for event in events] == [
        ("started", 2, 4),
        ("finished", 3, 4),
        ("started", 3, 4),
        ("finished", 4, 4),
    ]


def test_results_come_in_the_order_of_the_jobs(tmp_path):
    run(tmp_path, jobs(FREE))
    found = run(tmp_path, jobs("flat", FREE, "recess", GUIDED))
    assert [getattr(trace, "support", None) or trace.model for trace in found] == [
        *("flat", "flat", "recess", "recess")
    ]


def test_an_interrupted_comparison_keeps_every_finished_run(tmp_path, counted):
    def interrupt(event):
        if event.state == "started" and event.label == "recess":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, jobs("recess", GUIDED), progress=interrupt)
    assert counted == ["recess"]
    run(tmp_path, jobs("recess", GUIDED))
    assert counted == ["recess", "recess"]


def test_runs_of_another_comparison_go_only_when_this_one_is_complete(tmp_path):
    run(tmp_path, jobs("recess", "flat"))
    before = set(runs_in(tmp_path))

    def interrupt(_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, jobs(FREE), progress=interrupt)
    assert set(runs_in(tmp_path)) == before
    run(tmp_path, jobs(FREE, "recess"))
    assert len(runs_in(tmp_path)) == len(before)
    assert len(before & set(runs_in(tmp_path))) == len(before) - 1


def test_a_run_that_ended_its_process_is_tried_again(tmp_path, monkeypatch):
    job = Job(case=CASE, method="recess", label="recess")
    monkeypatch.setattr(execution, "simulate", lambda job: Crash("died"))
    with open_run_store(tmp_path) as store:
        assert isinstance(simulate_all([job], workers=1, store=store)[0], Crash)
        assert store.find(job) is None


def test_what_was_left_half_written_is_removed(tmp_path):
    (tmp_path / RUNS).mkdir()
    leftover = tmp_path / RUNS / ".abc.parquet.1.part"
    leftover.write_bytes(b"PAR1")
    with open_run_store(tmp_path):
        assert not leftover.exists()


def test_one_comparison_at_a_time_writes_to_a_folder(tmp_path):
    with (
        open_run_store(tmp_path),
        pytest.raises(ValueError, match="another process is writing to"),
        open_run_store(tmp_path),
    ):
        pass
