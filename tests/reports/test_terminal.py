"""What commands print on 80 columns."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from rockwobble.reports.cli.main import main


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process", "six_records")
@pytest.mark.parametrize(
    ("command", "most"),
    [
        ("compare", 14),
        ("simulate", 16),
        ("advise --diameter 1.6 --height 9 --friction 0.5 --copies 20", 26),
        ("fragility --synthetic 4 --levels 1,4,8", 8),
    ],
)
def test_an_answer_fits_on_a_screen_of_80_columns(
    command: str,
    most: int,
    no_engines: Callable[..., None],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    no_engines()
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        main([*command.split(), "--out", "rockwobble-answer"])
    assert ended.value.code == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    assert len(lines) <= most
