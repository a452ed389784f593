"""The ground acceleration."""

from __future__ import annotations

import numpy as np

from ..palette import Style
from ..picture import TIME, Axis, Layer, Line, Panel, Picture, Rule
from .view import CaseView

_AXES = (("x, east-west", "#0072B2"), ("y, north-south", "#D55E00"), ("z, up", "#009E73"))


def excitation_picture(view: CaseView, name: str) -> Picture | None:
    """Return the components of the ground acceleration, None where the ground is still."""
    motion, gravity = view.case.motion, view.case.gravity
    if motion is None:
        return None
    time = np.arange(len(motion.acceleration), dtype=np.float64) * motion.time_step
    threshold = view.case.cylinder.tan_alpha
    peak = max(1.15 * threshold, 1.05 * float(np.abs(motion.acceleration).max()) / gravity)
    lines = [
        Line(x=time, y=component / gravity, name=words, style=Style(colour=colour), width=0.9)
        for component, (words, colour) in zip(motion.acceleration.T, _AXES, strict=False)
    ]
    words = f"uplift where |a| exceeds tan α = {threshold:g}"
    layers: list[Layer] = [
        *lines,
        Rule(at=threshold, axis="y", text=words, side="right"),
        Rule(at=-threshold, axis="y"),
    ]
    y = Axis(label="ground acceleration / g", unit="-", low=-peak, high=peak)
    return Picture(
        name=name,
        title="Excitation",
        caption="Acceleration of the ground. The cylinder uplifts where the horizontal resultant exceeds the "
        "dashed line.",
        panels=[Panel(x=TIME, y=y, layers=layers)],
        link_x=True,
    )
