"""The report on the limits of the reduced model."""

from __future__ import annotations

from collections.abc import Hashable

import pandas as pd

from rockwobble.models.support import RECESS, SUPPORTS
from rockwobble.studies.validity.limits import (
    POINT,
    cells,
    contrasts,
    damping,
    early,
    needs,
    traces,
    vertical,
)
from rockwobble.studies.validity.measurements import INTENSITY
from rockwobble.studies.validity.plan import FREE, LARGEST_PEAK
from rockwobble.studies.validity.study import Validity

from ..figures.validity import METHODS, pictures
from .page import Page
from .wording import sentence, statement

Rows = list[dict[Hashable, object]]
_NEEDS = {
    "friction": "friction over tan α",
    "moment": "κ of the recess over weight × b",
    "tension": "force in the tendon over weight of a column",
    "motions": "motions counted",
}
_CHANGES = {"vertical": "vertical component", "copy": "record 1 % stronger", RECESS: "without either"}
_WORDS = {name: support.words for name, support in SUPPORTS.items()}


def page_of(results: Validity) -> Page:
    """Page of the validity report."""
    tables, structure, findings = results.tables, results.structure, results.findings()
    drawn = pictures(results)

    def said(group: str) -> list[str]:
        return [statement(each) for each in findings.of(f"limit_{group}")]

    def picture_names(*chosen: str) -> list[str]:
        return [picture.name for picture in drawn if picture.name in chosen]

    ranges = {
        name: tables[part][column].agg(["min", "max"]).tolist()
        for name, part, column in (
            ("slender", "free_response", "tan_alpha"),
            ("shaken", "peaks", "tan_alpha"),
            ("sizes", "peaks", "semidiagonal"),
            ("intensities", "peaks", "intensity"),
        )
    }
    values: dict[str, object] = {
        **{f"{group}_findings": said(group) for group in ("scope", "records", "release", "force", "ring")},
        "verdict": " ".join(said("model")),
        "clearance": " ".join(said("clearance")),
        "requirements": [
            {"need": sentence(each, short=True), "limit": sentence(each)}
            for each in findings.of("limit_requirement")
        ],
        "contrasts": _contrasts(contrasts(tables)),
        "summary": _summary(cells(tables)),
        "tendon": structure.tendon is not None,
        "map_pictures": picture_names("bias", "spread", "sensitivity"),
        "traces": _traces(traces(tables)),
        "early": early(tables),
        "followed": tables["following"],
        "free_pictures": picture_names("free-turn", "free-period", "verification"),
        "force_pictures": picture_names("need-friction", "need-contact", "need-moment", "slip"),
        **_needs(needs(tables)),
        "damping": damping(tables).to_dict("records"),
        "changes": _changes(vertical(tables)),
        "ranges": ranges,
        "largest_peak": LARGEST_PEAK,
        "records": results.facts["records"],
        "about": results.manifest,
    }
    if not structure.slab_mass_ratio:
        supports = _rings(tables["rings"], ["support"])[::-1]
        supports[-1]["rolled"] = None  # no roll-out in an ideal recess
        walls = _rings(tables["rings"], ["support", "clearance", "inclination", "friction"])
        values |= {"ring_level": INTENSITY * structure.uplift, "supports": supports, "rings": walls}
    return Page(name="validity", template="validity", values=values, pictures=drawn)


def _contrasts(table: pd.DataFrame) -> Rows:
    """Rows of paired ratios with their point in words, without the half-step runs."""
    table = table[table["method"].isin(METHODS)]
    points = [
        f"tan α = {slender:g}, R = {size:g} m, {level:g} g tan α"
        for slender, size, level in table[POINT].to_numpy()
    ]
    return table.assign(point=points, method=table["method"].map(METHODS)).to_dict("records")


def _summary(table: pd.DataFrame) -> Rows:
    """Summary of the maps: range over the sizes by slenderness and intensity."""
    shown = ["flat_ratio", "flat_90", "copy_90", "overturned", "flat_overturned"]
    rows = table.groupby(["tan_alpha", "intensity"])[shown].agg(["min", "max"])
    rows.columns = pd.Index(["_".join(each) for each in rows.columns])
    rows = rows.reset_index()
    slenderness = [f"tan α = {each:g}" for each in rows["tan_alpha"]]
    return rows.assign(slenderness=slenderness, peak=rows["tan_alpha"] * rows["intensity"]).to_dict("records")


def _needs(table: pd.DataFrame) -> dict[str, object]:
    """Requirements: one row per slenderness, one column per intensity."""
    names = [f"{intensity:g}" for intensity in sorted(table["intensity"].unique())]
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
    columns = [["tan_alpha", "tan α", "g"], *([name, f"{name} g tan α", "most .3g"] for name in names)]
    return {"needs": rows, "needed_columns": columns}


def _traces(table: pd.DataFrame) -> Rows:
    """Agreement times of the engine with each model; runs expected to diverge are not counted."""
    table = table.sort_values(["support", "reference_support"], ascending=False)
    counted = table[["whole", "runs"]].where(table["support"] == table["reference_support"])
    run = "engine, " + table["support"].map(_WORDS)
    model = table["reference_support"].map(_WORDS).str.removeprefix("ideal ")
    return table.assign(**counted, run=run, model=model).to_dict("records")


def _changes(table: pd.DataFrame) -> Rows:
    """Peak changes under El Centro, and overturning counts with and without the vertical component."""
    overturned = table["overturned"].drop("copy")
    return table.assign(case=table.index.map(_CHANGES), overturned=overturned).to_dict("records")


def _rings(table: pd.DataFrame, by: list[str]) -> Rows:
    """Results of each support, or of each with its walls, over slendernesses and azimuths."""
    ratio, off = table["peak"] / table["recess_peak"], (table["halved_peak"] / table["peak"] - 1.0).abs()
    table = table.assign(ratio=ratio, off=off, lost=table["loss"].where(table["contact_time"] > 0.0))
    lost = table.groupby(by, sort=False, dropna=False, as_index=False)["lost"].max()
    rows = (
        table[table["motion"] != FREE]
        .groupby(by, sort=False, dropna=False, as_index=False)
        .agg(
            least=("ratio", "min"),
            largest=("ratio", "max"),
            rolled=("rolled_out", "max"),
            at_end=("at_end", "max"),
            halved=("off", "max"),
        )
        .merge(lost, on=by)
    )
    rows["support"] = rows["support"].map(_WORDS)
    return rows.replace({"inclination": {0.0: "α"}}).to_dict("records")
