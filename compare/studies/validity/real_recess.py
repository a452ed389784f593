"""A real recess, a ring of walls with clearance and inclination, against the ideal one."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rockwobble.models import Case, Run

from .extent import Extent
from .motions import EL_CENTRO, shaken_case
from .part import Inputs, Part, Row
from .ring_losses import RingRow, ring_cases
from .ring_losses import measure as measure_rings
from .verification import ENGINE

# strong rocking without a fall
INTENSITY = 1.5
_SIZE = 6.0
# what stands for no wall at all, and for the ideal recess, in the column of clearances
OPEN, IDEAL = math.inf, 0.0
_MEASURED = (
    "outcome",
    "loss",
    "rolled_out",
    "at_end",
    "residual",
    "twist",
    "peak",
    "recess_peak",
    "contact_time",
)
_SUPPORTS = {OPEN: "flat", IDEAL: "recess"}


def _tasks(extent: Extent) -> Sequence[Inputs]:
    rings = [
        (clearance, inclination)
        for clearance in extent.ring_clearances
        for inclination in extent.ring_inclinations
    ]
    return [
        {
            "tan_alpha": tan_alpha,
            "clearance": clearance,
            "inclination": inclination,
            "turn": turn,
            "length": extent.ring_length,
        }
        for tan_alpha in extent.ring_tan_alphas
        for turn in extent.ring_turns
        for clearance, inclination in [(IDEAL, 0.0), *rings, (OPEN, 0.0)]
    ]


def measure(inputs: Inputs) -> list[Row]:
    """Return a row for free response and one for El Centro.

    The columns: tan_alpha, clearance [b] (0 for the ideal recess, inf for open ground), inclination [rad]
    (0 for alpha), turn [rad], motion, outcome, loss of energy over the largest reached, rolled_out, largest
    distance of the place on which it would come down from O [b], at_end [b], residual displacement of the
    base [b], twist [rad], peak and recess_peak [alpha], contact_time with walls [s].
    """
    run = _run(inputs)
    point = {name: inputs[name] for name in ("tan_alpha", "clearance", "inclination", "turn")}
    return [
        {**point, "motion": "free response" if case.motion is None else EL_CENTRO, **_measured(found)}
        for case in _cases(inputs)
        for found in measure_rings([case], [run], workers=1)
    ]


def _measured(found: RingRow) -> Row:
    return {name: getattr(found, name) for name in _MEASURED}


def _run(inputs: Inputs) -> Run:
    support = _SUPPORTS.get(inputs["clearance"], "ring")
    if support != "ring":
        return Run(ENGINE, support)
    walls = {"ring_clearance": inputs["clearance"]}
    if inputs["inclination"] > 0.0:
        walls["ring_inclination"] = inputs["inclination"]
    return Run(ENGINE, support, **walls)


def _cases(inputs: Inputs) -> list[Case]:
    turn, tan_alpha = inputs["turn"], inputs["tan_alpha"]
    free = ring_cases(turn, intensities=((tan_alpha, INTENSITY),), length=inputs["length"])[0]
    shaken = shaken_case(EL_CENTRO, tan_alpha, _SIZE, INTENSITY, duration=inputs["length"])
    assert shaken.motion is not None
    turned = Case(
        shaken.cylinder,
        shaken.motion.rotated(turn),
        duration=shaken.duration,
        friction=shaken.friction,
        name=shaken.name,
    )
    return [free, turned]


PART = Part(
    name="real_recess",
    title="a ring of walls in the engine",
    tasks=_tasks,
    measure=measure,
    cost=lambda inputs: (0.3 if inputs["clearance"] in _SUPPORTS else 1.0) * inputs["length"],
    module=__name__,
    engine=ENGINE,
)
