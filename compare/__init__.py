"""Reduced models and engines on the same problem: differences, and how long they agree."""

from .comparison import Comparison, describe_case, describe_run
from .contact import TILTED
from .driver import compare
from .ensemble_members import far_field_motions, perturbed_starts, synthetic_motions, with_motions
from .ensemble_study import Ensemble, ensemble, read_ensemble
from .error_budget import LARGEST_SHARE, WORTH_EXPLAINING, ErrorBudget, findings
from .execution import Crash, Job, Progress, simulate_all
from .external.trajectory import ExternalTrajectory, Foreign, read_trajectory
from .horizon import AGREEMENT
from .runs import (
    default_runs,
    installed_engines,
    missing_engines,
    own_model,
    require_runnable,
    reserved_engines,
    with_settings,
)
from .store import replace_files, require_writable
from .summary import SUMMARY_COLUMNS
from .sweep_cases import CaseSweep
from .sweep_grid import Grid
from .sweep_store import SweepStore, open_sweep_store
from .sweep_study import SweepIncompleteError, SweepProgress, sweep
from .tilt import relative_rms
from .traces import Pair, make_pair

__all__ = [
    "AGREEMENT",
    "LARGEST_SHARE",
    "SUMMARY_COLUMNS",
    "TILTED",
    "WORTH_EXPLAINING",
    "CaseSweep",
    "Comparison",
    "Crash",
    "Ensemble",
    "ErrorBudget",
    "ExternalTrajectory",
    "Foreign",
    "Grid",
    "Job",
    "Pair",
    "Progress",
    "SweepIncompleteError",
    "SweepProgress",
    "SweepStore",
    "compare",
    "default_runs",
    "describe_case",
    "describe_run",
    "ensemble",
    "far_field_motions",
    "findings",
    "installed_engines",
    "make_pair",
    "missing_engines",
    "open_sweep_store",
    "own_model",
    "perturbed_starts",
    "read_ensemble",
    "read_trajectory",
    "relative_rms",
    "replace_files",
    "require_runnable",
    "require_writable",
    "reserved_engines",
    "simulate_all",
    "sweep",
    "synthetic_motions",
    "with_motions",
    "with_settings",
]
