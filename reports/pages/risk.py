"""Values for the part of a fragility page on the annual frequency of overturning."""

from __future__ import annotations

import math
from typing import Any

from rockwobble.studies import Fragility
from rockwobble.studies.fragility.risk import FAR, TARGET

from ..figures.risk import risk_pictures
from .table import number

_UNIT = 1e4  # frequencies in 1e-4 a year
_FEWEST = 3  # motions that overturn, of which resamples make an interval
# shares of the frequency from which it is said what they rest on
_TAIL, _SCALED = 0.1, 0.5


def risk_values(found: Fragility) -> dict[str, object] | None:
    """Return the values of the template of the risk; None without a hazard."""
    if "risk" not in found.tables:
        return None
    rows = [
        {str(name): value for name, value in row.items()} for row in found.tables["risk"].to_dict("records")
    ]
    scaled = [name for name in rows[0] if name.startswith("annual_frequency")]
    reference = str(rows[0]["method"])
    return {
        "hazard": found.facts["hazard"],
        "rows": [{**row, **{name: _UNIT * row[name] for name in scaled}} for row in rows],
        "main": [{**row, "words": _words(row)} for row in rows if row["method"] == reference],
        "reference": reference,
        "remarks": _remarks(rows),
        "dispersion": _dispersion(found.facts["hazard"]["total_dispersion"]),
        "pictures": [picture.name for picture in risk_pictures(found)],
    }


def _words(row: dict[str, Any]) -> str:
    if not row["overturning_motions"]:
        return f"no motion overturns it at these levels: less than {row['annual_frequency_high']:.2g} a year."
    low, high = row["annual_frequency_low"], row["annual_frequency_high"]
    rate = row["annual_frequency"]
    verdict = "above" if low > TARGET else "below" if high < TARGET else "not told from"
    return (
        f"overturned {rate:.2g} times a year ({low:.2g} to {high:.2g}), once in {1.0 / rate:,.0f} years; "
        f"{verdict} a target of {TARGET:g} a year."
    )


def _dispersion(total: float | None) -> str:
    """The dispersion that was given for the curves, in place of that of the motions; empty of none."""
    return f". The total dispersion of the lognormal curves is {number(total)}" if total else ""


def _remarks(rows: list[dict[str, Any]]) -> list[str]:
    about = [(f"{row['method']} of {row['cylinder']}", row) for row in rows]
    few = [name for name, row in about if row["overturning_motions"] < _FEWEST]
    remarks = (
        [f"Fewer than {_FEWEST} motions overturn, so that the interval is a bound: {', '.join(few)}."]
        if few
        else []
    )
    remarks += [
        f"{100.0 * row['tail_share']:.0f} % of the frequency of {name} rests on intensities beyond the last "
        f"level or the last point of the hazard; it is at most {row['annual_frequency_most']:.2g} a year."
        for name, row in about
        if row["tail_share"] > _TAIL
    ]
    far = [
        (name, row) for name, row in about if not math.isnan(row["far_share"]) and row["far_share"] > _SCALED
    ]
    if far:
        share = max(row["far_share"] for _, row in far)
        remarks.append(
            f"Up to {100.0 * share:.0f} % of the frequency rests on motions scaled by more than {FAR:g}, "
            "whose shape is not that of such strong shaking: use stronger records, or "
            "other records at each level."
        )
    return remarks
