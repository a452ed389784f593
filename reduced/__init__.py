"""The reduced models of a cylinder that rocks and wobbles, and their exact solutions."""

from .batch import peak_tilts
from .exact import (
    FreeResponse,
    angle_of_turn,
    free_response,
    limiting_angle_of_turn,
    planar_quarter_period,
    rocking_period,
    steady_wobble_rate,
    wobbling_period,
)
from .problem import MODELS, REST_TILT, restitution_from_momentum
from .response import Response
from .simulation import simulate

__all__ = [
    "MODELS",
    "REST_TILT",
    "FreeResponse",
    "Response",
    "angle_of_turn",
    "free_response",
    "limiting_angle_of_turn",
    "peak_tilts",
    "planar_quarter_period",
    "restitution_from_momentum",
    "rocking_period",
    "simulate",
    "steady_wobble_rate",
    "wobbling_period",
]
