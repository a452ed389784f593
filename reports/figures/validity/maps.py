"""The maps of the report on the limits: over release and spin, and over size and intensity."""

from __future__ import annotations

import numpy as np
import pandas as pd

from rockwobble.compare.studies.validity.limits import FEWEST, Tables, cells

from ..heat import Gap, Heat, Shades, contour, names
from ..palette import DARK, GREY, ORDER, PALE, Style
from ..picture import Array, Axis, Line, Panel, Picture

_FREE_PANELS = 4
_FAR = 1e3  # what infinite is drawn as: beyond every scale
_STILL, _FEW = "no record uplifts it", f"fewer than {FEWEST} records left standing"
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


# name, title, caption, column of the cells, shades
_MAPS = (
    (
        "bias",
        "Where rolling out changes the peak: bias",
        "Median over the records of the peak on flat ground over that in an ideal recess, both of the "
        "reduced models: red, higher on flat ground; blue, lower.",
        "flat_percent",
        Shades(label="flat over recess, median", unit="%", low=-50.0, high=50.0, centre=0.0),
    ),
    (
        "spread",
        "Where rolling out changes the peak: spread",
        "The factor by which nine in ten records differ at most, to either side, on flat ground; darkest: 10 "
        "and more, or it overturns in one of the two alone.",
        "flat_90",
        Shades(label="factor of nine in ten", unit="-", low=1.0, high=10.0, log=True),
    ),
    (
        "sensitivity",
        "What sensitivity alone does",
        "The same of the recess model against itself under a record 1 % stronger: where it is no less, "
        "neither model can be asked for the peak of one record.",
        "copy_90",
        Shades(label="factor of nine in ten", unit="-", low=1.0, high=10.0, log=True),
    ),
    (
        "need-friction",
        "Friction that the recess model needs",
        "Friction that nine in ten of the records that rock without overturning need at most.",
        "friction_90",
        Shades(label="friction / tan α", unit="-", low=1.0, high=10.0, log=True),
    ),
    (
        "need-contact",
        "Least normal force",
        "Normal force that nine in ten of the records that rock without overturning keep at least; below "
        "zero the ground would have to pull.",
        "normal_10",
        Shades(label="normal force / weight", unit="-", low=-1.0, high=1.0, centre=0.0),
    ),
    (
        "need-moment",
        "Moment that the recess must supply",
        "κ of the restraining moment κ (vertical + axis) that nine in ten of the records that rock without "
        "overturning need at most.",
        "moment_90",
        Shades(label="κ / (weight × b)", unit="-", low=0.01, high=1.0, log=True),
    ),
)


def map_pictures(tables: Tables) -> list[Picture]:
    """Return the maps: of peaks over records, of what a recess must supply, and of free response."""
    table, free = cells(tables), tables["free_response"]
    table = table.assign(flat_percent=100.0 * (table["flat_ratio"] - 1.0))
    found = [_shaken(table, *given) for given in _MAPS]
    for name, what in (("turn", "Angle of turn"), ("period", "Period")):
        off = 100.0 * (free[f"flat_{name}"] / free[name] - 1.0)
        found.append(_free(f"free-{name}", what, free.assign(off=off)))
    return found


def _shaken(table: pd.DataFrame, name: str, title: str, caption: str, column: str, shades: Shades) -> Picture:
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
        title=title,
        caption=f"{caption} Each cell: {int(table['members'].max())} records.",
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
    reach = max(float(np.nanquantile(table["off"].abs(), 0.99)), 1e-3)
    return Picture(
        name=name,
        title=f"{what} from tilt maximum to next maximum",
        caption="Free response, by the reduced models: on flat ground against in an ideal recess.",
        panels=panels,
        columns=2,
        shades=Shades(label="flat over recess", unit="%", low=-reach, high=reach, centre=0.0),
    )
