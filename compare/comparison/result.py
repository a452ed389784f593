"""Result of a comparison, and its files."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from rockwobble.models import Case, Trace, plain_json
from rockwobble.models.number_checks import require_one_of
from rockwobble.models.shown import Shown

from ..external.verdict import lists_in_words
from ..metrics.order_statistics import stated
from ..runs.execution import case_inputs
from ..storage.fingerprint import fingerprint
from ..storage.manifest import Manifest, made_now, read_results, write_results
from .error_budget import ErrorBudget
from .file import ABOUT, load_fields, plain_fields
from .matrix import agreement_matrix

KIND = "comparison"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Comparison(Shown):
    """Runs held against reference models, or against one another.

    Parameters
    ----------
    summary : DataFrame
        One row for each run and reference; the columns are those of `SUMMARY_COLUMNS`. What differs of an
        external trajectory, and the likely mistakes in it, are tuples.
    cases : dict
        Case of each name.
    traces : dict
        Trace for each (case name, label), of runs and references, such as ("El Centro 1940",
        "mujoco recess") and ("El Centro 1940", "recess model"). One whose process died has no samples.
    versions : dict
        Version of each package and engine that took part.
    until : float or None
        End of the window of the RMS columns, in the time of the run [s]; None is the whole run.
    budgets : dict
        Error budget for each (case, label of the run, label of the reference), where it was asked for.
    command : str
        That asked for what was loaded.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> comparison = rw.compare(case, runs=[rw.Run(None, "flat")], workers=1)
    >>> comparison.summary[["run", "reference", "diverged"]].to_dict("records")[0]
    {'run': 'flat-ground model', 'reference': 'recess model', 'diverged': False}
    >>> sorted(comparison.traces)
    [('free response', 'flat-ground model'), ('free response', 'recess model')]
    """

    summary: pd.DataFrame
    cases: Mapping[str, Case]
    traces: Mapping[tuple[str, str], Trace]
    versions: Mapping[str, str]
    until: float | None = None
    budgets: Mapping[tuple[str, str, str], ErrorBudget] = field(default_factory=dict)
    command: str = ""

    def save(
        self,
        folder: str | Path,
        *,
        command: str = "",
        pages: Mapping[str, bytes] | None = None,
        manifest: Manifest | None = None,
    ) -> None:
        """Write the results to `folder`: whole files or none, other files there are left alone.

        summary.csv and summary.parquet are the summary, matrix.csv says who agrees with whom; traces.parquet
        holds the samples of runs and references, passes.parquet the passes, excitation.parquet the ground
        motions, budget.parquet the error budgets, comparison.json the rest, and manifest.json says what made
        them.

        Parameters
        ----------
        folder : str or Path
        command : str, optional
            That asked for the comparison.
        pages : mapping, optional
            Name and content of what was drawn of it.
        manifest : Manifest, optional
            Of results that hold a comparison and are more than one. Default: its own.

        Raises
        ------
        ValueError
            If the folder cannot be written.
        """
        whole = plain_fields(self.cases, self.traces, self.versions, self.until, self.budgets)
        files = {
            "summary.csv": lists_in_words(self.summary).to_csv(index=False).encode(),
            ABOUT: (plain_json.dumps(whole, indent=1) + "\n").encode(),
        }
        if len(matrix := self.matrix()):
            files["matrix.csv"] = matrix.to_csv(index=False).encode()
        made = manifest or self.manifest(command or self.command)
        write_results(folder, made, self._tables(), files=files, pages=pages)

    def of_case(self, name: str) -> Comparison:
        """Return the part on one case.

        Parameters
        ----------
        name : str

        Returns
        -------
        Comparison

        Raises
        ------
        ValueError
            If there is no such case.
        """
        require_one_of("case", name, self.cases)
        return dataclasses.replace(
            self,
            summary=self.summary[self.summary["case"] == name].reset_index(drop=True),
            cases={name: self.cases[name]},
            traces={key: trace for key, trace in self.traces.items() if key[0] == name},
            budgets={key: budget for key, budget in self.budgets.items() if key[0] == name},
        )

    def manifest(self, command: str = "") -> Manifest:
        """Return the manifest: what made the comparison, and its main numbers.

        Parameters
        ----------
        command : str, optional
            That asked for it.

        Returns
        -------
        Manifest
        """
        relative, agreed = self.summary["tilt_rms_relative"], self.summary["agreement_time"]
        return made_now(
            KIND,
            inputs=fingerprint([case_inputs(case) for case in self.cases.values()]),
            command=command,
            versions=self.versions,
            headline={
                "cases": len(self.cases),
                "rows": len(self.summary),
                "diverged": int(self.summary["diverged"].sum()),
                "failed": int((self.summary["outcome"] == "failed").sum()),
                "median of the relative RMS": _number(stated(relative.median(), int(relative.notna().sum()))),
                "largest relative RMS": _number(relative.max()),
                "median agreement time [s]": _number(stated(agreed.median(), len(agreed))),
            },
        )

    @classmethod
    def load(cls, folder: str | Path) -> Comparison:
        """Return the comparison that was saved in `folder`, without running anything.

        Parameters
        ----------
        folder : str or Path

        Returns
        -------
        Comparison

        Raises
        ------
        ValueError
            If the folder holds no comparison, or a file is missing or damaged.
        """
        stored = read_results(folder, KIND)
        return cls(**load_fields(stored), command=stored.manifest.command)

    def matrix(self) -> pd.DataFrame:
        """Return the differences of each motion from every other on its support, where two engines have run.

        The columns are those of `rockwobble.compare.comparison.matrix.MATRIX_COLUMNS`.
        """
        return agreement_matrix(self.cases, self.traces, until=self.until)

    def _tables(self) -> dict[str, pd.DataFrame]:
        run = ["case", "run"]
        known = {
            key: trace for key, trace in self.traces.items() if len(trace.time)
        }  # the process of others died
        tables = {
            "summary": self.summary,
            "traces": _stacked({key: trace.to_frame() for key, trace in known.items()}, run),
            "passes": _stacked({key: trace.passes for key, trace in known.items()}, run),
            "excitation": self._excitation(),
        }
        if self.budgets:
            parts = {key: budget.to_frame() for key, budget in self.budgets.items()}
            tables["budget"] = _stacked(parts, [*run, "reference"])
        return tables

    def _said(self) -> dict[str, str]:
        diverged = int(self.summary["diverged"].sum())
        return {"cases": str(len(self.cases)), "rows": str(len(self.summary)), "diverged": str(diverged)}

    def _repr_html_(self) -> str:
        names = ["case", "run", "reference", "outcome", "peak_tilt", "tilt_rms_relative", "agreement_time"]
        return str(self.summary[[*names, "diverged", "diagnostics"]].to_html(index=False))

    def _excitation(self) -> pd.DataFrame:
        tables = []
        for name, case in self.cases.items():
            if case.motion is None:
                continue
            a = case.motion.acceleration
            columns = {"case": name, "time": np.arange(len(a)) * case.motion.time_step}
            columns |= {f"acceleration_{axis}": a[:, i] for i, axis in enumerate("xyz"[: a.shape[1]])}
            tables.append(pd.DataFrame(columns))
        return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame({"case": [], "time": []})


def _stacked(
    tables: Mapping[tuple[str, str], pd.DataFrame] | Mapping[tuple[str, str, str], pd.DataFrame],
    names: list[str],
) -> pd.DataFrame:
    """One table below the other, each with its key in the first columns."""
    return pd.concat(tables, names=names).reset_index(names).reset_index(drop=True)


def describe_case(case: Case) -> dict[str, object]:
    """Return the numbers that state a case, for a file or a page; SI units and radians.

    Parameters
    ----------
    case : Case

    Returns
    -------
    dict
        Names and numbers.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> found = describe_case(case)
    >>> found["friction"], found["gravity"]
    (1.0, 9.81)
    """
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
        "rolling_resistance": case.rolling_resistance,
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


def _number(value: float) -> float | None:
    """JSON knows no NaN."""
    return float(value) if math.isfinite(value) else None
