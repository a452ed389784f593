"""A suite: every case with every run, for its numbers without its samples."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from rockwobble.models import Case, Run, Suite, Trace
from rockwobble.models.diagnostic import joined
from rockwobble.models.trace_file import run_to_plain

from ...metrics.tilt import outcome_of
from ...runs.choice import require_runnable
from ...runs.execution import Job, job_fingerprint, run_job
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
    def name(self) -> str:
        """Description of the chunk, for whoever waits."""
        more = f" and {len(self.jobs) - 1} more" if len(self.jobs) > 1 else ""
        return f"{self.jobs[0].name}{more}"

    def key(self) -> str:
        """Return the hash of all that the results depend on."""
        return fingerprint([(job.case.name, job.label, job_fingerprint(job)) for job in self.jobs])

    def run(self) -> dict[str, object]:
        """Return the columns of the results, one row for each run."""
        rows = [_row(job, run_job(job)) for job in self.jobs]
        return {name: [row[name] for row in rows] for name in rows[0]}


def runnable_suite(plan: Suite | Iterable[Case]) -> Suite:
    """Return the suite that is swept: cases alone, and a suite without runs, are run with the recess model.

    Raises
    ------
    ValueError
        If there is no case, two cases or two runs are alike, or an engine cannot run a case.
    """
    suite = plan if isinstance(plan, Suite) else Suite(plan, ())
    if not suite.runs:
        suite = Suite(suite.cases, (Run(None, "recess"),), suite.bounds)
    run_labels(suite.runs)
    for run in suite.runs:
        for case in suite.cases:
            require_runnable(case, run)
    return suite


def chunks_of(suite: Suite, size: int | None = None) -> Iterator[CaseChunk]:
    """Cut the runs of a suite into chunks, in the order of the table: method by method."""
    for run, label in zip(suite.runs, run_labels(suite.runs), strict=True):
        step = size or (_ENGINE_CHUNK_SIZE if run.engine else _REDUCED_CHUNK_SIZE)
        for i in range(0, len(suite.cases), step):
            yield CaseChunk(
                jobs=tuple(Job(case=case, run=run, label=label) for case in suite.cases[i : i + step])
            )


def describe_suite(suite: Suite) -> dict[str, object]:
    """Return cases and runs, for a file; SI units and radians."""
    return {
        "plan": "cases and runs",
        "runs": len(suite.cases) * len(suite.runs),
        "cases": {case.name: _described(case) for case in suite.cases},
        "runs of each": [
            {"label": label, **run_to_plain(run)}
            for run, label in zip(suite.runs, run_labels(suite.runs), strict=True)
        ],
    }


def _described(case: Case) -> dict[str, object]:
    """Return the numbers that state a case; SI units and radians."""
    cylinder, motion, initial = case.cylinder, case.motion, case.initial
    return {
        "semidiagonal": cylinder.semidiagonal,
        "tan_alpha": cylinder.tan_alpha,
        "alpha": cylinder.alpha,
        "base_radius": cylinder.base_radius,
        "height": 2.0 * cylinder.half_height,
        "duration": case.length,
        "gravity": case.gravity,
        "friction": case.friction,
        "rolling_resistance": case.rolling_resistance,
        "motion": None
        if motion is None
        else {
            "name": motion.name,
            "time_step": motion.time_step,
            "samples": len(motion.acceleration),
            "components": int(motion.acceleration.shape[1]),
            "peak": motion.peak,
        },
        "initial": None
        if initial is None
        else {
            "tilt": initial.tilt,
            "tilt_rate": initial.tilt_rate,
            "rolling_angle": initial.rolling_angle,
            "rolling_rate": initial.rolling_rate,
        },
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
        "outcome": outcome_of(trace),
        "diagnostics": joined(fact.code for fact in trace.facts),
        "version": trace.version,
        "end": float(trace.time[-1]),
        "passes": len(passes),
        "closest_pass": float(passes["minimum_tilt"].min()) if len(passes) else math.nan,
    }
