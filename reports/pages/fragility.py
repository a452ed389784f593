"""Values for the page of a fragility: its words are in the template fragility.md.j2."""

from __future__ import annotations

import math

from rockwobble.compare import Fragility
from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.compare.studies.fragility.fit import ALWAYS, FITTED, NEVER, TOO_FEW
from rockwobble.compare.studies.fragility.intensity import MEASURES
from rockwobble.compare.studies.fragility.study import FEWEST_LEVELS, Row, main_contrasts
from rockwobble.compare.studies.fragility.tables import ALL, OVERTURNED
from rockwobble.models.support import SUPPORTS

from ..figures.fragility import pictures
from ..figures.risk import risk_pictures
from .page import Page
from .risk import risk_values

_WALLED = tuple(each.name for each in SUPPORTS.values() if each.walls)
# below this probability the counts do not follow a lognormal curve
_POOR = 0.05


def page_of(found: Fragility) -> Page:
    """Return the page of a fragility."""
    drawn = pictures(found)
    names = [picture.name for picture in drawn]
    drawn += risk_pictures(found)
    values = {**fragility_values(found), "about": found.manifest, "pictures": names}
    return Page(name="fragility", template="fragility", values=values, pictures=drawn)


def fragility_values(found: Fragility) -> dict[str, object]:
    """Return the values of the template of a fragility."""
    measure = MEASURES[str(found.facts["measure"])]
    cylinders = found.facts["cylinders"]
    whole = ALL if len(cylinders) > 1 else next(iter(cylinders))
    answers = main_contrasts(found)
    fits = found.fits.to_dict("records")
    fallen = [row for row in fits if row["limit"] == OVERTURNED]
    efficiency = [
        {**row, "title": MEASURES[str(row["measure"])].title} for row in found.efficiency.to_dict("records")
    ]
    return {
        "facts": found.facts,
        "risk": risk_values(found),
        "measure": measure,
        "cylinders": [{"name": name, "slab_mass_ratio": 0.0, **body} for name, body in cylinders.items()],
        "answers": {
            question: [{"ratio_most": math.nan, **row} for row in rows if row["cylinder"] == whole]
            for question, rows in answers.items()
        },
        "contrasts": _by_cylinder([row for rows in answers.values() for row in rows], [*cylinders, ALL]),
        "several": len(cylinders) > 1,
        "engine_runs": any(each["engine"] is not None for each in found.facts["methods"].values()),
        "scaling": _scaling(found, measure.title),
        "fallen": fallen,
        "overturns": any(row["exceeded"] for row in fallen),
        "curved": [row for row in fallen if row["kind"] == FITTED],
        "extrapolated": [row for row in fallen if row["extrapolated"] and row["kind"] == FITTED],
        "curveless": [row for row in fits if row["kind"] not in (FITTED, ALWAYS, NEVER, TOO_FEW)],
        "few": any(row["kind"] == TOO_FEW for row in fits),
        "fewest": {"motions": FEWEST, "levels": FEWEST_LEVELS},
        **_counts(found),
        "poor": [row for row in fallen if row["p"] < _POOR],
        "poor_below": _POOR,
        "states": _states(found),
        "state_columns": [["method", "method", "words"]]
        + [[limit, limit.replace("_", " "), ".3g"] for limit in found.facts["limits"]],
        "walls": any(each["support"] in _WALLED for each in found.facts["methods"].values()),
        "failed": [{"median_if_not": math.nan, **row} for row in fallen if row["failed"]],
        "efficiency": efficiency,
        "gaps": found.gaps.to_dict("records"),
    }


def _scaling(found: Fragility, measure: str) -> str:
    levels, scales = found.facts["levels"], found.facts["scales"]
    if levels:
        return f"each at {len(levels)} levels of {measure} from {levels[0]:.4g} to {levels[-1]:.4g}"
    return "as they are" + ("" if scales == [1.0] else f", times {', '.join(f'{s:.4g}' for s in scales)}")


def _counts(found: Fragility) -> dict[str, object]:
    """One row for each cylinder, method and limit: motions that exceed it, by level where there are some."""
    levels: list[float] = [*found.counts["intensity"].unique()] if found.facts["levels"] else []
    rows = [
        {
            "cylinder": cylinder,
            "method": method,
            "limit": str(limit).replace("_", " "),
            "all": f"{own['k'].sum()} of {own['n'].sum()}",
            **{f"{row['intensity']:g}": f"{row['k']} of {row['n']}" for row in own.to_dict("records")},
        }
        for (cylinder, method, limit), own in found.counts.groupby(
            ["cylinder", "method", "limit"], sort=False
        )
    ]
    columns = [("all", "all"), *((f"{level:g}", f"{level:g}") for level in levels)]
    return {
        "count_rows": rows,
        "count_columns": [
            *([name, name, "words"] for name in ("method", "limit")),
            *([*each, "words"] for each in columns),
        ],
    }


def _by_cylinder(rows: list[Row], cylinders: list[str]) -> list[Row]:
    return [row for cylinder in cylinders for row in rows if row["cylinder"] == cylinder]


def _states(found: Fragility) -> list[Row]:
    """One row for each cylinder and method: the median of each limit, or what bounds it."""
    rows: dict[tuple[str, str], Row] = {}
    ends = found.counts.groupby("cylinder")["intensity"].agg(["min", "max"])
    for row in found.fits.to_dict("records"):
        key = str(row["cylinder"]), str(row["method"])
        made = rows.setdefault(key, {"cylinder": key[0], "method": key[1]})
        low, high = (float(ends[end][key[0]]) for end in ("min", "max"))
        bounds = {0.0: f"< {low:.3g}", math.inf: f"> {high:.3g}"}
        made[str(row["limit"])] = bounds.get(float(row["median"]), row["median"])
    return list(rows.values())
