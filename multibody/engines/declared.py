"""Common parts of the engines of this package: members of the protocol, steps of leapfrog."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from rockwobble.models.mode import SLIDES
from rockwobble.models.support import FLAT, RECESS

from ..kinematics import about_vertical, turning
from ..protocol import EngineFacts, SceneCounts, Settings, Stepper, Steps
from ..scene import Array, Scene
from ..settings import EngineSettings


class Declared:
    """An engine by its declarations.

    Attributes
    ----------
    package : str
        That is installed, whose version counts.
    settings_type : type
        Of its settings, which says what each is for.
    stepper_type : type
        Of its open scene, made from a scene and settings.
    facts : EngineFacts
        Measured by halving the step.
    supports : tuple of str
    uplifts : bool
        Whether the base is in contact as well as the rim.
    sliding : mapping
        Defaults of settings where the case slides.
    """

    package: ClassVar[str]
    settings_type: ClassVar[type[EngineSettings]]
    stepper_type: ClassVar[type[Any]]
    facts: EngineFacts
    supports: tuple[str, ...] = (RECESS, FLAT)
    uplifts: bool = True
    sliding: ClassVar[Settings] = MappingProxyType({})

    def version(self) -> str:
        """Version of the package."""
        return _version(self.package)

    def settings(self, given: Settings, scene: Scene) -> Mapping[str, object]:
        """Return every setting; see the type of the settings."""
        chosen = {**self.sliding, **given} if scene.mode == SLIDES else given
        return asdict(self.settings_type.resolve(chosen, scene.time_step * scene.unit_time))

    @contextlib.contextmanager
    def open(self, scene: Scene, settings: Settings) -> Iterator[Stepper]:
        """Open the scene at its start; Python frees it when nothing refers to it any more."""
        yield self.stepper_type(scene, self.settings_type(**settings))


_version = cache(version)  # reading it takes as long as a hundred steps


class Leapfrog:
    """Scene stepped by leapfrog, whose velocities follow from its poses.

    Parameters
    ----------
    scene : Scene
    guide_stiffness : float
        In the time of the user [1/s^2].
    depth : float
        Depth at which the rim is kept, taken off the poses [m].
    """

    hold_centre = 0.0

    def __init__(self, scene: Scene, guide_stiffness: float, depth: float = 0.0) -> None:
        self._scene, self._step, self._depth = scene, scene.time_step, depth
        # torque per twist of both halves of the guide
        stiffness = guide_stiffness * scene.unit_time**2 * scene.body.axial_inertia
        self._stiffness = stiffness if scene.support.guided else 0.0
        self._heading = 0.0  # azimuth of the x axis of the scene in the world [rad]
        self._position, self._quaternion = scene.start.position, scene.start.quaternion

    def warnings(self) -> str:
        """No warning: the engine does not warn."""
        return ""

    def _steps_to(
        self, position: Array, quaternion: Array, heading: Array | float = 0.0, *, unsolved: bool = False
    ) -> Steps:
        """Return the steps to poses (n, 3), (n, 4) in the scene, whose x axis is at azimuths (n,) [rad]."""
        position = about_vertical(position, heading)
        quaternion[:, 1:] = about_vertical(quaternion[:, 1:], heading)
        position[:, 2] += self._depth
        velocity = np.diff(np.vstack([self._position, position]), axis=0) / self._step
        spin = turning(self._quaternion, quaternion) / self._step
        self._position, self._quaternion = position[-1], quaternion[-1]
        return Steps(position, quaternion, velocity, spin, unsolved=unsolved)


def contact_counts(contacts: int) -> SceneCounts:
    """Constraint counts of a step of one body: a normal and two directions of friction for each contact."""
    return SceneCounts(degrees_of_freedom=6, contacts=contacts, constraint_rows=3 * contacts)
