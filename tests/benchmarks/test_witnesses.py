"""Failure of a witness process becomes a table row."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from . import witnesses


@pytest.mark.parametrize("ending", ["import os; os.abort()", "raise SystemExit('ERROR in it')", ""])
def test_witness_process_without_answer_gives_a_table_row(
    ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "witness_lmgc90.py").write_text(ending)
    monkeypatch.setattr(witnesses, "__file__", str(tmp_path / "witnesses.py"))
    answer = witnesses.asked(sys.executable, "lmgc90", "plane", {"corners": 21, "step": 1e-3})
    assert "its process ends" in witnesses.row("plane", "21 corners", answer)
    assert ("ERROR in it" in answer["ends"]) == ("ERROR" in ending)
