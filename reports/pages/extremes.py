"""The report on the extremes: counts of the verdicts, and what limits each run that is not fine."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pandas as pd

from rockwobble.models.diagnostic import CODES, codes_in
from rockwobble.studies.extremes import FINE, Extremes

from .page import Page

# verdict: the word in a table
WORDS = {
    "fine": "fine",
    "flagged": "flagged",
    "no reference": "no reference",
    "refused": "refused",
    "caught": "caught",
    "silent": "WRONG",
}
_REFERENCES = {
    "exact_turn": "exact angle of turn",
    "energy": "energy kept",
    "tight": "tolerance of 1e-12",
    "model": "model of its support",
    "half_step": "the same at half the step",
}


def page_of(found: Extremes) -> Page:
    """Return the report."""
    runs = found.extremes[found.extremes["verdict"] != "n/a"]
    counts = {name: int((runs["verdict"] == name).sum()) for name in WORDS}
    values: dict[str, object] = {
        "fine": FINE,
        "answer": _answer(counts, len(runs)),
        "methods": _by_method(runs),
        "verdicts": [[name, word, "d"] for name, word in WORDS.items()],
        "not_fine": _not_fine(runs),
        "all": [
            {
                "extreme": f"{row['extreme']}: {row['value']}",
                "method": row["method"],
                "verdict": WORDS[row["verdict"]],
                "error": row["error"],
                "reference": ", ".join(_REFERENCES[each] for each in codes_in(row["reference"])),
            }
            for row in runs.to_dict("records")
        ],
        "about": found.manifest,
    }
    return Page(name="extremes", template="extremes", values=values)


def _answer(counts: Mapping[str, int], total: int) -> str:
    """How many runs are wrong without a word; or what became of all, on three lines of the document."""
    if silent := counts["silent"]:
        return f"{silent} of {total} runs {'is' if silent == 1 else 'are'} silently wrong."
    return (
        f"Nothing is silently wrong: of {total} runs {counts['fine']} are fine, {counts['flagged']} are "
        f"flagged by what limits them,\n{counts['refused']} are refused, {counts['caught']} fail and are "
        f"caught,\nand {counts['no reference']} have no reference."
    )


def _by_method(runs: pd.DataFrame) -> list[dict[str, object]]:
    """Count of the runs of each method with each verdict, and the largest error of those that are fine."""
    rows: list[dict[str, object]] = []
    for method, own in runs.groupby("method", sort=False):
        counts = {name: int((own["verdict"] == name).sum()) for name in WORDS}
        rows.append({"method": method, **counts, "worst": own.loc[own["verdict"] == "fine", "error"].max()})
    return rows


def _not_fine(runs: pd.DataFrame) -> list[dict[str, object]]:
    """The runs that are not fine, one row for those that the same thing limits."""
    keys = ["extreme", "value", "verdict", "limit", "refusal"]
    rows: list[dict[str, object]] = []
    for key, alike in runs[runs["verdict"] != "fine"].groupby(keys, sort=False):
        extreme, value, verdict, limit, refusal = key
        rows.append(
            {
                "extreme": extreme,
                "value": value,
                "methods": ", ".join(alike["method"]),
                "verdict": WORDS[str(verdict)],
                "error": alike["error"].max(),
                # never is a dash
                **{name: alike[name].replace(math.inf, math.nan).min() for name in ("begins", "until")},
                "limit": refusal or "; ".join(CODES[code][1] for code in codes_in(str(limit))),
            }
        )
    return rows
