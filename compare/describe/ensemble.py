"""What a folder of an ensemble holds, from its files alone."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from ..runs.run_store import MEMBERS
from ..storage.origin import read_table
from ..storage.parquet_file import read_about
from ..studies.ensemble.study import KIND, TABLE
from ..studies.ensemble.tables import method_table


def holds_ensemble(path: Path) -> bool:
    """Return whether there is a finished ensemble: another table may have the same name."""
    file = path / TABLE
    return file.is_file() and read_about(file).get("kind") == KIND


def describe_ensemble(path: Path) -> dict[str, Any]:
    """Return what an ensemble was made of, and the distributions of its methods."""
    table, about = read_table(path / TABLE), read_about(path / TABLE)
    figures = []
    for row in method_table(table, dict.fromkeys(table["method"].unique(), "")).to_dict("records"):
        rows = table[(table["method"] == row["method"]) & ~table["outcome"].isin(["overturned", "failed"])]
        known = row["runs"] - row["failed"]
        figures.append(
            {
                "run": row["method"],
                "rows": row["runs"],
                "failed": row["failed"],
                "overturned [%]": 100.0 * row["overturned"] / known if known else None,
                "median peak tilt / alpha": _median(row["peak_median"]),
                "largest where not overturned": _number(rows["peak_tilt"].max()),
            }
        )
    inputs = {"fingerprint": about["inputs"], "members": f"{table['member'].nunique()}: {about['members']}"}
    names = ("perturbation", "semidiagonal", "tan_alpha")
    return {
        "kind": "an ensemble",
        "complete": True,
        "runs": len(table),
        "inputs": inputs | {name: about[name] for name in names if name in about},
        "seeds": about["seeds"],
        "versions": about["versions"],
        "outcomes": {str(name): int(count) for name, count in table["outcome"].value_counts().items()},
        "figures": figures,
    }


def describe_unfinished_ensemble(path: Path) -> dict[str, Any]:
    """Return how far an ensemble is."""
    runs = [read_about(file) for file in sorted((path / MEMBERS).glob("*.parquet"))]
    outcomes: dict[str, int] = {}
    versions: dict[str, str] = {}
    for run in runs:
        outcome = run["facts"]["outcome"]
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
        versions |= run["made with"]
    return {
        "kind": "an ensemble that is not finished",
        "complete": False,
        "runs_finished": len(runs),
        "inputs": {"methods": list(dict.fromkeys(run["label"] for run in runs))},
        "versions": versions,
        "outcomes": outcomes,
        "figures": [],
    }


def _median(value: float) -> float | str | None:
    return "overturned" if value == math.inf else _number(value)


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
