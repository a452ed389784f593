"""Result of an advice: the runs of one case, and the numbers that they come to."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from rockwobble.models import Case, Run, Trace
from rockwobble.models.shown import Shown
from rockwobble.multibody.scene.ring_geometry import rim_overhang

from ...comparison.prediction import Prediction
from ...metrics.agreement import tolerance_of
from ...metrics.distributions import Contrast
from ...metrics.pair import is_release
from ...metrics.tilt import overturned
from ..spectrum.spectrum import SPATIAL, uplift_factor
from .grades import (
    Grade,
    grade_engine,
    grade_intensity,
    grade_overturning,
    grade_share,
    grade_trace,
    overall,
)
from .members import COPIES, answers, demands_of, fall_of, ratios_of
from .scales import BESIDE, Lowest, planar_chances
from .trust import Trust, Verification

KIND = "advice"
OTHER = "other support"  # group of the copies on the other support


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Advice(Shown):
    """Advice on one case.

    Attributes
    ----------
    case : Case
        As it was run: where it falls after the end of what was asked, until its side is down, over still
        ground.
    support : str
        What holds the cylinder in place.
    friction_given : bool
        Whether the friction of the case is known, not a default.
    trace, other_trace, engine_trace : Trace
        By the reduced model of the support, by the other one, and by the engine (None without one).
    members : DataFrame
        A row for each run of the groups, see `member_rows`.
    band : DataFrame
        Of the copies, see `band_of`.
    scales, planar : DataFrame
        See `scan_scales` and `planar_runs`.
    lowest : mapping
        Of each series of `scales`.
    prediction : Prediction
        Predicted agreement time of reduced model and engine.
    verification : Verification or None
    trust : Trust
    form : Contrast or None
        Largest tilts of the copies on the other support over those on this one.
    vertical : mapping or None
        See `vertical_effect`.
    records : {"p695", "synthetic", ""}
        What the other records are.
    perturbation : float
        Of the copies, relative.
    seed : int
    """

    case: Case
    support: str
    friction_given: bool
    trace: Trace
    other_trace: Trace
    engine_trace: Trace | None
    members: pd.DataFrame
    band: pd.DataFrame
    scales: pd.DataFrame
    planar: pd.DataFrame
    lowest: Mapping[str, Lowest]
    prediction: Prediction
    verification: Verification | None
    trust: Trust
    form: Contrast | None
    vertical: Mapping[str, object] | None
    records: str
    perturbation: float
    seed: int

    def _said(self) -> dict[str, str]:
        tilt = "overturns" if self.overturned else f"{self.peak:.3g} alpha"
        return {
            "case": self.case.name,
            "run": str(self.model),
            "outcome": self.trace.outcome,
            "largest tilt": tilt,
            "grade": overall(self.grades.values()),
        }

    @property
    def model(self) -> Run:
        """The reduced model of the support."""
        return self.trace.run

    @property
    def moves(self) -> bool:
        """Whether the cylinder ever tilts."""
        return math.isfinite(self.trace.uplift_time) and self.trace.outcome != "failed"

    @property
    def overturned(self) -> bool:
        """Whether it overturns as given."""
        return self.trace.outcome == "overturned"

    @cached_property
    def answers(self) -> pd.DataFrame:
        """The groups of members, one row each, see `members.answers`; without the other support."""
        return answers(self.members[self.members["group"] != OTHER])

    @property
    def copies_differ(self) -> bool:
        """Whether the copies of the case are more than one run."""
        copies = self.answers[self.answers["group"] == COPIES]
        return bool(copies["chance"].notna().all())

    @property
    def peak(self) -> float:
        """Largest tilt of the case as given [alpha]."""
        return self.trace.peak_tilt / self.case.cylinder.alpha

    @property
    def beside(self) -> tuple[float, float]:
        """Least and largest peak tilt [alpha] for up to 12 % more or less shaking; infinite: overturned."""
        space = self.scales[self.scales["series"] == SPATIAL]
        if not len(space):
            return math.nan, math.nan
        here = int((space["factor"] - 1.0).abs().argmin())
        tilts = space["peak_tilt"].to_numpy()[here - BESIDE : here + BESIDE + 1]
        tilts = np.where(overturned(tilts), math.inf, tilts / self.case.cylinder.alpha)
        return float(np.nanmin(tilts)), float(np.nanmax(tilts))

    @property
    def grades(self) -> dict[str, Grade]:
        """Grade of each topic that there is something to say about; the criteria are in `grades`."""
        if self.trace.outcome == "failed":
            return {"trace": "not satisfied"}
        if not self.moves:
            return {}
        motion, engine = self.case.motion, self.verification
        worst, own = self.answers.max(numeric_only=True), demands_of(self.trace)
        spread = not math.isnan(worst["lost_95"])
        lacking = {name: worst[f"{name}_95"] if spread else own[name] for name in ("slip", "lost")}
        lowest = self.lowest[SPATIAL].factor if self.lowest else math.nan
        slides = self.friction_given and self.case.friction < self.case.cylinder.tan_alpha
        found: dict[str, Grade] = {
            "overturning": grade_overturning(
                self.overturned,
                lowest,
                self.answers["chance"],
                tested=bool(self.lowest) or (motion is None and self.copies_differ),
            ),
            "friction": grade_share(
                lacking["slip"] if self.friction_given else 0.0,
                asked=self.friction_given,
                tested=spread,
                slides=slides and self.trace.uplift_time > 0.0,
            ),
            "contact": grade_share(lacking["lost"], tested=spread),
            "trace": grade_trace(self.trust.kind, tested=self.copies_differ),
        }
        if motion is not None and not self.overturned:
            low, high = self.beside
            found["intensity"] = grade_intensity(low, self.peak, high)
        differs = engine is not None and (
            (engine.outcome == "overturned") != self.overturned or not engine.moves
        )
        found["engine"] = (
            "not tested"
            if engine is None
            else grade_engine(engine.outcome, engine.divergence, differs=differs)
        )
        return found

    def recess(self) -> dict[str, float] | None:
        """Return the design demands of a recess, by the worst 95th percentiles of groups that stand.

        None on flat ground, and where no group stands.

        Returns
        -------
        dict
            tilt [alpha]; force [weights] on the wall, the least that the restraining moment asks of it: the
            moment about the vertical through the contact point over the lever arm b; height of the wall, at
            which the rim stands out farthest, and clearance, by which a vertical wall of this height must
            stand back [m].
        """
        if self.support == "flat" or not len(self.answers):  # nothing was run of what never moves
            return None
        rows = self.answers[np.isfinite(self.answers["peak_tilt_95"])]
        if not len(rows):
            return None
        cylinder, tilt = self.case.cylinder, float(rows["peak_tilt_95"].max())
        theta, b = tilt * cylinder.alpha, cylinder.base_radius
        overhang, height = (b * part for part in rim_overhang(theta))
        return {
            "tilt": tilt,
            "force": (1.0 + math.cos(theta)) * float(rows["moment_95"].max()),
            "height": height,
            "clearance": max(overhang, height * math.tan(theta)),
        }

    def facts(self) -> dict[str, Any]:
        """Return every number behind the advice, as plain values; SI units, tilts in alpha."""
        case, trace, cylinder = self.case, self.trace, self.case.cylinder
        copies = self.members[self.members["group"] == COPIES]
        known = copies.loc[copies["outcome"] != "failed", "peak_tilt"]
        moved = case.motion is not None and not is_release(case)
        held = trace.assumptions_until(fall_of(trace)) if self.moves else None
        return {
            "name": case.name,
            "support": self.support,
            "model": str(self.model),
            "other": str(self.other_trace.run),
            "friction": case.friction if self.friction_given else None,
            "outcome": trace.outcome,
            "failure": [fact.code for fact in trace.facts],
            "moves": self.moves,
            "overturned": self.overturned,
            "end": float(trace.time[-1]),
            "length": case.length,
            "uplift_time": trace.uplift_time,
            "uplift_factor": uplift_factor(case.motion, cylinder.tan_alpha, case.gravity, until=case.length)
            if moved and case.motion is not None
            else math.nan,
            "peak": self.peak,
            "peak_deg": math.degrees(trace.peak_tilt),
            "peak_time": trace.peak_time,
            "peak_rank": float((known < self.peak).mean()) if len(known) and self.copies_differ else math.nan,
            "in_one_plane": self.moves and not np.any(trace.rolling_rate),
            "released": is_release(case),
            "shaken": case.motion is not None,
            "has_vertical": case.motion is not None and case.motion.has_vertical,
            "alpha": cylinder.alpha,
            "b": cylinder.base_radius,
            "h": cylinder.half_height,
            "tan_alpha": cylinder.tan_alpha,
            "grades": self.grades,
            "grade": overall(self.grades.values()),
            # whether the model may be used, whatever becomes of the cylinder
            "model_grade": overall(grade for topic, grade in self.grades.items() if topic != "overturning"),
            "answers": self.answers.to_dict("records"),
            "largest": dataclasses.asdict(held) if held else None,
            "recess": self.recess(),
            "beside": self.beside,
            "lowest": {name: dataclasses.asdict(each) for name, each in self.lowest.items()},
            "highest": float(self.scales["factor"].max()) if len(self.scales) else math.nan,
            "planar": planar_chances(self.planar) if len(self.planar) else [],
            "bound": tolerance_of(trace),
            "predicted": {
                "until": trace.uplift_time + self.prediction.length,
                "reason": self.prediction.reason,
            },
            "engine": None if self.verification is None else dataclasses.asdict(self.verification),
            "trust": dataclasses.asdict(self.trust),
            "form": ratios_of(self.form) if self.form is not None and self.copies_differ else None,
            "vertical": self.vertical,
            "records": self.records,
            "perturbation": self.perturbation,
            "seed": self.seed,
            "rtol": trace.settings["rtol"],
        }

    def tables(self) -> dict[str, pd.DataFrame]:
        """Return the tables by name; tilts of the traces in alpha."""
        alpha = self.case.cylinder.alpha
        engine = self.engine_trace
        return {
            "members": self.members,
            "band": self.band,
            "scales": self.scales,
            "planar": self.planar,
            "trace": pd.DataFrame(
                {
                    "time": self.trace.time,
                    "tilt": self.trace.tilt / alpha,
                    "friction_needed": self.trace.friction_needed,
                }
            ),
            "engine": pd.DataFrame(
                {"time": np.empty(0), "tilt": np.empty(0)}
                if engine is None
                else {"time": engine.time, "tilt": engine.tilt / alpha}
            ),
        }
