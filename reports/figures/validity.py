"""Figures of the validity report: engine runs, and maps over release, spin, size and intensity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.statistics import FEWEST as FEWEST_OF_A_QUANTILE
from rockwobble.models.finding import Finding, Value
from rockwobble.models.support import FLAT, RECESS, RECESSES_FIRST, RING
from rockwobble.studies.validity.limits import (
    CONFIRMS,
    CONTRASTS,
    FEWEST,
    POINT,
    Tables,
    cells,
    contrasts,
    has_walls,
    model_difference,
    soft_contacts,
)
from rockwobble.studies.validity.measurements import INTENSITY, STRONG
from rockwobble.studies.validity.plan import FREE, PERTURBED
from rockwobble.studies.validity.study import Validity

from .heat import Gap, Heat, Shades, contour, names
from .palette import DARK, GREY, ORDER, PALE, Style, mark_styles
from .picture import Array, Axis, Layer, Line, Panel, Picture, Rule, bar_ends, caption, group_lines, list_axis

_FREE_PANELS = 4
_FAR = 1e3  # stands for infinity: beyond every scale, as a colour and a contour need a number
_MODERATE = 2.0  # friction over tan(alpha), twice that of uplift
# column of the cells, level, line where it is reached
_LINES = (
    ("overturned", 0.1, "1 in 10 records overturns", Style(colour=DARK, dash="dash")),
    ("overturned", 0.5, "1 in 2 records overturns", Style(colour=DARK)),
    (
        "friction_90",
        _MODERATE,
        f"1 in 10 needs friction above {_MODERATE:g} tan α",
        Style(colour=ORDER[1], dash="dot"),
    ),
    ("lost", 0.1, "1 in 10 loses contact", Style(colour=ORDER[4], dash="dashdot")),
)
# column of flags, name and colour of the cells without a value
_GAPS = (("few", "too few records left standing", GREY), ("still", "no record uplifts it", PALE))
_FALLS = (("falls", "overturns on flat ground", GREY),)
# columns over which a map is drawn, with label and unit
_SHAKEN = {"semidiagonal": ("R", "m"), "intensity": ("peak / (g tan α)", "-")}
_RELEASED = {"spin": ("rolling rate / that of steady wobble", "-"), "release": ("release / α", "-")}


def _percent(label: str, reach: float) -> Shades:
    return Shades(label=label, unit="%", low=-reach, high=reach, centre=0.0)


_RATIO_90 = Shades(label="90th percentile of the ratio", unit="-", low=1.0, high=10.0, log=True)
_FRICTION = Shades(label="friction demand / tan α", unit="-", low=1.0, high=3.0)
_NORMAL = Shades(label="normal force / weight", unit="-", low=0.0, high=1.0, reverse=True)
_MOMENT = Shades(label="κ / (weight × b)", unit="-", low=0.01, high=1.0, log=True)
# name: fewest records of a cell that is not gray, column of the cells, shades
_MAPS = {
    "bias": (FEWEST_OF_A_QUANTILE, "flat_percent", _percent("flat ground / recess − 1, median", 50.0)),
    "spread": (1, "flat_90", _RATIO_90),
    "sensitivity": (1, "copy_90", _RATIO_90),
    "need-friction": (FEWEST, "friction_90", _FRICTION),
    "need-contact": (FEWEST, "normal_10", _NORMAL),
    "need-moment": (FEWEST, "moment_90", _MOMENT),
}


def map_pictures(tables: Tables) -> list[Picture]:
    """Maps with any known value: peaks over records, requirements, and free response."""
    table, free = cells(tables), tables["free_response"]
    still = table["rocked"] == 0
    table = table.assign(flat_percent=100.0 * (table["flat_ratio"] - 1.0), still=still)
    members, drawn = int(table["members"].max()), []
    for name, (fewest, column, shades) in _MAPS.items():
        if table[column].notna().any():
            known = table.assign(few=table[column].isna() & ~still)
            words = caption(name.replace("-", "_"), count=members, count_fewest=fewest)
            panels = _panels(known, _SHAKEN, column, _GAPS, _LINES, height=2.4)
            drawn.append(_maps(name, words, panels, shades))
    if free["flat_turn"].isna().all():  # one model only, without comparison
        return drawn
    every = np.unique(free["tan_alpha"])
    chosen = every[np.unique(np.linspace(0, len(every) - 1, _FREE_PANELS).round().astype(int))]
    for name, what in (("turn", "Azimuth change"), ("period", "Period")):
        off = 100.0 * (free[f"flat_{name}"] / free[name] - 1.0)
        reach = float(f"{max(float(np.nanquantile(off.abs(), 0.99)), 1e-3):.0e}")
        known = free.assign(off=off, falls=off.isna())[free["tan_alpha"].isin(chosen)]
        panels = _panels(known, _RELEASED, "off", _FALLS)
        shades = _percent("flat ground / recess − 1", reach)
        drawn.append(_maps(f"free-{name}", caption("free", name=what), panels, shades))
    return drawn


def _maps(name: str, words: Finding, panels: Sequence[Panel], shades: Shades) -> Picture:
    columns = len(panels) if len(panels) < 4 else 2
    return Picture(name=name, caption=words, panels=panels, columns=columns, shades=shades)


def _panels(
    table: pd.DataFrame,
    axes: Mapping[str, tuple[str, str]],
    value: str,
    gaps: Sequence[tuple[str, str, str]],
    lines: Sequence[tuple[str, float, str, Style]] = (),
    height: float = 2.6,
) -> list[Panel]:
    """Map of a column for each slenderness, with contours of other columns."""
    panels = []
    for tan_alpha, rows in table.groupby("tan_alpha"):
        (x, x_ticks), (y, y_ticks) = (names(sorted(rows[axis].unique())) for axis in axes)
        across, up = axes
        # one row per cell: an aggregation would take most of the page's time
        grid = rows.pivot(index=up, columns=across)  # noqa: PD010

        def cells_of(name: str, grid: pd.DataFrame = grid) -> Array:
            values = grid[name].to_numpy(dtype=np.float64)
            return np.where(np.isposinf(values), _FAR, values)

        empty = [Gap(name=words, colour=colour, cells=cells_of(name) > 0.0) for name, words, colour in gaps]
        layers: list[Layer] = [Heat(x=x, y=y, values=cells_of(value), gaps=empty)]
        for name, level, words, style in lines:
            at = contour(x, y, cells_of(name), level)
            if len(at[0]):
                layers.append(Line(x=at[0], y=at[1], name=words, style=style))
        (x_label, x_unit), (y_label, y_unit) = axes.values()
        panels.append(
            Panel(
                x=Axis(label=x_label, unit=x_unit, ticks=x_ticks),
                y=Axis(label=y_label, unit=y_unit, ticks=y_ticks),
                layers=layers,
                title=f"tan α = {float(str(tan_alpha)):g}",
                height=height,
            )
        )
    return panels


# methods in words
METHODS: Mapping[str, str] = {
    **{support: f"engine, {support.words}" for support in RECESSES_FIRST},
    FLAT.model: FLAT.model,
    PERTURBED: f"{RECESS.model}, record 1 % stronger",
}
# colour, and symbol of the median
_MARKS: Mapping[str, tuple[str, str]] = {
    RECESS: (ORDER[0], "circle"),
    RING: (ORDER[1], "square"),
    FLAT: (ORDER[4], "triangle-up"),
    FLAT.model: (GREY, "triangle-down"),
    PERTURBED: (DARK, "diamond"),
}
_OTHER_MARK = ORDER[3], "cross"
_APART = 0.16  # rows of one point
_RATIO_ENDS = (0.2, 5.0)  # a ratio beyond is drawn at the end
_LEAST = 1e-9  # stands for zero on a logarithmic axis
_PEAK_RATIO = Axis(label="peak / recess model's peak", unit="-")
_ONE = Rule(at=1.0, axis="y", colour=GREY, dash="solid")
_SAME = Rule(at=1.0, axis="x", colour=GREY, dash="solid")


def pictures(results: Validity) -> list[Picture]:
    """All figures of the report, in its order."""
    tables, uplift = results.tables, results.structure.uplift
    drawn = [_records(contrasts(tables)), *map_pictures(tables), _agreement(tables["following"])]
    # one model with a tendon, so no second one to distinguish
    if not results.structure.tendon:
        drawn.append(_verification(tables["verification"]))
    # no ring under a slab, and no base that slips first
    if not results.structure.slab_mass_ratio:
        drawn += [_slip(tables["slip"]), _rings(tables["rings"], uplift)]
    return [*drawn, _contact(tables, uplift)]


def _picture(name: str, *panels: Panel, columns: int = 1, **values: Value) -> Picture:
    return Picture(name=name, caption=caption(name, **values), panels=panels, columns=columns)


def _records(table: pd.DataFrame) -> Picture:
    low, high = _RATIO_ENDS
    ticks = [(value, f"{value:g}") for value in (0.2, 0.5, 1.0, 2.0, 5.0)]
    ratio = replace(_PEAK_RATIO, log=True, low=low, high=high, ticks=ticks)
    methods = [method for method, against in CONTRASTS if against == RECESS.model]
    panels = []
    for tan_alpha, points in table[table["against"] == RECESS.model].groupby("tan_alpha", sort=False):
        labels: list[str] = []
        layers: list[Layer] = [_SAME]
        for place, ((_, size, intensity), rows) in enumerate(points.groupby(POINT, sort=False)):
            labels.append(f"R = {size:g} m,\n{intensity:g} g tan α")
            for row in rows.to_dict("records"):
                method = row["method"]
                y = np.full(2, place + _APART * (methods.index(method) - 0.5 * (len(methods) - 1)))
                spread = np.clip([row[name] for name in ("ratio_05", "ratio", "ratio_95")], *_RATIO_ENDS)
                colour, symbol = _MARKS.get(method, _OTHER_MARK)
                layers.append(Line(x=spread[::2], y=y, style=Style(colour=colour), width=1.6))
                mark = Style(colour=colour, dash="none", symbol=symbol)
                layers.append(Line(x=spread[1:2], y=y[:1], name=METHODS[method], style=mark))
        title, height = f"tan α = {float(str(tan_alpha)):g}", 0.9 + 0.75 * len(labels)
        panels.append(Panel(x=ratio, y=list_axis(labels), layers=layers, title=title, height=height))
    return _picture("records", *panels, columns=min(2, len(panels)))


def _agreement(table: pd.DataFrame) -> Picture:
    end = float(table["duration"].max())
    time = Axis(label="agreement time", unit="s", low=0.0, high=1.03 * end)
    groups = {
        f"{support}, {reference} model": rows
        for (support, reference), rows in table.groupby(["support", "reference_support"], sort=False)
    }
    layers = [
        Line(x=np.array([0.0, end]), y=np.array([0.0, end]), name="as predicted", width=0.8),
        *group_lines(groups, "predicted_agreement_time", "agreement_time", lines=False, filled="diverged"),
    ]
    predicted = replace(time, label="predicted agreement time")
    return _picture("agreement", Panel(x=predicted, y=time, layers=layers, height=3.2))


def _verification(table: pd.DataFrame) -> Picture:
    off = np.degrees((table["engine_turn"] - table["turn"]).abs())
    table = table.assign(apart=np.degrees(model_difference(table)), off=np.maximum(off, _LEAST))
    groups = {f"engine, {name}": rows for name, rows in table.groupby("support", sort=False)}
    layers = group_lines(groups, "apart", "off", lines=False, filled="resolved")
    ends = table["apart"].agg(["min", "max"]).to_numpy(dtype=np.float64)
    layers.append(Line(x=ends, y=CONFIRMS * ends, name="half of the difference", width=0.8))
    x = Axis(label="recess − flat model", unit="deg", log=True)
    y = Axis(label="engine − model of its support", unit="deg", log=True)
    reason = None if table["resolved"].all() else "open_marks"
    return _picture("verification", Panel(x=x, y=y, layers=layers, height=3.2), reason=reason)


def _slip(table: pd.DataFrame) -> Picture:
    table = table.assign(shown=np.maximum(table["slip"], _LEAST))
    groups = {
        f"tan α = {tan_alpha:g}, demand {rows['needed'].iloc[0] / rows['tan_alpha'].iloc[0]:.2f} tan α": rows
        for tan_alpha, rows in table.sort_values("share").groupby("tan_alpha")
    }
    x, y = Axis(label="friction / friction demand", unit="-"), Axis(label="slip / b", unit="-", log=True)
    return _picture("slip", Panel(x=x, y=y, layers=[_SAME, *group_lines(groups, "share", "shown")]))


def _rings(table: pd.DataFrame, uplift: float) -> Picture:
    # other wall inclinations and frictions only in the table, as too many lines
    plain = table[has_walls(table) & (table["inclination"] == 0.0)]
    plain = plain[plain["friction"].isin(plain["friction"].mode()[:1])]
    plain = plain.assign(ratio=plain["peak"] / plain["recess_peak"])
    styles = mark_styles([f"tan α = {tan_alpha:g}" for tan_alpha in sorted(plain["tan_alpha"].unique())])

    def lines(column: str, chosen: pd.DataFrame, least: float) -> Iterator[Line]:
        for tan_alpha, rows in chosen.groupby("tan_alpha"):
            name = f"tan α = {tan_alpha:g}"
            ends = rows.groupby("clearance")[column].agg(["min", "max"]).clip(lower=least)
            x, low, high = (each.to_numpy(float) for each in (ends.index, ends["min"], ends["max"]))
            yield Line(x=x, y=np.sqrt(low * high), name=name, style=styles[name])
            bars = Style(colour=styles[name].colour)
            yield Line(x=np.repeat(x, 3), y=bar_ends(low, high), style=bars, width=0.8)

    shaken, touched = plain[plain["motion"] != FREE], plain[plain["contact_time"] > 0.0]
    out = Axis(label="roll-out / b", unit="-", log=True)
    lost = Axis(label="energy lost / largest energy", unit="-", log=True)
    panels: Sequence[tuple[str, Axis, list[Layer]]] = (
        ("peak tilt", _PEAK_RATIO, [_ONE, *lines("ratio", shaken, 1e-3)]),
        ("roll-out", out, [*lines("rolled_out", shaken, 1e-6)]),
        ("energy lost", lost, [*lines("loss", touched, 1e-6)]),
    )
    clearance = Axis(label="clearance / b", unit="-", log=True)
    drawn = (Panel(x=clearance, y=y, layers=layers, title=title) for title, y, layers in panels)
    return _picture("rings", *drawn, columns=2, intensity=INTENSITY * uplift)


def _contact(tables: Tables, uplift: float) -> Picture:
    table = soft_contacts(tables)
    known, failed = (table[table["failed"] == each].sort_values("softness") for each in (False, True))
    known = known.assign(lost=np.maximum(known["loss"], 1e-6))
    groups = {f"damping ratio {damping:g}": rows for damping, rows in known.groupby("damping")}
    low = float(known["ratio"].min()) if len(known) else 1.0
    cross, at = Style(colour=DARK, dash="none", symbol="x"), failed["softness"].to_numpy(float)
    crosses = [Line(x=at, y=np.full(len(at), low), name="failed", style=cross)] if len(at) else []
    softness = Axis(label="contact time constant × p", unit="-", log=True)
    peaks: list[Layer] = [_ONE, *group_lines(groups, "softness", "ratio", lines=False), *crosses]
    losses = group_lines(groups, "softness", "lost", lines=False)
    lost = Axis(label="energy lost in a pass", unit="-", log=True)
    return _picture(
        "contact",
        Panel(x=softness, y=_PEAK_RATIO, layers=peaks),
        Panel(x=softness, y=lost, layers=losses),
        columns=2,
        intensity=STRONG * uplift,
    )
