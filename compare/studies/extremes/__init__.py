"""What breaks first: every extreme by every method, each verdict with what backs it."""

from .scan import STAGES, measure_extremes, methods
from .store import Extremes, extremes_tables, read_extremes
from .table import EXTREMES, Condition, conditions

__all__ = [
    "EXTREMES",
    "STAGES",
    "Condition",
    "Extremes",
    "conditions",
    "extremes_tables",
    "measure_extremes",
    "methods",
    "read_extremes",
]
