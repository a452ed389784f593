"""The main result of a comparison as a picture: tilt, and how the tilts diverge."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.compare import AGREEMENT, make_pair, own_model

from .palette import Style, label_styles
from .picture import TILT, TIME, Axis, Layer, Line, Panel, Picture, Rule
from .svg import figure
from .thinning import envelope

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rockwobble.compare import Comparison
    from rockwobble.models import Case, Trace

# smaller differences are drawn here: a logarithm has no zero [alpha]
SMALLEST = 1e-7
# the difference is drawn as its largest value within this time, about one swing [s]
WINDOW = 1.0
_FALLS = 1.5  # [alpha] where tilts are cut if one goes farther


def draw(comparison: Comparison, case: str) -> Figure:
    """Return a matplotlib figure of one case."""
    return figure(comparison_picture(comparison, case))


def comparison_picture(comparison: Comparison, name: str) -> Picture:
    """Return the tilts of one case by support, each with the model of the support, and their differences."""
    case = comparison.cases[name]
    traces = {label: trace for (of, label), trace in comparison.traces.items() if of == name}
    styles = label_styles(list(traces))
    cylinder = case.cylinder
    return Picture(
        name="figure",
        title=f"{name}, R = {cylinder.semidiagonal:g} m, tan α = {cylinder.tan_alpha:g}",
        caption="Tilt of the runs of each support and its reduced model; below, the largest difference "
        "within the last second from what each run is held against. Diamonds: 1 % of α is first exceeded.",
        panels=[*_tilts(case, traces, styles), _differences(comparison, case, traces, styles)],
        link_x=True,
    )


def _tilts(case: Case, traces: Mapping[str, Trace], styles: Mapping[str, Style]) -> list[Panel]:
    runs = {label: trace for label, trace in traces.items() if trace.run.engine is not None}
    # of a comparison of models alone all stand in one panel
    supports = dict.fromkeys(trace.run.support for trace in (runs or traces).values())
    panels = []
    for support in supports:
        shown = [label for label, trace in runs.items() if trace.run.support == support] if runs else []
        own = {str(own_model(runs[label].run)) for label in shown}
        shown += [label for label in traces if label not in runs and (not runs or label in own)]
        lines = [
            Line(
                x=traces[label].time,
                y=traces[label].tilt / case.cylinder.alpha,
                name=label,
                style=styles[label],
                width=1.6 if label in runs else 0.9,
            )
            for label in shown
        ]
        title = f"support {support}" if runs else ""
        # a fall would leave nothing to be seen of the rest
        falls = max((float(np.nanmax(line.y, initial=0.0)) for line in lines), default=0.0) > _FALLS
        y = replace(TILT, high=_FALLS if falls else None)
        panels.append(Panel(x=TIME, y=y, layers=lines, title=title))
        if not runs:
            break
    return panels


def _differences(
    comparison: Comparison, case: Case, traces: Mapping[str, Trace], styles: Mapping[str, Style]
) -> Panel:
    layers: list[Layer] = [Rule(at=AGREEMENT, axis="y", text="1 % of α")]
    rows = comparison.summary[comparison.summary["case"] == case.name]
    for row in rows.to_dict("records"):
        run, reference = traces.get(row["run"]), traces.get(row["reference"])
        own = reference is not None and run is not None and row["reference"] == str(own_model(run.run))
        if run is None or reference is None or not (own or len(rows[rows["run"] == row["run"]]) == 1):
            continue
        pair = make_pair(case.cylinder, reference, run, until=case.length)
        style = styles[row["run"]]
        difference = np.maximum(envelope(pair.time, np.abs(pair.tilt_difference), WINDOW), SMALLEST)
        layers.append(Line(x=pair.time, y=difference, name=row["run"], style=style))
        if row["diverged"]:
            end = np.array([pair.start + row["agreement_time"]])
            mark = Style(colour=style.colour, dash="none", symbol="diamond")
            layers.append(Line(x=end, y=np.array([AGREEMENT]), style=mark, size=7.0))
    y = Axis(label="|tilt difference| / α", unit="-", log=True, low=SMALLEST, high=3.0)
    return Panel(x=TIME, y=y, layers=layers, title="difference")
