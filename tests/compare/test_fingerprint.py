from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rockwobble.compare.runs.execution import Job, job_fingerprint
from rockwobble.compare.storage import provenance
from rockwobble.compare.storage.provenance import fingerprint
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
MOTION = GroundMotion([[0.0, 0.0], [1.0, 2.0], [0.0, 0.0]], 0.1, "pulse")
VALUES = [
    *(None, True, 1, 1.0, np.nextafter(1.0, 2.0), 0.0, -0.0, "1", "", [], {}, [1], [[1]], [1, 1], [[1], 1]),
    *({"a": 1}, {"b": 1}, {"a": {"b": 1}}, ["a", "b"], ["ab"], ["a b"]),
    *(np.array([1.0]), np.array([1]), np.array([[1.0]]), np.array([1.0, 0.0]), np.array([0.0, 1.0])),
    *(
        PIER,
        MOTION,
        InitialState(0.1),
        InitialState(0.2),
        Run("mujoco", "flat"),
        Run("mujoco", "recess"),
    ),
]


MODEL = Run(None, "recess")


def job(run: Run = MODEL, name: str = "a", label: str = "b", **changes) -> Job:
    case = {"cylinder": PIER, "motion": MOTION} | changes
    return Job(case=Case(name=name, **case), run=run, label=label)


def test_different_values_have_different_hashes():
    names = [fingerprint(value) for value in VALUES]
    assert len(set(names)) == len(names)


def test_equal_values_have_one_hash():
    assert fingerprint(np.float64(0.5)) == fingerprint(0.5)
    assert fingerprint((1, 2)) == fingerprint([1, 2])
    assert fingerprint({"x": 1, "y": 2}) == fingerprint({"y": 2, "x": 1})
    columns = np.asfortranarray(np.arange(6.0).reshape(2, 3))
    assert fingerprint(columns) == fingerprint(np.ascontiguousarray(columns))


def test_the_hash_is_equal_in_another_process():
    module = "rockwobble.compare.storage.provenance"
    code = f"import {module} as there; print(there.fingerprint({{'a': [0.1, 'x', None]}}))"
    there = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert there.strip() == fingerprint({"a": [0.1, "x", None]})


def test_unhashable_options_have_no_cache_key():
    with pytest.raises(ValueError, match=r"input of type object"):
        fingerprint({"a": object()})


def test_each_input_of_a_run_changes_its_hash():
    jobs = [
        job(),
        job(Run(None, "flat")),
        job(Run(None, "recess", plane=0.0)),
        job(Run("mujoco", "recess")),
        job(Run("mujoco", "flat")),
        job(Run("mujoco", "flat", 1e-4)),
        job(Run("mujoco", "flat", integrator="discrete")),
        job(cylinder=Cylinder(semidiagonal=6.0, tan_alpha=0.2, height=11.0)),
        job(motion=MOTION.scaled(1.0 + 1e-15)),
        job(motion=GroundMotion(MOTION.acceleration, 0.11)),
        job(initial=InitialState(0.1)),
        job(duration=0.1),
        job(gravity=9.8),
        job(friction=0.9),
        job(rolling_resistance=0.01),
        job(rolling_resistance=0.02),
    ]
    assert len({job_fingerprint(each) for each in jobs}) == len(jobs)
    # names of case and run are left out, as are defaults
    for same in (job(name="x", label="y"), job(rolling_resistance=0.0)):
        assert job_fingerprint(same) == job_fingerprint(job())


def test_code_and_versions_change_the_hash(monkeypatch):
    before = job_fingerprint(job())
    monkeypatch.setattr("rockwobble.compare.storage.provenance._source_digest", lambda folder: "another")
    assert job_fingerprint(job()) != before
    monkeypatch.undo()
    monkeypatch.setattr("rockwobble.compare.storage.provenance._version", lambda package: "0")
    assert job_fingerprint(job()) != before


def test_scenes_of_an_engine_count_as_code(tmp_path: Path) -> None:
    scene = tmp_path / "scenes" / "recess.xml"
    scene.parent.mkdir()
    (tmp_path / "engine.py").write_text("")
    digests = []
    for text in ("<mujoco/>", "<mujoco model='other'/>", "<mujoco/>"):
        scene.write_text(text)
        digests.append(provenance._digest_of(tmp_path))
    assert digests[0] == digests[2] != digests[1]


SOURCE = """
from rockwobble.multibody.engines.mujoco import MujocoEngine

class Own(MujocoEngine):
    def version(self):
        return "1"
"""


@pytest.fixture
def own_engine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], dict[str, str]]:
    """Install an engine of another package with this source; return the hash inputs of its runs."""
    about = tmp_path / "external-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: external\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[rockwobble.engines]\nown = own_engine:Own\n")
    monkeypatch.syspath_prepend(str(tmp_path))

    def made(source: str) -> dict[str, str]:
        (tmp_path / "own_engine.py").write_text(source)
        monkeypatch.delitem(sys.modules, "own_engine", raising=False)
        provenance._of_another_package.cache_clear()  # cached for a process, in which no code changes
        return provenance.engine_makers("own")

    return made


def test_a_changed_engine_of_another_package_changes_the_hash(
    own_engine: Callable[[str], dict[str, str]],
) -> None:
    first, changed, again = (own_engine(source) for source in (SOURCE, SOURCE + "# changed\n", SOURCE))
    assert first == again != changed
    assert first["engine own"].startswith("1, ")
    assert {"numpy", "rockwobble"} <= first.keys()
    assert "mujoco" not in first


def test_the_commit_of_a_checkout_states_changed_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def git(*arguments: str) -> str:
        user = ("-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false")
        command = ["git", "-C", str(tmp_path), *user, *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    def found() -> str:
        provenance.commit.cache_clear()
        return provenance.commit()

    code, published = tmp_path / "code.py", tmp_path / "reports" / "published" / "table.csv"
    monkeypatch.setattr(provenance, "__file__", str(code))
    git("init", "-q")
    published.parent.mkdir(parents=True)
    for path in (code, published):
        path.write_text("1\n")
    assert found() == ""  # no file of this repository
    git("add", ".")
    git("commit", "-q", "-m", "first")
    head = git("rev-parse", "HEAD")
    assert found() == head
    published.write_text("2\n")
    assert found() == head
    code.write_text("2\n")
    assert found() == f"{head}+"
    provenance.commit.cache_clear()
