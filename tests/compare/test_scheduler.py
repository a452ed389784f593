"""Tasks in processes and on clusters: order of results, reports of death, and cleaning up."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
from concurrent.futures import Future
from contextlib import nullcontext
from pathlib import Path

import pandas as pd
import pytest
import scheduled
from scheduled import die_once, killed, multiples, never_the_same, process_of, refuse, signalled

from rockwobble.compare.runs import scheduler
from rockwobble.compare.runs.cache import open_table_cache, unfinished_results
from rockwobble.compare.runs.progress import FailedTask, Progress
from rockwobble.compare.runs.scheduler import ClusterError, run_tasks
from rockwobble.compare.storage.claim import CACHE
from rockwobble.models import cpus
from rockwobble.models.cpus import usable_cpus


def counted(task: int) -> pd.DataFrame:
    RAN.append(task)
    return multiples(task)


RAN: list[int] = []


@pytest.fixture(autouse=True)
def importable_there(monkeypatch):
    here = [str(Path(scheduled.__file__).parent), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, here)))


def table_cache(folder, kind="study"):
    return open_table_cache(folder, kind, name=lambda task: f"{task:032d}")


@pytest.mark.parametrize("workers", [1, 2])
def test_results_come_in_the_order_of_the_tasks(workers):
    progress: list[Progress] = []
    tasks = [-3, 2, -1, 5]
    results = run_tasks(abs, tasks, workers=workers, cost=lambda task: float(task), progress=progress.append)
    assert results == [3, 2, 1, 5]
    started = [event.label for event in progress if event.state == "started"]
    assert started == ["5", "2", "-1", "-3"]  # longest first
    assert [event.done for event in progress if event.state == "finished"] == [1, 2, 3, 4]
    assert progress[-1].share == pytest.approx(1.0)
    assert progress[-1].left == pytest.approx(0.0)


@pytest.mark.slow
def test_processes_are_reused_and_brief_tasks_run_here():
    pids = run_tasks(process_of, [0] * 8, workers=2)
    assert len(set(pids)) <= 2
    assert os.getpid() not in pids
    processes = run_tasks(process_of, [1, 2, 3], workers=2, here=lambda task: task == 2)
    assert [process == os.getpid() for process in processes] == [False, True, False]
    # a single task has a process of its own on request
    assert run_tasks(process_of, [0], workers=2) != [os.getpid()] == run_tasks(process_of, [0])


def test_bad_input_is_raised_here_with_its_remote_traceback():
    with pytest.raises(ValueError, match="at least 1") as caught:
        run_tasks(refuse, [1], workers=2)
    assert "refuse" in "".join(caught.value.__notes__)


@pytest.mark.slow
def test_a_process_that_dies_loses_only_its_own_task(tmp_path):
    results = run_tasks(signalled, [0, int(signal.SIGABRT), 0], workers=2)
    assert (results[0], results[2]) == (None, None)
    assert results[1] == FailedTask(f"the process ended with status -{signal.SIGABRT.value}")
    # a task whose process was killed from outside starts again
    again, once = (str(tmp_path / name) for name in ("a", "b"))
    assert run_tasks(die_once, [again], workers=2, tries=2) == [again]
    assert [type(each) for each in run_tasks(die_once, [once], workers=2)] == [FailedTask]


def test_ctrl_c_ends_the_processes_at_once_and_leaves_nothing(monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    def interrupt(event):
        raise KeyboardInterrupt

    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        run_tasks(time.sleep, [60.0, 60.0, 60.0], workers=2, progress=interrupt)
    assert time.monotonic() - begun < 20.0
    assert list(tmp_path.iterdir()) == []  # the folders of the processes are removed with them


def test_tasks_finished_before_an_interruption_are_stored(tmp_path):
    def interrupt(event):
        if event.done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), table_cache(tmp_path) as cache:
        run_tasks(multiples, [1, 2, 3, 4], workers=1, cache=cache, progress=interrupt)
    (going,) = unfinished_results(tmp_path)
    assert going == {"kind": "study", "done": 2, "total": 4}
    RAN.clear()
    with table_cache(tmp_path) as cache:
        run_tasks(counted, [1, 2, 3, 4], workers=1, cache=cache)
    assert RAN == [3, 4]
    assert unfinished_results(tmp_path) == []


def test_a_damaged_file_is_named_and_its_task_runs_again(tmp_path):
    with table_cache(tmp_path) as cache:
        run_tasks(multiples, [1, 2], workers=1, cache=cache)
    (path,) = (tmp_path / CACHE / "study").glob(f"{2:032d}-*.parquet")
    whole = path.read_bytes()
    for place in range(0, len(whole), len(whole) // 50):  # data, header and footer
        content = bytearray(whole)
        content[place] ^= 1  # a single bit
        path.write_bytes(content)
        RAN.clear()
        messages: list[Progress] = []
        with table_cache(tmp_path) as cache:
            run_tasks(counted, [1, 2], workers=1, cache=cache, progress=messages.append)
        assert RAN == [2], place
        assert {event.damaged for event in messages} == {(str(path),)}
        assert path.read_bytes() == whole


def test_a_lost_task_is_not_cached(tmp_path):
    with table_cache(tmp_path) as cache:
        results = run_tasks(killed, [1], workers=2, cache=cache)
        assert [type(each) for each in results] == [FailedTask]
        assert cache.find(1) is None


def test_only_one_run_writes_to_a_folder_and_leftovers_are_removed(tmp_path):
    place = tmp_path / CACHE / "study"
    place.mkdir(parents=True)
    (place / ".abc.parquet.1.part").write_bytes(b"PAR1")
    with (
        table_cache(tmp_path),
        pytest.raises(ValueError, match="another process is writing to"),
        table_cache(tmp_path),
    ):
        pass
    assert not list(place.glob("*.part"))


@pytest.mark.slow
def test_a_missing_scheduler_or_worker_is_one_clear_line(monkeypatch):
    monkeypatch.setattr(scheduler, "_PATIENCE", 0.5)
    with pytest.raises(ValueError, match="no Dask scheduler answers at 'tcp://127"):
        run_tasks(abs, [1], scheduler="tcp://127.0.0.1:1")
    with pytest.raises(ValueError, match=r"has an address such as tcp://.*, got 'nonsense'"):
        run_tasks(abs, [1], scheduler="nonsense")
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as cluster,
        pytest.raises(ClusterError, match=r"has had no worker for 0\.5 s: start one by dask worker"),
    ):
        run_tasks(abs, [1], scheduler=cluster.scheduler_address)


def test_dask_gives_the_same_results_and_refuses_other_code():
    distributed = pytest.importorskip("distributed")
    alone = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(**alone) as cluster:
        address = cluster.scheduler_address
        assert run_tasks(abs, [-2, 1, -3], scheduler=address) == [2, 1, 3]
        with pytest.raises(ClusterError, match="must have what the caller has: call"):
            run_tasks(abs, [1], scheduler=address, makers=never_the_same)


@pytest.mark.slow
def test_a_script_without_a_main_guard_runs_once(tmp_path):
    # its own functions are those of __main__, which is another module in the worker
    script = tmp_path / "plain.py"
    script.write_text(
        textwrap.dedent(
            """
            from rockwobble.compare.runs.scheduler import run_tasks
            def own(_): pass
            print(sum(run_tasks(abs, [-1, 2, -4], workers=2)))
            print(run_tasks(own, [1, 2], workers=2)[0].why)
            """
        )
    )
    run = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60, check=True)
    total, why = run.stdout.splitlines()
    assert total == "7"
    assert why.startswith("the process ended with status 1: AttributeError: ")
    assert "'own'" in why


@pytest.mark.slow
def test_workers_end_with_a_killed_caller(tmp_path):
    script = (
        "import os, time\n"
        "from rockwobble.compare.runs.scheduler import Worker\n"
        "worker = Worker()\n"
        "print(worker.call(os.getpid), flush=True)\n"
        "worker.call(time.sleep, 60.0)\n"
    )
    caller = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert caller.stdout is not None
    worker = int(caller.stdout.readline())
    caller.kill()
    caller.wait()
    caller.stdout.close()
    deadline = time.monotonic() + 20.0
    while _runs(worker) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not _runs(worker)


def _runs(pid: int) -> bool:
    try:
        # a zombie has ended, even if no process has waited for it yet
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.slow
def test_unpicklable_answers_and_printed_output_are_handled():
    with pytest.raises((TypeError, AttributeError, RuntimeError), match="pickle"):
        run_tasks(memoryview, [b"", b""], workers=2)
    assert run_tasks(os.system, ["echo noise", "echo more"], workers=2) == [0, 0]
    assert run_tasks(print, ["noise", "more"], workers=2) == [None, None]


def test_the_number_of_workers_is_that_of_usable_cpus(monkeypatch, tmp_path):
    quota = tmp_path / "cpu.max"
    monkeypatch.setattr(cpus, "_QUOTA", quota)
    whole = usable_cpus()
    assert whole == len(os.sched_getaffinity(0))
    quota.write_text("max 100000\n")
    assert usable_cpus() == whole
    quota.write_text("50000 100000\n")
    assert usable_cpus() == 1


@pytest.mark.parametrize(
    ("error", "words"), [(OSError("worker died\nat length"), "worker died"), (OSError(), "OSError")]
)
def test_a_lost_task_is_reported_in_one_line(monkeypatch, error, words):
    def lose(*_):
        lost = Future()
        lost.set_exception(error)
        return lost

    monkeypatch.setattr(scheduler, "on_cluster", lambda *_: nullcontext((lose, lambda: 1, (OSError,))))
    (result,) = run_tasks(abs, [1], scheduler="tcp://here:1")
    assert result.why == words
