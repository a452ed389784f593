"""Guard of an engine run: conditions that must hold at every step, whatever the engine itself says.

An engine that diverges does not always say so: explicit contact gains energy silently. Each check
returns the first step that breaks it and why; a run is cut there and its outcome is "failed".

The limits are far above what a sound run shows and far below what would change a result unseen: a
sound run at the default step gains 1e-6 of the energy of its motion, and sinks in by 1e-6 b.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..body import Body
from ..kinematics import Kinematics
from ..protocol import Wall

Array = NDArray[np.float64]

ENERGY_GAIN = 0.02  # of the largest energy of the motion so far
# of the energy at which the cylinder stands on its rim in balance: a base that is just about to open has no
# energy yet, and what its contact gains or loses there is noise
_LEAST_ENERGY = 0.05
PENETRATION = 0.01  # of b
GUIDE_TWIST = 0.02  # [rad] about one degree
LARGEST_STEP = 1e-3  # [s] at the reference size; contact needs it ten times shorter than the fastest pass
SMALLEST_STEP = 1e-9  # [s] there; below it what a step changes is lost in rounding


@dataclass(frozen=True, slots=True)
class Breach:
    """The first step that breaks a rule, and the code of its `Diagnostic`."""

    index: int
    code: str


def energy_scale(body: Body, gravity: float) -> float:
    """Return g (R - h): what it takes to raise the mass centre over the rim [m^2/s^2]."""
    b, h = body.base_radius, body.mass_centre_height
    # R - h = b^2/(R + h), which does not cancel for slender bodies
    return gravity * b * b / (float(np.hypot(b, h)) + h)


def check_time_step(time_step: float, unit_time: float) -> None:
    """Refuse a time step [s] that no contact can follow, or that is lost in rounding.

    Raises
    ------
    ValueError
        Saying what is allowed for this size and gravity.
    """
    if time_step > LARGEST_STEP * unit_time * (1.0 + 1e-9):
        raise ValueError(
            f"time_step must be at most {LARGEST_STEP * unit_time:.3g} s for contact at this size and "
            f"gravity, got {time_step:g}"
        )
    if time_step < SMALLEST_STEP * unit_time:
        raise ValueError(
            f"time_step must be at least {SMALLEST_STEP * unit_time:.3g} s, where rounding is still small, "
            f"got {time_step:g}"
        )


def first_breach(
    state: Kinematics,
    energy_error: Array,
    body: Body,
    gravity: float,
    in_recess: bool,
    wall: Wall | None = None,
    largest: float = 0.0,
) -> Breach | None:
    """Return the earliest breach among n steps, or None.

    `largest` is the energy that the motion had at most before them [m^2/s^2].
    """
    least = max(largest, _LEAST_ENERGY * energy_scale(body, gravity))
    finite = np.isfinite(state.tilt) & np.isfinite(state.energy)
    with np.errstate(invalid="ignore"):
        reached = np.maximum(np.maximum.accumulate(state.energy), least)
        rules = [
            (~finite, "not_finite"),
            (energy_error > ENERGY_GAIN * reached, "energy_gain"),
            (state.depth > PENETRATION * body.base_radius, "penetration"),
        ]
        if wall is not None:
            rules.append((wall.depth > PENETRATION * body.base_radius, "wall_penetration"))
        if in_recess:
            rules.append((np.abs(state.twist) > GUIDE_TWIST, "guide"))
    breaches = [Breach(int(np.argmax(broken)), code) for broken, code in rules if broken.any()]
    return min(breaches, key=lambda breach: breach.index, default=None)
