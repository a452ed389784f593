"""Pictures of one case of a comparison: tilts, contact point, centre of mass, and the ground."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from rockwobble.compare import TILTED, Comparison
from rockwobble.compare.metrics.pair import balance_of, make_pair
from rockwobble.models import Trace
from rockwobble.models.support import Support
from rockwobble.reduced import limiting_angle_of_turn

from .case_view import CaseView, case_views
from .heat import names
from .palette import DARK, GREY, SYMBOLS, Style
from .picture import TIME, Array, Axis, Bars, Layer, Line, Panel, Picture, Rule, caption, tilt_axis
from .thinning import envelope

# least difference drawn on the logarithmic axis [alpha]
SMALLEST = 1e-7
_HEIGHT = 2.3  # [inch]


def pictures(comparison: Comparison) -> Iterator[Picture]:
    """Yield the picture of each case, by its name."""
    return (tilt_picture(view, view.case.name) for view in case_views(comparison))


def tilt_picture(view: CaseView, name: str = "figure") -> Picture:
    """Tilts of one case by support, each with its model, and their differences."""
    cylinder = view.case.cylinder
    groups = [
        [label for label, trace in view.runs.items() if trace.run.support == support]
        for support in view.supports
    ]
    return Picture(
        name=name,
        caption=caption("tilt", name=view.case.name, length=cylinder.semidiagonal, ratio=cylinder.tan_alpha),
        panels=[
            *(_tilts(view, group, support) for group, support in zip(groups, view.supports, strict=True)),
            *(_differences(view, reference) for reference in view.rows["reference"].unique()),
        ],
        link_x=True,
    )


def _tilts(view: CaseView, runs: Sequence[str], support: Support) -> Panel:
    shown = dict.fromkeys([*runs, *map(view.partner, runs)])
    traces = view.traces
    alpha, widths = view.case.cylinder.alpha, {label: 1.6 if label in runs else 0.9 for label in shown}
    layers = [
        Line(
            x=traces[label].time,
            y=traces[label].tilt / alpha,
            name=label,
            style=view.styles[label],
            width=width,
        )
        for label, width in widths.items()
    ]
    y = tilt_axis([line.y for line in layers], balance_of(view.case) / alpha)
    return Panel(x=TIME, y=y, layers=layers, title=support.words, height=_HEIGHT)


def _differences(view: CaseView, reference: str) -> Panel:
    pairs = [each for each in view.pairs() if each[0].reference == reference]
    bounds = {row.tolerance: f"{100.0 * row.tolerance:.2g} % of α" for row, *_ in pairs}
    layers: list[Layer] = [
        Rule(at=max(bound, SMALLEST), axis="y", text=text, side="right") for bound, text in bounds.items()
    ]
    for row, other, trial in pairs:
        pair = make_pair(view.case.cylinder, other, trial, until=view.case.length)
        style = view.styles[row.run]
        apart = np.maximum(envelope(pair.time, np.abs(pair.tilt_difference)), SMALLEST)
        layers.append(Line(x=pair.time, y=apart, name=row.run, style=style))
        if row.left_tolerance:
            mark = Style(colour=style.colour, dash="none", symbol="diamond")
            at = np.array([row.within_tolerance_until])
            layers.append(Line(x=at, y=np.array([row.tolerance]), style=mark, size=7.0))
    y = Axis(label="|tilt difference| / α", unit="-", log=True, low=SMALLEST, high=3.0)
    return Panel(x=TIME, y=y, layers=layers, title=f"difference from {reference}", height=_HEIGHT)


_TURNS = Axis(label="azimuth of contact", unit="turns")
_DRIFT = Axis(label="radial drift / b", unit="%")
_ANGLE = Axis(label="|angle of turn|", unit="deg", low=0.0)


def contact_picture(view: CaseView, name: str) -> Picture:
    """Unwrapped azimuth of the contact point, and by support its distance from the circle."""
    return Picture(
        name=name,
        caption=caption("contact_point", name=view.case.name),
        panels=[_azimuth(view), *(_drift(view, support) for support in view.supports)],
        link_x=True,
    )


def azimuth_picture(view: CaseView, name: str) -> Picture:
    """Picture of the azimuth against time."""
    whole = contact_picture(view, name)
    return replace(whole, panels=whole.panels[:1])


def _azimuth(view: CaseView) -> Panel:
    starts = (trace.uplift_direction for trace in view.references.values())
    origin = next((start / (2.0 * np.pi) for start in starts if math.isfinite(start)), 0.0)
    layers = []
    for label, trace in view.traces.items():
        turns = trace.rolling_angle / (2.0 * np.pi)
        known = turns[np.isfinite(turns)]
        # azimuths are known up to whole turns: all start on the model's branch
        branch = round(float(known[0]) - origin) if len(known) else 0
        width = 1.6 if label in view.runs else 0.9
        layers.append(Line(x=trace.time, y=turns - branch, name=label, style=view.styles[label], width=width))
    return Panel(x=TIME, y=_TURNS, layers=layers, title="azimuth")


def _drift(view: CaseView, support: Support) -> Panel:
    """Relative distance from the circle (|T| - b)/b, at tilts large enough for a contact point."""
    layers = []
    for label, trace in view.traces.items():
        # no line for guided models, which keep to the circle
        if trace.run.support != support or (label not in view.runs and support.guided):
            continue
        tilted = trace.tilt > TILTED * np.nanmax(trace.tilt)
        drift: Array = 100.0 * trace.contact_offset / trace.case.cylinder.base_radius
        shown = np.where(tilted, drift, np.nan)
        layers.append(Line(x=trace.time, y=shown, name=label, style=view.styles[label]))
    return Panel(x=TIME, y=_DRIFT, layers=layers, title=f"drift, support {support}", height=2.0)


def turn_picture(view: CaseView, name: str, *, notes: bool = True) -> Picture:
    """Angle of turn of each pass with its limit for vanishing spin; `notes`: tilt of each pass."""
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
    x = replace(TIME, low=0.0, high=view.case.length)
    return Picture(
        name=name,
        caption=caption("turns", name=view.case.name),
        panels=[Panel(x=x, y=_ANGLE, layers=layers)],
        link_x=True,
    )


def _symbols(view: CaseView) -> list[str]:
    """Symbols with an area for runs, crosses for references."""
    crosses = ["cross-thin", "x-thin"]
    filled = [symbol for symbol in SYMBOLS if symbol not in crosses]
    runs = [filled[index % len(filled)] for index in range(len(view.runs))]
    return [*runs, *(crosses[index % 2] for index in range(len(view.references)))]


def orbit_picture(view: CaseView, name: str) -> Picture:
    """Path of each run over the path of its model."""
    reach = _reach(view)
    east, north = (Axis(label=side, unit="-", low=-reach, high=reach) for side in _SIDES)
    ends = {(row.run, row.reference): view.divergence(row) for row, _, _ in view.pairs()}
    panels = []
    for label, trace in view.runs.items():
        other = view.partner(label)
        end = ends.get((label, other), math.inf)
        layers = [
            *_path(view.traces[other], other, view.styles[other], end, 2.2),
            *_path(trace, label, view.styles[label], end, 1.3),
        ]
        title = f"{label} over {other}"
        panels.append(Panel(x=east, y=north, layers=layers, title=title, equal=True, height=3.4))
    return Picture(
        name=name,
        caption=caption("orbits", name=view.case.name),
        panels=panels,
        columns=2,
        legend="panels",
    )


_SIDES = ("east-west / b", "north-south / b")


def _reach(view: CaseView) -> float:
    cylinder, balance = view.case.cylinder, balance_of(view.case)
    largest = 0.0
    for trace in view.traces.values():
        # axis cut, as a fallen cylinder would dwarf the rest
        upright = trace.tilt <= 1.2 * balance
        beside = np.abs(trace.centre_of_mass[upright, :2])
        largest = max(largest, float(np.nanmax(beside, initial=0.0)))
    return min(1.08 * largest, 6.0 * cylinder.semidiagonal) / cylinder.base_radius or 1.0


def _path(trace: Trace, name: str, style: Style, end: float, width: float) -> Iterator[Line]:
    path = trace.centre_of_mass[:, :2] / trace.case.cylinder.base_radius
    solid, agreed = Style(colour=style.colour), trace.time <= end
    for part, opacity in ((agreed, 1.0), (~agreed, 0.25)):
        if np.count_nonzero(part) > 1:
            x, y = path[part].T
            yield Line(x=x, y=y, name=name, style=solid, width=width, opacity=opacity)


def residual_picture(view: CaseView, name: str) -> Picture:
    """Return residual displacement and residual twist of each run."""
    once = view.rows.drop_duplicates("run")
    runs = [str(run) for run in once["run"]]
    moved = once["residual_displacement"].to_numpy(float)
    twisted = np.abs(once["residual_twist"].to_numpy(float))
    colours = [view.styles[run].colour if run in view.styles else GREY for run in runs]
    return Picture(
        name=name,
        caption=caption("residuals", name=view.case.name),
        panels=[
            _bars(runs, moved, colours, Axis(label="displacement / b", unit="-", low=0.0), "b"),
            _bars(runs, twisted, colours, Axis(label="twist", unit="deg", low=0.0), "°"),
        ],
        columns=2,
    )


def _bars(runs: list[str], values: Array, colours: list[str], x: Axis, unit: str) -> Panel:
    places, ticks = names(runs)
    known = np.nan_to_num(values)
    # space for the numbers beside the bars
    high = 1.45 * (float(known.max(initial=0.0)) or 1.0)
    texts = [f"{value:.3g} {unit}".replace("nan", "–") for value in values]
    bars = Bars(places=places, start=0.0 * known, end=known, colours=colours, texts=texts)
    return Panel(
        x=Axis(label=x.label, unit=x.unit, low=0.0, high=high),
        y=Axis(label="", unit="", ticks=ticks, reverse=True),
        layers=[bars],
        height=0.7 + 0.3 * len(runs),
    )


_AXES = (("x, east-west", "#0072B2"), ("y, north-south", "#D55E00"), ("z, up", "#009E73"))


def excitation_picture(view: CaseView, name: str) -> Picture | None:
    """Ground acceleration and its horizontal resultant; None on still ground."""
    motion, gravity = view.case.motion, view.case.gravity
    if motion is None:
        return None
    time = np.arange(len(motion.acceleration), dtype=np.float64) * motion.time_step
    threshold = view.case.cylinder.tan_alpha
    resultant = np.hypot(*motion.acceleration.T[:2]) / gravity
    largest = max(float(resultant.max()), float(np.abs(motion.acceleration).max()) / gravity)
    peak = max(1.15 * threshold, 1.05 * largest)
    lines = [Line(x=time, y=resultant, name="horizontal resultant", style=Style(colour=DARK), width=1.1)]
    lines += [
        Line(x=time, y=component / gravity, name=words, style=Style(colour=colour), width=0.9)
        for component, (words, colour) in zip(motion.acceleration.T, _AXES, strict=False)
    ]
    words = f"uplift where the resultant exceeds tan α = {threshold:g}"
    layers: list[Layer] = [*lines, Rule(at=threshold, axis="y", text=words, side="right")]
    y = Axis(label="ground acceleration / g", unit="-", low=-peak, high=peak)
    return Picture(
        name=name,
        caption=caption("excitation", name=view.case.name),
        panels=[Panel(x=TIME, y=y, layers=layers)],
        link_x=True,
    )
