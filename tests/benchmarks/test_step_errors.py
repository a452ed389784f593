"""The trial of stated errors: its problems, its rows and its shares."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from benchmarks import step_errors
from rockwobble import multibody, reduced
from rockwobble.models import Diagnostic


def test_problems_are_half_released_half_shaken_and_always_the_same() -> None:
    first, again = (list(step_errors.problems(20, seed=3)) for _ in range(2))
    assert [case.name for case, _ in first] == [case.name for case, _ in again]
    assert [case.initial is None for case, _ in first] == [False, True] * 10
    assert [case.cylinder for case, _ in first] != [case.cylinder for case, _ in step_errors.problems(20, 4)]


def test_an_error_is_compared_up_to_where_it_is_stated() -> None:
    case, support = next(step_errors.problems(1, seed=3))
    case = dataclasses.replace(case, duration=0.5)
    exact = reduced.simulate(case, support=support)
    trace = multibody.simulate(case, support=support)
    alpha = case.cylinder.alpha
    off = np.where(exact.time > 0.3, 0.01 * alpha, 1e-3 * alpha)
    trace = dataclasses.replace(trace, tilt=exact.tilt + off, settled_until=0.3, facts=())
    for stated, too_small in ((0.6e-3, False), (0.4e-3, True)):
        row = step_errors.compared(dataclasses.replace(trace, error_estimate=stated * alpha), exact)
        assert (row["error"], row["too_small"]) == (pytest.approx(1e-3, rel=1e-6), too_small)
    assert not row["said"]


def test_what_states_no_error_says_why(capsys: pytest.CaptureFixture[str], monkeypatch) -> None:
    case, support = next(step_errors.problems(1, seed=3))
    case = dataclasses.replace(case, duration=0.1)
    monkeypatch.setattr(step_errors, "problems", lambda *_: [(case, support)])
    run = multibody.simulate(case, support=support)
    fact = Diagnostic(code="unsettled", detail="energy")
    monkeypatch.setattr(
        multibody, "simulate", lambda *_, **__: dataclasses.replace(run, facts=(fact,), settled_until=0.1)
    )
    assert step_errors.main(["--count", "1"]) == 0
    shown = capsys.readouterr().out
    assert "auto: 0 of 1 state an error, 0 of them" in shown
    assert "energy" in shown
