"""The motion of one cylinder as a picture: tilt over time, and the path of the contact point from above."""

from __future__ import annotations

import numpy as np

from rockwobble.models import Trace

from .palette import GREY, ORDER, Style
from .picture import TILT, TIME, Axis, Layer, Line, Panel, Picture, Pictures, Rule, at_hand

_PATH = Style(colour=ORDER[0])
_CIRCLE = Style(colour=GREY, dash="dash")


def pictures(trace: Trace) -> Pictures:
    """Return what makes the picture of a motion, by name."""
    return at_hand(trace_picture(trace))


def trace_picture(trace: Trace) -> Picture:
    """Return tilt over alpha against time, and the contact point over b against the original circle."""
    cylinder = trace.case.cylinder
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    x, y = trace.contact_point.T / cylinder.base_radius
    tilt: list[Layer] = [
        Line(x=trace.time, y=trace.tilt / cylinder.alpha, style=_PATH),
        *(
            [Rule(at=trace.uplift_time, axis="x", text="uplift", side="right")]
            if trace.uplift_time > 0.0
            else []
        ),
    ]
    path = [
        Line(x=np.cos(turn), y=np.sin(turn), style=_CIRCLE, name="original circle", width=1.0),
        Line(x=x, y=y, style=_PATH, name="contact point", width=1.0),
    ]
    return Picture(
        name="trace",
        title=f"{trace.case.name}, {trace.run}",
        caption="Tilt of the axis in units of alpha, and where the rim touches the ground, seen from above.",
        panels=[
            Panel(x=TIME, y=TILT, layers=tilt, title="tilt", height=3.4),
            Panel(
                x=Axis(label="x / b", unit="-"),
                y=Axis(label="y / b", unit="-"),
                layers=path,
                title="contact point",
                equal=True,
                height=3.4,
            ),
        ],
        columns=2,
    )
