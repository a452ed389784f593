"""Figures of the report on the limits: the engine's runs, and maps over release, spin, size and intensity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.statistics import FEWEST as FEWEST_OF_A_QUANTILE
from rockwobble.models.support import FLAT, RECESS, RECESSES_FIRST, RING, SUPPORTS
from rockwobble.studies.validity.limits import (
    CONFIRMS,
    CONTRASTS,
    FEWEST,
    POINT,
    Tables,
    cells,
    column,
    contrasts,
    model_difference,
)
from rockwobble.studies.validity.measurements import FREE, INTENSITY, PERTURBED, STRONG
from rockwobble.studies.validity.study import Validity

from .heat import Gap, Heat, Shades, contour, names
from .palette import DARK, GREY, ORDER, PALE, Style, mark_styles
from .picture import Array, Axis, Layer, Line, Panel, Picture, Rule, bar_ends, caption, group_lines, list_axis

_FREE_PANELS = 4
_FAR = 1e3  # stands for infinity: beyond every scale
_STILL, _FEW = "no record uplifts it", "too few records left standing"
_MODERATE = 2.0  # friction over tan(alpha): twice that of uplift
# column of the cells, level, name of the line where it is reached, style
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


_RATIO_90 = Shades(label="90th percentile of the ratio", unit="-", low=1.0, high=10.0, log=True)
# name, fewest records of a cell that is not gray, column of the cells, shades
_MAPS = (
    (
        "bias",
        FEWEST_OF_A_QUANTILE,
        "flat_percent",
        Shades(label="flat ground / recess − 1, median", unit="%", low=-50.0, high=50.0, centre=0.0),
    ),
    (
        "spread",
        1,
        "flat_90",
        _RATIO_90,
    ),
    (
        "sensitivity",
        1,
        "copy_90",
        _RATIO_90,
    ),
    (
        "need-friction",
        FEWEST,
        "friction_90",
        Shades(label="friction demand / tan α", unit="-", low=1.0, high=3.0),
    ),
    (
        "need-contact",
        FEWEST,
        "normal_10",
        Shades(label="normal force / weight", unit="-", low=0.0, high=1.0, reverse=True),
    ),
    (
        "need-moment",
        FEWEST,
        "moment_90",
        Shades(label="κ / (weight × b)", unit="-", low=0.01, high=1.0, log=True),
    ),
)


def map_pictures(tables: Tables) -> list[Picture]:
    """Return the maps in which anything is known: of peaks over records, of needs, and of free response."""
    table, free = cells(tables), tables["free_response"]
    table = table.assign(flat_percent=100.0 * (table["flat_ratio"] - 1.0))
    found = [_shaken(table, *given) for given in _MAPS if table[given[2]].notna().any()]
    two = free["flat_turn"].notna().any()  # models of free response, which are compared
    for name, what in (("turn", "Azimuth change"), ("period", "Period")) if two else ():
        off = 100.0 * (free[f"flat_{name}"] / free[name] - 1.0)
        found.append(_free(f"free-{name}", what, free.assign(off=off)))
    return found


def _shaken(table: pd.DataFrame, name: str, fewest: int, column: str, shades: Shades) -> Picture:
    panels = []
    for tan_alpha, own in table.groupby("tan_alpha"):
        (x, x_ticks), (y, y_ticks) = (
            names(sorted(own[axis].unique())) for axis in ("semidiagonal", "intensity")
        )
        values, still = _grid(own, column), _grid(own, "rocked") == 0.0
        gaps = [
            Gap(name=_FEW, colour=GREY, cells=np.isnan(values) & ~still),
            Gap(name=_STILL, colour=PALE, cells=still),
        ]
        layers: list[Heat | Line] = [Heat(x=x, y=y, values=values, gaps=gaps)]
        for other, level, words, style in _LINES:
            line = contour(x, y, _grid(own, other), level)
            if len(line[0]):
                layers.append(Line(x=line[0], y=line[1], name=words, style=style))
        panels.append(
            Panel(
                x=Axis(label="R", unit="m", ticks=x_ticks),
                y=Axis(label="peak / (g tan α)", unit="-", ticks=y_ticks),
                layers=layers,
                title=f"tan α = {float(str(tan_alpha)):g}",
                height=2.4,
            )
        )
    return Picture(
        name=name,
        caption=caption(name.replace("-", "_"), count=int(table["members"].max()), count_fewest=fewest),
        panels=panels,
        columns=len(panels) if len(panels) < 4 else 2,
        shades=shades,
    )


def _grid(table: pd.DataFrame, value: str) -> Array:
    # one row a cell: an aggregation would take most of the time of the page
    grid = table.pivot(index="intensity", columns="semidiagonal", values=value)  # noqa: PD010
    found = grid.to_numpy(dtype=np.float64)
    return np.where(np.isposinf(found), _FAR, found)  # a colour and a contour need a number


def _free(name: str, what: str, table: pd.DataFrame) -> Picture:
    every = np.unique(table["tan_alpha"])
    chosen = every[np.unique(np.linspace(0, len(every) - 1, _FREE_PANELS).round().astype(int))]
    panels = []
    for tan_alpha in chosen:
        own = table[table["tan_alpha"] == tan_alpha]
        (x, x_ticks), (y, y_ticks) = (names(sorted(own[axis].unique())) for axis in ("spin", "release"))
        grid = own.pivot(index="release", columns="spin", values="off")  # noqa: PD010 - one row a cell here, too
        values = grid.to_numpy(dtype=np.float64)
        overturned = Gap(name="overturns on flat ground", colour=GREY, cells=np.isnan(values))
        panels.append(
            Panel(
                x=Axis(label="rolling rate / that of steady wobble", unit="-", ticks=x_ticks),
                y=Axis(label="release / α", unit="-", ticks=y_ticks),
                layers=[Heat(x=x, y=y, values=values, gaps=[overturned])],
                title=f"tan α = {tan_alpha:g}",
            )
        )
    reach = float(f"{max(float(np.nanquantile(table['off'].abs(), 0.99)), 1e-3):.0e}")
    return Picture(
        name=name,
        caption=caption("free", name=what),
        panels=panels,
        columns=2,
        shades=Shades(label="flat ground / recess − 1", unit="%", low=-reach, high=reach, centre=0.0),
    )


# methods in words
METHODS: Mapping[str, str] = {
    RECESS.model: RECESS.model,
    **{support: f"engine, {support.words}" for support in RECESSES_FIRST},
    FLAT.model: FLAT.model,
    PERTURBED: f"{RECESS.model}, record 1 % stronger",
}
_STYLES: Mapping[str, Style] = {
    RECESS: Style(colour=ORDER[0]),
    RING: Style(colour=ORDER[1], dash="dashdot"),
    FLAT: Style(colour=ORDER[4], dash="dash"),
    FLAT.model: Style(colour=GREY, dash="dash"),
    PERTURBED: Style(colour=DARK, dash="dot"),
}
_OTHER_STYLE = Style(colour=ORDER[3])
_MEDIANS: Mapping[str, str] = {
    RECESS: "circle",
    RING: "square",
    FLAT: "triangle-up",
    FLAT.model: "triangle-down",
    PERTURBED: "diamond",
}
_OTHER_MEDIAN = "cross"
_APART = 0.16  # rows of one point
_RATIO_ENDS = (0.2, 5.0)  # a ratio beyond is drawn at the end
_LEAST = 1e-9  # stands for zero on a logarithmic axis
_PEAK_RATIO = "peak / recess model's peak"
_ONE = Rule(at=1.0, axis="y", colour=GREY, dash="solid")


def pictures(results: Validity) -> list[Picture]:
    """Return all figures of the report, in its order."""
    tables, uplift = results.tables, results.structure.uplift
    return [
        _records(contrasts(tables)),
        *map_pictures(tables),
        _agreement(tables["following"]),
        # a tendon leaves one model, so there is no second to tell apart
        *([] if results.structure.tendon else [_verification(tables["verification"])]),
        # a slab has no ring, and its base is not what slips first
        *(
            []
            if results.structure.slab_mass_ratio
            else [_slip(tables["slip"]), _rings(tables["rings"], uplift)]
        ),
        _contact(tables["contact"], uplift),
    ]


def _records(table: pd.DataFrame) -> Picture:
    low, high = _RATIO_ENDS
    ticks = [(value, f"{value:g}") for value in (0.2, 0.5, 1.0, 2.0, 5.0)]
    ratio = Axis(label=_PEAK_RATIO, unit="-", log=True, low=low, high=high, ticks=ticks)
    methods = [method for method, against in CONTRASTS if against == RECESS.model]
    panels = []
    for tan_alpha, points in table[table["against"] == RECESS.model].groupby("tan_alpha", sort=False):
        names: list[str] = []
        layers: list[Line | Rule] = [Rule(at=1.0, axis="x", colour=GREY, dash="solid")]
        for place, (_, rows) in enumerate(points.groupby(POINT, sort=False)):
            first = rows.iloc[0]
            names.append(f"R = {first['semidiagonal']:g} m,\n{first['intensity']:g} g tan α")
            for row in rows.to_dict("records"):
                method = row["method"]
                y = place + _APART * (methods.index(method) - 0.5 * (len(methods) - 1))
                spread = np.clip([row[name] for name in ("ratio_05", "ratio", "ratio_95")], *_RATIO_ENDS)
                colour = _STYLES.get(method, _OTHER_STYLE).colour
                layers.append(Line(x=spread[::2], y=np.full(2, y), style=Style(colour=colour), width=1.6))
                mark = Style(colour=colour, dash="none", symbol=_MEDIANS.get(method, _OTHER_MEDIAN))
                layers.append(Line(x=spread[1:2], y=np.array([y]), name=METHODS[method], style=mark))
        title, height = f"tan α = {float(str(tan_alpha)):g}", 0.9 + 0.75 * len(names)
        y_axis = list_axis(names)
        panels.append(Panel(x=ratio, y=y_axis, layers=layers, title=title, height=height))
    return Picture(
        name="records",
        caption=caption("records"),
        panels=panels,
        columns=min(2, len(panels)),
    )


def _agreement(table: pd.DataFrame) -> Picture:
    end = float(table["duration"].max())
    predicted = Axis(label="predicted agreement time", unit="s", low=0.0, high=1.03 * end)
    measured = Axis(label="agreement time", unit="s", low=0.0, high=1.03 * end)
    groups = {
        f"{support}, {reference} model": rows
        for (support, reference), rows in table.groupby(["support", "reference_support"], sort=False)
    }
    layers = [
        Line(x=np.array([0.0, end]), y=np.array([0.0, end]), name="as predicted", width=0.8),
        *group_lines(groups, "predicted_agreement_time", "agreement_time", lines=False, filled="diverged"),
    ]
    return Picture(
        name="agreement",
        caption=caption("agreement"),
        panels=[Panel(x=predicted, y=measured, layers=layers, height=3.2)],
    )


def _verification(table: pd.DataFrame) -> Picture:
    off = np.degrees((table["engine_turn"] - table["turn"]).abs())
    table = table.assign(apart=np.degrees(model_difference(table)), off=np.maximum(off, _LEAST))
    groups = {f"engine, {name}": rows for name, rows in table.groupby("support", sort=False)}
    layers = group_lines(groups, "apart", "off", lines=False, filled="resolved")
    ends = table["apart"].agg(["min", "max"]).to_numpy(dtype=np.float64)
    layers.append(Line(x=ends, y=CONFIRMS * ends, name="half of the difference", width=0.8))
    return Picture(
        name="verification",
        caption=caption("verification", reason=None if table["resolved"].all() else "open_marks"),
        panels=[
            Panel(
                x=Axis(label="recess − flat model", unit="deg", log=True),
                y=Axis(label="engine − model of its support", unit="deg", log=True),
                layers=layers,
                height=3.2,
            )
        ],
    )


def _slip(table: pd.DataFrame) -> Picture:
    table = table.assign(shown=np.maximum(table["slip"], _LEAST))
    groups = {
        f"tan α = {tan_alpha:g}, demand {rows['needed'].iloc[0] / rows['tan_alpha'].iloc[0]:.2f} tan α": rows
        for tan_alpha, rows in table.sort_values("share").groupby("tan_alpha")
    }
    layers: list[Layer] = [
        Rule(at=1.0, axis="x", colour=GREY, dash="solid"),
        *group_lines(groups, "share", "shown"),
    ]
    return Picture(
        name="slip",
        caption=caption("slip"),
        panels=[
            Panel(
                x=Axis(label="friction / friction demand", unit="-"),
                y=Axis(label="slip / b", unit="-", log=True),
                layers=layers,
            )
        ],
    )


def _rings(table: pd.DataFrame, uplift: float) -> Picture:
    # walls of another inclination or friction are in the table, and would be too many lines here
    plain = table[has_walls(table) & (table["inclination"] == 0.0)]
    default = plain["friction"].mode().iloc[0] if len(plain) else 0.0
    plain = plain[plain["friction"] == default]
    plain = plain.assign(ratio=plain["peak"] / plain["recess_peak"])
    styles = mark_styles([f"tan α = {tan_alpha:g}" for tan_alpha in sorted(plain["tan_alpha"].unique())])

    def lines(column_name: str, chosen: pd.DataFrame, least: float) -> Iterator[Line]:
        for tan_alpha, rows in chosen.groupby("tan_alpha"):
            name = f"tan α = {tan_alpha:g}"
            over = rows.groupby("clearance")[column_name]
            low, high = (np.maximum(end.to_numpy(float), least) for end in (over.min(), over.max()))
            x, bars = over.min().index.to_numpy(float), Style(colour=styles[name].colour)
            yield Line(x=x, y=np.sqrt(low * high), name=name, style=styles[name])
            yield Line(x=np.repeat(x, 3), y=bar_ends(low, high), style=bars, width=0.8)

    clearance = Axis(label="clearance / b", unit="-", log=True)
    shaken, touched = plain[plain["motion"] != FREE], plain[plain["contact_time"] > 0.0]
    return Picture(
        name="rings",
        caption=caption("rings", intensity=INTENSITY * uplift),
        panels=[
            Panel(
                x=clearance,
                y=Axis(label=_PEAK_RATIO, unit="-"),
                layers=[_ONE, *lines("ratio", shaken, 1e-3)],
                title="peak tilt",
            ),
            Panel(
                x=clearance,
                y=Axis(label="roll-out / b", unit="-", log=True),
                layers=list(lines("rolled_out", shaken, 1e-6)),
                title="roll-out",
            ),
            Panel(
                x=clearance,
                y=Axis(label="energy lost / largest energy", unit="-", log=True),
                layers=list(lines("loss", touched, 1e-6)),
                title="energy lost",
            ),
        ],
        columns=2,
    )


def has_walls(table: pd.DataFrame) -> pd.Series[bool]:
    """Mask of the runs whose support has walls."""
    return table["support"].map(lambda name: SUPPORTS[name].walls)


def _contact(table: pd.DataFrame, uplift: float) -> Picture:
    failed = (table["free_outcome"] == "failed") | (table["outcome"] == "failed")
    known = table[~failed].sort_values("softness")
    known = known.assign(ratio=known["peak"] / known["recess_peak"], lost=np.maximum(known["loss"], 1e-6))
    groups = {f"damping ratio {damping:g}": rows for damping, rows in known.groupby("damping")}
    softness = Axis(label="contact time constant × p", unit="-", log=True)
    lost: Array = column(table[failed], "softness")
    low = float(known["ratio"].min()) if len(known) else 1.0
    cross = Style(colour=DARK, dash="none", symbol="x")
    crosses = [Line(x=lost, y=np.full(len(lost), low), name="failed", style=cross)] if len(lost) else []
    return Picture(
        name="contact",
        caption=caption("contact", intensity=STRONG * uplift),
        panels=[
            Panel(
                x=softness,
                y=Axis(label=_PEAK_RATIO, unit="-"),
                layers=[_ONE, *group_lines(groups, "softness", "ratio", lines=False), *crosses],
            ),
            Panel(
                x=softness,
                y=Axis(label="energy lost in a pass", unit="-", log=True),
                layers=group_lines(groups, "softness", "lost", lines=False),
            ),
        ],
        columns=2,
    )
