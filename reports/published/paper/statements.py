"""Statements of the paper on its figures, compared with the numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from rockwobble.models import Cylinder

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
HOLDS, HOLDS_IN_PART, DOES_NOT_HOLD = "holds", "holds in part", "does not hold"


@dataclass(frozen=True, slots=True, kw_only=True)
class Statement:
    """A statement of the paper on one of its figures; the words stand in page.md.j2."""

    figure: int
    name: str
    numbers: Mapping[str, float]
    verdict: str


def verdict_of(*parts: bool) -> str:
    """Verdict on a statement with several parts."""
    if all(parts):
        return HOLDS
    return HOLDS_IN_PART if any(parts) else DOES_NOT_HOLD


def to_frame(statements: Sequence[Statement]) -> pd.DataFrame:
    """Return one row for each number: figure, statement, verdict, number, value."""
    rows = [
        (each.figure, each.name, each.verdict, number, float(value))
        for each in statements
        for number, value in each.numbers.items()
    ]
    return pd.DataFrame(rows, columns=["figure", "statement", "verdict", "number", "value"])


def from_frame(table: pd.DataFrame) -> list[Statement]:
    """Statements of the table of `to_frame`."""
    entries = []
    for name, rows in table.groupby("statement", sort=False):
        first, numbers = rows.iloc[0], dict(zip(rows["number"], rows["value"].astype(float), strict=True))
        entries.append(
            Statement(
                figure=int(first["figure"]), name=str(name), numbers=numbers, verdict=str(first["verdict"])
            )
        )
    return entries
