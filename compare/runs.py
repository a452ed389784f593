"""Which runs a comparison consists of where the user does not say, and what they are held against."""

from __future__ import annotations

from collections.abc import Sequence

from rockwobble.models import Case, Run
from rockwobble.multibody import available_engines, engine_names
from rockwobble.multibody.froude import froude_scale
from rockwobble.multibody.guard import check_time_step
from rockwobble.multibody.registry import find_engine

SUPPORTS = ("guided", "free")

# a cylinder on open ground is free to roll out: the rolling model is its own reduced model
SUPPORT_REFERENCES = {"free": ("rolling",)}


def installed_engines() -> tuple[str, ...]:
    """Return the engines that are installed here, those of a default run."""
    return available_engines()


def missing_engines() -> tuple[str, ...]:
    """Return the known engines that are not installed here."""
    return tuple(name for name in engine_names() if name not in installed_engines())


def require_runnable(case: Case, run: Run) -> None:
    """Check engine, support and time step of a run, so that no other run starts in vain.

    Raises
    ------
    ValueError
        If the engine is unknown or not installed, does not have the support, or the time step is too
        large for contact.
    """
    supports = find_engine(run.engine).supports
    if run.support not in supports:
        raise ValueError(f"support must be one of {', '.join(supports)}, got {run.support!r}")
    if run.time_step is not None:
        check_time_step(run.time_step, froude_scale(case.cylinder.semidiagonal, case.gravity).time)


def default_runs(
    engines: Sequence[str] | None = None, supports: Sequence[str] | None = None
) -> tuple[Run, ...]:
    """Return every installed engine with each support, the guided ones first."""
    return tuple(
        Run(engine, support)
        for support in (SUPPORTS if supports is None else supports)
        for engine in (installed_engines() if engines is None else engines)
    )


def references_of(run: Run, reference: str) -> tuple[str, ...]:
    """Return the reduced models that a run is held against: `reference`, and that of its support."""
    more = (model for model in SUPPORT_REFERENCES.get(run.support, ()) if model != reference)
    return (reference, *more)


def run_labels(runs: Sequence[Run]) -> tuple[str, ...]:
    """Return a label for each run: engine and support, and as much more as tells them apart."""
    labels = [f"{run.engine} {run.support}" for run in runs]
    if len(set(labels)) < len(labels):
        labels = [
            f"{label} {run.time_step:g} s" if run.time_step and labels.count(label) > 1 else label
            for label, run in zip(labels, runs, strict=True)
        ]
    if len(set(labels)) < len(labels):
        labels = [
            " ".join([label, *(f"{key}={value}" for key, value in run.settings.items())])
            if labels.count(label) > 1
            else label
            for label, run in zip(labels, runs, strict=True)
        ]
    for label in labels:
        if labels.count(label) > 1:
            raise ValueError(f"the runs of a comparison must differ, got {label!r} twice")
    return tuple(labels)
