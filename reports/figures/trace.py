"""The motion of one cylinder as a picture: tilt over time, and the path of the contact point from above."""

from __future__ import annotations

import math

import numpy as np

from rockwobble.compare.metrics.pair import balance_of
from rockwobble.models import Trace
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.studies.advice.demands import fall_of

from .palette import GREY, ORDER, Style
from .picture import TIME, Array, Axis, Layer, Line, Panel, Picture, Rule, tilt_axis

_PATH = Style(colour=ORDER[0])
_PLACES = Style(colour=ORDER[0], dash="none", symbol="circle")  # between which it only jumps, in a plane
_JUMP = 0.5  # of b between two samples: in a near pass the point runs along the circle, not across it
_APART = 0.1  # of b between points that are drawn
_CIRCLE = Style(colour=GREY, dash="dash")


def pictures(trace: Trace) -> list[Picture]:
    """Return tilt over alpha against time, and the contact point over b against the original circle."""
    cylinder = trace.case.cylinder
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    x, y = _path(trace.contact_point / cylinder.base_radius).T
    rolls = np.nansum(np.hypot(np.diff(x), np.diff(y))) > _APART
    tilts = trace.tilt / cylinder.alpha
    tilt: list[Layer] = [Line(x=trace.time, y=tilts, style=_PATH)]
    if trace.uplift_time > 0.0:
        tilt.append(Rule(at=trace.uplift_time, axis="x", text="uplift", side="right"))
    falls, balance = fall_of(trace), balance_of(trace.case)
    if math.isfinite(falls) and balance < OVERTURNED_TILT:
        name = "α" if balance == cylinder.alpha else "its balance"
        tilt.append(Rule(at=falls, axis="x", text=f"passes {name} for good", side="left"))
    path = [
        Line(x=np.cos(turn), y=np.sin(turn), style=_CIRCLE, name="original circle", width=1.0),
        Line(x=x, y=y, style=_PATH if rolls else _PLACES, name="contact point", width=1.0),
    ]
    panels = [
        Panel(x=TIME, y=tilt_axis([tilts], balance / cylinder.alpha), layers=tilt, title="tilt", height=3.4),
        Panel(
            x=Axis(label="x / b", unit="-"),
            y=Axis(label="y / b", unit="-"),
            layers=path,
            title="contact point",
            equal=True,
            height=3.4,
        ),
    ]
    title = f"{trace.case.name}, {trace.run}"
    caption = "Tilt of the axis in units of alpha, and where the rim touches the ground, seen from above."
    return [Picture(name="trace", title=title, caption=caption, panels=panels, columns=2)]


def _path(places: Array) -> Array:
    """Return as many of some places (n, 2) as a path shows, its pieces separated by NaN where it jumps.

    While the cylinder stands it has no place: NaN, of which one is kept.
    """
    way = np.hypot(*np.diff(places, axis=0).T)
    jumps = way > _JUMP
    ends = jumps | (np.diff(np.isnan(places[:, 0])) != 0)  # between two samples, one on either side
    travelled = np.cumsum(np.where(jumps | np.isnan(way), 0.0, way)) // _APART
    drawn = np.append(ends, True) | np.concatenate([[True], (np.diff(travelled, prepend=0.0) > 0.0) | ends])
    after = np.flatnonzero(np.diff(np.concatenate([[0], np.cumsum(jumps)])[drawn])) + 1
    return np.insert(places[drawn], after, np.nan, axis=0)
