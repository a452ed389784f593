"""The picture of an advice: how it ends, the trace and its spread, other scales, and the friction."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.tilt import overturned
from rockwobble.compare.studies.advice.advice import Advice
from rockwobble.compare.studies.spectrum.spectrum import PLANAR_X, PLANAR_Y, SERIES, SPATIAL

from .ensemble import peak_shares
from .palette import GREY, Style, model_style, run_styles
from .picture import TIME, Array, Axis, Band, Line, Panel, Picture, Rule

NAMES = {SPATIAL: "3D", PLANAR_X: "planar, x alone", PLANAR_Y: "planar, y alone"}
GROUPS = {
    "copies": "copies of this record",
    "acceleration": "other records, same peak acceleration",
    "velocity": "other records, same peak velocity",
}
SHORT = {"copies": "copies", "acceleration": "same acceleration", "velocity": "same velocity"}
_STANDS, _SIDE = 1.2, 1.3  # [alpha] where tilts are cut, and where overturned runs are drawn
_SCALES = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)


def pictures(found: Advice) -> list[Picture]:
    """Return the picture of an advice; none where there is nothing to draw."""
    return advice_pictures(found.facts(), found.tables())


def advice_pictures(facts: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> list[Picture]:
    """Return the picture, from what an advice stores; none where nothing was run that could be drawn."""
    panels = []
    if facts["moves"]:
        panels += [_peaks(facts, tables["members"]), _tilt(facts, tables)]
    if len(tables["scales"]):
        panels.append(_scales(facts, tables["scales"]))
    if facts["moves"]:
        panels.append(_friction(facts, tables["trace"]))
    picture = Picture(
        name="advice",
        title=f"{facts['name']}: largest tilts, the trace, other scales and friction",
        caption="Largest tilts: share of the runs that tilt no more; what a curve lacks to 1 overturns "
        "(triangle), the diamond is the case as given. Tilt: as given over the band of 90 % of the copies.",
        panels=panels,
        columns=2,
        legend="panels",
    )
    return [picture] if panels else []


def _peaks(facts: Mapping[str, Any], members: pd.DataFrame) -> Panel:
    groups = [name for name in GROUPS if (members["group"] == name).any()]
    styles = run_styles(groups)
    standing = members[~members["outcome"].isin(["overturned", "failed"])]
    end = 1.05 * max(float(standing["peak_tilt"].max()), 0.1) if len(standing) else 1.0
    layers: list[Line] = []
    for name in groups:
        layers += peak_shares(members[members["group"] == name], SHORT[name], styles[name], end)
    if not facts["overturned"]:
        here = Style(colour=model_style(facts["model"]).colour, dash="none", symbol="diamond")
        rank = np.array([facts["peak_rank"]])
        layers.append(Line(x=np.array([facts["peak"]]), y=rank, name="as given", style=here, size=7.0))
    return Panel(
        x=Axis(label="largest tilt / α", unit="-", low=0.0, high=end),
        y=Axis(label="share of the runs", unit="-", low=0.0, high=1.03),
        layers=layers,
        title="Largest tilt",
    )


def _tilt(facts: Mapping[str, Any], tables: Mapping[str, pd.DataFrame]) -> Panel:
    band, trace, engine = tables["band"], tables["trace"], tables["engine"]
    layers: list[Band | Line | Rule] = [
        Band(
            x=band["time"].to_numpy(float),
            low=_cut(band["low"]),
            high=_cut(band["high"]),
            name="90 % of the copies",
        )
    ]
    if len(engine):
        label = facts["engine"]["label"]
        style = run_styles([label])[label]
        layers.append(
            Line(x=engine["time"].to_numpy(float), y=_cut(engine["tilt"]), name=label, style=style, width=1.8)
        )
    layers.append(
        Line(
            x=trace["time"].to_numpy(float),
            y=_cut(trace["tilt"]),
            name=facts["model"],
            style=model_style(facts["model"]),
            width=1.1,
        )
    )
    if facts["trust"]["kind"] != "trace":
        until = facts["trust"]["until"]
        side: Literal["left", "right"] = "right" if until < 0.6 * facts["length"] else "left"
        layers.append(Rule(at=until, axis="x", text="trace holds until here", side=side))
    return Panel(x=TIME, y=Axis(label="tilt / α", unit="-", low=0.0), layers=layers, title="Tilt")


def _scales(facts: Mapping[str, Any], scales: pd.DataFrame) -> Panel:
    planes = run_styles([PLANAR_X, PLANAR_Y])
    layers: list[Line | Rule] = [Rule(at=1.0, axis="x", text="as given")]
    for name in SERIES:
        rows = scales[scales["series"] == name]
        if not len(rows):
            continue
        peaks = rows["peak_tilt"].to_numpy(float)
        tilt = np.where(overturned(peaks), _SIDE, np.minimum(peaks / facts["alpha"], _STANDS))
        style = model_style(facts["model"]) if name == SPATIAL else planes[name]
        marked = Style(colour=style.colour, dash=style.dash, symbol="circle")
        layers.append(
            Line(
                x=rows["factor"].to_numpy(float), y=tilt, name=NAMES[name], style=marked, size=2.5, width=1.0
            )
        )
    levels = [(level, f"{level:g}") for level in (0.0, 0.25, 0.5, 0.75, 1.0)]
    return Panel(
        x=Axis(
            label="scale of the ground motion",
            unit="-",
            log=True,
            low=_SCALES[0],
            high=_SCALES[-1],
            ticks=[(tick, f"{tick:g}") for tick in _SCALES],
        ),
        y=Axis(
            label="largest tilt / α", unit="-", low=-0.02, high=1.4, ticks=[*levels, (_SIDE, "overturns")]
        ),
        layers=layers,
        title="Other scales of this shaking",
    )


def _friction(facts: Mapping[str, Any], trace: pd.DataFrame) -> Panel:
    available = facts["friction"]
    usual = max((row["friction_95"] for row in facts["answers"]), default=0.0)
    most = [value for value in (available, usual) if value is not None and math.isfinite(value)]
    # what no friction supplies is drawn at the top
    top = 1.5 * max([*most, facts["tan_alpha"]])
    needed = np.where(trace["tilt"] > 0.0, np.minimum(trace["friction_needed"], top), 0.0)
    layers: list[Line | Rule] = [
        Line(x=trace["time"].to_numpy(float), y=needed, style=model_style(facts["model"]), width=0.9)
    ]
    if available is not None:
        layers.append(Rule(at=available, axis="y", text="available"))
    else:
        layers.append(Rule(at=facts["tan_alpha"], axis="y", text="b/h", colour=GREY))
    return Panel(
        x=TIME,
        y=Axis(label="friction needed", unit="-", low=0.0, high=top),
        layers=layers,
        title="Friction needed, as given",
    )


def _cut(tilts: pd.Series[float]) -> Array:
    return np.minimum(tilts.to_numpy(float), _STANDS)
