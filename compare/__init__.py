"""Reduced models and engines on the same problem: differences, and how long they agree.

Every name is imported when it is first used. The module may be called: ``rockwobble.compare(case)`` is
``rockwobble.compare.compare(case)``.
"""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .comparison.driver import compare
    from .comparison.error_budget import LARGEST_SHARE, WORTH_EXPLAINING, ErrorBudget, findings
    from .comparison.result import Comparison, describe_case
    from .comparison.summary import SUMMARY_COLUMNS
    from .metrics.agreement import AGREEMENT
    from .metrics.contact import TILTED
    from .metrics.tilt import relative_rms
    from .runs.choice import (
        default_runs,
        installed_engines,
        missing_engines,
        own_model,
        require_runnable,
        reserved_engines,
        runs_here,
    )
    from .runs.execution import Job, simulate, simulate_all
    from .runs.progress import Progress
    from .runs.run_settings import with_settings
    from .runs.scheduler import run_tasks
    from .storage.files import replace_files
    from .storage.manifest import require_writable
    from .studies.ensemble.members import far_field_motions, perturbed_starts, synthetic_motions, with_motions
    from .studies.ensemble.study import Ensemble, ensemble
    from .studies.fragility.intensity import MEASURES
    from .studies.fragility.limits import LIMITS
    from .studies.fragility.result import Fragility
    from .studies.fragility.study import fragility
    from .studies.sweep.cases import CaseSweep
    from .studies.sweep.grid import Grid
    from .studies.sweep.result import Sweep
    from .studies.sweep.study import SweepIncompleteError, read_sweep, sweep
    from .traces.pair import Pair, make_pair
    from .traces.trajectory import External, read_trajectory

_MODULES = {
    "comparison.driver": ("compare",),
    "comparison.error_budget": ("LARGEST_SHARE", "WORTH_EXPLAINING", "ErrorBudget", "findings"),
    "comparison.result": ("Comparison", "describe_case"),
    "comparison.summary": ("SUMMARY_COLUMNS",),
    "metrics.agreement": ("AGREEMENT",),
    "metrics.contact": ("TILTED",),
    "metrics.tilt": ("relative_rms",),
    "runs.choice": (
        "default_runs",
        "installed_engines",
        "missing_engines",
        "own_model",
        "require_runnable",
        "reserved_engines",
        "runs_here",
    ),
    "runs.execution": ("Job", "simulate", "simulate_all"),
    "runs.progress": ("Progress",),
    "runs.run_settings": ("with_settings",),
    "runs.scheduler": ("run_tasks",),
    "storage.files": ("replace_files",),
    "storage.manifest": ("require_writable",),
    "studies.ensemble.members": (
        "far_field_motions",
        "perturbed_starts",
        "synthetic_motions",
        "with_motions",
    ),
    "studies.ensemble.study": ("Ensemble", "ensemble"),
    "studies.fragility.intensity": ("MEASURES",),
    "studies.fragility.limits": ("LIMITS",),
    "studies.fragility.result": ("Fragility",),
    "studies.fragility.study": ("fragility",),
    "studies.sweep.cases": ("CaseSweep",),
    "studies.sweep.grid": ("Grid",),
    "studies.sweep.result": ("Sweep",),
    "studies.sweep.study": ("SweepIncompleteError", "read_sweep", "sweep"),
    "traces.pair": ("Pair", "make_pair"),
    "traces.trajectory": ("External", "read_trajectory"),
}
__all__ = [
    "AGREEMENT",
    "LARGEST_SHARE",
    "LIMITS",
    "MEASURES",
    "SUMMARY_COLUMNS",
    "TILTED",
    "WORTH_EXPLAINING",
    "CaseSweep",
    "Comparison",
    "Ensemble",
    "ErrorBudget",
    "External",
    "Fragility",
    "Grid",
    "Job",
    "Pair",
    "Progress",
    "Sweep",
    "SweepIncompleteError",
    "compare",
    "default_runs",
    "describe_case",
    "ensemble",
    "far_field_motions",
    "findings",
    "fragility",
    "installed_engines",
    "make_pair",
    "missing_engines",
    "own_model",
    "perturbed_starts",
    "read_sweep",
    "read_trajectory",
    "relative_rms",
    "replace_files",
    "require_runnable",
    "require_writable",
    "reserved_engines",
    "run_tasks",
    "runs_here",
    "simulate",
    "simulate_all",
    "sweep",
    "synthetic_motions",
    "with_motions",
    "with_settings",
]


class _Callable(ModuleType):
    def __call__(self, *arguments: Any, **options: Any) -> Comparison:
        """Run engines and reduced models on the same problem; see the function `compare`."""
        found: Comparison = self.compare(*arguments, **options)
        return found


def __getattr__(name: str) -> object:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(importlib.import_module(f".{module}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)


sys.modules[__name__].__class__ = _Callable
