"""A folder belongs to one plan: what is finished there goes only where somebody asked for it."""

from __future__ import annotations

import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare.storage.claim import CACHE, claim_folder, claim_on
from rockwobble.compare.storage.manifest import Manifest, read_manifests, write_results


def write(folder: Path, kind: str, *names: str) -> None:
    """Write results of tables, of the plan that this process has claimed the folder for."""
    claim = claim_on(folder)
    made = Manifest(kind=kind, command=claim.command if claim else "", plan=claim.plan if claim else "")
    write_results(folder, made, {name: pd.DataFrame({"a": [1]}) for name in names})


def finish(folder: Path, kind: str, name: str) -> Path:
    path = folder / CACHE / kind / f"{name}.parquet"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"")
    return path


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_the_same_plan_resumes_and_another_is_refused(tmp_path):
    with claim_folder(tmp_path, plan="a", command="sweep --a"):
        write(tmp_path, "sweep", "one")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    words = r"holds sweep of `sweep --a`: choose another by --out, or replace that by --overwrite"
    with pytest.raises(ValueError, match=words), claim_folder(tmp_path, plan="b", command="sweep --b"):
        pass
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    with claim_folder(tmp_path, plan="a", command="sweep  --a"):
        pass
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_finished_tasks_belong_to_the_plan_that_was_ended(tmp_path):
    with suppress(KeyboardInterrupt), claim_folder(tmp_path, plan="a", command="sweep --a"):
        path = finish(tmp_path, "sweep", "x")
        raise KeyboardInterrupt
    with (
        pytest.raises(ValueError, match="1 finished tasks of `sweep --a`"),
        claim_folder(tmp_path, plan="b", command="sweep --b"),
    ):
        pass
    with claim_folder(tmp_path, plan="a", command="sweep --a"):
        assert path.exists()


def test_an_overwritten_plan_is_removed_once_the_new_one_is_complete(tmp_path):
    with claim_folder(tmp_path, plan="a", command="sweep --a"):
        write(tmp_path, "sweep", "one")
    (tmp_path / "notes.txt").write_text("mine")
    finish(tmp_path, "sweep", "x")
    with (
        pytest.raises(KeyboardInterrupt),
        claim_folder(tmp_path, plan="b", command="other --b", overwrite=True),
    ):
        raise KeyboardInterrupt
    assert "one.parquet" in names(tmp_path)
    with claim_folder(tmp_path, plan="b", command="other --b", overwrite=True):
        write(tmp_path, "other", "two")
    assert [each.kind for each in read_manifests(tmp_path)] == ["other"]
    assert names(tmp_path) == {"two.parquet", "manifest.json", "notes.txt", CACHE}
    assert list((tmp_path / CACHE).iterdir()) == []


def test_nothing_finished_leaves_nothing(tmp_path):
    place = tmp_path / "x" / "y"
    with suppress(KeyboardInterrupt), claim_folder(place, plan="a", command="sweep"):
        assert claim_on(place)
        raise KeyboardInterrupt
    assert names(tmp_path) == set()
    assert claim_on(place) is None


def test_results_of_other_programs_or_versions_are_not_reused(tmp_path):
    write(tmp_path, "sweep", "one")
    with (
        pytest.raises(ValueError, match="another program"),
        claim_folder(tmp_path, plan="a", command="sweep"),
    ):
        pass
    write_results(tmp_path, Manifest(kind="sweep", command="sweep --a"), {})
    with claim_folder(tmp_path, plan="a", command="sweep --a"):  # word for word the same
        pass
    with pytest.raises(ValueError, match="`sweep --a`"), claim_folder(tmp_path, plan="a", command="sweep"):
        pass


def test_a_second_process_is_refused_and_a_killed_one_leaves_no_lock(tmp_path):
    script = (
        "import sys, time\nfrom rockwobble.compare.storage.claim import claim_folder\n"
        "with claim_folder(sys.argv[1], plan='a', command='sweep'):\n"
        " print('ready', flush=True)\n time.sleep(60)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script, str(tmp_path)], stdout=subprocess.PIPE, text=True
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "ready\n"
        with (
            pytest.raises(ValueError, match="another process is writing to"),
            claim_folder(tmp_path, plan="a", command="sweep", overwrite=True),
        ):
            pass
        other.kill()
    with claim_folder(tmp_path, plan="b", command="simulate"):  # it had finished nothing
        pass
    assert names(tmp_path) == set()
