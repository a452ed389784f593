"""Common parts of the engines of this package: settings with their bounds, guide, steps of leapfrog."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, fields
from functools import cache
from importlib.metadata import version
from typing import Annotated, ClassVar, Self, get_type_hints

import numpy as np

from rockwobble.models.number_checks import quoted
from rockwobble.models.support import SUPPORTS

from ..kinematics import about_vertical, turning
from ..protocol import Array, EngineFacts, SceneCounts, Settings, Steps
from ..scene import Scene

GUIDE = 0.2  # 2 h sqrt(stiffness of the guide): see `MujocoSettings.guide_stiffness`

Check = Callable[[str, object], None]
"""Refuses a value out of range, by its name."""


def positive(*, most: float = math.inf, or_zero: bool = False) -> Check:
    """Return the check of a positive number of at most `most`; `or_zero` allows 0, too."""

    def check(name: str, value: object) -> None:
        number = value if isinstance(value, int | float) and not isinstance(value, bool) else math.nan
        if not (math.isfinite(number) and number <= most and (number > 0.0 or (or_zero and number == 0.0))):
            wanted = "at least 0" if or_zero else "above 0"
            if most < math.inf:
                wanted = f"from 0 to {most:g}" if or_zero else f"above 0 and at most {most:g}"
            raise ValueError(f"{name} must be {wanted}, got {quoted(value)}")

    return check


def one_of(*allowed: object) -> Check:
    """Return the check of a value that is one of those allowed."""

    def check(name: str, value: object) -> None:
        if value not in allowed:
            raise ValueError(f"{name} must be one of {', '.join(map(str, allowed))}, got {quoted(value)}")

    return check


def whole(*, least: int = 1, most: int | None = None) -> Check:
    """Return the check of a whole number."""
    wanted = "a positive whole number" if most is None else f"a whole number from {least} to {most}"

    def check(name: str, value: object) -> None:
        if type(value) is not int or value < least or (most is not None and value > most):
            raise ValueError(f"{name} must be {wanted}, got {quoted(value)}")

    return check


Positive = Annotated[float, positive()]
NotNegative = Annotated[float, positive(or_zero=True)]
Share = Annotated[float, positive(most=1.0)]
Small = Annotated[float, positive(most=1e-3)]
Count = Annotated[int, whole()]


@dataclass(frozen=True, slots=True, kw_only=True)
class EngineSettings:
    """Settings of an engine: a dataclass whose fields are annotated with their checks."""

    def __post_init__(self) -> None:
        for name, check in _checks(type(self)).items():  # type: ignore[arg-type]  # a class is hashable
            check(name, getattr(self, name))

    @staticmethod
    def defaults(time_step: float) -> dict[str, float]:
        """Return the defaults that depend on the time step [s]."""
        return {"guide_stiffness": (GUIDE / time_step) ** 2 / 4.0}

    @classmethod
    def resolve(cls, given: Mapping[str, object], time_step: float) -> Self:
        """Return the settings for a time step [s], with those `given` in place of the defaults.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        names = [field.name for field in fields(cls)]
        for name in given:
            if name not in names:
                engine = cls.__name__.removesuffix("Settings").lower()
                raise ValueError(f"{name!r} is not a setting of {engine}; allowed are {', '.join(names)}")
        return cls(**{**cls.defaults(time_step), **given})


@cache
def _checks(kind: type) -> dict[str, Check]:
    hints = get_type_hints(kind, include_extras=True)
    return {name: hint.__metadata__[0] for name, hint in hints.items()}


class Declared:
    """An engine by its declarations.

    Attributes
    ----------
    package : str
        That is installed, whose version counts.
    settings_type : type
        Of its settings, which says what each is for.
    facts : EngineFacts
        Measured by halving the step.
    supports : tuple of str
    uplifts : bool
        Whether the base is in contact as well as the rim.
    """

    package: ClassVar[str]
    settings_type: ClassVar[type[EngineSettings]]
    facts: EngineFacts
    supports: tuple[str, ...] = ("recess", "flat")
    uplifts: bool = True

    def version(self) -> str:
        """Version of the package."""
        return _version(self.package)

    def settings(self, given: Settings, scene: Scene) -> Mapping[str, object]:
        """Return every setting; see the type of the settings."""
        return asdict(self.settings_type.resolve(given, scene.time_step * scene.unit_time))


@cache  # to read it takes as long as a hundred steps
def _version(package: str) -> str:
    return version(package)


class Leapfrog:
    """Scene whose new velocity moves the pose, so that the poses give the velocities.

    Parameters
    ----------
    scene : Scene
    guide_stiffness : float
        In the time of the user [1/s^2].
    depth : float
        At which the rim is kept, taken off the poses [m].
    """

    hold_centre = 0.0

    def __init__(self, scene: Scene, guide_stiffness: float, depth: float = 0.0) -> None:
        self._scene, self._step, self._depth = scene, scene.time_step, depth
        # of both halves of the guide, torque for each twist
        stiffness = guide_stiffness * scene.unit_time**2 * scene.body.axial_inertia
        self._stiffness = stiffness if SUPPORTS[scene.support].guided else 0.0
        self._heading = 0.0  # azimuth of the x axis of the scene in the world [rad]
        self._position, self._quaternion = scene.start.position, scene.start.quaternion

    def warnings(self) -> str:
        """Return none: the engine does not warn."""
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
    """Return the counts of a step of one body: a normal and two directions of friction for each contact."""
    return SceneCounts(degrees_of_freedom=6, contacts=contacts, constraint_rows=3 * contacts)


CONVENTIONS = ("pair", "product")


def body_friction(pair: float, convention: str) -> float:
    """Return the coefficient of cylinder and ground alike whose pair has the coefficient `pair` [-].

    Parameters
    ----------
    pair : float
        Coulomb coefficient between cylinder and ground.
    convention : {"pair", "product"}
        How the engine combines two equal bodies: to what both have, or not at all, because it takes that
        of the pair (MuJoCo's explicit pairs); by the product (Bullet). A rim that slides in Bullet feels
        2 to 5 % less friction than that; one that holds is not concerned.

    Raises
    ------
    ValueError
        If the convention is unknown.
    """
    if convention == "pair":
        return pair
    if convention == "product":
        return math.sqrt(pair)  # neither body is the rough one; Bullet bounds the product at 10
    raise ValueError(f"convention must be one of {', '.join(CONVENTIONS)}, got {convention!r}")
