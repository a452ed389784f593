"""The command of a study that states its options itself."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import typer

from ..console import show_and_save, user_input
from ..registry import Entry
from . import options
from .command import takes_options
from .outputs import results_in


def command_of(entry: Entry) -> Callable[..., None]:
    """Return the command: the fields of the study as options; its docstring is the help."""
    study = entry.study_class()

    def command(
        context: typer.Context,
        plan: Any,
        workers: options.Workers = None,
        out: options.Out = Path(f"rockwobble-{entry.command}"),
        overwrite: options.Overwrite = False,
    ) -> None:
        with results_in(context, study.what) as progress:
            with user_input():
                found = plan.run(folder=out, workers=workers, progress=progress)
            show_and_save(found, out)

    command.__name__, command.__doc__ = entry.command, study.__doc__
    command.__annotations__["plan"] = study
    return takes_options(command)
