"""Picture of an advice: outcome, trace and spread of copies, other scales, and friction."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np

from rockwobble.compare.metrics.pair import overturned
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.finding import Finding
from rockwobble.models.trace import NO_PEAK
from rockwobble.studies.advice.advice import Advice
from rockwobble.studies.spectrum.parts import SERIES

from .ensemble import peak_shares
from .palette import GREY, Style, model_style, run_styles
from .picture import TIME, Axis, Band, Line, Panel, Picture, Rule, caption, table_line, ticks_at
from .spectrum import NAMES, series_styles

SHORT = {"copies": "copies", "acceleration": "same acceleration", "velocity": "same velocity"}
_STANDS, _SIDE = 1.2, 1.3  # [balance tilt] where tilts are cut, and where overturned runs are drawn
_LOW = 1.8  # height of the panel beside the grades [inch]
_SCALES = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)


def pictures(results: Advice) -> list[Picture]:
    """Picture of an advice; none without runs to draw."""
    panels = []
    if results.moves:
        panels += [_peaks(results), _tilt(results)]
    if len(results.scales):
        panels.append(_scales(results))
    if results.moves:
        panels.append(_friction(results))
    picture = Picture(
        name="advice",
        caption=caption("advice", name=results.facts["case"]),
        panels=panels,
        columns=2,
        legend="panels",
    )
    return [picture] if panels else []


def parts_of(picture: Picture) -> tuple[Picture, Picture]:
    """Panel of peak tilts for the page head, and the other panels."""
    assert isinstance(picture.caption, Finding)
    peaks, details = (caption(f"advice_{part}", **picture.caption.values) for part in ("peaks", "details"))
    first, *others = picture.panels
    low = replace(first, title="", height=_LOW)
    return (
        replace(picture, name="advice-peaks", caption=peaks, panels=[low], columns=1),
        replace(picture, caption=details, panels=others),
    )


def _peaks(results: Advice) -> Panel:
    members = results.members
    groups = [name for name in SHORT if (members["group"] == name).any()]
    styles = run_styles(groups)
    standing = members[~members["outcome"].isin(["overturned", *NO_PEAK])]
    end = 1.05 * max(float(standing["peak_tilt"].max()), 0.1) if len(standing) else 1.0
    layers: list[Line] = []
    for name in groups:
        layers += peak_shares(members[members["group"] == name], SHORT[name], styles[name], end)
    if not results.overturned:
        here = Style(colour=model_style(results.facts["model"]).colour, dash="none", symbol="diamond")
        copies = members[(members["group"] == "copies") & (members["outcome"] != "failed")]
        rank = float((copies["peak_tilt"] < results.peak).mean()) if results.copies_differ else math.nan
        at = np.array([results.peak]), np.array([rank])
        layers.append(Line(x=at[0], y=at[1], name="as given", style=here, size=7.0))
    return Panel(
        x=Axis(label="largest tilt / α", unit="-", low=0.0, high=end),
        y=Axis(label="share of the runs", unit="-", low=0.0, high=1.03),
        layers=layers,
        title="Largest tilt",
    )


def _tilt(results: Advice) -> Panel:
    model, most = results.facts["model"], _STANDS * _balance(results)
    time, low, high = (results.band[name].to_numpy(float) for name in ("time", "low", "high"))
    band = Band(x=time, low=np.minimum(low, most), high=np.minimum(high, most), name="90 % of the copies")
    layers: list[Band | Line | Rule] = [band]
    shown = [(results.trace, model, model_style(model), 1.1)]
    if results.verification is not None and len(results.engine):
        label = results.verification.label
        shown.insert(0, (results.engine, label, run_styles([label])[label], 1.8))
    for table, name, style, width in shown:
        cut = table.assign(tilt=table["tilt"].clip(upper=most))
        layers.append(table_line(cut, "time", "tilt", name, style, width=width))
    trust = results.trust
    if trust.kind != "trace":
        side: Literal["left", "right"] = "right" if trust.until < 0.6 * results.facts["length"] else "left"
        layers.append(Rule(at=trust.until, axis="x", text="trusted until here", side=side))
    return Panel(x=TIME, y=Axis(label="tilt / α", unit="-", low=0.0), layers=layers, title="Tilt")


def _scales(results: Advice) -> Panel:
    scales, styles, balance = results.scales, series_styles(results.facts["model"]), _balance(results)
    side = _SIDE * balance
    layers: list[Line | Rule] = [Rule(at=1.0, axis="x", text="as given")]
    for name in SERIES:
        rows = scales[scales["series"] == name]
        if not len(rows):
            continue
        peaks = rows["peak_tilt"].to_numpy(float)
        cut = np.minimum(peaks / results.cylinder.alpha, _STANDS * balance)
        shown = rows.assign(tilt=np.where(overturned(peaks), side, cut))
        marked = replace(styles[name], symbol="circle")
        layers.append(table_line(shown, "factor", "tilt", NAMES[name], marked, width=1.0, size=2.5))
    # five ticks above zero at most, so that they do not collide
    step = 0.25 * 2.0 ** max(0, math.ceil(math.log2(balance / 1.25)))
    levels = [*ticks_at(step * place for place in range(int(balance / step) + 1)), (side, "overturns")]
    scale = Axis(label="scale of the ground motion", unit="-", log=True, low=_SCALES[0], high=_SCALES[-1])
    return Panel(
        x=replace(scale, ticks=ticks_at(_SCALES)),
        y=Axis(label="largest tilt / α", unit="-", low=-0.02, high=1.4 * balance, ticks=levels),
        layers=layers,
        title="Other scales of this shaking",
    )


def _friction(results: Advice) -> Panel:
    available, trace = results.facts["friction"], results.trace
    usual = float(results.groups["friction_95"].max())
    most = [value for value in (available, usual) if value is not None and math.isfinite(value)]
    # a demand beyond any friction is drawn at the top
    top = 1.5 * max([*most, results.cylinder.tan_alpha])
    needed = trace.assign(
        needed=np.where(trace["tilt"] > 0.0, np.minimum(trace["friction_needed"], top), 0.0)
    )
    style = model_style(results.facts["model"])
    slides = Rule(at=results.cylinder.tan_alpha, axis="y", text="b/h", colour=GREY)
    layers: list[Line | Rule] = [table_line(needed, "time", "needed", style=style, width=0.9)]
    layers.append(slides if available is None else Rule(at=available, axis="y", text="available"))
    return Panel(
        x=TIME,
        y=Axis(label="friction demand", unit="-", low=0.0, high=top),
        layers=layers,
        title="Friction demand at the base, as given",
    )


def _balance(results: Advice) -> float:
    """Balance tilt, at most pi/2 [alpha]."""
    tendon = results.facts.get("tendon")
    return min(tendon["balance_tilt"], OVERTURNED_TILT / results.cylinder.alpha) if tendon else 1.0
