"""What breaks first: every extreme by every method, each verdict with what backs it."""

from .scan import METHODS, STAGES, measure_extremes
from .store import Extremes, extremes_tables, read_extremes
from .table import EXTREMES, Condition, conditions

__all__ = [
    "EXTREMES",
    "METHODS",
    "STAGES",
    "Condition",
    "Extremes",
    "conditions",
    "extremes_tables",
    "measure_extremes",
    "read_extremes",
]
