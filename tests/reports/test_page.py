from __future__ import annotations

import re
from html.parser import HTMLParser

import pytest
from showing import is_golden

import rockwobble as rw
from rockwobble.compare import SUMMARY_COLUMNS
from rockwobble.models import Case, Cylinder, Diagnostic, InitialState, Run
from rockwobble.reports.pages import page_of
from rockwobble.reports.pages.diagnostics import sentence

PAGE_LIMIT = 2_000_000  # [bytes]
PICTURE_LIMIT = 300_000  # [bytes]


class Elements(HTMLParser):
    """Names and attributes of all elements, and the text outside of scripts and styles."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.text: list[str] = []
        self._silent = False
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))
        self._silent = tag in ("script", "style")

    def handle_endtag(self, tag):
        self._silent = False

    def handle_data(self, data):
        if not self._silent:
            self.text.append(data)


@pytest.mark.slow
def test_page_is_whole_small_and_reproducible(comparison):
    made = comparison.made_by("rockwobble compare")
    page = page_of(made).html()
    assert len(page.encode()) < PAGE_LIMIT
    elements = Elements(page)
    for tag, attributes in elements.found:
        assert not (tag == "script" and "src" in attributes)
        assert not (tag == "link" and attributes.get("href") != "data:,")
        assert tag not in ("img", "iframe", "object")
    plots = {a["id"] for tag, a in elements.found if tag == "div" and a.get("class") == "chart"}
    assert plots == {
        *(f"figure-{panel}" for panel in range(4)),  # two supports, two references
        *(f"orbits-0-{run}" for run in range(4)),
        *(f"contact-0-{panel}" for panel in range(3)),  # azimuth, drift by support
        "turns-0-0",
        *(f"residuals-0-{panel}" for panel in range(2)),
        "excitation-0-0",
    }
    text = " ".join(" ".join(elements.text).split())
    assert "b = 1.177 m, 2h = 11.77 m, alpha = 11.31°" in text
    for name in SUMMARY_COLUMNS:
        if name not in ("case", "run", "reference"):
            assert name.replace("_", " ") in text
    assert "nan" not in re.findall(r"\w+", text)
    files = page_of(made).files()
    assert set(files) == {"report.html", "report.md", "figure.svg"}
    assert files["report.html"] == page.encode(), "drawn again it must be the same"
    picture = files["figure.svg"]
    assert picture.startswith(b"<?xml")
    assert len(picture) < PICTURE_LIMIT
    assert b"](figure.svg)" in files["report.md"]


def test_still_ground_has_no_excitation_and_markup_in_a_name_stays_text(no_engines):
    no_engines()
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    release = InitialState(tilt=0.5 * cylinder.alpha, rolling_rate=0.5)
    case = Case(cylinder, initial=release, duration=2.0, name="<b>name</b> & co")
    page = page_of(rw.comparison(case, runs=[Run("mujoco", "recess")]).made_by()).html()
    assert "excitation-0" not in page
    assert "<b>name</b>" not in page
    assert "&lt;b&gt;name&lt;/b&gt; &amp; co" in page


@pytest.mark.slow
def test_a_run_that_never_moves_or_fails_can_be_shown(no_engines):
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    case = Case(cylinder, duration=1.0, name="still")
    no_engines()
    still = page_of(rw.comparison(case, runs=[Run("mujoco", "recess")]).made_by()).files()
    assert "stay at rest" in still["report.html"].decode()
    assert still["figure.svg"]
    gained = (Diagnostic(code="energy_gain", time=0.5),)
    no_engines(outcome="failed", facts=gained, peak_tilt=float("nan"))
    failed = page_of(rw.comparison(case, runs=[Run("mujoco", "recess")]).made_by()).files()
    assert sentence(gained[0]) in failed["report.html"].decode()
    assert failed["figure.svg"]


def test_release_page_matches_golden_file(no_engines):
    no_engines()
    pier = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
    release = InitialState(tilt=0.5 * pier.alpha, rolling_rate=0.5)
    case = Case(pier, initial=release, duration=8.0, name="release")
    is_golden(rw.comparison(case, runs=[Run("mujoco", "recess"), Run("mujoco", "flat")]))
