"""Consistency checks: the reduced model against exact solutions, its baseline and the engines.

Layers of checks, tightest first; every check has a measured value, a bound, the reason for the bound,
and the part that is suspect where it fails. `rockwobble check` runs them.
"""

from .bench import Bench
from .finding import FAILED, NO_BASELINE, NOT_RUN, PASSED, Finding
from .layers import LAYERS, run_checks

__all__ = [
    "FAILED",
    "LAYERS",
    "NOT_RUN",
    "NO_BASELINE",
    "PASSED",
    "Bench",
    "Finding",
    "run_checks",
]
