"""Extremes: every method under every condition, and the page; see script.py beside its folder."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from rockwobble.models import Diagnostic
from rockwobble.reports.pages.page import Page
from rockwobble.reports.published.extremes.scan import FINE, Extremes, measure
from rockwobble.reports.published.script import run

# verdict: the word in a table
WORDS = {
    "fine": "fine",
    "flagged": "flagged",
    "no reference": "no reference",
    "refused": "refused",
    "caught": "caught",
    "silent": "WRONG",
}
# no spin in a plane, an engine that holds no standing cylinder, a time step too long for its contact
_REFUSALS = ("planar motion has no rolling_rate", "cannot uplift", "time_step must be at most")
_REFERENCES = {
    "exact_turn": "exact angle of turn",
    "energy": "energy kept",
    "tight": "tolerance of 1e-12",
    "model": "model of its support",
    "half_step": "the same at half the step",
}


def page_of(results: Extremes) -> Page:
    """Return the report."""
    runs = results.extremes[results.extremes["verdict"] != "n/a"]
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
                "reference": ", ".join(_REFERENCES[each] for each in _codes(row["reference"])),
            }
            for row in runs.to_dict("records")
        ],
        "about": results.manifest,
    }
    return Page(name="extremes", template=Path(__file__).with_name("page.md.j2"), values=values)


def _answer(counts: Mapping[str, int], total: int) -> str:
    """Number of silently wrong runs, or of runs by verdict, on three lines of the document."""
    if silent := counts["silent"]:
        return f"{silent} of {total} runs {'is' if silent == 1 else 'are'} silently wrong."
    return (
        f"Nothing is silently wrong: of {total} runs {counts['fine']} are fine, {counts['flagged']} are "
        f"flagged by what limits them,\n{counts['refused']} are refused, {counts['caught']} fail and are "
        f"caught,\nand {counts['no reference']} have no reference."
    )


def _by_method(runs: pd.DataFrame) -> list[dict[str, object]]:
    """Runs of each method by verdict, and the largest error of the fine ones."""
    rows: list[dict[str, object]] = []
    for method, own in runs.groupby("method", sort=False):
        counts = {name: int((own["verdict"] == name).sum()) for name in WORDS}
        rows.append({"method": method, **counts, "worst": own.loc[own["verdict"] == "fine", "error"].max()})
    return rows


def _not_fine(runs: pd.DataFrame) -> list[dict[str, object]]:
    """Runs that are not fine, one row per limiting condition."""
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
                "limit": refusal or "; ".join(Diagnostic(code=code).meaning for code in _codes(str(limit))),
            }
        )
    return rows


def _codes(cell: str) -> list[str]:
    return cell.split(", ") if cell else []


def claims(results: Extremes) -> list[str]:
    """Silently wrong runs, and runs refused for a reason other than `_REFUSALS`."""
    return [
        f"{row['extreme']} {row['value']}, {row['method']}: {row['verdict']} {row['refusal']}"
        for row in results.extremes.to_dict("records")
        if row["verdict"] == "silent"
        or (row["verdict"] == "refused" and not any(each in row["refusal"] for each in _REFUSALS))
    ]


if __name__ == "__main__":
    sys.exit(run(__file__, Extremes, lambda _: measure(), page_of, claims=claims))
