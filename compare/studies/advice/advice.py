"""Advice on one case before its results are used: all of its runs, and the numbers that they come to."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypedDict

import numpy as np
import pandas as pd

from rockwobble.models import Case, Cylinder, GroundMotion, Run, Trace, el_centro_1940, perturbed_copies
from rockwobble.models.cylinder import cylinder_of
from rockwobble.models.doubts import doubts_of_cases
from rockwobble.models.number_checks import require_kind
from rockwobble.models.records.units import sources_of
from rockwobble.models.support import support_named
from rockwobble.models.trace import NO_PEAK

from ...metrics.pair import overturned, tolerance_of
from ...metrics.statistics import Contrast, contrast
from ...runs.choice import require_runnable
from ...runs.execution import SAMPLE_STEP, Job, job_fingerprint, require_case, simulate_run
from ...runs.progress import ProgressCallback, stages
from ...storage.manifest import Number
from ...storage.provenance import fingerprint
from ...storage.results import Results
from ..plans import AdvicePlan
from ..spectrum.maps import SPATIAL, uplift_factor
from .grades import (
    Grade,
    grade_engine,
    grade_intensity,
    grade_overturning,
    grade_share,
    grade_trace,
    overall,
)
from .members import (
    COPIES,
    OTHER,
    VELOCITY,
    demand_table,
    demands_of,
    fall_of,
    group_table,
    member_rows,
    other_records,
    ratios_of,
    top_displacement,
)
from .scales import BESIDE, planar_runs, scan_scales
from .trust import BAND_STEP, Trust, Verification, band_of, predicted, spread_from, trust_of, verified

KIND = "advice"
_VERTICAL_COUNT = 20  # pairs of copies with and without the vertical component


class Response(TypedDict):
    """Facts of the run of the reduced model as given: times in s, tilts in alpha, demands as in `demands_of`.

    diagnostics are their codes; end is that of the run or of the fall, tolerance that of an agreement.
    """

    outcome: str
    diagnostics: list[str]
    uplift_time: float
    peak_tilt: float
    peak_time: float
    end: float
    in_one_plane: bool
    largest_normal_force: float
    slip: float
    lost: float
    tolerance: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Advice(Results, kind=KIND):
    """Advice on one case.

    Attributes
    ----------
    members : DataFrame
        A row for each run of the groups, see `member_rows`.
    groups, demands : DataFrame
        Percentiles of the groups, see `group_table`, and the design demands, see `demand_table`.
    band : DataFrame
        Of the tilts of the copies, see `band_of`.
    scales, lowest, planar : DataFrame
        Other scales of the ground motion and the lowest that overturns, see `scan_scales`; and planar
        analysis of other records, see `planar_runs`.
    trace, engine : DataFrame
        time [s], tilt [alpha] and, of the reduced model, friction_needed [-]; no row without an engine.

    Its facts are the problem (case, cylinder, motion, release, length, gravity, rolling_resistance, friction:
    None unless it was given), the support with its model and the other_model; the response of the model;
    trust, prediction and verification as in `Trust`, `Prediction` and `Verification`; other_support and
    vertical, ratios of the largest tilts there, and with the vertical component (`ratios_of`), None where
    there are none; what the records are; perturbation and seed of the copies, and the hash of all inputs.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> found = rw.advise(rw.Case(pier, rw.el_centro_1940()), copies=20)
    >>> found.trust.kind, found.grades["overturning"]
    ('statistics', 'caution')
    """

    def headline(self) -> dict[str, Number]:
        """Return outcome, grade, the shares that overturn, and the largest tilt as given."""
        return {
            "case": self.facts["case"],
            "outcome as given": self.response["outcome"],
            "grade": overall(self.grades.values()),
            **{f"overturning, {row['group']}": row["chance"] for row in self.groups.to_dict("records")},
            "largest tilt as given [deg]": math.degrees(self.peak * self.cylinder.alpha),
            "displacement of the top as given [m]": self.top(self.peak),
        }

    @property
    def cylinder(self) -> Cylinder:
        """The cylinder, or the frame."""
        return cylinder_of(self.facts["cylinder"])

    @property
    def response(self) -> Response:
        """Facts of the run of the reduced model as given."""
        found: Response = self.facts["response"]
        return found

    @property
    def trust(self) -> Trust:
        """Time until which the trace can be trusted."""
        return Trust(**self.facts["trust"])

    @property
    def verification(self) -> Verification | None:
        """The run of the engine."""
        found = self.facts["verification"]
        return None if found is None else Verification(**found)

    @property
    def moves(self) -> bool:
        """Whether the cylinder ever tilts."""
        return _moves(self.response["outcome"], self.response["uplift_time"])

    @property
    def overturned(self) -> bool:
        """Whether it overturns as given."""
        return self.response["outcome"] == "overturned"

    @property
    def copies_differ(self) -> bool:
        """Whether the copies of the case are more than one run."""
        return _differ(self.groups)

    @property
    def peak(self) -> float:
        """Largest tilt of the case as given [alpha]."""
        return self.response["peak_tilt"]

    def top(self, tilt: float) -> float:
        """Return the displacement of the top at a tilt [alpha], infinite where it overturns [m]."""
        return float(top_displacement(self.cylinder, tilt * self.cylinder.alpha))

    @property
    def lowest_factor(self) -> float:
        """Lowest scale of the ground motion found to overturn; NaN where none is."""
        return float(self.lowest["factor"][self.lowest["series"] == SPATIAL].max())

    @property
    def beside(self) -> tuple[float, float]:
        """Least and largest peak tilt [alpha] for up to 12 % more or less shaking; infinite: overturned."""
        space = self.scales[self.scales["series"] == SPATIAL]
        if not len(space):
            return math.nan, math.nan
        here = int((space["factor"] - 1.0).abs().argmin())
        tilts = space["peak_tilt"].to_numpy(float)[here - BESIDE : here + BESIDE + 1]
        tilts = np.where(overturned(tilts), math.inf, tilts / self.cylinder.alpha)
        return float(np.nanmin(tilts)), float(np.nanmax(tilts))

    @property
    def missing(self) -> tuple[float, float]:
        """Shares of the moving time in which friction and contact are missing.

        Those that 95 % of the runs of each group do not exceed or, where too few differ, those as given.
        """
        worst = self.groups.max(numeric_only=True)
        if math.isnan(worst.get("lost_95", math.nan)):
            return self.response["slip"], self.response["lost"]
        return float(worst["slip_95"]), float(worst["lost_95"])

    @property
    def grades(self) -> dict[str, Grade]:
        """Grade of each topic that there is something to say about; the criteria are in `grades`."""
        response, facts, engine = self.response, self.facts, self.verification
        if response["outcome"] in NO_PEAK:
            return {"trace": "not satisfied"}
        if not self.moves:
            return {}
        shaken, friction = facts["motion"] is not None, facts["friction"]
        (slip, lost), spread = self.missing, bool(self.groups["lost_95"].notna().any())
        slides = friction is not None and friction < self.cylinder.tan_alpha and response["uplift_time"] > 0.0
        found: dict[str, Grade] = {
            "overturning": grade_overturning(
                self.overturned,
                self.lowest_factor,
                self.groups["chance"],
                tested=len(self.lowest) > 0 or (not shaken and self.copies_differ),
            ),
            "friction": grade_share(
                0.0 if friction is None else slip,
                asked=friction is not None,
                tested=spread,
                slides=slides,
            ),
            "contact": grade_share(lost, tested=spread),
            "trace": grade_trace(self.trust.kind, tested=self.copies_differ),
        }
        if shaken and not self.overturned:
            low, high = self.beside
            found["intensity"] = grade_intensity(low, self.peak, high)
        found["engine"] = "not tested"
        if engine is not None:
            differs = (engine.outcome == "overturned") != self.overturned or not engine.moves
            found["engine"] = grade_engine(engine.outcome, engine.divergence, differs=differs)
        return found

    @property
    def model_grade(self) -> Grade:
        """Whether the model may be used, whatever becomes of the cylinder."""
        return overall(grade for topic, grade in self.grades.items() if topic != "overturning")


def advise(
    case: Case,
    run: Run | None = None,
    *,
    friction_given: bool = True,
    progress: ProgressCallback | None = None,
    **options: Any,
) -> Advice:
    """Run what it takes to say how far the results of one case can be trusted.

    Parameters
    ----------
    case : Case
        Of a cylinder or of a frame.
    run : Run, optional
        Engine that verifies the prediction; without one it stays unverified.
    friction_given : bool, optional
        Whether the friction of the case is known, not a default.
    progress : callable, optional
        Called with a `Progress` at the start and at the end of each stage.
    **options
        See `AdvicePlan`: support ("recess", or that of the run), copies (100), perturbation (0.01), seed (1).

    Returns
    -------
    Advice

    Raises
    ------
    ValueError
        If the engine cannot run the case, or an option is out of range.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> found = rw.advise(rw.Case(pier, initial=release, duration=4.0), copies=20)
    >>> found.trust.kind, found.grades["engine"]
    ('trace', 'not tested')
    """
    require_kind("case", case, Case)
    if run is not None:
        require_kind("run", run, Run)
    require_case(case)
    plan = AdvicePlan.of(**({} if run is None else {"support": run.support}) | options)
    if run is not None:
        if run.support != plan.support:
            raise ValueError(f"support must be that of the run, {run.support}, got {plan.support}")
        require_runnable(case, run)
    model, other = Run(None, support_named(plan.support).compared_with[-1]), Run(None, "flat")
    if model == other:
        other = Run(None, "recess")
    stage = stages(progress, [1.0] * (4 if run is None else 5))
    inputs = fingerprint(
        [*(job_fingerprint(Job(case=case, run=each)) for each in (model, run) if each), plan]
    )
    with stage("both reduced models (compiled on their first run)"):
        trace = simulate_run(case, model)
        if trace.time[-1] > case.length:
            case = _to_the_fall(case, float(trace.time[-1]))
            trace = simulate_run(case, model)
    moves = _moves(trace.outcome, trace.uplift_time)
    copies: list[Trace] = []
    others: list[Trace] = []
    with stage(f"{plan.copies} perturbed copies"):
        if moves:  # in this process: other ones take longer to begin than hundreds of reduced runs
            cases = perturbed_copies(case, plan.copies, perturbation=plan.perturbation, seed=plan.seed)
            copies = [simulate_run(each, model) for each in cases]
            others = [simulate_run(each, other, sample_step=BAND_STEP) for each in cases]
        rows = [*member_rows(COPIES, copies), *member_rows(OTHER, others)]
    with stage("other records as strong, and planar analysis"):
        records, source = ({}, "") if trace.outcome in NO_PEAK else other_records(case)
        for name, cases in records.items():
            rows += member_rows(name, (simulate_run(each, model) for each in cases))
        planar = planar_runs(records[VELOCITY], model.support) if records else pd.DataFrame()
    with stage("other scales of the ground motion"):
        scales, lowest = scan_scales(case, model.support)
        vertical = None
        if records:
            vertical = vertical_effect(case, model, perturbation=plan.perturbation, seed=plan.seed)
    prediction, verification, engine = predicted(case, trace, run), None, None
    if run is not None:
        with stage(str(run)):
            if moves:
                verification, prediction, engine = verified(case, run, model)
    alpha, band = case.cylinder.alpha, band_of(case, copies)
    trust = Trust(kind="trace", until=case.length, because="")
    if moves:
        methods = trace.uplift_time + prediction.length if prediction.reason else math.inf
        if verification is not None and verification.outcome != "failed":
            methods = verification.agreed_until if verification.diverged else math.inf
        data = spread_from(band, trace.peak_tilt / alpha)
        trust = trust_of(methods, data, trace.peak_time, float(trace.time[-1]))
    members = pd.DataFrame(rows, columns=None if rows else ["group", "outcome", "peak_tilt", "member"])
    tables = {
        "members": members,
        "band": band,
        "scales": scales,
        "lowest": lowest,
        "planar": planar,
        "trace": _samples(trace, alpha).assign(friction_needed=trace.friction_needed),
        "engine": _samples(engine, alpha),
    }
    form = _contrast(others, copies) if _differ(group_table(members)) else None
    facts = {
        **_problem(case),
        "friction": case.friction if friction_given else None,
        "support": plan.support,
        "model": str(model),
        "other_model": str(other),
        "response": _response(trace),
        "trust": dataclasses.asdict(trust),
        "prediction": dataclasses.asdict(prediction),
        "verification": None if verification is None else dataclasses.asdict(verification),
        "other_support": None if form is None else ratios_of(form),
        "vertical": vertical,
        "records": source,
        "doubts": doubts_of_cases([case]),
        "record_sources": sources_of([case.motion]),
        "perturbation": plan.perturbation,
        "seed": plan.seed,
        "inputs": inputs,
    }
    return advice_of(tables, facts)


def advice_of(tables: Mapping[str, pd.DataFrame], facts: Mapping[str, object]) -> Advice:
    """Return the advice of its runs, with the tables that are concluded from them."""
    found = Advice(tables=tables, facts=facts)
    groups = group_table(found.members)
    demands = demand_table(groups, found.cylinder, found.facts["gravity"], found.facts["support"])
    return dataclasses.replace(found, tables={**tables, "groups": groups, "demands": demands})


def _moves(outcome: str, uplift_time: float) -> bool:
    return math.isfinite(uplift_time) and outcome not in NO_PEAK


def _differ(groups: pd.DataFrame) -> bool:
    copies = groups[groups["group"] == COPIES] if len(groups) else groups
    return bool(len(copies) and copies["chance"].notna().all())


def _samples(trace: Trace | None, alpha: float) -> pd.DataFrame:
    time, tilt = np.empty((2, 0)) if trace is None else (trace.time, trace.tilt / alpha)
    return pd.DataFrame({"time": time, "tilt": tilt})


def _problem(case: Case) -> dict[str, object]:
    """Facts of a case, without the samples of its motion."""
    motion, cylinder = case.motion, case.cylinder
    shaking = motion and {
        "name": motion.name,
        "samples": len(motion.acceleration),
        "time_step": motion.time_step,
        "peak": motion.peak,
        "has_vertical": motion.has_vertical,
        "uplift_factor": uplift_factor(motion, cylinder.tan_alpha, case.gravity, until=case.length),
    }
    return {
        "case": case.name,
        "cylinder": dataclasses.asdict(cylinder),
        "motion": shaking,
        "release": dataclasses.asdict(case.initial) if case.is_release and case.initial else None,
        "length": case.length,
        "gravity": case.gravity,
        "rolling_resistance": case.rolling_resistance,
    }


def _response(trace: Trace) -> Response:
    moves = _moves(trace.outcome, trace.uplift_time)
    assumed = trace.assumptions_until(fall_of(trace)) if moves else None
    own = demands_of(trace)
    return {
        "outcome": trace.outcome,
        "diagnostics": [fact.code for fact in trace.facts],
        "uplift_time": trace.uplift_time,
        "peak_tilt": trace.peak_tilt / trace.case.cylinder.alpha,
        "peak_time": trace.peak_time,
        "end": float(trace.time[-1]),
        "in_one_plane": moves and not trace.rolling_rate.any(),
        "largest_normal_force": assumed.largest_normal_force if assumed else math.nan,
        "slip": own["slip"],
        "lost": own["lost"],
        "tolerance": tolerance_of(trace),
    }


def vertical_effect(case: Case, model: Run, *, perturbation: float, seed: int) -> dict[str, object] | None:
    """Return the effect of the vertical component of ground motion on the largest tilt, copy by copy.

    Of the record itself or, where it has none, of El Centro 1940 as strong: what it usually changes.

    Returns
    -------
    dict
        given, record, and the ratios of the largest tilts, with over without it: see `ratios_of`.
    """
    motion = case.motion
    assert motion is not None
    record = motion
    if not motion.has_vertical:
        record = el_centro_1940(vertical=True)
        record = record.scaled(motion.peak / record.peak)
    duration = case.duration if motion.has_vertical else None
    runs = []
    for each in (record, GroundMotion(record.acceleration[:, :2], record.time_step, record.name)):
        shaken = dataclasses.replace(case, motion=each, duration=duration)
        copies = perturbed_copies(shaken, _VERTICAL_COUNT, perturbation=perturbation, seed=seed)
        runs.append([simulate_run(copy, model, sample_step=1.0) for copy in copies])
    found = _contrast(*runs)
    if found is None or not found.compared:
        return None
    return {"given": motion.has_vertical, "record": record.name, **ratios_of(found)}


def _contrast(traces: Sequence[Trace], against: Sequence[Trace]) -> Contrast | None:
    both = (traces, against)
    peaks = [np.array([trace.peak_tilt for trace in part]) for part in both]
    fell = [np.array([trace.outcome == "overturned" for trace in part]) for part in both]
    if np.count_nonzero(np.isfinite(peaks).all(axis=0)) < 2:
        return None
    return contrast(*peaks, *fell)


def _to_the_fall(case: Case, end: float) -> Case:
    """Return a case that takes until its fall at `end` [s], after what was asked for, over still ground.

    All that is run for it then sees the fall: the engine, the copies, and when two methods diverge.
    """
    motion = case.motion
    if motion is not None and case.length < motion.duration:
        kept = math.floor(case.length / motion.time_step * (1.0 + 1e-12)) + 1
        motion = motion.changed(motion.acceleration[: max(kept, 2)], f"cut to {case.length:g} s")
    duration = math.ceil(end / SAMPLE_STEP) * SAMPLE_STEP
    return dataclasses.replace(case, motion=motion, duration=duration)
