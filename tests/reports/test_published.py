"""Check of published results: detects damage and unsupported numbers; the guide states the limits."""

from __future__ import annotations

import ast
import importlib
import json
import runpy
import shutil
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from rockwobble.models.diagnostic import CODES, codes_in
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages.table import number
from rockwobble.reports.published import headlines
from rockwobble.studies.validity.limits import needs
from rockwobble.studies.validity.study import Validity

pytestmark = pytest.mark.checkout

PUBLISHED = Path(__file__).parents[2] / "reports" / "published"
STUDIES = ("ensemble/copies", "extremes")  # one of a command, one of a script
PUBLIC = (
    "rockwobble",
    "rockwobble.models",
    "rockwobble.reduced",
    "rockwobble.multibody",
    "rockwobble.compare",
)
PUBLIC += ("rockwobble.compare.check", "rockwobble.studies")
OF_A_STUDY = ("rockwobble.reports.pages.", "rockwobble.reports.figures.", "rockwobble.reports.published")


@pytest.fixture(scope="module")
def remake() -> dict[str, Any]:
    return runpy.run_path(str(PUBLISHED / "remake.py"))


@pytest.fixture(params=STUDIES)
def copy(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    return Path(shutil.copytree(PUBLISHED / request.param, tmp_path / request.param))


def page_of(folder: Path) -> Path:
    return next(path for path in folder.glob("*.md"))


@pytest.mark.slow
def test_published_results_are_undamaged(remake: dict[str, Any], copy: Path, tmp_path: Path) -> None:
    assert remake["faults"](tmp_path) == []


def test_a_damaged_table_is_a_fault(remake: dict[str, Any], copy: Path, tmp_path: Path) -> None:
    table = next(copy.glob("*.parquet"))
    content = bytearray(table.read_bytes())
    content[len(content) // 2] ^= 1
    table.write_bytes(content)
    assert any(f"{table.name} is damaged" in row for row in remake["faults"](tmp_path))


@pytest.mark.slow
def test_page_numbers_missing_from_tables_are_faults(
    remake: dict[str, Any], copy: Path, tmp_path: Path
) -> None:
    page = page_of(copy)
    page.write_text(page.read_text() + "\nA sentence of yesterday.\n")
    assert remake["faults"](tmp_path) == []
    page.write_text(page.read_text() + "\nAnd 0.98765 of all runs stand.\n")
    assert any("its page says 0.98765" in row for row in remake["faults"](tmp_path))


def test_undrawn_or_uncommitted_results_are_faults(
    remake: dict[str, Any], copy: Path, tmp_path: Path
) -> None:
    path = copy / "manifest.json"
    stated = json.loads(path.read_text())
    path.write_text(json.dumps(stated | {"commit": stated["commit"] + "+", "kind": "yesterday"}))
    (copy / "make.py").unlink(missing_ok=True)
    words = " ".join(remake["faults"](tmp_path))
    assert "committed" in words
    assert "draws such results" in words


def test_headline_contradicting_its_table_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    real = headlines.headline
    monkeypatch.setattr(headlines, "headline", lambda name: real(name).replace("1.000", "1.001"))
    (fault,) = headlines.faults()
    assert fault.startswith("validity: its headline")


def test_scripts_of_published_studies_use_public_names_alone() -> None:
    checked = 0
    for script in PUBLISHED.glob("*/make.py"):
        for path in script.parent.glob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if not isinstance(node, ast.ImportFrom) or not (node.module or "").startswith("rockwobble"):
                    continue
                module, checked = str(node.module), checked + 1
                if not module.startswith(OF_A_STUDY):
                    assert module in PUBLIC, path
                    known = importlib.import_module(module)
                    assert {each.name for each in node.names} <= {*known.__all__}, path
    assert checked > 20


def test_published_diagnostics_are_codes() -> None:
    for path in PUBLISHED.rglob("*.parquet"):
        for cell in pd.read_parquet(path).get("diagnostics", []):
            assert set(codes_in(cell)) <= set(CODES), path


def test_the_guide_states_the_needs_of_the_published_limits() -> None:
    table = needs(Validity.load(PUBLISHED / "validity").tables)
    guide = (PUBLISHED.parents[1] / "docs" / "guide" / "limits.md").read_text(encoding="utf-8")
    for name in ("friction", "moment"):
        heads = [f"{each:g}" for each in sorted(table["intensity"].unique())]
        lines = [["tan α", *heads]]
        for tan_alpha, own in table.groupby("tan_alpha"):
            known = {f"{row['intensity']:g}": number(row[name], "most .3g") for row in own.to_dict("records")}
            lines.append([f"{tan_alpha:g}", *(known.get(head, "–") for head in heads)])
        head, *rows = (f"| {' | '.join(line)} |" for line in lines)
        assert head in guide
        assert "\n".join(rows) in guide


@pytest.mark.slow
@pytest.mark.parametrize("name", ["reduced", "mujoco"])
def test_published_certificates_still_verify(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["verify", str(PUBLISHED / "certificates" / f"{name}.json"), "--json"])
    assert json.loads(capsys.readouterr().out)["findings"][0]["level"] == "satisfied"
