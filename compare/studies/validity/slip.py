"""The friction at which the engine slips, against that which the recess model needs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from rockwobble import multibody, reduced

from ...metrics.pair import make_pair
from ...metrics.tilt import tilt_rms
from .extent import Extent
from .free_response import needs_of
from .motions import release_case
from .part import Inputs, Part, Row

_PERIODS = 1.1  # one pass: the friction of the next is the same


def _tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha, release, spin in extent.slip_points:
        yield {"tan_alpha": tan_alpha, "release": release, "spin": spin, "shares": extent.slip_shares}


def measure(tan_alpha: float, release: float, spin: float, shares: Sequence[float]) -> list[Row]:
    """Return a row for each friction, as a share of what the recess model needs.

    The columns: tan_alpha, release, spin, needed, share, friction, slip of the engine in a recess in one
    period [b], tilt_rms against the recess model over alpha, outcome. No row where the model loses contact:
    no friction is enough.
    """
    needed = needs_of(release_case(tan_alpha, release, spin)).largest_friction_needed
    if not math.isfinite(needed):
        return []
    case = release_case(tan_alpha, release, spin, _PERIODS)
    recess = reduced.simulate(case, rtol=1e-10)
    rows: list[Row] = []
    for share in shares:
        run = multibody.simulate(replace(case, friction=share * needed))
        rows.append(
            {
                "needed": needed,
                "share": share,
                "friction": share * needed,
                "slip": float(run.slip[-1]) / case.cylinder.base_radius,
                "tilt_rms": tilt_rms(make_pair(case.cylinder, recess, run)),
                "outcome": run.outcome,
            }
        )
    return rows


PART = Part(
    name="slip",
    title="the friction at which the engine slips",
    tasks=_tasks,
    measure=measure,
    keys=("tan_alpha", "release", "spin"),
    cost=lambda shares, **_: 0.5 * len(shares),
    engine=multibody.DEFAULT_ENGINE,
)
