"""The motion of one cylinder as a picture: tilt over time, and the path of the contact point from above."""

from __future__ import annotations

import math

import numpy as np

from rockwobble.compare.metrics.pair import balance_of
from rockwobble.models import Trace
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.studies.advice.demands import overturning_time

from .palette import GREY, ORDER, Style
from .picture import TIME, Array, Axis, Layer, Line, Panel, Picture, Rule, caption, tilt_axis

_PATH = Style(colour=ORDER[0])
_POINT = Style(colour=ORDER[1])
_CLOSE = 5e-3  # least distance of drawn points, over the extent of the path
_ARC = 0.1  # [rad] between points of the rim
_CIRCLE = Style(colour=GREY, dash="dash")


def pictures(trace: Trace) -> list[Picture]:
    """Tilt over alpha against time; path of the top and, on flat ground, of the contact point from above."""
    cylinder = trace.case.cylinder
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    tilts = trace.tilt / cylinder.alpha
    tilt: list[Layer] = [Line(x=trace.time, y=tilts, style=_PATH)]
    if trace.uplift_time > 0.0:
        tilt.append(Rule(at=trace.uplift_time, axis="x", text="uplift", side="right"))
    falls, balance = overturning_time(trace), balance_of(trace.case)
    if math.isfinite(falls) and balance < OVERTURNED_TILT:
        tilt.append(Rule(at=falls, axis="x", text="passes its balance for good", side="left"))
    b = cylinder.base_radius
    path = [Line(x=b * np.cos(turn), y=b * np.sin(turn), style=_CIRCLE, name="base", width=1.0)]
    paths = {"top": (_top(trace), _PATH)}
    if not (trace.run.support.is_recess or trace.run.is_planar):
        paths["contact point"] = _along_the_rim(trace), _POINT
    for name, (places, style) in paths.items():
        x, y = _thin(places).T
        path.append(Line(x=x, y=y, style=style, name=name, width=1.0))
    panels = [
        Panel(x=TIME, y=tilt_axis([tilts], balance / cylinder.alpha), layers=tilt, title="tilt", height=3.4),
        Panel(
            x=Axis(label="x", unit="m"),
            y=Axis(label="y", unit="m"),
            layers=path,
            title="seen from above",
            equal=True,
            height=3.4,
        ),
    ]
    title = f"{trace.case.name}, {trace.run}"
    return [Picture(name="trace", title=title, caption=caption("trace"), panels=panels, columns=2)]


def _top(trace: Trace) -> Array:
    """Places of the centre of the top (n, 2) [m], seen from above."""
    body = trace.case.cylinder
    out = (2.0 * body.half_height - body.mass_centre_height) * np.sin(trace.tilt)
    angle = np.nan_to_num(trace.rolling_angle)  # no rolling angle at rest, where the path has no length
    top: Array = trace.centre_of_mass[:, :2] + out[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return top


def _along_the_rim(trace: Trace) -> Array:
    """Places of the contact point (n, 2) [m], joined along the rim between samples; NaN at rest."""
    b, angle = trace.case.cylinder.base_radius, trace.rolling_angle
    centre = trace.contact_point - b * np.column_stack([np.cos(angle), np.sin(angle)])
    turned = np.nan_to_num(np.abs(np.diff(angle)))
    parts = np.minimum(np.ceil(turned / _ARC), 100.0).astype(int).clip(1)
    start = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(len(start)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[start]
    fine = angle[start] + share * (angle[start + 1] - angle[start])
    along: Array = centre[start] + share[:, None] * (centre[start + 1] - centre[start])
    along += b * np.column_stack([np.cos(fine), np.sin(fine)])
    return along


def _thin(places: Array) -> Array:
    """Subset of points (n, 2) that suffices for a path, with one NaN point between pieces."""
    if not np.isfinite(places).any():
        return places[:1]
    apart = _CLOSE * max(float(np.nanmax(np.ptp(places[np.isfinite(places[:, 0])], axis=0))), 1e-300)
    way = np.nan_to_num(np.hypot(*np.diff(places, axis=0).T))
    travelled = np.diff(np.cumsum(way) // apart, prepend=-1.0, append=math.inf) != 0.0
    ends = np.diff(np.isnan(places[:, 0]).astype(int)) != 0
    shown: Array = places[travelled | np.append(ends, False) | np.insert(ends, 0, False)]
    return shown
