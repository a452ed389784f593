"""The maps of the report: over release and spin, and over size and intensity."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ...figures.heat import Array
from ...figures.picture import Picture
from .picture import Map, map_picture

if TYPE_CHECKING:
    import pandas as pd

_PANELS = 4
_FREE = {
    "x": "rolling rate / that of steady wobble",
    "x_unit": "-",
    "y": "tilt of release / α",
    "y_unit": "-",
}
_SHAKEN = {"x": "R", "x_unit": "m", "y": "peak resultant / (g tan α)", "y_unit": "-"}


def free_maps(table: pd.DataFrame) -> dict[str, Picture]:
    """Return the maps of free response by name."""
    turn = 100.0 * np.abs(table["flat_turn"] / table["turn"] - 1.0)
    period = 100.0 * np.abs(table["flat_period"] / table["period"] - 1.0)
    need = table["friction"] / table["tan_alpha"]
    return {
        "turn": map_picture(
            name="free-turn",
            title="Angle of turn from tilt maximum to next maximum",
            caption="How far the angle of turn of the flat-ground model (open ground) is off that of the "
            "recess model, "
            "in per cent.",
            value="difference",
            unit="%",
            log=True,
            **_free(table, turn),
        ),
        "period": map_picture(
            name="free-period",
            title="Period from tilt maximum to next maximum",
            caption="Period of the flat-ground model: difference from that of the recess model, in per cent.",
            value="difference",
            unit="%",
            log=True,
            **_free(table, period),
        ),
        "friction": map_picture(
            name="free-friction",
            title="Friction needed in free response",
            caption="Largest horizontal over normal force within one period, over tan α.",
            value="friction / tan α",
            unit="-",
            **_free(table, need.replace(np.inf, np.nan)),
        ),
    }


def shaken_maps(table: pd.DataFrame) -> dict[str, Picture]:
    """Return the maps under shaking by name."""
    stands = (table["recess"] < table["overturning"] * (1.0 - 1e-9)) & (table["recess"] > 0.0)

    def off(name: str) -> pd.Series[float]:
        both = stands & (table[name] < table["overturning"] * (1.0 - 1e-9))
        difference: pd.Series[float] = 100.0 * (table[name] / table["recess"] - 1.0).abs()
        return difference.where(both)

    grey = "Darkest: 100 % and more; grey: no uplift, or it falls in one of the two."
    several = len(table["motion"].unique()) > 1
    records, worst = ("Median of the records. ", "Largest of the records. ") if several else ("", "")
    need = (table["friction"] / table["tan_alpha"]).replace(np.inf, np.nan)
    return {
        "flat": map_picture(
            name="shaken-flat",
            title="Peak tilt, recess against open ground",
            caption="How far the peak tilt of the flat-ground model is off that of the recess model. "
            f"{records}{grey}",
            value="difference",
            unit="%",
            log=True,
            smallest=0.1,
            largest=100.0,
            **_shaken(table, off("flat"), "median"),
        ),
        "twin": map_picture(
            name="shaken-twin",
            title="Peak tilt, the model against itself",
            caption="How far the peak tilt of the recess model moves if the record is 0.1 % stronger: no "
            "model can be "
            f"asked for more. {records}{grey}",
            value="difference",
            unit="%",
            log=True,
            smallest=0.1,
            largest=100.0,
            **_shaken(table, off("twin"), "median"),
        ),
        "vertical": map_picture(
            name="shaken-vertical",
            title="Peak tilt with and without the vertical component",
            caption="How far the vertical component of El Centro moves the peak tilt of the recess model. "
            f"{grey}",
            value="difference",
            unit="%",
            log=True,
            smallest=0.1,
            largest=100.0,
            **_shaken(table[table["vertical"].notna()], off("vertical"), "median"),
        ),
        "friction": map_picture(
            name="shaken-friction",
            title="Friction needed under shaking",
            caption=f"Largest horizontal over normal force, over tan α. {worst}Darkest: 10 and more; grey: "
            "no uplift, it falls, "
            "or no "
            "friction is enough because contact is lost.",
            value="friction / tan α",
            unit="-",
            log=True,
            smallest=0.1,
            largest=10.0,
            **_shaken(table, need, "max"),
        ),
        "normal": map_picture(
            name="shaken-normal",
            title="Least normal force under shaking",
            caption="Below zero the ground would have to pull: contact is lost. "
            + worst.replace("Largest", "Smallest")
            + "Grey: no uplift, or it falls.",
            value="least normal force",
            unit="weights",
            **_shaken(table, table["least_normal"], "min"),
        ),
        "couple": map_picture(
            name="shaken-couple",
            title="Couple that the recess must supply under shaking",
            caption=f"Largest couple that keeps the cylinder from rolling out. {worst}Grey: no uplift, or "
            "it falls.",
            value="couple / (weight × b)",
            unit="-",
            **_shaken(table, table["couple"], "max"),
        ),
    }


def _free(table: pd.DataFrame, values: pd.Series[float]) -> dict[str, Any]:
    return {
        **_FREE,
        "maps": _panels(table.assign(shown=values), "spin", "release", "max"),
    }


def _shaken(
    table: pd.DataFrame, values: pd.Series[float], over: Literal["median", "max", "min"]
) -> dict[str, Any]:
    return {
        **_SHAKEN,
        "maps": _panels(table.assign(shown=values), "semidiagonal", "intensity", over),
    }


def _panels(table: pd.DataFrame, x: str, y: str, over: Literal["median", "max", "min"]) -> tuple[Map, ...]:
    """Return the maps of some slendernesses, the first and the last among them."""
    every = np.unique(table["tan_alpha"])
    chosen = every[np.unique(np.linspace(0, len(every) - 1, _PANELS).round().astype(int))]
    panels = []
    for tan_alpha in chosen:
        cells = table[table["tan_alpha"] == tan_alpha].pivot_table("shown", y, x, aggfunc=over, dropna=False)
        values: Array = cells.to_numpy(dtype=np.float64)
        panels.append(
            Map(title=f"tan α = {tan_alpha:g}", x=list(cells.columns), y=list(cells.index), values=values)
        )
    return tuple(panels)
