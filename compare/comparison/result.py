"""What a comparison found, and its files."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble.models import Case

from ..storage.files import replace_files
from ..storage.fingerprint import fingerprint
from ..storage.parquet_file import pack
from ..storage.provenance import about_results
from ..storage.stored_trace import stored
from ..traces.pair import Trace
from .error_budget import ErrorBudget
from .file import RESTORE, ComparisonFields, load_comparison, restore_bytes

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Comparison:
    """Runs of engines held against reduced models.

    Parameters
    ----------
    summary : DataFrame
        One row for each run and reference; the columns are those of `SUMMARY_COLUMNS`.
    cases : dict
        Case of each name.
    responses : dict
        Response of the reduced model for each (case name, model name).
    trajectories : dict
        Trajectory of the engine for each (case name, label of the run), such as
        ("El Centro 1940", "mujoco recess"). A run whose process died is left out.
    versions : dict
        Version of each package and engine that took part.
    until : float or None
        End of the window of the RMS columns, in the time of the run [s]; None is the whole run.
    budgets : dict
        Error budget for each (case, label of the run, reduced model), where it was asked for.
    """

    summary: pd.DataFrame
    cases: Mapping[str, Case]
    responses: Mapping[tuple[str, str], Any]
    trajectories: Mapping[tuple[str, str], Any]
    versions: Mapping[str, str]
    until: float | None = None
    budgets: Mapping[tuple[str, str, str], ErrorBudget] = field(default_factory=dict)

    def save(self, folder: str | Path) -> None:
        """Write the results to `folder`: whole files or none, other files there are left alone.

        summary.csv is the summary; responses.parquet and trajectories.parquet hold the samples,
        passes.parquet the passes, excitation.parquet the ground motions, and
        comparison.json the cases and the versions.

        Raises
        ------
        ValueError
            If the folder cannot be written.
        """
        replace_files(folder, self.files())

    @classmethod
    def load(cls, folder: str | Path) -> Comparison:
        """Return the comparison that was saved in `folder`, without running anything.

        Responses and trajectories are `StoredTrace`: what was sampled and measured, with the same bits, under
        the same names.

        Raises
        ------
        ValueError
            If the folder holds no comparison.
        """
        return cls(**load_comparison(folder))

    def files(self) -> dict[str, bytes]:
        """Return name and content of each file that `save` writes."""
        found = {
            "summary.csv": self.summary.to_csv(index=False).encode(),
            "summary.parquet": self._pack(self.summary),
            "responses.parquet": self._pack(_stacked(self.responses, "model")),
            "trajectories.parquet": self._pack(_stacked(self.trajectories, "run")),
            "passes.parquet": self._pack(self._passes()),
            "excitation.parquet": self._pack(self._excitation()),
            "comparison.json": (json.dumps(self._about(), indent=2, allow_nan=False) + "\n").encode(),
            RESTORE: restore_bytes(self._fields()),
        }
        return found | ({"budget.parquet": self._pack(self._budget())} if self.budgets else {})

    def _fields(self) -> ComparisonFields:
        return ComparisonFields(
            summary=self.summary,
            cases=self.cases,
            responses=self.responses,
            trajectories=self.trajectories,
            versions=self.versions,
            until=self.until,
            budgets=self.budgets,
        )

    def _budget(self) -> pd.DataFrame:
        import pandas as pd

        tables = []
        for (case, label, model), budget in self.budgets.items():
            table = budget.to_frame()
            for place, (name, value) in enumerate((("case", case), ("run", label), ("reference", model))):
                table.insert(place, name, value)
            tables.append(table)
        whole: pd.DataFrame = pd.concat(tables, ignore_index=True)
        return whole

    def _pack(self, table: pd.DataFrame) -> bytes:
        """Return a table as Parquet that says what made it and from what."""
        inputs = fingerprint([_inputs(case) for case in self.cases.values()])
        return pack(table, about_results("rockwobble comparison", inputs, versions=self.versions))

    def _passes(self) -> pd.DataFrame:
        import pandas as pd

        tables = [
            trace.passes.assign(case=case, run=label)
            for traces in (self.responses, self.trajectories)
            for (case, label), trace in traces.items()
        ]
        passes: pd.DataFrame = pd.concat(tables, ignore_index=True)
        return passes.set_index(["case", "run"]).reset_index()

    def _excitation(self) -> pd.DataFrame:
        import pandas as pd

        tables = []
        for name, case in self.cases.items():
            if case.motion is None:
                continue
            a = case.motion.acceleration
            columns = {"case": name, "time": np.arange(len(a)) * case.motion.time_step}
            columns |= {f"acceleration_{axis}": a[:, i] for i, axis in enumerate("xyz"[: a.shape[1]])}
            tables.append(pd.DataFrame(columns))
        return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame({"case": [], "time": []})

    def _about(self) -> dict[str, Any]:
        return {
            "until": self.until,
            "versions": dict(self.versions),
            "cases": {name: describe_case(case) for name, case in self.cases.items()},
            "responses": _described(self.responses),
            "trajectories": _described(self.trajectories),
        }


def describe_case(case: Case) -> dict[str, Any]:
    """Return the numbers that state a case, for a file or a page; SI units and radians."""
    cylinder, motion, initial = case.cylinder, case.motion, case.initial
    return {
        "semidiagonal": cylinder.semidiagonal,
        "tan_alpha": cylinder.tan_alpha,
        "alpha": cylinder.alpha,
        "base_radius": cylinder.base_radius,
        "height": 2.0 * cylinder.half_height,
        "duration": case.length,
        "gravity": case.gravity,
        "friction": case.friction,
        "motion": None
        if motion is None
        else {
            "name": motion.name,
            "time_step": motion.time_step,
            "samples": len(motion.acceleration),
            "components": int(motion.acceleration.shape[1]),
            "peak": motion.peak,
        },
        "initial": None
        if initial is None
        else {
            "tilt": initial.tilt,
            "tilt_rate": initial.tilt_rate,
            "rolling_angle": initial.rolling_angle,
            "rolling_rate": initial.rolling_rate,
        },
    }


def describe_run(trace: Any) -> dict[str, Any]:
    """Return what there is to know of a run besides its samples, for a file; SI units and radians."""
    names = (
        "model",
        "engine",
        "engine_version",
        "support",
        "time_step",
        "outcome",
        "message",
        "peak_tilt",
        "uplift_time",
        "uplift_direction",
        "contact_resolution",
        "residual_displacement",
        "residual_twist",
        "first_wall_contact",
        "error_estimate",
        "settled_until",
        "wall_time",
    )
    found = {name: getattr(trace, name) for name in names if hasattr(trace, name)}
    plain = {name: _number(value) if isinstance(value, float) else value for name, value in found.items()}
    return plain | ({"settings": dict(trace.settings)} if hasattr(trace, "settings") else {})


def _described(traces: Mapping[tuple[str, str], Any]) -> dict[str, Any]:
    return {f"{case} / {label}": describe_run(trace) for (case, label), trace in traces.items()}


def _number(value: float) -> float | None:
    """JSON knows no NaN."""
    return float(value) if math.isfinite(value) else None


def _stacked(traces: Mapping[tuple[str, str], Trace], name: str) -> pd.DataFrame:
    import pandas as pd

    tables = []
    for (case, label), trace in traces.items():
        table = stored(trace).samples.copy()
        table.insert(0, "case", case)
        table.insert(1, name, label)
        tables.append(table)
    return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame({"case": [], name: []})


def _inputs(case: Case) -> dict[str, Any]:
    """What a case depends on, without the names of it and its motion."""
    motion = case.motion
    return {
        "cylinder": case.cylinder,
        "motion": None if motion is None else (motion.acceleration, motion.time_step),
        "initial": case.initial,
        "length": case.length,
        "gravity": case.gravity,
        "friction": case.friction,
    }
