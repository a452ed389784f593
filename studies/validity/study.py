"""The measurements of all parts: side by side, kept as they are finished, and never repeated."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
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

from ..plans import ValidityPlan
from ..study import Study
from .findings import findings_of
from .limits import limits_of, records
from .measurements import (
    CONTACT,
    FOLLOWING,
    FREE_RESPONSE,
    PEAKS,
    RECORDS,
    RINGS,
    SLIP,
    VERIFICATION,
)
from .plan import (
    ALONE,
    FULL,
    QUICK,
    Extent,
    Inputs,
    Part,
    Structure,
    motion_named,
    record_names,
    release_case,
    shaken_case,
    source_of,
)

PARTS: Mapping[str, Part] = {
    part.name: part for part in (FREE_RESPONSE, VERIFICATION, PEAKS, SLIP, RINGS, CONTACT, FOLLOWING, RECORDS)
}
KIND = "validity"
Task = tuple[str, Inputs]  # name of a part, and what is measured
_ENDS = {
    "least": "least median",
    "largest": "largest median",
    "95_least": "least of what 95 % of the records do not exceed",
    "95_largest": "largest of what 95 % of the records do not exceed",
}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Validity(Results, kind=KIND):
    """Measurements of the limits of the reduced model.

    Attributes
    ----------
    free_response, verification, ... : DataFrame
        What each of `PARTS` measured; every table ends with slab_mass_ratio, tendon_prestress and
        tendon_stiffness, where they are not 0.
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
        return findings_of(limits_of(self.tables), self.structure)

    def headline(self) -> dict[str, Number]:
        """Return the ratios of the peaks of the engine to those of the model, over the records."""
        numbers = records(self.tables)
        return {
            f"peak {support.place} over that of the model, {what}": numbers[f"{support}_{end}"]
            for support in RECESSES_FIRST
            for end, what in _ENDS.items()
            if f"{support}_{end}" in numbers  # no recess with clearance takes a slab
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
    structure = extent.structure
    own = {} if structure == ALONE else {"structure": structure}
    parts = {name: part for name, part in PARTS.items() if not (structure.slab_mass_ratio and part.walls)}
    tasks: list[Task] = [
        (name, {**inputs, **own}) for name, part in parts.items() for inputs in part.tasks(extent)
    ]
    return MeasureStudy(parts, tasks).run(folder=folder, workers=workers, progress=progress)


@dataclass(frozen=True)
class MeasureStudy(Study[Task, dict[str, pd.DataFrame]]):
    """Measurements of the parts, task by task; its results are the table of each part."""

    kind: ClassVar[str] = KIND
    cost: ClassVar[Callable[[Task], float] | None] = staticmethod(lambda task: PARTS[task[0]].cost(**task[1]))
    parts: Mapping[str, Part]
    measured: Sequence[Task]

    def tasks(self) -> Sequence[Task]:
        """Tasks of all parts."""
        return self.measured

    @staticmethod
    def row(task: Task) -> pd.DataFrame:
        """Rows of a task."""
        name, inputs = task
        part = PARTS[name]
        point = {key: inputs[key] for key in part.keys}
        return pd.DataFrame([point | row for row in part.measure(**inputs)])

    def key(self, task: Task) -> str:
        """Hash of what the table of a task depends on."""
        part = PARTS[task[0]]
        return result_fingerprint({"part": part.name, "inputs": task[1]}, _makers(part))

    def name(self, task: Task) -> str:
        """Name of the part of the report."""
        return task[0].replace("_", " ")

    def results(self, tables: list[pd.DataFrame]) -> dict[str, pd.DataFrame]:
        """Table of each part."""
        made: dict[str, list[pd.DataFrame]] = {name: [] for name in self.parts}
        for (name, _), table in zip(self.measured, tables, strict=True):
            made[name].append(table)
        return {name: pd.concat(own, ignore_index=True) for name, own in made.items()}


def validity_of(tables: Mapping[str, pd.DataFrame], extent: Extent) -> Validity:
    """Return the results of what was measured here."""
    limits = pd.DataFrame(
        [
            {"limit": limit, "number": number, "value": value}
            for limit, numbers in limits_of(tables).items()
            for number, value in numbers.items()
        ]
    )
    facts = {
        "extent": extent.name,
        "records": source_of(record_names(extent.members)),
        **asdict(extent.structure),
    }
    stated = {name: value for name, value in asdict(extent.structure).items() if value}
    found = {name: table.assign(**stated) for name, table in {**tables, "limits": limits}.items()}
    return Validity(tables=found, facts=facts)


def _makers(part: Part) -> dict[str, str]:
    """Versions and code on which a part depends."""
    module = sys.modules[part.measure.__module__]
    engine = engine_makers(part.engine) if part.engine else {}
    return {
        **reduced_makers(),
        **engine,
        # fields of the plan that state a problem; their number is no part of it
        f"code of {part.name}": source_digest(module, Structure, release_case, motion_named, shaken_case),
        "records": source_of(record_names(1)),
    }
