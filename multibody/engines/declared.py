"""Common parts of the engines of this package: settings with their bounds, friction of a pair, facts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from importlib.metadata import version
from typing import Any, ClassVar, Protocol, TypeVar

from rockwobble.models.number_checks import quoted

from ..protocol import EngineFacts, Settings
from ..scene import Scene

S = TypeVar("S")

GUIDE = 0.2  # 2 h sqrt(stiffness of the guide): see `MujocoSettings.guide_stiffness`


class _SettingsType(Protocol):
    """A dataclass of settings."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @classmethod
    def resolve(cls, given: Mapping[str, Any], time_step: float) -> object:
        """Return the settings for a time step [s], with those given in place of the defaults."""
        ...


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
    settings_type: ClassVar[type[_SettingsType]]
    facts: EngineFacts
    supports: tuple[str, ...] = ("recess", "flat")
    uplifts: bool = True

    def version(self) -> str:
        """Version of the package."""
        return _version(self.package)

    def settings(self, given: Settings, scene: Scene) -> dict[str, Any]:
        """Return every setting; see the type of the settings."""
        resolved = self.settings_type.resolve(given, scene.time_step * scene.unit_time)
        return {name: getattr(resolved, name) for name in self.settings_type.__dataclass_fields__}


@cache  # to read it takes as long as a hundred steps
def _version(package: str) -> str:
    return version(package)


def build(kind: type[S], engine: str, given: Mapping[str, Any], defaults: Mapping[str, Any]) -> S:
    """Return the settings of an engine: those given in place of the defaults."""
    names = [field.name for field in fields(kind)]  # type: ignore[arg-type]
    for name in given:
        if name not in names:
            raise ValueError(f"{name!r} is not a setting of {engine}; allowed are {', '.join(names)}")
    return kind(**{**defaults, **given})


def positive(settings: object, name: str, *, most: float = math.inf, or_zero: bool = False) -> None:
    """Refuse a setting that is no positive number of at most `most`; `or_zero` allows 0, too."""
    value = getattr(settings, name)
    number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if not (number and value <= most and (value > 0.0 or (or_zero and value == 0.0))):
        limit = "" if most == math.inf else f" and at most {most:g}"
        raise ValueError(f"{name} must be {'at least' if or_zero else 'above'} 0{limit}, got {quoted(value)}")


def whole(settings: object, name: str) -> None:
    """Refuse a setting that is no positive whole number."""
    value = getattr(settings, name)
    if type(value) is not int or value < 1:
        raise ValueError(f"{name} must be a positive whole number, got {quoted(value)}")


def one_of(settings: object, name: str, allowed: tuple[Any, ...]) -> None:
    """Refuse a setting that is none of the values allowed."""
    value = getattr(settings, name)
    if value not in allowed:
        raise ValueError(f"{name} must be one of {', '.join(map(str, allowed))}, got {quoted(value)}")


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
