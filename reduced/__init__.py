"""The reduced models of a cylinder that rocks and wobbles, and their exact solutions."""

from collections.abc import Mapping
from typing import Any

from .batch import peak_tilts, peak_tilts_of_case
from .body import restitution_from_momentum
from .exact import (
    FreeResponse,
    angle_of_turn,
    free_response,
    limiting_angle_of_turn,
    planar_quarter_period,
    rocking_period,
    steady_wobble_rate,
    wobble_stability,
    wobbling_period,
)
from .problem import REST_TILT, SUPPORTS, balance_tilt_of_case
from .simulation import simulate
from .sliding import peak_displacements

# reduced models by name, and the options of `simulate` and `peak_tilts` that choose each
MODELS: Mapping[str, Mapping[str, Any]] = {
    **{support: {"support": support} for support in SUPPORTS},
    "planar": {"plane": 0.0},
}

__all__ = [
    "MODELS",
    "REST_TILT",
    "SUPPORTS",
    "FreeResponse",
    "angle_of_turn",
    "balance_tilt_of_case",
    "free_response",
    "limiting_angle_of_turn",
    "peak_displacements",
    "peak_tilts",
    "peak_tilts_of_case",
    "planar_quarter_period",
    "restitution_from_momentum",
    "rocking_period",
    "simulate",
    "steady_wobble_rate",
    "wobble_stability",
    "wobbling_period",
]


def __dir__() -> list[str]:
    return sorted(__all__)
