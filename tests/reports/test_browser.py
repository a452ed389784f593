"""Every page in a browser: drawn, quiet and no wider than the window. Runs where Chromium is installed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from browser import complaints, needs_chromium

from rockwobble import compare
from rockwobble.compare import Comparison
from rockwobble.compare.studies.advice import advise
from rockwobble.models import Case, Cylinder, InitialState, el_centro_1940
from rockwobble.reports.pages import extremes, tradeoff, validity
from rockwobble.reports.pages.advice.page import advice_page
from rockwobble.reports.pages.comparison import report
from rockwobble.reports.pages.comparison.report import comparison_page, view_page
from rockwobble.reports.pages.ensemble.page import ensemble_page

PUBLISHED = Path(__file__).parents[2] / "reports" / "published"
# of a player: moved, it must say where it is
PLAYER = """
window.lookFurther = (found) => {
  const player = document.querySelector(".player");
  if (!player || !player.querySelector("canvas")) { found.push("the player is not drawn"); return; }
  const [clock, slider] = ["clock", "time"].map((part) => player.querySelector(`[data-part="${part}"]`));
  slider.value = 1.5;
  slider.dispatchEvent(new Event("input"));
  if (!clock.textContent.startsWith("1.50 s of")) found.push(`the player says ${clock.textContent}`);
};
"""
# of a suite: another case is chosen and drawn
CHOOSER = """
window.addEventListener("load", () => setTimeout(() => document.getElementById("next").click(), 300));
"""


def advice() -> str:
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940(), name="El Centro")
    return advice_page(advise(case, count=20), "rockwobble advise")


def ensemble() -> str:
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    release = InitialState(tilt=0.5 * pier.alpha, rolling_rate=0.5)
    case = Case(pier, initial=release, duration=1.0, name="release")
    return ensemble_page(compare.ensemble(case, runs=[], size=8, workers=1))


PAGES: dict[str, tuple[Callable[[], str], int]] = {
    "validity": (lambda: validity.stored_page(PUBLISHED / "validity").html(), 38),
    "tradeoff": (lambda: tradeoff.stored_page(PUBLISHED / "tradeoff").html(), 18),
    "extremes": (lambda: extremes.stored_page(PUBLISHED / "extremes").html(), 0),
    "advice": (advice, 4),
    "ensemble": (ensemble, 2),
}


@needs_chromium
@pytest.mark.parametrize("name", PAGES)
def test_page_of_a_study_is_drawn(name: str, tmp_path: Path):
    page, figures = PAGES[name]
    assert complaints(page(), tmp_path, figures=figures) == []


@needs_chromium
def test_pages_of_a_comparison_are_drawn(comparison: Comparison, tmp_path: Path, monkeypatch):
    assert complaints(comparison_page(comparison).html(), tmp_path, figures=15, further=PLAYER) == []
    (name,) = comparison.cases
    played = view_page(comparison, name)
    assert played is not None
    # drawn without a graphics card, a player takes its time: the page above had it at both widths
    assert complaints(played.html(), tmp_path, figures=0, further=PLAYER, widths=["phone"]) == []
    monkeypatch.setattr(report, "SINGLY", 0)
    assert complaints(comparison_page(comparison).html(), tmp_path, figures=7, further=CHOOSER) == []


@needs_chromium
def test_a_page_with_a_broken_figure_is_found(tmp_path: Path):
    whole = ensemble()
    broken = whole.replace("Plotly.newPlot(", "Plotly.noPlot(")
    assert broken != whole
    said = complaints(broken, tmp_path, figures=2)
    assert "screen: ensemble: not drawn" in said
    assert "phone: ensemble: not drawn" in said
    assert any("Plotly.noPlot is not a function" in line for line in said)


@needs_chromium
def test_what_a_reader_would_stumble_over_is_found(tmp_path: Path):
    whole = ensemble()
    wrong = whole.replace("share of the members [-]", 20 * "share of the members ")
    wrong = wrong.replace(
        "<header>", '<div style="width: 700px">wide</div><img src="https://example.org/a.png"><header>'
    )
    said = complaints(wrong, tmp_path, figures=3)
    assert any(line.startswith("phone: ensemble: yaxis without a unit") for line in said)
    assert any(line.startswith("phone: ensemble: text cut off") for line in said)
    assert any(line.startswith("phone: the page scrolls sideways") for line in said)
    assert "screen: 2 figures, expected 3" in said
    assert "screen: asks for https://example.org/a.png" in said
