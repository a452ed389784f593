"""Advice on one case before its results are used: all of its runs, from one call."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from rockwobble.models import Case, GroundMotion, Run, Trace, el_centro_1940, perturbed_copies
from rockwobble.models.number_checks import require_one_of

from ...metrics.distributions import Contrast, contrast
from ...runs.choice import require_runnable
from ...runs.execution import SAMPLE_STEP, simulate_run
from ...runs.progress import ProgressCallback, Stages
from .advice import OTHER, Advice
from .members import COPIES, VELOCITY, member_rows, other_records, ratios_of
from .scales import planar_runs, scan_scales
from .trust import BAND_STEP, Trust, band_of, predicted, spread_from, trust_of, verified

SUPPORTS = ("recess", "flat", "ring")
COUNT = 100  # copies: quantiles of 5 % then rest on five runs
FEWEST, MOST = 20, 10_000  # one run stands for 5 % of them, and ten thousand take minutes
PERTURBATION = 0.01  # nobody knows a record or a release better than to a percent
SEED = 1
_VERTICAL_COUNT = 20  # pairs of copies with and without the vertical component


def require_count(name: str, count: int) -> None:
    """Raise ValueError unless an advice can be had of so many copies."""
    if not FEWEST <= count <= MOST:
        raise ValueError(f"{name} must be from {FEWEST} to {MOST}, got {count!r}")


def advise(
    case: Case,
    run: Run | None = None,
    *,
    support: str = "recess",
    friction_given: bool = True,
    count: int = COUNT,
    perturbation: float = PERTURBATION,
    seed: int = SEED,
    progress: ProgressCallback | None = None,
) -> Advice:
    """Run what it takes to say how far the results of one case can be trusted.

    Parameters
    ----------
    case : Case
    run : Run, optional
        Engine that verifies the prediction; without one it stays unverified.
    support : str, optional
        What holds the cylinder in place; that of `run` where it is given. "flat" asks for the flat-ground
        model, any other for the recess model.
    friction_given : bool, optional
        Whether the friction of the case is what there is, not a default.
    count, perturbation, seed
        Copies, their relative standard deviation, and the seed of both draws: see `perturbed_copies`.
    progress : callable, optional
        Called with a `Progress` at the start and at the end of each stage.

    Returns
    -------
    Advice

    Raises
    ------
    ValueError
        If the engine cannot run the case, or a number is out of range.

    Examples
    --------
    >>> from rockwobble.models import Cylinder, el_centro_1940
    >>> pier = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940())
    >>> found = advise(pier, count=20)
    >>> found.trust.kind, found.grades["overturning"]
    ('statistics', 'caution')
    """
    if run is not None:
        support = run.support
        require_runnable(case, run)
    require_one_of("support", support, SUPPORTS)
    require_count("count", count)
    model, other = Run(None, "recess"), Run(None, "flat")
    if support == "flat":
        model, other = other, model
    stage = Stages(progress, [1.0] * (4 if run is None else 5)).stage
    with stage("both reduced models (compiled on their first run)"):
        trace = simulate_run(case, model)
        if trace.time[-1] > case.length:
            case = _to_the_fall(case, float(trace.time[-1]))
            trace = simulate_run(case, model)
        other_trace = simulate_run(case, other)
    moves = math.isfinite(trace.uplift_time) and trace.outcome != "failed"
    copies: list[Trace] = []
    others: list[Trace] = []
    with stage(f"{count} perturbed copies"):
        if moves:  # in this process: other ones take longer to begin than hundreds of reduced runs
            cases = perturbed_copies(case, count, perturbation=perturbation, seed=seed)
            copies = [simulate_run(each, model) for each in cases]
            others = [simulate_run(each, other, sample_step=BAND_STEP) for each in cases]
        rows = [*member_rows(COPIES, copies), *member_rows(OTHER, others)]
    with stage("other records as strong, and planar analysis"):
        records, source = other_records(case) if trace.outcome != "failed" else ({}, "")
        for name, cases in records.items():
            rows += member_rows(name, (simulate_run(each, model) for each in cases))
        planar = planar_runs(records[VELOCITY], model.support) if records else pd.DataFrame()
    with stage("other scales of the ground motion"):
        scales, lowest = scan_scales(case, model.support)
        vertical = vertical_effect(case, model, perturbation=perturbation, seed=seed) if records else None
    prediction, verification, engine_trace = predicted(case, trace, run), None, None
    if run is not None:
        with stage(str(run)):
            if moves:
                verification, prediction, engine_trace = verified(case, run, model)
    band = band_of(case, copies)
    trust = Trust(kind="trace", until=case.length, because="")
    if moves:
        methods = trace.uplift_time + prediction.length if prediction.reason else math.inf
        if verification is not None and verification.outcome != "failed":
            methods = verification.agreed_until if verification.diverged else math.inf
        data = spread_from(band, trace.peak_tilt / case.cylinder.alpha)
        trust = trust_of(methods, data, float(trace.time[int(trace.tilt.argmax())]), float(trace.time[-1]))
    return Advice(
        case=case,
        support=support,
        friction_given=friction_given,
        trace=trace,
        other_trace=other_trace,
        engine_trace=engine_trace,
        members=pd.DataFrame(rows, columns=None if rows else ["group", "outcome", "peak_tilt", "member"]),
        band=band,
        scales=scales,
        planar=planar,
        lowest=lowest,
        prediction=prediction,
        verification=verification,
        trust=trust,
        form=_contrast(others, copies) if moves else None,
        vertical=vertical,
        records=source,
        perturbation=perturbation,
        seed=seed,
    )


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
    shaken = dataclasses.replace(case, motion=record, duration=case.duration if motion.has_vertical else None)
    cases = perturbed_copies(shaken, _VERTICAL_COUNT, perturbation=perturbation, seed=seed)
    flat = [dataclasses.replace(each, motion=_horizontal(each.motion)) for each in cases]
    found = _contrast(
        *([simulate_run(each, model, sample_step=1.0) for each in part] for part in (cases, flat))
    )
    if found is None or not found.compared:
        return None
    return {"given": motion.has_vertical, "record": record.name, **ratios_of(found)}


def _horizontal(motion: GroundMotion | None) -> GroundMotion:
    assert motion is not None
    return GroundMotion(motion.acceleration[:, :2], motion.time_step, motion.name)


def _contrast(traces: Sequence[Trace], against: Sequence[Trace]) -> Contrast | None:
    peaks, others = (np.array([trace.peak_tilt for trace in part]) for part in (traces, against))
    fell, fell_there = (
        np.array([trace.outcome == "overturned" for trace in part]) for part in (traces, against)
    )
    if np.count_nonzero(np.isfinite(peaks) & np.isfinite(others)) < 2:
        return None
    return contrast(peaks, others, fell, fell_there)


def _to_the_fall(case: Case, end: float) -> Case:
    """Return a case that takes until its fall at `end` [s], after what was asked for, over still ground.

    All that is run for it then sees the fall: the engine, the copies, and when two methods diverge.
    """
    motion = case.motion
    if motion is not None and case.length < motion.duration:
        kept = math.floor(case.length / motion.time_step * (1.0 + 1e-12)) + 1
        motion = GroundMotion(motion.acceleration[: max(kept, 2)], motion.time_step, motion.name)
    duration = math.ceil(end / SAMPLE_STEP) * SAMPLE_STEP
    return dataclasses.replace(case, motion=motion, duration=duration)
