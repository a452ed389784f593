"""The motion of one cylinder as a picture: tilt over time, and the path of the contact point from above."""

from __future__ import annotations

import numpy as np

from rockwobble.models import Trace

from ..palette import GREY, ORDER, Style
from ..picture import TILT, TIME, Axis, Layer, Line, Panel, Picture, Rule
from ..thinning import POINTS, kept_samples

_PATH = Style(colour=ORDER[0])
_JUMP = 0.5  # of b between two samples: in a near pass the point runs along the circle, not across it
_CIRCLE = Style(colour=GREY, dash="dash")


def pictures(trace: Trace) -> list[Picture]:
    """Return tilt over alpha against time, and the contact point over b against the original circle."""
    cylinder = trace.case.cylinder
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    places = trace.contact_point / cylinder.base_radius
    x, y = places[kept_samples(*places.T, points=POINTS // 2)].T  # a renderer leaves out no more of it
    jumps = np.flatnonzero(np.hypot(np.diff(x), np.diff(y)) > _JUMP) + 1
    x, y = (np.insert(each, jumps, np.nan) for each in (x, y))
    tilt: list[Layer] = [Line(x=trace.time, y=trace.tilt / cylinder.alpha, style=_PATH)]
    if trace.uplift_time > 0.0:
        tilt.append(Rule(at=trace.uplift_time, axis="x", text="uplift", side="right"))
    path = [
        Line(x=np.cos(turn), y=np.sin(turn), style=_CIRCLE, name="original circle", width=1.0),
        Line(x=x, y=y, style=_PATH, name="contact point", width=1.0),
    ]
    panels = [
        Panel(x=TIME, y=TILT, layers=tilt, title="tilt", height=3.4),
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
