"""Reduced models and engines on the same problem: differences, and how long they agree."""

from .comparison import Comparison, describe_case, describe_run
from .contact import TILTED
from .driver import compare
from .execution import Crash, Job, Progress, simulate_all
from .horizon import AGREEMENT
from .runs import default_runs, installed_engines, missing_engines, require_runnable, reserved_engines
from .store import replace_files, require_writable
from .summary import SUMMARY_COLUMNS
from .tilt import relative_rms
from .traces import Pair, make_pair

__all__ = [
    "AGREEMENT",
    "SUMMARY_COLUMNS",
    "TILTED",
    "Comparison",
    "Crash",
    "Job",
    "Pair",
    "Progress",
    "compare",
    "default_runs",
    "describe_case",
    "describe_run",
    "installed_engines",
    "make_pair",
    "missing_engines",
    "relative_rms",
    "replace_files",
    "require_runnable",
    "require_writable",
    "reserved_engines",
    "simulate_all",
]
