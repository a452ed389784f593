"""Ensembles: what can be compared beyond the horizon, where single traces say nothing."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.models import Case, Run, Suite

from .distributions import Contrast, contrast
from .ensemble_members import perturbed_starts
from .execution import Crash, Job, ProgressCallback, simulate_all
from .fingerprint import fingerprint
from .origin import read_table
from .parquet_file import read_about
from .provenance import about_results
from .run_store import job_fingerprint, open_run_store
from .runs import default_runs, own_model, require_runnable, run_labels

if TYPE_CHECKING:
    import pandas as pd

KIND = "rockwobble ensemble"
TABLE = "members.parquet"
MODELS = ("recess", "rolling")
_FALLING = "past its balance and falling when the run ended"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ensemble:
    """Peak tilts of many members by several methods.

    Parameters
    ----------
    members : DataFrame
        One row for each member and method: member, method, peak_tilt [alpha] (NaN where failed, pi/2 where
        overturned), outcome, message, wall_time [s]. What falls when its ground motion ends has overturned.
    methods : DataFrame
        One row for each method: own_model (of the support of an engine), runs, rocked, overturned, failed,
        failed_members (their names), and median and quantiles of the peak tilt of what did not fail [alpha],
        each that of a run: infinite where that one overturns.
    contrasts : DataFrame
        One row for each two methods: the numbers of `Contrast`, intervals in columns _low and _high.
    about : dict
        As `about_results`, with what the members are, the range of their sizes and slendernesses, the model
        of the support of each method, and the draws of the bootstrap.
    """

    members: pd.DataFrame
    methods: pd.DataFrame
    contrasts: pd.DataFrame
    about: dict[str, Any]


def ensemble(
    case_or_members: Case | Suite | Sequence[Case],
    *,
    runs: Iterable[Run] | None = None,
    models: Sequence[str] = MODELS,
    size: int = 20,
    perturbation: float = 0.01,
    seed: int = 0,
    draws: int = 1000,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
    resume: str | Path | None = None,
    source: str = "cases",
) -> Ensemble:
    """Run many members by each method, and hold the distributions of peak tilt against each other.

    Parameters
    ----------
    case_or_members : Case, Suite or sequence of Case
        One case is run with `size` perturbed starts, see `perturbed_starts`; several are the members,
        such as one body under many records.
    runs : iterable of Run, optional
        Default: those of the suite, else every installed engine with supports "guided" and "free".
    models : sequence of str, optional
        Reduced models. The first is named first in every contrast.
    size : int, optional
        Number of perturbed starts.
    perturbation : float, optional
        Their relative standard deviation.
    seed : int, optional
        Of the perturbations and of the bootstrap.
    draws : int, optional
        Of the bootstrap.
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
    >>> case = Case("pier", Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940())
    >>> found = ensemble(case, runs=[], size=5, workers=1)
    >>> found.methods[["method", "runs", "failed"]].values.tolist()
    [['recess', 5, 0], ['rolling', 5, 0]]
    """
    about: dict[str, Any] = {}
    if isinstance(case_or_members, Case):
        members = perturbed_starts(case_or_members, size, perturbation=perturbation, seed=seed)
        about |= {"members": f"starts of {case_or_members.name}, perturbed by {100.0 * perturbation:g} %"}
        about |= {"perturbation": perturbation}
    else:
        members = list(case_or_members.cases if isinstance(case_or_members, Suite) else case_or_members)
        about |= {"members": source}
    if len(members) < 2 or len({case.name for case in members}) < len(members):
        raise ValueError(f"an ensemble has at least 2 members of different names, got {len(members)}")
    chosen = _runs(case_or_members, runs)
    for case in members:
        for run in chosen:
            require_runnable(case, run)
    methods: dict[str, str | Run] = {model: model for model in models}
    methods |= dict(zip(run_labels(chosen), chosen, strict=True))
    jobs = [
        Job(case=case, method=method, label=label) for case in members for label, method in methods.items()
    ]
    with nullcontext() if resume is None else open_run_store(resume, samples=False) as store:
        results = simulate_all(jobs, workers=workers, progress=progress, store=store)
    table = _members(jobs, results)
    inputs = fingerprint([(job.case.name, job.label, job_fingerprint(job)) for job in jobs])
    about |= {name: _range(members, name) for name in ("semidiagonal", "tan_alpha")} | {"draws": draws}
    about |= {
        "methods": {label: "" if isinstance(m, str) else own_model(m.support) for label, m in methods.items()}
    }
    return ensemble_of(table, about_results(KIND, inputs, seeds={"ensemble": seed}) | about)


def ensemble_of(members: pd.DataFrame, about: dict[str, Any]) -> Ensemble:
    """Return the ensemble of a table of members, and of what `Ensemble.about` says of them."""
    methods, seed = about["methods"], about["seeds"]["ensemble"]
    return Ensemble(
        members=members,
        methods=_methods(members, methods),
        contrasts=_contrasts(members, list(methods), draws=about["draws"], seed=seed),
        about=about,
    )


def read_ensemble(folder: str | Path) -> Ensemble:
    """Return an ensemble whose members were stored as `members.parquet`.

    Raises
    ------
    ValueError
        If the file is missing or is not what was stored.
    """
    file = Path(folder) / TABLE
    members = read_table(file)
    try:
        return ensemble_of(members, read_about(file))
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{file} does not hold the members of an ensemble: {error!r}") from None


def _range(members: Sequence[Case], name: str) -> dict[str, float]:
    values = {float(getattr(case.cylinder, name)) for case in members}
    return {"from": min(values), "to": max(values), "count": len(values)}


def _runs(case_or_members: Case | Suite | Sequence[Case], runs: Iterable[Run] | None) -> tuple[Run, ...]:
    if runs is not None:
        return tuple(runs)
    if isinstance(case_or_members, Suite) and case_or_members.runs:
        return case_or_members.runs
    return default_runs()


def _members(jobs: Sequence[Job], results: Sequence[Any]) -> pd.DataFrame:
    import pandas as pd

    rows = []
    for job, result in zip(jobs, results, strict=True):
        crashed = isinstance(result, Crash)
        failed = crashed or result.outcome == "failed"
        falling = not failed and falls_at_the_end(job.case, result)
        peak = math.nan if failed else 0.5 * math.pi if falling else result.peak_tilt
        rows.append(
            {
                "member": job.case.name,
                "method": job.label,
                "peak_tilt": peak / job.case.cylinder.alpha,
                "outcome": "failed" if failed else "overturned" if falling else result.outcome,
                "message": "; ".join([result.message] * bool(result.message) + [_FALLING] * falling),
                "wall_time": math.nan if crashed else result.wall_time,
            }
        )
    return pd.DataFrame(rows)


def falls_at_the_end(case: Case, result: Any) -> bool:
    """Return whether a run ends on still ground past its balance and on its way down: nothing holds it."""
    alpha, motion = case.cylinder.alpha, case.motion
    if result.outcome == "overturned" or not result.peak_tilt > alpha:
        return False
    still = motion is None or case.length >= motion.duration
    return bool(still and result.tilt[-1] > alpha and result.tilt_rate[-1] >= 0.0)


def _methods(members: pd.DataFrame, methods: Mapping[str, str]) -> pd.DataFrame:
    import pandas as pd

    rows = []
    for method, own in methods.items():
        runs = members[members["method"] == method]
        failed = runs[runs["outcome"] == "failed"]
        standing = runs.loc[~runs["outcome"].isin(["overturned", "failed"]), "peak_tilt"].to_numpy(float)
        fallen = int((runs["outcome"] == "overturned").sum())
        peaks = np.sort([*standing, *[math.inf] * fallen])
        low, median, high = (
            np.quantile(peaks, [0.16, 0.5, 0.84], method="inverted_cdf") if len(peaks) else [math.nan] * 3
        )
        rows.append(
            {
                "method": method,
                "own_model": own,
                "runs": len(runs),
                "rocked": int((runs["peak_tilt"] > 0.0).sum()),
                "overturned": fallen,
                "failed": len(failed),
                "failed_members": ", ".join(failed["member"]),
                "peak_16": low,
                "peak_median": median,
                "peak_84": high,
            }
        )
    return pd.DataFrame(rows)


def _contrasts(members: pd.DataFrame, methods: list[str], *, draws: int, seed: int) -> pd.DataFrame:
    import pandas as pd

    names = members["member"].unique()
    peaks = members.pivot_table("peak_tilt", "member", "method", dropna=False).reindex(names)
    fell = (
        members.assign(fell=members["outcome"] == "overturned")
        .pivot_table("fell", "member", "method", aggfunc="max")
        .reindex(names)
        .astype(bool)
    )
    rows = []
    for against, method in itertools.combinations(methods, 2):
        ours, theirs = (peaks[name].to_numpy(float) for name in (method, against))
        if np.count_nonzero(np.isfinite(ours) & np.isfinite(theirs)) < 2:
            continue
        found = contrast(
            ours, theirs, fell[method].to_numpy(bool), fell[against].to_numpy(bool), draws=draws, seed=seed
        )
        masked = names[~(np.isfinite(ours) & np.isfinite(theirs))]
        rows.append({"method": method, "against": against, **_flat(found), "masked": ", ".join(masked)})
    return pd.DataFrame(rows)


def _flat(found: Contrast) -> dict[str, float | int]:
    row: dict[str, float | int] = {"count": found.count}
    for name in ("ks", "wasserstein", "median_ratio"):
        interval = getattr(found, name)
        row |= {name: interval.value, f"{name}_low": interval.low, f"{name}_high": interval.high}
    names = ("ks_p", "member_factor", "overturned", "against_overturned", "both_overturned", "overturned_p")
    return row | {name: getattr(found, name) for name in names}
