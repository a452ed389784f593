"""Sliding displacement of a case, of its perturbed copies, and under other records of equal strength."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from rockwobble.compare.metrics.mode import slide_finding
from rockwobble.compare.metrics.statistics import share_interval
from rockwobble.compare.runs.execution import Job, simulate_all, simulate_run
from rockwobble.models import Case, Run
from rockwobble.models.finding import Finding, Value
from rockwobble.models.frames import pd
from rockwobble.models.mode import ROCKS_AND_SLIDES, expected_mode
from rockwobble.models.support import FLAT, RECESS, support_named

from .grades import grade_chance
from .members import ACCELERATION, COPIES

ENGINE_COPIES = 5
SLIPS = 0.05  # share of the time in motion with too little friction from which the motion is another one
_COLUMNS = ["group", "member", "displacement", "residual_displacement"]


def slide_rows(groups: Mapping[str, Sequence[Case]], model: Run) -> pd.DataFrame:
    """Peak and residual displacement [m] of each case of each group, by the sliding model."""
    rows = [
        (name, case.name, trace.peak_displacement, trace.residual_displacement)
        for name, cases in groups.items()
        for case in cases
        for trace in [simulate_run(case, model)]
    ]
    return pd.DataFrame(rows, columns=_COLUMNS)


def slides_and_rocks(case: Case, support: str, slip: float) -> bool:
    """Whether a case may slide while it rocks, which only an engine can simulate.

    Parameters
    ----------
    case : Case
    support : str
    slip : float
        Share of the time in motion in which the model's friction demand exceeds the friction of the case.
    """
    free = support_named(support).lets_slide
    return free and (expected_mode(case, support) == ROCKS_AND_SLIDES or slip > SLIPS)


def engine_rows(cases: Sequence[Case], run: Run) -> pd.DataFrame:
    """Outcome, peak_tilt [alpha] and displacement [m] of an engine under copies of a case."""
    traces = simulate_all([Job(case=case, run=run) for case in cases[:ENGINE_COPIES]])
    rows = [
        (trace.outcome, trace.peak_tilt / trace.case.cylinder.alpha, trace.peak_displacement)
        for trace in traces
    ]
    return pd.DataFrame(rows, columns=["outcome", "peak_tilt", "displacement"])


def engine_finding(rows: pd.DataFrame | None, engine: str, peak: float) -> Finding:
    """Finding on an engine run that can slide, compared with the model's peak tilt without slip [alpha]."""
    if rows is None:
        return Finding(key="mode.no_engine", level="not tested")
    values: dict[str, Value] = {
        "name": engine,
        "runs": len(rows),
        "overturned": int((rows["outcome"] == "overturned").sum()),
        "peak": float(rows["peak_tilt"].max()),
        "displacement": float(rows["displacement"].max()),
        "peak_model": peak,
    }
    return Finding(key="mode.engine", level="caution", values=values)


def slide_findings(
    rows: pd.DataFrame, peak: float, residual: float, *, source: str, gap: float | None
) -> Iterator[Finding]:
    """Findings on sliding: as given with the interval of its copies, each other group, and a gap [m].

    Parameters
    ----------
    rows : DataFrame
        Of `slide_rows`.
    peak, residual : float
        Displacements of the case as given [m].
    source : {"p695", "synthetic"}
        Of the other records.
    gap : float, optional
        Distance to a neighbour [m].
    """
    moved = rows[["displacement", "residual_displacement"]]
    copies = moved[rows["group"] == COPIES].dropna()
    yield slide_finding(peak, residual, copies.to_numpy().tolist())
    kind = "measured records" if source == "p695" else "synthetic motions"
    for group, members in rows.groupby("group", sort=False):
        runs = members.dropna()
        name = f"{len(runs)} copies"
        if group != COPIES:
            name = f"{len(runs)} {kind}, same {'PGA' if group == ACCELERATION else 'PGV'}"
            most, end = runs[["displacement", "residual_displacement"]].quantile(0.95, interpolation="higher")
            ends = {"displacement_most": float(most), "displacement_end": float(end)}
            yield Finding(key="mode.slide_group", values={"name": name, **ends}, runs=str(group))
        if gap is not None and len(runs):
            used = share_interval(int((runs["displacement"] > gap).sum()), len(runs))
            share = used.value, used.low, used.high
            values: dict[str, Value] = {"name": name, "length": gap, "share": share}
            yield Finding(key="mode.gap", level=grade_chance(used.value), values=values)


def usual_support(case: Case, *, friction_given: bool) -> str:
    """Default support of an advice: flat ground if friction cannot hold the base, else a recess."""
    alone = case.tendon is None and case.cylinder.slab_mass_ratio == 0.0 and not case.is_release
    return FLAT if friction_given and alone and case.friction < case.friction_of_uplift else RECESS
