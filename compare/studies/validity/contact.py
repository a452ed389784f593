"""Soft contact: energy lost per pass, and what that does to the peak tilt."""

from __future__ import annotations

from collections.abc import Iterable

from rockwobble import reduced
from rockwobble.models import Run
from rockwobble.multibody import DEFAULT_ENGINE
from rockwobble.reduced.body import body_of

from ...runs.execution import simulate_run
from .extent import Extent
from .motions import EL_CENTRO, REFERENCE_SIZE, release_case, shaken_case
from .part import Inputs, Part, Row

_RELEASE, _SPIN, _PASSES = 0.5, 0.1, 4
_INTENSITY, _LENGTH = 2.0, 10.0


def _tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha in extent.contact_tan_alphas:
        for time_constant in extent.time_constants:
            for damping in extent.dampings:
                yield {"tan_alpha": tan_alpha, "time_constant": time_constant, "damping": damping}


def measure(tan_alpha: float, time_constant: float, damping: float) -> list[Row]:
    """Return a row: what free response in a recess loses, and the peak tilt under El Centro.

    The columns: tan_alpha, time_constant [s] in which contact removes a normal velocity, damping ratio,
    softness, the time constant times the frequency parameter p; loss of energy per pass over the energy of
    the release, passes, peak and recess_peak under El Centro over alpha, free_outcome, outcome.
    """
    run = Run(DEFAULT_ENGINE, "recess", contact_time_constant=time_constant, contact_damping_ratio=damping)
    free = simulate_run(release_case(tan_alpha, _RELEASE, _SPIN, _PASSES), run)
    case = shaken_case(EL_CENTRO, tan_alpha, REFERENCE_SIZE, _INTENSITY, duration=_LENGTH)
    shaken, recess = simulate_run(case, run), reduced.simulate(case)
    lost = -float(free.energy_error[-1]) / float(free.energy[0])
    return [
        {
            "softness": time_constant * body_of(case.cylinder, case.gravity).p,
            "loss": lost / max(len(free.passes), 1),
            "passes": len(free.passes),
            "peak": shaken.peak_tilt / case.cylinder.alpha,
            "recess_peak": recess.peak_tilt / case.cylinder.alpha,
            "free_outcome": free.outcome,
            "outcome": shaken.outcome,
        }
    ]


PART = Part(
    name="contact",
    title="contact that gives, in the engine",
    tasks=_tasks,
    measure=measure,
    keys=("tan_alpha", "time_constant", "damping"),
    cost=lambda **_: 1.0,
    engine=DEFAULT_ENGINE,
)
