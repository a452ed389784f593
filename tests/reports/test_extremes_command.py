"""`rockwobble extremes` from the outside, with verdicts that are given: a scan takes minutes."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pandas as pd
import pytest
from showing import loads_as_it_was, shows_itself
from typer.testing import CliRunner

from rockwobble.reports.cli.main import app
from rockwobble.reports.pages import extremes as pages
from rockwobble.reports.pages.page import Page
from rockwobble.studies import extremes as scan
from rockwobble.studies.extremes import Extremes, Verdict, measure_extremes
from rockwobble.studies.plans import QuickPlan


def given(worst: Verdict) -> Extremes:
    rows = [
        ("spin", "0", "recess model", Verdict(verdict="fine", error=1e-7, reference="tight")),
        ("spin", "0", "mujoco flat", worst),
        ("spin", "0", "mujoco recess", worst),
        ("spin", "9", "recess model", Verdict(verdict="n/a")),
    ]
    names = ("extreme", "value", "method")
    table = pd.DataFrame(
        [dict(zip(names, row[:3], strict=True)) | dataclasses.asdict(row[3]) for row in rows]
    )
    return Extremes(tables={"extremes": table}, facts={}).made_by()


def page_of(worst: Verdict) -> Page:
    return pages.page_of(given(worst))


FLAGGED = Verdict(verdict="flagged", error=0.3, reference="model", begins=0.5, limit="slip")
SILENT = Verdict(verdict="silent", error=0.3, reference="model", begins=0.5)


@pytest.mark.parametrize(("worst", "code"), [(FLAGGED, 0), (SILENT, 1)])
def test_the_exit_code_tells_whether_anything_is_silently_wrong(
    worst: Verdict, code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scan, "measure_extremes", lambda *_, **__: given(worst))
    done = CliRunner().invoke(app, ["extremes", "--out", str(tmp_path)])
    assert done.exit_code == code
    printed = " ".join(done.stdout.split())
    assert ("Nothing is silently wrong: of 3 runs 1 are fine" in printed) == (code == 0)
    assert ("2 of 3 runs are silently wrong" in printed) == (code == 1)
    names = {path.name for path in tmp_path.iterdir() if path.is_file()}
    assert names >= {"extremes.html", "extremes.md", "extremes.parquet", "manifest.json"}
    before = (tmp_path / "extremes.md").read_text()
    (tmp_path / "extremes.md").unlink()
    assert CliRunner().invoke(app, ["report", str(tmp_path)]).exit_code == 0
    assert (tmp_path / "extremes.md").read_text() == before


def test_what_is_not_fine_is_one_line_for_what_the_same_thing_limits() -> None:
    document = page_of(FLAGGED).markdown()
    section = document.split("## What is not fine")[1].split("##")[0]
    rows = [row for row in section.splitlines() if row.startswith("| spin")]
    assert len(rows) == 1
    assert "mujoco flat, mujoco recess" in rows[0]
    assert "contact slipped" in rows[0]
    refused = page_of(Verdict(verdict="refused", refusal="<b>must</b> be *less*"))
    assert "&lt;b&gt;must&lt;/b&gt;" in refused.html()
    assert "<b>must" not in refused.html()


def test_a_second_scan_repeats_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cheap = [each for each in scan.conditions() if each.value in ("0.001 s", "R = 0.01 m")]
    monkeypatch.setattr(scan, "conditions", lambda **_: cheap)
    models = scan.methods()[:2]
    monkeypatch.setattr(scan, "methods", lambda: models)
    first = measure_extremes(tmp_path, QuickPlan(), workers=1)
    assert list(first.extremes["verdict"]) == ["fine"] * 4
    monkeypatch.setattr(scan, "judge", None)
    again = measure_extremes(tmp_path, QuickPlan(), workers=1)
    pd.testing.assert_frame_equal(first.extremes, again.extremes)
    assert again.headline() == {"runs": 4, "fine": 4}


def test_bad_input_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    done = CliRunner().invoke(app, ["extremes", "--out", str(tmp_path / "taken")])
    assert done.exit_code == 2
    assert "the output folder must be a folder" in done.stderr
    assert not re.search(r"\n.+\n", done.stderr)


def test_a_scan_shows_itself(tmp_path: Path) -> None:
    found = given(SILENT)
    shows_itself(found, "runs 4, fine 1, silent 2")
    loads_as_it_was(found, tmp_path)
