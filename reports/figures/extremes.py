"""The verdicts on a scan of extremes as a picture: how many runs of each method have each."""

from __future__ import annotations

import numpy as np

from rockwobble.studies.extremes import Extremes

from .palette import GREY, ORDER, PALE
from .picture import Axis, Bars, Panel, Picture, list_axis

# verdict: colour and hatch; what nothing explains stands out
_SHADES = {
    "fine": (ORDER[4], ""),
    "flagged": (ORDER[2], ""),
    "no reference": (PALE, ""),
    "refused": (GREY, ""),
    "caught": (ORDER[3], "/"),
    "silent": (ORDER[1], "x"),
}


def pictures(found: Extremes) -> list[Picture]:
    """Return the counts of the verdicts, a bar for each method."""
    runs = found.extremes[found.extremes["verdict"] != "n/a"]
    methods = list(dict.fromkeys(runs["method"]))
    places, start, layers = np.arange(len(methods), dtype=np.float64), np.zeros(len(methods)), []
    for verdict, (colour, hatch) in _SHADES.items():
        counts = runs[runs["verdict"] == verdict].groupby("method").size().reindex(methods, fill_value=0)
        if not counts.any():
            continue
        end = start + counts.to_numpy()
        colours = [colour] * len(methods)
        layers.append(Bars(places=places, start=start, end=end, colours=colours, name=verdict, hatch=hatch))
        start = end
    panel = Panel(
        x=Axis(label="runs", unit="-", low=0.0),
        y=list_axis(methods, "method"),
        layers=layers,
        height=0.4 * len(methods) + 1.0,
    )
    title = "Verdicts on the extremes, by method"
    caption = "Runs of each method by verdict; a silent one is wrong and no diagnostic explains it."
    return [Picture(name="extremes", title=title, caption=caption, panels=[panel])]
