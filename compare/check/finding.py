"""Findings of the checks: a measured value, its bound, and what is suspect where it is beyond it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from rockwobble.models.shown import Brief

Outcome = Literal["passed", "FAILED", "no baseline", "not run"]
PASSED: Outcome = "passed"
FAILED: Outcome = "FAILED"
NO_BASELINE: Outcome = "no baseline"
NOT_RUN: Outcome = "not run"


@dataclass(frozen=True, slots=True)
class Bound:
    """Upper bound of a measured value.

    Parameters
    ----------
    most : float
    reason : str
        Where the bound comes from.
    unit : str, optional
        Empty for a ratio.
    """

    most: float
    reason: str
    unit: str = ""


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Finding(Brief):
    """One check.

    Parameters
    ----------
    layer : str
        One of `LAYERS`; empty until `run_checks` has put it in its place.
    name : str
        What was measured.
    value, bound : float
        The check holds where the value is at most the bound. NaN holds nowhere.
    unit : str
        Of both; empty for a ratio.
    reason : str
        Where the bound comes from.
    part : str
        What is suspect where the check fails.
    outcome : {"passed", "FAILED", "no baseline", "not run"}
    note : str
        What else there is to say, such as the budget of a difference.
    """

    layer: str = ""
    name: str
    value: float
    bound: float
    unit: str = ""
    reason: str
    part: str
    outcome: Outcome
    note: str = ""

    @property
    def failed(self) -> bool:
        """Whether the check failed."""
        return self.outcome == FAILED


def at_most(name: str, value: float, bound: Bound, part: str, note: str = "") -> Finding:
    """Return the finding that holds `value` against `bound`; a value that is no number fails."""
    value = float(value)
    return Finding(
        name=name,
        value=value,
        bound=bound.most,
        unit=bound.unit,
        reason=bound.reason,
        part=part,
        outcome=PASSED if math.isfinite(value) and value <= bound.most else FAILED,
        note=note,
    )


def worst_place(errors: Mapping[str, float]) -> str:
    """Return where the largest of several errors is, one that is no number before all others."""
    return max(errors, key=lambda key: abs(errors[key]) if math.isfinite(errors[key]) else math.inf)


def worst_of(name: str, errors: Mapping[str, float], bound: Bound, part: str, note: str = "") -> Finding:
    """Return the finding on the largest of several errors, and say which; one that is no number fails."""
    place = worst_place(errors)
    notes = [f"worst of {len(errors)}: {place}", *([note] if note else [])]
    return at_most(name, abs(errors[place]), bound, part, "; ".join(notes))


def none_wrong(name: str, wrong: Sequence[str], reason: str, part: str, *, made: bool = True) -> Finding:
    """Return the finding that nothing is wrong, with the first of what is; fails where it was not `made`."""
    return at_most(name, len(wrong) if made else math.nan, Bound(0.0, reason), part, "; ".join(wrong[:3]))


def not_run(name: str, part: str, note: str) -> Finding:
    """Return the finding of a check that could not run, and why: not a failure, but said."""
    nan = math.nan
    return Finding(name=name, value=nan, bound=nan, reason="", part=part, outcome=NOT_RUN, note=note)
