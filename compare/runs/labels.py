"""Labels of runs beside one another: as much of each run as tells them apart."""

from __future__ import annotations

from collections.abc import Sequence

from rockwobble.models import Run

REDUCED = "reduced"  # the engine of a reduced model, in tables


def labels_beside_references(runs: Sequence[Run], reference: Run | None) -> tuple[tuple[str, ...], str]:
    """Return a label for each run and that of the reference, all different and none that of another model.

    A reduced model at its defaults keeps its name.
    """
    run_labels(runs)  # none of them twice
    others: list[Run] = []
    models = Run(None, "recess"), Run(None, "flat")
    for each in (*models, *(() if reference is None else (reference,))):
        if each not in (*runs, *others):
            others.append(each)
    labels = run_labels((*runs, *others))
    named = "" if reference is None else labels[[*runs, *others].index(reference)]
    return labels[: len(runs)], named


def run_labels(runs: Sequence[Run]) -> tuple[str, ...]:
    """Return a label for each run: engine and support, and as much more as tells them apart."""
    labels = [str(run) for run in runs]
    if len(set(labels)) < len(labels):
        labels = [
            f"{label} {_step_label(run.time_step)}" if run.time_step and labels.count(label) > 1 else label
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


def _step_label(time_step: float | str) -> str:
    return time_step if isinstance(time_step, str) else f"{time_step:g} s"
