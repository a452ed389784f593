"""Every page in a browser: drawn, quiet and no wider than the window. Runs where Chromium is installed."""

from __future__ import annotations

from pathlib import Path

import pytest
from browser import complaints, needs_chromium

import rockwobble as rw
from rockwobble.compare import Comparison
from rockwobble.compare.comparison.result import View
from rockwobble.compare.storage.manifest import MANIFEST, file_state, read_manifests
from rockwobble.models import Case, Cylinder, InitialState
from rockwobble.reports.pages import comparison as report
from rockwobble.reports.pages import page_of, stored_page
from rockwobble.reports.pages.ensemble import page_of as ensemble_page
from rockwobble.reports.registry import KINDS

pytestmark = [pytest.mark.slow, pytest.mark.checkout]

# player: reports its position after a move
PLAYER = """
window.lookFurther = (faults) => {
  const player = document.querySelector(".player");
  if (!player || !player.querySelector("canvas")) { faults.push("the player is not drawn"); return; }
  const [clock, slider] = ["clock", "time"].map((part) => player.querySelector(`[data-part="${part}"]`));
  slider.value = 1.5;
  slider.dispatchEvent(new Event("input"));
  if (!clock.textContent.startsWith("1.50 s of")) faults.push(`the player says ${clock.textContent}`);
};
"""
# suite: another case is chosen and drawn
CHOOSER = """
window.addEventListener("load", () => setTimeout(() => document.getElementById("next").click(), 300));
"""


def ensemble() -> str:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    release = InitialState(tilt=0.5 * pier.alpha, rolling_rate=0.5)
    case = Case(pier, initial=release, duration=1.0, name="release")
    ensemble = rw.ensemble(case, runs=[], copies=8, workers=1)
    return ensemble_page(ensemble.made_by()).html()


PUBLISHED = Path(__file__).parents[2] / "reports" / "published"
# of each kind one whose tables are all kept
WHOLE = {
    made.kind: path.parent
    for path in sorted(PUBLISHED.rglob(MANIFEST))
    for made in read_manifests(path.parent)
    if made.kind in KINDS and all(file_state(path.parent, made, name) == "whole" for name in made.files)
}


@needs_chromium
@pytest.mark.parametrize("kind", sorted(WHOLE))
def test_page_of_a_study_is_drawn(kind: str, tmp_path: Path):
    folder = WHOLE[kind]
    page = stored_page(kind, folder).html()
    assert complaints(page, tmp_path, figures=page.count('class="chart"')) == []


@needs_chromium
def test_pages_of_a_comparison_are_drawn(comparison: Comparison, tmp_path: Path, monkeypatch):
    assert complaints(page_of(comparison.made_by()).html(), tmp_path, figures=15, further=PLAYER) == []
    played = page_of(View.of(comparison, "El Centro 1940").made_by())
    assert complaints(played.html(), tmp_path, figures=0, further=PLAYER) == []
    monkeypatch.setattr(report, "SINGLY", 0)
    assert complaints(page_of(comparison.made_by()).html(), tmp_path, figures=6, further=CHOOSER) == []


@needs_chromium
def test_page_faults_are_detected(tmp_path: Path):
    whole = ensemble()
    broken = whole.replace("LAYERS[layer.kind](", "LAYERS[layer.no_kind](")
    wrong = whole.replace("share of the members [-]", 20 * "share_of_the_members_")
    wide = '<div style="width: 700px">wide</div><img src="https://example.org/a.png"><h1'
    faults = {
        broken: ["screen: ensemble-0: empty", "phone: ensemble-0: empty", "is not a function"],
        wrong.replace("<h1", wide): [
            "phone: ensemble-0: y without a unit",
            "phone: ensemble-0: text cut off",
            "phone: the page scrolls sideways",
            "screen: 2 figures, expected 3",
            "screen: asks for https://example.org/a.png",
        ],
    }
    for page, expected in faults.items():
        assert page != whole
        said = complaints(page, tmp_path, figures=3)
        assert [each for each in expected if not any(each in line for line in said)] == []
