"""Fragility curves with their bands and counts, a panel for each support, and the ratios of the medians."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from rockwobble.models.support import SUPPORTS
from rockwobble.studies import Fragility
from rockwobble.studies.fragility.intensity import MEASURES
from rockwobble.studies.fragility.study import main_contrasts
from rockwobble.studies.fragility.tables import ALL, OVERTURNED, Row

from .ensemble import margin_rules, ratio_axes
from .palette import DARK, GREY, ORDER, Style, mark_styles, pale
from .picture import Axis, Band, Line, Panel, Picture, Rule, caption, table_line, ticks_at

# support of a panel, and its title
_PANELS = {"planar": "Planar analysis"} | {each: each.words.capitalize() for each in SUPPORTS.values()}
_GUIDED = tuple(each for each in SUPPORTS.values() if each.guided)
_COLOURS = (DARK, *ORDER)
_TICKS = (0.1, 0.2, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0, 20.0, 50.0)
_RATIOS = (0.25, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 4.0)
_LINE = 0.42  # inch for a pair of methods
_EDGE = 1.02  # a mark keeps so far within the ends of a logarithmic axis
# symbol of a ratio and its name: within the axis, and beyond its left or right end
_MARKS = {
    (False, False): ("diamond", "ratio of the medians"),
    (True, False): ("triangle-left", "beyond the axis"),
    (False, True): ("triangle-right", "beyond the axis"),
}
_TITLES: Mapping[str | None, str] = {ALL: "Mean of all cylinders"}


def pictures(results: Fragility) -> list[Picture]:
    """Ratios of the medians, and the curves of each cylinder."""
    ratios = _ratios(results)
    curves = [
        _curves(results, str(name), place)
        for place, name in enumerate(results.facts["cylinders"], start=1)
        if ((results.counts["cylinder"] == name) & (results.counts["limit"] == OVERTURNED)).any()
    ]
    return ([ratios] if ratios else []) + curves


def _ratios(results: Fragility) -> Picture | None:
    answers = main_contrasts(results)
    # mean over several cylinders only; values of each are in the table
    cylinder = ALL if len(results.facts["cylinders"]) > 1 else None
    rows = [
        row
        for part in answers.values()
        for row in part
        if math.isfinite(row["ratio"]) and cylinder in (None, row["cylinder"])
    ]
    if not rows:
        return None
    pairs = list(dict.fromkeys((row["method"], row["against"]) for row in rows))
    margin = float(results.facts["margin"])
    ends = [row[f"ratio_{end}"] for row in rows for end in ("low", "high")]
    known = [abs(math.log(end)) for end in ends if 0.0 < end < math.inf]
    reach = min(1.15 * max([*known, 2.0 * math.log1p(margin)]), math.log(4.0))
    low, high = math.exp(-reach), math.exp(reach)
    names = [f"{method}\n/ {against}" for method, against in pairs]
    x_axis, y_axis = ratio_axes("ratio of medians", low, high, _RATIOS, names)
    layers: list[Line | Rule] = [*margin_rules(margin)]
    for row in rows:
        place = pairs.index((row["method"], row["against"]))
        x = np.clip([row["ratio_low"], row["ratio_high"]], low, high)
        y = np.full(2, float(place))
        layers.append(Line(x=x, y=y, name="95 % interval", style=Style(colour=ORDER[0]), width=3.0))
        symbol, name = _MARKS[bool(row["ratio"] < low), bool(row["ratio"] > high)]
        x = np.clip([row["ratio"]], low * _EDGE, high / _EDGE)
        mark = Style(colour=ORDER[0], dash="none", symbol=symbol)
        layers.append(Line(x=x, y=y[:1], name=name, style=mark))
    title = _TITLES.get(cylinder, "")
    panel = Panel(x=x_axis, y=y_axis, layers=layers, title=title, height=_LINE * len(pairs) + 1.0)
    return Picture(
        name="fragility-ratios",
        caption=caption("fragility_ratios", share=margin, names=tuple(results.facts["cylinders"])),
        panels=[panel],
    )


def _curves(results: Fragility, cylinder: str, place: int) -> Picture:
    methods: Mapping[str, Row] = results.facts["methods"]
    guided = [name for name, own in methods.items() if own["support"] in _GUIDED and not own["engine"]]
    panels = []
    for support, title in _PANELS.items():
        labels = [name for name, own in methods.items() if own["support"] == support]
        shown = labels if support in _GUIDED else [*guided, *labels]
        # a panel of one curve only if there is only one method
        if labels and (len(shown) > 1 or len(methods) == 1):
            panels.append(_panel(results, cylinder, shown, title))
    measure = MEASURES[str(results.facts["measure"])]
    drawn = (results.curves["cylinder"] == cylinder) & (results.curves["limit"] == OVERTURNED)
    return Picture(
        name=f"fragility-{place}",
        caption=caption(
            "fragility_curves" if drawn.any() else "fragility_marks", name=cylinder, detail=measure.title
        ),
        panels=panels,
        columns=2,
        legend="panels",
    )


def _panel(results: Fragility, cylinder: str, labels: Sequence[str], title: str) -> Panel:
    counts, curves = (
        table[(table["cylinder"] == cylinder) & (table["limit"] == OVERTURNED)]
        for table in (results.counts, results.curves)
    )
    measure = MEASURES[str(results.facts["measure"])]
    backs: list[Band | Line] = []
    fronts: list[Band | Line] = []
    for index, (label, style) in enumerate(mark_styles(labels).items()):
        colour = _COLOURS[index % len(_COLOURS)]
        own = curves[curves["method"] == label]
        if len(own):
            x, low, high = (own[name].to_numpy(float) for name in ("intensity", "low", "high"))
            shade = "#d9d9d9" if colour == DARK else pale(pale(colour))
            backs.append(Band(x=x, low=low, high=high, colour=shade, name="95 % bands"))
            line = Style(colour=colour, dash=style.dash)
            fronts.append(table_line(own, "intensity", "probability", label, line, width=1.8))
        part = _groups(counts[counts["method"] == label])
        mark = Style(colour=colour, dash="none", symbol=style.symbol)
        notes = [f"{label}: {k} of {n}" for k, n in zip(part["k"], part["n"], strict=True)]
        marks = table_line(
            part.assign(share=part["k"] / part["n"]), "intensity", "share", style=mark, size=4.0
        )
        fronts.append(replace(marks, name="" if len(own) else label, notes=notes))
    shown = counts["intensity"]
    ends = 0.9 * float(shown.min()), 1.1 * float(shown.max())
    x_axis = Axis(label=measure.title, unit=measure.unit, log=True, low=ends[0], high=ends[1])
    return Panel(
        x=replace(x_axis, ticks=ticks_at(_TICKS, *ends)),
        y=Axis(label="probability of overturning", unit="-", low=-0.02, high=1.02),
        layers=[*backs, Rule(at=0.5, axis="y", colour=GREY), *fronts],
        title=title,
        height=2.9,
    )


def _groups(counts: pd.DataFrame) -> pd.DataFrame:
    """Counts of a cloud in ten groups of runs, each at its mean log intensity; of stripes unchanged."""
    if len(counts) <= 40:
        return counts
    ordered = counts.sort_values("intensity")
    group = (np.arange(len(ordered)) * 10) // len(ordered)
    parts = [part for _, part in ordered.groupby(group)]
    return pd.DataFrame(
        {
            "intensity": [math.exp(float(np.log(part["intensity"]).mean())) for part in parts],
            "n": [int(part["n"].sum()) for part in parts],
            "k": [int(part["k"].sum()) for part in parts],
        }
    )
