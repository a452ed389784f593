"""Study of an ensemble: distributions of peak tilts, which agree where single traces have diverged."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, cast

import pandas as pd

from rockwobble.models import Case, Run, Suite, Trace
from rockwobble.models.diagnostic import joined
from rockwobble.models.records.plausibility import doubts_of
from rockwobble.models.shown import Shown

from ...metrics.tilt import outcome_of
from ...runs.choice import default_runs, require_runnable
from ...runs.execution import Job, job_fingerprint, open_trace_cache, simulate_all
from ...runs.labels import run_labels
from ...runs.progress import ProgressCallback
from ...storage.fingerprint import fingerprint
from ...storage.manifest import Manifest, Results, made_now
from .members import perturbed_copies
from .tables import contrast_table, method_table

KIND = "ensemble"
MODELS = (Run(None, "recess"), Run(None, "flat"))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Ensemble(Shown):
    """Peak tilts of many members by several methods.

    Parameters
    ----------
    members : DataFrame
        One row for each member and method: member, method, peak_tilt [alpha] (NaN where failed, pi/2 where
        overturned), outcome (see `outcome_of`), diagnostics (their codes), wall_time [s].
    methods : DataFrame
        One row for each method: own_model (of the support of an engine; of a ring, which has none, the recess
        model), runs, rocked, overturned, failed, failed_members (their names), and of the peak tilts of what
        did not fail [alpha] the median with its interval (peak_median, _low, _high) and the 16th and 84th
        percentile (peak_16, peak_84): infinite where they overturn.
    contrasts : DataFrame
        One row for each two methods: the numbers of `Contrast`, intervals in columns _low and _high, its
        verdict, masked (members that failed by one of them), and both probabilities corrected for the number
        of pairs (Holm) in columns _adjusted.
    about : mapping
        What the tables do not hold: what the members are, the range of their sizes and slendernesses, the
        model of the support of each method, the seed, and the hash of all inputs.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> case = rw.Case(pier, rw.el_centro_1940(), duration=15.0)
    >>> both = [rw.Run(None, "recess"), rw.Run(None, "flat")]
    >>> found = rw.ensemble(case, runs=[], models=both, size=5, workers=1)
    >>> list(found.methods["runs"]), found.members.shape
    ([5, 5], (10, 6))
    """

    _figures: ClassVar[str] = "ensemble"
    members: pd.DataFrame
    methods: pd.DataFrame
    contrasts: pd.DataFrame
    about: Mapping[str, object]

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        """The tables by name."""
        return {"members": self.members, "methods": self.methods, "contrasts": self.contrasts}

    def _said(self) -> dict[str, str]:
        runs = self.methods[["runs", "overturned", "failed"]].sum()
        return {
            "members": f"{self.members['member'].nunique()}, {self.about.get('members', '')}",
            "overturned": f"{runs['overturned']} of {runs['runs']} runs",
            "methods": ", ".join(self.methods["method"]),
            "failed": str(runs["failed"]),
        }


def ensemble(
    case_or_members: Case | Suite | Sequence[Case],
    *,
    runs: Iterable[Run] | None = None,
    models: Sequence[Run] = MODELS,
    size: int = 20,
    perturbation: float = 0.01,
    seed: int = 0,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    resume: str | Path | None = None,
    source: str = "cases",
) -> Ensemble:
    """Run many members by each method, and hold their peak tilts against each other, member by member.

    Parameters
    ----------
    case_or_members : Case, Suite or sequence of Case
        One case is run as `size` perturbed copies, see `perturbed_copies`; several are the members,
        such as one body under many records.
    runs : iterable of Run, optional
        Default: those of the suite, else every installed engine with supports "recess" and "flat".
    models : sequence of Run, optional
        Reduced models. The first is named first in every contrast.
    size : int, optional
        Number of perturbed copies.
    perturbation : float, optional
        Their relative standard deviation.
    seed : int, optional
        Of the perturbations.
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
    >>> found = ensemble(case, runs=[], size=5, workers=1)
    >>> found.methods[["method", "runs", "failed"]].values.tolist()
    [['recess model', 5, 0], ['flat-ground model', 5, 0]]
    """
    about: dict[str, object] = {"seed": seed}
    if isinstance(case_or_members, Case):
        members = perturbed_copies(case_or_members, size, perturbation=perturbation, seed=seed)
        about |= {"members": f"perturbed copies of {case_or_members.name}, {100.0 * perturbation:g} %"}
        about |= {"perturbation": perturbation}
    else:
        members = list(case_or_members.cases if isinstance(case_or_members, Suite) else case_or_members)
        about |= {"members": source}
    if len(members) < 2 or len({case.name for case in members}) < len(members):
        raise ValueError(f"an ensemble has at least 2 members of different names, got {len(members)}")
    stated = case_or_members.runs if isinstance(case_or_members, Suite) else ()
    chosen = (stated or default_runs()) if runs is None else tuple(runs)
    for case in members:
        for run in chosen:
            require_runnable(case, run)
    methods = dict(zip(run_labels((*models, *chosen)), (*models, *chosen), strict=True))
    jobs = [Job(case=case, run=run, label=label) for case in members for label, run in methods.items()]
    with nullcontext() if resume is None else open_trace_cache(resume, "ensemble", samples=False) as cache:
        results = simulate_all(jobs, workers=workers, progress=progress, cache=cache)
    table = _members(jobs, results)
    about |= {name: _range(members, name) for name in ("semidiagonal", "tan_alpha")}
    about |= {"methods": {label: _held_against(run) for label, run in methods.items()}}
    about |= {"doubts": doubts_of(case.motion for case in members)}
    about |= {"inputs": fingerprint([(job.case.name, job.label, job_fingerprint(job)) for job in jobs])}
    return ensemble_of(table, about)


def _held_against(run: Run) -> str:
    """Return the label of the model that an engine's run is held against: a ring against the recess model."""
    return str(Run(None, "flat" if run.support == "flat" else "recess")) if run.engine else ""


def ensemble_of(members: pd.DataFrame, about: Mapping[str, object]) -> Ensemble:
    """Return the ensemble of a table of members, and of what `Ensemble.about` says of them."""
    methods = cast("Mapping[str, str]", about["methods"])
    return Ensemble(
        members=members,
        methods=method_table(members, methods),
        contrasts=contrast_table(members, methods),
        about=about,
    )


def manifest_of(found: Ensemble, command: str = "") -> Manifest:
    """Return the manifest of an ensemble, with the median ratio of each two methods as headline."""
    return made_now(
        KIND,
        inputs=str(found.about["inputs"]),
        command=command,
        seeds={"ensemble": cast("int", found.about["seed"])},
        headline={
            f"{row['method']} / {row['against']}, median ratio": row["ratio"]
            for row in found.contrasts.to_dict("records")
        },
        about=found.about,
    )


def stored_ensemble(results: Results) -> Ensemble:
    """Return the ensemble that is stored in a folder."""
    return ensemble_of(results.table("members"), results.manifest.about)


def _range(members: Sequence[Case], name: str) -> dict[str, float]:
    values = {float(getattr(case.cylinder, name)) for case in members}
    return {"from": min(values), "to": max(values), "count": len(values)}


def _members(jobs: Sequence[Job], results: Sequence[Trace]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "member": job.case.name,
            "method": job.label,
            "peak_tilt": result.peak_tilt / job.case.cylinder.alpha,
            "outcome": outcome_of(result),
            "diagnostics": joined(fact.code for fact in result.facts),
            "wall_time": result.wall_time,
        }
        for job, result in zip(jobs, results, strict=True)
    )
