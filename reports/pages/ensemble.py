"""Values for the page of an ensemble."""

from __future__ import annotations

from rockwobble.compare.metrics.statistics import POWER, value_if_enough
from rockwobble.models.diagnostic import codes_in
from rockwobble.studies import Ensemble

from ..figures.ensemble import pictures
from .page import Page
from .table import span
from .wording import lines_of, sentence, statement

_ANSWERS = tuple(f"ensemble.{name}" for name in ("no_pairs", "equivalent", "different", "undecided", "few"))


def page_of(ensemble: Ensemble) -> Page:
    """Page of an ensemble."""
    rows = [
        {str(name): value for name, value in row.items()}
        | {"ratio": value_if_enough(row["ratio"], row["compared"], ratio=True)}
        | {"only": row["overturned"] - row["both_overturned"]}
        | {"only_there": row["against_overturned"] - row["both_overturned"]}
        | {"neither": row["count"] - row["overturned"] - row["against_overturned"] + row["both_overturned"]}
        for row in ensemble.contrasts.to_dict("records")
    ]
    findings = ensemble.findings()
    one_column = any("one_column" in codes_in(cell) for cell in ensemble.members["diagnostics"])
    values = {
        "facts": ensemble.facts,
        "sizes": span([ensemble.facts["semidiagonal"][end] for end in ("from", "to")]),
        "slenderness": span([ensemble.facts["tan_alpha"][end] for end in ("from", "to")]),
        "count": ensemble.members["member"].nunique(),
        "methods": ensemble.methods.to_dict("records"),
        "contrasts": rows,
        "notes": [lines_of("diagnostic.one_column")[0]] if one_column else [],
        "headline": [statement(each) for each in findings if each.key in _ANSWERS],
        # no capital: pairs begin with a method name
        "pairs": [f"{sentence(each)}." for each in findings if each.key == "ensemble.pair"],
        "findings": [statement(each) for each in findings if each.key not in (*_ANSWERS, "ensemble.pair")],
        "any_falls": bool(ensemble.methods["overturned"].any()),
        "power": POWER,
        "about": ensemble.manifest,
    }
    return Page(name="ensemble", template="ensemble", values=values, pictures=pictures(ensemble))
