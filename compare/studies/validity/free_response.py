"""Free response over slenderness, release and spin: recess against flat ground, and what the recess needs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from rockwobble import reduced
from rockwobble.models import Assumptions, Case, Trace

from .extent import Extent
from .part import Inputs, Part, Row
from .releases import released

if TYPE_CHECKING:
    from rockwobble.models import Cylinder, InitialState

_RTOL = 1e-10
_CYCLES = 10.0  # over which the flat-ground model may gather tilt
_MAXIMUM = 1.0  # in the fourth column of `Trace.extrema`


def _tasks(extent: Extent) -> Sequence[Inputs]:
    return [
        {"tan_alpha": tan_alpha, "releases": extent.releases, "spins": extent.spins}
        for tan_alpha in extent.tan_alphas
    ]


def measure(inputs: Inputs) -> list[Row]:
    """Return one row for each release and spin.

    The columns: tan_alpha, release, spin; period [s] and turn [rad] from tilt maximum to next maximum, exact
    (recess) and integrated (flat_period, flat_turn; NaN where it overturns first), flat_peak, the
    largest tilt of the flat-ground model in ten periods over the release; needs of the recess model in one
    period: friction, least_normal [weights], couple over weight and base radius.
    """
    return [
        {"tan_alpha": inputs["tan_alpha"], "release": release, "spin": spin, **_row(inputs, release, spin)}
        for release in inputs["releases"]
        for spin in inputs["spins"]
    ]


def _row(inputs: Inputs, release: float, spin: float) -> Row:
    cylinder, initial = released(inputs["tan_alpha"], release, spin)
    exact = reduced.free_response(cylinder, initial)
    rolling = reduced.simulate(
        Case(cylinder, initial=initial, duration=_CYCLES * exact.period), support="flat", rtol=_RTOL
    )
    period, turn = next_maximum(rolling)
    needs = needs_of_one_period(cylinder, initial, exact.period)
    return {
        "period": exact.period,
        "flat_period": period,
        "turn": exact.angle_of_turn,
        "flat_turn": turn,
        "flat_peak": rolling.peak_tilt / initial.tilt,
        "friction": needs.largest_friction_needed,
        "least_normal": needs.least_normal_force,
        "couple": needs.largest_restraining_moment / cylinder.base_radius,
    }


def next_maximum(response: Trace) -> tuple[float, float]:
    """Return time and rolling angle from the release, a tilt maximum, to the next; NaN if there is none."""
    maxima = response.extrema[response.extrema[:, 3] == _MAXIMUM]
    if len(maxima) < 2:
        return math.nan, math.nan
    return float(maxima[1, 0] - maxima[0, 0]), float(maxima[1, 2] - maxima[0, 2])


def needs_of_one_period(cylinder: Cylinder, initial: InitialState, period: float) -> Assumptions:
    """Return what the recess model needs of ground and recess from a release to the next maximum."""
    needs = reduced.simulate(Case(cylinder, initial=initial, duration=period), rtol=_RTOL).assumptions
    assert needs is not None
    return needs


PART = Part(
    name="free_response",
    title="free response, recess against flat ground",
    tasks=_tasks,
    measure=measure,
    cost=lambda inputs: 0.02 * len(inputs["releases"]) * len(inputs["spins"]),
    module=__name__,
)
