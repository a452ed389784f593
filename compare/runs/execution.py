"""Runs of a case by a reduced model or an engine, and tables of tasks, each stored when it is finished."""

from __future__ import annotations

import dataclasses
import inspect
import math
from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rockwobble.models import Case, Run, Trace
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.case import TimeStep
from rockwobble.models.shown import CompactRepr
from rockwobble.models.support import RECESS
from rockwobble.models.trace import lost_trace
from rockwobble.models.trace_file import pack, read
from rockwobble.multibody.engines.registry import engine_facts
from rockwobble.multibody.extrapolated_step import FINEST
from rockwobble.multibody.scene import REFERENCE_TIME_STEP, froude_scale

from ..storage.provenance import engine_makers, fingerprint, reduced_makers, result_fingerprint
from .cache import Cache, open_cache
from .progress import FailedTask, ProgressCallback
from .scheduler import run_tasks

SAMPLE_STEP = 0.01
# steps [s] at the reference size: the usual search ends at half of the default step
_EQUAL_STEPS: dict[str | None, float] = {"auto": 2.5e-5, "extrapolated": FINEST / 1.75}


_FEW = 16  # largest number of runs of reduced models that take less time than to start a process


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Job(CompactRepr):
    """One run of one case.

    Parameters
    ----------
    case : Case
    run : Run
    label : str, optional
        For tables and figures, different for each job of a case. Default: engine and support.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> Job(case=case, run=rw.Run("mujoco", "recess")).label
    'mujoco recess'
    """

    case: Case
    run: Run
    label: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "label", self.label or str(self.run))

    @property
    def name(self) -> str:
        """Case and label, for the progress callback."""
        return f"{self.case.name}, {self.label}"


@with_argument_kinds
def simulate(
    case: Case,
    *,
    support: str = RECESS,
    engine: str | None = None,
    time_step: TimeStep = None,
    sample_step: float = SAMPLE_STEP,
    **settings: object,
) -> Trace:
    """Run a case in a reduced model or an engine.

    Parameters
    ----------
    case : Case
    support : {"recess", "flat", "ring"}, optional
    engine : str, optional
        Such as "mujoco" or "pybullet". Default: the reduced model.
    time_step : float, "auto" or "extrapolated", optional
        Time step of an engine [s].
    sample_step : float, optional
        Spacing of the samples [s].
    **settings
        Of `reduced.simulate` or `multibody.simulate`.

    Returns
    -------
    Trace

    Raises
    ------
    ValueError
        If the engine or the support is unknown, or a setting is unknown or out of range.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(tilt=0.5 * pier.alpha, rolling_rate=0.5)
    >>> rw.simulate(rw.Case(pier, initial=release, duration=2.0), support="flat").outcome
    'stands'
    """
    return simulate_run(case, Run(engine, support, time_step, **settings), sample_step=sample_step)


def simulate_run(case: Case, run: Run, *, sample_step: float = SAMPLE_STEP) -> Trace:
    """Run a reduced model or an engine on a case, by the settings of `run`.

    Raises
    ------
    ValueError
        What `reduced.simulate` or `multibody.simulate` raises.
    """
    if run.is_model:
        from rockwobble import reduced

        if run.time_step is not None:
            raise ValueError(f"a reduced model has no time_step, but a tolerance rtol, got {run.time_step!r}")
        known = _model_settings()
        for name in run.settings.keys() - known:
            raise ValueError(f"a reduced model has the settings {', '.join(sorted(known))}, got {name!r}")
        trace = reduced.simulate(case, support=run.support, sample_step=sample_step, **run.settings)
        _ = trace.late  # computed here, so that it is pickled with the trace
        return trace
    from rockwobble import multibody

    return multibody.simulate(
        case,
        engine=run.engine_name,
        support=run.support,
        time_step=run.time_step,
        sample_step=sample_step,
        **run.settings,
    )


@cache  # the signature takes a twentieth of a run of a millisecond
def _model_settings() -> frozenset[str]:
    from rockwobble import reduced

    return frozenset(inspect.signature(reduced.simulate).parameters) - {"case", "support", "sample_step"}


def run_job(job: Job) -> Trace:
    """Run one job in this process."""
    return simulate_run(job.case, job.run)


def simulate_all(
    jobs: Sequence[Job],
    *,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    cache: Cache[Job, Trace] | None = None,
) -> list[Trace]:
    """Traces of all jobs, in their order.

    Parameters
    ----------
    jobs : sequence of Job
    workers, progress, cache : optional
        See `run_tasks`.

    Returns
    -------
    list of Trace
        One whose process died has no samples, the outcome "failed" and the diagnostic "died".

    Raises
    ------
    ValueError
        What a job raises for bad input; the other jobs are given up.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> jobs = [Job(case=case, run=rw.Run(None, "recess")), Job(case=case, run=rw.Run(None, "flat"))]
    >>> [trace.outcome for trace in simulate_all(jobs, workers=1)]
    ['stands', 'stands']
    """
    traces = run_tasks(
        run_job,
        jobs,
        workers=workers,
        cost=job_time,
        label=lambda job: job.name,
        progress=progress,
        cache=cache,
        here=brief_among(jobs),
    )
    return [
        lost_trace(job.case, job.run, result.why) if isinstance(result, FailedTask) else result
        for job, result in zip(jobs, traces, strict=True)
    ]


def job_time(job: Job) -> float:
    """Rough computing time of a job [s]; infinite for a reduced model, which may need compilation."""
    return math.inf if job.run.is_model else engine_time(job.case, job.run)


def brief_among(jobs: Iterable[Job]) -> Callable[[Job], bool]:
    """Predicate of jobs that take less time than to start a process, as one of few of reduced models."""
    few = sum(job.run.is_model for job in jobs) <= _FEW
    return lambda job: few and _is_compiled(job)


def _is_compiled(job: Job) -> bool:
    """Whether a run takes milliseconds: that of a reduced model whose code is on disk."""
    if not job.run.is_model:
        return False
    from rockwobble.reduced.problem import Problem
    from rockwobble.reduced.simulation import is_compiled

    return is_compiled(Problem(job.case, **job.run.settings, support=job.run.support).kernel)


def open_trace_cache(folder: str | Path, kind: str) -> AbstractContextManager[Cache[Job, Trace]]:
    """Open the finished runs in a folder of results, see `open_cache`."""

    def to_bytes(job: Job, trace: Trace) -> bytes:
        about = {"kind": "run", "case": job.case.name, "label": job.label, "trace": trace.to_plain()}
        return pack(trace.to_frame(), about)

    def from_bytes(job: Job, content: bytes) -> Trace:
        table, about = read(content)
        return dataclasses.replace(Trace.from_plain(about["trace"], table, job.case), run=job.run)

    return open_cache(folder, kind, name=job_fingerprint, pack=to_bytes, unpack=from_bytes)


def equal_step(case: Case, run: Run) -> float:
    """Time step of a single run of an engine with the computing time of `run` [s]."""
    unit_time = froude_scale(case.cylinder.semidiagonal, case.gravity).time
    if isinstance(run.time_step, float):
        return run.time_step
    return unit_time * _EQUAL_STEPS.get(run.time_step, REFERENCE_TIME_STEP)


def engine_time(case: Case, run: Run) -> float:
    """Rough computing time of a run of an engine [s]."""
    return case.length / equal_step(case, run) * engine_facts(run.engine_name).step_time


def makers_of(run: Run) -> dict[str, str]:
    """Versions and code on which a run depends."""
    return reduced_makers() if run.is_model else engine_makers(run.engine_name)


def all_makers(runs: Iterable[Run]) -> dict[str, str]:
    """Versions and code on which any of the runs depends; without runs, those of the reduced models."""
    engines = sorted({run.engine_name for run in runs if not run.is_model})
    return reduced_makers() | (engine_makers(*engines) if engines else {})


def job_fingerprint(job: Job) -> str:
    """Hash that identifies the result of a job."""
    own = {"method": job.run, "sample step": SAMPLE_STEP}
    return result_fingerprint(case_inputs(job.case) | own, makers_of(job.run))


def jobs_fingerprint(jobs: Iterable[Job]) -> str:
    """Hash that identifies the results of jobs in a table, which holds their names."""
    return fingerprint([(job.case.name, job.label, job_fingerprint(job)) for job in jobs])


def case_inputs(case: Case) -> dict[str, object]:
    """Inputs on which runs of a case depend, without its name and that of its motion."""
    motion = case.motion
    # runs without extra terms have the same hash as before terms existed
    return case.terms | {
        "cylinder": case.cylinder,
        "motion": None if motion is None else (motion.acceleration, motion.time_step),
        "initial": case.initial,
        "length": case.length,
        "gravity": case.gravity,
        "friction": case.friction,
    }
