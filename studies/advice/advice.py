"""Advice on one case: all of its runs, their tables and facts."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np
import pandas as pd

from rockwobble import reduced
from rockwobble.compare.metrics.contrast import pairs_of
from rockwobble.compare.metrics.mode import mode_findings
from rockwobble.compare.metrics.pair import beyond_yield, overturned, tolerance_of
from rockwobble.compare.runs.choice import require_runnable
from rockwobble.compare.runs.execution import Job, job_fingerprint, simulate_run
from rockwobble.compare.runs.progress import ProgressCallback, stages
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.provenance import fingerprint
from rockwobble.compare.storage.results import Results
from rockwobble.models import (
    CLOSED_TILT,
    Case,
    RockingBody,
    Run,
    Trace,
    el_centro_1940,
)
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.case import FLAT_MODEL, RECESS_MODEL, TERMS
from rockwobble.models.cylinder import cylinder_of
from rockwobble.models.doubts import doubts_of_cases
from rockwobble.models.finding import Findings, Grade
from rockwobble.models.ground_motion import sources_of
from rockwobble.models.mode import REST, SLIDES, expected_mode
from rockwobble.models.plain_json import plain
from rockwobble.models.support import RECESS, support_named
from rockwobble.models.trace import NO_PEAK
from rockwobble.models.trace_file import motion_facts

from ..plans import AdvicePlan
from ..spectrum.parts import SPATIAL
from .demands import demand_table, demands_of, overturning_time, weaker_factors
from .findings import findings_of
from .grades import graded, overall
from .members import (
    BESIDE_THE_PROBLEM,
    COPIES,
    DEMAND_STEP,
    HORIZONTAL,
    OTHER,
    VELOCITY,
    VERTICAL,
    WEAKER_COUNT,
    group_table,
    member_rows,
    other_records,
    ratios_of,
    run_rows,
    top_displacement,
    uplift_of,
    with_vertical,
    without_vertical,
)
from .scales import planar_runs, scan_as_strong, scan_scales
from .slides import (
    engine_rows,
    slide_rows,
    slides_and_rocks,
    usual_support,
)
from .trust import (
    BAND_STEP,
    Trust,
    Verification,
    band_of,
    model_prediction,
    spread_from,
    trust_of,
    trusted_part,
    verify_run,
    with_time_to_fall,
)

KIND = "advice"
VERTICAL_COUNT = 20  # pairs of copies with and without the vertical component


@dataclass(frozen=True, slots=True, kw_only=True)
class Vertical:
    """Vertical component of the ground motion: where it comes from and what it changes.

    Attributes
    ----------
    source : {"", "own", "shipped", "other"}
        The ground motion has it; the shipped record has it, which the case takes without; neither, and
        another record was run in its place; or there is no horizontal shaking.
    record : str
        Of which it is.
    uplift_factor : float
        Factor on the ground motion with it at which the cylinder uplifts.
    ratios : dict, optional
        Largest tilts of the copies with it over those without it, see `ratios_of`.
    """

    source: Literal["", "own", "shipped", "other"] = ""
    record: str = ""
    uplift_factor: float = math.inf
    ratios: Mapping[str, float] | None = None


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
        Band of the tilts of the copies, see `band_of`.
    weaker : DataFrame
        Rows of `member_rows` under weaker shaking by the same records, see `weaker_factors`.
    scales, lowest, planar : DataFrame
        Other scales of the ground motion and the lowest that overturns, see `scan_scales`; and planar
        analysis of other records, see `planar_runs`.
    as_strong : DataFrame
        Shaking as strong as that given: scales close to 1, see `scan_as_strong`.
    trace, engine : DataFrame
        time [s], tilt [alpha] and, of the reduced model, friction_needed [-]; no row without an engine.

    Its facts are the problem (case, cylinder, motion, release, length, gravity, rolling_resistance, tendon,
    friction: None unless it was given), the support with its model and the other_model; the response of the
    model; trust, prediction and verification as in `Trust`, `Prediction` and `Verification`; other_support,
    ratios of the largest tilts there (`ratios_of`), None where there are none; vertical, as in `Vertical`;
    what the other records are; mass of a cylinder [t] or None; perturbation and seed of the copies, and the
    hash of
    all inputs. options are those of the command line that stated the problem, None where it was not used.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> advice = rw.advise(rw.Case(pier, rw.el_centro_1940()), copies=20)
    >>> advice.trust.kind, advice.grades["overturning"]
    ('statistics', 'caution')
    """

    def headline(self) -> dict[str, Number]:
        """Outcome, grade, overturning shares and peak tilt as given; for a slide its displacement."""
        response = self.response
        about = {"case": self.facts["case"], "outcome as given": response["outcome"]}
        if self.slides:
            return about | {
                "outcome as given": SLIDES,
                "peak displacement as given [m]": response["displacement"],
                "residual displacement as given [m]": response["residual_displacement"],
            }
        return {
            **about,
            "grade": overall(self.grades.values()),
            **{f"overturning, {row['group']}": row["chance"] for row in self.groups.to_dict("records")},
            "largest tilt as given [deg]": math.degrees(self.peak * self.cylinder.alpha),
            "displacement of the top as given [m]": self.top(self.peak),
        }

    @property
    def cylinder(self) -> RockingBody:
        """The cylinder, or the frame."""
        return cylinder_of(self.facts["cylinder"])

    @property
    def response(self) -> Mapping[str, Any]:
        """Facts of the run of the reduced model as given: times in s, tilts in alpha, forces in weights.

        Demands are as in `demands_of`, displacements [m] those of the base centre; diagnostics are codes; end
        is that of the run or of the fall, tolerance that of an agreement, yields, see `beyond_yield`, of a
        tendon, and tension its largest force until the fall; NaN without one.
        """
        response: Mapping[str, Any] = self.facts["response"]
        return response

    @property
    def trust(self) -> Trust:
        """Time until which the trace can be trusted, with its reason."""
        return Trust(**self.facts["trust"])

    @property
    def verification(self) -> Verification | None:
        """Run of the engine that verifies the model."""
        stored = self.facts["verification"]
        return None if stored is None else Verification(**stored)

    @property
    def moves(self) -> bool:
        """Whether the cylinder ever tilts."""
        return _moves(self.response["outcome"], self.response["uplift_time"])

    @property
    def slides(self) -> bool:
        """Whether the cylinder only slides on flat ground."""
        return len(self.tables.get("slides", ())) > 0

    @property
    def slides_at_rest(self) -> bool:
        """Whether the given friction lets the closed base slide."""
        motion, friction = self.facts["motion"], self.facts["friction"]
        known = motion is not None and friction is not None and self.response["outcome"] not in NO_PEAK
        if self.moves or self.slides or not known:
            return False
        # results of earlier versions have no such facts
        return bool(friction < motion.get("friction_at_rest", 0.0))

    @property
    def overturned(self) -> bool:
        """Whether the case overturns as given; False if its tendon yields, as nobody knows then."""
        return self.response["outcome"] == "overturned" and not self.yields

    @property
    def yields(self) -> bool:
        """Whether the tendon yields as given, which leaves the run without a result."""
        return bool(self.response.get("yields", False))  # unknown in results of earlier versions

    @property
    def yielded(self) -> int:
        """Number of runs with a yielding tendon in the groups that count for grades."""
        return int(self.counting["yielded"].sum()) if "yielded" in self.counting else 0

    @property
    def yields_from(self) -> float:
        """Lowest scale of the ground motion at which the tendon yields; NaN if none."""
        spatial = self.scales[self.scales["series"] == SPATIAL]
        tables = (table for table in (spatial, self.as_strong) if "yields" in table)
        factors = (table["factor"][table["yields"].astype(bool)].min() for table in tables)
        return float(np.fmin.reduce([math.nan, *factors]))

    @property
    def copies_differ(self) -> bool:
        """Whether perturbed copies differ from the case."""
        return _differ(self.groups)

    @property
    def divergence_time(self) -> float:
        """Time at which the spread of the copies exceeds half of the peak tilt [s]; inf if never."""
        return spread_from(self.band, self.peak)

    @property
    def peak(self) -> float:
        """Largest tilt of the case as given [alpha]."""
        return float(self.response["peak_tilt"])

    def top(self, tilt: float) -> float:
        """Displacement of the top at a tilt [alpha], infinite where it overturns [m]."""
        return float(top_displacement(self.cylinder, tilt * self.cylinder.alpha))

    @property
    def lowest_factor(self) -> float:
        """Lowest scale of the ground motion found to overturn, below any yield of a tendon; NaN if none."""
        searched = self.lowest["factor"][self.lowest["series"] == SPATIAL].max()
        beside = self.as_strong
        lowest = float(np.fmin(searched, beside["factor"][overturned(beside["peak_tilt"])].min()))
        return math.nan if lowest >= self.yields_from else lowest

    @property
    def overturning_as_strong(self) -> tuple[float, float]:
        """Lowest overturning scale within equally strong shaking, and the share of that range that overturns.

        The share is of the logarithm of the factor, each scale standing for what is nearer to it than to
        another: counts would say too much, since most scales are run about the largest tilts.
        """
        factors = self.as_strong["factor"].to_numpy(float)
        fell = overturned(self.as_strong["peak_tilt"].to_numpy(float))
        if not fell.any():
            return math.nan, 0.0
        share = np.trapezoid(fell.astype(float), np.log(factors)) / np.log(factors[-1] / factors[0])
        return float(factors[fell].min()), float(share)

    @property
    def range_as_strong(self) -> tuple[float, float]:
        """Least and largest peak tilt [alpha] under equally strong shaking; infinite: overturned."""
        if not len(self.as_strong):
            return math.nan, math.nan
        tilts = self.as_strong["peak_tilt"].to_numpy(float)
        tilts = np.where(overturned(tilts), math.inf, tilts / self.cylinder.alpha)
        return float(np.nanmin(tilts)), float(np.nanmax(tilts))

    @property
    def counting(self) -> pd.DataFrame:
        """Groups of runs that count for grades."""
        return self.groups[self.groups["counts"]] if len(self.groups) else self.groups

    @property
    def vertical(self) -> Vertical:
        """Facts of the vertical component."""
        return Vertical(**self.facts["vertical"])

    @property
    def missing(self) -> tuple[float, float]:
        """Shares of the time in motion with insufficient friction and with lost contact.

        Those that 95 % of the runs of each group do not exceed or, where too few differ, those as given.
        """
        worst = self.counting.max(numeric_only=True)
        if math.isnan(worst.get("lost_95", math.nan)):
            return self.response["slip"], self.response["lost"]
        return float(worst["slip_95"]), float(worst["lost_95"])

    @property
    def grades(self) -> dict[str, Grade]:
        """Grade of each topic that applies to the case, by the criteria of `grades`."""
        return {each.key.partition(".")[0]: cast("Grade", each.level) for each in graded(self)}

    def findings(self) -> Findings:
        """Verdict, motion, grades with reasons, groups, demands, next steps and details, in this order."""
        return findings_of(self)


@with_argument_kinds
def advise(
    case: Case,
    run: Run | None = None,
    *,
    support: str | None = None,
    copies: int = 100,
    perturbation: float = 0.01,
    seed: int = 1,
    gap: float | None = None,
    mass: float | None = None,
    friction_given: bool = True,
    progress: ProgressCallback | None = None,
) -> Advice:
    """Run one case by models, copies and other records, and grade how far its results can be trusted.

    Parameters
    ----------
    case : Case
        Case of a cylinder or of a frame.
    run : Run, optional
        Engine that verifies the prediction; without one it stays unverified.
    support : {"recess", "flat", "ring"}, optional
        That is built. Default: that of the run, else "flat" for what slides by the friction given, else
        "recess".
    copies : int, optional
        Number of perturbed copies.
    perturbation : float, optional
        Relative standard deviation of the copies: of tilt and rolling rate at release, or of both components
        of the ground motion.
    seed : int, optional
        Seed of the perturbations.
    gap : float, optional
        Distance to a neighbour on flat ground [m]: how often a slide uses it up.
    mass : float, optional
        Mass of the cylinder, or of one column without a slab [t]: forces in kN and moments in kNm.
    friction_given : bool, optional
        Whether the friction of the case is known, not a default.
    progress : callable, optional
        Called with a `Progress` at the start and at the end of each stage.

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
    >>> advice = rw.advise(rw.Case(pier, initial=release, duration=4.0), copies=20)
    >>> advice.trust.kind, advice.grades["engine"]
    ('trace', 'not tested')
    """
    plan = AdvicePlan(
        support=support
        or (usual_support(case, friction_given=friction_given) if run is None else run.support),
        copies=copies,
        perturbation=perturbation,
        seed=seed,
        gap=gap,
        mass=mass,
    )
    require_judged(case, plan.support, plan.gap)
    if run is not None:
        if run.support != plan.support:
            raise ValueError(f"support must be that of the run, {run.support}, got {plan.support}")
        require_runnable(case, run)
    model = Run(None, plan.support).compared_with[-1]
    other = RECESS_MODEL if model == FLAT_MODEL else FLAT_MODEL
    inputs = fingerprint(
        [*(job_fingerprint(Job(case=case, run=each)) for each in (model, run) if each), plan]
    )
    if expected_mode(case, plan.support) in (REST, SLIDES):
        run = None  # a run at rest has no tilt to verify
    stage = stages(progress, [1.0] * (5 if run is None else 6))
    with stage("the reduced model (compiled on its first run)"):
        trace = simulate_run(case, model)
        if trace.time[-1] > case.length:
            case = with_time_to_fall(case, trace)
            trace = simulate_run(case, model)
    moves = _moves(trace.outcome, trace.uplift_time)
    perturbed: list[Trace] = []
    others: list[Trace] = []
    groups: dict[str, list[Case]] = {}
    tables: dict[str, pd.DataFrame] = {}
    with stage(f"{plan.copies} perturbed copies"):
        if moves:  # this process: starting another one takes longer than hundreds of reduced runs
            groups[COPIES] = plan.perturbed(case)
            perturbed = [simulate_run(each, model, sample_step=DEMAND_STEP) for each in groups[COPIES]]
            # no other support with an anchor, or with a base that never opens, whose chatter takes minutes
            stays = case.is_release or case.friction >= case.friction_of_uplift  # holds on flat ground, too
            if stays and not case.anchor and trace.peak_tilt > CLOSED_TILT * case.cylinder.alpha:
                few = groups[COPIES][:WEAKER_COUNT]  # few copies suffice for a ratio without part in grades
                others = [simulate_run(each, other, sample_step=BAND_STEP) for each in few]
        rows = [*member_rows(COPIES, perturbed), *member_rows(OTHER, others)]
    with stage("other records as strong, planar analysis and the vertical component"):
        records, source = ({}, "") if trace.outcome in NO_PEAK else other_records(case)
        slides = trace.mode == SLIDES
        if slides:  # sliding bodies never uplift
            tables["slides"] = slide_rows({COPIES: plan.perturbed(case), **records}, model)
            records = {}
        groups |= records
        for name, cases in records.items():
            rows += run_rows(name, cases, model)
        planar = planar_runs(records[VELOCITY], model.support) if records else pd.DataFrame()
        vertical, shaken = vertical_effect(case, model, plan if moves else None)
        for name, traces in shaken.items():
            rows += member_rows(name, traces)
            if name == VERTICAL:
                groups[name] = [each.case for each in traces]
    with stage("weaker shaking by the same records"):
        is_shaken = case.motion is not None and case.motion.peak > 0.0
        weaker = [
            row
            for factor in (weaker_factors(uplift_of(case)) if is_shaken else ())
            for name, cases in groups.items()
            for row in run_rows(name, cases[:WEAKER_COUNT], model, factor)
        ]
    with stage("other scales of the ground motion"):
        scaled = dataclasses.replace(case, motion=None, duration=case.length) if slides else case
        scales, lowest = scan_scales(scaled, model.support)
        as_strong = scan_as_strong(scaled, model.support, trace.peak_tilt)
    alpha, band = case.cylinder.alpha, band_of(case, perturbed)
    data = spread_from(band, trace.peak_tilt / alpha)
    prediction, verification, engine = None, None, None
    both = moves and slides_and_rocks(case, plan.support, demands_of(trace)["slip"])
    if run is not None:
        with stage(str(run)):
            if both:
                tables["slipped"] = engine_rows(groups[COPIES], run)
            if moves:
                shorter, reference = trusted_part(case, trace, data)
                verification, prediction, engine = verify_run(shorter, run, reference)
                if shorter.length < case.length:
                    verification = dataclasses.replace(verification, stopped=shorter.length)
    if prediction is None:
        prediction = model_prediction(case, trace, run)
    trust = Trust(kind="trace", until=case.length, because="")
    if moves:
        methods = trace.uplift_time + prediction.length if prediction.reason else math.inf
        if verification is not None and verification.outcome != "failed":
            methods = verification.agreed_until if verification.diverged else math.inf
        trust = trust_of(methods, data, trace.peak_time, float(trace.time[-1]))
    columns = ["group", "outcome", "peak_tilt", "yields", "member"]
    members = pd.DataFrame(rows, columns=None if rows else columns)
    tables |= {
        "members": members,
        "band": band,
        "weaker": pd.DataFrame(weaker, columns=None if weaker else list(members.columns)),
        "scales": scales,
        "as_strong": as_strong,
        "lowest": lowest,
        "planar": planar,
        "trace": _samples(trace, alpha).assign(friction_needed=trace.friction_needed),
        "engine": _samples(engine, alpha),
    }
    form = None
    if others and _differ(group_table(members)):
        form = pairs_of(others, perturbed[: len(others)]).contrast()
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
        "vertical": dataclasses.asdict(vertical),
        "records": source,
        "gap": plan.gap,
        "rocks_and_slides": (str(run) if run else "") if both else None,
        "mode": [each.to_json() for each in mode_findings(case, plan.support, friction_given=friction_given)],
        "mass": plan.mass,
        "options": None,
        "doubts": doubts_of_cases([case], plan.mass),
        "record_sources": sources_of([case.motion]),
        "perturbation": plan.perturbation,
        "seed": plan.seed,
        "inputs": inputs,
    }
    return advice_of(tables, facts)


def require_judged(case: Case, support: str, gap: float | None) -> None:
    """Refuse a case that the advice cannot judge.

    Raises
    ------
    ValueError
        If it has an anchor, such as a tendon, on a support whose reduced model has none, or a gap [m] where
        the support stops a slide.
    """
    if gap is not None and not support_named(support).lets_slide:
        raise ValueError(f"a gap is for a slide on flat ground, got {gap:g} m with support {str(support)!r}")
    if case.anchor and not support_named(support).guided:
        raise ValueError(
            f"an advice on a body with {case.anchor} is for support {str(RECESS)!r}, got {support!r}"
        )


def _restraint(case: Case) -> dict[str, object] | None:
    """Facts of the tendon of a case; None without one.

    uplift_factor, by which it raises the threshold of uplift; initial_stiffness [m g b]; balance_tilt
    [alpha], infinite where the couple brings the body back from every tilt; yield_tilt [alpha], infinite
    where it does not yield; tilts [alpha] at which it carries 2 and 5 times its prestress, or weights
    without one.
    """
    tendon, body = case.tendon, case.cylinder
    if tendon is None:
        return None
    return {
        **dataclasses.asdict(tendon),
        "gaps": tendon.gaps(body),
        "uplift_factor": tendon.uplift_factor(body),
        "initial_stiffness": tendon.initial_stiffness(body),
        "balance_tilt": reduced.balance_tilt_of_case(case) / body.alpha,
        "yield_tilt": tendon.yield_tilt(body) / body.alpha,
        "tilts": {str(n): tendon.tilt_at(body, n * (tendon.prestress or 1.0)) / body.alpha for n in (2, 5)},
    }


def advice_of(tables: Mapping[str, pd.DataFrame], facts: Mapping[str, object]) -> Advice:
    """Advice from the runs of a case, with the tables concluded from them."""
    advice = Advice(tables=tables, facts=plain(facts))
    counting = advice.members[~advice.members["group"].isin(BESIDE_THE_PROBLEM)]
    demands = demand_table(
        pd.concat([counting, advice.weaker]) if len(advice.weaker) else counting,
        advice.cylinder,
        gravity=advice.facts["gravity"],
        support=advice.facts["support"],
        mass=advice.facts["mass"],
    )
    return dataclasses.replace(
        advice, tables={**tables, "groups": group_table(advice.members), "demands": demands}
    )


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
    motion = case.motion
    shaking = motion and {
        **motion_facts(motion),
        "has_vertical": motion.has_vertical,
        "friction_at_rest": case.friction_at_rest,
        "uplift_factor": uplift_of(case),
    }
    return {
        "case": case.name,
        "cylinder": dataclasses.asdict(case.cylinder),
        "motion": shaking,
        "release": dataclasses.asdict(case.initial) if case.is_release and case.initial else None,
        "length": case.length,
        "gravity": case.gravity,
        **{name: getattr(case, name) for name in TERMS},
        "tendon": _restraint(case),
    }


def _response(trace: Trace) -> dict[str, object]:
    moves = _moves(trace.outcome, trace.uplift_time)
    assumed = trace.assumptions_until(overturning_time(trace)) if moves else None
    own = demands_of(trace)
    return {
        "outcome": trace.outcome,
        "mode": trace.mode,
        "displacement": trace.peak_displacement,
        "residual_displacement": trace.residual_displacement,
        "diagnostics": [fact.code for fact in trace.facts],
        "uplift_time": trace.uplift_time,
        "peak_tilt": trace.peak_tilt / trace.case.cylinder.alpha,
        "peak_time": trace.peak_time,
        "end": float(trace.time[-1]),
        "in_one_plane": moves and not trace.rolling_rate.any(),
        "largest_normal_force": assumed.largest_normal_force if assumed else math.nan,
        "slip": own["slip"],
        "tension": own.get("tendon", math.nan),
        "lost": own["lost"],
        "tolerance": tolerance_of(trace),
        "yields": bool(beyond_yield(trace.peak_tilt, trace.case)),
    }


def vertical_effect(
    case: Case, model: Run, plan: AdvicePlan | None
) -> tuple[Vertical, dict[str, list[Trace]]]:
    """Run copies with and without the vertical component of ground motion.

    Of the record itself, or as it is shipped where the case leaves it out; of a record that has none, El
    Centro 1940 as strong is run in its place, whose runs belong to no group: what it usually changes. Nothing
    is run without a plan.

    Returns
    -------
    Vertical
    dict of str to list of Trace
        Runs of the group `VERTICAL` or `HORIZONTAL`, those that the case itself is not; none of a record that
        has no vertical component.
    """
    motion = case.motion
    if motion is None or motion.peak == 0.0:
        return Vertical(), {}
    source: Literal["own", "shipped", "other"] = "own" if motion.has_vertical else "shipped"
    record, duration = with_vertical(motion), case.duration
    if record is None:
        record = el_centro_1940(vertical=True)
        source, record, duration = "other", record.scaled(motion.peak / record.peak), None
    threshold = uplift_of(case, record)
    about = Vertical(source=source, record=record.name, uplift_factor=threshold)
    if plan is None:
        return about, {}
    runs: dict[str, list[Trace]] = {}
    for name, each in ((VERTICAL, record), (HORIZONTAL, without_vertical(record))):
        shaken = dataclasses.replace(case, motion=each, duration=duration)
        copies = plan.perturbed(shaken, VERTICAL_COUNT)
        runs[name] = [simulate_run(copy, model, sample_step=DEMAND_STEP) for copy in copies]
    contrast = pairs_of(*runs.values()).contrast()
    ratios = None if contrast is None or not contrast.compared else ratios_of(contrast)
    kept = {"own": HORIZONTAL, "shipped": VERTICAL}.get(source, "")
    return dataclasses.replace(about, ratios=ratios), {
        name: traces for name, traces in runs.items() if name == kept
    }
