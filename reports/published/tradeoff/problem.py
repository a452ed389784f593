"""Problems of the trade-off, each with its error measure.

One cylinder in all of them, R = 6 m and tan(alpha) = 0.2, so that computing times may be compared:

* turn: free response from alpha/2; error of the angle of turn;
* shaken: twice El Centro until ten seconds after uplift; largest error of the tilt. The factor takes its
  passes away from upright: as recorded they come so close that the trace is a matter of chance;
* peaks: many synthetic ground motions; distance of the distributions of peak tilt.

The reference of a method is the answer for its own support: that of a reduced model or, between walls, which
no reduced model has, that of the same engine at half of the finest step of its line.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

import rockwobble as rw
from rockwobble import multibody, reduced
from rockwobble.models import (
    Case,
    Cylinder,
    InitialState,
    Run,
    Trace,
    el_centro_1940,
    synthetic_motions,
    with_motions,
)

Array = NDArray[np.float64]

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RECESS, SUPPORTS = "recess", ("recess", "flat", "ring")
ENGINES = multibody.available_engines()

# of the tight solutions, and a rest rule a hundred times finer than the default: without any a cylinder
# that just uplifts chatters at upright without end, and there is no solution to compare with
TIGHT = 1e-12
FINE_REST_TILT = 1e-10

_STEPS = (1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5)  # [s] of the engines
_TURN_LENGTH = 2.6  # [s] a period of the tilt is 2.39 s
_AFTER_UPLIFT = 10.0  # [s]
_FACTOR = 2.0  # on El Centro
_SAMPLE = 0.02  # [s]
_MEMBER_LENGTH = 10.0  # [s]
# about half of the members rock beyond a fifth of alpha, few overturn
_MEMBER_PEAK = 0.45 * 9.81  # [m/s^2]
_DRAWS = 500  # of a bootstrap


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reference:
    """The answer for one support.

    Attributes
    ----------
    quantities : sequence of ndarray
        Quantities of all cases.
    doubt : float
        Its own error, from an answer ten times less tight or of twice the step; 0 where it is exact.
    source : {"exact", "tight", "half_step"}
    """

    quantities: Sequence[Array]
    doubt: float
    source: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Problem:
    """Cases of a problem, the quantity asked for, and reference answers.

    Attributes
    ----------
    name : {"turn", "shaken", "peaks"}
    cases : sequence of Case
        More than one are an ensemble.
    sample_step : float
        Time between samples of a run [s].
    steps, few_steps : sequence of float
        Time steps of the engines [s], all and those of what costs more.
    quantity : callable
        Returns what is asked of a trace, (k,); nothing where it has no such thing.
    distance : callable
        (quantities of all cases, those of the reference) -> error, [deg] in "turn", else [alpha].
    references : mapping
        By support: "recess", "flat", and "ring" where an engine that has one is installed.
    """

    name: str
    cases: Sequence[Case]
    sample_step: float
    steps: Sequence[float]
    few_steps: Sequence[float]
    quantity: Callable[[Trace], Array]
    distance: Callable[[Sequence[Array], Sequence[Array]], float]
    references: Mapping[str, Reference]

    def error(self, support: str, quantities: Sequence[Array]) -> float:
        """Error of an answer; NaN if any case has none."""
        if any(value.size == 0 or not np.isfinite(value).all() for value in quantities):
            return math.nan
        return self.distance(quantities, self.references[support].quantities)


def problems(*, quick: bool = False) -> Iterator[Problem]:
    """Yield the three problems; `quick`: fewer steps and ensemble members."""
    yield turn(quick=quick)
    yield shaken(quick=quick)
    yield peaks(quick=quick)


def turn(*, quick: bool = False) -> Problem:
    """Problem of the angle of turn, whose answer in a recess is exact, by quadrature."""
    release = InitialState(0.5 * PIER.alpha, rolling_rate=0.1)
    exact = math.degrees(reduced.angle_of_turn(PIER, release))
    case = Case(PIER, initial=release, duration=_TURN_LENGTH, name="release at alpha/2")
    references: dict[str, Reference] = {
        RECESS: Reference(quantities=[np.array([exact])], doubt=0.0, source="exact")
    }
    return _single("turn", case, _TURN_LENGTH, _angle_of_turn, references, quick=quick)


def shaken(*, quick: bool = False) -> Problem:
    """Problem of the tilt under El Centro."""
    motion = el_centro_1940().scaled(_FACTOR)
    uplift = reduced.simulate(Case(PIER, motion), rtol=TIGHT).uplift_time
    end = _SAMPLE * round((uplift + _AFTER_UPLIFT) / _SAMPLE)
    case = Case(PIER, motion, duration=end, name=f"{_FACTOR:g} × El Centro")
    return _single("shaken", case, _SAMPLE, _whole_tilt, {}, quick=quick)


def _single(
    name: str,
    case: Case,
    sample_step: float,
    quantity: Callable[[Trace], Array],
    references: Mapping[str, Reference],
    *,
    quick: bool,
) -> Problem:
    """Problem of one case, with its known answers."""
    return _with_answers(
        Problem(
            name=name,
            cases=[case],
            sample_step=sample_step,
            steps=_STEPS[:3] if quick else _STEPS,
            few_steps=_STEPS[:2] if quick else _STEPS[:5],
            quantity=quantity,
            distance=_largest,
            references=references,
        )
    )


def peaks(*, quick: bool = False) -> Problem:
    """Problem of the peak tilts under many motions."""
    standing = Case(PIER, synthetic_motions(2, peak=1.0, seed=0)[0], name="synthetic")
    motions = synthetic_motions(4 if quick else 12, peak=_MEMBER_PEAK, seed=1940, duration=_MEMBER_LENGTH)
    steps = _STEPS[:2] if quick else _STEPS[:4]
    return _with_answers(
        Problem(
            name="peaks",
            cases=with_motions(standing, motions),
            sample_step=_MEMBER_LENGTH,
            steps=steps,
            few_steps=steps,
            quantity=_peak,
            distance=_wasserstein,
            references={},
        )
    )


def sampling_distance(problem: Problem, support: str) -> float:
    """Chance distance of two ensembles of this size: bootstrap median [alpha].

    No method needs to be better than that, because another earthquake changes more.
    """
    answers = np.concatenate(problem.references[support].quantities)
    random = np.random.default_rng(0)
    samples = np.sort(random.choice(answers, (2, _DRAWS, len(answers))), axis=2)
    return float(np.median(np.abs(samples[0] - samples[1]).mean(axis=1)))


def _with_answers(problem: Problem) -> Problem:
    """Add the computed reference answers, with their convergence."""
    references = dict(problem.references)
    for name in SUPPORTS:
        runs = _reference_runs(name, min(problem.few_steps))
        if name not in references and runs:
            best, other = ([_answer(problem, case, run) for case in problem.cases] for run in runs)
            source = "tight" if name in reduced.SUPPORTS else "half_step"
            references[name] = Reference(quantities=best, doubt=problem.distance(other, best), source=source)
    return replace(problem, references=references)


def _reference_runs(support: str, finest: float) -> list[Run]:
    """Reference run of a support, and a less accurate one; none if impossible."""
    if support in reduced.SUPPORTS:
        tolerances = (TIGHT, 10.0 * TIGHT)
        return [Run(None, support, rtol=rtol, rest_tilt=FINE_REST_TILT) for rtol in tolerances]
    engines = [each for each in ENGINES if support in multibody.find_engine(each).supports]
    return [Run(engine, support, step) for engine in engines[-1:] for step in (0.5 * finest, finest)]


def simulate(problem: Problem, case: Case, run: Run) -> Trace:
    """Run of a case, sampled as the problem needs."""
    return rw.simulate(
        case,
        support=run.support,
        engine=run.engine,
        time_step=run.time_step,
        sample_step=problem.sample_step,
        **run.settings,
    )


def _answer(problem: Problem, case: Case, run: Run) -> Array:
    trace = simulate(problem, case, run)
    if trace.outcome == "failed":
        raise RuntimeError(f"the reference of {case.name} failed: {trace.facts}")
    return problem.quantity(trace)


def _angle_of_turn(trace: Trace) -> Array:
    return np.asarray(np.degrees(trace.passes["angle_of_turn"].to_numpy(float)[:1]))


def _whole_tilt(trace: Trace) -> Array:
    """Tilt of all samples [alpha]; empty where the run ended before the case."""
    whole = abs(trace.time[-1] - trace.case.length) < 1e-6
    return trace.tilt / trace.case.cylinder.alpha if whole else np.empty(0)


def _peak(trace: Trace) -> Array:
    """Peak tilt [alpha], limited to the balance tilt, beyond which it overturns."""
    return np.array([min(trace.peak_tilt / trace.case.cylinder.alpha, 1.0)])


def _largest(answers: Sequence[Array], reference: Sequence[Array]) -> float:
    pairs = list(zip(answers, reference, strict=True))
    if any(ours.shape != theirs.shape for ours, theirs in pairs):
        return math.nan
    return max(float(np.abs(ours - theirs).max()) for ours, theirs in pairs)


def _wasserstein(answers: Sequence[Array], reference: Sequence[Array]) -> float:
    ours, theirs = (np.sort(np.concatenate(list(values))) for values in (answers, reference))
    return float(np.abs(ours - theirs).mean())
