"""Figures 3 to 6 of the paper, computed again, with a verdict on each of its statements; see script.py."""

from __future__ import annotations

import argparse
import math
import sys
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare import Results
from rockwobble.models import Run
from rockwobble.reports.figures.palette import DARK, ORDER, SHADED, Style
from rockwobble.reports.figures.picture import TIME, Axis, Layer, Line, Panel, Picture, Rule
from rockwobble.reports.figures.spectrum import NAMES, pictures, series_styles
from rockwobble.reports.pages.page import Page
from rockwobble.reports.pages.spectrum import spectrum_values
from rockwobble.reports.pages.table import number
from rockwobble.reports.published.paper import earthquake, free, overturning
from rockwobble.reports.published.paper.overturning import lowest_on_axes
from rockwobble.reports.published.paper.statements import PIER, Statement, from_frame, to_frame
from rockwobble.reports.published.script import run
from rockwobble.studies import OverturningSpectrum

_SAMPLES = 12_000  # of figure 5 that are kept


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Paper(Results, kind="paper"):
    """The figures of the paper, computed again, and verdicts on what it says of them.

    Attributes
    ----------
    figure-3, figure-4, figure-5 : DataFrame
        What the figures show.
    statements : DataFrame
        Numbers of each statement and its verdict, see `to_frame`.
    spectrum, record, lowest, gaps, contrast, checked : DataFrame
        Figure 6, see `OverturningSpectrum`.
    """

    def headline(self) -> dict[str, int]:
        """Number of statements with each verdict."""
        return {**Counter(each.verdict for each in from_frame(self.statements))}


def measure(given: argparse.Namespace) -> Paper:
    """Run figures 3 to 6."""
    curves, modes, shaken = free.periods(), free.free_modes(), earthquake.shaken()
    spectrum = overturning.spectrum_of(given.grid)
    statements = [
        *free.period_statements(curves),
        *free.mode_statements(modes),
        *earthquake.statements(shaken),
        *overturning.statements(spectrum),
    ]
    tables = {
        "figure-3": curves,
        "figure-4": free.to_frame(modes),
        "figure-5": free.drawn_samples(shaken.trace, _SAMPLES),
        "statements": to_frame(statements),
        **spectrum.tables,
    }
    return Paper(tables=tables, facts=spectrum.facts)


def page_of(paper: Paper) -> Page:
    """Page of the figures."""
    tables, spectrum = paper.tables, OverturningSpectrum(tables=paper.tables, facts=paper.facts)
    by_name = {each.name: each for each in from_frame(paper.statements)}
    shaken = {**by_name["abrupt"].numbers, "time_step": spectrum.maps.motion.time_step}
    return Page(
        name="paper",
        template=Path(__file__).with_name("page.md.j2"),
        values={
            **spectrum_values(spectrum),
            "statements": by_name,
            "judgements": {name: _judgement(each) for name, each in by_name.items()},
            "linear_range": _linear_range(by_name["housner"].numbers),
            "copy_agreement": _copy_agreement(by_name["abrupt"].numbers),
            "at_the_end": _at_the_end(by_name["place"].numbers),
            "lower_from": _lower_from(by_name["large_equal"].numbers),
            "cylinder": PIER,
            "release": free.RELEASE,
            "about": paper.manifest,
        },
        pictures=[
            period_picture(tables["figure-3"]),
            free_picture(tables["figure-4"]),
            earthquake_picture(tables["figure-5"], tables["record"], shaken),
            overturning_picture(spectrum),
        ],
    )


# of what follows, a sentence of several lines has the lines of the document


def _judgement(statement: Statement) -> str:
    """Verdict on a statement of the paper, with the axes it holds on."""
    return f"{'On equal shaking it' if statement.name.endswith('equal') else 'It'} {statement.verdict}."


def _linear_range(numbers: Mapping[str, float]) -> str:
    """Slenderness up to which Housner's linearised period holds."""
    if not (good := numbers["good"]):
        return "never so close"
    return f"within {number(numbers['tolerance'], 'percent')} up to tan α =\n{number(good)}"


def _copy_agreement(numbers: Mapping[str, float]) -> str:
    """Time from which a perturbed copy differs."""
    if math.isfinite(until := numbers["agreement"]):
        return (
            f"differs by 1 % of α from {number(until, '.1f')} s on: passes close\nto upright amplify every "
            "difference, and from there on this response is one of many"
        )
    return "stays within 1 % of α of this\nresponse to the end"


def _at_the_end(numbers: Mapping[str, float]) -> str:
    """Whether the cylinder has returned to its place at the end of the record."""
    if numbers["rests"]:
        return "it stands where it stood"
    return (
        f"it still rocks,\nundamped as it is, at {number(numbers['last_tilt'], '.3f')} α, the centre of its "
        f"base {number(numbers['last_away'], '.1g')} b from\nits place"
    )


def _lower_from(numbers: Mapping[str, float]) -> str:
    """Size from which on the 3D boundary is lowest at every size; empty if not at the largest."""
    size = numbers["from"]
    return "" if math.isnan(size) else f", and from R = {number(size)} m up at every size"


Array = NDArray[np.float64]

_LINE = Style(colour=ORDER[0])
_PIER = f"R = {PIER.semidiagonal:g} m, tan α = {PIER.tan_alpha:g}"
# cividis, dark to light by slenderness
_SHADES = ("#00224e", "#2b406d", "#595e6e", "#7e7d78", "#a99f73", "#d6c35d")
_ROCKING = (1.0, free.DISC)  # curves of slender bodies lie under Housner's
_HISTORIES = (("θ / α", "-"), ("θ'", "rad/s"), ("φ / π", "-"), ("φ'", "rad/s"))
_FROM_0 = replace(TIME, low=0.0)


def period_picture(table: pd.DataFrame) -> Picture:
    """Return figure 3."""
    layers: list[Layer] = []
    for tan_alpha, colour in zip(free.TAN_ALPHAS, _SHADES, strict=True):
        x, y = free.curve(table, "wobble", tan_alpha)
        name = f"wobble, tan α = {tan_alpha:g}" + (" (disc)" if tan_alpha == free.DISC else "")
        layers.append(Line(x=x, y=y, name=name, style=Style(colour=colour), width=1.6))
    for tan_alpha, dash in zip(_ROCKING, ("dash", "dashdot"), strict=True):
        x, y = free.curve(table, "rocking", tan_alpha)
        colour = _SHADES[free.TAN_ALPHAS.index(tan_alpha)]
        name = f"planar, tan α = {tan_alpha:g}" + (" (disc)" if tan_alpha == free.DISC else "")
        layers.append(Line(x=x, y=y, name=name, style=Style(colour=colour, dash=dash), width=1.1))
    x, y = free.curve(table, "housner")
    layers.append(Line(x=x, y=y, name="planar, Housner", style=Style(colour=ORDER[1], dash="dot"), width=2.0))
    panel = Panel(
        x=Axis(label="tilt / α", unit="-", low=0.0, high=1.0),
        y=Axis(label="p × period", unit="-", low=0.0, high=15.0),
        layers=layers,
        height=4.0,
    )
    return Picture(
        name="figure-3",
        title="Periods over the tilt, any size",
        caption="p times the time in which the contact point goes once round the rim at constant tilt, for "
        "bodies from slender to flat; and p times the full period of planar rocking released at that "
        "tilt: linearised after Housner (dotted), which does not depend on α, and exact for tan α = 1 "
        "(dashed) and for the disc (dash-dotted).",
        panels=[panel],
    )


def free_picture(table: pd.DataFrame) -> Picture:
    """Return figure 4: one column for each mode, the path of the centre of mass above its time histories."""
    modes = {str(mode): rows for mode, rows in table.groupby("mode", sort=False)}
    orbits = [_orbit(mode, rows) for mode, rows in modes.items()]
    histories = [_histories(rows, PIER.alpha) for rows in modes.values()]
    rate = 1.1 * max(float(np.abs(each[1]).max()) for each in histories)
    # the same scale across, so that the modes compare; the rates of rolling need their own
    ends = ((0.0, 1.1 * free.RELEASE), (-rate, rate), (None, None), (None, None))
    panels = []
    for place, ((label, unit), (low, high)) in enumerate(zip(_HISTORIES, ends, strict=True)):
        for rows, values in zip(modes.values(), (each[place] for each in histories), strict=True):
            # of hardly any spin the rate spans decades
            log = place == 3 and bool(values.max() > 100.0 * values.min())
            room = (0.0, 1.15 * float(values.max())) if place == 3 and not log else (low, high)
            y = Axis(label=label, unit=unit, low=room[0], high=room[1], log=log)
            line = Line(x=_column(rows, "time"), y=values, style=_LINE)
            panels.append(Panel(x=_FROM_0, y=y, layers=[line], height=1.5))
    return Picture(
        name="figure-4",
        title=f"Paths and time histories of the modes, {_PIER}",
        caption="Top row: path of the centre of mass, seen from above; it starts at the dot.",
        panels=[*orbits, *panels],
        columns=len(modes),
    )


def _orbit(mode: str, rows: pd.DataFrame) -> Panel:
    x, y = _column(rows, "centre_x"), _column(rows, "centre_y")
    reach = 1.12 * float(np.abs([x, y]).max())
    start = Line(x=x[:1], y=y[:1], style=Style(colour=DARK, dash="none", symbol="circle"), size=4.0)
    return Panel(
        x=Axis(label="x", unit="m", low=-reach, high=reach),
        y=Axis(label="y of the centre of mass", unit="m", low=-reach, high=reach),
        layers=[Line(x=x, y=y, style=_LINE, width=0.9), start],
        title=f"{mode}\nφ'(0) = {_column(rows, 'rolling_rate')[0]:.3g} rad/s",
        equal=True,
        height=2.9,
    )


def _histories(rows: pd.DataFrame, alpha: float) -> tuple[Array, ...]:
    names = ("tilt", "tilt_rate", "rolling_angle", "rolling_rate")
    tilt, rate, angle, rolling = (_column(rows, name) for name in names)
    return tilt / alpha, rate, angle / math.pi, rolling


def _column(rows: pd.DataFrame, name: str) -> Array:
    return rows[name].to_numpy(dtype=np.float64)


def earthquake_picture(table: pd.DataFrame, record: pd.DataFrame, numbers: Mapping[str, float]) -> Picture:
    """Figure 5: response above, record below, strong part shaded."""
    cylinder, gravity = PIER, 9.81
    marks: list[Layer] = [Rule(at=numbers["from"], until=numbers["until"], axis="x", colour=SHADED)]
    if math.isfinite(numbers["agreement"]):
        marks.append(Rule(at=numbers["agreement"], axis="x", colour="#777777"))
    tilt, rate, angle, rolling = _histories(table, cylinder.alpha)
    shown = [(tilt, 1.9), (rate, 1.5), (angle, 1.9), (_signed_log(rolling), 1.6)]
    ticks = [(float(_signed_log(np.array([v]))[0]), f"{v:g}") for v in (-1000.0, -10.0, 0.0, 10.0, 1000.0)]
    axes = [Axis(label=label, unit=unit) for label, unit in _HISTORIES]
    axes = [replace(axes[0], low=0.0), *axes[1:3], replace(axes[3], ticks=ticks)]
    panels = [
        _over_time(_column(table, "time"), values, y, marks, _LINE, height)
        for (values, height), y in zip(shown, axes, strict=True)
    ]
    at = np.arange(len(record), dtype=np.float64) * numbers["time_step"]
    largest = 1.1 * float(record[["x", "y"]].abs().to_numpy().max()) / gravity
    for name, label in (("x", "east-west"), ("y", "north-south")):
        y = Axis(label=label, unit="g", low=-largest, high=largest)
        ground = _column(record, name) / gravity
        panels.append(_over_time(at, ground, y, marks, Style(colour="#444444"), 1.4))
    return Picture(
        name="figure-5",
        title="Response and ground motion, El Centro 1940",
        caption=f"R = {cylinder.semidiagonal:g} m, tan α = {cylinder.tan_alpha:g}. Shaded: the record itself "
        f"can uplift; dashed: from here on the response to a record {100.0 * earthquake.NUDGE:g} % stronger "
        "differs by 1 % of α.",
        panels=panels,
        link_x=True,
    )


def _over_time(x: Array, y: Array, axis: Axis, marks: list[Layer], style: Style, height: float) -> Panel:
    line = Line(x=x, y=y, style=style, width=0.8)
    return Panel(x=_FROM_0, y=axis, layers=[*marks, line], height=height)


def _signed_log(values: Array) -> Array:
    """Signed logarithmic scale, linear below 1."""
    size = np.abs(values)
    return np.asarray(np.sign(values) * np.where(size < 1.0, size, 1.0 + np.log10(np.maximum(size, 1.0))))


def overturning_picture(spectrum: OverturningSpectrum) -> Picture:
    """Return figure 6: the maps, and the overturning boundaries on two axes."""
    (whole,) = pictures(spectrum)
    styles = series_styles(str(Run(None, spectrum.maps.plan.support)))
    curves = []
    for own, label in ((True, "own peak / (g tan α)"), (False, "peak resultant / (g tan α)")):
        lowest = lowest_on_axes(spectrum, own=own)
        lines = [
            Line(
                x=spectrum.maps.semidiagonals, y=lowest[name], name=NAMES[name], style=styles[name], width=1.6
            )
            for name in lowest
        ]
        title = "overturning boundary, " + ("axis of the paper" if own else "equal ground motion")
        y = Axis(label=label, unit="-", low=0.0)
        curves.append(Panel(x=Axis(label="R", unit="m"), y=y, layers=lines, title=title, height=3.2))
    return replace(
        whole,
        name="figure-6",
        title=f"Peak tilts and overturning boundaries, El Centro 1940, tan α = {spectrum.maps.tan_alpha:g}",
        caption="Peak tilt of sizes under intensities, in 3D and of each component alone, undamped; the "
        "line is the overturning boundary as found by the search. The three runs of a cell "
        "share one factor on the record; the scale on the right of a planar map is the peak of "
        "its own component, the axis of the paper.",
        panels=[*whole.panels[:3], *curves],
    )


def options(parser: argparse.ArgumentParser) -> None:
    """Add the option of this script."""
    parser.add_argument(
        "--grid", type=int, default=100, help="sizes and intensities of figure 6 (%(default)s)"
    )


if __name__ == "__main__":
    sys.exit(run(__file__, Paper, measure, page_of, options=options))
