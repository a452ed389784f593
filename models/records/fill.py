"""Numbers that stand where a sample is missing, such as -999 and 1e10."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .component import Component

_FILL = re.compile(r"-?9{3,}(?:\.(?:9+|0))?|-12345\.0")
_FAR = 5.0  # times the largest of all other samples
_BEYOND = 1e6  # times the largest of all other samples: no record has such a spike, whatever its digits
_LEAST = 999.0  # least size of a number that fills a place


def without_fill(values: NDArray[np.float64]) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """Return values without what fills the last line after the last sample, such as 9999.9, and a note of it.

    Examples
    --------
    >>> without_fill(np.array([0.1, 0.2, -999.0, -999.0]))
    (array([0.1, 0.2]), ('2 fill values of -999 after the last sample are left out',))
    """
    last = float(values[-1]) if len(values) else 0.0
    others = np.flatnonzero(values != last)
    if not _FILL.fullmatch(repr(last)) and not _is_beyond(last, values[others]):
        return values, ()
    count = len(values) - (int(others[-1]) + 1 if len(others) else 0)
    note = f"{count} fill value{'s' * (count > 1)} of {last:g} after the last sample are left out"
    return values[: len(values) - count], (note,)


def without_filled_end(component: Component) -> Component:
    """Return a component without fill values after its last sample.

    Raises
    ------
    ValueError
        If one stands among its samples: the sample is missing, and no other number would be right.
    """
    values, notes = without_fill(component.values)
    if notes:
        component = replace(component, values=values, notes=(*component.notes, *notes))
    largest = float(np.abs(values).max())
    if not largest >= _LEAST:
        return component
    at = int(np.abs(values).argmax())
    fill = float(values[at])
    rest = values[values != fill]
    known = _FILL.fullmatch(repr(fill)) and len(rest) and largest > _FAR * float(np.abs(rest).max())
    if known or _is_beyond(fill, rest):
        raise ValueError(
            f"{component.path.name}: sample {at + 1}{f' of {component.label}' * bool(component.label)} is "
            f"{fill:g}, which stands for a missing one: give a whole record"
        )
    return component


def _is_beyond(value: float, others: NDArray[np.float64]) -> bool:
    """Return whether a number is too large to be a sample beside all others, some of which are not zero."""
    largest = float(np.abs(others).max(initial=0.0))
    return abs(value) >= _LEAST and 0.0 < largest < abs(value) / _BEYOND
