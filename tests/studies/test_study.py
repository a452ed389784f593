"""Base of the studies: order of tables, cache, and tasks whose process died."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

import pandas as pd
import pytest

from rockwobble.compare import IncompleteError
from rockwobble.compare.runs.progress import FailedTask
from rockwobble.compare.runs.scheduler import run_tasks
from rockwobble.compare.storage.claim import CACHE, claim_folder
from rockwobble.studies import study
from rockwobble.studies.study import Study

TASKS = list(range(1, 8))


class Multiples(Study[int, list[int]]):
    """Ten times each number."""

    kind: ClassVar[str] = "study"

    def __init__(self, numbers: list[int] = TASKS, *, known: bool = False) -> None:
        self.numbers, self.known = numbers, known

    def tasks(self) -> list[int]:
        return self.numbers

    @staticmethod
    def row(task: int) -> pd.DataFrame:
        return pd.DataFrame({"multiple": [10 * task]})

    def key(self, task: int) -> str:
        return f"{task:032d}"

    def lost(self, task: int, why: str) -> pd.DataFrame | None:
        return pd.DataFrame({"multiple": [-task]}) if self.known else None

    def results(self, tables: list[pd.DataFrame]) -> list[int]:
        return [int(number) for table in tables for number in table["multiple"]]


@pytest.fixture
def second_dies(monkeypatch: pytest.MonkeyPatch) -> None:
    def losing(function, tasks, **options):
        results = run_tasks(function, tasks, **options)
        return [
            FailedTask("out of memory") if task == 2 else each
            for task, each in zip(tasks, results, strict=True)
        ]

    monkeypatch.setattr(study, "run_tasks", losing)


def kept(folder: Path) -> set[str]:
    return {path.name[:32].lstrip("0") for path in (folder / CACHE / "study").glob("*.parquet")}


def test_tables_are_in_the_order_of_the_tasks_whatever_ran_first(tmp_path):
    whole = [10 * task for task in TASKS]
    assert Multiples().run(workers=1) == whole
    assert Multiples().run(folder=tmp_path, workers=1) == whole
    assert kept(tmp_path) == {str(task) for task in TASKS}


@pytest.mark.usefixtures("second_dies")
def test_lost_task_gets_a_table_or_ends_the_study(tmp_path):
    assert Multiples([1, 2, 3], known=True).run(workers=1) == [10, -2, 30]
    with pytest.raises(IncompleteError, match=r"1 of 3 tasks ended .* the last words of 2: out of memory"):
        Multiples([1, 2, 3]).run(folder=tmp_path, workers=1)
    assert kept(tmp_path) >= {"1", "3"}


def test_cached_tasks_of_another_plan_are_deleted_only_after_saving(tmp_path):
    Multiples([9]).run(folder=tmp_path, workers=1)
    saved: list[list[int]] = []
    with claim_folder(tmp_path, plan="this", command="study", overwrite=True):
        with pytest.raises(ZeroDivisionError):
            Multiples().run(folder=tmp_path, workers=1, save=lambda found: 1 // 0)
        assert "9" in kept(tmp_path)
        Multiples().run(folder=tmp_path, workers=1, save=saved.append)
    assert saved == [[10 * task for task in TASKS]]
    assert kept(tmp_path) == {str(task) for task in TASKS}
