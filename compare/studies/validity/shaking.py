"""Peak tilt over slenderness, size and intensity: recess, its twin, rolling, and with vertical motion."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rockwobble import reduced
from rockwobble.models import Case, Trace

from .extent import Extent
from .motions import motion_named, shaken_case
from .part import Inputs, Part, Row

# the twin's record is stronger by this: what it changes, no model can be asked for
TWIN = 1e-3


def _tasks(extent: Extent) -> Sequence[Inputs]:
    return [
        {"motion": motion, "tan_alpha": tan_alpha, "semidiagonal": size, "intensities": extent.intensities}
        for motion in extent.motions
        for tan_alpha in extent.shaken_tan_alphas
        for size in extent.sizes
    ]


def measure(inputs: Inputs) -> list[Row]:
    """Return one row for each intensity.

    The columns: motion, tan_alpha, semidiagonal [m], intensity; peak tilt over alpha of the recess model,
    its twin under a record stronger by 0.1 %, the flat-ground model, and the recess model with the vertical
    component (NaN where the record has none); pi/2 over alpha if overturned. Needs of the recess model:
    friction, least_normal [weights], couple over weight and base
    radius; NaN where it does not move or overturns.
    """
    return [_row(inputs, intensity) for intensity in inputs["intensities"]]


def _row(inputs: Inputs, intensity: float) -> Row:
    name, tan_alpha, size = inputs["motion"], inputs["tan_alpha"], inputs["semidiagonal"]
    case = shaken_case(name, tan_alpha, size, intensity)
    alpha = case.cylinder.alpha
    recess = _run(case, "recess")
    row: Row = {
        "motion": name,
        "tan_alpha": tan_alpha,
        "semidiagonal": size,
        "intensity": intensity,
        "overturning": 0.5 * math.pi / alpha,
        "recess": recess.peak_tilt / alpha,
        "twin": _run(shaken_case(name, tan_alpha, size, intensity * (1.0 + TWIN)), "recess").peak_tilt
        / alpha,
        "flat": _run(case, "flat").peak_tilt / alpha,
        "vertical": math.nan,
        "friction": math.nan,
        "least_normal": math.nan,
        "couple": math.nan,
    }
    if motion_named(name).acceleration.shape[1] == 3:
        raised = shaken_case(name, tan_alpha, size, intensity, vertical=True)
        row["vertical"] = _run(raised, "recess").peak_tilt / alpha
    if recess.peak_tilt > 0.0 and recess.outcome in ("rest", "completed"):
        needs = recess.assumptions
        assert needs is not None
        row["friction"] = needs.largest_friction_needed
        row["least_normal"] = needs.least_normal_force
        row["couple"] = needs.largest_restraining_moment / case.cylinder.base_radius
    return row


def _run(case: Case, support: str) -> Trace:
    return reduced.simulate(case, support=support, rtol=1e-7)


PART = Part(
    name="shaking",
    title="peak tilt under shaking",
    tasks=_tasks,
    measure=measure,
    cost=lambda inputs: 0.06 * len(inputs["intensities"]),
    module=__name__,
)
