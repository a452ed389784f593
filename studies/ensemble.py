"""Study of an ensemble: distributions of peak tilts, which can agree after single traces have diverged."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, cast

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.contrast import pairs_in
from rockwobble.compare.metrics.pair import beyond_yield, outcome_of
from rockwobble.compare.metrics.statistics import adjusted, quantile_interval, value_if_enough
from rockwobble.compare.runs.choice import default_runs, require_runnable, run_labels
from rockwobble.compare.runs.execution import (
    Job,
    brief_among,
    job_fingerprint,
    job_time,
    jobs_fingerprint,
    run_job,
)
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.results import Results
from rockwobble.models import Case, Run, Suite, Tendon, Trace
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.case import REDUCED_MODELS, TERMS
from rockwobble.models.diagnostic import cell_of
from rockwobble.models.doubts import doubts_of_cases
from rockwobble.models.finding import Findings
from rockwobble.models.ground_motion import sources_of
from rockwobble.models.number_checks import require_each
from rockwobble.models.plain_json import fields_of, plain
from rockwobble.models.trace import NO_PEAK, lost_trace

from .ensemble_findings import ensemble_findings
from .plans import Copies
from .study import Study

KIND = "ensemble"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Ensemble(Results, kind=KIND):
    """Peak tilts of many members by several methods.

    Attributes
    ----------
    members : DataFrame
        One row for each member and method: member, method, peak_tilt [alpha] (NaN where failed, pi/2 where
        overturned), outcome (see `outcome_of`; undecided where the tendon yields), diagnostics (their
        codes), wall_time [s].
    methods : DataFrame
        One row for each method: own_model (of the support of an engine; of a ring, which has none, the recess
        model), runs, uplifted, overturned, failed, failed_members (their names), and of the peak tilts of
        what did not fail [alpha] the median with its interval (peak_median, _low, _high) and the 16th and
        84th percentile (peak_16, peak_84): infinite where they overturn; peak_median_least and _most: the
        median were all that failed at rest, and were all to overturn.
    contrasts : DataFrame
        One row for each two methods: the numbers of `Contrast`, intervals in columns _low and _high, its
        verdict, masked (members that failed by one of them), ratio_least and ratio_most (the median ratio,
        whatever these members would have done: a run may fail where it overturns), and both probabilities
        corrected for the number of pairs (Holm) in columns _adjusted.

    Its facts are what the members are, the range of their sizes and slendernesses, the model of the support
    of each method, the seed, and the hash of all inputs.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> case = rw.Case(pier, rw.el_centro_1940(), duration=15.0)
    >>> both = [rw.Run(None, "recess"), rw.Run(None, "flat")]
    >>> study = rw.ensemble(case, runs=[], models=both, copies=5, workers=1)
    >>> list(study.methods["runs"]), study.members.shape
    ([5, 5], (10, 6))
    """

    def headline(self) -> dict[str, Number]:
        """Median ratio of each pair of methods."""
        return {
            f"{row['method']} / {row['against']}, median ratio": value_if_enough(
                row["ratio"], row["compared"], ratio=True
            )
            for row in self.contrasts.to_dict("records")
        }

    def findings(self) -> Findings:
        """Findings: equivalent methods, significant differences, failures."""
        return Findings(ensemble_findings(self.members["member"].nunique(), self.methods, self.contrasts))

    def sheets(self) -> dict[str, bytes]:
        """Tables as CSV."""
        return {f"{name}.csv": table.to_csv(index=False).encode() for name, table in self.tables.items()}

    def _main_facts(self) -> dict[str, str]:
        runs = self.methods[["runs", "overturned", "failed"]].sum()
        return {
            "members": f"{self.members['member'].nunique()}, {self.facts.get('members', '')}",
            "overturned": f"{runs['overturned']} of {runs['runs']} runs",
            "methods": ", ".join(self.methods["method"]),
            "failed": str(runs["failed"]),
        }


@with_argument_kinds
def ensemble(
    case_or_members: Case | Suite | Sequence[Case],
    *,
    runs: Iterable[Run] | None = None,
    models: Sequence[Run] = REDUCED_MODELS,
    copies: int = 20,
    perturbation: float = 0.01,
    seed: int = 0,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    resume: str | Path | None = None,
    source: str = "cases",
) -> Ensemble:
    """Run many members by each method, and compare their peak tilts, member by member.

    Parameters
    ----------
    case_or_members : Case, Suite or sequence of Case
        One case is run as perturbed copies, see `perturbed_copies`; several are the members, such as one
        body under many records.
    runs : iterable of Run, optional
        Default: those of the suite, else every installed engine with supports "recess" and "flat".
    models : sequence of Run, optional
        Reduced models. The first is named first in every contrast. Default: recess and flat; with a tendon
        recess.
    copies : int, optional
        Number of perturbed copies of one case.
    perturbation : float, optional
        Relative standard deviation of the copies: of tilt and rolling rate at release, or of both components
        of the ground motion.
    seed : int, optional
        Seed of the perturbations.
    workers, progress, resume
        As in `compare`.
    source : str, optional
        What the members are, for people, where there are several cases.

    Returns
    -------
    Ensemble
        Failed runs have no peak; they are counted and named, and their member does not count in the
        contrasts of their method.

    Raises
    ------
    ValueError
        If there are fewer than two members, or an engine or a number is not usable.

    Examples
    --------
    >>> from rockwobble.models import Cylinder, el_centro_1940
    >>> case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940())
    >>> study = ensemble(case, runs=[], copies=5, workers=1)
    >>> study.methods[["method", "runs", "failed"]].values.tolist()
    [['recess model', 5, 0], ['flat-ground model', 5, 0]]
    """
    plan = Copies(copies=copies, perturbation=perturbation, seed=seed)
    about: dict[str, object] = {"seed": plan.seed}
    if not isinstance(case_or_members, Case | Suite):
        require_each("case_or_members", case_or_members, Case)
    if isinstance(case_or_members, Case):
        members = plan.perturbed(case_or_members)
        about |= {"members": f"perturbed copies of {case_or_members.name}, {100.0 * plan.perturbation:g} %"}
        about |= {"perturbation": plan.perturbation}
    else:
        members = list(case_or_members.cases if isinstance(case_or_members, Suite) else case_or_members)
        about |= {"members": source}
    if len(members) < 2 or len({case.name for case in members}) < len(members):
        raise ValueError(f"an ensemble has at least 2 members of different names, got {len(members)}")
    stated = case_or_members.runs if isinstance(case_or_members, Suite) else ()
    chosen = (stated or default_runs(cases=members)) if runs is None else tuple(runs)
    if models is REDUCED_MODELS and any(case.anchor for case in members):
        # no anchor on flat ground, where the base wanders
        models = tuple(model for model in models if model.support.guided)
    for case in members:
        for run in chosen:
            require_runnable(case, run)
    methods = dict(zip(run_labels((*models, *chosen)), (*models, *chosen), strict=True))
    jobs = [Job(case=case, run=run, label=label) for case in members for label, run in methods.items()]
    about |= {name: _range(members, name) for name in ("semidiagonal", "tan_alpha")}
    about |= {"slab_mass_ratio": _of_all(case.cylinder.slab_mass_ratio for case in members)}
    for name in ("gravity", *TERMS):
        about[name] = _of_all(getattr(case, name) for case in members)
    about |= {"methods": {label: _compared_with(run) for label, run in methods.items()}}
    about |= {"doubts": doubts_of_cases(members)}
    about |= {"record_sources": sources_of(case.motion for case in members)}
    about |= {"inputs": jobs_fingerprint(jobs)}
    return EnsembleStudy(jobs, about).run(folder=resume, workers=workers, progress=progress)


@dataclass(frozen=True)
class EnsembleStudy(Study[Job, Ensemble]):
    """Members by methods, one task each, with the inputs as `Ensemble.facts`."""

    kind: ClassVar[str] = KIND
    what: ClassVar[str] = "runs"
    cost: ClassVar[Callable[[Job], float] | None] = staticmethod(job_time)
    jobs: Sequence[Job]
    about: Mapping[str, object]

    def tasks(self) -> Sequence[Job]:
        """One task for each member and method."""
        return self.jobs

    @staticmethod
    def row(task: Job) -> pd.DataFrame:
        """Row of a run, without member name and method."""
        return _row(run_job(task))

    def key(self, task: Job) -> str:
        """Hash of the inputs of a run."""
        return job_fingerprint(task)

    def here(self) -> Callable[[Job], bool]:
        """Whether a run takes less time than starting a process."""
        return brief_among(self.jobs)

    def lost(self, task: Job, why: str) -> pd.DataFrame:
        """Row of a failed run, for a process that died."""
        return _row(lost_trace(task.case, task.run, why))

    def results(self, tables: list[pd.DataFrame]) -> Ensemble:
        """Ensemble from the rows of all runs."""
        names = [{"member": job.case.name, "method": job.label} for job in self.jobs]
        members = pd.concat([pd.DataFrame(names), pd.concat(tables, ignore_index=True)], axis=1)
        return ensemble_of(members, self.about)


def _compared_with(run: Run) -> str:
    """Label of the reduced model of an engine's support, else the recess model."""
    return "" if run.is_model else str(run.compared_with[-1])


def ensemble_of(members: pd.DataFrame, about: Mapping[str, object]) -> Ensemble:
    """Ensemble of a table of members and of their `Ensemble.facts`."""
    methods = cast("Mapping[str, str]", about["methods"])
    tables = {
        "members": members,
        "methods": method_table(members, methods),
        "contrasts": contrast_table(members, methods),
    }
    return Ensemble(tables=tables, facts=plain(about))


def _of_all(values: Iterable[float | Tendon | None]) -> object:
    """Common value as plain fields; "differs" if there are several."""
    value, *others = set(values)
    if others:
        return "differs"
    return fields_of(value) if isinstance(value, Tendon) else value


def _range(members: Sequence[Case], name: str) -> dict[str, float]:
    values = {float(getattr(case.cylinder, name)) for case in members}
    return {"from": min(values), "to": max(values), "count": len(values)}


def _row(trace: Trace) -> pd.DataFrame:
    yields = bool(beyond_yield(trace.peak_tilt, trace.case))  # what comes after is not modelled
    row = {
        "peak_tilt": math.nan if yields else trace.peak_tilt / trace.case.cylinder.alpha,
        "outcome": "undecided" if yields else outcome_of(trace),
        "diagnostics": cell_of(fact.code for fact in trace.facts),
        "wall_time": trace.wall_time,
    }
    return pd.DataFrame([row])


def method_table(members: pd.DataFrame, methods: Mapping[str, str]) -> pd.DataFrame:
    """One row per method, see `Ensemble.methods`; `methods` names the own model of each."""
    rows = []
    for method, own in methods.items():
        runs = members[members["method"] == method]
        without = runs["outcome"].isin(NO_PEAK)
        failed, known = runs[without], runs[~without]
        fallen = known["outcome"] == "overturned"
        peaks = np.where(fallen, math.inf, known["peak_tilt"].to_numpy(float))
        median = quantile_interval(peaks, 0.5)
        least, most = (
            quantile_interval(np.append(peaks, np.full(len(failed), fate)), 0.5).value
            for fate in (0.0, math.inf)
        )
        rows.append(
            {
                "method": method,
                "own_model": own,
                "runs": len(runs),
                "uplifted": int((known["peak_tilt"] > 0.0).sum()),
                "overturned": int(fallen.sum()),
                "failed": len(failed),
                "failed_members": ", ".join(failed["member"]),
                "peak_16": quantile_interval(peaks, 0.16).value,
                "peak_median": median.value,
                "peak_median_low": max(median.low, 0.0),
                "peak_median_high": median.high,
                "peak_84": quantile_interval(peaks, 0.84).value,
                "peak_median_least": least,
                "peak_median_most": most,
            }
        )
    return pd.DataFrame(rows)


def contrast_table(members: pd.DataFrame, methods: Mapping[str, str]) -> pd.DataFrame:
    """One row per pair of methods, see `Ensemble.contrasts`."""
    rows = []
    for against, method in itertools.combinations(methods, 2):
        both = pairs_in(members, method, against)
        contrast = both.contrast()
        if contrast is not None:
            least, most = both.ratio_bounds()
            rows.append(
                {
                    "method": method,
                    "against": against,
                    **contrast.columns(),
                    "masked": ", ".join(both.members[both.failed]),
                    "ratio_least": least,
                    "ratio_most": most,
                }
            )
    table = pd.DataFrame(rows)
    for name in ("ratio_p", "overturned_p") if len(table) else ():
        table[f"{name}_adjusted"] = adjusted(table[name].to_numpy(float))
    return table
