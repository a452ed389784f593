"""What breaks first: every extreme by every method, each verdict with what backs it."""

from .conditions import EXTREMES, Condition, conditions
from .study import KIND, METHODS, Extremes, measure_extremes, read_extremes
from .verdict import FINE, Verdict, judge

__all__ = [
    "EXTREMES",
    "FINE",
    "KIND",
    "METHODS",
    "Condition",
    "Extremes",
    "Verdict",
    "conditions",
    "judge",
    "measure_extremes",
    "read_extremes",
]
