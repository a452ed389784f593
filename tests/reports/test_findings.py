from __future__ import annotations

import math
from types import SimpleNamespace

import pandas as pd
import pytest

from rockwobble.reports.pages.comparison.budget_words import parting_lines
from rockwobble.reports.pages.comparison.findings import finding, headline, small

LENGTH = 50.0


def row(**values):
    return SimpleNamespace(
        **{
            "engine": "mujoco",
            "support": "recess",
            "reference": "recess",
            "outcome": "completed",
            "reference_outcome": "completed",
            "message": "",
            "peak_tilt": 0.25,
            "reference_peak_tilt": 0.25,
            "agreement_time": 20.0,
            "diverged": True,
            "agreed_passes": 7,
            "predicted_agreement_time": 18.0,
            "contact_resolution": 2e-5,
            "closest_pass": 3e-3,
        }
        | values
    )


def test_agreement_to_the_end():
    text = finding(row(diverged=False, agreement_time=50.0), LENGTH)
    assert "stays within 1 % of alpha of the recess model for the whole run (50.0 s, 7 passes" in text
    assert "part" not in text.replace("parts", "")


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "at 18.0 s a pass comes closer to upright than the contact resolves (2 × 10⁻⁵ rad)"),
        ({"predicted_agreement_time": 30.0}, "the closest of which comes within 0.003 alpha of upright"),
        (
            {"predicted_agreement_time": 30.0, "closest_pass": math.nan},
            "an error of the method and not of chance",
        ),
        ({"support": "flat"}, "on open ground the cylinder may roll out"),
        ({"support": "flat", "reference": "flat"}, "a pass comes closer to upright"),
        ({"support": "ring"}, "only where it has rolled out as far as their clearance"),
        (
            {"support": "ring", "reference": "flat", "message": "the cylinder touched a wall from 2 s on"},
            "each touch takes energy",
        ),
        ({"support": "ring", "reference": "flat"}, "a pass comes closer to upright"),
    ],
)
def test_a_parting_and_its_reason_follow_from_the_numbers(values, words):
    text = finding(row(**values), LENGTH)
    assert "for 20.0 s from uplift or release (7 passes), then they part" in text
    assert words in text


def test_of_a_trajectory_from_elsewhere_nothing_is_said_about_contact():
    unknown = {"support": "external", "engine": "table", "contact_resolution": math.nan}
    text = finding(row(**unknown, predicted_by=""), LENGTH)
    assert "table external stays within 1 % of alpha of the recess model for 20.0 s" in text
    assert "closest pass until then comes within 0.003 alpha of upright" in text
    none = finding(row(**unknown, predicted_by="", closest_pass=math.nan), LENGTH)
    assert "not chance but the body, its start, the ground motion or the method differs" in none
    assert "resolve" not in text + none
    assert headline(table(row(**unknown)), LENGTH).startswith(
        "Brought from elsewhere (external), table follows"
    )


def test_a_trajectory_from_elsewhere_cannot_part_too_early():
    early = {"case": "El Centro", "run": "table external", "divergence": "earlier"}
    assert parting_lines(table(row(**early, support="external"))) == []
    assert "a finding" in parting_lines(table(row(**early)))[0]


def test_peaks_are_told_apart_only_where_they_differ():
    assert "Peak tilt is the same to 0.4 %" in finding(row(peak_tilt=0.251), LENGTH)
    assert "Peak tilt is 0.3 alpha against 0.25 alpha." in finding(row(peak_tilt=0.3), LENGTH)


def test_outcomes_that_are_no_traces():
    fell = row(outcome="overturned", message="only mujoco overturned; compared up to 9 s")
    assert "Only mujoco overturned" in finding(fell, LENGTH)
    both = row(outcome="overturned", reference_outcome="overturned", message="both overturned")
    assert finding(both, LENGTH).endswith("Both overturn.")
    failed = row(outcome="failed", message="mujoco failed: it gained energy", peak_tilt=math.nan)
    assert (
        finding(failed, LENGTH) == "mujoco recess against the recess model: mujoco failed: it gained energy."
    )
    still = row(message="neither uplifted: there is no motion to compare", peak_tilt=0.0)
    assert "does not uplift the cylinder" in finding(still, LENGTH)


def table(*rows):
    return pd.DataFrame([vars(r) for r in rows])


def test_headline_speaks_of_each_run_against_the_model_of_its_support():
    first = row(agreement_time=20.0)
    second = row(engine="pybullet", agreement_time=12.0)
    other = row(support="flat", agreement_time=2.0)
    own = row(support="flat", reference="flat", diverged=False, agreement_time=50.0)
    assert headline(table(first, second, other, own), LENGTH) == (
        "In an ideal recess (guided), mujoco and pybullet follow the recess model within 1 % of alpha "
        "for 12.0 s to 20.0 s from uplift or release. "
        "On open ground (free), mujoco follows the flat-ground model within 1 % of alpha "
        "for the whole run (50.0 s). "
        "Once traces have diverged, compare distributions."
    )
    assert headline(table(row(diverged=False)), LENGTH).endswith(
        "within 1 % of alpha for the whole run (50.0 s)."
    )
    assert headline(table(row(outcome="failed")), LENGTH) == "No run could be compared."


@pytest.mark.parametrize(
    ("value", "text"), [(0.0213, "0.02"), (0.001, "0.001"), (2.4e-5, "2 × 10⁻⁵"), (9.7e-11, "1 × 10⁻¹⁰")]
)
def test_small_numbers_can_be_read(value, text):
    assert small(value) == text
