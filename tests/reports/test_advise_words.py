"""The sentences of an advice, at the thresholds of the numbers that they are made from."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from rockwobble.compare.studies.advice import Demands, PlanarView, Trust
from rockwobble.reports.pages.advice.scale_words import overturning_words, planar_words, uplift_words
from rockwobble.reports.pages.advice.words import (
    contact_words,
    couple_words,
    engine_words,
    error_words,
    friction_words,
    horizon_words,
    trust_words,
)

ALPHA = 0.2


def demands(**values) -> Demands:
    return Demands(
        **{
            "moving_time": 20.0,
            "friction": 0.5,
            "friction_needed": 0.31,
            "friction_usual": 0.21,
            "slip_from": math.nan,
            "slip_time": 0.0,
            "slides": False,
            "couple": 1.23,
            "couple_usual": 0.5,
            "couple_in_radii": 0.1,
            "least_normal_force": 0.9,
            "largest_normal_force": 2.0,
            "lost_from": math.nan,
            "lost_time": 0.0,
        }
        | values
    )


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "A friction of 0.5 suffices: it takes 0.31 at most, and 0.21 in 99 % of the time in motion."),
        ({"slip_from": 3.0, "slip_time": 0.4}, "slip from 3.0 s on, for 0.4 s in all (2 % of the time"),
        ({"friction_needed": math.inf}, "suffices: it takes 0.21 in 99 % of the time in motion, and more"),
        ({"friction_needed": math.inf, "friction_usual": math.inf}, "more than any friction for over 1 %"),
        ({"friction": 0.1, "slides": True}, "below b/h = 0.2: at rest the cylinder slides"),
    ],
)
def test_friction(values, words):
    assert words in friction_words(demands(**values), 0.2)


def test_couple_in_units_of_a_designer():
    said = couple_words(demands(), "recess")
    assert "up to 1.23 kN m for each tonne of its mass (0.1 weight × b)" in said
    assert "no couple" in couple_words(demands(couple_in_radii=1e-17), "recess")
    assert "rolling out of its place" in couple_words(demands(), "flat")


def test_contact():
    assert "never lost: the normal force stays between 0.9 and 2 weights" in contact_words(demands())
    lost = demands(lost_from=4.0, lost_time=0.01, least_normal_force=-0.5)
    assert contact_words(lost) == (
        "Contact would be lost from 4.0 s on, for 0.01 s in all (0.05 % of the time in motion): the ground "
        "would have to pull with 0.5 weights."
    )


@pytest.mark.parametrize(("reason", "words"), [("pass", "closer to upright"), ("growth", "multiplied")])
def test_horizon_gives_its_reason(reason, words):
    said = horizon_words(7.0, reason, 2.0, 50.0)
    assert "for 7.0 s from uplift or release, until 9.0 s" in said
    assert words in said
    assert "to the end (50.0 s)" in horizon_words(50.0, "", 2.0, 50.0)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "mujoco recess agreed for 20.0 s, as predicted. Its largest tilt is 0.25 α against 0.24 α."),
        ({"divergence": "later"}, "longer than predicted"),
        ({"divergence": "earlier"}, "do not rely on either"),
        ({"diverged": False, "divergence": "never, as predicted"}, "agreed to the end"),
        ({"outcome": "overturned"}, "It overturns."),
        ({"outcome": "failed", "message": "gained energy"}, "could not verify that: gained energy."),
    ],
)
def test_engine(values, words):
    found = {
        "label": "mujoco recess",
        "outcome": "completed",
        "message": "",
        "diverged": True,
        "divergence": "in time",
        "agreement": 20.0,
        "peak_tilt": 0.25,
    }
    assert words in engine_words(SimpleNamespace(**(found | values)), 0.24)


def test_trust():
    whole = trust_words(Trust(kind="trace", until=9.0, because=""), 5.0, 100, 1.0)
    assert whole.startswith("Trust the trace to its end")
    peak = trust_words(Trust(kind="peak", until=9.0, because="data"), 5.0, 100, 1.0)
    assert "until 9.0 s, the largest tilt (5.0 s) included; 100 starts 1 % off" in peak
    statistics = Trust(kind="statistics", until=4.0, because="methods")
    said = trust_words(statistics, 5.0, 100, 1.0, what="fall", verified=False)
    assert "only statistics from then on, those of the fall (here at 5.0 s) included" in said
    assert said.endswith("as predicted.")
    assert "one plane" in trust_words(statistics, 5.0, 100, 1.0, in_one_plane=True)


def view(spatial: float, x: float, y: float, **values) -> PlanarView:
    return PlanarView(
        **{
            "spatial": spatial,
            "planar_x": x,
            "planar_y": y,
            "neighbours": 25,
            "larger": 0.6,
            "missed": 0.2,
            "lowest_spatial": 1.4,
            "lowest_planar": 2.2,
        }
        | values
    )


FELL = 0.5 * math.pi


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (
            view(0.08, 0.02, 0.04),
            "unconservative at this scale: 0.1 α (x) and 0.2 α (y), 0.4 α in 3D, 2 times",
        ),
        (view(0.03, 0.02, 0.04), "Planar analysis is conservative at this scale"),
        (view(0.04, 0.02, 0.04), "At this scale planar analysis gives the same"),
        (view(FELL, 0.02, 0.04), "unconservative: 3D overturns, the components alone tilt to 0.1 α"),
        (view(0.02, FELL, 0.04), "a component overturns, 3D tilts to 0.1 α"),
        (view(FELL, FELL, 0.04), "3D overturns, and so does planar analysis of a component"),
        (view(0.0, 0.0, 0.0), "At this scale nothing uplifts"),
        (view(0.08, 0.0, 1e-6), "5 × 10⁻⁶ α (y), 0.4 α in 3D. Of 25"),
    ],
)
def test_planar(found, words):
    said = planar_words(found, ALPHA)
    assert words.replace(" × 10", "\u00a0×\u00a010") in said
    assert said.endswith("3D tilts more than both planes at 60 %, and overturns alone at 20 %.")


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "0 % of the perturbed starts overturn. The lowest scale found that does is 1.4 times"),
        ({}, "All below it that was run stands, in steps of 0.007 times and less; a narrower window"),
        ({"lowest": 0.8}, "But it stands in a gap: 0.8 times this shaking, which is weaker, overturns it"),
        ({"falls": True, "lowest": 0.8, "chance": 0.91}, "at 37.5 s; 91 % of the perturbed starts"),
        ({"lowest": math.nan}, "No scale up to 16 times this shaking was found to overturn it, in steps of"),
        ({"planar": 2.2}, "Planar analysis would say 2.2 times."),
        ({"confirmed": False}, "It is a matter of chance: at a tolerance of 1e-09"),
    ],
)
def test_overturning(values, words):
    given = {
        "falls": False,
        "fall": 37.5,
        "lowest": 1.4,
        "planar": math.nan,
        "chance": 0.0,
        "search": 0.007,
        "confirmed": True,
    } | values
    assert words in overturning_words(**given, highest=16.0)
    assert overturning_words(**(given | {"chance": math.nan}), highest=math.nan).endswith(".")
    assert "chance" not in overturning_words(**(given | {"confirmed": True}), highest=16.0)


def test_the_larger_error_is_named():
    of_data = error_words(0.36, -0.35, 0.24, 0.33, 1.0, single=False)
    assert "0.24 to 0.33 α (90 % of the starts), an error of up to 36 %" in of_data
    assert "-35 % in the median of the starts. The larger of the two is due to the data" in of_data
    assert "due to the support" in error_words(0.36, -0.37, 0.24, 0.33, 1.0, single=True)
    assert "no difference in this run" in error_words(0.016, 6e-8, 0.4, 0.41, 1.0, single=True)
    assert "0.24 α to overturning" in error_words(math.inf, math.nan, 0.24, 8.0, 1.0, single=True)
    assert error_words(math.nan, math.nan, 0.0, 0.0, 1.0, single=True) == ""


def test_uplift():
    assert uplift_words(1.4).startswith("It takes 1.4 times")
    assert uplift_words(0.7).startswith("0.7 times this shaking is enough")
