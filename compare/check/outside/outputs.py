"""Call of an external model, and its output.

A model is any callable `model(case, support)` that takes a `rockwobble.Case` and "recess" or "flat", and
returns a mapping, a table or an object with

========== ===== ==================================================================
name       unit  meaning
========== ===== ==================================================================
time       s     (n,), rising
tilt       rad   (n,), angle of the axis from the vertical
azimuth    rad   (n,), optional: direction of the lean, also as rolling_angle
energy     m2/s2 (n,), optional: relative to the ground, per unit mass, 0 standing
========== ===== ==================================================================

What it does not give is not checked, and the checks say so.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case

from ...external.motion import Motion, motion_at

Array = NDArray[np.float64]
Model = Callable[[Case, str], object]


def load_model(name: str) -> Model:
    """Return the callable that "module:function" names; modules of the working folder are found.

    Raises
    ------
    ValueError
        If there is none.
    """
    module, _, function = name.partition(":")
    if not (module and function):
        raise ValueError(f"a model must be given as module:function, got {name!r}")
    if str(Path.cwd()) not in sys.path:
        sys.path.insert(0, str(Path.cwd()))
    try:
        found = getattr(importlib.import_module(module), function)
    except (ImportError, AttributeError) as error:
        raise ValueError(f"the model {name} cannot be imported: {error}") from error
    if not callable(found):
        raise ValueError(f"the model {name} must be callable, got {type(found).__name__}")  # noqa: TRY004 bad input
    model: Model = found
    return model


def outputs_of(result: object) -> tuple[Motion, Array | None]:
    """Return the motion that a model gave, and its energy if it is told.

    Raises
    ------
    ValueError
        If time or tilt is missing, or an array has another length or no finite numbers.
    """
    columns = {}
    for name, others in (("time", ()), ("tilt", ()), ("azimuth", ("rolling_angle",)), ("energy", ())):
        value = next((found for key in (name, *others) if (found := _taken(result, key)) is not None), None)
        if value is not None:
            columns[name] = np.asarray(value, dtype=np.float64)
    for name in ("time", "tilt"):
        if name not in columns:
            raise ValueError(f"the model must return {name}, got {type(result).__name__} without it")
        if columns[name].ndim != 1 or not np.isfinite(columns[name]).all():
            raise ValueError(f"{name} must be finite numbers in one dimension, got {columns[name]!r:.60}")
    if not (len(columns["time"]) > 1 and (np.diff(columns["time"]) > 0.0).all()):
        raise ValueError("time must rise")
    for name, column in columns.items():
        if len(column) != len(columns["time"]):
            raise ValueError(f"{name} must be as long as time, {len(columns['time'])}, got {len(column)}")
    # what is nowhere known is not told
    told = {name: column for name, column in columns.items() if np.isfinite(column).any()}
    return motion_at(told["time"], told["tilt"], told.get("azimuth")), told.get("energy")


def _taken(result: object, key: str) -> object:
    if isinstance(result, Mapping):
        return result.get(key)
    return getattr(result, key, None)
