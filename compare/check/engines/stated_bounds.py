"""Engine runs against the bounds that their suite states."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from rockwobble.models import Bounds, Case, Run

from ...comparison.prediction import Prediction
from ...comparison.summary import SUMMARY_COLUMNS, summary_row
from ...runs.choice import own_model
from ..finding import Finding, at_most

LAYER = "agreement"


def reference_of(bounds: Bounds, run: Run) -> str:
    """Return the reduced model that a run is held against."""
    return own_model(run).support if bounds.reference == "own" else bounds.reference


def check(
    bounds: Bounds, case: Case, run: Run, label: str, trajectory: Any, response: Any, prediction: Prediction
) -> Iterator[Finding]:
    """Yield one finding for each bound; `response` is that of `reference_of`."""
    model = reference_of(bounds, run)
    row = summary_row(case, f"{model} model", response, label, trajectory, prediction=prediction)
    for column, bound in bounds.given().items():
        unit, meaning = SUMMARY_COLUMNS[column]
        value = abs(float(row[column]))
        if column == "agreement_time":
            # the shorter the worse: what is missing may be nothing
            missing = max(0.0, bound - value) if row["diverged"] else 0.0
            yield at_most(
                LAYER,
                f"{case.name}, {label} against {model}: agreement_time missing",
                missing,
                0.0,
                unit=unit,
                reason=f"the suite asks for {bound:g} s",
                part=f"{run.engine} ({run.support}) or the {model} model",
                note=f"they agree for {value:.3g} s",
            )
            continue
        yield at_most(
            LAYER,
            f"{case.name}, {label} against {model}: {column}",
            value if math.isfinite(value) else math.nan,
            bound,
            unit=unit,
            reason=f"stated by the suite: {meaning}",
            part=f"{run.engine} ({run.support}) or the {model} model",
            note="; ".join(part for part in str(row["diagnostics"]).split("; ") if "not defined" not in part),
        )
