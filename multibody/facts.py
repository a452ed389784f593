"""Facts of an engine, known before a run: computing time, error, and its needs at uplift."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from rockwobble.models.shown import Brief

Options = Mapping[str, Any]

_NOTHING: Options = MappingProxyType({})


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class EngineFacts(Brief):
    """Measured facts of one engine, for plans and predictions; the defaults are those of an unknown one.

    Attributes
    ----------
    title : str
        Name as its makers write it.
    step_time : float
        Computing time of a step on one core of a two-core machine [s].
    order : float
        Of the error in the time step.
    release_error : float
        Root mean square error of the tilt in the first second after a release, over alpha tan^2(alpha), at
        the default step; see `compare.comparison.prediction`.
    uplift_error : float
        The same after an uplift from rest, over alpha.
    smooth_uplift : bool
        Whether the error of a run that uplifts is a power series in the step, so that finer steps tell its
        limit.
    rounding : float
        Relative rounding error of its arithmetic, 2^-53 in double and 2^-24 in single precision.
    carries_slab : bool
        Whether its scenes hold the slab of a frame: one column, under a slab that only translates.
    rolling_friction : bool
        Whether it has a couple against rolling, of at most a length times the normal force.
    contact_time : str
        Name of the setting that is the time in which contact removes a velocity [s]; empty without one.
    alternatives : mapping
        Settings worth a price of their own in a table of costs, by what they are called there; for a
        release.
    standing_alternatives : mapping
        The same for a cylinder that stands.
    """

    title: str = ""
    step_time: float = 3e-5
    order: float = 1.0
    release_error: float = 2e-6
    uplift_error: float = 2.5e-5
    smooth_uplift: bool = False
    rounding: float = 2.0**-53
    carries_slab: bool = False
    rolling_friction: bool = False
    contact_time: str = ""
    alternatives: Mapping[str, Options] = field(default_factory=lambda: _NOTHING)
    standing_alternatives: Mapping[str, Options] = field(default_factory=lambda: _NOTHING)
