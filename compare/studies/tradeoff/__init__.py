"""What accuracy costs: error against computing time of the reduced models, other solvers and the engines."""

from .conclusions import Fastest, Plateau, fastest, plateaus, rest_tilt_price
from .measure import STAGES, Tradeoff, measure_tradeoff
from .methods import Method, methods_for
from .problem import Problem, problems
from .store import read_tradeoff, tradeoff_tables

__all__ = [
    "STAGES",
    "Fastest",
    "Method",
    "Plateau",
    "Problem",
    "Tradeoff",
    "fastest",
    "measure_tradeoff",
    "methods_for",
    "plateaus",
    "problems",
    "read_tradeoff",
    "rest_tilt_price",
    "tradeoff_tables",
]
