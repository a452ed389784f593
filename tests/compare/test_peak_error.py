"""Error of a peak tilt: the largest part, and its source."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from rockwobble.compare.comparison.peak_error import NO_ERROR, copies_of_input, peak_error
from rockwobble.models import Case, Cylinder, InitialState, Run, Trace

BODY = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
CASE = Case(BODY, initial=InitialState(0.5 * BODY.alpha, rolling_rate=0.5), duration=2.0)


def motion(peak: float, run: Run, *facts: Any) -> Any:
    outcome = "overturned" if peak > 1.0 else "stands"
    return SimpleNamespace(peak_tilt=peak * BODY.alpha, run=run, facts=facts, outcome=outcome)


def error(trial: Any, *, model: float = 0.0, copy: float = 0.0, coarser: float = 0.0) -> Any:
    own = motion(0.5, Run(None, "recess"))

    def simulate(case: Case, run: Run) -> Trace:
        shift: Any = motion(0.5 + coarser, run)
        assert run.settings["rtol"] == pytest.approx(1e-7)
        return shift  # type: ignore[no-any-return]

    copies = [motion(0.5 + copy, own.run), motion(0.5 - copy, own.run)]
    reference = motion(0.5 - model, Run(None, "flat"))
    return peak_error(CASE, trial, own, reference, copies=copies, simulate=simulate)


def test_the_largest_part_gives_the_error_and_its_source() -> None:
    model, engine = Run(None, "recess"), Run("mujoco", "recess")
    settled = SimpleNamespace(code="settled", size=0.3)
    for trial, parts, expected in (
        (motion(0.5, model), {"model": 0.1, "copy": 0.2, "coarser": 0.01}, (0.2, "copies")),
        (motion(0.5, model), {"model": 0.1, "copy": 0.05, "coarser": 0.3}, (0.3, "integration")),
        (motion(0.6, engine), {"model": 0.2, "copy": 0.05}, (0.2, "model form")),
        (motion(0.6, engine), {"model": 0.02, "copy": 0.05}, (0.1, "step")),
        (motion(0.6, engine, settled), {"model": 0.2}, (0.3, "step")),
        # two peaks of which one overturned have no difference
        (motion(0.5, model), {"model": -7.5, "copy": 0.2}, (math.inf, "model form")),
        (motion(0.5, model), {"copy": 7.5}, (math.inf, "copies")),
        (motion(8.0, engine), {}, (math.inf, "step")),
    ):
        estimate = error(trial, **parts)
        assert estimate.source == expected[1]
        assert estimate.size == pytest.approx(expected[0])


def test_a_run_without_a_peak_has_no_error() -> None:
    assert error(motion(math.nan, Run("mujoco", "recess"))) is NO_ERROR


def test_copies_are_one_per_cent_stronger_and_weaker() -> None:
    tilts = [copy.initial.tilt / CASE.initial.tilt for copy in copies_of_input(CASE) if copy.initial]  # type: ignore[union-attr]
    assert tilts == pytest.approx([1.01, 0.99])
