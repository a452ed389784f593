"""The main result of a comparison as a picture: tilt, and how the tilts diverge."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from rockwobble.compare import Comparison
from rockwobble.compare.metrics.pair import make_pair
from rockwobble.models import AGREEMENT
from rockwobble.models.support import SUPPORTS

from ..palette import Style
from ..picture import TILT, TIME, Axis, Layer, Line, Panel, Picture, Rule
from ..thinning import envelope
from .view import CaseView, case_views

# smaller differences are drawn here: a logarithm has no zero [alpha]
SMALLEST = 1e-7
_CUT = 1.5  # [alpha] where tilts are cut if one goes farther
_HEIGHT = 2.3  # [inch]


def pictures(comparison: Comparison) -> Iterator[Picture]:
    """Yield the picture of each case, by its name."""
    return (tilt_picture(view, view.case.name) for view in case_views(comparison))


def tilt_picture(view: CaseView, name: str = "figure") -> Picture:
    """Return the tilts of one case by support, each with the model of the support, and their differences."""
    cylinder = view.case.cylinder
    groups = [
        [label for label, trace in view.runs.items() if trace.run.support == support]
        for support in view.supports
    ]
    return Picture(
        name=name,
        title=f"Tilt: {view.case.name}, R = {cylinder.semidiagonal:g} m, tan α = {cylinder.tan_alpha:g}",
        caption="Angle of the axis from the vertical over the slenderness, of the runs of each support and "
        "its model. Below, the difference from the reference: its largest value within the last second. "
        "Diamonds mark where 1 % of α is first exceeded: beyond it single traces say nothing about "
        "each other.",
        panels=[
            *(_tilts(view, group, support) for group, support in zip(groups, view.supports, strict=True)),
            *(_differences(view, reference) for reference in view.rows["reference"].unique()),
        ],
        link_x=True,
    )


def _tilts(view: CaseView, runs: Sequence[str], support: str) -> Panel:
    shown = dict.fromkeys([*runs, *map(view.partner, runs)])
    traces = view.traces
    layers = [
        Line(
            x=traces[label].time,
            y=traces[label].tilt / view.case.cylinder.alpha,
            name=label,
            style=view.styles[label],
            width=1.6 if label in runs else 0.9,
        )
        for label in shown
    ]
    # a fall would leave nothing to be seen of the rest
    cut = any(float(np.nanmax(line.y, initial=0.0)) > _CUT for line in layers)
    y = replace(TILT, high=_CUT if cut else None)
    return Panel(
        x=TIME,
        y=y,
        layers=layers,
        title=SUPPORTS[support].words if support in SUPPORTS else "external trajectory",
        height=_HEIGHT,
    )


def _differences(view: CaseView, reference: str) -> Panel:
    layers: list[Layer] = [Rule(at=AGREEMENT, axis="y", text="1 % of α", side="right")]
    for row, other, trial in view.pairs():
        if row.reference != reference:
            continue
        pair = make_pair(view.case.cylinder, other, trial, until=view.case.length)
        style = view.styles[row.run]
        apart = np.maximum(envelope(pair.time, np.abs(pair.tilt_difference)), SMALLEST)
        layers.append(Line(x=pair.time, y=apart, name=row.run, style=style))
        if row.diverged:
            mark = Style(colour=style.colour, dash="none", symbol="diamond")
            at = np.array([view.divergence(row)])
            layers.append(Line(x=at, y=np.array([AGREEMENT]), style=mark, size=7.0))
    y = Axis(label="|tilt difference| / α", unit="-", log=True, low=SMALLEST, high=3.0)
    return Panel(x=TIME, y=y, layers=layers, title=f"difference from {reference}", height=_HEIGHT)
