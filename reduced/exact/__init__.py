"""Exact solutions of the reduced models, independent of any integrator."""

from .free_motion import FreeResponse, angle_of_turn, free_response, limiting_angle_of_turn
from .periods import (
    planar_quarter_period,
    rocking_period,
    steady_wobble_rate,
    wobble_stability,
    wobbling_period,
)

__all__ = [
    "FreeResponse",
    "angle_of_turn",
    "free_response",
    "limiting_angle_of_turn",
    "planar_quarter_period",
    "rocking_period",
    "steady_wobble_rate",
    "wobble_stability",
    "wobbling_period",
]
