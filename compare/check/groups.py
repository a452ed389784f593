"""`rockwobble.check`: the physical checks in groups, and the subjects that they are run on.

What comes later in the list rests on what comes earlier.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
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
from ..runs.progress import ProgressCallback, Stage, stages
from ..storage.provenance import package_versions
from ..storage.results import Results
from . import agreement, baseline, invariance, lagrange, laws, restraint
from . import subject as subjects
from .cause import likely_cause
from .measurement import FAILED, PASSED, RELEASE, Bound, Result, at_most, not_run
from .subject import TOLERANCE, Subject
from .suite import SuiteRuns, check_suite

Measure = Callable[[Subject, str], Iterator[Result]]
ENDS = Bound(0.0, "a check must reach its end")


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """One check, and the subjects that it is for.

    Parameters
    ----------
    measure : callable
        Yields the results on a subject with a support; its docstring holds the theory and the expected law.
    supports : tuple of str
        Supports that it is for, as far as the subject has them; empty: the first of the subject.
    knows : tuple of str
        Fields of a trace without which it cannot run, and says so.
    options : tuple of str
        Options of the source without which it does not apply.
    reference : bool
        Whether it compares with an independent model: not for the reduced models themselves.
    files : bool
        Whether it is for trajectories of cases of their own.
    from_rest : bool
        Whether it starts from a cylinder that stands.
    slab : bool
        Whether it is for subjects that know a wobbling frame.
    terms : tuple of str
        Terms of a case without which a subject is not asked.
    """

    measure: Measure
    supports: tuple[str, ...] = MODELLED
    knows: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    reference: bool = False
    files: bool = False
    from_rest: bool = False
    slab: bool = False
    terms: tuple[str, ...] = ()

    def applies(self, subject: Subject) -> bool:
        """Return whether the check applies to a subject."""
        return (
            set(self.options) <= subject.options
            and self.files == (subject.cases is not None)
            and (subject.reference is not None or not self.reference)
            and (subject.uplifts or not self.from_rest)
            and (subject.carries_slab or not self.slab)
            and subject.terms.issuperset(self.terms)
        )

    def run(self, subject: Subject) -> Iterator[Result]:
        """Yield its results, the name of each with its support; an exception is a result, too."""
        name = self.measure.__name__.replace("_", " ")
        if lacks := [field for field in self.knows if field not in subject.knows]:
            yield not_run(name, f"{subject.label} does not return {', '.join(lacks)}")
            return
        supports = [each for each in self.supports or subject.supports[:1] if each in subject.supports]
        for support in supports:
            try:
                for result in self.measure(subject, support):
                    yield dataclasses.replace(result, name=f"{result.name}, {support}")
            except Exception as error:  # whatever a model or engine raises is said in its place
                words = f"{type(error).__name__}: {' '.join(str(error).split())}"
                if subject.options or subject.cases:  # a reduced model or a file read here must not fail
                    yield at_most(f"{name}, {support}", math.nan, ENDS, note=words)
                else:
                    yield not_run(f"{name}, {support}", words)


GROUPS: Mapping[str, tuple[Check, ...]] = {
    "equations": (Check(measure=lagrange.residual, supports=(RECESS,), options=("rtol",)),),
    "exact": (
        Check(measure=laws.free_response, supports=(RECESS,)),
        Check(measure=laws.steady_wobble),
        Check(measure=laws.vanishing_spin, supports=(RECESS,), options=("rtol",)),
        Check(measure=laws.planar_rocking, supports=("planar",)),
    ),
    "conserved": (
        Check(measure=lagrange.free_motion, knows=("energy",)),
        Check(measure=lagrange.rolling_loss, supports=(RECESS,), terms=("rolling_resistance",)),
        Check(measure=lagrange.work_of_the_ground, knows=("energy", "centre_of_mass")),
        Check(
            measure=lagrange.work_of_a_record,
            supports=tuple(reduced.MODELS),
            knows=("energy",),
            options=("rtol",),
        ),
    ),
    "rest": (
        Check(measure=laws.stands, supports=tuple(reduced.MODELS), from_rest=True),
        Check(measure=laws.uplift, knows=("uplift_time",), from_rest=True),
        Check(measure=laws.force_at_rest, knows=("contact_force",), from_rest=True),
        Check(measure=laws.falls, knows=("outcome",)),
        Check(measure=laws.static_loads, supports=(), options=("stepper",), from_rest=True),
    ),
    "invariance": (
        Check(measure=invariance.frame, knows=("rolling_angle",)),
        Check(measure=invariance.scale),
        Check(measure=invariance.statement),
    ),
    "tendon": (
        Check(measure=restraint.releases, supports=(RECESS,), terms=("tendon",)),
        Check(measure=restraint.rocking, supports=("planar",), terms=("tendon",)),
        Check(measure=restraint.stored_energy, supports=(RECESS,), knows=("energy",), terms=("tendon",)),
        Check(
            measure=restraint.load_at_rest, supports=(RECESS,), knows=("contact_force",), terms=("tendon",)
        ),
        Check(
            measure=restraint.raised_uplift,
            supports=(RECESS, "planar"),
            knows=("uplift_time",),
            terms=("tendon",),
            from_rest=True,
        ),
        Check(measure=restraint.balance, supports=(RECESS,), knows=("outcome",), terms=("tendon",)),
    ),
    "order": (Check(measure=agreement.order, options=("stepper",), reference=True),),
    "trace": (
        Check(measure=laws.place, supports=(RECESS,), knows=("twist", "contact_point", "centre_of_mass")),
        Check(measure=laws.slip, options=("stepper",)),
        Check(measure=laws.turning, knows=("extrema", "passes")),
    ),
    "agreement": (
        Check(measure=agreement.fields, knows=("twist", "centre_of_mass"), reference=True),
        Check(measure=agreement.release, reference=True),
        Check(measure=agreement.frame, reference=True, slab=True),
        Check(measure=agreement.tendon, supports=(RECESS,), reference=True, terms=("tendon",)),
        Check(measure=agreement.ramp, reference=True, from_rest=True),
        Check(measure=agreement.record, reference=True, from_rest=True),
        Check(measure=agreement.ring, supports=(RING,), options=("stepper",), reference=True),
        Check(measure=agreement.trajectory, reference=True, files=True),
    ),
    "protocol": tuple(
        Check(measure=measure, supports=tuple(SUPPORTS.values()), options=("stepper",))
        for measure in (
            invariance.description,
            invariance.stepping,
            invariance.time_grid,
            invariance.repetition,
        )
    ),
    "baseline": (
        Check(measure=baseline.same_as_baseline, options=("rtol",)),
        Check(measure=baseline.same_as_baseline, supports=tuple(SUPPORTS.values()), options=("stepper",)),
    ),
}
# groups whose results become the claims of a certificate
CLAIMING = tuple(group for group in GROUPS if group not in baseline.NOT_CLAIMING)
# an engine that nobody has named is checked for what a new version may change: whether it follows the model,
# which the checks before hold to the laws, and whether short motions are those of its baseline
_OF_ENGINES = {
    "agreement": tuple(
        each
        for each in GROUPS["agreement"]
        if each.measure in (agreement.fields, agreement.release, agreement.record, agreement.ring)
    ),
    "baseline": GROUPS["baseline"],
}
# an engine that is an extra is checked in every field, on its first support
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


def run_checks(
    subject: Subject,
    groups: Sequence[str] | None = None,
    *,
    checks: Mapping[str, tuple[Check, ...]] | None = None,
    stage: Stage | None = None,
) -> Iterator[Result]:
    """Yield the results of the groups, in their order, as they are made.

    An exception in a check is a failure of that check, or, of somebody's model, one that could not run: the
    checks after it still run.

    Parameters
    ----------
    subject : Subject
    groups : sequence of str, optional
        Some of `GROUPS`. Default: all.
    checks : mapping, optional
        The checks of each group. Default: all.
    stage : callable, optional
        Told of the start and the end of each check, see `stages`.

    Returns
    -------
    iterator of Result

    Raises
    ------
    ValueError
        If a group is unknown.
    """
    for group, each in chosen_checks(subject, groups, checks=checks):
        name = f"{subject.label}: {each.measure.__name__.replace('_', ' ')}"
        with nullcontext() if stage is None else stage(name):
            for result in each.run(subject):
                yield dataclasses.replace(result, group=group, subject=subject.label)


def chosen_checks(
    subject: Subject,
    groups: Sequence[str] | None = None,
    *,
    checks: Mapping[str, tuple[Check, ...]] | None = None,
) -> list[tuple[str, Check]]:
    """Return the checks of some groups, as in `run_checks`, that apply to a subject, each with its group."""
    for group in groups or ():
        require_one_of("a group", group, tuple(GROUPS))
    return [
        (group, each)
        for group, chosen in (GROUPS if checks is None else checks).items()
        if groups is None or group in groups
        for each in chosen
        if each.applies(subject)
    ]


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
        """Return the checks with these results.

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
        """The results in the order in which they were made."""
        return [
            Result(**{str(name): value for name, value in row.items()})
            for row in self.tables["results"].to_dict("records")
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
    """Check a reduced model, an engine, somebody's model or a trajectory by physics.

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
        # an extra that is not installed is nobody's loss, one that does not load is
        asked = [name for name in engine_packages() if name in (*standard_engines(), *available_engines())]
        faults = {name: engine_fault(name) for name in asked}
        results = [not_run(f"checks of {name}", fault) for name, fault in faults.items() if fault]
    by_default = not any(each is not None for each in given)
    parts: list[tuple[Subject, str, Mapping[str, tuple[Check, ...]]]] = []
    for group in (each for each in GROUPS if only is None or each in only):
        for each in chosen:
            checks: Mapping[str, tuple[Check, ...]] = GROUPS
            if by_default and each.run is not None:
                checks = _OF_ENGINES if each.label in standard_engines() else _OF_EXTRAS
            parts.append((each, group, checks))
    count = sum(len(chosen_checks(each, [group], checks=checks)) for each, group, checks in parts)
    stage = stages(progress, [1.0] * count)
    for each, group, checks in parts:
        results += run_checks(each, [group], checks=checks, stage=stage)
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
    cases = [RELEASE, agreement.LOW_RELEASE, *([agreement.RAMP] if subject.uplifts else [])]
    try:
        cause = likely_cause(subject, support, cases)
    except Exception:  # whatever a model raises is said by its checks
        cause = ""
    return [dataclasses.replace(each, cause=cause) if lacks(each) else each for each in results]


def baseline_subjects() -> list[Subject]:
    """Return the subjects whose numbers are kept: the reduced models, and our engines installed here."""
    return [subjects.reduced_model(), *(subjects.engine(name) for name in own_engines())]


def _of_suite(runs: SuiteRuns, suite: Suite) -> Iterator[Result]:
    """Yield the results of each run of each case of a suite."""
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
