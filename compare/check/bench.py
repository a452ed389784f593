"""What is checked: the reduced models, the suite, and the engines with their settings."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from rockwobble.models import Case, Run, Suite
from rockwobble.multibody.engines.registry import standard_engines

from ..runs.choice import installed_engines, run_labels
from ..runs.execution import Crash, Job, ProgressCallback, simulate_all
from ..storage.fingerprint import fingerprint
from .finding import Finding, not_run

ENGINES = standard_engines()


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
    kept : dict, optional
        Engine runs that were made; may be shared by benches.
    """

    reduced: Any
    suite: Suite
    shipped: bool = True
    adjust: Callable[[Run], Run] = _as_given
    workers: int | None = None
    progress: ProgressCallback | None = None
    kept: dict[str, Any] = field(default_factory=dict)

    def rows(self) -> Iterator[tuple[Case, Run, str, Any]]:
        """Yield case, run, label and trajectory (or Crash) of every run of the suite."""
        labels = run_labels(self.suite.runs)
        wanted = [
            (case, run, label)
            for case in self.suite.cases
            for run, label in zip(self.suite.runs, labels, strict=True)
        ]
        found = self.engine_runs([(case, self.adjust(run), label) for case, run, label in wanted])
        for (case, run, label), trajectory in zip(wanted, found, strict=True):
            yield case, run, label, trajectory

    def engine_runs(self, wanted: Sequence[tuple[Case, Run, str]]) -> list[Any]:
        """Return the trajectory, or the Crash, of each case and run, labelled for the progress."""
        keys = [fingerprint([case, run]) for case, run, _ in wanted]
        missing = {key: each for key, each in zip(keys, wanted, strict=True) if key not in self.kept}
        jobs = [Job(case=case, method=run, label=label) for case, run, label in missing.values()]
        found = simulate_all(jobs, workers=self.workers, progress=self.progress)
        self.kept.update(zip(missing, found, strict=True))
        return [self.kept[key] for key in keys]

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


def engines_here() -> tuple[str, ...]:
    """Return those of `ENGINES` that are installed."""
    return tuple(name for name in ENGINES if name in installed_engines())


def not_here(layer: str, what: str) -> Iterator[Finding]:
    """Yield for each of `ENGINES` that is not installed that `what` was not checked with it."""
    for name in ENGINES:
        if name not in engines_here():
            yield not_run(layer, f"{what}, {name}", part=name, note=f"{name} is not installed here")


def crashed(trajectory: Any) -> bool:
    """Return whether an engine left no trajectory, or one that it had to give up."""
    return isinstance(trajectory, Crash) or trajectory.outcome == "failed"
