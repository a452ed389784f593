"""What accuracy costs: error against computing time of the reduced models, other solvers and the engines."""

from .conclusions import TARGETS, costs, engine_factors, plateaus, rest_tilt_price
from .study import KIND, ROUNDS, Tradeoff, measure_tradeoff, read_tradeoff

__all__ = [
    "KIND",
    "ROUNDS",
    "TARGETS",
    "Tradeoff",
    "costs",
    "engine_factors",
    "measure_tradeoff",
    "plateaus",
    "read_tradeoff",
    "rest_tilt_price",
]
