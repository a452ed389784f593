"""Sentences on the limits of the model, for numbers that a small study does not have."""

from __future__ import annotations

import math

import pytest

from rockwobble.reports.pages.limits_in_words import force_findings, record_findings, verdict_words

RECORDS = {"points": 4.0, "members": 22.0, "recess_within": 0.0, "recess_beyond": 0.0}
RECORDS |= {"recess_least": 0.99, "recess_largest": 1.01}
FREE = {"contradicted": 0.0, "points": 9.0}


@pytest.mark.parametrize(
    ("records", "free", "words"),
    [
        ({}, {}, ["undecided", "over 22 records its median ratio is 0.990 to 1.010."]),
        ({"recess_least": math.nan}, {}, ["undecided", "22 records are too few for an interval."]),
        ({"recess_within": 3.0}, {}, ["at 3 of 4 points and beyond at none."]),
        ({"recess_beyond": 1.0}, {}, ["not established", "at 1 of 4 points its peaks over 22 records"]),
        ({}, {"contradicted": 2.0}, ["not established", "contradicts it at 2 of 9 releases."]),
        (
            {"recess_beyond": 1.0},
            {"contradicted": 2.0},
            ["contradicts it at 2 of 9 releases, and at 1 of 4 points"],
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
    limits = {"friction": friction, "contact": contact, "restraining_moment": {"slight_up_to": 0.2}}
    said = list(force_findings(limits, slab=slab))
    assert said[1] == words
    assert said[2] == "Least normal force: 0.9 weights, in free response 0.8."
    assert said[3] == "A recess that supplies κ = 0.1 weight × b is enough up to tan α = 0.2."


def test_runs_over_records_are_said_to_converge_only_where_they_do():
    records = {"touched": 3.0, "ring_loss_worst": 0.01, "failed": 2.0, "runs": 40.0}
    records |= {f"halved{share}_{end}": 1.0 for share in ("", "_05", "_95") for end in ("least", "largest")}
    for largest, words in ((1.0, ": converged"), (1.2, ": not converged")):
        limits = {"records": {**records, "halved_95_largest": largest}}
        converged, touched, failed = record_findings(limits, slab=False)
        assert f"{words} record by record." in converged
        assert touched.startswith("Runs that touch its walls: 3,")
        assert failed == "Failed and left out: 2 of 40 runs."
    assert list(record_findings({"records": records | {"failed": 0.0}}, slab=True)) == []
