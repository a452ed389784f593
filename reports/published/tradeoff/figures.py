"""Error against computing time: a picture for each problem, a panel for each question asked of it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from rockwobble.reports.figures.palette import DARK, GREY, Style, mark_styles
from rockwobble.reports.figures.picture import Axis, Line, Panel, Picture, Rule, bar_ends
from rockwobble.reports.published.tradeoff.points import Tradeoff
from rockwobble.reports.published.tradeoff.problem import PIER, RECESS

TITLES = {
    "turn": "Azimuth change in free response",
    "shaken": "Tilt under 2 × El Centro",
    "peaks": "Distribution of peak tilt",
}
ERRORS = {
    "turn": ("error of azimuth change", "deg"),
    "shaken": ("error of tilt", "α"),
    "peaks": ("distance", "α"),
}
# support and panel, in the order of the picture
_PANELS: Mapping[tuple[str, str], str] = {
    (RECESS, "methods"): "ideal recess",
    ("flat", "methods"): "flat ground",
    ("ring", "methods"): "recess with clearance",
    (RECESS, "scipy"): "scipy's solvers, recess",
    (RECESS, "rest threshold"): "rest threshold, recess",
    (RECESS, "integrator"): "integrators, recess",
    (RECESS, "contact"): "time constant of contact, recess",
}
# of the trace, which the table has whole, what the model and the engines cost, and what other solvers do
_SHOWN = {"shaken": ((RECESS, "methods"), ("flat", "methods"), (RECESS, "scipy"))}
_BASE = "recess model"
_OF_MODEL, _OF_ENGINES = ("scipy", "rest threshold"), ("integrator", "contact")  # panels of variants


def pictures(results: Tradeoff) -> list[Picture]:
    """Picture of each problem; its panels share their axes."""
    return [_picture(results, name) for name in TITLES if (results.points["problem"] == name).any()]


def _picture(results: Tradeoff, problem: str) -> Picture:
    points = results.points[(results.points["problem"] == problem) & (results.points["error"] > 0.0)]
    time = _axis("computing time / recess model's", "-", points["ratio"])
    error = _axis(*ERRORS[problem], points["error"])
    panels = []
    for (support, name), title in _PANELS.items():
        chosen = points[(points["support"] == support) & (points["panel"] == name)]
        if chosen.empty or (support, name) not in _SHOWN.get(problem, _PANELS):
            continue
        plain = [_BASE] if name in _OF_MODEL else []  # baseline of the variants
        plain += [f"{engine} {support}" for engine in chosen["family"].unique() if name in _OF_ENGINES]
        chosen = pd.concat([points[points["line"].isin(plain)], chosen])
        described = results.problems[
            (results.problems["problem"] == problem) & (results.problems["support"] == support)
        ].iloc[0]
        layers: list[Line | Rule] = list(_lines(chosen))
        if np.isfinite(described["chance"]):
            layers.append(
                Rule(at=float(described["chance"]), axis="y", dash="dot", colour=GREY, name="chance")
            )
        panels.append(Panel(x=time, y=error, layers=layers, title=title))
    return Picture(
        name=f"tradeoff-{problem}",
        title=f"{TITLES[problem]}, R = {PIER.semidiagonal:g} m, tan α = {PIER.tan_alpha:g}",
        caption="Lower left is better. Along a line only the tolerance or the time step changes, from coarse "
        "on the left to fine on the right; bars: quartiles of the times. A recess with clearance is compared "
        "with itself at half the finest step."
        + (
            " Below “chance” another set of motions changes the distribution more than the method does."
            if problem == "peaks"
            else ""
        ),
        panels=panels,
        columns=2,
        legend="panels",
    )


def _lines(points: pd.DataFrame) -> list[Line]:
    layers = []
    styles = mark_styles(list(points["line"].unique()))
    for name, line in points.groupby("line", sort=False):
        ordered = line.sort_values("value", ascending=False)
        style = styles[str(name)]
        colour = DARK if name == _BASE else style.colour
        x, y = ordered["ratio"].to_numpy(float), ordered["error"].to_numpy(float)
        notes = [
            f"{row['knob']} {row['value']:g}: {row['milliseconds']:.3g} ms {row['said']}".strip()
            for _, row in ordered.iterrows()
        ]
        layers.append(
            Line(x=x, y=y, name=str(name), style=Style(colour=colour, symbol=style.symbol), notes=notes)
        )
        bars = bar_ends(*(ordered[f"ratio_{end}"].to_numpy(float) for end in ("low", "high")))
        layers.append(Line(x=bars, y=np.repeat(y, 3), style=Style(colour=colour), width=0.8))
    return layers


def _axis(label: str, unit: str, values: pd.Series[float]) -> Axis:
    """Logarithmic axis over whole decades, common to all panels."""
    if values.empty:
        return Axis(label=label, unit=unit, log=True)
    low, high = np.log10(values.min()) - 0.05, np.log10(values.max()) + 0.05
    ends = float(10.0 ** np.floor(low)), float(10.0 ** np.ceil(high))
    return Axis(label=label, unit=unit, log=True, low=ends[0], high=ends[1])
