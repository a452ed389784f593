"""Maps of peak tilt over size and intensity, and the lowest intensities found to overturn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.compare.studies.spectrum.lowest_overturning import Island, safe_islands
from rockwobble.compare.studies.spectrum.series import PLANAR_X, PLANAR_Y, SERIES, SPATIAL
from rockwobble.compare.studies.spectrum.study import OverturningSpectrum

from .drawing import drawn, with_grid
from .palette import model_style, run_styles

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

TITLES = {
    SPATIAL: "3D, both components",
    PLANAR_X: "planar, east-west alone",
    PLANAR_Y: "planar, north-south alone",
}
_SHORT = {SPATIAL: "3D", PLANAR_X: "planar east-west", PLANAR_Y: "planar north-south"}
_HEIGHT = 7.6
# blue for tilt and orange for overturned stay apart for every kind of colour blindness
_TILT_COLOURS = "Blues"
_OVERTURNED = "#D55E00"
_FAILED = "#9a9a9a"
_STEP = 0.1  # of tilt over alpha from one colour to the next
_DASHES: dict[str, Any] = {SPATIAL: "-", PLANAR_X: (0, (5, 1.5)), PLANAR_Y: (0, (1.2, 1.2))}


def spectrum_figure(spectrum: OverturningSpectrum) -> bytes:
    """Return three maps of peak tilt and the lowest intensities found to overturn, as SVG."""

    def draw(figure: Figure) -> None:
        panels = figure.subplots(2, 2)
        colours: Any = None
        for letter, axes, series in zip("abc", panels.flat, SERIES, strict=False):
            colours = _map(axes, spectrum, series)
            axes.set_title(f"({letter}) {TITLES[series]}")
        _curves(panels[1, 1], spectrum)
        panels[1, 1].set_title(f"(d) lowest found to overturn, steps of {spectrum.search_step:g}")
        bar = figure.colorbar(
            colours, ax=panels, location="bottom", shrink=0.75, aspect=45, pad=0.01, extend="max"
        )
        unknown = "; grey: not solved" if spectrum.failed().any() else ""
        bar.set_label(
            f"peak tilt / α [-]   (darkest: above α and back; orange: overturned; white: no uplift{unknown})"
        )

    return drawn(draw, _HEIGHT)


def _map(axes: Axes, spectrum: OverturningSpectrum, series: str) -> Any:
    import matplotlib as mpl
    from matplotlib.colors import BoundaryNorm, ListedColormap

    tilt = spectrum.peak_tilt[series] / spectrum.alpha
    bounds = np.arange(0.0, 1.0 + 0.5 * _STEP, _STEP)
    shades = mpl.colormaps[_TILT_COLOURS](np.linspace(0.08, 1.0, len(bounds)))
    colours = ListedColormap(shades[:-1]).with_extremes(over=shades[-1])
    norm = BoundaryNorm(bounds, len(bounds) - 1)
    edges = _edges(spectrum.semidiagonals), _edges(spectrum.intensities)
    falls = spectrum.overturned(series)
    mesh = axes.pcolormesh(
        *edges, np.ma.masked_where(falls | (tilt == 0.0), tilt).T, cmap=colours, norm=norm, rasterized=True
    )
    for which, colour in ((falls, _OVERTURNED), (np.isnan(tilt), _FAILED)):
        if which.any():
            layer = np.ma.masked_where(~which, np.ones_like(tilt))
            axes.pcolormesh(*edges, layer.T, cmap=ListedColormap([colour]), rasterized=True)
    axes.plot(spectrum.semidiagonals, spectrum.lowest[series], color="black", linewidth=1.1)
    axes.set_xlim(edges[0][0], edges[0][-1])
    axes.set_ylim(edges[1][0], edges[1][-1])
    axes.set_xlabel("R [m]")
    axes.set_ylabel("peak resultant / (g tan α) [-]")
    share = spectrum.component_share(series)
    if share not in (0.0, 1.0):
        own = axes.secondary_yaxis("right", functions=_proportional(share))
        own.set_ylabel("peak of the component / (g tan α) [-]")
    return mesh


def _proportional(share: float) -> Any:
    return (lambda y: y * share), (lambda y: y / share)


def _curves(axes: Axes, spectrum: OverturningSpectrum) -> None:
    sizes, levels = spectrum.semidiagonals, spectrum.intensities
    spacing = float(np.diff(sizes).min()) if len(sizes) > 1 else 0.0
    styles = run_styles([PLANAR_X, PLANAR_Y])
    for place, series in zip((0.0, -0.3, 0.3), SERIES, strict=True):
        colour = model_style(spectrum.model).colour if series == SPATIAL else styles[series].colour
        islands = safe_islands(sizes, levels, spectrum.peak_tilt[series], spectrum.lowest[series])
        _islands(axes, [island for island in islands if island.closed], place * spacing, levels, colour)
        axes.plot(
            sizes,
            spectrum.lowest[series],
            color=colour,
            linestyle=_DASHES[series],
            linewidth=1.6,
            label=_SHORT[series],
        )
    with_grid(axes)
    axes.set_xlim(*_edges(sizes)[[0, -1]])
    axes.set_ylim(*_edges(levels)[[0, -1]])
    axes.set_xlabel("R [m]")
    axes.set_ylabel("peak resultant / (g tan α) [-]")
    axes.legend(loc="best", title="thin bars: safe islands", title_fontsize=8.5)


def _islands(axes: Axes, islands: list[Island], aside: float, levels: Array, colour: str) -> None:
    half = 0.5 * float(np.diff(levels).min()) if len(levels) > 1 else 0.0
    axes.vlines(
        [island.semidiagonal + aside for island in islands],
        [island.lower - half for island in islands],
        [island.upper + half for island in islands],
        colors=colour,
        linewidth=0.7,
        alpha=0.45,
    )


def _edges(centres: Array) -> Array:
    """Edges (n + 1,) of the cells around `centres` (n,)."""
    if len(centres) == 1:
        return np.array([0.9, 1.1]) * float(centres[0])
    between = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate([[2.0 * centres[0] - between[0]], between, [2.0 * centres[-1] - between[-1]]])
