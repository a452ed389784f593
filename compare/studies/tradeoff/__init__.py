"""What accuracy costs: error against computing time of the reduced models, other solvers and the engines."""

from .conclusions import TARGETS, costs, engine_factors, plateaus, rest_tilt_price
from .study import ROUNDS, STAGES, Tradeoff, measure_tradeoff

__all__ = [
    "ROUNDS",
    "STAGES",
    "TARGETS",
    "Tradeoff",
    "costs",
    "engine_factors",
    "measure_tradeoff",
    "plateaus",
    "rest_tilt_price",
]
