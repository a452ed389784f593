"""Diagnostics in words, and the lines on a budget."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest

from rockwobble.compare.comparison.findings import parts_finding
from rockwobble.models import Diagnostic
from rockwobble.models.diagnostic import REASONS
from rockwobble.reports.pages.comparison import counted_diagnostics, run_diagnostics
from rockwobble.reports.pages.diagnostics import failure, remarks, sentence


@pytest.mark.parametrize(("code", "reason"), [(code, each) for code in REASONS for each in REASONS[code]])
def test_each_reason_has_words_and_others_are_refused(code, reason):
    words, others = (
        sentence(Diagnostic(code=code, time=2.0, size=2.0, bound=1.0, detail=each))
        for each in (reason, next(each for each in REASONS[code] if each != reason))
    )
    assert words
    assert words != others  # each is said in its own words
    with pytest.raises(ValueError, match=f"detail must be one of .*{reason}.*, got 'because'"):
        Diagnostic(code=code, detail="because")


def test_a_diagnostic_of_two_runs_is_said_once_and_failures_apart():
    slipped, gained = Diagnostic(code="slip", time=1.0), Diagnostic(code="energy_gain", time=2.0)
    assert remarks([slipped, slipped]) == f"{sentence(slipped)}; {sentence(slipped)}"
    assert failure([slipped, gained]) == sentence(gained)
    view: Any = SimpleNamespace(
        rows=pd.DataFrame({"run": ["a", "a", "b", "c"]}), facts={"a": [slipped], "b": [slipped], "c": []}
    )
    assert run_diagnostics(view) == [f"a and b: {sentence(slipped)}."]


def test_diagnostics_of_many_cases_count_each_run_that_did_not_fail():
    rows = pd.DataFrame(
        {
            "case": "El Centro",
            "run": ["a", "a", "b"],
            "diagnostics": ["slip, lift_off", "slip, lift_off", "slip"],
            "outcome": ["stands", "stands", "failed"],
            "reference_outcome": "stands",
        }
    )
    (text,) = counted_diagnostics(rows)
    assert "1 slipped, 1 left the ground" in text
    assert counted_diagnostics(rows.assign(outcome="failed")) == []


@pytest.mark.parametrize("reason", ["", "order"])
def test_a_budget_that_is_not_split_states_no_numerics(reason):
    budget: Any = SimpleNamespace(not_split=reason, rms=lambda _: 1e-3, covered=1.6, steps=(2e-4, 1e-4))
    stated = dict(parts_finding(budget, "recess model").values)
    assert ("difference_numerics" in stated) == (not reason)
    assert (stated["difference_whole"], stated["names"]) == (1e-3, ("0.0002", "0.0001"))
    assert parts_finding(None, "flat-ground model").key == "comparison.no_parts"
