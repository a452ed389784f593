"""What commands print on 80 columns."""

from __future__ import annotations

from pathlib import Path

import pytest

from rockwobble.reports.cli.main import main


@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(
    ("command", "most"),
    [
        ("compare --duration 4 --engine mujoco", 20),
        ("simulate --diameter 1.6 --height 9", 20),
        ("advise --diameter 1.6 --height 9 --friction 0.5 --copies 20 --engine none --duration 6", 33),
        ("fragility --synthetic 4 --levels 1,4,8", 18),
    ],
)
def test_an_answer_fits_on_a_screen_of_80_columns(
    command: str,
    most: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        main([*command.split(), "--out", "here"])
    assert ended.value.code == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= most
    assert max(map(len, lines)) <= 80
