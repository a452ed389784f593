"""Adding a study at the places listed in docs/development, in a temporary copy of the package."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import rockwobble

PACKAGE = Path(rockwobble.__file__).parent
ADDING = Path(__file__).parents[2] / "docs" / "development" / "adding.md"
MOST = 3  # places of a new study

# what is new in each place, for the study of a name
STUDY = {
    "studies/NAME.py": '''"""Ground acceleration at which a cylinder uplifts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import pandas as pd

from rockwobble.compare.runs.plan import Plan, option
from rockwobble.compare.storage.results import Results

from .study import Study


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Thresholds(Results, kind="thresholds"):
    """Thresholds of uplift: the table thresholds, tan_alpha and acceleration [m/s^2]."""

    def headline(self) -> dict[str, float]:
        return {"lowest threshold [m/s2]": float(self.thresholds["acceleration"].min())}


@dataclass(frozen=True, kw_only=True)
class ThresholdStudy(Plan, Study[tuple[float, float], Thresholds]):
    """Ground acceleration at which cylinders uplift.

    Example: rockwobble thresholds --tan-alpha 0.1,0.2
    """

    kind: ClassVar[str] = "thresholds"
    yields: ClassVar[type[Results]] = Thresholds
    tan_alphas: Sequence[float] | None = option(
        None, "Slendernesses tan alpha: a list or an even range.", form="numbers", flag="--tan-alpha"
    )
    gravity: float = option(9.81, "Gravitational acceleration g, in m/s2.", above=0.0)

    def tasks(self) -> list[tuple[float, float]]:
        return [(self.gravity, tan_alpha) for tan_alpha in self.tan_alphas or (0.1, 0.2)]

    @staticmethod
    def row(task: tuple[float, float]) -> pd.DataFrame:
        gravity, tan_alpha = task
        return pd.DataFrame([{"tan_alpha": tan_alpha, "acceleration": gravity * tan_alpha}])
''',
    "reports/registry.py": """
    Entry(name="thresholds", group="batch", study="studies.thresholds.ThresholdStudy"),
""",
    "tests/studies/test_NAME.py": """from __future__ import annotations

from pathlib import Path

import pytest
from showing import call, loads_as_it_was, shows_itself

from rockwobble.studies.thresholds import Thresholds, ThresholdStudy


def test_the_threshold_is_g_tan_alpha_and_loads_as_it_was(tmp_path: Path) -> None:
    found = ThresholdStudy(tan_alphas=[0.1, 0.5], gravity=10.0).run(workers=1)
    assert found.thresholds["acceleration"].tolist() == [1.0, 5.0]
    shows_itself(found, "lowest threshold [m/s2] 1")
    loads_as_it_was(found, tmp_path)


def test_the_command_saves_shows_draws_again_and_refuses(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call("--help") == 0
    assert "uplift" in capsys.readouterr().out.split("thresholds", 1)[1].splitlines()[0]
    stated = ("thresholds", "--tan-alpha", "0.3,0.1", "--gravity", "10", "--out", str(tmp_path))
    assert call(*stated, "--workers", "1") == 0
    assert "Thresholds of uplift" in capsys.readouterr().out
    assert Thresholds.load(tmp_path).thresholds["acceleration"].tolist() == pytest.approx([3.0, 1.0])
    page = (tmp_path / "thresholds.html").read_text()
    assert page.count('class="chart"') == 1
    (tmp_path / "thresholds.html").unlink()
    assert [call(command, str(tmp_path)) for command in ("show", "report")] == [0, 0]
    assert (tmp_path / "thresholds.html").read_text() == page
    capsys.readouterr()
    assert call(*stated[:3], "--out", str(tmp_path)) == 2
    assert "holds thresholds of" in capsys.readouterr().err
    assert call("thresholds", "--gravity", "-1", "--out", str(tmp_path)) == 2
    assert capsys.readouterr().err == "rockwobble: --gravity must be above 0, got -1.0\\n"
""",
}


def places() -> list[str]:
    """Listed places of a new study."""
    section = ADDING.read_text(encoding="utf-8").split("## A new study\n")[1].split("\n## ")[0]
    return re.findall(r"^\| `(\S+)` \|", section, re.MULTILINE)


def test_new_study_needs_at_most_three_places() -> None:
    assert places() == list(STUDY)
    assert len(STUDY) <= MOST


@pytest.mark.slow
def test_study_added_at_the_documented_places_works(tmp_path: Path) -> None:
    def link(source: str, place: str) -> None:
        Path(place).symlink_to(Path(source).resolve())

    copy = tmp_path / "rockwobble"
    unused = shutil.ignore_patterns("__pycache__", "published")
    shutil.copytree(PACKAGE, copy, copy_function=link, ignore=unused)
    for name, text in STUDY.items():
        place = (copy.parent if name.startswith("tests/") else copy) / name.replace("NAME", "thresholds")
        before = place.read_text(encoding="utf-8") if place.exists() else ""
        head, list_end, tail = (
            before.partition(")\nCOMMANDS") if name.endswith("registry.py") else (before, "", "")
        )
        place.parent.mkdir(parents=True, exist_ok=True)
        place.unlink(missing_ok=True)
        place.write_text(head + text + list_end + tail, encoding="utf-8")
    (tmp_path / "tests" / "test_registry.py").symlink_to(Path(__file__).with_name("test_registry.py"))
    paths = [str(tmp_path), str(Path(__file__).parent), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths)), "PYTEST_ADDOPTS": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    passed = re.findall(r"(\d+) passed", done.stdout)
    assert int(passed[0]) > 2  # its tests, and those of the registry
