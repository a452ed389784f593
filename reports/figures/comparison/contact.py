"""Contact point as a picture: its azimuth, its way off the original circle, and its turn in each pass."""

from __future__ import annotations

import math

import numpy as np

from rockwobble.compare import TILTED
from rockwobble.models.support import SUPPORTS
from rockwobble.reduced import limiting_angle_of_turn

from ..palette import SYMBOLS, Style
from ..picture import TIME, Array, Axis, Layer, Line, Panel, Picture, Rule
from .view import CaseView

_TURNS = Axis(label="azimuth of contact", unit="turns")
_DRIFT = Axis(label="radial drift / b", unit="%")
_ANGLE = Axis(label="|angle of turn|", unit="deg", low=0.0)


def contact_picture(view: CaseView, name: str) -> Picture:
    """Return the unwrapped azimuth of the contact point, and by support its distance from the circle."""
    return Picture(
        name=name,
        title="Where the rim touches",
        caption="Azimuth of the contact point, counted through whole turns; a jump of about half a turn is a "
        "pass. Below, its distance from the original circle, where the tilt exceeds 5 % of its peak: a "
        "cylinder in a recess keeps to the circle, on flat ground it rolls out.",
        panels=[_azimuth(view), *(_drift(view, support) for support in view.supports)],
        link_x=True,
    )


def azimuth_picture(view: CaseView, name: str) -> Picture:
    """Return the azimuth alone."""
    whole = contact_picture(view, name)
    return Picture(name=name, title=whole.title, caption=whole.caption, panels=whole.panels[:1], link_x=True)


def _azimuth(view: CaseView) -> Panel:
    starts = (trace.uplift_direction for trace in view.references.values())
    origin = next((start / (2.0 * np.pi) for start in starts if math.isfinite(start)), 0.0)
    layers = []
    for label, trace in view.traces.items():
        turns = trace.rolling_angle / (2.0 * np.pi)
        known = turns[np.isfinite(turns)]
        # azimuths are known up to whole turns: all start on the branch of the model
        branch = round(float(known[0]) - origin) if len(known) else 0
        width = 1.6 if label in view.runs else 0.9
        layers.append(Line(x=trace.time, y=turns - branch, name=label, style=view.styles[label], width=width))
    return Panel(x=TIME, y=_TURNS, layers=layers, title="azimuth")


def _drift(view: CaseView, support: str) -> Panel:
    """(|T| - b)/b, where the tilt is so large that a contact point means something."""
    layers = []
    for label, trace in view.traces.items():
        # a guided model keeps to the circle: that line is zero
        guided = support in SUPPORTS and SUPPORTS[support].guided
        if trace.run.support != support or (label not in view.runs and guided):
            continue
        tilted = trace.tilt > TILTED * np.nanmax(trace.tilt)
        drift: Array = 100.0 * trace.contact_offset / trace.case.cylinder.base_radius
        shown = np.where(tilted, drift, np.nan)
        layers.append(Line(x=trace.time, y=shown, name=label, style=view.styles[label]))
    return Panel(x=TIME, y=_DRIFT, layers=layers, title=f"drift, support {support}", height=2.0)


def turn_picture(view: CaseView, name: str, *, notes: bool = True) -> Picture:
    """Return |angle of turn| of each pass, against its limit for vanishing spin; `notes` give its tilt."""
    limit = math.degrees(limiting_angle_of_turn(view.case.cylinder))
    layers: list[Layer] = [Rule(at=limit, axis="y", text=f"π √(A/J) = {limit:.2f}°, vanishing spin")]
    for (label, trace), symbol in zip(view.traces.items(), _symbols(view), strict=False):
        passes = trace.passes
        resolved = passes["resolved"].to_numpy(bool)
        tilts = passes["minimum_tilt"].to_numpy(float) / view.case.cylinder.alpha
        layers.append(
            Line(
                x=passes["time"].to_numpy(float),
                y=np.abs(np.degrees(passes["angle_of_turn"].to_numpy(float))),
                name=label,
                style=Style(colour=view.styles[label].colour, dash="none", symbol=symbol),
                filled=bool(resolved.all()) or resolved,
                notes=[f"minimum tilt {tilt:.2g} α" for tilt in tilts] if notes else (),
            )
        )
    x = Axis(label=TIME.label, unit=TIME.unit, low=0.0, high=view.case.length)
    return Picture(
        name=name,
        title="Angle of turn of each pass",
        caption="How far the contact point turns from one tilt maximum to the next; dashed: the exact answer "
        "for vanishing spin. Open symbols are passes closer to upright than contact resolves.",
        panels=[Panel(x=x, y=_ANGLE, layers=layers)],
        link_x=True,
    )


def _symbols(view: CaseView) -> list[str]:
    """Symbols with an area for runs, crosses for references."""
    crosses = ["cross-thin", "x-thin"]
    filled = [symbol for symbol in SYMBOLS if symbol not in crosses]
    runs = [filled[index % len(filled)] for index in range(len(view.runs))]
    return [*runs, *(crosses[index % 2] for index in range(len(view.references)))]
