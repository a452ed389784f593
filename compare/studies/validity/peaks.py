"""Peak tilts of the reduced models over records, slenderness, size and intensity, and what a recess needs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from rockwobble import reduced
from rockwobble.models import Case, Trace

from .extent import LARGEST_PEAK, Extent
from .motions import EL_CENTRO, motion_named, record_names, shaken_case
from .part import Inputs, Part, Row

# the record of the perturbed copy is stronger by this: no record is known better, and no model can be asked
# for more than what it changes
COPY = 0.01
_RTOL = 1e-7


def _tasks(extent: Extent) -> Iterable[Inputs]:
    # El Centro besides, which has a vertical component
    for motion in [*record_names(extent.members), EL_CENTRO]:
        for tan_alpha in extent.shaken_tan_alphas:
            for size in extent.sizes:
                yield {
                    "motion": motion,
                    "tan_alpha": tan_alpha,
                    "semidiagonal": size,
                    "intensities": tuple(i for i in extent.intensities if i * tan_alpha <= LARGEST_PEAK),
                }


def measure(motion: str, tan_alpha: float, semidiagonal: float, intensities: Sequence[float]) -> list[Row]:
    """Return one row for each intensity.

    The columns: motion, tan_alpha, semidiagonal [m], intensity; peak tilt over alpha, pi/2 over alpha if
    overturned, of the recess model, of its perturbed copy under a record stronger by 1 %, of the flat-ground
    model, and of the recess model with the vertical component (NaN where the record has none). Needs of the
    recess model: friction, least_normal [weights], moment, the restraining moment over weight and base
    radius; NaN where it does not move or overturns.
    """
    return [_row(motion, tan_alpha, semidiagonal, intensity) for intensity in intensities]


def _row(motion: str, tan_alpha: float, size: float, intensity: float) -> Row:
    case = shaken_case(motion, tan_alpha, size, intensity)
    recess = _run(case)
    stronger = shaken_case(motion, tan_alpha, size, intensity * (1.0 + COPY))
    found = {"recess": recess, "copy": _run(stronger), "flat": _run(case, "flat")}
    if motion_named(motion).acceleration.shape[1] == 3:
        found["vertical"] = _run(shaken_case(motion, tan_alpha, size, intensity, vertical=True))
    row: Row = {
        "intensity": intensity,
        "vertical": math.nan,
        **{name: trace.peak_tilt / case.cylinder.alpha for name, trace in found.items()},
        "friction": math.nan,
        "least_normal": math.nan,
        "moment": math.nan,
    }
    if recess.peak_tilt > 0.0 and recess.outcome == "stands":
        needs = recess.assumptions
        assert needs is not None
        row["friction"] = needs.largest_friction_needed
        row["least_normal"] = needs.least_normal_force
        row["moment"] = needs.largest_restraining_moment / case.cylinder.base_radius
    return row


def _run(case: Case, support: str = "recess") -> Trace:
    return reduced.simulate(case, support=support, rtol=_RTOL)


PART = Part(
    name="peaks",
    title="peak tilt over records",
    tasks=_tasks,
    measure=measure,
    keys=("motion", "tan_alpha", "semidiagonal"),
    cost=lambda intensities, **_: 0.03 * len(intensities),
)
