"""A comparison without engines: reduced models in an engine's clothes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import pytest

from rockwobble import reduced
from rockwobble.compare import Comparison, compare
from rockwobble.compare.comparison import driver
from rockwobble.compare.runs.execution import Job
from rockwobble.models import Case, Cylinder, Run, el_centro_1940


class Disguised:
    """A response that answers as an engine's trajectory; `fields` replace what it has."""

    def __init__(self, response: reduced.Response, run: Run, **fields: Any) -> None:
        self._response = response
        self._fields = {
            "engine": run.engine,
            "engine_version": "1",
            "support": run.support,
            "time_step": run.time_step or 1e-4,
            "contact_resolution": 2e-5,
            "residual_displacement": 1e-6 if run.support == "recess" else 0.4,
            "residual_twist": 1e-7 if run.support == "recess" else 0.2,
            "wall_time": 5.0,
            "message": "",
        } | fields

    def __getattr__(self, name: str) -> Any:
        if name == "assumptions":
            raise AttributeError(name)
        return self._fields[name] if name in self._fields else getattr(self._response, name)

    @property
    def passes(self) -> Any:
        passes = self._response.passes
        return passes.assign(resolved=passes["minimum_tilt"] > self.contact_resolution)


def disguised(job: Job, **fields: Any) -> Any:
    """Return a response; for an engine that of a body slightly off, on the model of its support."""
    case, method = job.case, job.method
    given = {"initial": case.initial, "duration": case.duration}
    if isinstance(method, str):
        return reduced.simulate(Case(case.cylinder, case.motion), **reduced.MODELS[method], **given)
    off = dataclasses.replace(case.cylinder, semidiagonal=case.cylinder.semidiagonal * (1.0 + 1e-5))
    model = "flat" if method.support == "flat" else "recess"
    return Disguised(
        reduced.simulate(Case(off, case.motion), **reduced.MODELS[model], **given), method, **fields
    )


@pytest.fixture
def no_engines(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """Replace the engines of every comparison in this test; `fields` are those of the trajectories."""

    def use(**fields: Any) -> None:
        def simulate_all(jobs: list[Job], **_: Any) -> list[Any]:
            return [disguised(job, **fields) for job in jobs]

        monkeypatch.setattr(driver, "simulate_all", simulate_all)

    return use


@pytest.fixture
def comparison(no_engines: Callable[..., None], monkeypatch: pytest.MonkeyPatch) -> Comparison:
    no_engines()
    # no engine runs, so none needs to be installed: PyBullet is not everywhere
    monkeypatch.setattr(driver, "require_runnable", lambda case, run: None)
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940(), name="El Centro 1940")
    runs = [Run(engine, support) for support in ("recess", "flat") for engine in ("mujoco", "pybullet")]
    return compare(case, runs=runs)
