from __future__ import annotations

import importlib.util
import io
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from showing import call

from rockwobble.compare.runs.execution import Job
from rockwobble.models import Trace
from rockwobble.models.trace import lost_trace
from rockwobble.multibody.engines.registry import engine_packages, standard_engines
from rockwobble.reports.pages.page import Page


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def no_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw no report, for tests of what is printed."""
    monkeypatch.setattr(Page, "files", lambda *_, **__: {})


@pytest.mark.slow
def test_compare_prints_summary_and_writes_files(folder, no_engines, monkeypatch, capsys):
    no_engines()
    monkeypatch.setattr(Page, "html", lambda _, **__: "")
    (folder / "results").mkdir()
    (folder / "results" / "mine.txt").write_text("mine")
    arguments = ["compare", "--engine", "mujoco", "--out", "results", "--duration", "10", "--scale", "1.5"]
    assert call(*arguments) == 0
    out = capsys.readouterr().out
    assert "2h = 11.77 m" in out
    assert "peak 0.430 g" in out
    assert "mujoco recess" in out
    names = {path.name for path in (folder / "results").iterdir()}
    tables = {f"{name}.parquet" for name in ("summary", "traces", "passes", "excitation")}
    files = {"mine.txt", "manifest.json", "summary.csv", "comparison.json", "report.json", "report.html"}
    assert names == tables | files
    summary = pd.read_csv(folder / "results" / "summary.csv")
    assert summary["case"].tolist() == ["El Centro 1940 × 1.5"] * 3
    assert (folder / "results" / "mine.txt").read_text() == "mine"


def test_missing_engine_is_skipped_with_a_note(folder, no_engines, no_report, monkeypatch, capsys):
    no_engines()
    first, second = standard_engines()
    assert first == "mujoco"
    package, find = engine_packages()[second], importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == package else find(name))
    assert call("compare", "--duration", "5") == 0
    captured = capsys.readouterr()
    said = [line for line in captured.err.splitlines() if "compiling" not in line]  # once for an installation
    (line,) = said
    assert line.startswith(f"rockwobble: {second} ")
    assert line.endswith("left out")
    assert second not in captured.out
    assert call("simulate", "--engine", second) == 2  # named, it is bad input
    said = capsys.readouterr().err
    assert re.fullmatch(rf"rockwobble: engine '{second}' is not installed here: [^\n]+\n", said)


def test_ctrl_c_is_one_line_and_nothing_written(folder, monkeypatch, capsys):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("rockwobble.comparison", interrupted)
    assert call("compare", "--engine", "mujoco") == 130
    assert capsys.readouterr().err.startswith("rockwobble: interrupted")
    assert not (folder / "rockwobble-compare").exists()


def test_simulate_writes_the_trace_of_a_reduced_model(folder, in_this_process, capsys):
    assert call("simulate", "--release-tilt-deg", "5", "--rolling-rate", "0.5", "--duration", "2") == 0
    captured = capsys.readouterr()
    assert "Peak tilt" in captured.out
    assert ": recess model" in captured.err
    samples = pd.read_csv("rockwobble-simulate/run.csv")
    kept = pd.read_parquet("rockwobble-simulate/run.parquet").astype(samples.dtypes.to_dict())
    assert len(Trace.load("rockwobble-simulate/run.parquet").time) == 201
    # the default parser of older pandas is off by a rounding
    pd.testing.assert_frame_equal(samples, kept, rtol=1e-15, atol=0.0)
    about = json.loads(Path("rockwobble-simulate/manifest.json").read_text())["about"]
    assert about["result"]["outcome"] == "stands"
    assert about["case"]["initial"]["rolling_rate"] == 0.5


@pytest.mark.slow
def test_simulate_states_the_divergence_time_of_copies(folder, in_this_process, capsys):
    slender = ["--semidiagonal", "6.0847320541999865", "--tan-alpha", "0.08996054265853794"]
    given = [*slender, "--scale", "1.28359029043245", "--support", "recess"]
    assert call("simulate", *given, "--rest-tilt", "1e-9") == 0
    about = json.loads(Path("rockwobble-simulate/manifest.json").read_text())["about"]["single_trace"]
    # before its peak, which an input 1 % off changes by half of it and more
    assert (about["perturbation"], 20.0 < about["copies_part"] < 40.0) == (0.01, True)
    # with what states the problem, and nothing that advise does not know
    assert set(about["answer"].split()) == {"rockwobble", "advise", *given}
    words = " ".join(capsys.readouterr().out.split())
    assert f"From {about['copies_part']:.3g} s on" in words
    release = ["--release-tilt-deg", "5", "--rolling-rate", "0.5", "--duration", "2"]
    assert call("simulate", *release, "--out", "released") == 0
    assert "not reproducible" not in capsys.readouterr().out


def result(*arguments: str) -> dict[str, Any]:
    assert call("simulate", *arguments, "--overwrite") == 0
    made = json.loads(Path("rockwobble-simulate/manifest.json").read_text())
    return made["about"] | {"inputs": made["inputs"]}


@pytest.mark.slow
def test_options_select_each_reduced_model(folder, in_this_process):
    release = ["--release-tilt-deg", "5", "--duration", "2"]
    spin = [*release, "--rolling-rate", "0.5"]
    recess, flat = result(*spin), result(*spin, "--support", "flat")
    assert [each["run"] for each in (recess, flat)] == ["recess model", "flat-ground model"]
    assert recess["result"]["residual_displacement"] != flat["result"]["residual_displacement"]
    planar = result(*release, "--plane", "0.3", "--restitution", "0.9", "--rest-tilt", "1e-6")
    assert planar["run"] == "planar model"
    settings = {name: planar["result"]["settings"][name] for name in ("plane", "restitution", "rest_tilt")}
    assert settings == {"plane": 0.3, "restitution": 0.9, "rest_tilt": 1e-6}


@pytest.mark.slow
def test_dimensions_and_ratios_give_one_cylinder(folder, in_this_process):
    # R = 5 m and tan alpha = 3/4, on the moon and on ice
    same = ["--release-tilt-deg", "5", "--rolling-rate", "0.5", "--duration", "1"]
    same += ["--gravity", "1.62", "--friction", "0.1"]
    by_size = result("--semidiagonal", "5", "--tan-alpha", "0.75", *same)
    by_dimensions = result("--diameter", "6", "--height", "8", *same)
    assert by_dimensions["inputs"] == by_size["inputs"]
    assert (by_size["case"]["gravity"], by_size["case"]["friction"]) == (1.62, 0.1)
    hollow = result("--diameter", "6", "--height", "8", "--axial-inertia", "9", *same)
    assert hollow["inputs"] != by_size["inputs"]


def test_help_lists_commands_engines_and_an_example(capsys):
    assert call() == 0
    assert "compare" in capsys.readouterr().out
    assert call("advise", "-h") == 0
    said = capsys.readouterr().out
    assert " rockwobble advise --" in said
    assert [name for name in engine_packages() if name not in said] == []


def test_help_imports_nothing_heavy():
    script = (
        "import sys\n"
        "from rockwobble.reports.cli.main import main\n"
        "try:\n    main(['--help'])\n"
        "except SystemExit:\n    pass\n"
        "heavy = {'numpy', 'numba', 'scipy', 'pandas', 'mujoco', 'matplotlib', 'jinja2'}\n"
        "print(sorted(heavy & set(sys.modules)), file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "[]"


@pytest.mark.slow
def test_ctrl_c_stops_a_real_run_at_once_and_leaves_no_process(tmp_path):
    # hours of free response: it would run for an hour
    release = ["--release-tilt-deg", "5", "--rolling-rate", "0.5", "--duration", "20000"]
    # who runs the tests in the background may have taught their children to ignore it
    script = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    script += "from rockwobble.reports.cli.main import main; main()"
    process = subprocess.Popen(
        [sys.executable, "-c", script, "compare", *release, "--engine", "mujoco"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr is not None
    while "0 of" not in (line := process.stderr.readline()):
        assert line, "it ended before it ran"
    time.sleep(1.0)
    children = _children(process.pid)
    assert children
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert errors.splitlines()[-1].startswith("rockwobble: interrupted")
    assert "Traceback" not in errors
    assert not any(_alive(child) for child in children)
    assert list(tmp_path.iterdir()) == []


def _children(pid: int) -> list[int]:
    tasks = Path(f"/proc/{pid}/task").iterdir()
    return [int(child) for path in tasks for child in (path / "children").read_text().split()]


def _alive(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


def test_crashed_run_gives_one_line_and_exit_code_1(folder, in_this_process, monkeypatch, capsys):
    def died(jobs: list[Job], **_: Any) -> list[Trace]:
        return [lost_trace(job.case, job.run, "status -11") for job in jobs]

    with monkeypatch.context() as patch:
        patch.setattr("rockwobble.studies.single_run.simulate_all", died)
        assert call("simulate", "--engine", "mujoco") == 1
    shown = capsys.readouterr().err.splitlines()
    assert re.fullmatch("rockwobble: mujoco recess .* -11", shown[-1])
    assert not any("copies" in line for line in shown)
    assert not (folder / "rockwobble-simulate").exists()
    assert call("simulate", "--release-tilt-deg", "3", "--rolling-rate", "1e40") == 1  # no first step
    *_, said = capsys.readouterr().err.splitlines()
    assert said.startswith("rockwobble: recess model ")


@pytest.mark.slow
def test_results_are_complete_if_terminal_output_fails(tmp_path, in_this_process, monkeypatch):
    words = ["simulate", "--release-tilt-deg", "5", "--duration", "1", "--out"]
    command = [sys.executable, "-m", "rockwobble", *words]
    poor = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    with monkeypatch.context() as patch:
        patch.setattr(sys, "stdout", poor)
        assert call(*words, str(tmp_path / "poor")) == 0
        poor.flush()
    shown = poor.buffer.getvalue()
    assert b"Peak tilt" in shown
    assert b"ALPHA" in shown
    reader, writer = os.pipe()
    os.close(reader)
    closed = subprocess.run(
        [*command, "closed"], cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE, check=False
    )
    with Path("/dev/full").open("wb") as device:
        full = subprocess.run(
            [*command, "full"], cwd=tmp_path, stdout=device, stderr=subprocess.PIPE, check=False
        )
    assert b"cannot be printed: No space left on device" in full.stderr
    for ended in (closed, full):
        assert (ended.returncode, b"Traceback" in ended.stderr) == (1, False)
    for name in ("poor", "closed", "full"):
        assert Trace.load(tmp_path / name / "run.parquet").outcome == "stands"
