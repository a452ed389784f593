"""The limits of the model as numbers, each a function of the measured tables alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from .distributions import records, single_peaks, vertical
from .engine import free_response, rings, soft_contact, traces
from .needs import contact, friction, restraining_moment
from .numbers import Numbers, Tables

LIMITS: Mapping[str, Callable[[Tables], Numbers]] = {
    "records": records,
    "single_peaks": single_peaks,
    "traces": traces,
    "free_response": free_response,
    "friction": friction,
    "contact": contact,
    "restraining_moment": restraining_moment,
    "rings": rings,
    "soft_contact": soft_contact,
    "vertical": vertical,
}


def limits_of(tables: Tables) -> dict[str, Numbers]:
    """Return the numbers of all limits by name.

    Parameters
    ----------
    tables : mapping of DataFrame
        Of each part by its name, as `measure_all` returns them.
    """
    return {name: limit(tables) for name, limit in LIMITS.items()}
