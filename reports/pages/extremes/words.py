"""What the table of extremes says, in sentences and cells: every number is counted in it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

# of a cell; told apart by the word as well as by the colour
WORDS = {
    "fine": "fine",
    "inaccurate": "said",
    "refused": "refused",
    "caught": "caught",
    "silent": "WRONG",
    "n/a": "",
}
# word of a cell, verdict, meaning
MEANINGS = (
    ("fine", "fine", "the largest error, in α (or relative, of the angle of turn), is at most 0.01"),
    (
        "said",
        "inaccurate",
        "it is more, or the model leaves its own assumptions, and the run says so in words; the number is "
        "the error as far as the reference holds",
    ),
    ("refused", "refused", "bad input, one line before anything runs"),
    ("caught", "caught", "the run ended as failed, with its reason"),
    (
        "WRONG",
        "silent",
        "an answer that is wrong and says nothing; the command then ends with exit code 1",
    ),
    ("empty", "na", "the method has nothing of the kind; the planar model starts without spin"),
)
LEGEND = " ".join(f"{word}: {meaning}." for word, _, meaning in MEANINGS)


def rows_of(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Return the rows by the names of the columns."""
    return [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]


def counts(table: pd.DataFrame) -> dict[str, int]:
    """Return how many runs have each verdict."""
    found = {verdict: int((table["verdict"] == verdict).sum()) for verdict in WORDS}
    return {verdict: count for verdict, count in found.items() if verdict != "n/a"}


def headline(table: pd.DataFrame) -> str:
    """Return whether anything is silently wrong, and the counts."""
    found = counts(table)
    silent = found["silent"]
    first = "Nothing is silently wrong" if not silent else f"{silent} runs are silently wrong"
    return (
        f"{first}: of {sum(found.values())} runs {found['fine']} are fine, {found['inaccurate']} say what "
        f"limits them, {found['refused']} are refused and {found['caught']} fail and are caught."
    )


def statements(table: pd.DataFrame) -> list[str]:
    """Return what breaks first: by method, and each run that is silently wrong."""
    rows = rows_of(table.loc[table["verdict"] != "n/a"])
    lines = [
        f"Silently wrong: {row['method']}, {row['extreme']} {row['value']}: an error of {_error(row)} while "
        f"the reference holds, and no word about it (backed by {row['backed_by'] or row['message']})."
        for row in rows
        if row["verdict"] == "silent"
    ]
    for method in dict.fromkeys(row["method"] for row in rows):
        own = [row for row in rows if row["method"] == method]
        fine = [row for row in own if row["verdict"] == "fine"]
        broken = dict.fromkeys(row["extreme"] for row in own if row["verdict"] != "fine")
        worst = max((row["error"] for row in fine), default=math.nan)
        lines.append(
            f"{method}: {len(fine)} of {len(own)} fine, with errors of {worst:.0e} at most"
            + (f"; not fine at extremes of {', '.join(broken)}." if broken else ".")
        )
    return lines


def _error(row: dict[str, Any]) -> str:
    return f"{row['error']:.0e}" if math.isfinite(row["error"]) else "unknown size"


def cell(row: dict[str, Any] | None) -> str:
    """Return the words of a cell."""
    if row is None or row["verdict"] == "n/a":
        return ""
    word = WORDS[row["verdict"]]
    if not math.isfinite(row["error"]):
        return word
    return f"{word} {row['error']:.0e}" if row["error"] else f"{word} 0"


def matrix(table: pd.DataFrame) -> tuple[tuple[str, ...], list[tuple[str, list[dict[str, Any] | None]]]]:
    """Return the methods, and for each condition its name and the row of each method."""
    rows = rows_of(table)
    methods = tuple(dict.fromkeys(row["method"] for row in rows))
    found: dict[str, dict[str, dict[str, Any]]] = {}
    for row in rows:
        found.setdefault(f"{row['extreme']}: {row['value']}", {})[row["method"]] = row
    return methods, [(name, [own.get(method) for method in methods]) for name, own in found.items()]
