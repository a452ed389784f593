"""What pictures for a document have in common: style, width, and the same bytes for the same numbers."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .thinning import kept_samples

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rockwobble.models import Trace

# a column of text on a screen is some 830 pixels wide, 96 to the inch [inch]
WIDTH = 8.6
GRID = "#dddddd"
# more points than such a column has pixels
_POINTS = 1600
_STYLE: Any = {
    "svg.hashsalt": "rockwobble",
    "font.size": 9.5,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.linewidth": 0.7,
    "legend.fontsize": 8.5,
    "legend.framealpha": 0.9,
    "path.simplify_threshold": 0.3,
}
# of what an SVG cannot hold as lines
_RASTER_DPI = 200


def drawn(draw: Callable[[Figure], None], height: float) -> bytes:
    """Return the SVG of a figure of `height` [inch] that `draw` fills."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    buffer = io.BytesIO()
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(WIDTH, height), layout="constrained")
        draw(figure)
        metadata = {"Date": None, "Creator": "rockwobble"}
        figure.savefig(buffer, format="svg", dpi=_RASTER_DPI, metadata=metadata)
    return buffer.getvalue()


def drawn_samples(response: Trace, keep: slice | NDArray[np.intp]) -> pd.DataFrame:
    """Return what the figures show of a response at the samples to keep, by the names of its table.

    The whole table of the finely sampled releases would take as much memory as figure 6.
    """
    import pandas as pd

    names = ("time", "tilt", "tilt_rate", "rolling_angle", "rolling_rate")
    table = pd.DataFrame({name: getattr(response, name)[keep] for name in names})
    table[["centre_x", "centre_y"]] = response.centre_of_mass[keep, :2]
    return table


def line(axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], **style: Any) -> None:
    """Draw y over x, thinned to what can be seen."""
    keep = kept_samples(y, points=_POINTS)
    axes.plot(x[keep], y[keep], **style)


def path(axes: Axes, points: NDArray[np.float64], **style: Any) -> None:
    """Draw a path (n, 2), thinned to what can be seen."""
    keep = kept_samples(points[:, 0], points[:, 1], points=2 * _POINTS)
    axes.plot(points[keep, 0], points[keep, 1], **style)


def with_grid(axes: Axes) -> None:
    """Draw grid lines behind everything."""
    axes.set_axisbelow(True)
    axes.grid(color=GRID, linewidth=0.6)
