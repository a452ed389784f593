"""Times of the samples of a record: even steps, and one step, start and length for its components."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .component import Component, RecordFile

# over a whole record two components may drift apart by this part of a step, the rounding of printed times
_DRIFT = 0.05
_MOST_PARTS = 20  # samples per smallest step; a longer resampled record indicates a mistake in the time steps
# components may differ in length by this part, and by more where what is left out is below this part of
# the peak
_LEFT_OUT, _STILL = 0.01, 0.05
LENGTHS = ("pad", "cut")
# printed times are rounded, as 0.0167 for 1/60: a sample may stand this much of a step off its place
_UNEVENNESS = 0.05
_LONGEST_GAP = 2.0  # median steps; more are missing samples
_EPOCH = 1e6  # [s], 11 days: no record begins so late, times since 1970 do


def rises_evenly(time: NDArray[np.float64]) -> bool:
    """Whether numbers rise in even steps, as times do."""
    return len(time) > 1 and _uneven(time)[0] is None


def is_counting(time: NDArray[np.float64]) -> bool:
    """Whether numbers are whole and rise by 1, as row numbers do."""
    return bool((np.diff(time) == 1.0).all() and (time[0] == round(time[0])))


def since_epoch(time: float) -> bool:
    """Whether a time [s] counts from an epoch such as 1970."""
    return bool(abs(time) > _EPOCH)


def _uneven(time: NDArray[np.float64]) -> tuple[int | None, float]:
    """Place of the largest jump of the step, None where all are even, and the mean step."""
    # halves, because the difference of two large floats overflows
    step = 2.0 * float(0.5 * time[-1] - 0.5 * time[0]) / (len(time) - 1)
    if not 0.0 < step < np.inf:
        return 0, step
    with np.errstate(over="ignore", invalid="ignore"):  # an infinite distance is refused like any other
        off = np.abs((time - time[0]) / step - np.arange(len(time)))
        # the place where the step changes, not the one where the error has grown largest
        jump = np.abs(np.diff(time) / step - 1.0)
    even = off.max() <= _UNEVENNESS and jump.max() <= 2.0 * _UNEVENNESS
    return (None if even else int(jump.argmax())), step


def even_samples(
    file: RecordFile,
    time: NDArray[np.float64],
    samples: NDArray[np.float64],
    lines: Sequence[int],
    *,
    resample: bool,
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    """Samples at even times, their step in the unit of the times, and a note of what was done.

    Parameters
    ----------
    file : RecordFile
        For messages.
    time : ndarray, shape (n,)
    samples : ndarray, shape (n, columns)
    lines : sequence of int
        Line of each.
    resample : bool
        Whether uneven times become even: linearly between samples, at their median step.

    Raises
    ------
    ValueError
        If the times do not rise in even steps and may not be resampled, or samples are missing.
    """
    at, step = _uneven(time)
    if at is None:
        return samples, step, ()
    if not 0.0 < step < np.inf:
        raise ValueError(f"{file.name}: times must rise [s], got {time[0]:g} s first and {time[-1]:g} s last")
    steps = np.diff(time)
    median = float(np.median(steps))
    if not resample or not 0.0 < steps.min() <= steps.max() <= _LONGEST_GAP * median:
        raise ValueError(
            f"{file.name}, line {lines[at + 1]}: times must rise in even steps, got {time[at + 1]:g} s "
            f"after {time[at]:g} s where the mean step is {step:.6g} s: --resample (resample=) takes samples "
            f"at even times where no step exceeds {_LONGEST_GAP:g} times the median"
        )
    even = time[0] + median * np.arange(int((time[-1] - time[0]) / median * (1.0 + 1e-12)) + 1)
    taken = np.column_stack([np.interp(even, time, column) for column in samples.T])
    return taken, median, (f"uneven times (steps of {steps.min():.6g} to {steps.max():.6g}) resampled",)


def require_same_clock(components: Sequence[Component]) -> None:
    """Refuse components of different time steps, or that start at different times.

    Raises
    ------
    ValueError
        Naming two files that differ.
    """
    length = min(len(part.values) for part in components)
    first = components[0]
    tolerance = _DRIFT * first.time_step
    for other in components[1:]:
        if abs(other.time_step - first.time_step) * length > tolerance:
            raise ValueError(
                f"the components of a record must have one time step, got {first.time_step:g} s in "
                f"{first.path.name} and {other.time_step:g} s in {other.path.name}: resample (--resample) "
                "takes both at a step that divides them, which changes neither"
            )
        # an AT2 file gives no times: its first sample is taken as that of the others
        if first.start is not None and other.start is not None and abs(other.start - first.start) > tolerance:
            raise ValueError(
                f"the components of a record must start at one time, got {first.start:g} s in "
                f"{first.path.name} and {other.start:g} s in {other.path.name}"
            )


def equally_long(
    components: Sequence[Component], lengths: str | None
) -> tuple[list[Component], tuple[str, ...]]:
    """Components of one length, and what was done to them.

    Parameters
    ----------
    components : sequence of Component
    lengths : {"pad", "cut"} or None
        Fill the shorter with zeros, or cut the longer. None: cut where what is left out is as good as over.

    Raises
    ------
    ValueError
        If one would be cut in the middle of its motion and `lengths` does not say so: half a record is
        another record.
    """
    counts = [len(part.values) for part in components]
    shortest, longest = min(counts), max(counts)
    if shortest == longest:
        return list(components), ()
    if lengths == "pad":
        padded = [
            replace(part, values=np.concatenate([part.values, np.zeros(longest - len(part.values))]))
            for part in components
        ]
        return padded, (f"components of {shortest} samples filled with zeros",)
    for part in components if lengths is None else ():
        rest, peak = np.abs(part.values[shortest:]), np.abs(part.values).max()
        if len(rest) > _LEFT_OUT * len(part.values) and rest.max() > _STILL * peak:
            raise ValueError(
                f"the components of a record must be equally long, got {len(part.values)} samples in "
                f"{part.path.name} and {shortest} in another: what would be left out has "
                f"{100.0 * rest.max() / peak:.0f} % of its peak; --lengths pad (lengths=) fills the shorter "
                "with zeros, --lengths cut cuts the longer"
            )
    cut = [replace(part, values=part.values[:shortest]) for part in components]
    return cut, (f"components of up to {longest} samples cut to {shortest}",)


def resampled(components: Sequence[Component]) -> list[Component]:
    """Components at the largest time step that divides the steps of all, linear between samples.

    That changes no record: each is linear between its samples, and all of them stay.

    Raises
    ------
    ValueError
        If no such step is at least a twentieth of the smallest one.
    """
    finest = min(components, key=lambda each: each.time_step)
    for parts in range(1, _MOST_PARTS + 1):
        step = finest.time_step / parts
        counts = [round(each.time_step / step) for each in components]
        drifts = [
            abs(each.time_step - count * step) * len(each.values)
            for each, count in zip(components, counts, strict=True)
        ]
        if max(drifts) <= _DRIFT * step:
            return [_refine(each, count, step) for each, count in zip(components, counts, strict=True)]
    coarsest = max(components, key=lambda each: each.time_step)
    raise ValueError(
        f"components are resampled to a step that divides all, at least 1/{_MOST_PARTS} of the smallest: "
        f"{finest.time_step:g} s in {finest.path.name} and {coarsest.time_step:g} s in {coarsest.path.name} "
        "have none"
    )


def _refine(component: Component, count: int, step: float) -> Component:
    """Component with each of its time steps cut into `count` of `step` [s]."""
    values = component.values
    places = np.arange((len(values) - 1) * count + 1) / count
    return replace(component, values=np.interp(places, np.arange(len(values)), values), time_step=step)
