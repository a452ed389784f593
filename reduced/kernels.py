"""The compiled entry points: one march for each model of the ladder."""

from __future__ import annotations

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Cylinder

from ._compile import jit, kernel
from .body import Body, body_of
from .driver import March, Options, make_driver
from .equations import planar_rhs, recess_rhs, rolling_rhs


@jit
def _planar(
    body: Body, y: NDArray[np.float64], ax: float, ay: float, az: float, out: NDArray[np.float64]
) -> None:
    """Write the derivative of (theta, theta', phi); the plane is x z, so phi is 0 or pi."""
    out[0] = y[1]
    out[1] = planar_rhs(body, y[0], cos(y[2]), ax, az)
    out[2] = 0.0


@jit
def _recess(
    body: Body, y: NDArray[np.float64], ax: float, ay: float, az: float, out: NDArray[np.float64]
) -> None:
    """Write the derivative of (theta, theta', phi, L)."""
    out[0], out[1], out[2], out[3] = recess_rhs(body, y[0], y[1], y[2], y[3], ax, ay, az)


@jit
def _rolling(
    body: Body, y: NDArray[np.float64], ax: float, ay: float, az: float, out: NDArray[np.float64]
) -> None:
    """Write the derivative of (theta, theta', phi, Lambda, tau, S, X, Y).

    (X, Y) is the centre of the circle that the rim rolls on: the contact point is that plus
    b (cos phi, sin phi), and moves at the speed b psi'.
    """
    out[0], out[1], out[2], out[3], out[4], out[5] = rolling_rhs(
        body, y[0], y[1], y[2], y[3], y[4], y[5], ax, ay, az
    )
    out[6] = body.b * out[4] * sin(y[2])
    out[7] = -body.b * out[4] * cos(y[2])


_march_planar = make_driver(_planar, 3)
_march_recess = make_driver(_recess, 4)
_march_rolling = make_driver(_rolling, 8)


@kernel
def march_planar(
    body: Body,
    options: Options,
    record: NDArray[np.float64],
    scale: float,
    time_step: float,
    initial: NDArray[np.float64],
    times: NDArray[np.float64],
    later: NDArray[np.float64],
) -> March:
    """Solve the planar model; see `driver.make_driver`."""
    return _march_planar(body, options, record, scale, time_step, initial, times, later)


@kernel
def march_recess(
    body: Body,
    options: Options,
    record: NDArray[np.float64],
    scale: float,
    time_step: float,
    initial: NDArray[np.float64],
    times: NDArray[np.float64],
    later: NDArray[np.float64],
) -> March:
    """Solve the recess model; see `driver.make_driver`."""
    return _march_recess(body, options, record, scale, time_step, initial, times, later)


@kernel
def march_rolling(
    body: Body,
    options: Options,
    record: NDArray[np.float64],
    scale: float,
    time_step: float,
    initial: NDArray[np.float64],
    times: NDArray[np.float64],
    later: NDArray[np.float64],
) -> March:
    """Solve the rolling model; see `driver.make_driver`."""
    return _march_rolling(body, options, record, scale, time_step, initial, times, later)


def compile_march(model: str) -> None:
    """Compile the march of `model`, by running it on a cylinder at rest for a moment."""
    march = {"planar": (march_planar, 3), "recess": (march_recess, 4), "rolling": (march_rolling, 8)}
    entry, size = march[model]
    body = body_of(Cylinder(semidiagonal=1.0, tan_alpha=0.2), 9.81)
    options = Options(1e-6, 0.0, 1.0, 1.0, 1, False)
    entry(body, options, np.zeros((0, 3)), 1.0, 1.0, np.zeros(size), np.zeros(1), np.zeros((0, 2)))
