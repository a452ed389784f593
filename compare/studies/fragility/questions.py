"""Three questions and the pairs of methods that answer them: planar analysis, support, engine."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from .limits import OVERTURNED
from .result import Fragility

Row = dict[str, Any]


def main_contrasts(found: Fragility) -> dict[str, list[Row]]:
    """Return the rows of the contrasts that answer the three questions on overturning, by question.

    "planar": each planar method against the recess model; "support": the same method on another support
    against the recess; "engine": an engine against the model of its support, and another engine on it.
    """
    methods: Mapping[str, Mapping[str, Any]] = found.about["methods"]
    answers: dict[str, list[Row]] = {"planar": [], "support": [], "engine": []}
    rows = found.contrasts.to_dict("records") if len(found.contrasts) else []
    for row in rows:
        if row["limit"] != OVERTURNED:
            continue
        question, turned = _question(methods, str(row["method"]), str(row["against"]))
        if question:
            named = {str(name): value for name, value in row.items()}
            answers[question].append(_inverted(named) if turned else named)
    return answers


def _question(methods: Mapping[str, Mapping[str, Any]], method: str, against: str) -> tuple[str, bool]:
    """Return the question that a pair answers, and whether the pair is the other way round; "" for none."""
    one, other = methods[method], methods[against]
    engines = one["engine"], other["engine"]
    if engines == (None, None) and "planar" in (one["support"], other["support"]):
        recess = [each["support"] == "recess" for each in (one, other)]
        return ("planar", recess[0]) if any(recess) else ("", False)
    if engines[0] == engines[1]:
        recess = [each["support"] == "recess" for each in (one, other)]
        return ("support", recess[0]) if recess[0] != recess[1] else ("", False)
    if None in engines:
        turned = engines[0] is None
        model, engine = (method, other) if turned else (against, one)
        return ("engine", turned) if engine["own_model"] == model else ("", False)
    return ("engine", False) if one["support"] == other["support"] else ("", False)


def _inverted(row: Row) -> Row:
    """Return a contrast with its methods exchanged."""

    def inverse(value: float) -> float:
        return math.inf if value == 0.0 else 1.0 / value

    return row | {
        "method": row["against"],
        "against": row["method"],
        "ratio": inverse(row["ratio"]),
        "ratio_low": inverse(row["ratio_high"]),
        "ratio_high": inverse(row["ratio_low"]),
        "dispersion_difference": -row["dispersion_difference"],
        "dispersion_difference_low": -row["dispersion_difference_high"],
        "dispersion_difference_high": -row["dispersion_difference_low"],
    }
