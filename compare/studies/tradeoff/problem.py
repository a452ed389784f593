"""The problems on which methods are held against each other, and what an error is in each.

One cylinder in all of them, R = 6 m and tan(alpha) = 0.2, so that computing times may be compared:

* turn: free response from alpha/2; error of the angle of turn, exact by quadrature in a recess and
  converged on open ground, where no quadrature is known;
* shaken: twice El Centro until ten seconds after uplift; largest error of the tilt. The factor takes its
  passes away from upright: as recorded they come so close that the trace is a matter of chance;
* peaks: many synthetic ground motions; distance of the distributions of peak tilt.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState, Trace, el_centro_1940

from ..ensemble.members import synthetic_motions, with_motions

Array = NDArray[np.float64]

MODELS = ("recess", "flat")
# of the tight solutions, and a rest rule a hundred times finer than the default: without any a cylinder
# that just uplifts chatters at upright without end, and there is no solution to hold a method against
TIGHT = 1e-12
FINE_REST_TILT = 1e-10
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)

_TURN_LENGTH = 2.6  # [s] a period of the tilt is 2.39 s
_AFTER_UPLIFT = 10.0  # [s]
_FACTOR = 2.0  # on El Centro
_SAMPLE = 0.02  # [s]
_MEMBER_LENGTH = 10.0  # [s]
# about half of the members rock beyond a fifth of alpha, few overturn
_MEMBER_PEAK = 0.45 * 9.81  # [m/s^2]


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """Cases, what is asked of a run of each, and the answer.

    Parameters
    ----------
    name, title, error_title : str
        For the table, for a heading, and for an axis, with the unit.
    cases : sequence of Case
        More than one are an ensemble.
    sample_step : float
        At which a run is sampled [s].
    quantity : callable
        (trace) -> what is asked of a run, shape (k,).
    distance : callable
        (quantities of all cases, those of the reference) -> error.
    references : dict
        Quantities of all cases by model.
    doubt : dict
        Error of the reference itself by model, against one ten times less tight (0: exact).
    source : dict
        What the reference is, by model.
    """

    name: str
    title: str
    error_title: str
    cases: Sequence[Case]
    sample_step: float
    quantity: Callable[[Trace], Array]
    distance: Callable[[Sequence[Array], Sequence[Array]], float]
    references: dict[str, list[Array]]
    doubt: dict[str, float]
    source: dict[str, str]

    def error(self, model: str, quantities: Sequence[Array]) -> float:
        """Return the error of an answer against that of a model; NaN without an answer for each case."""
        if any(value.size == 0 or not np.isfinite(value).all() for value in quantities):
            return math.nan
        return self.distance(quantities, self.references[model])


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """What a method says of one case: the quantity, empty where it failed, and its message."""

    quantity: Array
    message: str = ""


def problems(*, quick: bool = False) -> list[Problem]:
    """Return the three problems; `quick` has fewer members of the ensemble."""
    return [_turn(), _shaken(), _peaks(4 if quick else 12)]


def reference_run(case: Case, model: str, sample_step: float, rtol: float = TIGHT) -> Trace:
    """Return the tight solution of a case: the model with next to no rest rule.

    Raises
    ------
    RuntimeError
        If the solution fails: there is nothing to hold a method against.
    """
    trace = reduced.simulate(
        case, support=model, rtol=rtol, rest_tilt=FINE_REST_TILT, sample_step=sample_step
    )
    if trace.outcome == "failed":
        raise RuntimeError(f"the reference of {case.name} failed: {trace.facts}")
    return trace


def _make(problem: Problem) -> Problem:
    """Fill in the references that are converged, and how far they have converged."""
    references, doubt, source = dict(problem.references), dict(problem.doubt), dict(problem.source)
    for model in MODELS:
        if model in references:
            continue
        tight, less = (
            [
                problem.quantity(reference_run(case, model, problem.sample_step, rtol))
                for case in problem.cases
            ]
            for rtol in (TIGHT, 10.0 * TIGHT)
        )
        references[model], doubt[model] = tight, problem.distance(less, tight)
        source[model] = f"{model} model, tolerance {TIGHT:g} and rest threshold {FINE_REST_TILT:g}"
    return dataclasses.replace(problem, references=references, doubt=doubt, source=source)


def _turn() -> Problem:
    release = InitialState(0.5 * PIER.alpha, rolling_rate=0.1)
    exact = math.degrees(reduced.angle_of_turn(PIER, release))
    return _make(
        Problem(
            name="turn",
            title="Angle of turn in free response",
            error_title="error of the angle of turn [deg]",
            cases=[Case(PIER, initial=release, duration=_TURN_LENGTH, name="release at alpha/2")],
            sample_step=_TURN_LENGTH,
            quantity=_angle_of_turn,
            distance=_largest,
            references={"recess": [np.array([exact])]},
            doubt={"recess": 0.0},
            source={"recess": "exact, by quadrature"},
        )
    )


def _angle_of_turn(trace: Trace) -> Array:
    turns = trace.passes["angle_of_turn"]
    return np.asarray(np.degrees(turns.to_numpy(float)[:1]), dtype=np.float64)


def _shaken() -> Problem:
    motion = el_centro_1940().scaled(_FACTOR)
    uplift = reduced.simulate(Case(PIER, motion), rtol=TIGHT).uplift_time
    end = _SAMPLE * round((uplift + _AFTER_UPLIFT) / _SAMPLE)
    case = Case(PIER, motion, duration=end, name=f"{_FACTOR:g} × El Centro")
    return _make(
        Problem(
            name="shaken",
            title=f"{_FACTOR:g} × El Centro until {_AFTER_UPLIFT:g} s after uplift",
            error_title="largest error of the tilt [α]",
            cases=[case],
            sample_step=_SAMPLE,
            quantity=_whole_tilt,
            distance=_largest,
            references={},
            doubt={},
            source={},
        )
    )


def _whole_tilt(trace: Trace) -> Array:
    """Tilt of all samples [alpha]; empty where the run ended before the case."""
    tilt = trace.tilt / trace.case.cylinder.alpha
    return tilt if abs(trace.time[-1] - trace.case.length) < 1e-6 else np.empty(0)


def _peaks(count: int) -> Problem:
    standing = Case(PIER, synthetic_motions(2, peak=1.0, seed=0)[0], name="synthetic")
    motions = synthetic_motions(count, peak=_MEMBER_PEAK, seed=1940, duration=_MEMBER_LENGTH)
    return _make(
        Problem(
            name="peaks",
            title=f"Distribution of peak tilt over {count} synthetic motions",
            error_title="distance of distributions [α]",
            cases=with_motions(standing, motions),
            sample_step=_MEMBER_LENGTH,
            quantity=_peak,
            distance=_wasserstein,
            references={},
            doubt={},
            source={},
        )
    )


def _peak(trace: Trace) -> Array:
    """Peak tilt [alpha]; what leans beyond its balance counts as that, it falls sooner or later."""
    return np.array([min(trace.peak_tilt / trace.case.cylinder.alpha, 1.0)])


def _largest(found: Sequence[Array], reference: Sequence[Array]) -> float:
    pairs = list(zip(found, reference, strict=True))
    if any(ours.shape != theirs.shape for ours, theirs in pairs):
        return math.nan
    return max(float(np.abs(ours - theirs).max()) for ours, theirs in pairs)


def _wasserstein(found: Sequence[Array], reference: Sequence[Array]) -> float:
    ours, theirs = (np.sort(np.concatenate(list(values))) for values in (found, reference))
    return float(np.abs(ours - theirs).mean())


def sampling_distance(problem: Problem, model: str, *, draws: int = 500, seed: int = 0) -> float:
    """Return how far apart two ensembles as large as this one are by chance: median of a bootstrap.

    No method needs to be better than that, because another earthquake changes more.
    """
    peaks = np.concatenate(problem.references[model])
    random = np.random.default_rng(seed)
    samples = np.sort(random.choice(peaks, (2, draws, len(peaks))), axis=2)
    return float(np.median(np.abs(samples[0] - samples[1]).mean(axis=1)))
