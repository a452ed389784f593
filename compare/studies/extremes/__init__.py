"""What breaks first: every extreme by every method, each verdict with what backs it."""

from .conditions import EXTREMES, Condition, conditions
from .scan import METHODS, STAGES, measure_extremes
from .store import Extremes, extremes_tables, read_extremes
from .verdict import FINE, Verdict, judge

__all__ = [
    "EXTREMES",
    "FINE",
    "METHODS",
    "STAGES",
    "Condition",
    "Extremes",
    "Verdict",
    "conditions",
    "extremes_tables",
    "judge",
    "measure_extremes",
    "read_extremes",
]
