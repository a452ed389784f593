"""Results of checks: a measured value, its bound, and the reason of the bound."""

from __future__ import annotations

import math
from collections.abc import Mapping
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
class Result(Brief):
    """Result of one check of one subject.

    Parameters
    ----------
    group : str
        One of `GROUPS`; empty until the check is run as one of them.
    subject : str
        Label of what was checked.
    name : str
        What was measured.
    value, bound : float
        The check holds where the value is at most the bound. NaN holds nowhere.
    unit : str
        Unit of both; empty for a ratio.
    reason : str
        Where the bound comes from.
    cause : str
        Likely cause of a failure; empty where the check cannot tell.
    outcome : {"passed", "FAILED", "no baseline", "not run"}
    note : str
        Further facts, such as the place of the largest error.
    """

    group: str = ""
    subject: str = ""
    name: str
    value: float
    bound: float
    unit: str = ""
    reason: str
    cause: str = ""
    outcome: Outcome
    note: str = ""

    @property
    def failed(self) -> bool:
        """Whether the check failed."""
        return self.outcome == FAILED


def at_most(name: str, value: float, bound: Bound, cause: str = "", note: str = "") -> Result:
    """Return the result that compares `value` with `bound`; a value that is no number fails."""
    value = float(value)
    return Result(
        name=name,
        value=value,
        bound=bound.most,
        unit=bound.unit,
        reason=bound.reason,
        cause=cause,
        outcome=PASSED if math.isfinite(value) and value <= bound.most else FAILED,
        note=note,
    )


def worst_of(name: str, errors: Mapping[str, float], bound: Bound, cause: str = "") -> Result:
    """Return the result on the largest of several errors, and its place; one that is no number fails."""
    place = max(errors, key=lambda key: abs(errors[key]) if math.isfinite(errors[key]) else math.inf)
    return at_most(name, abs(errors[place]), bound, cause, f"largest of {len(errors)}: {place}")


def not_run(name: str, note: str) -> Result:
    """Return the result of a check that could not run, and why: no failure."""
    return Result(name=name, value=math.nan, bound=math.nan, reason="", outcome=NOT_RUN, note=note)
