"""The report on the limits of the reduced model."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pandas as pd

from rockwobble.models.support import SUPPORTS
from rockwobble.studies.validity.limits import cells, contrasts, damping, limits_of, needs
from rockwobble.studies.validity.measurements import FREE, INTENSITY
from rockwobble.studies.validity.plan import LARGEST_PEAK
from rockwobble.studies.validity.study import Validity

from ..figures.validity import METHODS, pictures
from .page import Page
from .wording import sentence

_NEEDS = {
    "friction": "friction over tan α",
    "moment": "κ of the recess over weight × b",
    "tension": "force in the tendon over weight of a column",
    "motions": "motions counted",
}

# how the maps and the free response are shown: a tendon has no model on flat ground to compare with
_WITHOUT_TENDON: Mapping[str, object] = {
    "map_words": "Flat ground over an ideal recess by the reduced models, over all sizes; where both factors "
    "are alike, the difference is sensitivity.",
    "map_columns": [
        ["intensity", "peak over g tan α [-]", "g"],
        ["peak", "peak [g]", ".2g"],
        ["flat_ratio_min", "median, least", ".2f"],
        ["flat_ratio_max", "largest", ".2f"],
        ["flat_90_max", "nine in ten", ".2f"],
        ["copy_90_max", "record + 1 %", ".2f"],
        ["overturned_min", "overturn, least", "percent", "wide"],
        ["overturned_max", "largest", "percent", "wide"],
        ["flat_overturned_max", "largest on flat ground", "percent", "wide"],
    ],
    "free_title": "Free response: rolling out",
    "free_pictures": ["free-turn", "free-period", "verification"],
}
_WITH_TENDON: Mapping[str, object] = {
    "map_words": "Over all sizes: the factor of nine in ten records under a record 1 % stronger, and the "
    "share that overturns.",
    "map_columns": [
        ["intensity", "peak over g tan α [-]", "g"],
        ["peak", "peak [g]", ".2g"],
        ["copy_90_max", "record + 1 %", ".2f"],
        ["overturned_min", "overturn, least", "percent"],
        ["overturned_max", "largest", "percent"],
    ],
    "free_title": "Free response",
    "free_pictures": [],
}


def page_of(results: Validity) -> Page:
    """Return the report."""
    tables, structure, limits = results.tables, results.structure, limits_of(results.tables)
    findings = results.findings()

    def said(group: str) -> list[str]:
        lines = (sentence(each) for each in findings.of(f"limit_{group}"))
        return [f"{line[:1].upper()}{line[1:]}." for line in lines]

    drawn = pictures(results)
    names = [picture.name for picture in drawn]
    tendon, slab = structure.tendon is not None, bool(structure.slab_mass_ratio)
    values: dict[str, object] = {
        "limits": limits,
        "scope": said("scope"),
        "verdict": " ".join(said("model")),
        "clearance": " ".join(said("clearance")),
        "requirements": [
            {"need": sentence(each, short=True), "limit": sentence(each)}
            for each in findings.of("limit_requirement")
        ],
        "contrasts": _contrasts(contrasts(tables)),
        "record_findings": said("records"),
        "summary": _summary(cells(tables)),
        **(_WITH_TENDON if tendon else _WITHOUT_TENDON),
        "map_pictures": [name for name in ("bias", "spread", "sensitivity") if name in names],
        "trace_rows": _agreement_rows(limits["traces"], tendon=tendon),
        "free_findings": said("release"),
        "force_pictures": [
            name for name in ("need-friction", "need-contact", "need-moment", "slip") if name in names
        ],
        "force_findings": said("force"),
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
        "records": results.facts["records"],
        "has_clearance": not slab,
        "about": results.manifest,
    }
    if not slab:
        values |= {
            "ring_level": INTENSITY * structure.uplift,
            "rings": _rings(tables["rings"]),
            "ring_findings": said("ring"),
        }
    return Page(name="validity", template="validity", values=values, pictures=drawn)


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
    """Requirements: a row for each slenderness, a column for each intensity."""
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
    columns = [["tan_alpha", "tan α", "g"], *([name, f"{name} g tan α", "most .3g"] for name in intensities)]
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
                "inclination": {"0.0": "α"}.get(str(inclination), inclination),
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


def _agreement_rows(traces: Mapping[str, float], *, tendon: bool) -> list[dict[str, object]]:
    """Agreement times of the engine with each model; a tendon is known to the recess model alone."""
    compared = [("recess", "ideal recess", "recess"), ("flat", "flat ground", "recess")]
    compared.append(("own", "flat ground", "flat ground"))
    counted = ("whole", "runs")
    return [
        {"run": f"engine, {place}", "model": model, "low": traces[name], "high": traces[f"{name}_longest"]}
        # runs expected to diverge are not counted
        | {each: traces[f"{name}_{each}"] for each in counted if name != "flat"}
        for name, place, model in compared[: 1 if tendon else 3]
    ]
