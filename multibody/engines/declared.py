"""Members of the protocol that the engines of this package state in the same way."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from typing import Any, ClassVar, Protocol

from ..facts import EngineFacts
from ..protocol import Scene, Settings


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
