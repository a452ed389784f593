"""Values for the page of an advice: its words are in the template advice.md.j2."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import pandas as pd

from rockwobble.compare.storage.manifest import Manifest, Results
from rockwobble.compare.studies.spectrum.spectrum import PLANAR_X, PLANAR_Y
from rockwobble.compare.studies.spectrum.tables import CHECK_RTOL, NUDGE
from rockwobble.models import AGREEMENT
from rockwobble.models.diagnostic import CODES

from ..figures.advice import GROUPS, SHORT, advice_pictures
from .page import Page
from .words.criteria import CRITERIA


def advice_page(tables: Mapping[str, pd.DataFrame], manifest: Manifest) -> Page:
    """Return the page of an advice, from its tables and its manifest alone."""
    facts = manifest.about["advice"]
    pictures = advice_pictures(facts, tables)
    values = {**advice_values(facts), "about": manifest, "drawn": bool(pictures)}
    return Page(name="advice", template="advice", values=values, pictures=pictures)


def stored_page(results: Results) -> Page:
    """Return the page of the advice that is stored.

    Raises
    ------
    ValueError
        If a version made it that graded otherwise.
    """
    if "bound" not in results.manifest.about["advice"]:
        raise ValueError(f"{results.folder} holds grades by other criteria: run its command again")
    names = ("members", "band", "scales", "trace", "engine")
    return advice_page({name: results.table(name) for name in names}, results.manifest)


def advice_values(facts: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of the template of an advice, from `Advice.facts`."""
    b, h, alpha = facts["b"], facts["h"], facts["alpha"]

    def moved(tilt: float) -> dict[str, float]:
        """Displacement of the centre of the top and uplift of the rim [m]; infinite where it overturns."""
        if not math.isfinite(tilt):
            return {"top": tilt, "rim": tilt}
        theta = tilt * alpha
        return {
            "top": b * (1.0 - math.cos(theta)) + 2.0 * h * math.sin(theta),
            "rim": 2.0 * b * math.sin(theta),
        }

    groups = []
    for row in facts["answers"]:
        name = "copies of this release" if facts["released"] else GROUPS[row["group"]]  # it has no others
        group = {**row, "name": name, "short": SHORT[row["group"]]}
        for share in ("05", "50", "95"):
            group |= {f"{name}_{share}": value for name, value in moved(row[f"peak_tilt_{share}"]).items()}
        groups.append(group)
    planar = [each["factor"] for name, each in facts["lowest"].items() if name in (PLANAR_X, PLANAR_Y)]
    known = [factor for factor in planar if math.isfinite(factor)]
    return {
        **facts,
        "given": moved(facts["peak"]) if facts["moves"] and not facts["overturned"] else None,
        "groups": groups,
        "spread": [group for group in groups if not math.isnan(group["friction_95"])],
        "here": next((row for row in facts["planar"] if row["scale"] == 1.0), None),
        "planar_lowest": min(known) if known else math.nan,
        "space": facts["lowest"].get("3d"),
        "meanings": [CODES[code][1] for code in facts["failure"]],
        "criteria": [
            {"topic": topic, "grade": grade, **CRITERIA[topic]} for topic, grade in facts["grades"].items()
        ],
        "agreement": AGREEMENT,
        "tolerance": CHECK_RTOL,
        "nudge": NUDGE,
    }
