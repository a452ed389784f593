"""Peak tilts of an ensemble: their distributions over each other, and each member against itself."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.compare.metrics.distributions import MARGIN

from .ensemble_chart import curves
from .ensemble_ratios import RatioRow, ratio_rows, ratio_span, ratio_ticks
from .palette import DASHES

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble

_CURVES, _ROW = (
    4.4,
    0.42,
)  # heights [inch]: of the upper panel with its legend, and of a line of the lower one
_LIGHT = "#dddddd"


def ensemble_figure(found: Ensemble) -> bytes:
    """Return the picture as SVG: distributions above, ratios of the members below."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    rows = ratio_rows(found)
    lower = _ROW * len(rows) + 0.7 if rows else 0.0
    with mpl.rc_context({"svg.hashsalt": "rockwobble", "font.size": 10}):
        figure = Figure(figsize=(8.0, _CURVES + lower), layout="constrained")
        if rows:
            above, below = figure.subplots(2, 1, height_ratios=[_CURVES, lower])
            _draw_ratios(below, rows)
        else:
            above = figure.subplots()
        _draw_curves(above, found)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "rockwobble"})
    return buffer.getvalue()


def _draw_curves(axes: Any, found: Ensemble) -> None:
    for curve in curves(found):
        axes.step(
            curve.tilt,
            curve.share,
            where="post",
            color=curve.style.colour,
            linestyle=DASHES[curve.style.dash],
            linewidth=1.6,
            label=curve.label,
        )
        axes.set_xlim(0.0, curve.tilt[-1])
        if curve.overturned:
            axes.plot(
                *(curve.tilt[-1:], curve.share[-1:]),
                ">",
                color=curve.style.colour,
                markersize=7,
                clip_on=False,
            )
    axes.set_xlabel("peak tilt / α [-]")
    axes.set_ylabel("share of the members [-]")
    axes.set_ylim(0.0, 1.02)
    axes.grid(color=_LIGHT, linewidth=0.6)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False, fontsize=9)


def _draw_ratios(axes: Any, rows: list[RatioRow]) -> None:
    low, high = ratio_span(rows)
    axes.axvspan(1.0 / (1.0 + MARGIN), 1.0 + MARGIN, color="#e8eef4", linewidth=0.0)
    axes.axvline(1.0, color="#888888", linewidth=0.8)
    for place, row in enumerate(rows):
        inside = (row.ratios > 0.0) & np.isfinite(row.ratios)
        axes.plot(row.ratios[inside], np.full(inside.sum(), place - 0.2), "o", color="#0072B2", **_DOT)
        for edge, marker, beyond in ((low, "<", row.ratios == 0.0), (high, ">", np.isinf(row.ratios))):
            if beyond.any():
                axes.plot([edge], [place - 0.2], marker, color="#D55E00", markersize=7, clip_on=False)
                side = "left" if edge == low else "right"
                axes.annotate(
                    str(int(beyond.sum())),
                    *((edge, place - 0.2), (8 if side == "left" else -8, 0)),
                    textcoords="offset points",
                    ha=side,
                    va="center",
                    fontsize=9,
                    color="#D55E00",
                )
        for ends, width in ((row.spread, 1.0), (row.ends, 3.5)):
            axes.plot(np.clip(ends, low, high), [place + 0.2] * 2, "-", color="#222222", linewidth=width)
        if low <= row.median <= high:
            axes.plot(
                [row.median], [place + 0.2], "D", color="#222222", markersize=5, markeredgecolor="white"
            )
    axes.set_xscale("log")
    axes.set_xlim(low, high)
    ticks = ratio_ticks(low, high)
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_yticks(range(len(rows)), ["\n".join(row.label) for row in rows], fontsize=9)
    axes.tick_params(axis="y", length=0.0, pad=10.0)  # room for the triangles
    axes.grid(axis="x", color=_LIGHT, linewidth=0.6)
    axes.set_xlabel("ratio of peak tilts of the same member [-]")


_DOT = {"markersize": 4, "alpha": 0.55, "markeredgewidth": 0.0}
