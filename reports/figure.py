"""The main result as a picture for a document: tilt, and how the tilts part."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.compare import AGREEMENT, make_pair

from .case_view import CaseView, case_views
from .palette import Style, model_style
from .thinning import kept_samples

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from rockwobble.compare import Comparison

_DASHES: dict[str, Any] = {
    "solid": "-",
    "dash": (0, (5, 2)),
    "dashdot": (0, (5, 2, 1, 2)),
    "dot": (0, (1, 1.5)),
    "longdash": (0, (9, 3)),
    "longdashdot": (0, (9, 3, 1, 3)),
}
# a picture of some 800 pixels shows no more
_POINTS = 1200
_SMALLEST = 1e-7


def comparison_figure(comparison: Comparison) -> bytes:
    """Return the picture of the first case of a comparison as SVG, the same bytes for the same numbers."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    view = case_views(comparison)[0]
    with mpl.rc_context({"svg.hashsalt": "rockwobble", "font.size": 10, "path.simplify_threshold": 0.3}):
        figure = Figure(figsize=(8.6, 6.8), layout="constrained")
        above, below = figure.subplots(2, 1, sharex=True)
        _tilts(above, view)
        _differences(below, view)
        figure.suptitle(_title(view), fontsize=11, x=0.01, ha="left")
        buffer = io.BytesIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "rockwobble"})
    return buffer.getvalue()


def _title(view: CaseView) -> str:
    cylinder = view.case.cylinder
    return f"{view.case.name}, R = {cylinder.semidiagonal:g} m, tan α = {cylinder.tan_alpha:g}"


def _tilts(axes: Axes, view: CaseView) -> None:
    for label, trace, style in view.lines():
        model = label.endswith("model")
        _line(axes, trace.time, trace.tilt / view.case.cylinder.alpha, label, style, 0.8 if model else 1.5)
    axes.set_ylabel("tilt / α [-]")
    axes.set_ylim(bottom=0.0)
    _finish(axes)


def _differences(axes: Axes, view: CaseView) -> None:
    axes.axhline(AGREEMENT, color="#222222", linewidth=0.8, linestyle=(0, (5, 2)))
    axes.annotate("1 % of α", (0.995, AGREEMENT), xycoords=("axes fraction", "data"), ha="right", va="bottom")
    for _, row in view.rows.iterrows():
        if row.run not in view.trajectories:
            continue
        pair = make_pair(view.case.cylinder, view.responses[row.reference], view.trajectories[row.run])
        style = Style(colour=view.styles[row.run].colour, dash=model_style(row.reference).dash)
        difference = np.maximum(np.abs(pair.tilt_difference), _SMALLEST)
        _line(axes, pair.time, difference, f"{row.run} − {row.reference}", style, 0.9)
        if row.parted:
            filled = row.reference == "recess"
            axes.plot(
                view.start(row.reference) + row.agreement_horizon,
                AGREEMENT,
                marker="D",
                markersize=7,
                color=style.colour if filled else "white",
                markeredgecolor="black" if filled else style.colour,
                zorder=5,
            )
    axes.set_yscale("log")
    axes.set_ylim(_SMALLEST, 10.0)
    axes.set_ylabel("|tilt difference| / α [-]")
    axes.set_xlabel("time [s]")
    _finish(axes)


def _finish(axes: Axes) -> None:
    # above the axes, where it hides nothing
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, fontsize=8, frameon=False)
    axes.grid(color="#dddddd", linewidth=0.6)
    axes.margins(x=0.0)


def _line(axes: Axes, x: Any, y: Any, label: str, style: Style, width: float) -> None:
    keep = kept_samples(y, points=_POINTS)
    axes.plot(
        x[keep], y[keep], label=label, color=style.colour, linestyle=_DASHES[style.dash], linewidth=width
    )
