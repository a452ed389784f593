"""From a case to the scene that every engine gets."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from typing import Any

from rockwobble.models import Case

from .body import scaled_body
from .engines.registry import engine_for
from .protocol import Engine, Scene
from .scene.froude import REFERENCE_GRAVITY, Scale, default_step, froude_scale
from .start import starting_state


def make_scene(case: Case, support: str, step: float, scale: Scale) -> Scene:
    """Return the scene of a case, in the units of the reference size; `step` is the user's [s]."""
    body = scaled_body(case.cylinder, scale.length)
    motion = case.motion
    return Scene(
        body=body,
        start=starting_state(body, case.initial, scale.time),
        support=support,
        friction=case.friction,
        time_step=step / scale.time,
        gravity=REFERENCE_GRAVITY,
        components="" if motion is None else "xyz" if motion.has_vertical else "xy",
        unit_time=scale.time,
        rolling_resistance=case.rolling_resistance / scale.length,
    )


def resolved_settings(
    case: Case, engine: str, support: str, settings: Mapping[str, Any], time_step: float | None = None
) -> dict[str, Any]:
    """Return every setting with which `simulate` would run a case, without running it.

    Raises
    ------
    ValueError
        If the engine is unknown, cannot run the case, or a setting is unknown or out of range.
    """
    backend, scene = _stated(case, engine, support, time_step)
    return backend.settings(settings, scene)


@contextlib.contextmanager
def open_scene(case: Case, engine: str, support: str, settings: Mapping[str, Any]) -> Iterator[Any]:
    """Open the scene of a case as `simulate` does at its default step, for who wants to step it alone.

    Yields
    ------
    Stepper
        With whatever members its engine adds.

    Raises
    ------
    ValueError
        As `simulate` does.
    """
    backend, scene = _stated(case, engine, support)
    with backend.open(scene, backend.settings(settings, scene)) as stepper:
        yield stepper


def _stated(case: Case, engine: str, support: str, time_step: float | None = None) -> tuple[Engine, Scene]:
    backend = engine_for(case, engine, support)
    size = case.cylinder.semidiagonal, case.gravity
    step = default_step(*size) if time_step is None else time_step
    return backend, make_scene(case, support, step, froude_scale(*size))
