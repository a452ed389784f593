"""The numbers of the guide to a pier with a tendon are what its commands say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from rockwobble.models.records import p695
from rockwobble.reports.cli.main import main

pytestmark = pytest.mark.checkout

GUIDE = (Path(__file__).parents[2] / "docs" / "guide" / "tendon.md").read_text(encoding="utf-8")
COMMANDS = dict(re.findall(r"^rockwobble (\w+) (.*)$", GUIDE, flags=re.MULTILINE))
STEEL = r" --mass \S+ --tendon-force \S+ --tendon-rigidity \S+ --tendon-length \S+"
RATIOS = r" --tendon-prestress \S+ --tendon-stiffness \S+"


def page(command: str, options: str, place: Path, name: str) -> str:
    for arguments in ([command, *options.split(), "--out", str(place)], ["report", str(place)]):
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        assert not ended.value.code
    return " ".join((place / f"{name}.md").read_text(encoding="utf-8").split())


@pytest.mark.slow
def test_the_run_of_the_guide(tmp_path: Path) -> None:
    options = COMMANDS["simulate"]
    tied = page("simulate", options, tmp_path / "tied", "run")
    free = page("simulate", re.sub(STEEL, "", options), tmp_path / "free", "run")
    rows = [
        [cell.strip() for cell in row.split("|")[1:-1]] for row in GUIDE.splitlines() if row.startswith("| ")
    ]
    numbers = {row[0]: row[1:] for row in rows}
    assert f"prestress {numbers['prestress, weights of a column'][0]} weights of a column" in tied
    assert f"stiffness {numbers['stiffness, weights per base radius'][0]} weights per base radius" in tied
    for text, place in ((tied, 0), (free, 1)):
        assert f"| {numbers['uplift at'][place]} towards" in text
        assert f"= {numbers['peak tilt'][place].replace(' deg', '°')};" in text
    force = numbers["largest force in the tendon, weights of a column"][0]
    assert f"largest {force} weights of a column" in tied
    kilonewtons = re.search(r"weight of the pier, (\d+) kN", GUIDE)
    assert kilonewtons
    assert float(kilonewtons[1]) == pytest.approx(float(force) * 45.0 * 9.81, rel=5e-3)


@pytest.mark.slow
def test_the_advice_of_the_guide(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # what the guide says of it rests on no other record
    monkeypatch.setattr(p695, "PAIRS", 2)
    options = f"{COMMANDS['advise']} --copies 20"
    text = page("advise", options, tmp_path / "advice", "advice")
    uplift, balance = re.search(r"is at (\S+) g tan", GUIDE), re.search(r"from tilts up to (\S+) α", GUIDE)
    assert uplift and balance  # noqa: PT018
    assert f"Uplift at {uplift[1]} g tan α" in text
    assert f"from tilts up to {balance[1]} α" in text
    steps = re.findall(r"rockwobble (?:ensemble|compare)[^`]*tendon-force[^`]*", text)
    assert steps
    assert all("--mass 45" in step for step in steps)


@pytest.mark.slow
def test_the_fragility_of_the_guide(tmp_path: Path) -> None:
    options = COMMANDS["fragility"]
    tied = page("fragility", options, tmp_path / "tied", "fragility")
    without = re.sub(RATIOS, "", options).replace("2,3,4,6,8,12,16", "1.2,1.5,2,3,4,6,8")
    free = page("fragility", without, tmp_path / "free", "fragility")
    found = re.search(r"is (\S+ \([^)]*\)) times g tan α, without a tendon (\S+ \([^)]*\))", GUIDE)
    assert found
    assert f"by recess model: {found[1]}" in tied
    assert f"by recess model: {found[2]}" in free
