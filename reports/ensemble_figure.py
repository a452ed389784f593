"""Empirical distributions of peak tilt over each other."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

from .ensemble_chart import MODELS, end_of_axis
from .palette import DASHES, model_style, run_styles

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble


def ensemble_figure(found: Ensemble) -> bytes:
    """Return the picture as SVG: share of the members whose peak tilt is at most that of the axis.

    A curve that ends below 1 leaves the share that overturns.
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    methods = list(found.methods["method"])
    styles = run_styles([method for method in methods if method not in MODELS])
    reach = end_of_axis(found)
    with mpl.rc_context({"svg.hashsalt": "rockwobble", "font.size": 10}):
        figure = Figure(figsize=(8.0, 4.6), layout="constrained")
        axes = figure.subplots()
        for method in methods:
            runs = found.members[(found.members["method"] == method) & (found.members["outcome"] != "failed")]
            standing = np.sort(runs.loc[runs["outcome"] != "overturned", "peak_tilt"].to_numpy(float))
            if not len(runs):
                continue
            style = model_style(method) if method in MODELS else styles[method]
            axes.step(
                np.concatenate([[0.0], standing, [reach]]),
                np.append(np.arange(len(standing) + 1), len(standing)) / len(runs),
                where="post",
                color=style.colour,
                linestyle=DASHES[style.dash],
                linewidth=1.6,
                label=method,
            )
        axes.set_xlabel("peak tilt / α [-]")
        axes.set_ylabel("share of the members [-]")
        axes.set_ylim(0.0, 1.02)
        axes.set_xlim(0.0, reach)
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False, fontsize=9)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": "rockwobble"})
    return buffer.getvalue()
