from __future__ import annotations

import math
from types import SimpleNamespace

import pandas as pd
import pytest

from rockwobble.compare.comparison.external.verdict import no_verdict
from rockwobble.reports.pages.comparison.external import (
    external_rows,
    external_sentences,
    mistakes,
    scope,
    within,
)
from rockwobble.reports.pages.comparison.findings import Finding, finding, headline, reason

AGREES = {"azimuth_rms": 0.2, "path_rms": 0.001, "tilt_bound": 0.01, "noise": 0.0}


def row(**values):
    common = {
        "run": "table",
        "engine": "table",
        "support": "external",
        "reference": "recess model",
        "reference_engine": "reduced",
        "reference_support": "recess",
        "case": "El Centro",
        "predicted_by": "",
        "outcome": "completed",
        "reference_outcome": "completed",
        "peak_tilt": 0.25,
        "reference_peak_tilt": 0.25,
        "agreement_time": 8.0,
        "diverged": False,
        "agreed_passes": 3,
        "predicted_agreement_time": 8.0,
        "contact_resolution": math.nan,
        "closest_pass": 0.003,
        "uplift_time_difference": 0.004,
        "uplift_direction_difference": -0.5,
    }
    values = common | no_verdict() | AGREES | values
    until = 1.7 if values["diverged"] else 0.0  # the uplift, where a length counts from it
    return SimpleNamespace(
        **{
            "reference_uplift_time": 1.7,
            "tolerance": 0.01,
            "left_tolerance": values["diverged"],
            "within_tolerance_until": values["agreement_time"] + until,
            "predicted_until": values["predicted_agreement_time"],
        }
        | values
    )


def said(given, end=math.nan):
    return finding(
        Finding(
            row=given,
            failed="",
            uplifted=True,
            reference_uplifted=True,
            reason=reason(given, 8.0),
            bound=within(given),
            passes=3,
            end=end,
        )
    )


def table(*rows):
    return pd.DataFrame([vars(each) for each in rows])


def test_what_agrees_is_said_to_agree():
    assert headline(table(row()), 8.0) == (
        "Brought from elsewhere, table follows the recess model within 1 % of alpha for the whole "
        "run (8.0 s), in tilt, azimuth and path."
    )
    words = said(row())
    assert "The azimuth differs by 0.2 deg (rms while the tilts agree), which is agreement." in words
    assert "mistake" not in words


def test_a_trajectory_that_is_called_a_model_is_none():
    assert "recess model stays within 1 % of alpha of the recess model" in said(row(run="recess model"))
    against = said(row(reference="clay model", reference_engine="clay model"))
    assert "within 1 % of alpha of clay model for the whole run" in against


def test_what_was_not_compared_is_said():
    alone = row(
        not_compared=("azimuth", "path"), not_given=("azimuth",), azimuth_rms=math.nan, path_rms=math.nan
    )
    assert scope(alone) == ", in tilt (not compared: azimuth and path)"
    assert external_sentences(alone) == (
        "Not compared: azimuth (not given) and path of the mass centre (too little motion)."
    )


WRONG = {
    "differs_in": ("azimuth", "path"),
    "azimuth_rms": 10.0,
    "azimuth_differs_from": 2.8,
    "path_differs_from": 5.96,
    "likely_mistake": ("turned",),
    "likely_mistake_in": ("axes",),
    "likely_mistake_value": (10.0,),
    "agreement_without_mistake": 8.0,
}


def test_a_mistake_stands_in_the_headline_and_what_is_left_without_it():
    assert headline(table(row(**WRONG)), 8.0).endswith(
        "for the whole run (8.0 s), in tilt but not in azimuth and path of the mass centre. Likely mistake: "
        "its axes are turned by 10.0 deg (counter-clockwise)."
    )
    words = said(row(**WRONG))
    assert "The azimuth differs by 10.0 deg (rms while the tilts agree), from 2.80 s on." in words
    assert words.endswith("Without it, the tilt follows the model until 9.7 s.")
    left = external_sentences(row(**WRONG, differs_without_mistake=("tilt", "path")))
    assert left.endswith(
        "Without it, the tilt follows the model until 9.7 s, but it differs in tilt and path."
    )
    other = external_sentences(
        row(**WRONG, alternative_mistake=("mirrored",), alternative_mistake_value=(25.0,))
    )
    assert other.endswith(
        "Or, which here is the same: its azimuth is mirrored in the line at 25.0 deg, so that it rolls the "
        "other way round."
    )


def test_a_difference_that_no_mistake_explains_is_said_to_be_none():
    words = external_sentences(row(differs_in=("azimuth",), azimuth_differs_from=3.0))
    assert words.endswith("No mistake of axes, units, clock or origin explains that.")


@pytest.mark.parametrize(
    ("part", "code", "value", "words"),
    [
        ("time", "time_offset", -0.3, "its clock is 0.300 s late: an offset of -0.300 s takes that back"),
        ("time", "time_offset", 0.3, "its clock is 0.300 s early: an offset of 0.300 s takes that back"),
        ("azimuth", "angle_unit", 57.2958, "its azimuth is in degrees, read as radians"),
        ("tilt and azimuth", "angle_unit", 0.0174533, "its tilt and azimuth are in radians, read as degrees"),
        ("path", "length_unit", 1000.0, "x, y and z are in mm, read as m"),
        ("path", "z_reversed", math.nan, "z points down"),
        ("path", "origin", 5.88, "x, y and z are counted from a point 5.88 m from the original base centre"),
        (
            "axes",
            "axes_exchanged",
            math.nan,
            "its axes are mirrored: x and y are exchanged, or azimuths are counted",
        ),
        ("azimuth", "turned_back", math.nan, "its azimuth is turned by 180 deg"),
        ("path", "y_reversed", math.nan, "its path is mirrored: y has the other sign"),
    ],
)
def test_each_code_has_its_words(part, code, value, words):
    (said,) = mistakes(row(likely_mistake=(code,), likely_mistake_in=(part,), likely_mistake_value=(value,)))
    assert said.startswith(words)


def test_two_mistakes_keep_their_own_values():
    both = row(
        likely_mistake=("x_reversed", "length_unit"),
        likely_mistake_in=("axes", "path"),
        likely_mistake_value=(math.nan, 100.0),
    )
    assert mistakes(both) == [
        "its axes are mirrored: x has the other sign",
        "x, y and z are in cm, read as m",
    ]


def test_the_uplift_carries_its_uncertainty():
    early = row(uplift_time_difference=-0.004, uplift_time_uncertainty=0.012)
    assert external_sentences(early).endswith(
        "It uplifts 0.004 s before the model, where its samples tell ± 0.012 s."
    )
    apart = row(
        uplift_time_uncertainty=0.012,
        uplift_direction_uncertainty=0.1,
        differs_in=("uplift_direction",),
    )
    assert "and 29 deg from its direction, where they tell ± 6 deg." in external_sentences(apart)


def test_noise_widens_what_agreement_means_and_says_so():
    assert within(row()) == "1 % of alpha"
    assert within(row(tilt_bound=0.034)) == "3.4 % of alpha (1 % and the noise)"
    assert "within 3.4 % of alpha (1 % and the noise)" in headline(table(row(tilt_bound=0.034)), 8.0)


def test_the_table_has_the_numbers_and_codes_of_each_external_trajectory():
    engine = row(support="recess", run="mujoco recess")
    (line,) = external_rows(table(engine, row(**WRONG, uplift_time_uncertainty=0.012)))
    names = ("run", "azimuth_rms", "azimuth_differs_from", "path_rms", "path_differs_from", "uplift")
    assert [line[name] for name in names] == ["table", 10.0, 2.8, 0.001, 5.96, 0.004]
    assert (line["differs_in"], line["likely_mistake"]) == ("azimuth; path", "axes: turned")
    # of the direction nothing is known
    assert (line["towards"], line["towards_uncertainty"]) == (None, None)
    (other,) = external_rows(table(row(uplift_direction_uncertainty=4.0)))
    assert (other["towards"], other["towards_uncertainty"]) == (math.degrees(-0.5), 180.0)
    assert external_rows(table(engine)) == []


def test_a_divergence_of_an_external_trajectory_has_its_own_reasons():
    text = said(row(diverged=True, agreement_time=4.0))
    assert "the closest pass until then comes within 0.003 alpha of upright" in text
    assert "small difference there is in the body, its start, the ground motion or the method" in text
    none = said(row(diverged=True, closest_pass=math.nan))
    assert "not chance but the body, its start, the ground motion or the method differs" in none
    assert "resolve" not in text + none
    assert "then they diverge: see the likely mistake." in said(row(diverged=True, **WRONG))


def test_a_file_that_ends_early_is_not_the_whole_run() -> None:
    assert headline(table(row()), 20.0) == (
        "Brought from elsewhere, table follows the recess model within 1 % of alpha to its end (8.0 s), "
        "in tilt, azimuth and path."
    )
    words = said(row(reference_peak_tilt=0.5), end=8.0)
    assert "to its end, at 8 s of the run (3 passes by upright); what comes after is not known." in words
    assert "Peak tilt is 0.25 alpha up to there against 0.5 alpha of the whole run." in words
