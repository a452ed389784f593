"""Layer metrics, second part: predicted agreement times, and distributions of peaks."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from rockwobble.models import Case, Cylinder, Run, Trace

from ...comparison.prediction import Prediction, close_pass, estimated_error, measured_error, predict, verdict
from ...metrics.distributions import contrast
from ..bench import Array, Bench
from ..finding import Bound, Finding, worst_of
from ..problems import PIER, released
from .made_traces import RECESS, made, passes

if TYPE_CHECKING:
    from ...comparison.budget import ErrorBudget

ALPHA = PIER.alpha
STEP = 0.01
TIME: Array = STEP * np.arange(2001, dtype=np.float64)
LENGTH = 20.0
GROWTH, ERROR = 0.8, 1e-5  # of a perturbed copy [1/s], of an engine in its first second [alpha]
EXPONENTIAL = "a difference that grows as an exponential reaches 1 % where it must; samples 0.01 s apart"
TIMES = Bound(STEP * (1.0 + 1e-9), EXPONENTIAL, "s")
VERDICTS = Bound(1e-12, "within a factor of two; in proportion to the step, at any size")
COUNTED = Bound(1e-12, "counted value by value")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    del bench
    part = "predicted agreement time (compare/comparison/prediction.py)"
    yield worst_of("predicted agreement times", _predictions(), TIMES, part)
    yield worst_of("words on a prediction, and scale of an estimated error", _verdicts(), VERDICTS, part)
    part = "distributions (compare/metrics/distributions.py)"
    yield worst_of("distances of distributions of peaks", _distances(), COUNTED, part)


def _predictions() -> dict[str, float]:
    case = released(0.5, 0.1, LENGTH, name="made")
    table = passes([3.0, 7.0, 11.0], [2e-3, 3e-4, 1e-5])
    reference = _trace(0.0, passes=table)
    landed = 1.0 + np.where(TIME >= 5.0, math.pi, 0.0)
    lands = _trace(0.0, rolling_angle=landed)
    late = _trace(0.0, passes=table, uplift_time=2.0)

    def perturbed(disturbed: Case, run: Run) -> Trace:
        # a copy of the recess model moves with the change of its gravity, any other one not at all
        return _trace((disturbed.gravity / case.gravity - 1.0) * (run == RECESS))

    def predicted(own: Trace, resolution: float, error: float = ERROR) -> Prediction:
        return predict(
            case, reference=reference, own=own, contact_resolution=resolution, error=error, simulate=perturbed
        )

    # RMS of 7 d exp(k t) over the first second, sample by sample; d such that it is the error
    first = np.exp(GROWTH * TIME[:101])
    rms = float(np.sqrt(np.mean(first**2)))
    grown = math.log(0.01 * rms / ERROR) / GROWTH
    form = predicted(_trace(0.02 / 7.0 / math.exp(GROWTH * 4.0)), 0.0)
    growth, near = predicted(reference, 0.0), predicted(reference, 1e-3)
    other = predicted(reference, 0.0, error=1e-12)
    return {
        "first pass below the resolution": close_pass(reference, 1e-3, LENGTH).length - 7.0,
        "from the uplift": close_pass(late, 1e-4, LENGTH).length - 9.0,
        "no such pass": close_pass(reference, 1e-6, LENGTH).length - LENGTH,
        "a pass through the upright position": close_pass(lands, 1e-6, LENGTH).length - 5.0,
        "growth": growth.length - grown + _unlike(growth.reason, "growth"),
        "a pass before it": near.length - 7.0 + _unlike(near.reason, "pass"),
        "model form": form.length - (4.0 - math.log(2.0) / GROWTH) + _unlike(form.reason, "model form"),
        "nothing": other.length - LENGTH + _unlike(other.reason, ""),
    }


def _trace(strength: float, **fields: Any) -> Trace:
    """A standing lean of alpha/2 and 7 times `strength` alpha that grows."""
    tilt = 0.5 * ALPHA + 7.0 * strength * ALPHA * np.exp(GROWTH * TIME)
    return made(TIME, tilt, **fields)


def _verdicts() -> dict[str, float]:
    words = {
        (5.0, True, 9.0, "pass"): "in time",
        (4.0, True, 9.0, "pass"): "earlier",
        (19.0, True, 9.0, "pass"): "later",
        (20.0, False, 9.0, "pass"): "later",
        (20.0, False, 20.0, ""): "never, as predicted",
        (4.0, True, 20.0, ""): "earlier",
    }
    errors = {f"{given}": _unlike(verdict(*given), word) for given, word in words.items()}
    shaken = Case(PIER, duration=1.0)
    small = Case(Cylinder(semidiagonal=0.06, tan_alpha=0.2), duration=1.0)
    error = estimated_error(shaken, "mujoco", 1e-4)
    leaning = (released(0.5, 0.0, 1.0, Cylinder(semidiagonal=6.0, tan_alpha=a)) for a in (0.2, 0.6))
    halved, exact = (
        cast("ErrorBudget", SimpleNamespace(time=TIME, numerics=np.where(TIME < 1.005, error, 1.0)))
        for error in (3e-5, 0.0)
    )
    slender, squat = (estimated_error(case, "pybullet", 1e-4) for case in leaning)
    return errors | {
        "twice the step": estimated_error(shaken, "mujoco", 2e-4) / error - 2.0,
        "a hundredth of the size": estimated_error(small, "mujoco", 1e-5) / error - 1.0,
        "three times as squat, released": squat / slender - 9.0,
        "shown by another step": measured_error(shaken, halved) / 3e-5 - 1.0,
        "shown by another step, none": measured_error(shaken, exact) / 1e-9 - 1.0,
    }


def _distances() -> dict[str, float]:
    drawn = np.random.default_rng(3)
    ours = drawn.lognormal(-1.0, 0.5, 20)
    theirs = ours * drawn.lognormal(0.2, 0.3, 20)
    fell, fell_there = (np.isin(np.arange(20), fallen) for fallen in ([2, 9], [9, 11, 13, 14, 16]))
    ours[0] = math.nan
    found = contrast(ours, theirs, fell, fell_there)
    # a run that falls has a peak of its own, and counts as larger than any other
    standing = (1, 3, 4, 5, 6, 7, 8, 10, 12, 15, 17, 18, 19)
    logs = sorted([math.inf, *(math.log(ours[i] / theirs[i]) for i in standing), *[-math.inf] * 4])
    # of all signs that the differences could have had, those whose ranks are as unequal: infinite ones tie
    sizes = np.abs(logs)
    ranks = np.array([np.mean([1.0 + (sizes < x).sum(), (sizes <= x).sum()]) for x in sizes])
    sums = np.array(list(itertools.product((0.0, 1.0), repeat=len(logs)))) @ ranks
    seen = ranks[np.array(logs) > 0.0].sum()
    signed = min(1.0, 2.0 * min((sums <= seen).mean(), (sums >= seen).mean()))
    # the fifth of 18 values is below the median with a probability of 98.5 %, the sixth with 95.2 %
    bracketed = logs[4] <= math.log(found.ratio.low) <= logs[5]
    return {
        "members that count": found.count - 19.0,
        "members with a ratio": found.compared - 18.0,
        "members that are larger": found.higher - sum(x > 0.0 for x in logs),
        "median ratio": math.log(found.ratio.value) - 0.5 * (logs[8] + logs[9]),
        "lower end of its interval": 0.0 if bracketed else math.inf,
        "signed ranks": found.ratio_p - signed,
        "overturned": found.overturned - 2.0,
        "overturned in the other": found.against_overturned - 5.0,
        "overturned in both": found.both_overturned - 1.0,
        "McNemar": found.overturned_p - 2.0 * (1.0 + 5.0) / 2.0**5,
        "difference of shares": found.overturned_difference.value + 3.0 / 19.0,
    }


def _unlike(found: str, expected: str) -> float:
    return 0.0 if found == expected else math.inf
