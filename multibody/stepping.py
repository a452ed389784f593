"""Steps an engine through a run."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .engine import Engine, Scene, Stepper
from .excitation import StepMeans
from .recorder import Recorder

Array = NDArray[np.float64]
Progress = Callable[[float], None]

_CHUNK = 10_000  # steps between two looks at the run: a second of the reference scene, 3 MB of states


def run_steps(
    backend: Engine,
    scene: Scene,
    settings: Mapping[str, Any],
    recorder: Recorder,
    means: StepMeans,
    progress: Progress | None,
) -> Recorder:
    """Step a run to its end, and return what recorded it."""
    # one step past the end: the velocity at a pose is the mean of those before and after it
    total = math.ceil(recorder.end / scene.time_step - 1e-6) + 1
    with backend.open(scene, settings) as stepper:
        done = 0
        while done < total and not recorder.ended:
            count = min(_CHUNK, total - done)
            acceleration = means(done, count, stepper.hold_centre)
            # the force belongs to the pose, wherever the engine holds it
            at_pose = means(done, count) if stepper.hold_centre else acceleration
            _advance(stepper, recorder, acceleration, at_pose)
            done += count
            if progress is not None:
                progress(done / total)
    return recorder


def _advance(stepper: Stepper, recorder: Recorder, acceleration: Array, at_pose: Array) -> None:
    recorder.take(stepper.advance(acceleration), at_pose)
    warning = stepper.warnings()
    if warning and not recorder.ended:
        recorder.fail(f"the engine warned: {warning}")
    elif warning and recorder.ended == "failed":
        recorder.reason += f"; the engine warned: {warning}"
