"""Peak tilts of an ensemble: their distributions by every method, and each member by two methods."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from typing import Literal

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.contrast import pairs_in
from rockwobble.compare.metrics.statistics import MARGIN
from rockwobble.models.trace import NO_PEAK
from rockwobble.studies import Ensemble
from rockwobble.studies.ensemble_findings import main_pairs
from rockwobble.studies.fragility.tables import Row

from .palette import DARK, ORDER, SHADED, Style, label_styles
from .picture import (
    Array,
    Axis,
    Line,
    Panel,
    Picture,
    Rule,
    Text,
    caption,
    ecdf,
    list_axis,
    log_ticks,
    ticks_at,
)

# beyond the largest ratio, and at least beyond the margin
_ROOM = 1.25
_DOTS, _BEYOND = Style(colour=ORDER[0], dash="none", symbol="circle"), ORDER[1]
_MEDIAN = Style(colour=DARK, dash="none", symbol="diamond")
_LINE = 0.5  # inch for a pair of methods


def pictures(ensemble: Ensemble) -> list[Picture]:
    """Distribution of each method, and the ratios of the members of the main pairs."""
    rows = [row for row in main_pairs(ensemble.methods, ensemble.contrasts) if row["compared"]]
    models = ensemble.methods.loc[ensemble.methods["own_model"] == "", "method"]
    panels = [distributions(ensemble.members, list(models)), *([_ratios(ensemble, rows)] if rows else [])]
    picture = Picture(
        name="ensemble",
        caption=caption("ensemble", share=MARGIN, name=ensemble.facts.get("members")),
        panels=panels,
        legend="panels",
    )
    return [picture]


def distributions(members: pd.DataFrame, models: Collection[str], what: str = "members") -> Panel:
    """Empirical distribution of peak tilt over alpha by method; models are drawn as such."""
    standing = members.loc[members["outcome"] != "overturned", "peak_tilt"]
    largest = float(standing.max(skipna=True)) if standing.notna().any() else 0.0
    end = 1.05 * largest or 1.0
    layers: list[Line] = []
    for method, style in label_styles(list(members["method"].unique()), models).items():
        runs = members[members["method"] == method]
        if (~runs["outcome"].isin(NO_PEAK)).any():
            layers += peak_shares(runs, method, style, end, width=1.6, notes=True)
    return Panel(
        x=Axis(label="peak tilt / α", unit="-", low=0.0, high=end),
        y=Axis(label=f"share of the {what}", unit="-", low=0.0, high=1.03),
        layers=layers,
        title="Peak tilt",
        height=3.4,
    )


def peak_shares(
    runs: pd.DataFrame, name: str, style: Style, end: float, *, width: float = 1.4, notes: bool = False
) -> Iterator[Line]:
    """Yield the empirical distribution of peak tilt, and a triangle for the overturned share.

    Runs that failed have no part in it; `notes` name the member of each step.
    """
    known = runs[~runs["outcome"].isin(NO_PEAK)]
    stands = known[known["outcome"] != "overturned"].sort_values("peak_tilt")
    fallen = len(known) - len(stands)
    x, y = ecdf(stands["peak_tilt"].to_numpy(float), total=len(known), end=end)
    label = f"{name} ({fallen} of {len(known)} overturn)"
    names = ["", *map(str, stands["member"]), ""] if notes else ()
    yield Line(x=x, y=y, name=label, style=style, width=width, steps=True, notes=names)
    if fallen:
        mark = Style(colour=style.colour, dash="none", symbol="triangle-right")
        yield Line(x=x[-1:], y=y[-1:], style=mark, size=7.0, clip=False)


def _ratios(ensemble: Ensemble, rows: list[Row]) -> Panel:
    both = [pairs_in(ensemble.members, row["method"], row["against"]) for row in rows]
    logarithms = [each.log_ratios() for each in both]
    low, high = ratio_span(np.concatenate(logarithms))
    layers: list[Line | Rule | Text] = [*margin_rules(MARGIN)]
    names = []
    for place, (row, each, logs) in enumerate(zip(rows, both, logarithms, strict=True)):
        has = ~np.isnan(logs)
        ratios, members = np.exp(logs[has]), each.members[has]
        inside = (ratios > 0.0) & np.isfinite(ratios)
        y, notes = np.full(inside.sum(), place - 0.2), list(map(str, members[inside]))
        layers += [
            Line(x=ratios[inside], y=y, name="members", style=_DOTS, opacity=0.6, notes=notes),
            _bar(row, "05 95", place, (low, high), "5 to 95 % of the members", 1.0),
            _bar(row, "low high", place, (low, high), "95 % interval of the median", 3.5),
            *_beyond(ratios, place, low, high),
        ]
        if low <= row["ratio"] <= high:
            at = np.array([row["ratio"]]), np.array([place + 0.2])
            layers.append(Line(x=at[0], y=at[1], name="median", style=_MEDIAN))
        names.append(f"{row['method']}\n/ {row['against']}, n = {has.sum()}")
    x_axis, y_axis = ratio_axes("ratio of peaks", low, high, log_ticks(low, high), names)
    title = "Ratio of the peaks of each member"
    return Panel(x=x_axis, y=y_axis, layers=layers, title=title, height=_LINE * len(rows) + 1.4)


def margin_rules(margin: float) -> list[Rule]:
    """Line at a ratio of 1 on the strip of the margin."""
    return [
        Rule(at=1.0 / (1.0 + margin), until=1.0 + margin, axis="x", colour=SHADED),
        Rule(at=1.0, axis="x"),
    ]


def ratio_axes(
    label: str, low: float, high: float, ticks: Sequence[float], names: Sequence[str]
) -> tuple[Axis, Axis]:
    """Axis of ratios, and axis with the names as a list."""
    x = Axis(label=label, unit="-", log=True, low=low, high=high, ticks=ticks_at(ticks, low, high))
    return x, list_axis(names)


def _bar(row: Row, ends: str, place: int, span: tuple[float, float], name: str, width: float) -> Line:
    x = np.clip([row[f"ratio_{end}"] for end in ends.split()], *span)
    return Line(x=x, y=np.full(2, place + 0.2), name=name, style=Style(colour=DARK), width=width)


def _beyond(ratios: Array, place: int, low: float, high: float) -> list[Line | Text]:
    """Triangle at each edge with the number of members that overturn by one method only."""
    marks: list[Line | Text] = []
    for edge, side, which in ((low, "left", ratios == 0.0), (high, "right", np.isinf(ratios))):
        if which.any():
            mark = Style(colour=_BEYOND, dash="none", symbol=f"triangle-{side}")
            inside = edge * (high / low) ** (0.02 if side == "left" else -0.02)
            anchor: Literal["left", "right"] = "left" if side == "left" else "right"
            marks += [
                Line(x=np.array([edge]), y=np.array([place - 0.2]), style=mark, size=7.0, clip=False),
                Text(x=inside, y=place - 0.2, text=str(which.sum()), colour=_BEYOND, anchor=anchor),
            ]
    return marks


def ratio_span(logarithms: Array) -> tuple[float, float]:
    """Ends of the ratio axis, symmetric about 1; ratios beyond lie at the edges."""
    known = np.abs(logarithms[np.isfinite(logarithms)])
    reach = _ROOM * max(float(known.max(initial=0.0)), 2.0 * math.log1p(MARGIN))
    return math.exp(-reach), math.exp(reach)
