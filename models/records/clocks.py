"""One time step, start and length for the components of a record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .component import Component

# over a whole record two components may drift apart by this part of a step, the rounding of printed times
_DRIFT = 0.05
_MOST_PARTS = 20  # of the smallest step: a record of more samples by that is a mistake, not a common step
# components may differ in length by this part, and by more where what is left out is below this part of
# the peak
_LEFT_OUT, _STILL = 0.01, 0.05
LENGTHS = ("pad", "cut")


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
    """Return components of one length, and what was done to them.

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
    """Return components at the largest time step that divides the steps of all, linear between samples.

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
            return [_refined(each, count, step) for each, count in zip(components, counts, strict=True)]
    coarsest = max(components, key=lambda each: each.time_step)
    raise ValueError(
        f"components are resampled to a step that divides all, at least 1/{_MOST_PARTS} of the smallest: "
        f"{finest.time_step:g} s in {finest.path.name} and {coarsest.time_step:g} s in {coarsest.path.name} "
        "have none"
    )


def _refined(component: Component, count: int, step: float) -> Component:
    """Return a component with each of its time steps cut into `count` of `step` [s]."""
    values = component.values
    places = np.arange((len(values) - 1) * count + 1) / count
    return replace(component, values=np.interp(places, np.arange(len(values)), values), time_step=step)
