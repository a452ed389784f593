"""Measurements of all parts, run in parallel and cached."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from functools import cache
from pathlib import Path
from typing import ClassVar

import pandas as pd

from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.provenance import (
    engine_makers,
    reduced_makers,
    result_fingerprint,
    source_digest,
)
from rockwobble.compare.storage.results import Results
from rockwobble.models.finding import Findings
from rockwobble.models.support import RECESSES_FIRST
from rockwobble.multibody import DEFAULT_ENGINE

from ..plans import ValidityPlan
from ..study import Study
from . import measurements
from . import plan as problems
from .limits import contrasts, findings_of, limits_of
from .measurements import PARTS, Task, tasks_of
from .plan import FULL, QUICK, Extent, Structure, record_names, source_of

KIND = "validity"
# of the contrasts over the points: column and end
_ENDS = {
    "least median": ("ratio", "min"),
    "largest median": ("ratio", "max"),
    "least of what 95 % of the records do not exceed": ("ratio_95", "min"),
    "largest of what 95 % of the records do not exceed": ("ratio_95", "max"),
}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Validity(Results, kind=KIND):
    """Measurements of the limits of the reduced model.

    Attributes
    ----------
    free_response, verification, ... : DataFrame
        What each of `PARTS` measured; every table ends with tendon_prestress, tendon_stiffness and
        slab_mass_ratio, where they are not 0.
    limits : DataFrame
        Every number of every limit, see `limits_of`: limit, number, value.

    Its facts are the extent, what the ground motions are, the mass of the slab over that of the column, and
    prestress and stiffness of a tendon.
    """

    @property
    def structure(self) -> Structure:
        """Slab and tendon of every column."""
        return Structure(**{each.name: self.facts.get(each.name, 0.0) for each in fields(Structure)})

    def findings(self) -> Findings:
        """Findings of the limits."""
        return findings_of(self.tables, self.structure)

    def headline(self) -> dict[str, Number]:
        """Ratios of the engine's peaks to the model's, over the records."""
        by_method = dict(iter(contrasts(self.tables).groupby("method")))
        return {
            f"peak {support.place} over that of the model, {what}": float(by_method[support][name].agg(end))
            for support in RECESSES_FIRST
            for what, (name, end) in _ENDS.items()
            if support in by_method  # no recess with clearance takes a slab
        }

    def _main_facts(self) -> dict[str, str]:
        return {"motions": self.facts["records"]} | {
            name: f"{len(table)} rows" for name, table in self.tables.items()
        }


def measure_validity(
    folder: str | Path,
    plan: ValidityPlan,
    *,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> Validity:
    """Measure the limits of the reduced model; for arguments and errors see `measure_all` and `Extent.of`."""
    structure = Structure(**{each.name: getattr(plan, each.name) for each in fields(Structure)})
    extent = (QUICK if plan.quick else FULL).of(structure)
    return validity_of(measure_all(extent, folder, workers=workers, progress=progress), extent)


def measure_all(
    extent: Extent,
    folder: str | Path,
    *,
    workers: int | None = None,
    progress: ProgressCallback | None = None,
) -> dict[str, pd.DataFrame]:
    """Measure every part (with a slab, only those without walls), and return the tables by name.

    Parameters
    ----------
    extent : Extent
    folder : str or Path
        Keeps each finished task, named by a hash of its inputs, the versions and the code: a second call,
        after whatever ended the first, repeats none that is there.
    workers : int, optional
        Processes; 1 measures in this one. Default: one for each processor.
    progress : callable, optional
        Called with a `Progress` at the start and the end of each task.

    Raises
    ------
    ValueError
        If nothing can be written there, or another process does.
    IncompleteError
        If a process ended in a task; what was finished is kept.
    """
    return MeasureStudy(tasks_of(extent)).run(folder=folder, workers=workers, progress=progress)


@dataclass(frozen=True)
class MeasureStudy(Study[Task, dict[str, pd.DataFrame]]):
    """Measurements of the parts as a study; its results are the table of each part."""

    kind: ClassVar[str] = KIND
    measured: Sequence[Task]

    def tasks(self) -> Sequence[Task]:
        """Tasks of all parts."""
        return self.measured

    @staticmethod
    def row(task: Task) -> pd.DataFrame:
        """Rows of a task."""
        part, point, inputs = task
        return pd.DataFrame([{**point, **row} for row in PARTS[part](**point, **inputs)])

    def key(self, task: Task) -> str:
        """Hash of what the table of a task depends on."""
        return result_fingerprint(task, _makers())

    def name(self, task: Task) -> str:
        """Name of the part of the report."""
        return task[0].replace("_", " ")

    def results(self, tables: list[pd.DataFrame]) -> dict[str, pd.DataFrame]:
        """Table of each part."""
        by_part: dict[str, list[pd.DataFrame]] = {}
        for (part, *_), table in zip(self.measured, tables, strict=True):
            by_part.setdefault(part, []).append(table)
        return {part: pd.concat(each, ignore_index=True) for part, each in by_part.items()}


def validity_of(tables: Mapping[str, pd.DataFrame], extent: Extent) -> Validity:
    """Results from the measured tables."""
    stated = asdict(extent.structure)
    source = source_of(record_names(1)[0])
    terms = {name: value for name, value in stated.items() if value}
    every = {**tables, "limits": limits_of(tables, extent.structure)}
    return Validity(
        tables={name: table.assign(**terms) for name, table in every.items()},
        facts={"extent": extent.name, "records": source, **stated},
    )


@cache
def _makers() -> dict[str, str]:
    """Versions and code on which the parts depend."""
    return {
        **reduced_makers(),
        **engine_makers(DEFAULT_ENGINE),
        "code of the measurements": source_digest(measurements, problems),
        "records": source_of(record_names(1)[0]),
    }
