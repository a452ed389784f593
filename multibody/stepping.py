"""Stepping of an engine through a run, and past its end where the cylinder still moves.

A run that ends in motion is followed over still ground until the tilt turns back, comes to rest, or the side
is on the ground. In the first two cases the run stands, and only the maximum is kept of the time after its
end: of those over still ground the first is the largest, since contact only loses energy (walls, which turn
spin into tilt, are the exception). In the last it has overturned, and goes on to there.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping

import numpy as np

from .auto_step import Progress
from .excitation import StepMeans
from .passes import TurningPoint, filter_noise_swings
from .protocol import Engine, Stepper
from .recorder import Recorder
from .scene import Array, Scene

_CHUNK = 10_000  # steps between two checks of the run: a second of the reference scene, 3 MB of states
_CHUNK_BEYOND = 2_000  # the same after the end, where most swings turn back within a second
# Times of growth by e next to the balance for which a motion is followed: one that turns or falls no sooner
# is within 3e-7 of the balance, the accuracy of an engine.
LONGEST = 15.0
# [rad] decrease of the tilt that counts as a turn; contact lost for a step gives 1e-7
_TURN = 1e-6
# Drift of a tilt in that time, over its distance from either end. A wobble at 0.1 and 0.5 alpha, where it is
# stable, drifts by 2e-5 at most in MuJoCo and Drake (tan alpha 0.1 to 1, R 1 to 30 m), by 3e-3 in Rapier,
# which is not decided; one at 0.9 alpha departs by 5e-3 at least in MuJoCo. The geometric mean of both.
_STEADY = 3e-4


def run_steps(
    backend: Engine,
    scene: Scene,
    settings: Mapping[str, object],
    recorder: Recorder,
    means: StepMeans,
    sample_step: float,
    progress: Progress | None,
) -> Recorder:
    """Step a run to its end, and return its recorder: `recorder`, or one continued to a later end.

    `sample_step` is that of samples after the end [s], in the scene.
    """
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
        if recorder.ended or recorder.resting or _has_turned(recorder, means.still_from):
            return recorder
        return _follow(stepper, scene, recorder, means, total, sample_step, progress)


def _follow(
    stepper: Stepper,
    scene: Scene,
    recorder: Recorder,
    means: StepMeans,
    done: int,
    sample_step: float,
    progress: Progress | None,
) -> Recorder:
    end, longest = recorder.end, LONGEST * scene.growth_time
    ahead = copy.deepcopy(recorder)
    first = math.floor(end / sample_step + 1e-9) + 1
    ahead.off_grid = end - (first - 1) * sample_step > 1e-6 * sample_step
    ahead.extend(sample_step * np.arange(first, math.ceil((end + longest) / sample_step) + 1, dtype=float))
    start = TurningPoint(end, recorder.last_value("tilt"), 0.0, recorder.last_value("tilt_rate") < 0.0)
    last = done + math.ceil(longest / scene.time_step)
    acceleration, at_pose = np.zeros((2, _CHUNK_BEYOND, 3))
    acceleration[0], at_pose[0] = means.stop(end, done, stepper.hold_centre), means.stop(end, done)
    while done < last:
        _advance(stepper, ahead, acceleration, at_pose)
        done += _CHUNK_BEYOND
        if progress is not None:
            progress(1.0)
        if ahead.ended:
            ahead.followed_until = ahead.end_time
            return ahead
        top = _maximum(start, ahead)
        if top is not None or ahead.resting:
            break
        acceleration[0] = at_pose[0] = 0.0
    # a steady wobble below the balance has no maximum to come, nor has a body against a wall beyond it
    keeps = abs(ahead.last_value("tilt") - start.tilt) < _STEADY * min(
        start.tilt, abs(scene.balance_tilt - start.tilt)
    )
    recorder.undecided = top is None and not ahead.resting and not keeps
    recorder.followed_until = float(ahead.last_row[0]) if top is None else top.time
    recorder.peak = max(recorder.peak, ahead.peak if top is None else top.tilt)
    recorder.elongation, recorder.yield_time = ahead.elongation, ahead.yield_time
    return recorder


def _advance(stepper: Stepper, recorder: Recorder, acceleration: Array, at_pose: Array) -> None:
    recorder.take(stepper.advance(acceleration), at_pose)
    warning = stepper.warnings()
    if warning:
        recorder.warn(warning)


def _has_turned(recorder: Recorder, since: float) -> bool:
    """Return whether the tilt has had a maximum since a time [s]."""
    return any(
        point.is_maximum and point.time >= since for point in filter_noise_swings(recorder.points, _TURN)
    )


def _maximum(start: TurningPoint, recorder: Recorder) -> TurningPoint | None:
    """First maximum after `start` from which the tilt has decreased."""
    later = [point for point in recorder.points if point.time > start.time]
    tilt = recorder.last_value("tilt")
    for point in filter_noise_swings([start, *later], _TURN):
        if point.is_maximum and point.time > start.time and tilt < point.tilt - _TURN:
            return point
    return None
