"""What breaks first: every extreme by every method, each verdict with what backs it."""

from .conditions import EXTREMES, Condition
from .study import KIND, Extremes, measure_extremes, methods, read_extremes
from .verdict import FINE, Verdict, judge

__all__ = [
    "EXTREMES",
    "FINE",
    "KIND",
    "Condition",
    "Extremes",
    "Verdict",
    "judge",
    "measure_extremes",
    "methods",
    "read_extremes",
]
