"""Sentences on the limits of the model, for numbers that a small study does not have."""

from __future__ import annotations

import math

import pytest

from rockwobble.reports.pages.limits_in_words import (
    force_findings,
    record_findings,
    requirements,
    verdict_words,
)

RECORDS = {"points": 4.0, "members": 22.0, "recess_within": 0.0, "recess_beyond": 0.0}
RECORDS |= {"recess_least": 0.99, "recess_largest": 1.01, "strays_bounded": 0.0}
FREE = {"contradicted": 0.0, "points": 9.0}


@pytest.mark.parametrize(
    ("records", "free", "words"),
    [
        ({}, {}, ["undecided", "over 22 records its median ratio is 0.990 to 1.010."]),
        ({"recess_least": math.nan}, {}, ["undecided", "22 records are too few for an interval."]),
        ({"recess_within": 3.0}, {}, ["at 3 of 4 points and beyond at none."]),
        ({"recess_beyond": 1.0}, {}, ["not established", "at 1 of 4 points its peaks over 22 records"]),
        ({}, {"contradicted": 2.0}, ["not established", "contradicts it in 2 of 9 runs."]),
        (
            {"recess_beyond": 1.0},
            {"contradicted": 2.0},
            ["contradicts it in 2 of 9 runs, and at 1 of 4 points"],
        ),
    ],
)
def test_the_verdict_says_what_it_rests_on(records, free, words):
    said = verdict_words({"records": RECORDS | records, "free_response": FREE | free})
    assert all(each in said for each in words)
    assert said.endswith(".")  # with a space behind it the page would show its asterisks


def test_the_verdict_warns_of_single_records_where_enough_are_known():
    strays = {"flat_95_least": 1.2, "flat_95_largest": math.inf, "ring_95_least": 1.1, "ring_95_largest": 1.1}
    for within in (0.0, 1.0):
        records = RECORDS | strays | {"recess_within": within}
        said = verdict_words({"records": records, "free_response": FREE})
        assert "a factor of more than\n1.10 in a recess with clearance, 1.20 to ∞ on flat ground (∞:" in said
        assert said.endswith("in samples of 22 records; no upper bound is known.")
        known = verdict_words({"records": {**records, "strays_bounded": 1.0}, "free_response": FREE})
        assert known.endswith("in samples of 22 records.")


@pytest.mark.parametrize(
    ("slips_at", "holds_from", "slab", "words"),
    [
        (math.nan, math.nan, False, "The engine did not slip at any friction tried."),
        (0.9, math.nan, True, "At 0.9 of the demand the engine parts from the model."),
        (
            0.9,
            1.05,
            False,
            "At 0.9 of the demand the engine slides 0.02 b in one period, and the tilt errs by 3 % of α; "
            "from 1.05 of it on it holds.",
        ),
    ],
)
def test_friction_below_the_demand_does_what_was_seen(slips_at, holds_from, slab, words):
    friction = {"free_response": 1.0, "slips_at": slips_at, "holds_from": holds_from}
    friction |= {"slip": 0.02, "tilt_error": 0.03}
    contact = {"least": 0.9, "free_least": 0.8, "free_lost_from": math.nan}
    contact |= {"shaken_least": 0.956, "free_least_tan_alpha": 1.25}
    limits = {"friction": friction, "contact": contact, "restraining_moment": {"slight_up_to": 0.2}}
    said = list(force_findings(limits, slab=slab))
    assert said[1] == words
    assert said[2] == (
        "Least normal force, in weights: of the shaken motions that do not overturn 0.95; of free response "
        "0.8, at tan α = 1.25."
    )
    assert said[3] == "A recess that supplies κ = 0.1 weight × b is enough up to tan α = 0.2."


def test_runs_over_records_are_said_to_converge_only_where_they_do():
    records = {"touched": 3.0, "ring_loss_worst": 0.01, "failed": 2.0, "runs": 40.0}
    records |= {"undecided": 0.0, "ring_standing": 9.0, "ring_passed": 0.0, "ring_passed_largest": 0.9}
    records |= {f"halved{share}_{end}": 1.0 for share in ("", "_05", "_95") for end in ("least", "largest")}
    for largest, words in ((1.0, ": converged"), (1.2, ": not converged")):
        limits = {"records": {**records, "halved_95_largest": largest}}
        converged, touched, failed = record_findings(limits, slab=False)
        assert f"{words} record by record." in converged
        assert touched.startswith("Runs that touch its walls: 3,")
        assert failed == "Left out of 40 runs: 2 failed."
    assert list(record_findings({"records": records | {"failed": 0.0}}, slab=True)) == []


@pytest.mark.parametrize(
    ("undecided", "words"), [(0.0, "3 failed."), (1.0, "2 failed and 1 undecided."), (3.0, "3 undecided.")]
)
def test_failed_and_undecided_runs_are_counted_apart(undecided, words):
    records = {"halved_95_least": math.nan, "touched": 0.0, "ring_loss_worst": math.nan, "ring_passed": 0.0}
    records |= {"failed": 3.0, "undecided": undecided, "runs": 40.0}
    assert list(record_findings({"records": records}, slab=False))[-1] == f"Left out of 40 runs: {words}"


def test_runs_that_a_leaning_wall_holds_beyond_alpha_are_named():
    records = {"halved_95_least": math.nan, "touched": 0.0, "ring_loss_worst": math.nan, "failed": 0.0}
    records |= {"ring_standing": 9.0, "ring_passed": 2.0, "ring_passed_largest": 1.0302}
    passed, _ = record_findings({"records": records}, slab=False)
    assert "2 of the 9 runs counted as standing pass α and reach up to 1.04 α" in passed
    assert list(record_findings({"records": records}, slab=True)) == []


def test_a_contact_that_is_stiff_enough_says_which_runs_failed():
    contact = {"lost": 0.0, "runs": 5.0, "least_held": 0.519}
    contact |= dict.fromkeys(("lost_from", "lost_intensity"), math.nan)
    soft = {"held_up_to": 0.00229, "held_peak": 0.0494, "held_runs": 6.0, "held_ended": 6.0}
    limits = {"friction": {"shaken": 2.501}, "contact": contact, "restraining_moment": {"shaken": 0.2022}}
    rows = {row["need"]: row["limit"] for row in requirements({**limits, "soft_contact": soft})}
    assert rows["Friction"].startswith("at most 2.51 tan α")
    assert rows["Contact"].endswith("at least 0.51 of the weight")
    assert rows["Recess"].startswith("supplies κ, at most 0.21 weight")
    stiff = "a time constant of at most 0.0022/p: there the peak is off by at most 5 % in "
    assert rows["Stiffness of contact"] == f"{stiff}all 6 runs"
    soft |= {
        "held_ended": 4.0,
        "failed_up_to": 2.2e-4,
        "failed_damping_least": 0.1,
        "failed_damping_largest": 0.3,
    }
    rows = {row["need"]: row["limit"] for row in requirements({**limits, "soft_contact": soft})}
    assert rows["Stiffness of contact"] == (
        f"{stiff}the 4 of 6 runs that ended; the others failed, with up to 0.00022/p and damping ratios of "
        "0.1 to 0.3"
    )
