"""Mistakes in the path of the mass centre: its axes, the sense of z, its unit, its origin."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...traces.motion import Motion, on_samples_of
from .difference import Difference, explains
from .frame import Frame, Mistake

_LENGTH_UNITS = (1e3, 1e2, 1e-2, 1e-3)
Trial = tuple[Frame, bool, float, bool]  # axes, z down, unit, another origin


def explain_path(
    reference: Motion,
    motion: Motion,
    before: Difference,
    *,
    axes: Frame,
    fits: Sequence[Frame],
    hold: Callable[[Motion], Difference],
) -> tuple[Frame, list[Mistake], Motion]:
    """Return the fewest mistakes that explain a path, and the motion with the path without them.

    What is wrong with the axes of the lean, `axes`, or nothing is expected of the path, too; `fits` is what
    else may be wrong with them. `hold` gives the difference of a motion and the reference, which is `before`
    for this one. What is wrong with the axes is returned first.
    """
    part = before.path
    if part is None or not (part.differs or axes.code):
        return Frame(), [], motion
    expected = (Frame(), axes)

    def count(one: Trial) -> float:
        frame, down, unit, moved = one
        # a constant offset has three numbers to fit: it comes after what has none
        return (frame not in expected) + down + (unit != 1.0) + 1.5 * moved

    frames = dict.fromkeys((*expected, *fits))
    tried = sorted(itertools.product(frames, (False, True), (1.0, *_LENGTH_UNITS), (False, True)), key=count)
    for _, alike in itertools.groupby(tried, key=count):
        passing = []
        for frame, mistakes, trial in _trials(reference, motion, before.covered, alike):
            left = hold(trial).path
            if left is None or left.differs:
                continue
            if explains(part, left) or not part.differs:
                passing.append((left.size, frame, mistakes, trial))
        if passing:
            return min(passing, key=lambda one: one[0])[1:]
    return Frame(), [], motion


def _trials(
    reference: Motion, motion: Motion, end: float, tried: Iterator[Trial]
) -> Iterator[tuple[Frame, list[Mistake], Motion]]:
    for frame, down, unit, moved in tried:
        path = frame.apply(motion).path
        assert path is not None
        path = path / unit * np.array([1.0, 1.0, -1.0 if down else 1.0])
        trial = replace(motion, path=path, path_noise=motion.path_noise / unit)
        mistakes = [frame.mistake("path")] if frame.code else []
        mistakes += [Mistake(code="z_reversed", concerns="path")] if down else []
        mistakes += [Mistake(code="length_unit", concerns="path", value=unit)] if unit != 1.0 else []
        if moved:
            wanted, own = on_samples_of(reference, trial)
            assert wanted.path is not None
            assert own.path is not None
            origin = np.median((own.path - wanted.path)[wanted.time <= end + 1e-9], axis=0)
            trial = replace(trial, path=path - origin)
            mistakes.append(Mistake(code="origin", concerns="path", value=float(np.linalg.norm(origin))))
        yield frame, mistakes, trial


def lean_of_path(motion: Motion) -> Motion:
    """Return the motion with the direction of its mass centre for that of its axis."""
    assert motion.path is not None
    flat = motion.path[:, 0] + 1j * motion.path[:, 1]
    return replace(motion, lean=np.sin(motion.tilt) * np.exp(1j * np.angle(flat)))
