"""Pose and velocity at time zero.

A body of revolution in a recess turns with psi = -phi, so its quaternion has no z component, and its
velocity is a pure turning about the contact point: v = omega x (S - T).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import InitialState

from .body import Body

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """Pose and velocity of the mass centre, in a frame with its origin at O.

    Attributes
    ----------
    standing : bool
        Upright at rest; otherwise the cylinder leans on its rim.
    position, velocity : ndarray, shape (3,)
        Of the mass centre [m], [m/s].
    quaternion : ndarray, shape (4,)
        Orientation, scalar first.
    angular_velocity : ndarray, shape (3,)
        In world axes [rad/s].
    """

    standing: bool
    position: Array
    quaternion: Array
    velocity: Array
    angular_velocity: Array


def starting_state(body: Body, initial: InitialState | None, time: float) -> Start:
    """Return the start of a run, with psi' = -phi' and no slip; `time` scales the rates to the scene.

    Equations (8) and (10) give the pose.
    """
    if initial is None or initial.tilt == 0.0:
        # the x axis of the cylinder along that of the world: its matrix is then exactly the unit matrix,
        # where any other heading leaves rounding that plane-cylinder contact magnifies
        upright = np.array([0.0, 0.0, body.mass_centre_height])
        return Start(True, upright, np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), np.zeros(3))
    theta, phi = initial.tilt, initial.rolling_angle
    theta_rate, phi_rate = initial.tilt_rate * time, initial.rolling_rate * time
    sine, cosine = math.sin(theta), math.cos(theta)
    versine = 2.0 * math.sin(0.5 * theta) ** 2
    outward = np.array([math.cos(phi), math.sin(phi), 0.0])
    forward = np.array([-math.sin(phi), math.cos(phi), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    axis = sine * outward + cosine * up
    base_centre = body.base_radius * (versine * outward + sine * up)
    position = base_centre + body.mass_centre_height * axis
    half = 0.5 * theta
    quaternion = np.array(
        [math.cos(half), -math.sin(half) * math.sin(phi), math.sin(half) * math.cos(phi), 0.0]
    )
    angular_velocity = phi_rate * (up - axis) + theta_rate * forward
    velocity = np.cross(angular_velocity, position - body.base_radius * outward)
    return Start(False, position, quaternion, velocity, angular_velocity)
