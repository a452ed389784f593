"""Engines by name; each is imported only when it is asked for."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import cast

from .engine import Engine


class EngineNotInstalledError(ValueError):
    """A known engine whose package cannot be imported here."""


@dataclass(frozen=True, slots=True)
class _Entry:
    package: str
    factory: str  # module:callable, relative to this folder
    remedy: str


_ENGINES: Mapping[str, _Entry] = MappingProxyType(
    {
        "mujoco": _Entry("mujoco", ".mujoco_engine:MujocoEngine", "pip install 'mujoco>=4.0,<5'"),
        "pybullet": _Entry(
            "pybullet",
            ".pybullet_engine:PybulletEngine",
            "pip install pybullet, which has wheels for Python 3.11 and older on Linux x86-64 only",
        ),
    }
)


def engine_names() -> tuple[str, ...]:
    """Return the names of all known engines, installed or not."""
    return tuple(_ENGINES)


def available_engines() -> tuple[str, ...]:
    """Return the names of the engines whose packages are installed here, without importing them."""
    return tuple(name for name, entry in _ENGINES.items() if importlib.util.find_spec(entry.package))


def find_engine(name: str) -> Engine:
    """Return the engine called `name`.

    Raises
    ------
    ValueError
        If there is no such engine.
    EngineNotInstalledError
        If its package is not installed; a ValueError that says how to get it.
    """
    entry = _ENGINES.get(name)
    if entry is None:
        raise ValueError(f"engine must be one of {', '.join(_ENGINES)}, got {name!r}")
    if importlib.util.find_spec(entry.package) is None:
        raise EngineNotInstalledError(f"engine {name!r} is not installed here: {entry.remedy}")
    module, factory = entry.factory.split(":")
    return cast(Engine, getattr(importlib.import_module(module, __package__), factory)())
