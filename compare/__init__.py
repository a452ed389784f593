"""Reduced models and engines on the same problem: differences, and how long they agree.

Every name is imported when it is first used. The module may be called: ``rockwobble.compare(case)`` is
``rockwobble.compare.compare(case)``.
"""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # under its own name again: that is how a type checker knows a name for a public one
    from inspect import Signature

    from .comparison.budget import LARGEST_SHARE as LARGEST_SHARE
    from .comparison.budget import WORTH_EXPLAINING as WORTH_EXPLAINING
    from .comparison.budget import ErrorBudget as ErrorBudget
    from .comparison.budget import findings as findings
    from .comparison.comparison import Comparison as Comparison
    from .comparison.driver import compare as compare
    from .comparison.summary import SUMMARY_COLUMNS as SUMMARY_COLUMNS
    from .external.trajectory import External as External
    from .external.trajectory import read_trajectory as read_trajectory
    from .metrics.contact import TILTED as TILTED
    from .metrics.pair import Pair as Pair
    from .metrics.pair import make_pair as make_pair
    from .runs.choice import default_runs as default_runs
    from .runs.choice import missing_engines as missing_engines
    from .runs.choice import own_model as own_model
    from .runs.choice import require_runnable as require_runnable
    from .runs.choice import reserved_engines as reserved_engines
    from .runs.choice import runs_here as runs_here
    from .runs.execution import Job as Job
    from .runs.execution import simulate as simulate
    from .runs.execution import simulate_all as simulate_all
    from .runs.progress import Progress as Progress
    from .runs.run_settings import with_settings as with_settings
    from .runs.scheduler import run_tasks as run_tasks
    from .runs.task import IncompleteError as IncompleteError
    from .storage.files import replace_files as replace_files
    from .storage.manifest import require_writable as require_writable
    from .studies.advice.advice import Advice as Advice
    from .studies.advice.advice import advise as advise
    from .studies.ensemble import Ensemble as Ensemble
    from .studies.ensemble import ensemble as ensemble
    from .studies.fragility.intensity import MEASURES as MEASURES
    from .studies.fragility.samples import LIMITS as LIMITS
    from .studies.fragility.study import Fragility as Fragility
    from .studies.fragility.study import fragility as fragility
    from .studies.spectrum.study import OverturningSpectrum as OverturningSpectrum
    from .studies.spectrum.study import spectrum as spectrum
    from .studies.sweep.grid import Grid as Grid
    from .studies.sweep.result import Sweep as Sweep
    from .studies.sweep.study import sweep as sweep

_MODULES = {
    "comparison.driver": ("compare",),
    "comparison.budget": ("LARGEST_SHARE", "WORTH_EXPLAINING", "ErrorBudget", "findings"),
    "comparison.comparison": ("Comparison",),
    "comparison.summary": ("SUMMARY_COLUMNS",),
    "metrics.contact": ("TILTED",),
    "runs.choice": (
        "default_runs",
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
    "runs.task": ("IncompleteError",),
    "storage.files": ("replace_files",),
    "storage.manifest": ("require_writable",),
    "studies.advice.advice": ("Advice", "advise"),
    "studies.ensemble": ("Ensemble", "ensemble"),
    "studies.fragility.intensity": ("MEASURES",),
    "studies.fragility.samples": ("LIMITS",),
    "studies.fragility.study": ("Fragility", "fragility"),
    "studies.spectrum.study": ("OverturningSpectrum", "spectrum"),
    "studies.sweep.grid": ("Grid",),
    "studies.sweep.result": ("Sweep",),
    "studies.sweep.study": ("sweep",),
    "metrics.pair": ("Pair", "make_pair"),
    "external.trajectory": ("External", "read_trajectory"),
}
__all__ = sorted(name for names in _MODULES.values() for name in names)


class _Callable(ModuleType):
    def __call__(self, *arguments: Any, **options: Any) -> Comparison:
        """Run engines and reduced models on the same problem; see the function `compare`."""
        found: Comparison = self.compare(*arguments, **options)
        return found

    @property
    def __signature__(self) -> Signature:
        from inspect import signature

        return signature(self.compare)


def __getattr__(name: str) -> object:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(importlib.import_module(f".{module}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)


sys.modules[__name__].__class__ = _Callable
