"""The measurements of all parts: side by side, kept as they are finished, and never repeated."""

from __future__ import annotations

import hashlib
import os
import queue
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockwobble.models import plain_json

from ...runs.process_pool import ProcessPool
from ...storage.files import remove_leftovers, sole_writer, write_whole
from ...storage.fingerprint import fingerprint
from ...storage.parquet_file import pack
from ...storage.provenance import engine_makers, reduced_makers
from .extent import Extent
from .motions import ensemble_names, source_of
from .part import Inputs, Part, Row
from .parts import PARTS, part_named

if TYPE_CHECKING:
    import pandas as pd

KEPT = "measured"


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignProgress:
    """How far the measurements are.

    Attributes
    ----------
    title : str
        Of the part whose task has ended last.
    done, total, found : int
        Tasks: finished, those found included; in all; found in the folder.
    share : float
        Of the computing time of what was not found, as far as it is known beforehand.
    """

    title: str
    done: int
    total: int
    found: int
    share: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Task:
    part: Part
    inputs: Inputs
    name: str


def measure_all(
    extent: Extent,
    folder: str | Path,
    *,
    parts: Sequence[Part] = PARTS,
    workers: int | None = None,
    progress: Callable[[CampaignProgress], None] | None = None,
) -> dict[str, pd.DataFrame]:
    """Measure every part, and return its table by its name.

    Parameters
    ----------
    extent : Extent
    folder : str or Path
        Keeps each finished task in `measured`, named by a hash of its inputs, the versions and the code:
        a second call, after whatever ended the first, repeats none that is there.
    parts : sequence of Part, optional
    workers : int, optional
        Processes; 1 measures in this one. Default: one for each core.
    progress : callable, optional
        Called with a `CampaignProgress` at the start and after each task.

    Raises
    ------
    ValueError
        If nothing can be written there, or another process does.
    WorkerDiedError
        If a process ended in a task; what was finished is kept.
    """
    import pandas as pd

    place = Path(folder) / KEPT
    with sole_writer(place):
        remove_leftovers(place)
        tasks = [
            _Task(part=part, inputs=inputs, name=_name(part, inputs))
            for part in parts
            for inputs in part.tasks(extent)
        ]
        rows: dict[str, list[Row]] = {}
        for task in tasks:
            if (path := place / f"{task.name}.json").exists():
                rows[task.name] = plain_json.loads(path.read_bytes())["rows"]
        _measure(tasks, rows, place, workers, progress)
    return {
        part.name: pd.DataFrame([row for task in tasks if task.part is part for row in rows[task.name]])
        for part in parts
    }


def packed(name: str, table: pd.DataFrame, about: dict[str, Any]) -> bytes:
    """Return the table of a part as a Parquet file that says what made it."""
    part = part_named(name)
    return pack(table, {"kind": f"validity: {part.title}", "made with": _makers(part), **about})


def measure_task(part: str, inputs: Inputs) -> list[Row]:
    """Return the rows of one task; a process is told the name of its part."""
    return part_named(part).measure(inputs)


def _measure(
    tasks: Sequence[_Task],
    rows: dict[str, list[Row]],
    place: Path,
    workers: int | None,
    progress: Callable[[CampaignProgress], None] | None,
) -> None:
    waiting = [task for task in tasks if task.name not in rows]
    found, costs = len(tasks) - len(waiting), {task.name: task.part.cost(task.inputs) for task in waiting}
    whole = sum(costs.values())

    def finish(task: _Task, measured: list[Row]) -> None:
        rows[task.name] = measured
        content = {"part": task.part.name, "inputs": dict(task.inputs), "rows": measured}
        write_whole(place / f"{task.name}.json", plain_json.dumps(content).encode())
        tell(task.part.title)

    def tell(title: str) -> None:
        if progress is None:
            return
        left = sum(cost for name, cost in costs.items() if name not in rows)
        share = 1.0 - left / whole if whole > 0.0 else 1.0
        progress(CampaignProgress(title=title, done=len(rows), total=len(tasks), found=found, share=share))

    tell(waiting[0].part.title if waiting else "")
    count = _cores() if workers is None else workers
    if count == 1:
        for task in waiting:
            finish(task, measure_task(task.part.name, task.inputs))
    elif waiting:
        _side_by_side(waiting, count, finish)


def _side_by_side(tasks: Sequence[_Task], workers: int, finish: Callable[[_Task, list[Row]], None]) -> None:
    ended: queue.SimpleQueue[int] = queue.SimpleQueue()
    with ProcessPool(workers) as pool:

        def start(index: int) -> Future[list[Row]]:
            future = pool.submit(measure_task, tasks[index].part.name, tasks[index].inputs)
            future.add_done_callback(lambda _: ended.put(index))
            return future

        futures = [start(index) for index in range(len(tasks))]
        for _ in tasks:
            index = ended.get()
            finish(tasks[index], futures[index].result())


def _name(part: Part, inputs: Inputs) -> str:
    return fingerprint({"part": part.name, "inputs": inputs, "made with": _makers(part)})


def _makers(part: Part) -> dict[str, str]:
    """Return versions and code on which a part depends."""
    spec = find_spec(part.module)
    assert spec is not None
    assert spec.origin is not None
    own = hashlib.sha256(Path(spec.origin).read_bytes()).hexdigest()[:16]
    engine = engine_makers(part.engine) if part.engine else {}
    return {
        **reduced_makers(),
        **engine,
        f"code of {part.name}": own,
        "records": source_of(ensemble_names(1)),
    }


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
