"""Values for the page of an ensemble: its words are in the template ensemble.md.j2."""

from __future__ import annotations

import math

from rockwobble.compare import Ensemble
from rockwobble.compare.metrics.statistics import (
    FEWEST,
    MARGIN,
    POWER,
    SIGNIFICANCE,
    largest_share_unseen,
    least_significant_count,
    value_if_enough,
)
from rockwobble.models.diagnostic import codes_in

from ..figures.ensemble import main_pairs, pictures
from .page import Page

# of tables kept before there were bounds for runs that failed
_UNBOUNDED = dict.fromkeys(("peak_median_least", "peak_median_most", "ratio_least", "ratio_most"), math.nan)


def page_of(found: Ensemble) -> Page:
    """Return the page of an ensemble."""
    values = {**ensemble_values(found), "about": found.manifest}
    return Page(name="ensemble", template="ensemble", values=values, pictures=pictures(found))


def ensemble_values(found: Ensemble) -> dict[str, object]:
    """Return the values of the template of an ensemble."""
    contrasts, methods = found.contrasts, found.methods.to_dict("records")
    rows, main = (
        [
            {**_UNBOUNDED, **row, "ratio": value_if_enough(row["ratio"], row["compared"], ratio=True)}
            for row in each
        ]
        for each in (contrasts.to_dict("records"), main_pairs(found))
    )
    # those that matter first, then the others by their probability
    ordered = main + (contrasts.sort_values("ratio_p").to_dict("records") if rows else [])
    every = {(row["method"], row["against"]): row for row in ordered}
    for row in rows:
        both = row["both_overturned"]
        row["only"], row["only_there"] = row["overturned"] - both, row["against_overturned"] - both
        row["neither"] = row["count"] - both - row["only"] - row["only_there"]
    return {
        "facts": found.facts,
        "count": found.members["member"].nunique(),
        "methods": methods,
        "contrasts": rows,
        "main": main,
        "one_column": any("one_column" in codes_in(cell) for cell in found.members["diagnostics"]),
        "verdicts": {
            verdict: [row for row in main if row["verdict"] == verdict]
            for verdict in ("within", "beyond", "undecided")
        },
        "apart": [row for row in every.values() if row["ratio_p_adjusted"] < SIGNIFICANCE],
        "apart_by_falls": [row for row in rows if row["overturned_p_adjusted"] < SIGNIFICANCE],
        "any_falls": bool(found.methods["overturned"].any()),
        "failed": [{**_UNBOUNDED, **row} for row in methods if row["failed"]],
        "margin": MARGIN,
        "power": POWER,
        "significance": SIGNIFICANCE,
        "stated_from": FEWEST,
        "fewest": least_significant_count(),
        "unseen": largest_share_unseen(int(contrasts["count"].min())) if rows else 1.0,
    }
