"""How far the engines are from their models on the suite that ships, as it was measured."""

from __future__ import annotations

from rockwobble.models import Case

from ...comparison.prediction import time_scale

# RMS of the tilt difference [alpha] at a step of 1e-4 s (R = 6 m), from release: 2e-6 tan^2(alpha) was
# measured with both engines on the slender, and from rest 6e-5 to 1.4e-4, which near passes magnify
RELEASED, RELEASED_LEAST = 1e-5, 1e-7
FROM_REST = 5e-4


def tilt_bound(case: Case, time_step: float | None) -> float:
    """Return the largest RMS difference of tilts that the step and its contact explain [alpha]."""
    step = 1.0 if time_step is None else max(1.0, time_step / (1e-4 * time_scale(case)))
    if case.initial is not None and case.initial.tilt > 0.0 and case.motion is None:
        return step * max(RELEASED * case.cylinder.tan_alpha**2, RELEASED_LEAST)
    return step * FROM_REST
