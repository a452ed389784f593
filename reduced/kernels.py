"""The compiled entry points: one time integration for each model, and the momentum of a release."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import numpy as np

from rockwobble.models import Cylinder

from ._compile import kernel
from .body import Body, body_of
from .integration.driver import make_driver
from .integration.progress import spin_momentum
from .integration.resisted import RESISTED_FLAT, RESISTED_RECESS, STEPPERS
from .integration.result import Driver, IntegrationResult, Options, Task
from .integration.stepping import runge_kutta, taylor_series
from .integration.systems import (
    FLAT,
    PLANAR,
    RECESS,
    flat_combine,
    flat_ratio,
    planar_combine,
    planar_ratio,
)

_driver_planar = make_driver(PLANAR, runge_kutta(PLANAR, planar_combine, planar_ratio))
_driver_recess = make_driver(RECESS, taylor_series())
_driver_flat = make_driver(FLAT, runge_kutta(FLAT, flat_combine, flat_ratio))
_driver_resisted_recess = make_driver(RESISTED_RECESS, STEPPERS["recess"])
_driver_resisted_flat = make_driver(RESISTED_FLAT, STEPPERS["flat"])


@kernel
def integrate_planar(body: Body, options: Options, task: Task) -> IntegrationResult:
    """Solve the planar model."""
    return _driver_planar(body, options, task)


@kernel
def integrate_recess(body: Body, options: Options, task: Task) -> IntegrationResult:
    """Solve the recess model."""
    return _driver_recess(body, options, task)


@kernel
def integrate_flat(body: Body, options: Options, task: Task) -> IntegrationResult:
    """Solve the flat-ground model."""
    return _driver_flat(body, options, task)


@kernel
def integrate_resisted_recess(body: Body, options: Options, task: Task) -> IntegrationResult:
    """Solve the recess model, and without spin the planar one, with rolling resistance."""
    return _driver_resisted_recess(body, options, task)


@kernel
def integrate_resisted_flat(body: Body, options: Options, task: Task) -> IntegrationResult:
    """Solve the flat-ground model with rolling resistance."""
    return _driver_resisted_flat(body, options, task)


@kernel
def momentum_of_release(body: Body, tilt: float, rolling_rate: float) -> float:
    """Momentum L = B phi' of a release [m^2/s]; an entry point: it takes longer to compile than a run."""
    return spin_momentum(body, tilt, rolling_rate)


INTEGRATORS: dict[str, Driver] = {
    "planar": integrate_planar,
    "recess": integrate_recess,
    "flat": integrate_flat,
    "resisted planar": integrate_resisted_recess,
    "resisted recess": integrate_resisted_recess,
    "resisted flat": integrate_resisted_flat,
}
# number of variables of a state: with rolling resistance the energy lost is the last (`integration.resisted`)
SIZES = {"planar": 3, "recess": 4, "flat": 8, "resisted planar": 5, "resisted recess": 5, "resisted flat": 9}


def load(model: str) -> None:
    """Load or compile the code of `model` by two trivial runs: a moment at rest, and a release."""
    body = body_of(Cylinder(semidiagonal=1.0, tan_alpha=0.2), 9.81)
    options = Options(1e-6, 0.0, 1.0, 1.0, 1, False)
    start = (0.0,) * SIZES[model]
    INTEGRATORS[model](body, options, Task(np.zeros((0, 3)), 1.0, start, np.zeros(1), np.zeros((0, 2))))
    if not model.endswith("planar"):
        momentum_of_release(body, 0.1, 0.0)  # so the first release is timed without its loading


@contextmanager
def interrupted_after() -> Iterator[None]:
    """Context manager: a Ctrl-C within an entry point that returns a named tuple is raised after it.

    What makes that tuple runs as Python code, which raises an interrupt that waits, and numba takes the tuple
    that is then missing for one: the process ends by a fault.
    """
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield
        return
    waiting: list[tuple[int, FrameType | None]] = []
    signal.signal(signal.SIGINT, lambda number, frame: waiting.append((number, frame)))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
    if waiting:
        handler(*waiting[0])
