"""Sweeps: many runs, of a grid or a suite, in cached chunks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from numbers import Integral
from pathlib import Path
from typing import ClassVar

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.pair import outcome_of
from rockwobble.compare.metrics.statistics import value_if_enough
from rockwobble.compare.runs.choice import require_runnable, run_labels
from rockwobble.compare.runs.execution import Job, all_makers, jobs_fingerprint, run_job
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.provenance import fingerprint
from rockwobble.compare.storage.results import Results
from rockwobble.models import Case, GroundMotion, Suite, Trace
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.case import RECESS_MODEL
from rockwobble.models.diagnostic import cell_of
from rockwobble.models.doubts import doubts_of_cases
from rockwobble.models.finding import Finding, Findings, Value
from rockwobble.models.ground_motion import sources_of
from rockwobble.models.number_checks import require_in_range
from rockwobble.models.plain_json import fields_of, plain
from rockwobble.models.trace_file import case_facts

from .grid import Grid, GridChunk
from .study import Study

# An engine's run takes seconds, a reduced one milliseconds.
_REDUCED_CHUNK_SIZE, _ENGINE_CHUNK_SIZE = 200, 1
# without the computing time: sweeps of equal runs have equal tables
_RESULTS = (
    *("peak_tilt", "uplift_time", "uplift_direction"),
    *("contact_resolution", "residual_displacement", "residual_twist"),
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CaseChunk:
    """Some cases with one method; `run` solves them."""

    jobs: tuple[Job, ...]

    @property
    def name(self) -> str:
        """Description of the chunk, for the progress callback."""
        more = f" and {len(self.jobs) - 1} more" if len(self.jobs) > 1 else ""
        return f"{self.jobs[0].name}{more}"

    def key(self) -> str:
        """Hash that identifies the results."""
        return jobs_fingerprint(self.jobs)

    def run(self) -> pd.DataFrame:
        """Table of the results, one row for each run."""
        return pd.DataFrame([_row(job, run_job(job)) for job in self.jobs])


def runnable_suite(plan: Suite | Iterable[Case]) -> Suite:
    """Suite to sweep; without runs, its cases are run with the recess model.

    Raises
    ------
    ValueError
        If there is no case, two cases or two runs are alike, or an engine cannot run a case.
    """
    suite = plan if isinstance(plan, Suite) else Suite(plan, ())
    if not suite.runs:
        suite = Suite(suite.cases, (RECESS_MODEL,), suite.bounds)
    run_labels(suite.runs)
    for run in suite.runs:
        for case in suite.cases:
            require_runnable(case, run)
    return suite


def chunks_of(suite: Suite, size: int | None = None) -> Iterator[CaseChunk]:
    """Chunks of the runs of a suite, in the order of the table: method by method."""
    for run, label in zip(suite.runs, run_labels(suite.runs), strict=True):
        step = size or (_REDUCED_CHUNK_SIZE if run.is_model else _ENGINE_CHUNK_SIZE)
        jobs = [Job(case=case, run=run, label=label) for case in suite.cases]
        for i in range(0, len(jobs), step):
            yield CaseChunk(jobs=tuple(jobs[i : i + step]))


def describe_suite(suite: Suite) -> dict[str, object]:
    """Return cases and runs, for a file; SI units and radians."""
    return {
        "plan": "cases and runs",
        "runs": len(suite.cases) * len(suite.runs),
        "cases": {case.name: case_facts(case) | {"duration": case.length} for case in suite.cases},
        "runs of each": [
            {"label": label, **fields_of(run)}
            for run, label in zip(suite.runs, run_labels(suite.runs), strict=True)
        ],
    }


def _row(job: Job, trace: Trace) -> dict[str, object]:
    cylinder, motion, passes = job.case.cylinder, job.case.motion, trace.passes
    return {
        "case": job.case.name,
        "run": job.label,
        "engine": job.run.engine_name,
        "support": job.run.support,
        "time_step": trace.time_step,
        "semidiagonal": cylinder.semidiagonal,
        "tan_alpha": cylinder.tan_alpha,
        "motion": motion.name if motion else "",
        "peak_tilt_over_alpha": float(trace.peak_tilt) / cylinder.alpha,
        **{name: float(getattr(trace, name)) for name in _RESULTS},
        "outcome": outcome_of(trace),
        "diagnostics": cell_of(fact.code for fact in trace.facts),
        "version": trace.version,
        "end": float(trace.time[-1]),
        "passes": len(passes),
        "closest_pass": float(passes["minimum_tilt"].min()) if len(passes) else math.nan,
    }


KIND = "sweep"
_OUTCOMES = ("stands", "overturned", "undecided", "failed")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Sweep(Results, kind=KIND):
    """Outcome and numbers of each run.

    Attributes
    ----------
    sweep : DataFrame
        One row for each run, in the order of the plan; `table`, too.
    motions : DataFrame
        Of a grid the samples of its ground motions.

    Its facts are the plan: its kind, the number of runs, and the axes of a grid or its cases and methods.
    """

    @property
    def table(self) -> pd.DataFrame:
        """One row for each run, in the order of the plan."""
        return self.tables[KIND]

    def headline(self) -> dict[str, Number]:
        """Number of runs, and of runs by outcome."""
        outcome = self.table["outcome"]
        return {"runs": len(outcome), **{name: int((outcome == name).sum()) for name in self.outcomes}}

    def findings(self) -> Findings:
        """Findings: what was run, and the number of runs by outcome."""
        plan = self.facts
        values: dict[str, Value] = {"runs": len(self.table)}
        if of_grid := "model" in self.table:
            for name, axis in (("length", "semidiagonals"), ("ratio", "tan_alphas"), ("factor", "scales")):
                values |= {f"count_{name}": len(plan[axis]), name: min(plan[axis])}
                values[f"{name}_end"] = max(plan[axis])
            values |= {"count_motions": len(plan["motions"]), "names": tuple(plan["models"])}
        else:
            values |= {"count": len(plan["cases"]), "count_of_each": len(plan["runs of each"])}
        ended = {f"count_{name}": value for name, value in self.headline().items() if name != "runs"}
        swept = Finding(key="sweep.grid" if of_grid else "sweep.cases", values=values)
        return Findings([swept, Finding(key="sweep.ended", values=ended)])

    @property
    def keys(self) -> list[str]:
        """Columns that distinguish the parts of the sweep in `summary` and figures."""
        return ["motion", "model", "tan_alpha"] if "model" in self.table else ["run"]

    @property
    def outcomes(self) -> list[str]:
        """All outcomes that occur."""
        entries = set(self.table["outcome"])
        return [name for name in _OUTCOMES if name in entries]

    def summary(self) -> pd.DataFrame:
        """One row per part: runs by outcome, and their peak tilts.

        Columns: `keys`, runs, a count for each outcome that there is, no_uplift (how many of them stood still
        throughout), and in alpha median, in which an overturned run is infinite, NaN of fewer than six, and
        largest, of those that do not overturn.
        """
        rows = []
        for key, own in self.table.groupby(self.keys, sort=False):
            fell, peaks = own["outcome"] == "overturned", own["peak_tilt_over_alpha"]
            median = peaks.mask(fell, math.inf).median()
            rows.append(
                {
                    **dict(zip(self.keys, key, strict=True)),
                    "runs": len(own),
                    **{name: int((own["outcome"] == name).sum()) for name in self.outcomes},
                    "no_uplift": int((peaks == 0.0).sum()),
                    "median": value_if_enough(median, int(peaks.notna().sum())),
                    "largest": peaks[~fell].max(),
                }
            )
        return pd.DataFrame(rows)


Chunk = GridChunk | CaseChunk


@with_argument_kinds
def sweep(
    plan: Grid | Suite | Iterable[Case],
    *,
    out: str | Path | None = None,
    scheduler: str | None = None,
    workers: int | None = None,
    chunk_size: int | None = None,
    progress: ProgressCallback | None = None,
) -> Sweep:
    """Run every combination, and return a tidy table of the outcomes.

    The runs are cut into chunks. With `out` each chunk is kept there as soon as it is finished, named by
    a hash of its inputs, the versions and the code; a second call, after whatever ended the first, repeats
    none that is there. The table has the same bits whatever the number of workers, the chunks, and
    where they ran.

    Parameters
    ----------
    plan : Grid, Suite or iterable of Case
        A grid of peak tilts; every case of a suite with each of its runs; cases alone are run with the recess
        model.
    out : str or Path, optional
        Folder of the sweep: sweep.parquet is the table, motions.parquet the ground motions of a grid. The
        chunks of another sweep stay there until this one is complete.
    scheduler : str, optional
        Address of a Dask scheduler, such as `tcp://10.0.0.1:8786`; its workers must have the same
        versions. Default: processes on this machine.
    workers : int, optional
        Number of those processes; 1 runs everything in this one. Default: one for each processor.
    chunk_size : int, optional
        Runs in a chunk. Default: about a second of computing. The hash of a chunk depends on it.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each chunk.

    Returns
    -------
    Sweep

    Raises
    ------
    ValueError
        If the plan, the folder or the scheduler is not usable.
    IncompleteError
        If chunks could not be finished because their processes died, or the Dask cluster cannot do them.

    Examples
    --------
    >>> from rockwobble.models import el_centro_1940
    >>> grid = Grid(semidiagonals=[2.0, 6.0], tan_alphas=[0.2], scales=[1.0, 3.0], motions=[el_centro_1940()])
    >>> swept = sweep(grid, workers=1)
    >>> swept
    Sweep(runs 4, stands 2, overturned 2)
    >>> swept.table[["semidiagonal", "scale", "outcome"]].values.tolist()
    [[2.0, 1.0, 'stands'], [2.0, 3.0, 'overturned'], [6.0, 1.0, 'stands'], [6.0, 3.0, 'overturned']]

    Every case of a suite with each of its runs:

    >>> from rockwobble.models import Cylinder, InitialState, Run
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> case = Case(pier, initial=InitialState(0.5 * pier.alpha, rolling_rate=0.5), duration=4.0)
    >>> sweep(Suite([case], [Run(None, "recess"), Run(None, "flat")]), workers=1)
    Sweep(runs 2, stands 2)
    """
    whole = plan if isinstance(plan, Grid) else runnable_suite(plan)
    if chunk_size is not None:
        require_in_range("chunk_size", chunk_size, Integral, least=1)
    cut = whole.chunks(chunk_size) if isinstance(whole, Grid) else chunks_of(whole, chunk_size)
    return SweepStudy(whole, list(cut)).run(
        folder=out,
        workers=workers,
        scheduler=scheduler,
        progress=progress,
        save=None if out is None else lambda swept: swept.save(out),
    )


@dataclass(frozen=True, slots=True)
class SweepStudy(Study[Chunk, Sweep]):
    """All runs of a grid or of a suite, in chunks."""

    kind: ClassVar[str] = KIND
    what: ClassVar[str] = "chunks"
    tries: ClassVar[int] = 3
    plan: Grid | Suite
    chunks: Sequence[Chunk]

    def tasks(self) -> Sequence[Chunk]:
        """Chunks."""
        return self.chunks

    def key(self, task: Chunk) -> str:
        """Hash of the inputs of a chunk."""
        return task.key()

    def makers(self) -> Mapping[str, str]:
        """Versions and code of the methods."""
        return all_makers(() if isinstance(self.plan, Grid) else self.plan.runs)

    def results(self, tables: list[pd.DataFrame]) -> Sweep:
        """Sweep of the tables of all chunks."""
        plan, rows = self.plan, {KIND: pd.concat(tables, ignore_index=True)}
        if isinstance(plan, Grid):
            stated, doubts, motions = plan.describe(), plan.doubts(), list(plan.motions)
            rows["motions"] = _samples(motions)
        else:
            stated, doubts = describe_suite(plan), doubts_of_cases(plan.cases)
            motions = [case.motion for case in plan.cases if case.motion is not None]
        inputs = fingerprint([chunk.key() for chunk in self.chunks])
        facts = {**stated, "doubts": doubts, "record_sources": sources_of(motions), "inputs": inputs}
        return Sweep(tables=rows, facts=plain(facts))


def _samples(motions: Iterable[GroundMotion]) -> pd.DataFrame:
    """Table of the motions of a grid; a missing component is NaN, not zero."""
    columns = ["motion", "time", *(f"acceleration_{axis}" for axis in "xyz")]
    tables = []
    for motion in motions:
        time = np.arange(len(motion.acceleration)) * motion.time_step
        values = [motion.name or "record", time, *motion.acceleration.T]
        tables.append(pd.DataFrame(dict(zip(columns, values, strict=False))))
    return pd.concat(tables, ignore_index=True).reindex(columns=columns)
