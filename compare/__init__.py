"""Reduced models and engines on the same problem: differences, and how long they agree."""

from .comparison import Comparison, describe_case
from .driver import compare
from .execution import Progress
from .runs import default_runs, installed_engines, missing_engines
from .store import replace_files, require_writable
from .summary import SUMMARY_COLUMNS
from .tilt import relative_rms

__all__ = [
    "SUMMARY_COLUMNS",
    "Comparison",
    "Progress",
    "compare",
    "default_runs",
    "describe_case",
    "installed_engines",
    "missing_engines",
    "relative_rms",
    "replace_files",
    "require_writable",
]
