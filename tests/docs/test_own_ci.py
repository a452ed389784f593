"""Workflow from the documentation, run in a repository like that of its page."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import yaml

from rockwobble.models import el_centro_1940

pytestmark = pytest.mark.checkout

PAGE = Path(__file__).parents[2] / "docs" / "guide" / "own-ci.md"
WORKFLOW = yaml.safe_load((PAGE.parent / "own-ci" / "rocking.yml").read_text(encoding="utf-8"))
STEPS: list[dict[str, Any]] = WORKFLOW["jobs"]["rocking"]["steps"]
RUN = {step["name"]: step["run"] for step in STEPS if "run" in step}
ONE_GROUP = " --only rest"  # all of them take half a minute, and other tests run them


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Example repository: a suite with its records, the first seconds of El Centro."""
    place = tmp_path_factory.mktemp("my-bridge")
    records = place / "tests" / "records"
    records.mkdir(parents=True)
    shutil.copy(PAGE.parent / "own-ci" / "pier.suite.toml", records.parent)
    motion = el_centro_1940()
    for column, name in enumerate(("EW", "NS")):
        samples = np.array(motion.acceleration)[:801, column] / 9.81
        head = f"example\nof a record\nACCELERATION IN G\nNPTS= {len(samples)}, DT= {motion.time_step} SEC\n"
        rows = "\n".join(f"{sample:15.7E}" for sample in samples)
        (records / f"{name}.AT2").write_text(f"{head}{rows}\n")
    return place


def run(command: str, repository: Path) -> subprocess.CompletedProcess[str]:
    """Run a line of the workflow like a CI runner: bash -e, in the checkout, with its variables."""
    scripts = str(Path(sys.executable).parent)
    own = {
        "PATH": f"{scripts}{os.pathsep}{os.environ['PATH']}",
        "GITHUB_STEP_SUMMARY": str(repository / "summary.md"),
    }
    return subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", command],
        cwd=repository, env=os.environ | own, capture_output=True, text=True, timeout=300,
    )  # fmt: skip


def cases_in(report: Path) -> list[ElementTree.Element]:
    return list(ElementTree.parse(report).getroot().iter("testcase"))


def test_ci_example_has_the_steps_a_runner_needs() -> None:
    uses = [step["uses"].split("@")[0].removeprefix("actions/") for step in STEPS if "uses" in step]
    assert uses == ["checkout", "setup-python", "cache", "upload-artifact"]
    cached = next(step["with"]["path"] for step in STEPS if "cache@" in step.get("uses", ""))
    assert WORKFLOW["env"]["NUMBA_CACHE_DIR"] == f"${{{{ github.workspace }}}}/{cached}"
    written = {
        word for line in RUN.values() for word in shlex.split(line, comments=True) if word.endswith(".xml")
    }
    assert written == {"check.xml", "pytest.xml"}
    assert STEPS[-1]["with"]["path"] == "*.xml"


def test_the_ci_example_installs_what_the_start_page_names() -> None:
    # both need the network: that they are whole shell lines, and ask for what the other pages say
    for name in ("libraries of the system", "packages"):
        assert subprocess.run(["bash", "-n", "-c", RUN[name]], check=False).returncode == 0
    asked = shlex.split(RUN["libraries of the system"], comments=True)
    start = (PAGE.parents[1] / "start.md").read_text(encoding="utf-8")
    assert f"apt install {' '.join(asked[asked.index('--yes') + 1 :])}" in start
    assert shlex.split(RUN["packages"]) == ["python", "-m", "pip", "install", "$ROCKWOBBLE", "pytest"]


@pytest.mark.slow
def test_check_and_suite_run_and_write_their_reports(repository: Path) -> None:
    done = run(RUN["models and engines of this machine"] + ONE_GROUP, repository)
    assert done.returncode == 0, done.stdout + done.stderr
    assert cases_in(repository / "check.xml")
    assert (repository / "summary.md").stat().st_size > 0
    done = run(RUN["suites, and tests of your own"], repository)
    assert done.returncode == 0, done.stdout + done.stderr
    cases = cases_in(repository / "pytest.xml")
    assert [each.get("name") for each in cases if each.find("skipped") is None] != []
    assert len(cases) == 2  # one for each scale of the record
