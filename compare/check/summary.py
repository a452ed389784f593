"""`rockwobble.check`: the checks of one subject, or of the reduced models and the engines of this machine."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockwobble.models import Case, Suite, Trace, read_suite
from rockwobble.models.case import TimeStep
from rockwobble.models.number_checks import require_one_of
from rockwobble.models.shown import line
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import engine_lack, own_engines, standard_engines

from ..runs.choice import default_runs, require_runnable, runs_here
from ..runs.execution import Job
from ..runs.labels import run_labels
from ..runs.progress import ProgressCallback
from ..storage.provenance import package_versions
from . import subject as subjects
from .agreement import check_suite
from .groups import GROUPS, run_checks
from .own_bounds import SuiteRuns
from .result import Result, not_run
from .subject import TOLERANCE, Subject

if TYPE_CHECKING:
    import pandas as pd

# of an engine that nobody has named: what a version of it may change, in a few seconds
COLUMNS = tuple(Result.__dataclass_fields__)
_OF_ENGINES = ("exact", "conserved", "agreement", "baseline")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Checks:
    """Results of checks.

    Attributes
    ----------
    tables : mapping of str to DataFrame
        "results": one row for each `Result`, its fields as columns.
    facts : mapping
        Subjects, versions of the packages.
    """

    tables: Mapping[str, pd.DataFrame]
    facts: Mapping[str, Any]

    @property
    def results(self) -> list[Result]:
        """The results, in the order in which they were made."""
        return [
            Result(**dict(zip(COLUMNS, row, strict=True)))
            for row in self.tables["results"].itertuples(index=False)
        ]

    @property
    def failures(self) -> list[Result]:
        """The results of the checks that failed."""
        return [result for result in self.results if result.failed]

    @property
    def passed(self) -> bool:
        """Whether no check failed."""
        return not self.failures

    def headline(self) -> Mapping[str, int]:
        """Return the number of checks by their outcome."""
        counts = Counter(self.tables["results"]["outcome"])
        return {name: int(counts[name]) for name in ("FAILED", "passed", "no baseline", "not run")}

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {outcome}" for outcome, count in self.headline().items() if count)
        failed = [f"{each.name} {each.value:.2g} > {each.bound:.2g}" for each in self.failures]
        return line("Checks", [counts, *failed, *self.facts["subjects"]])


def check(
    engine: str | None = None,
    *,
    model: Callable[[Case, str], object] | str | None = None,
    trajectory: Trace | Sequence[Trace] | None = None,
    suite: Suite | str | Path | None = None,
    support: str = "recess",
    tolerance: float = TOLERANCE,
    time_step: TimeStep | None = None,
    only: Sequence[str] | None = None,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    announce: Callable[[str], None] | None = None,
    **settings: Any,
) -> Checks:
    """Check a reduced model, an engine, somebody's model or a trajectory by physics.

    Parameters
    ----------
    engine : str, optional
        Engine that is held to all checks, those of the protocol included. Default, where nothing else is
        given: the reduced models, and what a version may change of the engines that are installed here.
    model : callable or str, optional
        Model of somebody else, or its name as "module:function"; see `external_model`.
    trajectory : Trace or sequence of Trace, optional
        Of `rockwobble.compare.read_trajectory`.
    suite : Suite, str or path, optional
        Suite whose engine runs are compared with the reduced models: by the bounds that it states, or by
        what the time step of each run leaves.
    support : {"recess", "flat"}, optional
        What the model or the trajectory is of.
    tolerance : float, optional
        How exact the model or the trajectory claims to be.
    time_step : float, "auto" or "extrapolated", optional
        Of the engine [s].
    only : sequence of str, optional
        Some of `rockwobble.compare.check.GROUPS`. Default: all.
    workers : int, optional
        Number of processes for the runs of a suite. Default: one for each core.
    progress, announce : callable, optional
        Called at the start and end of each run of the suite; called with the name of each group before it.
    **settings
        Of the engine.

    Returns
    -------
    Checks

    Raises
    ------
    ValueError
        If more than one subject is given, a name is unknown, or an option is out of range.

    Examples
    --------
    >>> import rockwobble as rw
    >>> rw.check(only=["equations"])
    Checks(4 passed, reduced model)
    """
    given = [engine, model, trajectory, suite]
    if sum(each is not None for each in given) > 1:
        raise ValueError("one of engine, model, trajectory and suite may be given, got more")
    if (time_step is not None or settings) and engine is None:
        raise ValueError("time_step and settings belong to an engine, got them alone")
    for group in only or ():
        require_one_of("a group", group, tuple(GROUPS))
    results = list[Result]()
    if suite is not None:
        runs = SuiteRuns(workers=workers, progress=progress)
        results = [*_of_suite(runs, read_suite(suite) if not isinstance(suite, Suite) else suite)]
        return _summed(results)
    if engine is not None:
        chosen = [subjects.engine(engine, time_step, **settings)]
    elif model is not None:
        function = subjects.load_model(model) if isinstance(model, str) else model
        chosen = [subjects.external_model(function, support=support, tolerance=tolerance)]
    elif trajectory is not None:
        traces = [trajectory] if isinstance(trajectory, Trace) else trajectory
        chosen = [subjects.trajectories(traces, support=support, tolerance=tolerance)]
        results = [not_run("all other checks", "one motion does not tell: give a model that can be called")]
    else:
        chosen = _of_this_machine()
        missing = [name for name in standard_engines() if name not in available_engines()]
        results = [not_run(f"checks of {name}", engine_lack(name)) for name in missing]
    for group in (each for each in GROUPS if only is None or each in only):
        if announce is not None:
            announce(group)
        for each in chosen:
            extra = each.label in own_engines() and each.label not in standard_engines()
            if engine is None and each.run is not None and not extra and group not in _OF_ENGINES:
                continue
            results += run_checks(each, [group], extra=extra and engine is None)
    return _summed(results)


def baseline_subjects() -> list[Subject]:
    """Return the subjects whose numbers are kept: the reduced models, and the standard engines."""
    standard = [name for name in standard_engines() if name in available_engines()]
    return [subjects.reduced_model(), *map(subjects.engine, standard)]


def _of_this_machine() -> list[Subject]:
    """Return the reduced models and our engines that are installed here."""
    return [subjects.reduced_model(), *(subjects.engine(name) for name in own_engines())]


def _of_suite(runs: SuiteRuns, suite: Suite) -> Iterator[Result]:
    """Yield the results of each run of each case of a suite."""
    chosen, _ = runs_here(suite.runs or default_runs())
    for case in suite.cases:
        for run in chosen:
            require_runnable(case, run)
    labels = run_labels(chosen)
    jobs = [
        Job(case=case, run=run, label=label)
        for case in suite.cases
        for run, label in zip(chosen, labels, strict=True)
    ]
    for result in check_suite(runs, jobs, suite.bounds):
        yield Result(**{**asdict(result), "group": "agreement"})


def _summed(results: Sequence[Result]) -> Checks:
    import pandas as pd

    rows = [asdict(result) for result in results]
    table = pd.DataFrame(rows, columns=COLUMNS).astype({"value": float, "bound": float})
    labels = dict.fromkeys(result.subject for result in results if result.subject)
    facts = {"subjects": list(labels), "versions": package_versions()}
    return Checks(tables={"results": table}, facts=facts)
