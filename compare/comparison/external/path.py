"""What is wrong with the path of the mass centre: its axes, the sense of z, its unit, its origin."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...traces.motion import Motion, on_samples_of
from .difference import Difference
from .frame import Frame
from .mistake import Mistake, explains, mistake_of

_LENGTH_UNITS = (1e3, 1e2, 1e-2, 1e-3)


def explain_path(
    reference: Motion,
    motion: Motion,
    before: Difference,
    *,
    axes: Frame,
    fits: Sequence[Frame],
    hold: Callable[[Motion], Difference],
) -> tuple[Frame, list[Mistake], Motion]:
    """Return the fewest mistakes that explain a path.

    Parameters
    ----------
    reference, motion : Motion
    before : Difference
        Of the two.
    axes : Frame
        What is wrong with the axes of the lean: that, or nothing, is expected of the path, too.
    fits : sequence of Frame
        What else may be wrong with the axes.
    hold : callable
        Difference of a motion and the reference.

    Returns
    -------
    Frame
        What is wrong with the axes.
    list of Mistake
        Those and others; empty where none explains the path.
    Motion
        The motion with the path without them.
    """
    part = before.path
    if part is None or not (part.differs or axes.code):
        return Frame(), [], motion
    expected = (Frame(), axes)
    tried = sorted(
        itertools.product(
            dict.fromkeys((*expected, *fits)), (False, True), (1.0, *_LENGTH_UNITS), (False, True)
        ),
        key=lambda one: _count(one[0] not in expected, *one[1:]),
    )
    for _, alike in itertools.groupby(tried, key=lambda one: _count(one[0] not in expected, *one[1:])):
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
    reference: Motion, motion: Motion, end: float, tried: Iterator[tuple[Frame, bool, float, bool]]
) -> Iterator[tuple[Frame, list[Mistake], Motion]]:
    for frame, down, unit, moved in tried:
        path = frame.apply(motion).path
        assert path is not None
        path = path / unit * np.array([1.0, 1.0, -1.0 if down else 1.0])
        trial = replace(motion, path=path, path_noise=motion.path_noise / unit)
        mistakes = [mistake_of(frame, "path")] if frame.code else []
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


def _count(other_axes: bool, down: bool, unit: float, moved: bool) -> float:
    # a constant offset has three numbers to fit: it comes after what has none
    return other_axes + down + (unit != 1.0) + 1.5 * moved


def lean_of_path(motion: Motion) -> Motion:
    """Return the motion with the direction of its mass centre for that of its axis."""
    assert motion.path is not None
    flat = motion.path[:, 0] + 1j * motion.path[:, 1]
    return replace(motion, lean=np.sin(motion.tilt) * np.exp(1j * np.angle(flat)))
