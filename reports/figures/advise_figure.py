"""The figures of an advice as one picture for a document."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.compare.metrics.tilt import overturned
from rockwobble.compare.studies.spectrum.series import PLANAR_X, PLANAR_Y, SPATIAL

from .advise_charts import FALLS, NAMES, STANDS
from .drawing import drawn, line, with_grid
from .palette import DASHES, Style, model_style, run_styles

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rockwobble.compare.studies.advice import Advice

_BAND = "#cfe3f1"


def advice_figure(advice: Advice) -> bytes:
    """Return tilt and friction over time, largest tilts of the starts, and other scales (SVG)."""
    panels = []
    if advice.moves:
        panels += [_tilt, _friction]
    if advice.moves:
        panels += [_peaks]
    if advice.scan is not None:
        panels += [_scales]

    def draw(figure: Figure) -> None:
        rows = -(-len(panels) // 2)
        places = figure.subplots(max(rows, 1), 2, squeeze=False).flat
        for axes, panel in zip(places, panels, strict=False):
            panel(axes, advice)
            with_grid(axes)
        for axes in list(places):
            axes.set_visible(False)

    return drawn(draw, 2.9 * max(1, -(-len(panels) // 2)))


def _style(style: Style) -> dict[str, Any]:
    return {"color": style.colour, "linestyle": DASHES[style.dash], "linewidth": 1.2}


def _tilt(axes: Axes, advice: Advice) -> None:
    spread, alpha = advice.spread, advice.case.cylinder.alpha
    assert spread is not None
    axes.fill_between(
        spread.time,
        np.minimum(spread.low, STANDS),
        np.minimum(spread.high, STANDS),
        color=_BAND,
        linewidth=0.0,
        label="90 % of the starts",
    )
    if advice.verification is not None and advice.verification.trajectory is not None:
        label, trajectory = advice.verification.label, advice.verification.trajectory
        tilt = np.minimum(trajectory.tilt / alpha, STANDS)
        line(
            axes,
            trajectory.time,
            tilt,
            label=label,
            **_style(run_styles([label])[label]) | {"linewidth": 1.8},
        )
    tilt = np.minimum(advice.response.tilt / alpha, STANDS)
    line(axes, advice.response.time, tilt, label=f"{advice.model} model", **_style(model_style(advice.model)))
    if advice.trust.kind != "trace":
        axes.axvline(
            advice.trust.until,
            color="#222222",
            linestyle=":",
            linewidth=1.0,
            label="the trace holds until here",
        )
    axes.set_xlabel("time [s]")
    axes.set_ylabel("tilt / α [-]")
    axes.set_ylim(bottom=0.0)
    axes.set_title("Tilt")
    axes.legend(loc="upper right", fontsize=7.5)


def _friction(axes: Axes, advice: Advice) -> None:
    response, available = advice.response, advice.demands.friction
    top = 1.15 * max(available, min(advice.demands.friction_needed, 2.0 * available + 0.2))
    needed = np.where(response.tilt > 0.0, np.minimum(response.friction_needed, top), 0.0)
    line(axes, response.time, needed, label="needed", **_style(model_style(advice.model)))
    axes.axhline(available, color="#222222", linestyle=":", linewidth=1.0, label="available")
    axes.set_ylim(0.0, top)
    axes.set_xlabel("time [s]")
    axes.set_ylabel("friction [-]")
    axes.set_title("Friction needed")
    axes.legend(loc="center right", fontsize=7.5)


def _peaks(axes: Axes, advice: Advice) -> None:
    spread = advice.spread
    assert spread is not None
    for model, peaks, fell in (
        (spread.model, spread.peaks, spread.overturned),
        (spread.other, spread.other_peaks, spread.other_overturned),
    ):
        known = np.isfinite(peaks)
        standing = np.sort(peaks[known & ~fell])
        if not known.any():
            continue
        shares = np.arange(len(standing) + 1) / known.sum()
        axes.step(
            np.concatenate([[0.0], standing]), shares, where="post", label=f"{model} model",
            **_style(model_style(model)),
        )  # fmt: skip
    axes.set_xlabel("largest tilt / α [-]")
    axes.set_ylabel("share of the starts [-]")
    axes.set_xlim(left=0.0)
    axes.set_ylim(0.0, 1.03)
    axes.set_title("Largest tilt of the perturbed starts")
    axes.legend(loc="best", fontsize=7.5)


def _scales(axes: Axes, advice: Advice) -> None:
    scan, alpha = advice.scan, advice.case.cylinder.alpha
    assert scan is not None
    planes = run_styles([PLANAR_X, PLANAR_Y])
    for name, peaks in scan.peaks.items():
        style = model_style(advice.model) if name == SPATIAL else planes[name]
        tilt = np.where(overturned(peaks), FALLS, np.minimum(peaks / alpha, STANDS))
        axes.plot(scan.factors, tilt, marker="o", markersize=2.0, label=NAMES[name], **_style(style))
    axes.axvline(1.0, color="#222222", linestyle=":", linewidth=1.0)
    axes.set_xscale("log")
    ticks = [tick for tick in (0.25, 0.5, 1, 2, 4, 8) if scan.factors[0] <= tick <= scan.factors[-1]]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks], minor=False)
    axes.minorticks_off()
    axes.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0, FALLS], ["0", "0.25", "0.5", "0.75", "1", "falls"])
    axes.set_xlabel("scale of the ground motion [-]")
    axes.set_ylabel("largest tilt / α [-]")
    axes.set_title("Other scales of this shaking")
    axes.legend(loc="upper left", fontsize=7.5)
