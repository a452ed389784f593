"""Findings of a comparison: agreement, causes of divergence, mistakes, budgets, supports."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from rockwobble.models import AGREEMENT, Case, Trace
from rockwobble.models.case import FLAT_MODEL, RECESS_MODEL, REDUCED
from rockwobble.models.finding import Finding, Value
from rockwobble.models.frames import pd
from rockwobble.models.mode import REST, SLIDES, expected_mode
from rockwobble.models.support import EXTERNAL, SUPPORTS

from ..external.mistakes import ENERGY_LOSS
from ..external.verdict import mistakes_of
from ..metrics.mode import mode_findings, slide_finding
from ..metrics.pair import make_pair
from .budget import COVERED, LARGEST_SHARE, WORTH_EXPLAINING, ErrorBudget, unexplained_rows
from .prediction import BEATEN
from .summary import SummaryRow, own_rows, rows_of

_LISTED = 10  # largest number of rows named one by one
_SAME_END = 0.1  # [s] ends of agreements that are stated as equal


def case_findings(
    case: Case,
    rows: pd.DataFrame,
    traces: Mapping[str, Trace],
    causes: Sequence[str],
    budgets: pd.DataFrame,
) -> Iterator[Finding]:
    """Findings on one case, in order of weight.

    Parameters
    ----------
    case : Case
    rows : DataFrame
        Its rows of the summary, with the verdicts on external trajectories.
    traces : mapping
        Its traces by label.
    causes : sequence of str
        Of each row, see `cause`; empty where the run agrees to its end.
    budgets : DataFrame
        Its rows of `Comparison.budget_rms`.
    """
    summary = list(rows_of(rows))
    sound = [row for row in summary if "failed" not in (row.outcome, row.reference_outcome)]
    driven = {row.support: "" for row in summary if row.engine != REDUCED and row.support != EXTERNAL}
    modes = {expected_mode(case, each) for each in driven}
    for each in list(driven)[: 1 if len(modes) == 1 else None]:  # a single mode is stated once
        yield from mode_findings(case, each, named=len(modes) > 1)
    slid = [trace for trace in traces.values() if trace.run.is_model and trace.mode == SLIDES]
    yield from (slide_finding(each.peak_displacement, each.residual_displacement) for each in slid)
    for label, trace in traces.items():
        if trace.outcome == "failed":
            yield Finding(key="comparison.failed", level="caution", values={"name": label})
    yield from agreements(rows[rows["outcome"] != "failed"], case.length)
    moving = [trace for trace in traces.values() if trace.mode not in ("", REST)]
    if sound and not moving:
        yield Finding(key="comparison.at_rest")
    late = [label for label, trace in traces.items() if len(trace.time) and trace.peak_time > trace.time[-1]]
    if late:
        yield Finding(key="comparison.late_peak", values={"names": tuple(late)})
    yield from _causes(zip(summary, causes, strict=True))
    yield from (each for row in sound if row.support == EXTERNAL for each in _mistakes(row))
    yield from budget_findings(rows, budgets)
    supports = dict.fromkeys(SUPPORTS.get(row.support) for row in summary if row.engine != REDUCED)
    for support in filter(None, supports):
        walls, guided = support.walls, support.guided
        yield Finding(
            key="comparison.on_walls" if walls else "comparison.on_guide" if guided else "comparison.on_flat"
        )


# keys for tilt and slide: diverging, and in tolerance to the end
AGREE = (
    ("comparison.agree", "comparison.agree_to_end"),
    ("comparison.agree_slide", "comparison.agree_slide_to_end"),
)


def agreements(rows: pd.DataFrame, length: float) -> Iterator[Finding]:
    """Findings on the agreement of the runs of each support with their own model; external ones singly.

    Parameters
    ----------
    rows : DataFrame
        Rows of one case that did not fail.
    length : float
        Length of the run [s].
    """
    own = own_rows(rows)
    if not len(own):
        yield Finding(key="comparison.none")
    groups = own["support"].where(own["support"] != EXTERNAL, own["run"])
    for _, group in own.groupby(groups, sort=False):
        summary = list(rows_of(group))
        first, ends = summary[0], [row.within_tolerance_until for row in summary]
        external = first.support == EXTERNAL
        labels = dict.fromkeys(
            row.run if external or row.engine == REDUCED else row.engine for row in summary
        )
        left = any(row.left_tolerance for row in summary)
        yield Finding(
            key=AGREE[first.reference_mode == SLIDES][not left],
            level="note",
            values={
                "reason": first.support,
                "names": tuple(labels),
                "names_reference": tuple(dict.fromkeys(row.reference for row in summary)),
                # the tolerance of a small peak is a tenth of it; that of a measurement includes its noise
                "difference": first.tolerance + (first.tilt_bound - AGREEMENT if external else 0.0),
                "until": min(ends),
                "until_last": max(ends) if max(ends) - min(ends) > _SAME_END else None,
                # the file of an external trajectory may end before the run does
                "until_whole": length if not left and max(ends) < length * (1.0 - 1e-9) else None,
            },
            runs=str(first.support),
        )
        if external and (first.differs_in or first.not_compared):
            names = tuple(part for part in first.differs_in if part != "tilt")
            yield Finding(
                key="comparison.differs",
                values={"name": first.run, "names": names, "names_left": tuple(first.not_compared)},
            )


def cause(row: SummaryRow, length: float, *, touched: bool = False, models_differ: bool = True) -> str:
    """Cause of the divergence of a run from its reference, a name among the words of comparison.

    Parameters
    ----------
    row : namedtuple
        Row of the summary.
    length : float
        Length of the run [s].
    touched : bool, optional
        Whether the run met a wall.
    models_differ : bool, optional
        Whether the models of recess and flat ground differ by then: else it is not for the support.

    Returns
    -------
    str
        "failed"; "support" or "walls", a difference of support, not of accuracy; "mistake" of an external
        trajectory, or "loss" of its energy; "slides", which the reference does not;
        "pass", one that contact does not resolve; "near_passes", which amplify what small difference there
        is; "method", without a pass, so that it is not chance.
    """
    if "failed" in (row.outcome, row.reference_outcome):
        return "failed"
    support, reference = (SUPPORTS.get(each, EXTERNAL) for each in (row.support, row.reference_support))
    if support == EXTERNAL:
        if explains_divergence(row):
            return "loss" if _loses(row) else "mistake"
    elif support.walls:
        if not reference.walls and (reference.guided or touched):
            return "walls"
    elif not support.guided and reference.guided and models_differ:
        return "support"
    if SLIDES in row.mode and SLIDES not in row.reference_mode:
        return "slides"
    by_pass = row.predicted_by == "pass" and support != EXTERNAL and row.predicted_until < length
    start = row.reference_uplift_time
    agreed, predicted = row.within_tolerance_until - start, row.predicted_until - start
    if by_pass and predicted <= agreed <= BEATEN * predicted:  # a pass survived for longer had no effect
        return "pass"
    return "near_passes" if math.isfinite(row.closest_pass) else "method"


def causes_of(case: Case, rows: pd.DataFrame, traces: Mapping[str, Trace]) -> list[str]:
    """Cause of each row of a case, see `cause`; empty where the run agrees to its end."""
    recess, flat = (traces.get(str(model)) for model in (RECESS_MODEL, FLAT_MODEL))

    def models_differ(row: SummaryRow) -> bool:
        """Whether half of the difference at the end of an agreement is between the models."""
        if recess is None or flat is None or not (len(recess.time) and len(flat.time)):
            return True
        pair = make_pair(case.cylinder, recess, flat, until=row.within_tolerance_until)
        return bool((abs(pair.tilt_difference) > 0.5 * row.tolerance).any())

    return [
        cause(
            row,
            case.length,
            touched=any(fact.code == "wall_contact" for fact in traces[row.run].facts),
            models_differ=models_differ(row),
        )
        if row.left_tolerance
        else ""
        for row in rows_of(rows)
    ]


def explains_divergence(row: SummaryRow) -> bool:
    """Whether the likely mistake explains diverging tilts (rotated axes do not)."""
    return any(mistake.changes_tilt for mistake in mistakes_of(row))


_KEYS = {
    "slides": "comparison.slides",
    "support": "comparison.support",
    "walls": "comparison.walls",
    "pass": "comparison.pass",
    "near_passes": "comparison.near_passes",
    "method": "comparison.method",
}


def _causes(rows: Iterator[tuple[SummaryRow, str]]) -> Iterator[Finding]:
    """Findings for each cause and reference, with the runs that diverge from it."""
    groups: dict[tuple[str, str], list[str]] = {}
    for row, name in rows:
        groups.setdefault((name, row.reference), []).append(row.run)
    for name, key in _KEYS.items():
        for (of, reference), runs in groups.items():
            if of == name:
                yield Finding(key=key, values={"names": tuple(runs), "name_reference": reference})
    if any(name in _KEYS for name, _ in groups):
        yield Finding(key="comparison.distributions")


def _mistakes(row: SummaryRow) -> Iterator[Finding]:
    """Likely mistakes of an external trajectory, and the differences that they explain."""
    mistakes, loses = mistakes_of(row), _loses(row)
    values = {"name": row.run, "detail": "; ".join(mistake.words for mistake in mistakes)}
    explained = explains_divergence(row) and (not loses or len(mistakes) > 1)
    if not mistakes:
        if {"azimuth", "path"} & {*row.differs_in}:
            yield Finding(key="comparison.unlike", level="caution", values={"name": row.run})
    elif loses and not explained:
        yield Finding(key="comparison.loss_unexplained", level="caution", values=values)
    elif "tilt" in row.differs_in and not explained:
        yield Finding(key="comparison.mistake_besides", level="caution", values=values)
    else:
        left = tuple(name for name in row.differs_without_mistake if name != "tilt")
        # a run that never diverges agrees until its end
        start = row.reference_uplift_time if "tilt" in row.differs_without_mistake else 0.0
        until = start + row.agreement_without_mistake
        yield Finding(
            key="comparison.loss" if loses else "comparison.mistake",
            level="caution",
            values={**values, "until": until, "names": left},
        )


def _loses(row: SummaryRow) -> bool:
    """Whether an external trajectory loses energy that its model does not."""
    return ENERGY_LOSS in row.likely_mistake


def budget_findings(summary: pd.DataFrame, budgets: pd.DataFrame) -> Iterator[Finding]:
    """Findings on divergences earlier than predicted, and on budgets: large unexplained parts first.

    Of external trajectories nobody predicts a divergence: the prediction rests on the errors of an engine.
    """
    early = (summary["divergence"] == "earlier") & (summary["support"] != EXTERNAL)
    for row in rows_of(summary[early]):
        yield Finding(key="comparison.earlier", level="caution", values=_pair(row))
    if not len(budgets):
        return
    large = budgets[budgets["whole_rms"] > WORTH_EXPLAINING]
    split, left = large[large["not_split"] == ""], unexplained_rows(budgets)
    for row in rows_of(left.head(_LISTED)):
        sizes = {"difference": row.whole_rms, "difference_limit": row.limit_error}
        yield Finding(
            key="comparison.unexplained",
            level="caution",
            values={**_pair(row), "share": row.unexplained_share, **sizes},
        )
    if (more := len(left) - _LISTED) > 0:
        yield Finding(key="comparison.more_unexplained", level="caution", values={"count": more})
    if len(split):
        counts = {
            "count": len(split) - len(left),
            "count_of": len(split),
            "count_less": len(budgets) - len(large),
        }
        bounds = {"share": LARGEST_SHARE, "difference": WORTH_EXPLAINING}
        yield Finding(key="comparison.explained", values={**bounds, **counts})
    elif not len(large):
        yield Finding(key="comparison.small", values={"difference": WORTH_EXPLAINING})
    for reason, count in large.loc[large["not_split"] != "", "not_split"].value_counts().items():
        yield Finding(
            key="comparison.not_split", values={"count": int(count), "reason": f"not_split_{reason}"}
        )
    if missing := len(summary) - len(budgets):
        yield Finding(key="comparison.no_budget", values={"count": missing})


def parts_finding(budget: ErrorBudget | None, reference: str) -> Finding:
    """Finding of the parts of a difference; only the run's own reference has an error budget."""
    if budget is None:
        return Finding(key="comparison.no_parts")
    sizes = {part: budget.rms(part) for part in ("whole", "model_form", "limit_error")}
    if not budget.not_split:
        sizes |= {part: budget.rms(part) for part in ("numerics", "unexplained")}
    values: dict[str, Value] = {f"difference_{part}": size for part, size in sizes.items()}
    values |= {"name_reference": reference, "until": budget.covered, "share": COVERED}
    values["names"] = tuple(f"{step:g}" for step in budget.steps)
    return Finding(key="comparison.parts", values=values)


def _pair(row: SummaryRow) -> dict[str, Value]:
    return {"name": row.case, "name_run": row.run, "name_reference": row.reference}


def overview(summary: pd.DataFrame, budgets: pd.DataFrame) -> Iterator[Finding]:
    """Findings on many cases together: runs that agree, verdicts on predictions, budgets."""
    own = own_rows(summary)
    failed = int((own["outcome"] == "failed").sum())
    counts = {
        "count": int((~own["left_tolerance"]).sum()),
        "count_of": len(own),
        "count_failed": failed or None,
    }
    yield Finding(key="comparison.agreeing", values=counts)
    yield from budget_findings(summary, budgets)
    verdicts = summary.loc[summary["support"] != EXTERNAL, "divergence"].value_counts()
    for verdict, count in verdicts.items():
        if verdict:
            yield Finding(key="comparison.predicted", values={"count": int(count), "reason": str(verdict)})
