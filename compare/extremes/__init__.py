"""What breaks first: every extreme by every method, each verdict with what backs it."""

from .scan import METHODS, STAGES, measure_extremes
from .table import EXTREMES, Condition, conditions

__all__ = [
    "EXTREMES",
    "METHODS",
    "STAGES",
    "Condition",
    "conditions",
    "measure_extremes",
]
