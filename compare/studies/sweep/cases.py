"""Cases times methods, each run for its numbers without its samples."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from rockwobble.models import Case, Run

from ...comparison.result import describe_case
from ...runs.choice import require_runnable, run_labels
from ...runs.execution import Job, simulate
from ...runs.run_store import job_fingerprint, makers_of
from ...storage.fingerprint import fingerprint
from .grid import MODELS

# An engine's run takes seconds, a reduced one milliseconds.
_REDUCED_CHUNK_SIZE, _ENGINE_CHUNK_SIZE = 200, 1
# not the computing time: the table of two sweeps of the same runs is the same
_RESULTS = (
    "outcome",
    "message",
    "peak_tilt",
    "uplift_time",
    "uplift_direction",
    "contact_resolution",
    "residual_displacement",
    "residual_twist",
    "engine_version",
)
_WORDS = ("outcome", "message", "engine_version")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CaseChunk:
    """Some cases with one method; `run` solves them."""

    jobs: tuple[Job, ...]

    @property
    def rows(self) -> int:
        """Number of runs."""
        return len(self.jobs)

    @property
    def makers(self) -> dict[str, str]:
        """Versions and code on which the results depend."""
        return makers_of(self.jobs[0])

    def key(self) -> str:
        """Return the hash of all that the results depend on."""
        return fingerprint([(job.case.name, job.label, job_fingerprint(job)) for job in self.jobs])

    def run(self) -> dict[str, Any]:
        """Return the columns of the results, one row for each run."""
        rows = [_row(job, simulate(job)) for job in self.jobs]
        return {name: [row[name] for row in rows] for name in rows[0]}


@dataclass(frozen=True, slots=True, eq=False, init=False)
class CaseSweep:
    """Every case with every method: runs of engines, and reduced models by name.

    Parameters
    ----------
    cases : iterable of Case
        With different names.
    methods : iterable of Run or str

    Raises
    ------
    ValueError
        If there is no case or no method, two are alike, or an engine cannot run a case.
    """

    cases: tuple[Case, ...]
    methods: tuple[Run | str, ...]

    def __init__(self, cases: Iterable[Case], methods: Iterable[Run | str]) -> None:
        object.__setattr__(self, "cases", tuple(cases))
        object.__setattr__(self, "methods", tuple(methods))
        names = [case.name for case in self.cases]
        if not names or not self.methods:
            raise ValueError("a sweep must have at least one case and one method")
        for values in (names, [method for method in self.methods if isinstance(method, str)]):
            for value in values:
                if values.count(value) > 1:
                    raise ValueError(f"the cases and methods of a sweep must differ, got {value!r} twice")
        for method in self.methods:
            if isinstance(method, Run):
                for case in self.cases:
                    require_runnable(case, method)
            elif method not in MODELS:
                raise ValueError(f"a method must be a run or one of {', '.join(MODELS)}, got {method!r}")
        self._labels()

    @property
    def rows(self) -> int:
        """Number of runs."""
        return len(self.cases) * len(self.methods)

    @property
    def kind(self) -> str:
        """What this is, for people."""
        return "cases and runs"

    def chunks(self, size: int | None = None) -> Iterator[CaseChunk]:
        """Cut the runs into chunks, in the order of the table: method by method."""
        for method, label in zip(self.methods, self._labels(), strict=True):
            step = size or (_REDUCED_CHUNK_SIZE if isinstance(method, str) else _ENGINE_CHUNK_SIZE)
            for i in range(0, len(self.cases), step):
                yield CaseChunk(
                    jobs=tuple(
                        Job(case=case, method=method, label=label) for case in self.cases[i : i + step]
                    )
                )

    def describe(self) -> dict[str, Any]:
        """Return cases and methods, for a file; SI units and radians."""
        return {
            "cases": {case.name: describe_case(case) for case in self.cases},
            "methods": [
                method if isinstance(method, str) else {"label": label, **_described(method)}
                for method, label in zip(self.methods, self._labels(), strict=True)
            ],
        }

    def _labels(self) -> list[str]:
        runs = iter(run_labels([method for method in self.methods if isinstance(method, Run)]))
        return [method if isinstance(method, str) else next(runs) for method in self.methods]


def _described(run: Run) -> Mapping[str, Any]:
    return {
        "engine": run.engine,
        "support": run.support,
        "time_step": run.time_step,
        "settings": dict(run.settings),
    }


def _row(job: Job, trace: Any) -> dict[str, Any]:
    cylinder, motion, passes = job.case.cylinder, job.case.motion, trace.passes
    run = None if isinstance(job.method, str) else job.method
    found = {name: getattr(trace, name, "" if name in _WORDS else math.nan) for name in _RESULTS}
    return {
        "case": job.case.name,
        "run": job.label,
        "engine": run.engine if run else "",
        "support": run.support if run else "",
        "time_step": float(getattr(trace, "time_step", math.nan)),
        "semidiagonal": cylinder.semidiagonal,
        "tan_alpha": cylinder.tan_alpha,
        "motion": motion.name if motion else "",
        "peak_tilt_over_alpha": float(trace.peak_tilt) / cylinder.alpha,
        **{name: value if name in _WORDS else float(value) for name, value in found.items()},
        "end": float(trace.time[-1]),
        "passes": len(passes),
        "closest_pass": float(passes["minimum_tilt"].min()) if len(passes) else math.nan,
    }
