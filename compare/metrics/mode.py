"""Findings on the mode of motion, which precede all others in an answer."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from rockwobble.models import Case
from rockwobble.models.finding import Finding, Value
from rockwobble.models.mode import BORDER, REST, ROCKS_AND_SLIDES, SLIDES, expected_mode, wall_force
from rockwobble.models.support import support_named

_KEYS = {SLIDES: "mode.slides", ROCKS_AND_SLIDES: "mode.rocks_and_slides", REST: "mode.rest"}


def mode_findings(
    case: Case, support: str, *, friction_given: bool = True, named: bool = False
) -> Iterator[Finding]:
    """Findings on the mode of a case on a support: both modes near a border, and the effect of walls.

    Parameters
    ----------
    case : Case
    support : str
    friction_given : bool, optional
        Whether the friction of the case is known, not a default.
    named : bool, optional
        Whether to name the support, as one of several.
    """
    mode, border = expected_mode(case, support), case.friction_of_uplift
    given = case.friction if friction_given else math.nan
    where: dict[str, Value] = {"reason": str(support) if named else None}
    values = where | {"given": given, "bound": border, "demand": case.friction_at_rest}
    yield Finding(key=_KEYS.get(mode, f"mode.{mode.replace(' ', '_')}"), values=values)
    if case.is_release or not friction_given:
        return
    if not support_named(support).lets_slide:
        force = wall_force(case)
        if force > 0.0:
            yield Finding(key="mode.walls", values=where | {"given": given, "bound": border, "force": force})
    elif border / BORDER < given < border and mode == SLIDES and case.uplifts:
        yield Finding(key="mode.border", level="caution", values={"given": given, "bound": border})


def slide_finding(peak: float, residual: float, copies: Sequence[Sequence[float]] = ()) -> Finding:
    """Finding of the peak and the residual displacement [m].

    Parameters
    ----------
    peak, residual : float
        [m]
    copies : sequence, shape (n, 2), optional
        Both of perturbed copies, for the interval of 95 % of them.
    """
    low, high = np.quantile(copies, [0.025, 0.975], axis=0) if len(copies) else np.full((2, 2), np.nan)
    names = ("displacement", "displacement_end")
    values: dict[str, Value] = {
        name: (value, float(least), float(most)) if math.isfinite(least) else value
        for name, value, least, most in zip(names, (peak, residual), low, high, strict=True)
    }
    return Finding(key="mode.slide", values=values)
