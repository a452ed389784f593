"""The compiled entry points: one time integration for each model, and the momentum of a release."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder

from ._compile import kernel
from .body import Body, body_of
from .integration.driver import make_driver
from .integration.march import March, Options
from .integration.progress import spin_momentum
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
from .integration.tsit5 import State

_march_planar = make_driver(PLANAR, runge_kutta(PLANAR, planar_combine, planar_ratio))
_march_recess = make_driver(RECESS, taylor_series())
_march_flat = make_driver(FLAT, runge_kutta(FLAT, flat_combine, flat_ratio))


@kernel
def march_planar(
    body: Body,
    options: Options,
    record: NDArray[np.float64],
    time_step: float,
    initial: State,
    times: NDArray[np.float64],
    later: NDArray[np.float64],
) -> March:
    """Solve the planar model; see `driver.make_driver`."""
    return _march_planar(body, options, record, time_step, initial, times, later)


@kernel
def march_recess(
    body: Body,
    options: Options,
    record: NDArray[np.float64],
    time_step: float,
    initial: State,
    times: NDArray[np.float64],
    later: NDArray[np.float64],
) -> March:
    """Solve the recess model; see `driver.make_driver`."""
    return _march_recess(body, options, record, time_step, initial, times, later)


@kernel
def march_flat(
    body: Body,
    options: Options,
    record: NDArray[np.float64],
    time_step: float,
    initial: State,
    times: NDArray[np.float64],
    later: NDArray[np.float64],
) -> March:
    """Solve the flat-ground model; see `driver.make_driver`."""
    return _march_flat(body, options, record, time_step, initial, times, later)


@kernel
def momentum_of_release(body: Body, tilt: float, rolling_rate: float) -> float:
    """Return L = B phi' [m^2/s]; an entry point of its own, since to compile it takes longer than a run."""
    return spin_momentum(body, tilt, rolling_rate)


MARCHES = {"planar": march_planar, "recess": march_recess, "flat": march_flat}
SIZES = {"planar": 3, "recess": 4, "flat": 8}  # variables of a state


def load(model: str) -> None:
    """Load or compile the march of `model`, by running it on a cylinder at rest for a moment."""
    body = body_of(Cylinder(semidiagonal=1.0, tan_alpha=0.2), 9.81)
    options = Options(1e-6, 0.0, 1.0, 1.0, 1, False)
    start = (0.0,) * SIZES[model]
    MARCHES[model](body, options, np.zeros((0, 3)), 1.0, start, np.zeros(1), np.zeros((0, 2)))
