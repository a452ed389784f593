"""Findings of an ensemble, from the numbers of its tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd

from rockwobble.compare.metrics.statistics import (
    FEWEST,
    MARGIN,
    POWER,
    SIGNIFICANCE,
    largest_share_unseen,
    least_significant_count,
    value_if_enough,
)
from rockwobble.models.finding import Finding, Level, Value

Row = dict[str, Any]
_SHOWN = 4  # pairs of methods that differ and are named
_NOT_DETECTABLE = 1e9  # ratio that no interval of the members could tell from 1
_ANSWERS: Mapping[str, tuple[str, Level]] = {
    "within": ("ensemble.equivalent", "satisfied"),
    "beyond": ("ensemble.different", "not satisfied"),
    "undecided": ("ensemble.undecided", "not tested"),
}


def rows_of(table: pd.DataFrame) -> list[Row]:
    """Rows of a table by the names of its columns."""
    return [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]


def main_pairs(methods: pd.DataFrame, contrasts: pd.DataFrame) -> list[Row]:
    """Main rows of the contrasts: engines compared with their reduced model, then models."""
    rows = rows_of(contrasts)
    own = dict(zip(methods["method"], methods["own_model"], strict=True))
    engines = [row for row in rows if own[row["method"]] and own[row["method"]] == row["against"]]
    models = [row for row in rows if not own[row["method"]] and not own[row["against"]]]
    return engines + models or rows


def ensemble_findings(members: int, methods: pd.DataFrame, contrasts: pd.DataFrame) -> Iterator[Finding]:
    """Findings: equivalence of the main pairs, what differs significantly, what failed."""
    main = main_pairs(methods, contrasts)
    if not main:
        yield Finding(key="ensemble.no_pairs", level="not tested")
    for verdict, (key, level) in _ANSWERS.items():
        if names := tuple(_names(row) for row in main if row["verdict"] == verdict):
            yield Finding(key=key, level=level, values={"share": MARGIN, "names": names})
    yield from map(_pair, main)
    if main and members < FEWEST:
        yield Finding(key="ensemble.few", values={"count": FEWEST})
    if main:
        # equivalent pairs first, then by p value
        yield from _differences([*main, *rows_of(contrasts.sort_values("ratio_p"))])
        yield from _overturning(contrasts, bool(methods["overturned"].any()))
    for row in methods[methods["failed"] > 0].to_dict("records"):
        least, most = (row.get(f"peak_median_{end}", math.nan) for end in ("least", "most"))
        values = {"name": row["method"], "runs": row["runs"], "runs_failed": row["failed"]}
        values |= {"detail": row["failed_members"]}
        if least < most:
            values |= {"peak_least": least, "peak_most": most}
        yield Finding(key="ensemble.failed", level="caution", values=values)


def _pair(row: Row) -> Finding:
    """Finding on the difference of one pair of methods."""
    values: dict[str, Value] = {"name": row["method"], "name_reference": row["against"], "share": MARGIN}
    values |= {"runs": row["compared"], "count_higher": row["higher"], "count_lower": row["lower"]}
    ratio = value_if_enough(row["ratio"], row["compared"], ratio=True)
    if ratio is not None and math.isfinite(ratio):
        values["ratio"] = ratio, row["ratio_low"], row["ratio_high"]
    values["p"] = row["ratio_p"]
    if row["within_reach"] < _NOT_DETECTABLE:
        values |= {"ratio_detectable": row["within_reach"], "share_power": POWER}
    elif row["compared"]:
        values["reason_detectable"] = "not_detectable"
    least, most = (row.get(f"ratio_{end}", math.nan) for end in ("least", "most"))
    if least < most:
        values |= {"ratio_least": least, "ratio_most": most}
    if row["overturned"] or row["against_overturned"]:
        values |= {"overturned": row["overturned"], "overturned_reference": row["against_overturned"]}
        values |= {
            "overturned_both": row["both_overturned"],
            "count": row["count"],
            "p_overturned": row["overturned_p"],
        }
    return Finding(key="ensemble.pair", level=_ANSWERS[row["verdict"]][1], values=values)


def _names(row: Row) -> str:
    return f"{row['method']} with {row['against']}"


def _differences(rows: Sequence[Row]) -> Iterator[Finding]:
    every = {_names(row): row for row in rows}
    apart = [name for name, row in every.items() if row["ratio_p_adjusted"] < SIGNIFICANCE]
    values: dict[str, Value] = {"bound": SIGNIFICANCE, "count": len(every) if len(every) > 1 else None}
    if apart:
        more = len(apart) - _SHOWN
        values |= {"names": tuple(apart[:_SHOWN]), "count_more": more if more > 0 else None}
    yield Finding(key="ensemble.significant" if apart else "ensemble.not_significant", values=values)


def _overturning(contrasts: pd.DataFrame, any_falls: bool) -> Iterator[Finding]:
    differ = contrasts[contrasts["overturned_p_adjusted"] < SIGNIFICANCE]
    if not any_falls:
        unseen = largest_share_unseen(int(contrasts["count"].min()))
        yield Finding(key="ensemble.none_overturns", values={"share": unseen})
    elif len(differ):
        names = tuple(map(_names, rows_of(differ)))
        yield Finding(key="ensemble.overturning_differs", values={"names": names, "bound": SIGNIFICANCE})
    else:
        yield Finding(key="ensemble.overturning_alike", values={"count": least_significant_count()})
