"""Everything that is to be known of one case before its results are used, from one call."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, GroundMotion, Run, Trace

from ...comparison.prediction import Prediction
from ...runs.choice import require_runnable
from ...runs.execution import SAMPLE_STEP, simulate_run
from ...runs.progress import Clock, ProgressCallback
from ...storage.provenance import package_versions
from ..spectrum.lowest_overturning import uplift_factor
from .advice import Advice
from .demands import Demands, demands_of
from .grades import Trust, trust_of
from .planar import planar_view
from .scales import scan_scales
from .spread import COUNT, PERTURBATION, SEED, Spread, spread_of_starts
from .verification import Verification, predicted, verified

SUPPORTS = ("recess", "flat", "ring")
FEWEST, MOST = 20, 10_000  # members: one run stands for 5 % of them, and ten thousand take a minute
_SAMPLES = 200_000  # of a run until its fall: closer than a near pass lasts, and computed in a second
_OTHER = {"recess": Run(None, "flat"), "flat": Run(None, "recess")}


def advise(
    case: Case,
    run: Run | None = None,
    *,
    support: str = "recess",
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
        What holds the cylinder in place; that of `run` where it is given. "flat" asks for the rolling
        model, any other for the recess.
    count, perturbation, seed
        Members, their relative standard deviation, and the seed of both draws: see `perturbed_starts`.
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
    >>> found.trust.kind, found.planar.kind
    ('statistics', 'unconservative')
    """
    if run is not None:
        support = run.support
        require_runnable(case, run)
    if support not in SUPPORTS:
        raise ValueError(f"support must be one of {', '.join(SUPPORTS)}, got {support!r}")
    if not FEWEST <= count <= MOST:
        raise ValueError(f"count must be from {FEWEST} to {MOST}, got {count!r}")
    model = Run(None, "flat" if support == "flat" else "recess")
    other = _OTHER[model.support]
    stages = _Stages(case.name, progress, total=3 if run is None else 4)
    with stages.one("recess and flat models (compiled on their first run)"):
        response = simulate_run(case, model)
        if response.time[-1] > case.length:
            case = _to_the_fall(case, float(response.time[-1]))
            response = simulate_run(case, model)
        other_response = simulate_run(case, other)
        demands = _demands(case, response, model)
    moves = math.isfinite(response.uplift_time) and response.outcome != "failed"
    spread = None
    with stages.one(f"{count} perturbed starts"):
        if moves:
            spread = spread_of_starts(
                case,
                response,
                other_response,
                models=(model, other),
                count=count,
                perturbation=perturbation,
                seed=seed,
            )
    with stages.one("other scales of the ground motion, and planar analysis"):
        scan = scan_scales(case, model.support) if response.outcome != "failed" else None
    prediction = predicted(case, response, run)
    verification = None
    if run is not None:
        with stages.one(f"{run.engine} {run.support}"):
            if moves:
                verification, prediction = verified(case, run, model)
    peak_time = _peak_time(response) if moves else math.nan
    return Advice(
        case=case,
        support=support,
        model=model,
        other=other,
        response=response,
        other_response=other_response,
        uplift_factor=_uplift_factor(case),
        peak_time=peak_time,
        demands=demands,
        prediction=prediction,
        verification=verification,
        spread=spread,
        scan=scan,
        planar=planar_view(scan),
        trust=_trust(case, response, prediction, verification, spread, peak_time),
        versions=package_versions(),
    )


class _Stages:
    """Tells a callback of one stage after the other."""

    def __init__(self, name: str, progress: ProgressCallback | None, total: int) -> None:
        self._name, self._clock = name, Clock(progress, [1.0] * total)

    @contextmanager
    def one(self, label: str) -> Iterator[None]:
        self._clock("started", f"{self._name}, {label}")
        yield
        self._clock("finished", f"{self._name}, {label}", 0)


def _to_the_fall(case: Case, end: float) -> Case:
    """Return a case that takes until its fall at `end` [s], after what was asked for, over still ground.

    All that is run for it then sees the fall: the engine, the members, and when two methods part.
    """
    motion = case.motion
    if motion is not None and case.length < motion.duration:
        kept = math.floor(case.length / motion.time_step * (1.0 + 1e-12)) + 1
        motion = GroundMotion(motion.acceleration[: max(kept, 2)], motion.time_step, motion.name)
    duration = math.ceil(end / SAMPLE_STEP) * SAMPLE_STEP
    return dataclasses.replace(case, motion=motion, duration=duration)


def _uplift_factor(case: Case) -> float:
    if case.motion is None:
        return math.inf
    return uplift_factor(case.motion, case.cylinder.tan_alpha, case.gravity, until=case.length)


def _demands(case: Case, response: Trace, model: Run) -> Demands:
    """Demands until the run last passes alpha, if it overturns: what a falling cylinder asks is none."""
    if response.outcome != "overturned":
        return demands_of(response)
    below = np.flatnonzero(response.tilt <= case.cylinder.alpha)
    fall = float(response.time[below[-1]]) if len(below) else 0.0
    if not fall > 0.0:
        return demands_of(response)
    # a run that ended here would be followed to the ground, too: the samples of the whole have to tell
    fine = reduced.simulate(
        Case(
            case.cylinder,
            case.motion,
            initial=case.initial,
            duration=case.duration,
            gravity=case.gravity,
            friction=case.friction,
        ),
        sample_step=min(SAMPLE_STEP, fall / _SAMPLES),
        support=model.support,
    )
    return demands_of(fine, until=fall)


def _peak_time(response: Trace) -> float:
    """Time of the largest tilt [s]; to a sample."""
    return float(response.time[int(response.tilt.argmax())])


def _trust(
    case: Case,
    response: Trace,
    prediction: Prediction,
    verification: Verification | None,
    spread: Spread | None,
    peak_time: float,
) -> Trust:
    if spread is None:
        return Trust(kind="trace", until=case.length, because="")
    end = float(response.time[-1])
    if verification is not None and verification.outcome != "failed":
        methods = verification.agreed_until if verification.diverged else math.inf
    else:
        methods = response.uplift_time + prediction.length if prediction.reason else math.inf
    data = spread.followed_until if spread.followed_until < case.length else math.inf
    return trust_of(methods, data, peak_time, end)
