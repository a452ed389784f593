"""The check of what is published finds damage and words without a table; the guide states its limits."""

from __future__ import annotations

import json
import runpy
import shutil
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from rockwobble.compare.check.verdict import CHANGED
from rockwobble.models.diagnostic import CODES, codes_in
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages.table import number
from rockwobble.studies.validity.limits import needs
from rockwobble.studies.validity.study import Validity

PUBLISHED = Path(__file__).parents[2] / "reports" / "published"
STUDY = "extremes"


def name_of(value: object) -> str:
    return value.relative_to(PUBLISHED).as_posix() if isinstance(value, Path) else str(value)


@pytest.fixture(scope="module")
def remake() -> dict[str, Any]:
    return runpy.run_path(str(PUBLISHED / "remake.py"))


@pytest.fixture
def copy(tmp_path: Path, remake: dict[str, Any]) -> Path:
    """A published study whose page has today's words, as `--redraw` leaves it."""
    shutil.copytree(PUBLISHED / STUDY, tmp_path / STUDY)
    with pytest.raises(SystemExit):
        main(["report", str(tmp_path / STUDY)])
    remake["trim"](tmp_path / STUDY)
    return tmp_path


def test_what_is_redrawn_is_sound(remake: dict[str, Any], copy: Path) -> None:
    assert remake["faults"](copy) == []
    assert not any("words" in row for row in remake["ages"](copy))


def test_a_damaged_table_is_found(remake: dict[str, Any], copy: Path) -> None:
    table = next((copy / STUDY).glob("*.parquet"))
    content = bytearray(table.read_bytes())
    content[len(content) // 2] ^= 1
    table.write_bytes(content)
    assert any(f"{table.name} is damaged" in row for row in remake["faults"](copy))


def test_a_number_that_its_table_does_not_hold_is_found(remake: dict[str, Any], copy: Path) -> None:
    page = copy / STUDY / "extremes.md"
    page.write_text(page.read_text() + "\nAnd 0.98765 of all runs stand.\n")
    assert any("its page says 0.98765" in row for row in remake["faults"](copy))


def test_another_sentence_is_no_fault_but_reported(remake: dict[str, Any], copy: Path) -> None:
    page = copy / STUDY / "extremes.md"
    page.write_text(page.read_text() + "\nA sentence of yesterday.\n")
    assert remake["faults"](copy) == []
    assert any("other words" in row for row in remake["ages"](copy))


def test_results_of_code_that_was_not_committed_are_found(remake: dict[str, Any], copy: Path) -> None:
    path = copy / STUDY / "manifest.json"
    stated = json.loads(path.read_text())
    stated["commit"] += "+"
    path.write_text(json.dumps(stated))
    assert any("committed" in row for row in remake["faults"](copy))


@pytest.mark.parametrize("path", sorted(PUBLISHED.rglob("*.parquet")), ids=name_of)
def test_its_diagnostics_are_codes(path: Path) -> None:
    table = pd.read_parquet(path)
    for cell in table.get("diagnostics", []):
        assert set(codes_in(cell)) <= set(CODES)


def test_the_guide_states_the_needs_of_the_published_limits() -> None:
    found = needs(Validity.load(PUBLISHED / "validity").tables)
    guide = (PUBLISHED.parents[1] / "docs" / "guide" / "limits.md").read_text(encoding="utf-8")
    for name in ("friction", "moment"):
        heads = [f"{each:g}" for each in sorted(found["intensity"].unique())]
        lines = [["tan α", *heads]]
        for tan_alpha, own in found.groupby("tan_alpha"):
            known = {f"{row['intensity']:g}": number(row[name], "most .3g") for row in own.to_dict("records")}
            lines.append([f"{tan_alpha:g}", *(known.get(head, "–") for head in heads)])
        head, *rows = (f"| {' | '.join(line)} |" for line in lines)
        assert head in guide
        assert "\n".join(rows) in guide


@pytest.mark.slow
@pytest.mark.parametrize("name", ["reduced", "mujoco"])
def test_the_code_still_does_what_it_did_then(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["verify", str(PUBLISHED / "certificates" / f"{name}.json"), "--json"])
    assert json.loads(capsys.readouterr().out)["word"] != CHANGED
