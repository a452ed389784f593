"""Findings on an external trajectory: numbers for a table, and sentences made from codes."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from rockwobble.compare.external.trajectory import SUPPORT as EXTERNAL
from rockwobble.compare.external.verdict import mistakes_of
from rockwobble.models import AGREEMENT

from ...figures.comparison.view import rows_of
from ..table import Row
from ..words.sentences import sentence

WORDS = "comparison/external.md.j2"


def found_in(row: Any) -> dict[str, object]:
    """Return what the codes of a row of an external trajectory say.

    Returns
    -------
    dict
        row, of the summary; differs and left, parts that differ, and that still do without the mistake;
        agrees and wrong, what does and does not besides the tilt; mistakes, in words; explained, whether
        they explain a divergence of the tilts.
    """
    differs = row.differs_in
    known = [part for part in ("azimuth", "path") if math.isfinite(getattr(row, f"{part}_rms"))]
    return {
        "row": row,
        "differs": differs,
        "left": row.differs_without_mistake,
        "agrees": [part for part in known if part not in differs],
        "wrong": [part for part in differs if part != "tilt"],
        "mistakes": [mistake.words for mistake in mistakes_of(row)],
        "explained": explains_divergence(row),
    }


def explains_divergence(row: Any) -> bool:
    """Whether a likely mistake is a reason for the tilts to diverge: a turn of the axes is none."""
    return any(mistake.changes_tilt for mistake in mistakes_of(row))


def within(row: Any) -> str:
    """Return what agreement of the tilts means for a run."""
    noise = row.tilt_bound - AGREEMENT if row.support == EXTERNAL else 0.0
    return sentence(WORDS, "within", row.tolerance, noise, AGREEMENT)


def scope(row: Any) -> str:
    """Return what of an external trajectory agrees while the tilts do, and what does not, for a headline."""
    return sentence(WORDS, "scope", found_in(row))


def external_sentences(row: Any) -> str:
    """Return the sentences on azimuth, path, uplift and likely mistakes of an external trajectory."""
    return sentence(WORDS, "sentences", found_in(row))


def external_rows(summary: pd.DataFrame) -> list[Row]:
    """Return one line of numbers and codes for each external trajectory."""
    return [
        {
            **row._asdict(),
            "uplift": row.uplift_time_difference if math.isfinite(row.uplift_time_uncertainty) else None,
            "towards": _degrees(row.uplift_direction_difference, row.uplift_direction_uncertainty),
            "towards_uncertainty": _degrees(
                # beyond half a turn there is nothing left to tell
                min(row.uplift_direction_uncertainty, math.pi),
                row.uplift_direction_uncertainty,
            ),
            "differs_in": "; ".join(row.differs_in) or None,
            "likely_mistake": "; ".join(
                f"{part}: {code}"
                for part, code in zip(row.likely_mistake_in, row.likely_mistake, strict=True)
            )
            or None,
        }
        for row in rows_of(summary[summary["support"] == EXTERNAL])
    ]


def _degrees(angle: float, uncertainty: float) -> float | None:
    return math.degrees(angle) if math.isfinite(uncertainty) else None
