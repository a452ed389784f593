"""`rockwobble.check`: the physical checks in groups, and their subjects.

What comes later in the list rests on what comes earlier.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Self

from rockwobble import reduced
from rockwobble.models import Case, Suite, Trace, read_suite
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.case import TimeStep
from rockwobble.models.finding import Finding, Findings
from rockwobble.models.number_checks import require_one_of
from rockwobble.models.shown import line
from rockwobble.models.support import MODELLED, RECESS, RING, SUPPORTS
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import engine_fault, engine_packages, own_engines, standard_engines

from ..runs.choice import default_runs, require_runnable, run_labels, runs_here
from ..runs.execution import Job
from ..runs.progress import ProgressCallback, stages
from ..storage.provenance import package_versions
from ..storage.results import Results
from . import agreement, baseline, invariance, lagrange, laws, restraint
from . import subject as subjects
from .cause import likely_cause
from .measurement import FAILED, PASSED, RELEASE, Bound, Result, at_most, not_run
from .subject import FILES, REFERENCE, SLAB, TOLERANCE, UPLIFT, Subject
from .suite import SuiteRuns, check_suite

Measure = Callable[[Subject, str], Iterator[Result]]
ENDS = Bound(0.0, "a check must reach its end")


@dataclass(frozen=True, slots=True)
class Check:
    """One check, and the kinds of subjects to which it applies.

    Parameters
    ----------
    measure : callable
        Yields the results on a subject with a support; its docstring holds the theory and the expected law.
    supports : tuple of str
        Supports that it is for, as far as the subject has them; empty: the first of the subject.
    knows : tuple of str
        Fields of a trace without which it cannot run, and says so.
    needs : tuple of str
        Features of a subject without which it does not apply, see `Subject.features`.
    """

    measure: Measure
    supports: tuple[str, ...] = MODELLED
    knows: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()

    def applies(self, subject: Subject) -> bool:
        """Whether the check applies to a subject."""
        files = FILES in subject.features
        return subject.features.issuperset(self.needs) and (FILES in self.needs) == files

    def run(self, subject: Subject) -> Iterator[Result]:
        """Results of the check, named with its support; an exception becomes a failed result."""
        name = self.measure.__name__.replace("_", " ")
        if lacks := [field for field in self.knows if field not in subject.knows]:
            yield not_run(name, f"{subject.label} does not return {', '.join(lacks)}")
            return
        supports = [each for each in self.supports or subject.supports[:1] if each in subject.supports]
        for support in supports:
            try:
                for result in self.measure(subject, support):
                    yield dataclasses.replace(result, name=f"{result.name}, {support}")
            except Exception as error:  # the exception of a model or engine becomes its result
                words = f"{type(error).__name__}: {' '.join(str(error).split())}"
                if subject.features & {
                    "rtol",
                    "stepper",
                    FILES,
                }:  # a reduced model, an engine and a trajectory read here must not raise
                    yield at_most(f"{name}, {support}", math.nan, ENDS, note=words)
                else:
                    yield not_run(f"{name}, {support}", words)


_MODELS, _ANY = tuple(reduced.MODELS), tuple(SUPPORTS.values())
GROUPS: Mapping[str, tuple[Check, ...]] = {
    "equations": (Check(lagrange.residual, (RECESS,), needs=("rtol",)),),
    "exact": (
        Check(laws.free_response, (RECESS,)),
        Check(laws.steady_wobble),
        Check(laws.vanishing_spin, (RECESS,), needs=("rtol",)),
        Check(laws.planar_rocking, ("planar",)),
    ),
    "conserved": (
        Check(lagrange.free_motion, knows=("energy",)),
        Check(lagrange.rolling_loss, (RECESS,), needs=("rolling_resistance",)),
        Check(lagrange.work_of_the_ground, knows=("energy", "centre_of_mass")),
        Check(lagrange.work_of_a_record, _MODELS, ("energy",), ("rtol",)),
    ),
    "rest": (
        Check(laws.stands, _MODELS, needs=(UPLIFT,)),
        Check(laws.uplift, knows=("uplift_time",), needs=(UPLIFT,)),
        Check(laws.force_at_rest, knows=("contact_force",), needs=(UPLIFT,)),
        Check(laws.falls, knows=("outcome",)),
        Check(laws.static_loads, (), needs=("stepper", UPLIFT)),
    ),
    "invariance": (
        Check(invariance.frame, knows=("rolling_angle",)),
        Check(invariance.scale),
        Check(invariance.statement),
    ),
    "tendon": (
        Check(restraint.releases, (RECESS,), needs=("tendon",)),
        Check(restraint.rocking, ("planar",), needs=("tendon",)),
        Check(restraint.stored_energy, (RECESS,), ("energy",), ("tendon",)),
        Check(restraint.load_at_rest, (RECESS,), ("contact_force",), ("tendon",)),
        Check(restraint.raised_uplift, (RECESS, "planar"), ("uplift_time",), ("tendon", UPLIFT)),
        Check(restraint.balance, (RECESS,), ("outcome",), ("tendon",)),
    ),
    "order": (Check(agreement.order, needs=("stepper", REFERENCE)),),
    "trace": (
        Check(laws.place, (RECESS,), ("twist", "contact_point", "centre_of_mass")),
        Check(laws.slip, needs=("stepper",)),
        Check(laws.turning, knows=("extrema", "passes")),
    ),
    "agreement": (
        Check(agreement.fields, knows=("twist", "centre_of_mass"), needs=(REFERENCE,)),
        Check(agreement.release, needs=(REFERENCE,)),
        Check(agreement.frame, needs=(REFERENCE, SLAB)),
        Check(agreement.tendon, (RECESS,), needs=(REFERENCE, "tendon")),
        Check(agreement.ramp, needs=(REFERENCE, UPLIFT)),
        Check(agreement.record, needs=(REFERENCE, UPLIFT)),
        Check(agreement.ring, (RING,), needs=("stepper", REFERENCE)),
        Check(agreement.trajectory, needs=(REFERENCE, FILES)),
    ),
    "protocol": (
        Check(invariance.description, _ANY, needs=("stepper",)),
        Check(invariance.stepping, _ANY, needs=("stepper",)),
        Check(invariance.time_grid, _ANY, needs=("stepper",)),
        Check(invariance.repetition, _ANY, needs=("stepper",)),
    ),
    "baseline": (
        Check(baseline.same_as_baseline, needs=("rtol",)),
        Check(baseline.same_as_baseline, _ANY, needs=("stepper",)),
    ),
}
# groups whose results become the claims of a certificate
CLAIMING = tuple(group for group in GROUPS if group not in baseline.NOT_CLAIMING)
# default checks of an engine, which cover the effects of a new version: agreement with the model, itself
# checked against the laws, and short motions equal to those of the baseline
_OF_ENGINES = {
    "agreement": tuple(
        each
        for each in GROUPS["agreement"]
        if each.measure in (agreement.fields, agreement.release, agreement.record, agreement.ring)
    ),
    "baseline": GROUPS["baseline"],
}
# an extra engine is checked in every field, on its first support only
_OF_EXTRAS = {"agreement": (dataclasses.replace(GROUPS["agreement"][0], supports=()),)}
TITLES = {
    "equations": "equations of motion",
    "exact": "exact solutions",
    "conserved": "conserved quantities",
    "rest": "rest and uplift",
    "invariance": "invariance",
    "tendon": "restraining tendon",
    "order": "order of convergence",
    "trace": "consistency of a trace",
    "agreement": "agreement with the independent model",
    "protocol": "protocol of an engine",
    "baseline": "baseline",
}


Part = tuple[Subject, str, Check]  # subject, group, and a check of this group


def run_checks(
    subject: Subject, groups: Sequence[str] | None = None, *, progress: ProgressCallback | None = None
) -> Iterator[Result]:
    """Results of the groups, in their order, as they are computed.

    An exception in a check is a failure of that check, or, of somebody's model, one that could not run: the
    checks after it still run.

    Parameters
    ----------
    subject : Subject
    groups : sequence of str, optional
        Some of `GROUPS`. Default: all.
    progress : callable, optional
        Called at the start and the end of each check.

    Returns
    -------
    iterator of Result

    Raises
    ------
    ValueError
        If a group is unknown.
    """
    for group in groups or ():
        require_one_of("a group", group, tuple(GROUPS))
    yield from _results(
        [
            part
            for group in GROUPS
            if groups is None or group in groups
            for part in _parts(subject, group, GROUPS)
        ],
        progress,
    )


def _parts(subject: Subject, group: str, checks: Mapping[str, tuple[Check, ...]]) -> list[Part]:
    """Checks of a group that apply to a subject."""
    return [(subject, group, each) for each in checks.get(group, ()) if each.applies(subject)]


def _results(parts: Sequence[Part], progress: ProgressCallback | None) -> Iterator[Result]:
    stage = stages(progress, [1.0] * len(parts))
    for subject, group, each in parts:
        with stage(f"{subject.label}: {each.measure.__name__.replace('_', ' ')}"):
            for result in each.run(subject):
                yield dataclasses.replace(result, group=group, subject=subject.label)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Checks(Results, kind="check"):
    """Results of checks.

    Attributes
    ----------
    tables : mapping of str to DataFrame
        results: one row for each result, its fields as columns.
    facts : mapping
        subjects: their labels; versions of the packages; seconds that the checks took [s].
    """

    @classmethod
    def of(cls, results: Sequence[Result], *, seconds: float) -> Self:
        """Checks with these results.

        Parameters
        ----------
        results : sequence of Result
        seconds : float
            Time that they took [s].
        """
        import pandas as pd

        rows, columns = [asdict(each) for each in results], list(Result.__dataclass_fields__)
        table = pd.DataFrame(rows, columns=columns).astype({"value": float, "bound": float})
        subjects = dict.fromkeys(result.subject for result in results if result.subject)
        facts = {"subjects": list(subjects), "versions": package_versions(), "seconds": seconds}
        return cls(tables={"results": table}, facts=facts)

    @cached_property
    def results(self) -> list[Result]:
        """Results in the order of the checks."""
        return [
            Result(**{str(name): value for name, value in row.items()})
            for row in self.tables["results"].to_dict("records")
        ]

    @property
    def failures(self) -> list[Result]:
        """Results of the failed checks."""
        return [result for result in self.results if result.failed]

    @property
    def passed(self) -> bool:
        """Whether no check failed."""
        return not self.failures

    def headline(self) -> Mapping[str, int]:
        """Number of checks by their outcome."""
        counts = Counter(each.outcome for each in self.results)
        return {name: counts[name] for name in ("FAILED", "passed", "no baseline", "not run")}

    def findings(self) -> Findings:
        """Findings: number of failed checks, and each failed check."""
        counts = {name: count for name, count in self.headline().items() if count}
        failed, passed = counts.pop(FAILED, 0), counts.pop(PASSED, 0)
        values = {
            "count": failed or passed,
            "count_all": len(self.results),
            "duration": self.facts["seconds"],
        }
        values["detail"] = ", ".join(f"{count} {name}" for name, count in counts.items())
        first = Finding(
            key="check.failed" if failed else "check.passed",
            level="not satisfied" if failed else "satisfied",
            values=values,
        )
        return Findings([first, *(each.finding() for each in self.failures)])

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {outcome}" for outcome, count in self.headline().items() if count)
        failed = [f"{each.name} {each.value:.2g} > {each.bound:.2g}" for each in self.failures]
        return line("Checks", [counts, *failed, *self.facts["subjects"]])


@with_argument_kinds
def check(
    engine: str | None = None,
    *,
    model: Callable[[Case, str], object] | str | None = None,
    trajectory: Trace | Sequence[Trace] | None = None,
    suite: Suite | str | Path | None = None,
    support: str = RECESS,
    tolerance: float = TOLERANCE,
    time_step: TimeStep | None = None,
    only: Sequence[str] | None = None,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    **settings: object,
) -> Checks:
    """Check a reduced model, an engine, another model or a trajectory by physics.

    Parameters
    ----------
    engine : str, optional
        Engine that is held to all checks, those of the protocol included. Default, where nothing else is
        given: the reduced models, and what a version may change of the engines that are installed here.
    model : callable or str, optional
        Model of somebody else, or its name as "module:function"; see `external_model`.
    trajectory : Trace or sequence of Trace, optional
        Trajectory, from `rockwobble.compare.read_trajectory`.
    suite : Suite, str or path, optional
        Suite whose engine runs are compared with the reduced models: by the bounds that it states, or by
        what the time step of each run leaves.
    support : {"recess", "flat"}, optional
        What the model or the trajectory is of.
    tolerance : float, optional
        How exact the model or the trajectory claims to be.
    time_step : float, "auto" or "extrapolated", optional
        Time step of the engine [s].
    only : sequence of str, optional
        Some of `rockwobble.compare.check.GROUPS`. Default: all.
    workers : int, optional
        Number of processes for the runs of a suite. Default: one for each core.
    progress : callable, optional
        Called at the start and the end of each check, or of each run of the suite.
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
    Checks(10 passed, reduced model)
    """
    begun = time.monotonic()
    given = [engine, model, trajectory, suite]
    if sum(each is not None for each in given) > 1:
        raise ValueError("one of engine, model, trajectory and suite may be given, got more")
    if engine is None and (time_step is not None or settings):
        raise ValueError("time_step and settings belong to an engine, got them alone")
    for group in only or ():
        require_one_of("a group", group, tuple(GROUPS))
    results = list[Result]()
    if suite is not None:
        runs = SuiteRuns(workers=workers, progress=progress)
        found = _of_suite(runs, read_suite(suite) if not isinstance(suite, Suite) else suite)
        return Checks.of([*found], seconds=time.monotonic() - begun)
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
        chosen = baseline_subjects()
        # an extra that is not installed is skipped, one that does not load fails
        asked = [name for name in engine_packages() if name in (*standard_engines(), *available_engines())]
        faults = {name: engine_fault(name) for name in asked}
        results = [not_run(f"checks of {name}", fault) for name, fault in faults.items() if fault]
    by_default = not any(each is not None for each in given)
    parts: list[Part] = []
    for group in (each for each in GROUPS if only is None or each in only):
        for each in chosen:
            checks: Mapping[str, tuple[Check, ...]] = GROUPS
            if by_default and each.run is not None:
                checks = _OF_ENGINES if each.label in standard_engines() else _OF_EXTRAS
            parts += _parts(each, group, checks)
    results += _results(parts, progress)
    for each in chosen:
        results = with_cause(each, results)
    if not results:
        raise ValueError(f"no check of {', '.join(only or GROUPS)} applies: name an engine, or another group")
    return Checks.of(results, seconds=time.monotonic() - begun)


def with_cause(subject: Subject, results: Sequence[Result]) -> list[Result]:
    """Add the likely cause to failed motion checks that have none."""

    def lacks(result: Result) -> bool:
        own = result.subject == subject.label and result.group in ("exact", "conserved", "rest", "agreement")
        return own and result.failed and not result.cause

    support = next((name for name in MODELLED if name in subject.supports), None)
    can_tell = subject.reference is not None and subject.cases is None
    if support is None or not can_tell or not any(map(lacks, results)):
        return list(results)
    cases = [RELEASE, agreement.LOW_RELEASE, *([agreement.RAMP] if UPLIFT in subject.features else [])]
    try:
        cause = likely_cause(subject, support, cases)
    except Exception:  # exceptions of a model are reported by its checks
        cause = ""
    return [dataclasses.replace(each, cause=cause) if lacks(each) else each for each in results]


def baseline_subjects() -> list[Subject]:
    """Subjects with stored baselines: the reduced models, and our engines installed here."""
    return [subjects.reduced_model(), *(subjects.engine(name) for name in own_engines())]


def _of_suite(runs: SuiteRuns, suite: Suite) -> Iterator[Result]:
    """Results of each run of each case of a suite."""
    chosen, _ = runs_here(suite.runs or default_runs(cases=suite.cases))
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
        yield dataclasses.replace(result, group="agreement")
