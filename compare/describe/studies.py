"""What a folder of a study holds, from its files alone: limits, speed against accuracy, extremes."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from ..storage.origin import Origin
from ..studies.extremes import read_extremes
from ..studies.tradeoff import read_tradeoff
from ..studies.validity import PARTS, read_validity
from ..studies.validity.campaign import KEPT


def describe_validity(path: Path) -> dict[str, Any]:
    """Return what a report on the limits is made from."""
    found = read_validity(path)
    inputs = {
        "extent": found.extent.name,
        "motions of the maps": "; ".join(found.motions.values()),
        "ensemble": f"{found.extent.members} {found.records}",
    }
    figures = [{"run": part.title, "rows": len(found.tables[part.name])} for part in PARTS]
    runs = sum(row["rows"] for row in figures if isinstance(row["rows"], int))
    return _described("a report on the limits of the reduced model", runs, found.origin, inputs, figures)


def describe_unfinished_validity(path: Path) -> dict[str, Any]:
    """Return how far the measurements of the limits are."""
    return {
        "kind": "a report on the limits of the reduced model that is not finished",
        "complete": False,
        "runs_finished": len(list((path / KEPT).glob("*.json"))),
        "inputs": {},
        "versions": {},
        "figures": [],
    }


def describe_tradeoff(path: Path) -> dict[str, Any]:
    """Return what was measured of speed against accuracy."""
    found = read_tradeoff(path)
    titles = dict(zip(found.problems["problem"], found.problems["title"], strict=True))
    figures = [
        {
            "run": f"{titles[problem]}, {model}",
            "points": len(rows),
            "lines": rows["line"].nunique(),
            "least error": _number(rows["error"].min()),
            "slowest, times the reduced model": _number(rows["ratio"].max()),
        }
        for (problem, model), rows in found.points.groupby(["problem", "model"], sort=False)
    ]
    inputs = {
        "rounds": found.rounds,
        "load before, after": [round(each, 1) for each in found.load if math.isfinite(each)],
    }
    return _described(
        "a measurement of speed against accuracy", len(found.points), found.origin, inputs, figures
    )


def describe_extremes(path: Path) -> dict[str, Any]:
    """Return the verdicts of a scan of the extremes."""
    found = read_extremes(path)
    table = found.table.loc[found.table["verdict"] != "n/a"]
    verdicts = [str(name) for name in table["verdict"].unique()]
    figures = [
        {
            "run": method,
            "runs": len(rows),
            **{name: int((rows["verdict"] == name).sum()) for name in verdicts},
        }
        for method, rows in table.groupby("method", sort=False)
    ]
    inputs = {"extremes": [str(name) for name in table["extreme"].unique()]}
    outcomes = {name: int((table["verdict"] == name).sum()) for name in verdicts}
    return _described("a scan of the extremes", len(table), found.origin, inputs, figures) | {
        "outcomes": outcomes
    }


def _described(
    kind: str, runs: int, origin: Origin, inputs: dict[str, Any], figures: list[dict[str, Any]]
) -> dict[str, Any]:
    made = {"command": origin.command, "made on": origin.date, "processor": origin.processor}
    return {
        "kind": kind,
        "complete": True,
        "runs": runs,
        "inputs": made | inputs,
        "versions": dict(origin.versions),
        "figures": figures,
    }


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
