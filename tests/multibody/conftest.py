"""References for engines: the reduced models, solved to a far smaller error than that of an engine.

Their equations have tests of their own, against vectors and in forty digits (tests/reduced).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace
from rockwobble.multibody import available_engines, simulate
from rockwobble.multibody.engines.registry import find_engine

_CLOSELY = {"rtol": 1e-11, "rest_tilt": 0.0}


def solve(case: Case, *, rolls_out: bool = False, sample_step: float = 0.01) -> Trace:
    """The motion of a case in the recess or on flat ground."""
    support = "flat" if rolls_out else "recess"
    return reduced.simulate(case, support=support, sample_step=sample_step, **_CLOSELY)


def free_response(
    cylinder: Cylinder, initial: InitialState, time: NDArray[np.float64], *, rolls_out: bool = False
) -> Trace:
    """The response to a release at evenly spaced times."""
    case = Case(cylinder, initial=initial, duration=float(time[-1]))
    return solve(case, rolls_out=rolls_out, sample_step=float(time[1] - time[0]))


def forced_response(
    cylinder: Cylinder, motion: GroundMotion, end: float, *, rolls_out: bool = False
) -> Trace:
    """The response from rest at the samples of the motion until `end`."""
    case = Case(cylinder, motion, duration=end)
    return solve(case, rolls_out=rolls_out, sample_step=motion.time_step)


def _is_exact(name: str) -> bool:
    """Whether an engine runs every case in double precision; single precision has its own tests."""
    engine = find_engine(name)
    return engine.uplifts and engine.facts.rounding < 1e-12


@pytest.fixture(params=filter(_is_exact, available_engines()))
def engine(request: pytest.FixtureRequest) -> str:
    """Every engine that is installed here and serves any case."""
    return str(request.param)


@pytest.fixture
def time_step(engine: str) -> float | None:
    """Time step at the reference size that an engine's bounds need [s]; None is the default.

    A step of Drake costs ten times another's, and it keeps every bound at larger ones.
    """
    return 2.5e-4 if engine == "drake" else None


@pytest.fixture
def solve_free() -> Callable[..., Trace]:
    return free_response


@pytest.fixture
def run_release(solve_free: Callable[..., Trace]) -> Callable[..., tuple[Trace, Trace]]:
    """Release at half of alpha in an engine, with its progress, and the solution of its model."""

    def run(
        engine: str, support: str, tan_alpha: float, *, duration: float, **options: Any
    ) -> tuple[Trace, Trace]:
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        release = InitialState(cylinder.alpha / 2, rolling_rate=0.5)
        progress: list[float] = []
        case = Case(cylinder, initial=release, duration=duration)
        trace = simulate(case, engine=engine, support=support, progress=progress.append, **options)
        assert progress == sorted(progress)
        assert progress[-1] == 1.0
        return trace, solve_free(cylinder, release, trace.time, rolls_out=support == "flat")

    return run


@pytest.fixture(scope="session")
def solve_forced() -> Callable[..., Trace]:
    return forced_response


@pytest.fixture
def pier() -> Cylinder:
    """The example of the paper."""
    return Cylinder(semidiagonal=6.0, tan_alpha=0.2)
