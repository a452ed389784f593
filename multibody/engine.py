"""What an engine must do: one small protocol, known to everything else in this folder.

An engine runs one rigid body on rigid ground at the reference size. It opens a scene, and then advances
it by a number of steps at a time under given ground accelerations. How it steps (a rollout in C, a loop
in Python) is its own affair; so are its settings, which it resolves from the time step.

Both engines here are semi-implicit: the new velocity moves the pose. Read as leapfrog, the pose n
stands at n h and the velocity that led to it at (n - 1/2) h, which makes them second order where the
naive reading is first order. A stepper therefore starts half a step back in velocity, and `Steps`
holds the velocities between the poses.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .body import Body
from .start import Start

Array = NDArray[np.float64]

Settings = Mapping[str, Any]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Scene:
    """One run, stated for every engine, at the reference size and gravity.

    Attributes
    ----------
    body : Body
    start : Start
    support : str
        What holds the cylinder in its place.
    friction : float
        Coefficient of the pair cylinder and ground [-].
    time_step : float
        h [s].
    gravity : float
        [m/s^2].
    components : str
        Components of the ground acceleration that are not absent, such as "xy" or "".
    unit_time : float
        User seconds in one second of the scene: settings that are times are in user seconds.
    """

    body: Body
    start: Start
    support: str
    friction: float
    time_step: float
    gravity: float
    components: str
    unit_time: float


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """Poses after each of n steps, and the velocities that led to them.

    Attributes
    ----------
    position : ndarray, shape (n, 3)
        Of the mass centre [m].
    quaternion : ndarray, shape (n, 4)
        Scalar first.
    velocity, angular_velocity : ndarray, shape (n, 3)
        During the step that ends at the pose, world axes [m/s], [rad/s].
    """

    position: Array
    quaternion: Array
    velocity: Array
    angular_velocity: Array


class Stepper(Protocol):
    """An open scene."""

    @property
    def hold_centre(self) -> float:
        """Centre of the time over which the force of step n is held, from pose n, in steps: 0 in leapfrog."""
        ...

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`, shape (n, 3), of the ground [m/s^2]."""
        ...

    def warnings(self) -> str:
        """Return what the engine has warned of so far, empty if nothing."""
        ...


class Engine(Protocol):
    """A physics engine."""

    @property
    def supports(self) -> tuple[str, ...]:
        """Names of the supports that it has."""
        ...

    def version(self) -> str:
        """Return the version of the package, for the record: results differ between versions."""
        ...

    def settings(self, given: Settings, scene: Scene) -> dict[str, Any]:
        """Return every setting, from those `given` (in the units of the user) and the time step.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        ...

    def open(self, scene: Scene, settings: Settings) -> AbstractContextManager[Stepper]:
        """Return a context that opens the scene at its start and closes it whatever happens."""
        ...
