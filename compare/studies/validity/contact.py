"""Contact that gives: energy lost per pass, and what that does to the peak tilt."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from rockwobble import reduced
from rockwobble.models import Case, Run, Trace

from ...runs.execution import simulate_run
from .extent import Extent
from .motions import EL_CENTRO, shaken_case
from .part import Inputs, Part, Row
from .releases import released
from .verification import ENGINE

_RELEASE, _SPIN, _PASSES = 0.5, 0.1, 4
_SIZE, _INTENSITY, _LENGTH = 6.0, 2.0, 10.0
_FRICTION = 3.0


def _tasks(extent: Extent) -> Sequence[Inputs]:
    return [
        {"tan_alpha": tan_alpha, "time_constant": time_constant, "damping": damping}
        for tan_alpha in extent.contact_tan_alphas
        for time_constant, damping in extent.contacts
    ]


def measure(inputs: Inputs) -> list[Row]:
    """Return a row: what guided free response loses, and the peak tilt under El Centro.

    The columns: tan_alpha, time_constant [s] in which contact removes a normal velocity, damping ratio,
    softness, the time constant times the frequency parameter p; loss of energy per pass over the energy of
    the release, passes, peak and recess_peak under El Centro over alpha, free_outcome, outcome.
    """
    settings: dict[str, Any] = {
        "contact_time_constant": inputs["time_constant"],
        "contact_damping_ratio": inputs["damping"],
    }
    cylinder, initial = released(inputs["tan_alpha"], _RELEASE, _SPIN)
    duration = _PASSES * reduced.free_response(cylinder, initial).period
    still = Case(cylinder, initial=initial, duration=duration, friction=_FRICTION, name="free response")
    free = _engine(still, settings)
    shaken = shaken_case(EL_CENTRO, inputs["tan_alpha"], _SIZE, _INTENSITY, duration=_LENGTH)
    run = _engine(shaken, settings)
    recess = reduced.simulate(shaken)
    lost = -float(free.energy_error[-1]) / float(free.energy[0])
    return [
        {
            **inputs,
            "softness": inputs["time_constant"] * _frequency(inputs["tan_alpha"]),
            "loss": lost / max(len(free.passes), 1),
            "passes": len(free.passes),
            "peak": run.peak_tilt / shaken.cylinder.alpha,
            "recess_peak": recess.peak_tilt / shaken.cylinder.alpha,
            "free_outcome": free.outcome,
            "outcome": run.outcome,
        }
    ]


def _engine(case: Case, settings: dict[str, Any]) -> Trace:
    return simulate_run(case, Run(ENGINE, "recess", **settings))


def _frequency(tan_alpha: float) -> float:
    """Frequency parameter p of the homogeneous cylinder of the reference size [1/s]: equation (23)."""
    cos_squared = 1.0 / (1.0 + tan_alpha**2)
    return math.sqrt(12.0 * 9.81 / (_SIZE * (15.0 + cos_squared)))


PART = Part(
    name="contact",
    title="contact that gives, in the engine",
    tasks=_tasks,
    measure=measure,
    cost=lambda inputs: 4.0,
    module=__name__,
    engine=ENGINE,
)
