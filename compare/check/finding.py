"""What a check finds: a measured value, its bound, and what is suspect where it is beyond it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

Outcome = Literal["passed", "FAILED", "no baseline", "not run"]
PASSED: Outcome = "passed"
FAILED: Outcome = "FAILED"
NO_BASELINE: Outcome = "no baseline"
NOT_RUN: Outcome = "not run"

# tightest first: what comes later rests on what comes earlier
LAYERS = (
    "records",
    "equations",
    "conserved",
    "exact",
    "rest",
    "invariance",
    "properties",
    "order",
    "residual",
    "metrics",
    "studies",
    "traces",
    "agreement",
    "baseline",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One check.

    Parameters
    ----------
    layer : str
        One of `LAYERS`.
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

    layer: str
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


def at_most(
    layer: str,
    name: str,
    value: float,
    bound: float,
    *,
    reason: str,
    part: str,
    unit: str = "",
    note: str = "",
) -> Finding:
    """Return the finding that holds `value` against `bound`; a value that is no number fails."""
    value = float(value)
    return Finding(
        layer=layer,
        name=name,
        value=value,
        bound=bound,
        unit=unit,
        reason=reason,
        part=part,
        outcome=PASSED if math.isfinite(value) and value <= bound else FAILED,
        note=note,
    )


def worst_of(
    layer: str,
    name: str,
    errors: Mapping[str, float],
    bound: float,
    *,
    reason: str,
    part: str,
    unit: str = "",
) -> Finding:
    """Return the finding on the largest of several errors, and say which; one that is no number fails."""
    place = max(errors, key=lambda key: abs(errors[key]) if math.isfinite(errors[key]) else math.inf)
    note = f"worst of {len(errors)}: {place}"
    return at_most(layer, name, abs(errors[place]), bound, reason=reason, part=part, unit=unit, note=note)


def not_run(layer: str, name: str, *, part: str, note: str) -> Finding:
    """Return the finding of a check that could not run, and why: not a failure, but said."""
    return Finding(
        layer=layer,
        name=name,
        value=math.nan,
        bound=math.nan,
        reason="",
        part=part,
        outcome=NOT_RUN,
        note=note,
    )
