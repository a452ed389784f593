"""The code of the guide to your own metric and figure runs, and its results are what it says they are."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rockwobble.reports.cli.main import main

pytestmark = pytest.mark.checkout

CHECKOUT = Path(__file__).parents[2]
GUIDE = (CHECKOUT / "docs" / "guide" / "own-figure.md").read_text(encoding="utf-8")
STUDY = CHECKOUT / "reports" / "published" / "fragility" / "p695"


def report(tmp_path: Path, *formats: str) -> None:
    options = [word for form in formats for word in ("--format", form)]
    with pytest.raises(SystemExit) as ended:
        main(["report", str(STUDY), "--out", str(tmp_path), *options])
    assert not ended.value.code


@pytest.mark.slow
def test_the_code_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "reports").symlink_to(CHECKOUT / "reports")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    blocks = re.findall(r"^```python\n(.*?)^```$", GUIDE, flags=re.DOTALL | re.MULTILINE)
    assert len(blocks) == 5
    for block in blocks:
        exec(compile(block, "own-figure.md", "exec"), names)
    assert names["medians"].shape == (10, 3)
    assert names["larger"].between(0.0, 1.0).all()
    trace, case = names["trace"], names["case"]
    spacing = np.diff(trace.time)
    share = (trace.tilt[1:] > 0.1 * case.cylinder.alpha) @ spacing
    assert names["time_above"] == pytest.approx(share, abs=spacing.max() * 100)
    assert (tmp_path / "pier.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "trace.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "overturning.pdf").read_bytes().startswith(b"%PDF")
    assert r"pier [alpha] & tower [alpha]" in names["text"]


@pytest.mark.slow
def test_the_files_that_the_guide_names(tmp_path: Path) -> None:
    report(tmp_path, "tex", "png")
    (name,) = re.findall(r"\\input\{(.*?)\}", GUIDE)
    table = (tmp_path / name).read_text(encoding="utf-8")
    head = table.splitlines()[2]
    assert "median [-]" in head
    assert "95 \\% from" in head
    assert {line.count("&") for line in table.splitlines() if line.endswith(r"\\")} == {head.count("&")}
    for place in sorted(tmp_path.glob("*.tex")):  # nothing is left that a text font of LaTeX lacks
        assert place.read_text(encoding="utf-8").isascii(), place.name
    for number in (1, 2, 3):
        assert (tmp_path / f"fragility-{number}.png").read_bytes().startswith(b"\x89PNG")


def test_an_unknown_format_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["report", str(STUDY), "--out", str(tmp_path), "--format", "eps"])
    assert ended.value.code == 2
    assert "--format must be one of pdf, png, tex, " in capsys.readouterr().err
