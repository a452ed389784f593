from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from rockwobble.reports.pages import page_of, stored_page
from rockwobble.reports.pages.versions import KIND, EngineVersions

from . import engine_versions
from .engine_versions import COLUMNS, made_table, minor_releases


def test_the_last_patch_of_each_minor_release() -> None:
    listed = ["4.0.0", "3.10.0", "3.9.0", "3.4.1", "3.4.0", "3.3.7", "3.2.9"]
    assert minor_releases(listed, (3, 3)) == ["3.3.7", "3.4.1", "3.9.0", "3.10.0", "4.0.0"]
    # the newest is always among them
    assert minor_releases(listed, (3, 3), 2) == ["3.3.7", "3.9.0", "4.0.0"]


@pytest.fixture
def table() -> pd.DataFrame:
    row = dict.fromkeys(COLUMNS, math.nan) | {"engine": "mujoco", "uplift": "holds", "remark": ""}
    broken = row | {"version": "3.3.7", "uplift": "", "remark": "turn: AttributeError: no such name"}
    return made_table(
        [broken, row | {"version": "3.4.0", "el_centro": 1e-5}, row | {"version": "4.0.0", "el_centro": 4e-5}]
    )


def test_the_page_names_the_release_that_moved_a_figure(table: pd.DataFrame) -> None:
    text = page_of(EngineVersions(tables={"versions": table}, facts={})).markdown()
    assert (
        "**1 release has moved the error under El Centro by more than a tenth: MuJoCo 4.0.0 (4 times).**"
        in text
    )
    assert "no such name" in text
    still = table.assign(el_centro=1e-5)
    text = page_of(EngineVersions(tables={"versions": still}, facts={})).markdown()
    assert "**No release has moved the error under El Centro by more than a tenth.**" in text


def test_the_page_is_drawn_again_from_its_files(table: pd.DataFrame, tmp_path: Path) -> None:
    found = EngineVersions(tables={"versions": table}, facts={}).made_by()
    pages = page_of(found).files()
    found.save(tmp_path, pages=pages)
    assert EngineVersions.load(tmp_path).versions.equals(table)
    assert set(stored_page(KIND, tmp_path).files()) == set(pages) == {"versions.md", "versions.html"}


def test_rows_of_other_engines_stay_and_say_when_they_were_measured(
    table: pd.DataFrame, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def row(engine: str, version: str, *_: object, **__: object) -> dict[str, Any]:
        figures = {str(name): value for name, value in table.iloc[1].items()}
        return figures | {"engine": engine, "version": version}

    monkeypatch.setattr(engine_versions, "_row", row)
    for engine in ("dart", "rapier", "dart"):
        engine_versions.main(["--engine", engine, "--version", "9.0.0", "--out", str(tmp_path)])
    found = EngineVersions.load(tmp_path)
    assert found.manifest is not None
    assert list(found.versions["engine"]) == ["rapier", "dart"]
    assert found.facts["earlier"] == {
        "rapier": {"date": found.manifest.date, "commit": found.manifest.commit}
    }
    assert (
        f"Rapier (single precision) ({found.manifest.date}, commit" in (tmp_path / "versions.md").read_text()
    )
