from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest

from rockwobble.compare.runs.process_pool import ProcessPool, WorkerDiedError
from rockwobble.models import Cylinder


def test_calls_return_what_they_return_elsewhere():
    with ProcessPool(2) as pool:
        futures = [pool.submit(pow, 2, power) for power in range(8)]
        pids = {pool.submit(os.getpid).result() for _ in range(6)}
        assert [future.result() for future in futures] == [2**power for power in range(8)]
    assert os.getpid() not in pids
    assert len(pids) <= 2  # processes are kept


def test_bad_input_is_raised_here_with_where_it_came_from():
    with ProcessPool(1) as pool:
        future = pool.submit(Cylinder, semidiagonal=-1.0, tan_alpha=0.2)
        with pytest.raises(ValueError, match=r"semidiagonal must be positive \[m\], got -1.0") as caught:
            future.result()
    assert "require_positive" in "".join(caught.value.__notes__)


def test_a_function_that_cannot_be_imported_there_is_said(tmp_path):
    # the script's own functions are those of __main__, which is another module there
    script = tmp_path / "script.py"
    script.write_text(
        "from rockwobble.compare.runs.process_pool import ProcessPool\n"
        "def own(): pass\n"
        "with ProcessPool(1) as pool: pool.submit(own).result(timeout=20)\n"
    )
    run = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60)
    last = run.stderr.splitlines()[-1]
    assert "WorkerDiedError: the process ended with status 1: AttributeError: " in last
    assert "'own'" in last


def test_a_process_that_dies_fails_only_its_own_call():
    with ProcessPool(1) as pool:
        dead = pool.submit(os.abort)
        alive = pool.submit(abs, -3)
        with pytest.raises(WorkerDiedError, match=f"status -{signal.SIGABRT.value}"):
            dead.result()
        assert alive.result() == 3


def test_what_a_call_prints_does_not_mix_with_its_answer():
    with ProcessPool(1) as pool:
        assert pool.submit(os.system, "echo noise").result() == 0
        assert pool.submit(print, "noise").result() is None
        assert pool.submit(abs, -3).result() == 3


def test_an_answer_that_cannot_travel_is_an_error_of_its_call():
    with ProcessPool(1) as pool:
        with pytest.raises((TypeError, AttributeError, RuntimeError), match="pickle"):
            pool.submit(memoryview, b"").result()
        assert pool.submit(abs, -3).result() == 3


def test_leaving_by_an_exception_ends_the_processes_at_once():
    started = time.monotonic()
    futures = []

    def interrupted():
        with ProcessPool(1) as pool:
            futures.extend([pool.submit(time.sleep, 60.0), pool.submit(abs, 2)])
            while not futures[0].running():
                time.sleep(0.01)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert time.monotonic() - started < 20.0
    assert isinstance(futures[0].exception(), WorkerDiedError)
    assert futures[1].cancelled()


def test_nothing_can_be_submitted_after_shutdown():
    pool = ProcessPool(1)
    pool.shutdown()
    with pytest.raises(RuntimeError, match="after shutdown"):
        pool.submit(abs, 1)


def test_a_script_without_a_main_guard_runs_once(tmp_path: Path):
    script = tmp_path / "plain.py"
    script.write_text(
        textwrap.dedent(
            """
            from rockwobble.compare.process_pool import ProcessPool
            print("top")
            with ProcessPool(2) as pool:
                print(sum(pool.submit(pow, 2, n).result() for n in range(3)))
            """
        )
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.split() == ["top", "7"]


def test_workers_end_with_a_caller_that_is_killed(tmp_path: Path):
    script = (
        "import os, time\n"
        "from rockwobble.compare.runs.process_pool import ProcessPool\n"
        "pool = ProcessPool(1)\n"
        "print(pool.submit(os.getpid).result(), flush=True)\n"
        "pool.submit(time.sleep, 60.0).result()\n"
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
        # a zombie has ended; that nobody has waited for it yet does not count
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False
