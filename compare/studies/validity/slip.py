"""The friction at which the engine slips, against that which the recess model needs."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rockwobble import multibody, reduced
from rockwobble.models import Case

from ...metrics.tilt import tilt_rms
from ...traces.pair import make_pair
from .extent import Extent
from .free_response import needs_of_one_period
from .part import Inputs, Part, Row
from .releases import released
from .verification import ENGINE

_PERIODS = 1.1  # one pass: the friction of the next is the same


def _tasks(extent: Extent) -> Sequence[Inputs]:
    return [
        {"tan_alpha": tan_alpha, "release": release, "spin": spin, "shares": extent.slip_shares}
        for tan_alpha, release, spin in extent.slip_points
    ]


def measure(inputs: Inputs) -> list[Row]:
    """Return a row for each friction, as a share of what the recess model needs.

    The columns: tan_alpha, release, spin, needed, share, friction, slip of the guided engine in one
    period [b], tilt_rms against the recess model over alpha, outcome. No row where the model loses contact:
    no friction is enough.
    """
    cylinder, initial = released(inputs["tan_alpha"], inputs["release"], inputs["spin"])
    period = reduced.free_response(cylinder, initial).period
    needed = needs_of_one_period(cylinder, initial, period).largest_friction_needed
    if not math.isfinite(needed):
        return []
    duration = _PERIODS * period
    recess = reduced.simulate(Case(cylinder, initial=initial, duration=duration), rtol=1e-10)
    rows = []
    for share in inputs["shares"]:
        run = multibody.simulate(
            Case(cylinder, initial=initial, duration=duration, friction=share * needed), engine=ENGINE
        )
        rows.append(
            {
                "tan_alpha": inputs["tan_alpha"],
                "release": inputs["release"],
                "spin": inputs["spin"],
                "needed": needed,
                "share": share,
                "friction": share * needed,
                "slip": float(run.slip[-1]) / cylinder.base_radius,
                "tilt_rms": tilt_rms(make_pair(cylinder, recess, run)),
                "outcome": run.outcome,
            }
        )
    return rows


PART = Part(
    name="slip",
    title="the friction at which the engine slips",
    tasks=_tasks,
    measure=measure,
    cost=lambda inputs: 0.5 * len(inputs["shares"]),
    module=__name__,
    engine=ENGINE,
)
