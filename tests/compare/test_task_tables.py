"""Tables of tasks: in their order, kept, and what becomes of those whose process died."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest
from scheduled import multiples

from rockwobble.compare import IncompleteError
from rockwobble.compare.runs import execution
from rockwobble.compare.runs.execution import run_tables
from rockwobble.compare.runs.progress import Lost
from rockwobble.compare.runs.scheduler import run_tasks
from rockwobble.compare.storage.claim import CACHE, claim_folder

TASKS = [1, 2, 3]


@pytest.fixture
def second_dies(monkeypatch: pytest.MonkeyPatch) -> None:
    def losing(*given, **options):
        first, _, third = run_tasks(*given, **options)
        return [first, Lost("out of memory"), third]

    monkeypatch.setattr(execution, "run_tasks", losing)


def ran(tasks: list[int] = TASKS, **options) -> pd.DataFrame:
    with run_tables(
        multiples, tasks, kind="study", key="{:032d}".format, label="number {}".format, workers=1, **options
    ) as found:
        return pd.concat(found, ignore_index=True)


def kept(folder: Path) -> set[str]:
    return {path.name[:32].lstrip("0") for path in (folder / CACHE / "study").glob("*.parquet")}


def test_the_tables_are_in_the_order_of_the_tasks_with_and_without_a_folder(tmp_path):
    whole = pd.concat(map(multiples, TASKS), ignore_index=True)
    pd.testing.assert_frame_equal(ran(), whole, check_exact=True)
    pd.testing.assert_frame_equal(ran(folder=tmp_path), whole, check_exact=True)
    assert kept(tmp_path) == {"1", "2", "3"}


@pytest.mark.usefixtures("second_dies")
def test_a_lost_task_has_the_table_that_it_is_given(tmp_path):
    found = ran(folder=tmp_path, lost=lambda task: pd.DataFrame({"multiple": [-float(task)]}))
    assert found["multiple"].min() == -2.0
    assert len(found) == 2001


@pytest.mark.usefixtures("second_dies")
def test_without_one_the_lost_are_counted_and_the_others_kept(tmp_path):
    words = "1 of 3 tasks ended their processes, all others are finished; the last words of number 2: out of"
    with pytest.raises(IncompleteError, match=words):
        ran(folder=tmp_path)
    with pytest.raises(IncompleteError, match="1 of 3 chunks ended their processes 2 times, all"):
        ran(folder=tmp_path, what="chunks", tries=2)
    assert kept(tmp_path) >= {"1", "3"}


def test_tasks_of_other_results_go_only_when_the_block_ends_well(tmp_path):
    ran([7], folder=tmp_path)
    with (
        pytest.raises(ZeroDivisionError),
        run_tables(
            multiples, TASKS, kind="study", key="{:032d}".format, label=str, folder=tmp_path, workers=1
        ),
    ):
        raise ZeroDivisionError
    assert kept(tmp_path) == {"1", "2", "3", "7"}
    ran(folder=tmp_path)
    assert kept(tmp_path) == {"1", "2", "3", "7"}
    with claim_folder(tmp_path, plan="this", command="study", overwrite=True):
        ran(folder=tmp_path)
    assert kept(tmp_path) == {"1", "2", "3"}
