"""Checks of a subject: a reduced model, an engine, another model, or files of trajectories.

One list of physical checks, in groups, tightest first; every check has a measured value, a bound, and the
reason of the bound. `rockwobble check` runs them, and `rockwobble.check` in Python.
"""

from .groups import GROUPS, Checks, check, run_checks
from .measurement import FAILED, NO_BASELINE, NOT_RUN, PASSED, Result
from .subject import Subject, engine, external_model, reduced_model, trajectories

__all__ = [
    "FAILED",
    "GROUPS",
    "NOT_RUN",
    "NO_BASELINE",
    "PASSED",
    "Checks",
    "Result",
    "Subject",
    "check",
    "engine",
    "external_model",
    "reduced_model",
    "run_checks",
    "trajectories",
]
