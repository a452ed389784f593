"""What limits a run by its own account: slip, flight, walls, energy, passes too close to resolve."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

# parts of a message that say something of the comparison, which other sentences and numbers do
_OF_COMPARISON = ("both overturned", "only ", "neither ", "compared up to ", "not defined here: ")
# what a remark contains, and what it is called where many are counted
_KINDS = {
    "contact slipped": "slipped",
    "left the ground": "left the ground",
    "touched a wall": "touched a wall",
    "holds the rim down": "lost contact but for a joint",
    "of the energy": "lost or gained energy",
    "not converged": "had steps whose solver did not converge",
    "not settled": "did not settle with the time step",
    "closer to upright": "had passes closer to upright than contact resolves",
}


def remark_lines(rows: pd.DataFrame) -> list[str]:
    """Return a sentence for each run of one case that has something to say of itself.

    Parameters
    ----------
    rows : DataFrame
        Of the summary. A run that failed is left out: its finding says why.
    """
    return [f"{run}, by its own account: {remark}." for run, remark in _remarks(rows)]


def counted_remarks(summary: pd.DataFrame) -> list[str]:
    """Return one sentence on how many runs of many cases have which remark; none if no run has any."""
    remarks = [remark for _, remark in _remarks(summary)]
    counts = {name: sum(part in remark for remark in remarks) for part, name in _KINDS.items()}
    said = ", ".join(f"{count} {name}" for name, count in counts.items() if count)
    return (
        [f"By their own account, of the runs {said}; see the column message of summary.csv."] if said else []
    )


def _remarks(summary: pd.DataFrame) -> Iterator[tuple[str, str]]:
    """Yield label and remark of each run that has one, once for each case."""
    for _, row in summary.drop_duplicates(["case", "run"]).iterrows():
        parts = [part for part in row["message"].split("; ") if part and not part.startswith(_OF_COMPARISON)]
        if parts and row["outcome"] != "failed" and row["reference_outcome"] != "failed":
            yield row["run"], "; ".join(parts)
