"""Maps of peak tilt over size and intensity, and the lowest intensities found to overturn."""

from __future__ import annotations

import numpy as np

from rockwobble.models import Run
from rockwobble.studies.spectrum.maps import TiltMaps, safe_gaps
from rockwobble.studies.spectrum.parts import PLANAR_X, PLANAR_Y, SERIES, SPATIAL, TITLES
from rockwobble.studies.spectrum.study import OverturningSpectrum

from .heat import PEAKS, Heat, peak_map
from .palette import Style, model_style, run_styles
from .picture import Axis, Line, Panel, Picture, bar_ends, caption

NAMES = TITLES | {SPATIAL: "3D"}
_HEIGHT = 3.4
_ASIDE = {SPATIAL: 0.0, PLANAR_X: -0.3, PLANAR_Y: 0.3}  # offset over the spacing of sizes: gaps side by side


def pictures(results: OverturningSpectrum) -> list[Picture]:
    """Map of each series, and the lowest intensities with the safe gaps above them."""
    return [picture_of(results.maps)]


def picture_of(spectrum: TiltMaps) -> Picture:
    """Picture of tilt maps."""
    size = Axis(label="R", unit="m")
    low, high = (float(spectrum.intensities[end]) for end in (0, -1))
    intensity = Axis(label="peak resultant / (g tan α)", unit="-", low=low, high=high)
    own_peak = Axis(label="peak of the component / (g tan α)", unit="-")
    shares = {series: spectrum.component_share(series) for series in SERIES}
    maps = [
        Panel(
            x=size,
            y=intensity,
            title=TITLES[series],
            layers=[
                _map(spectrum, series),
                Line(
                    x=spectrum.semidiagonals,
                    y=spectrum.lowest[series],
                    name="overturning boundary",
                    width=1.1,
                ),
            ],
            height=_HEIGHT,
            second=None if share in (0.0, 1.0) else (own_peak, share),
        )
        for series, share in shares.items()
    ]
    curves = Panel(
        x=size,
        y=intensity,
        title="overturning boundary, safe gaps (thin)",
        layers=_curves(spectrum),
        height=_HEIGHT,
    )
    return Picture(
        name="spectrum",
        caption=caption("spectrum", name=spectrum.motion.name or "record", ratio=spectrum.tan_alpha),
        panels=[*maps, curves],
        columns=2,
        shades=PEAKS,
    )


def _map(spectrum: TiltMaps, series: str) -> Heat:
    tilt, fell = spectrum.peak_tilt[series].T / spectrum.alpha, spectrum.overturned(series).T
    return peak_map(spectrum.semidiagonals, spectrum.intensities, tilt, fell)


def series_styles(model: str) -> dict[str, Style]:
    """Style of each series, for 3D the style of the model with this label."""
    return {SPATIAL: model_style(model), **run_styles([PLANAR_X, PLANAR_Y])}


def _curves(spectrum: TiltMaps) -> list[Line]:
    styles = series_styles(str(Run(None, spectrum.plan.support)))
    gaps = safe_gaps(spectrum)
    spacing = float(np.diff(spectrum.semidiagonals).min(initial=np.inf))
    half = 0.5 * float(np.diff(spectrum.intensities).min(initial=np.inf))
    entries: list[Line] = []
    for series in SERIES:
        closed = gaps[gaps["closed"] & (gaps["series"] == series)]
        place = closed["semidiagonal"].to_numpy(float) + _ASIDE[series] * spacing
        ends = closed["lower"].to_numpy(float) - half, closed["upper"].to_numpy(float) + half
        thin = Style(colour=styles[series].colour)
        entries += [
            Line(x=bar_ends(place, place), y=bar_ends(*ends), style=thin, width=0.7, opacity=0.45),
            Line(
                x=spectrum.semidiagonals,
                y=spectrum.lowest[series],
                name=NAMES[series],
                style=styles[series],
                width=1.6,
            ),
        ]
    return entries
