"""Free response over slenderness, release and spin: recess against flat ground, and what the recess needs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from rockwobble import reduced
from rockwobble.models import Assumptions, Case, Trace

from .extent import Extent
from .motions import release_case
from .part import Inputs, Part, Row

_RTOL = 1e-10
_CYCLES = 10.0  # over which the flat-ground model may gather tilt
_MAXIMUM = 1.0  # in the fourth column of `Trace.extrema`


def _tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha in extent.tan_alphas:
        yield {"tan_alpha": tan_alpha, "releases": extent.releases, "spins": extent.spins}


def measure(tan_alpha: float, releases: Sequence[float], spins: Sequence[float]) -> list[Row]:
    """Return one row for each release and spin.

    The columns: tan_alpha, release, spin; period [s] and turn [rad] from tilt maximum to next maximum, exact
    (recess) and integrated (flat_period, flat_turn; NaN where it overturns first), flat_peak, the
    largest tilt of the flat-ground model in ten periods over the release; needs of the recess model in one
    period: friction, least_normal [weights], moment, the restraining moment over weight and base radius.
    """
    return [_row(tan_alpha, release, spin) for release in releases for spin in spins]


def _row(tan_alpha: float, release: float, spin: float) -> Row:
    case = release_case(tan_alpha, release, spin)
    assert case.initial is not None
    exact = reduced.free_response(case.cylinder, case.initial)
    flat = reduced.simulate(replace(case, duration=_CYCLES * exact.period), support="flat", rtol=_RTOL)
    period, turn = next_maximum(flat)
    needs = needs_of(case)
    return {
        "release": release,
        "spin": spin,
        "period": exact.period,
        "flat_period": period,
        "turn": exact.angle_of_turn,
        "flat_turn": turn,
        "flat_peak": flat.peak_tilt / case.initial.tilt,
        "friction": needs.largest_friction_needed,
        "least_normal": needs.least_normal_force,
        "moment": needs.largest_restraining_moment / case.cylinder.base_radius,
    }


def next_maximum(trace: Trace) -> tuple[float, float]:
    """Return time and rolling angle from the release, a tilt maximum, to the next; NaN if there is none."""
    maxima = trace.extrema[trace.extrema[:, 3] == _MAXIMUM]
    if len(maxima) < 2:
        return math.nan, math.nan
    return float(maxima[1, 0] - maxima[0, 0]), float(maxima[1, 2] - maxima[0, 2])


def needs_of(case: Case) -> Assumptions:
    """Return the needs of the recess model of ground and recess in a case."""
    needs = reduced.simulate(case, rtol=_RTOL).assumptions
    assert needs is not None
    return needs


PART = Part(
    name="free_response",
    title="free response, recess against flat ground",
    tasks=_tasks,
    measure=measure,
    keys=("tan_alpha",),
    cost=lambda releases, spins, **_: 0.02 * len(releases) * len(spins),
)
