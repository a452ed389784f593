"""Fixtures: comparisons with models in place of engines, and runs without processes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import rockwobble as rw
from rockwobble import reduced
from rockwobble.compare import Comparison
from rockwobble.compare.comparison import driver
from rockwobble.compare.runs import execution
from rockwobble.compare.runs.execution import Job
from rockwobble.models import Case, Cylinder, Run, Trace, el_centro_1940
from rockwobble.models.records import p695
from rockwobble.studies import study
from rockwobble.studies.advice import scales

RESOLUTION = 2e-5  # [rad]


def disguised(job: Job, **fields: Any) -> Trace:
    """Trace of a model; for an engine that of a slightly different body, with its support."""
    case, run = job.case, job.run
    if run.is_model:
        model = reduced.simulate(case, support=run.support, **run.settings)
        return dataclasses.replace(model, wall_time=1e-3)
    off = dataclasses.replace(case.cylinder, semidiagonal=case.cylinder.semidiagonal * (1.0 + 1e-5))
    recess = run.support != "flat"
    model = reduced.simulate(dataclasses.replace(case, cylinder=off), support="recess" if recess else "flat")
    given = {
        "case": case,
        "run": run,
        "version": "1",
        "time_step": run.time_step or 1e-4,
        "contact_resolution": RESOLUTION,
        "passes": model.passes.assign(resolved=model.passes["minimum_tilt"] > RESOLUTION),
        "residual_displacement": 1e-6 if recess else 0.4,
        "twist": model.twist + (1e-7 if recess else 0.2),
        "wall_time": 5.0,
    } | fields
    return dataclasses.replace(model, **given)


def simulate_disguised(jobs: list[Job], fields: dict[str, Any]) -> list[Trace]:
    return [disguised(job, **fields) for job in jobs]


@pytest.fixture
def no_engines(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Replace the engines of every comparison in this test; `fields` are those of their traces."""

    def use(**fields: Any) -> None:
        monkeypatch.setattr(driver, "simulate_all", lambda jobs, **_: simulate_disguised(jobs, fields))

    return use


@pytest.fixture(scope="session")
def comparison() -> Comparison:
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940(), name="El Centro 1940")
    runs = [Run(engine, support) for support in ("recess", "flat") for engine in ("mujoco", "pybullet")]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(driver, "simulate_all", lambda jobs, **_: simulate_disguised(jobs, {}))
        # no engine runs, so none needs to be installed: PyBullet is not everywhere
        patch.setattr(driver, "require_runnable", lambda case, run: None)
        return rw.comparison(case, runs=runs)


@pytest.fixture(scope="module")
def six_records() -> Iterator[None]:
    """Six other records in each advice, and two planar intensities: all of them take most of its time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(p695, "PAIRS", 6)
        patch.setattr(scales, "PLANAR_SCALES", (1.0, 2.0))
        yield


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Run inside this process, which has loaded the model; a new process would load it again."""
    run_tasks = execution.run_tasks

    def here(*given: Any, **options: Any) -> list[Any]:
        return run_tasks(*given, **options | {"workers": 1})

    for module in (execution, study):
        monkeypatch.setattr(module, "run_tasks", here)
