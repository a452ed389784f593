"""Tables of a study as its page shows them: what rows have in common stands once, above them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Any


def grouped(rows: Iterable[Sequence[Any]]) -> list[tuple[Any, list[Sequence[Any]]]]:
    """Return rows without their first cell, under the first cells of those that follow each other."""
    return [(name, [row[1:] for row in members]) for name, members in groupby(rows, key=lambda row: row[0])]
