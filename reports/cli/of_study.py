"""Typer command of a study whose dataclass fields are its options."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from ..registry import Entry
from . import options
from .command import Work, saves_results

if TYPE_CHECKING:
    from rockwobble.compare.runs.progress import ProgressCallback
    from rockwobble.compare.storage.results import Results


def command_of(entry: Entry) -> Callable[..., None]:
    """Command of a study: its fields as options, its docstring as help."""
    study = entry.study_class()

    def command(context: typer.Context, plan: Any, workers: options.Workers = None) -> Work:
        def run(resume: Path, progress: ProgressCallback) -> Results:
            results: Results = plan.run(folder=resume, workers=workers, progress=progress)
            return results

        return Work(run, what=study.what, resumes=True)

    command.__name__, command.__doc__ = entry.command, study.__doc__
    command.__annotations__["plan"] = study
    return saves_results(command)
