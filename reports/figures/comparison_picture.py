"""The main result as a picture for a document: tilt, and how the tilts part."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.compare import AGREEMENT, make_pair

from .case_view import CaseView, case_views, own_rows
from .charts.tilt import SMALLEST, WINDOW
from .palette import DASHES, Style
from .thinning import envelope, kept_samples

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rockwobble.compare import Comparison

# a picture of some 800 pixels shows no more
_POINTS = 1200


def comparison_figure(comparison: Comparison) -> bytes:
    """Return the picture of the first case of a comparison as SVG, the same bytes for the same numbers."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    view = case_views(comparison)[0]
    supports = view.supports
    with mpl.rc_context({"svg.hashsalt": "rockwobble", "font.size": 10, "path.simplify_threshold": 0.3}):
        figure = Figure(figsize=(8.6, 2.6 + 2.3 * len(supports)), layout="constrained")
        panels = figure.subplots(len(supports) + 1, 1, sharex=True, squeeze=False)[:, 0]
        for axes, support in zip(panels, supports, strict=False):
            _tilts(axes, view, support)
        _differences(panels[-1], view)
        figure.suptitle(_title(view), fontsize=11, x=0.01, ha="left")
        buffer = io.BytesIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "rockwobble"})
    return buffer.getvalue()


def _title(view: CaseView) -> str:
    cylinder = view.case.cylinder
    return f"{view.case.name}, R = {cylinder.semidiagonal:g} m, tan α = {cylinder.tan_alpha:g}"


def _tilts(axes: Axes, view: CaseView, support: str) -> None:
    """Draw the runs of one support over each other, with the model of that support."""
    chosen = {label: 1.6 for label, trace in view.runs.items() if trace.run.support == support}
    chosen |= dict.fromkeys(map(view.partner, tuple(chosen)), 0.8)
    for label, width in chosen.items():
        trace = view.traces[label]
        _line(axes, trace.time, trace.tilt / view.case.cylinder.alpha, label, view.styles[label], width)
    axes.set_ylabel("tilt / α [-]")
    axes.set_ylim(bottom=0.0)
    _finish(axes)


def _differences(axes: Axes, view: CaseView) -> None:
    """Draw how each run parts from the model of its support."""
    axes.axhline(AGREEMENT, color="#222222", linewidth=0.8, linestyle=(0, (5, 2)))
    axes.annotate("1 % of α", (0.005, AGREEMENT), xycoords=("axes fraction", "data"), ha="left", va="bottom")
    own = own_rows(view.rows).index
    for row, reference, trial in view.pairs():
        if row.Index not in own:
            continue
        pair = make_pair(view.case.cylinder, reference, trial)
        style = view.styles[row.run]
        difference = np.maximum(envelope(pair.time, np.abs(pair.tilt_difference), WINDOW), SMALLEST)
        _line(axes, pair.time, difference, f"{row.run} − {row.reference}", style, 1.3)
        if row.diverged:
            end = view.divergence(row)
            axes.plot(
                end, AGREEMENT, "D", markersize=7, color=style.colour, markeredgecolor="black", zorder=5
            )
    axes.set_yscale("log")
    axes.set_ylim(SMALLEST, 3.0)
    axes.set_ylabel("|tilt difference| / α [-]")
    axes.set_xlabel("time [s]")
    _finish(axes)


def _finish(axes: Axes) -> None:
    # above the axes, where it hides nothing
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 0.98), ncols=4, fontsize=8, frameon=False)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.margins(x=0.0)


def _line(axes: Axes, x: Any, y: Any, label: str, style: Style, width: float) -> None:
    keep = kept_samples(y, points=_POINTS)
    axes.plot(
        x[keep], y[keep], label=label, color=style.colour, linestyle=DASHES[style.dash], linewidth=width
    )
