"""Values for the page of a fragility."""

from __future__ import annotations

import math
from collections.abc import Iterable

from rockwobble.models.finding import Finding
from rockwobble.studies import Fragility
from rockwobble.studies.fragility.fit import SEPARATED
from rockwobble.studies.fragility.intensity import MEASURES
from rockwobble.studies.fragility.risk import TARGET
from rockwobble.studies.fragility.study import known_ratio, main_contrasts
from rockwobble.studies.fragility.tables import ALL, OVERTURNED, Row, rows_of

from ..figures.fragility import pictures
from ..figures.risk import risk_pictures
from .page import Page
from .wording import sentence, statement

_QUESTIONS = {
    "planar": "Planar analysis (worse plane: the larger peak of the two):",
    "support": "Support:",
    "engine": "Engine:",
}
_FREQUENCY = ("risk.frequency", "risk.none")
_UNIT = 1e4  # frequencies in 1e-4 a year


def page_of(fragility: Fragility) -> Page:
    """Page of a fragility."""
    drawn = pictures(fragility)
    names = [picture.name for picture in drawn]
    drawn += risk_pictures(fragility)
    values = {**fragility_values(fragility), "about": fragility.manifest, "pictures": names}
    return Page(name="fragility", template="fragility", values=values, pictures=drawn)


def fragility_values(fragility: Fragility) -> dict[str, object]:
    """Values of the template of a fragility."""
    measure, cylinders, findings = (
        MEASURES[str(fragility.facts["measure"])],
        fragility.facts["cylinders"],
        fragility.findings(),
    )
    whole = ALL if len(cylinders) > 1 else next(iter(cylinders))
    fits = rows_of(fragility.fits)
    fallen = [
        {**_with_known_spread(row, fits), "median": fragility.median_or_bound(row["cylinder"], row["median"])}
        for row in fits
        if row["limit"] == OVERTURNED
    ]
    contrasts = [
        {**_with_known_spread(row, fits), "ratio": known_ratio(row["ratio"])}
        for cylinder in (*cylinders, ALL)
        for rows in main_contrasts(fragility).values()
        for row in rows
        if row["cylinder"] == cylinder
    ]

    def said(*keys: str) -> list[Finding]:
        return [each for each in findings if each.key.removeprefix("fragility.") in keys]

    questions: dict[str, list[str]] = {}
    for each in said("equivalent", "different", "undecided", "no_ratio"):
        if each.runs == whole:
            questions.setdefault(_QUESTIONS[str(each.values["reason"])], []).append(f"{sentence(each)}.")
    return {
        "facts": fragility.facts,
        "modes": list(map(statement, findings.of("mode"))),
        "risk": _risk_values(fragility),
        "measure": measure,
        "bodies": list(map(sentence, said("body", "one_column"))),
        "scaling": " ".join(map(sentence, said("levels", "own_levels", "cloud"))),
        "answers": list(map(statement, said("few", "nothing_overturns", *([] if contrasts else ["median"])))),
        "undetermined": list(map(statement, said("bounded"))),
        "questions": questions,
        "several": len(cylinders) > 1,
        "contrasts": contrasts,
        "fallen": fallen,
        "remarks": list(map(statement, said("poor_fit", "failed", "no_curve"))),
        "few": "".join(sentence(each, short=True) for each in said("few")),
        **_counts(fragility),
        "states": _states(fragility),
        "state_columns": [["method", "method", "words"]]
        + [[limit, limit.replace("_", " "), ".3g"] for limit in fragility.facts["limits"]],
        "unit": measure.unit.replace("-", ""),
        "notes": list(map(statement, said("wall"))),
        "efficiency": [
            {**row, "title": MEASURES[str(row["measure"])].title} for row in rows_of(fragility.efficiency)
        ],
        "gaps": _gaps(fragility),
    }


def _with_known_spread(row: Row, fits: Iterable[Row]) -> Row:
    """Row without dispersions for unfitted curves, whose step has a nominal dispersion of 0."""
    methods = {row["method"], row.get("against", row["method"])}
    steps = (
        each["kind"] == SEPARATED
        for each in fits
        if each["method"] in methods
        and each["limit"] == row["limit"]
        and row["cylinder"] in (ALL, each["cylinder"])
    )
    unknown = any(steps)
    return {
        name: math.nan if unknown and name.startswith("dispersion") else value for name, value in row.items()
    }


def _counts(fragility: Fragility) -> dict[str, object]:
    """One row per cylinder, method and limit: motions that exceed it, by level for stripes."""
    levels: list[float] = [*fragility.counts["intensity"].unique()] if fragility.facts["levels"] else []
    rows = [
        {
            "cylinder": cylinder,
            "method": method,
            "limit": str(limit).replace("_", " "),
            "all": _share(own["k"].sum(), own["n"].sum()),
            **{f"{row['intensity']:g}": _share(row["k"], row["n"]) for row in own.to_dict("records")},
        }
        for (cylinder, method, limit), own in fragility.counts.groupby(
            ["cylinder", "method", "limit"], sort=False
        )
    ]
    columns = [(f"{level:g}", f"{level:g}") for level in levels]
    fallen = [row for row in rows if row["limit"] == OVERTURNED]
    for row in fallen:
        shares = [(level, str(row.get(f"{level:g}", "0"))) for level in levels]
        row["first"] = next((level for level, share in shares if not share.startswith("0")), None)
    return {
        "count_rows": rows,
        "fallen_rows": fallen,
        "count_columns": [
            *([name, name, "words"] for name in ("method", "limit", "all")),
            *([*each, "words", "wide"] for each in columns),
        ],
    }


def _share(exceeded: float, runs: float) -> str:
    return f"{exceeded:g} of {runs:g}".replace(" ", "\u00a0")  # no-break spaces keep it in one line


def _gaps(fragility: Fragility) -> list[Row]:
    medians = ("median", "median_incremental")
    return [
        {
            **row,
            **{name: fragility.median_or_bound(row["cylinder"], row[name]) for name in medians},
            "bias": known_ratio(row["bias"]),
        }
        for row in rows_of(fragility.gaps)
    ]


def _states(fragility: Fragility) -> list[Row]:
    """One row per cylinder and method: median of each limit, or its bound."""
    rows: dict[tuple[str, str], Row] = {}
    for row in fragility.fits.to_dict("records"):
        key = str(row["cylinder"]), str(row["method"])
        made = rows.setdefault(key, {"cylinder": key[0], "method": key[1]})
        made[str(row["limit"])] = fragility.median_or_bound(key[0], float(row["median"]))
    return list(rows.values())


def _risk_values(fragility: Fragility) -> dict[str, object] | None:
    """Template values on the annual frequency of overturning; None without a hazard."""
    if "risk" not in fragility.tables:
        return None
    rows = rows_of(fragility.tables["risk"])
    scaled = [name for name in rows[0] if name.startswith("annual_frequency")]
    reference, said = str(rows[0]["method"]), fragility.findings().of("risk")
    return {
        "hazard": {"limit": OVERTURNED, "target": TARGET, "source": ""} | fragility.facts["hazard"],
        "rows": [{**row, **{name: _UNIT * row[name] for name in scaled}} for row in rows],
        "main": [sentence(each) for each in said if each.key in _FREQUENCY],
        "reference": reference,
        "remarks": [
            f"{each.runs}: {sentence(each)}".removeprefix(": ") for each in said if each.key not in _FREQUENCY
        ],
        "pictures": [picture.name for picture in risk_pictures(fragility)],
    }
