"""What was run for one case, and what it says."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockwobble.models import Case, Run, Trace

from ...comparison.prediction import Prediction
from .demands import Demands
from .grades import (
    Trust,
    grade_contact,
    grade_engine,
    grade_friction,
    grade_overturning,
    grade_trust,
    overall,
)
from .planar import PlanarView
from .scales import ScaleScan
from .spread import HIGH, LOW, Spread
from .verification import Verification


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Advice:
    """What was run for one case, and what it says.

    Attributes
    ----------
    case : Case
        As it was run: where it falls after the end of what was asked, until its side is down, over still
        ground.
    support : str
        What holds the cylinder in place.
    model, other : Run
        Reduced model of that support, and the other one: recess and flat.
    response, other_response : Trace
        Their runs.
    uplift_factor : float
        On the ground motion, at which a cylinder at rest uplifts; inf without a ground motion.
    peak_time : float
        Of the largest tilt [s]; NaN where nothing moves or the run failed.
    demands : Demands
        Until the fall, if it overturns.
    prediction : Prediction
        When reduced model and engine have to part.
    verification : Verification or None
        None where no engine was asked for, or nothing moves.
    spread : Spread or None
        None where nothing moves or the run failed.
    scan : ScaleScan or None
        None without a ground motion.
    planar : PlanarView or None
        None without a ground motion and for a release.
    trust : Trust
    versions : mapping
        Of the packages and engines.
    """

    case: Case
    support: str
    model: Run
    other: Run
    response: Trace
    other_response: Trace
    uplift_factor: float
    peak_time: float
    demands: Demands
    prediction: Prediction
    verification: Verification | None
    spread: Spread | None
    scan: ScaleScan | None
    planar: PlanarView | None
    trust: Trust
    versions: Mapping[str, str]

    @property
    def moves(self) -> bool:
        """Whether the cylinder ever tilts."""
        return math.isfinite(self.response.uplift_time) and self.response.outcome != "failed"

    @property
    def in_one_plane(self) -> bool:
        """Whether the motion goes straight through upright, as none out of its plane does."""
        return self.moves and not np.any(self.response.rolling_rate)

    @property
    def overturned(self) -> bool:
        """Whether it overturns."""
        return bool(self.response.outcome == "overturned")

    @property
    def peak(self) -> float:
        """Largest tilt [alpha]."""
        return float(self.response.peak_tilt / self.case.cylinder.alpha)

    @property
    def overturned_peak(self) -> float:
        """What stands for the largest tilt of a run that overturned [alpha]."""
        return 0.5 * math.pi / self.case.cylinder.alpha

    @property
    def lowest_overturning(self) -> float:
        """Lowest factor on the ground motion that was found to overturn; NaN if none was."""
        return math.nan if self.scan is None else self.scan.lowest["3d"]

    @property
    def overturning_share(self) -> float:
        """Share of the perturbed members that overturn; NaN if none was run."""
        return math.nan if self.spread is None else self.spread.overturning_share()

    @property
    def data_error(self) -> float:
        """Relative distance of the 5 % or 95 % quantile of the members from the peak.

        NaN if unknown, inf where more than 5 % of them overturn and the case does not.
        """
        if self.spread is None or self.overturned or not self.peak > 0.0:
            return math.nan
        low, high = (self.spread.quantile(share) for share in (LOW, HIGH))
        if high >= self.overturned_peak:
            return math.inf
        return max(abs(low / self.peak - 1.0), abs(high / self.peak - 1.0))

    @property
    def form_error(self) -> float:
        """Relative difference in peak tilt that the other support makes; NaN if unknown.

        Of the single runs where the trace can be trusted, else of the medians of the members: single runs
        differ by chance then.
        """
        if self.spread is None or self.overturned or not self.peak > 0.0:
            return math.nan
        if self.trust.kind != "statistics":
            if self.other_response.outcome in ("failed", "overturned"):
                return math.nan
            return float(self.other_response.peak_tilt / self.case.cylinder.alpha / self.peak - 1.0)
        medians = [self.spread.quantile(0.5, other=other) for other in (True, False)]
        return medians[0] / medians[1] - 1.0 if max(medians) < self.overturned_peak else math.nan

    @property
    def grades(self) -> dict[str, str]:
        """Grade of each topic that there is something to say about."""
        if self.response.outcome == "failed":
            return {"response": "bad"}
        if not self.moves:
            return {}
        found = {
            "friction": grade_friction(self.demands),
            "contact": grade_contact(self.demands),
            "trust": grade_trust(self.trust),
            "overturning": grade_overturning(
                self.overturned, self.lowest_overturning, self.overturning_share
            ),
        }
        if self.verification is not None:
            differ = (self.verification.outcome == "overturned") != self.overturned
            found["engine"] = (
                "care"
                if self.verification.outcome == "failed"
                else grade_engine(self.verification.divergence, differ)
            )
        return found

    @property
    def model_grade(self) -> str:
        """Whether the reduced model may be used here, whatever becomes of the cylinder."""
        return overall(grade for topic, grade in self.grades.items() if topic != "overturning")

    def numbers(self) -> dict[str, Any]:
        """Return every number behind the advice, as plain values; SI units, tilts in alpha where so named."""
        spread, verification = self.spread, self.verification
        return {
            "model": self.model,
            "support": self.support,
            "outcome": self.response.outcome,
            "uplift_time": self.response.uplift_time,
            "uplift_factor": self.uplift_factor,
            "peak_tilt_in_alpha": self.peak,
            "peak_time": self.peak_time,
            "other_model": self.other,
            "other_outcome": self.other_response.outcome,
            "other_peak_tilt_in_alpha": self.other_response.peak_tilt / self.case.cylinder.alpha,
            "demands": self.demands,
            "trust": self.trust,
            "prediction": self.prediction,
            "engine": None
            if verification is None
            else {
                name: getattr(verification, name)
                for name in verification.__dataclass_fields__
                if name != "trajectory"
            },
            "starts": None
            if spread is None
            else {
                "count": spread.count,
                "perturbation": spread.perturbation,
                "seed": spread.seed,
                "failed": int((~np.isfinite(spread.peaks)).sum()),
                "quantiles_in_alpha": {f"{share:g}": spread.quantile(share) for share in (LOW, 0.5, HIGH)},
                "other_quantiles_in_alpha": {
                    f"{share:g}": spread.quantile(share, other=True) for share in (LOW, 0.5, HIGH)
                },
                "overturning_share": spread.overturning_share(),
                "other_overturning_share": spread.overturning_share(other=True),
                "followed_until": spread.followed_until,
                "models_agree_until": spread.agreed_until,
                "contrast": spread.contrast(),
            },
            "data_error": self.data_error,
            "form_error": self.form_error,
            "in_one_plane": self.in_one_plane,
            "planar": self.planar,
            "planar_kind": None if self.planar is None else self.planar.kind,
            "lowest_overturning": self.lowest_overturning,
            "scales": self.scan,
        }
