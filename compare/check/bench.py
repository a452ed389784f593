"""Subjects of the checks: the reduced models, the suite, and the engines with their settings."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Run, Suite, Trace
from rockwobble.models.shown import Brief
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import engine_lack, own_engines, standard_engines

from ..runs.execution import Job, simulate_all
from ..runs.labels import run_labels
from ..runs.progress import ProgressCallback
from ..storage.fingerprint import fingerprint
from .finding import Finding, not_run

Array = NDArray[np.float64]

# the engines that every installation is meant to have, and whose accuracy at the default step is known
ENGINES = standard_engines()


def _as_given(run: Run) -> Run:
    return run


@dataclass(slots=True, kw_only=True, repr=False)
class Bench(Brief):
    """Subjects of the checks; engine runs are made once and kept for the checks that follow.

    Parameters
    ----------
    reduced : module
        The package of the reduced models: `rockwobble.reduced`, or a copy of it with a fault.
    suite : Suite
        Its engine runs are held against the reduced models.
    shipped : bool
        Whether that is the suite "quick", for which baselines are kept.
    adjust : callable
        Returns a run with its settings changed: how a fault gets into the settings of an engine.
    workers : int, optional
        Number of processes for engines. Default: one for each core.
    progress : callable, optional
        Told of the start and the end of each engine run.
    kept : dict, optional
        Engine runs that were made; may be shared by benches.
    engines : sequence of str, optional
        Those of `ENGINES` that the checks run beside the suite, where they are installed. Default: all.
    """

    reduced: Any
    suite: Suite
    shipped: bool = True
    adjust: Callable[[Run], Run] = _as_given
    workers: int | None = None
    progress: ProgressCallback | None = None
    kept: dict[str, Trace] = field(default_factory=dict)
    engines: Sequence[str] = field(default_factory=lambda: ENGINES)

    def further_engines(self) -> tuple[str, ...]:
        """Return our other engines that are installed here; none where `engines` are not all the standard."""
        standard = standard_engines()
        if tuple(self.engines) != standard:
            return ()
        return tuple(name for name in own_engines() if name not in standard)

    def jobs(self) -> list[Job]:
        """Return every run of the suite, labelled as in tables."""
        labels = run_labels(self.suite.runs)
        return [
            Job(case=case, run=self.adjust(run), label=label)
            for case in self.suite.cases
            for run, label in zip(self.suite.runs, labels, strict=True)
        ]

    def traces(self, jobs: Sequence[Job]) -> list[Trace]:
        """Return the trace of each job."""
        keys = [fingerprint([job.case, job.run]) for job in jobs]
        missing = {key: job for key, job in zip(keys, jobs, strict=True) if key not in self.kept}
        made = simulate_all(list(missing.values()), workers=self.workers, progress=self.progress)
        self.kept.update(zip(missing, made, strict=True))
        return [self.kept[key] for key in keys]

    def solve(self, case: Case, model: str = "recess", **options: Any) -> Trace:
        """Return the trace of a reduced model: "recess", "flat" or "planar"."""
        model_options = {"plane": 0.0} if model == "planar" else {"support": model}
        trace: Trace = self.reduced.simulate(case, **{**model_options, **options})
        return trace


def engines_here(among: Sequence[str] | None = None) -> tuple[str, ...]:
    """Return those of some engines, or of `ENGINES`, that are installed."""
    return tuple(name for name in (ENGINES if among is None else among) if name in available_engines())


def not_here(what: str, engines: Sequence[str]) -> Iterator[Finding]:
    """Yield for each of some engines that is not installed that `what` was not checked with it."""
    for name in engines:
        if name not in engines_here(engines):
            yield not_run(f"{what}, {name}", name, f"{name} {engine_lack(name)}")


def why(trace: Trace) -> str:
    """Return what ended a run, for a note."""
    return "; ".join(f"{fact.meaning} {fact.detail}".strip() for fact in trace.facts)


def largest(values: Array) -> float:
    """Return the largest size of values of any shape; NaN of none."""
    return float(np.abs(values).max()) if np.size(values) else math.nan


def tilts_apart(one: Trace, other: Trace) -> float:
    """Return the largest difference of two tilts [alpha]; infinite where one ended earlier."""
    if len(one.tilt) != len(other.tilt):
        return math.inf
    return largest(one.tilt - other.tilt) / one.case.cylinder.alpha
