"""What a folder of results holds, from its files alone."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..runs.run_store import MEMBERS, RUNS
from ..storage.parquet_file import read_about
from ..studies.ensemble.study import TABLE
from ..studies.sweep.store import ABOUT, open_sweep_store
from ..studies.validity.campaign import KEPT
from .ensemble import describe_ensemble, describe_unfinished_ensemble, holds_ensemble
from .studies import (
    describe_extremes,
    describe_tradeoff,
    describe_unfinished_validity,
    describe_validity,
)

if TYPE_CHECKING:
    import pandas as pd

_KINDS = {
    "sweep.json": "a sweep",
    "comparison.json": "a comparison",
    "spectrum.parquet": "an overturning spectrum",
    "run.json": "a single run",
    RUNS: "a comparison that is not finished",
    TABLE: "an ensemble",
}
_STUDIES = {
    "validity.json": describe_validity,
    "tradeoff.json": describe_tradeoff,
    "extremes.json": describe_extremes,
}


def describe_store(folder: str | Path) -> list[dict[str, Any]]:
    """Return what there is in a folder of results, one description for each kind of result.

    Each has "kind", "complete", "runs", "inputs" (what was run, and its hash), "versions", "figures" (the
    main numbers) and, but for studies without them, "outcomes" (how many of each).

    Raises
    ------
    ValueError
        If the folder holds no results, or they cannot be read.
    """
    path = Path(folder)
    if not path.is_dir():
        raise ValueError(f"the store must be a folder of results, got {path}, which is none")
    found = []
    if (path / ABOUT).exists():
        found.append(_sweep(path))
    if (path / "comparison.json").exists():
        found.append(_comparison(path))
    elif (path / RUNS).is_dir():
        found.append(_unfinished(path))
    if (path / "spectrum.parquet").exists():
        found.append(_spectrum(path))
    if (path / "run.json").exists():
        found.append(_run(path))
    if holds_ensemble(path):
        found.append(describe_ensemble(path))
    elif (path / MEMBERS).is_dir():
        found.append(describe_unfinished_ensemble(path))
    found += [describe(path) for file, describe in _STUDIES.items() if (path / file).exists()]
    if (path / KEPT).is_dir() and not (path / "validity.json").exists():
        found.append(describe_unfinished_validity(path))
    if not found:
        files = ", ".join([*_KINDS, *_STUDIES])
        raise ValueError(f"{path} holds no results of rockwobble: a store has one of {files} in it")
    return found


def _sweep(path: Path) -> dict[str, Any]:
    store = open_sweep_store(path)
    about, finished, table = store.about, store.finished(), store.read()
    done = sum(store.rows[key] for key in finished)
    inputs: dict[str, Any] = {"fingerprint": about["inputs"], "plan": about["plan"]}
    if "cases" in about:
        inputs |= {"cases": len(about["cases"]), "methods": [_label(method) for method in about["methods"]]}
    else:
        inputs |= {name: _range(about[name]) for name in ("semidiagonals", "tan_alphas", "scales")}
        inputs |= {
            "motions": [motion["name"] for motion in about["motions"]],
            "models": about["models"],
            "options": about["options"],
        }
    method = "run" if "run" in table else "model"
    figures = [_tilts(name, rows) for name, rows in table.groupby(method, sort=False)] if len(table) else []
    return {
        "kind": _KINDS[ABOUT],
        "complete": done == about["runs"],
        "runs": about["runs"],
        "runs_finished": done,
        "chunks": len(store.keys),
        "chunks_finished": len(finished),
        "chunks_of_another_sweep": len(store.others()),
        "inputs": inputs,
        "seeds": about["seeds"],
        "versions": about["versions"],
        "outcomes": _counts(table),
        "figures": figures,
    }


def _comparison(path: Path) -> dict[str, Any]:
    import pandas as pd

    about = _json(path / "comparison.json")
    summary = pd.read_csv(path / "summary.csv")
    table = path / "summary.parquet"
    figures = [
        {
            "run": f"{engine} {support} against {reference}",
            "rows": len(rows),
            "median relative RMS": _number(rows["tilt_rms_relative"].median()),
            "largest relative RMS": _number(rows["tilt_rms_relative"].max()),
            "diverged": int(rows["diverged"].sum()),
            "median agreement horizon [s]": _number(rows["agreement_time"].median()),
        }
        for (engine, support, reference), rows in summary.groupby(
            ["engine", "support", "reference"], sort=False
        )
    ]
    return {
        "kind": _KINDS["comparison.json"],
        "complete": True,
        "runs": len(about["responses"]) + len(about["trajectories"]),
        "inputs": {
            "fingerprint": read_about(table).get("inputs", "") if table.exists() else "",
            "cases": list(about["cases"]),
        },
        "versions": about["versions"],
        "outcomes": _counts(summary.drop_duplicates(["case", "run"])),
        "figures": figures,
    }


def _unfinished(path: Path) -> dict[str, Any]:
    runs = [read_about(file) for file in sorted((path / RUNS).glob("*.parquet"))]
    outcomes: dict[str, int] = {}
    for run in runs:
        outcome = run["facts"]["outcome"]
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
    versions: dict[str, str] = {}
    for run in runs:
        versions |= run["made with"]
    return {
        "kind": _KINDS[RUNS],
        "complete": False,
        "runs_finished": len(runs),
        "inputs": {
            "cases": list(dict.fromkeys(run["case"] for run in runs)),
            "methods": list(dict.fromkeys(run["label"] for run in runs)),
        },
        "versions": versions,
        "outcomes": outcomes,
        "figures": [],
    }


def _spectrum(path: Path) -> dict[str, Any]:
    import pandas as pd

    file = path / "spectrum.parquet"
    table, about = pd.read_parquet(file), read_about(file)
    return {
        "kind": _KINDS["spectrum.parquet"],
        "complete": True,
        "runs": len(table),
        "inputs": {
            "fingerprint": about.get("inputs", ""),
            "semidiagonals": _range(table["semidiagonal"].unique().tolist()),
            "intensities": _range(table["intensity"].unique().tolist()),
        },
        "versions": about.get("versions", {}),
        "outcomes": {
            "stood": int((table["peak_tilt"] == 0.0).sum()),
            "rocked": int(((table["peak_tilt"] > 0.0) & ~table["overturned"]).sum()),
            "overturned": int(table["overturned"].sum()),
            "failed": int(table["peak_tilt"].isna().sum()),
        },
        "figures": [
            _tilts(series, rows, rows["overturned"]) for series, rows in table.groupby("series", sort=False)
        ],
    }


def _run(path: Path) -> dict[str, Any]:
    about = _json(path / "run.json")
    result = about["result"]
    alpha = about["case"]["alpha"]
    peak = result["peak_tilt"]
    return {
        "kind": _KINDS["run.json"],
        "complete": True,
        "runs": 1,
        "inputs": {
            "fingerprint": about.get("inputs", ""),  # an older file says less
            "run": about["run"],
            "case": about["case"],
        },
        "versions": about.get("versions", {}),
        "outcomes": {result["outcome"]: 1},
        "figures": [{"run": about["run"], "peak tilt / alpha": None if peak is None else peak / alpha}],
    }


def _tilts(name: Any, rows: pd.DataFrame, overturned: pd.Series | None = None) -> dict[str, Any]:
    fallen = rows["outcome"] == "overturned" if overturned is None else overturned
    standing = rows.loc[~fallen, "peak_tilt_over_alpha"]
    return {
        "run": str(name),
        "rows": len(rows),
        "overturned [%]": 100.0 * float(fallen.mean()),
        "median peak tilt / alpha where not": _number(standing.median()),
        "largest": _number(standing.max()),
    }


def _counts(table: pd.DataFrame) -> dict[str, int]:
    if "outcome" not in table:
        return {}
    return {str(name): int(count) for name, count in table["outcome"].value_counts().items()}


def _range(values: list[float]) -> dict[str, Any]:
    return {"from": min(values), "to": max(values), "count": len(values)}


def _label(method: str | Mapping[str, Any]) -> str:
    return method if isinstance(method, str) else str(method["label"])


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _json(path: Path) -> dict[str, Any]:
    try:
        found: dict[str, Any] = json.loads(path.read_bytes())
    except ValueError as error:
        raise ValueError(f"{path} cannot be read: {error}") from None
    return found
