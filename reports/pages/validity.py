"""The report on the limits of the reduced model."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pandas as pd

from rockwobble.compare.metrics.statistics import MARGIN
from rockwobble.compare.studies.validity.limits import cells, contrasts, damping, limits_of, needs
from rockwobble.compare.studies.validity.plan import LARGEST_PEAK
from rockwobble.compare.studies.validity.shaken import FREE, INTENSITY
from rockwobble.compare.studies.validity.study import Validity
from rockwobble.models.support import RECESSES_FIRST, SUPPORTS

from ..figures.validity import METHODS, has_walls, pictures
from .page import Page
from .table import number

_NEEDS = {
    "friction": "friction over tan α",
    "moment": "κ of the recess over weight × b",
    "tension": "force in the tendon over weight of a column",
    "motions": "motions counted",
}

_PLACES: Mapping[str, str] = {
    **{support: support.place for support in RECESSES_FIRST},
    "copy": "by a record 1 % stronger alone",
}


def page_of(found: Validity) -> Page:
    """Return the report."""
    tables, structure = found.tables, found.structure
    values: dict[str, object] = {
        "limits": limits_of(tables),
        "margin": MARGIN,
        "strayed": _strays(limits_of(tables)["records"]),
        "contrasts": _contrasts(contrasts(tables)),
        "summary": _summary(cells(tables)),
        **_needs(needs(tables)),
        "damping": damping(tables).to_dict("records"),
        "ranges": {
            name: (float(tables[part][column].min()), float(tables[part][column].max()))
            for name, part, column in (
                ("slender", "free_response", "tan_alpha"),
                ("shaken", "peaks", "tan_alpha"),
                ("sizes", "peaks", "semidiagonal"),
                ("intensities", "peaks", "intensity"),
            )
        },
        "largest_peak": LARGEST_PEAK,
        "records": found.facts["records"],
        "slab_mass_ratio": structure.slab_mass_ratio,
        "tendon": structure.tendon,
        "uplift": structure.uplift,
        "ring_level": INTENSITY * structure.uplift,
        "about": found.manifest,
    }
    if not structure.slab_mass_ratio:
        values |= {"rings": _rings(tables["rings"]), "worst": _worst(tables["rings"])}
    drawn = pictures(found)
    values["drawn"] = {picture.name for picture in drawn}
    return Page(name="validity", template="validity", values=values, pictures=drawn)


def _strays(records: Mapping[str, float]) -> list[str]:
    """What one record in twenty exceeds at the points, in words, of what enough records know it."""
    found = []
    for name, place in _PLACES.items():
        ends = [records.get(f"{name}_95_{end}", math.nan) for end in ("least", "largest")]
        if not math.isnan(ends[0]):
            span = dict.fromkeys(number(end, ".2f") for end in ends)
            found.append(f"{' to '.join(span)} {place}")
    return found


def _contrasts(table: pd.DataFrame) -> list[dict[str, object]]:
    """The rows of paired ratios with their point in words, but for half the step."""
    rows = []
    for row in table.to_dict("records"):
        if row["method"] not in METHODS:
            continue
        point = f"tan α = {row['tan_alpha']:g}, R = {row['semidiagonal']:g} m, {row['intensity']:g} g tan α"
        rows.append({str(k): v for k, v in row.items()} | {"point": point, "method": METHODS[row["method"]]})
    return rows


def _summary(table: pd.DataFrame) -> list[dict[str, object]]:
    """The maps in one table: by slenderness and intensity the least and the largest over the sizes."""
    rows: list[dict[str, object]] = []
    for (tan_alpha, intensity), own in table.groupby(["tan_alpha", "intensity"]):
        rows.append(
            {
                "slenderness": f"tan α = {float(str(tan_alpha)):g}",
                "intensity": intensity,
                "peak": float(str(tan_alpha)) * float(str(intensity)),
                **{
                    f"{name}_{end}": float(getattr(own[name], end)())
                    for name in ("flat_ratio", "flat_90", "copy_90", "overturned", "flat_overturned")
                    for end in ("min", "max")
                },
            }
        )
    return rows


def _needs(table: pd.DataFrame) -> dict[str, object]:
    """What must be supplied: a row for each slenderness, a column for each intensity."""
    intensities = [f"{intensity:g}" for intensity in sorted(table["intensity"].unique())]
    rows = [
        {
            "what": words,
            "tan_alpha": tan_alpha,
            **dict(zip(map("{:g}".format, own["intensity"]), own[name], strict=True)),
        }
        for name, words in _NEEDS.items()
        if name in table
        for tan_alpha, own in table.groupby("tan_alpha")
    ]
    columns = [["tan_alpha", "tan α", "g"], *([name, f"{name} g tan α", ".3g"] for name in intensities)]
    return {"needs": rows, "needed_columns": columns}


def _rings(table: pd.DataFrame) -> list[dict[str, object]]:
    """Results of each support with its walls, over slendernesses and azimuths."""
    rows: list[dict[str, object]] = []
    walls = ["support", "clearance", "inclination", "friction"]
    for key, own in table.groupby(walls, sort=False, dropna=False):
        support, clearance, inclination, friction = key
        shaken = own[own["motion"] != FREE]
        touched = own[own["contact_time"] > 0.0]
        ratio = shaken["peak"] / shaken["recess_peak"]
        rows.append(
            {
                "support": SUPPORTS[str(support)].words,
                "clearance": clearance,
                "inclination": "α" if inclination == 0.0 else inclination,
                "friction": friction,
                "least": ratio.min(),
                "largest": ratio.max(),
                "rolled": shaken["rolled_out"].max(),
                "at_end": shaken["at_end"].max(),
                "loss": touched["loss"].max() if len(touched) else math.nan,
                "halved": (shaken["halved_peak"] / shaken["peak"] - 1.0).abs().max(),
            }
        )
    return rows


def _worst(table: pd.DataFrame) -> dict[str, object]:
    """The recess with clearance whose peak is farthest from that of the recess model."""
    shaken = table[has_walls(table) & (table["motion"] != FREE) & (table["outcome"] != "failed")]
    ratio = (shaken["peak"] / shaken["recess_peak"]).to_numpy(dtype=float)
    with np.errstate(divide="ignore"):
        worst = shaken.iloc[int(np.argmax(np.maximum(ratio, 1.0 / ratio)))]
    return {str(name): value for name, value in worst.items()} | {
        "ratio": worst["peak"] / worst["recess_peak"]
    }
