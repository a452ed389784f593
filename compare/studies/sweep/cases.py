"""Cases times methods, each run for its numbers without its samples."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from rockwobble.models import Case, Run, Trace
from rockwobble.models.diagnostic import joined
from rockwobble.models.shown import Brief
from rockwobble.models.traces.trace_file import run_to_plain

from ...comparison.result import describe_case
from ...runs.choice import require_runnable
from ...runs.execution import Job, job_fingerprint, makers_of, run_job
from ...runs.labels import REDUCED, run_labels
from ...storage.fingerprint import fingerprint

# An engine's run takes seconds, a reduced one milliseconds.
_REDUCED_CHUNK_SIZE, _ENGINE_CHUNK_SIZE = 200, 1
# not the computing time: the table of two sweeps of the same runs is the same
_RESULTS = (
    "peak_tilt",
    "uplift_time",
    "uplift_direction",
    "contact_resolution",
    "residual_displacement",
    "residual_twist",
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CaseChunk:
    """Some cases with one method; `run` solves them."""

    jobs: tuple[Job, ...]

    @property
    def rows(self) -> int:
        """Number of runs."""
        return len(self.jobs)

    @property
    def name(self) -> str:
        """Description of the chunk, for whoever waits."""
        more = f" and {self.rows - 1} more" if self.rows > 1 else ""
        return f"{self.jobs[0].name}{more}"

    @property
    def makers(self) -> dict[str, str]:
        """Versions and code on which the results depend."""
        return makers_of(self.jobs[0])

    def key(self) -> str:
        """Return the hash of all that the results depend on."""
        return fingerprint([(job.case.name, job.label, job_fingerprint(job)) for job in self.jobs])

    def run(self) -> dict[str, object]:
        """Return the columns of the results, one row for each run."""
        rows = [_row(job, run_job(job)) for job in self.jobs]
        return {name: [row[name] for row in rows] for name in rows[0]}


@dataclass(frozen=True, slots=True, eq=False, init=False, repr=False)
class CaseSweep(Brief):
    """Every case with every method: runs of engines, and reduced models by name.

    Parameters
    ----------
    cases : iterable of Case
        With different names.
    runs : iterable of Run

    Raises
    ------
    ValueError
        If there is no case or no method, two are alike, or an engine cannot run a case.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> found = rw.sweep(CaseSweep([case], [rw.Run(None, "recess"), rw.Run(None, "flat")]), workers=1)
    >>> list(found.table["outcome"])
    ['completed', 'completed']
    """

    cases: tuple[Case, ...]
    runs: tuple[Run, ...]

    def __init__(self, cases: Iterable[Case], runs: Iterable[Run]) -> None:
        object.__setattr__(self, "cases", tuple(cases))
        object.__setattr__(self, "runs", tuple(runs))
        names = [case.name for case in self.cases]
        if not names or not self.runs:
            raise ValueError("a sweep must have at least one case and one run")
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"the cases of a sweep must differ, got {name!r} twice")
        run_labels(self.runs)
        for run in self.runs:
            for case in self.cases:
                require_runnable(case, run)

    @property
    def rows(self) -> int:
        """Number of runs."""
        return len(self.cases) * len(self.runs)

    @property
    def kind(self) -> str:
        """Kind of the sweep, for people."""
        return "cases and runs"

    def chunks(self, size: int | None = None) -> Iterator[CaseChunk]:
        """Cut the runs into chunks, in the order of the table: method by method."""
        for run, label in zip(self.runs, run_labels(self.runs), strict=True):
            step = size or (_ENGINE_CHUNK_SIZE if run.engine else _REDUCED_CHUNK_SIZE)
            for i in range(0, len(self.cases), step):
                yield CaseChunk(
                    jobs=tuple(Job(case=case, run=run, label=label) for case in self.cases[i : i + step])
                )

    def describe(self) -> dict[str, object]:
        """Return cases and methods, for a file; SI units and radians."""
        return {
            "cases": {case.name: describe_case(case) for case in self.cases},
            "runs of each": [
                {"label": label, **run_to_plain(run)}
                for run, label in zip(self.runs, run_labels(self.runs), strict=True)
            ],
        }


def _row(job: Job, trace: Trace) -> dict[str, object]:
    cylinder, motion, passes = job.case.cylinder, job.case.motion, trace.passes
    return {
        "case": job.case.name,
        "run": job.label,
        "engine": job.run.engine or REDUCED,
        "support": job.run.support,
        "time_step": trace.time_step,
        "semidiagonal": cylinder.semidiagonal,
        "tan_alpha": cylinder.tan_alpha,
        "motion": motion.name if motion else "",
        "peak_tilt_over_alpha": float(trace.peak_tilt) / cylinder.alpha,
        **{name: float(getattr(trace, name)) for name in _RESULTS},
        "outcome": trace.outcome,
        "diagnostics": joined(fact.code for fact in trace.facts),
        "version": trace.version,
        "end": float(trace.time[-1]),
        "passes": len(passes),
        "closest_pass": float(passes["minimum_tilt"].min()) if len(passes) else math.nan,
    }
