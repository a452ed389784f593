"""Paths of the centre of mass seen from above, and where and how the cylinder stands at the end."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Trace

from ..heat import names
from ..palette import GREY, Style
from ..picture import Array, Axis, Bars, Line, Panel, Picture
from .view import CaseView


def orbit_picture(view: CaseView, name: str) -> Picture:
    """Return the path of each run over that of the model of its support."""
    reach = _reach(view)
    east, north = (Axis(label=side, unit="-", low=-reach, high=reach) for side in _SIDES)
    ends = {(row.run, row.reference): view.divergence(row) for row, _, _ in view.pairs()}
    panels = []
    for label, trace in view.runs.items():
        other = view.partner(label)
        end = ends.get((label, other), math.inf)
        layers = [
            *_path(view.traces[other], other, view.styles[other], end, 2.2),
            *_path(trace, label, view.styles[label], end, 1.3),
        ]
        title = f"{label} over {other}"
        panels.append(Panel(x=east, y=north, layers=layers, title=title, equal=True, height=3.4))
    return Picture(
        name=name,
        title="Paths of the centre of mass, seen from above",
        caption="Each run over the model of its support, relative to the moving ground: strong until they "
        "diverge, faint from then on.",
        panels=panels,
        columns=2,
        legend="panels",
    )


_SIDES = ("east-west / b", "north-south / b")


def _reach(view: CaseView) -> float:
    cylinder = view.case.cylinder
    largest = 0.0
    for trace in view.traces.values():
        # a fallen cylinder would leave nothing to be seen of the rest
        upright = trace.tilt <= 1.2 * cylinder.alpha
        beside = np.abs(trace.centre_of_mass[upright, :2])
        largest = max(largest, float(np.nanmax(beside, initial=0.0)))
    return min(1.08 * largest, 6.0 * cylinder.semidiagonal) / cylinder.base_radius or 1.0


def _path(trace: Trace, name: str, style: Style, end: float, width: float) -> Iterator[Line]:
    path = trace.centre_of_mass[:, :2] / trace.case.cylinder.base_radius
    solid, agreed = Style(colour=style.colour), trace.time <= end
    for part, opacity in ((agreed, 1.0), (~agreed, 0.25)):
        if np.count_nonzero(part) > 1:
            x, y = path[part].T
            yield Line(x=x, y=y, name=name, style=solid, width=width, opacity=opacity)


def residual_picture(view: CaseView, name: str) -> Picture:
    """Return residual displacement and residual twist of each run."""
    once = view.rows.drop_duplicates("run")
    runs = [str(run) for run in once["run"]]
    moved = once["residual_displacement"].to_numpy(float)
    twisted = np.abs(once["residual_twist"].to_numpy(float))
    colours = [view.styles[run].colour if run in view.styles else GREY for run in runs]
    return Picture(
        name=name,
        title="How the cylinder stands at the end",
        caption="Distance of the base centre from its old place, and turn of the cylinder about its own "
        "axis. The recess model has none of either.",
        panels=[
            _bars(runs, moved, colours, Axis(label="displacement / b", unit="-", low=0.0), "b"),
            _bars(runs, twisted, colours, Axis(label="twist", unit="deg", low=0.0), "°"),
        ],
        columns=2,
    )


def _bars(runs: list[str], values: Array, colours: list[str], x: Axis, unit: str) -> Panel:
    places, ticks = names(runs)
    known = np.nan_to_num(values)
    # room for the numbers beside the bars
    high = 1.45 * (float(known.max(initial=0.0)) or 1.0)
    texts = [f"{value:.3g} {unit}" if math.isfinite(value) else "unknown" for value in values]
    bars = Bars(places=places, start=0.0 * known, end=known, colours=colours, texts=texts)
    return Panel(
        x=Axis(label=x.label, unit=x.unit, low=0.0, high=high),
        y=Axis(label="", unit="", ticks=ticks, reverse=True),
        layers=[bars],
        height=0.7 + 0.3 * len(runs),
    )
