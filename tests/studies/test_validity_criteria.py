"""Criteria of the validity study: which limits establish the model, and which contradict it."""

from __future__ import annotations

import math

import pytest

from rockwobble.compare.metrics.statistics import MARGIN
from rockwobble.studies.validity.criteria import (
    clearance_is_unconservative,
    converges_by_record,
    model_verdict,
)


@pytest.mark.parametrize(
    ("contradicted", "beyond", "within", "verdict"),
    [
        (0.0, 0.0, 0.0, "undecided"),
        (0.0, 0.0, 1.0, "established"),
        (0.0, 1.0, 2.0, "contradicted"),
        (1.0, 0.0, 2.0, "contradicted"),
    ],
)
def test_one_contradiction_outweighs_any_agreement(contradicted, beyond, within, verdict):
    records = {"recess_beyond": beyond, "recess_within": within}
    assert model_verdict({"free_response": {"contradicted": contradicted}, "records": records}) == verdict


@pytest.mark.parametrize(("largest", "expected"), [(1.01, True), (1.0, False), (math.nan, False)])
def test_a_recess_with_clearance_is_unconservative_where_it_tilts_more(largest, expected):
    assert clearance_is_unconservative({"records": {"ring_95_largest": largest}}) == expected
    assert not clearance_is_unconservative({"records": {}})  # under a slab there is none


@pytest.mark.parametrize(
    ("least", "largest", "expected"),
    [
        (1.0 / (1.0 + MARGIN), 1.0 + MARGIN, True),
        (1.0 / (1.0 + MARGIN) - 1e-3, 1.0, False),
        (1.0, 1.0 + MARGIN + 1e-3, False),
    ],
)
def test_runs_converge_where_neither_tail_leaves_the_margin(least, largest, expected):
    records = {"halved_05_least": least, "halved_95_largest": largest}
    assert converges_by_record({"records": records}) == expected
