"""Physics engines: the cylinder as a free rigid body in contact with rigid ground.

`simulate` runs one case in one engine with one support and gives a `Trace`. Nothing here knows the reduced
models: inertia, kinematics and energy are derived from the pose of a rigid body.
"""

from .engines.registry import (
    DEFAULT_ENGINE,
    BrokenEngineError,
    EngineNotInstalledError,
    available_engines,
    engine_names,
    find_engine,
)
from .simulation import open_scene, simulate

__all__ = [
    "DEFAULT_ENGINE",
    "BrokenEngineError",
    "EngineNotInstalledError",
    "available_engines",
    "engine_names",
    "find_engine",
    "open_scene",
    "simulate",
]


def __dir__() -> list[str]:
    return sorted(__all__)
