"""What is checked: the reduced models, the suite, and the engines with their settings."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from rockwobble.models import Case, Run, Suite

from ..execution import Crash, Job, ProgressCallback, simulate_all
from ..runs import run_labels


def _as_given(run: Run) -> Run:
    return run


@dataclass(slots=True, kw_only=True)
class Bench:
    """What the checks are made on; engine runs are made once and kept for the checks that follow.

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
    """

    reduced: Any
    suite: Suite
    shipped: bool = True
    adjust: Callable[[Run], Run] = _as_given
    workers: int | None = None
    progress: ProgressCallback | None = None
    _kept: dict[tuple[int, int], Any] = field(default_factory=dict)

    def rows(self) -> Iterator[tuple[Case, Run, str, Any]]:
        """Yield case, run, label and trajectory (or Crash) of every run of the suite."""
        labels = run_labels(self.suite.runs)
        pairs = [(i, j) for i in range(len(self.suite.cases)) for j in range(len(self.suite.runs))]
        missing = [pair for pair in pairs if pair not in self._kept]
        jobs = [(self.suite.cases[i], self.adjust(self.suite.runs[j]), labels[j]) for i, j in missing]
        self._kept.update(zip(missing, self.engine_runs(jobs), strict=True))
        for i, j in pairs:
            yield self.suite.cases[i], self.suite.runs[j], labels[j], self._kept[i, j]

    def engine_runs(self, wanted: Sequence[tuple[Case, Run, str]]) -> list[Any]:
        """Return the trajectory, or the Crash, of each case and run, labelled for the progress."""
        jobs = [Job(case=case, method=run, label=label) for case, run, label in wanted]
        return simulate_all(jobs, workers=self.workers, progress=self.progress)

    def response(self, case: Case, model: str, **options: Any) -> Any:
        """Return the response of a reduced model to a case, with the samples of an engine run."""
        return self.reduced.simulate(
            case.cylinder,
            case.motion,
            initial=case.initial,
            duration=case.duration,
            gravity=case.gravity,
            model=model,
            **options,
        )


def crashed(trajectory: Any) -> bool:
    """Return whether an engine left no trajectory, or one that it had to give up."""
    return isinstance(trajectory, Crash) or trajectory.outcome == "failed"
