"""What a real recess costs: energy, place and agreement of runs in rings of walls.

Each is held against the recess model, which is the ideal of a ring, and against the flat-ground model.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockwobble.models import Case, Cylinder, InitialState, Run, Trace, el_centro_1940
from rockwobble.multibody.scene.ring_geometry import clearance_needed
from rockwobble.multibody.scene.ring_settings import take_ring

from ...metrics.tilt import tilt_rms_relative
from ...runs.execution import Job, simulate_all
from ...traces.pair import FloatArray, make_pair

# tan(alpha): peak of the record over the acceleration that uplifts. Large motion, and the ground keeps hold
INTENSITIES = ((0.2, 2.0), (1.0, 1.3))
_FRICTION = 3.0  # of the ground: a squat cylinder that uplifts needs more than 1
_LENGTH = 8.0  # [s] of a free response
_RECORD = 15.0  # [s] of the record: the strong part


@dataclass(frozen=True, slots=True, kw_only=True)
class RingRow:
    """One run: which ring, and what it did.

    Attributes
    ----------
    case : str
    support : str
    settings : dict
        Of the ring; empty for the defaults.
    outcome : str
    first_contact, contact_time : float
        First contact with a wall (inf where there is none) and time in contact [s].
    passes : int
    loss : float
        Energy lost over the largest reached.
    rolled_out, at_end : float
        Distance from O of the place on which the cylinder would stand if it came to rest upright, largest
        and last [b].
    residual : float
        Displacement of the base centre at the end [b].
    twist : float
        At the end [rad].
    peak, recess_peak : float
        Peak tilt of the run and of the recess model [alpha].
    against_recess, against_flat : float
        RMS of the tilt difference over that of the model's tilt.
    """

    case: str
    support: str
    settings: dict[str, Any]
    outcome: str
    first_contact: float
    contact_time: float
    passes: int
    loss: float
    rolled_out: float
    at_end: float
    residual: float
    twist: float
    peak: float
    recess_peak: float
    against_recess: float
    against_flat: float


def ring_cases(
    turn: float = 0.0,
    *,
    intensities: Sequence[tuple[float, float]] = INTENSITIES,
    length: float = _LENGTH,
) -> tuple[Case, ...]:
    """Return the cases of the table, turned by an azimuth [rad]: free response and El Centro.

    For each slenderness and intensity, with `length` that of the free response [s].
    """
    cases = []
    record = el_centro_1940()
    for tan_alpha, intensity in intensities:
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        release = InitialState(tilt=0.5 * cylinder.alpha, rolling_angle=turn, rolling_rate=0.5)
        scaled = record.scaled(intensity * tan_alpha * 9.81 / record.peak).rotated(turn)
        name = f"tan alpha {tan_alpha:g}"
        cases += [
            Case(
                cylinder, initial=release, duration=length, friction=_FRICTION, name=f"free response, {name}"
            ),
            Case(cylinder, scaled, duration=_RECORD, friction=_FRICTION, name=f"El Centro, {name}"),
        ]
    return tuple(cases)


def measure(cases: Sequence[Case], runs: Sequence[Run], *, workers: int | None = None) -> list[RingRow]:
    """Run each case with each run, and return one row for each; what a case refuses is left out."""
    rows = []
    for case in cases:
        possible = [run for run in runs if _possible(case, run)]
        methods = [Run(None, "recess"), Run(None, "flat"), *possible]
        jobs = [Job(case=case, run=run, label=str(n)) for n, run in enumerate(methods)]
        recess, flat, *trials = simulate_all(jobs, workers=workers)
        rows += [
            _row(case, run, trial, recess, flat)
            for run, trial in zip(possible, trials, strict=True)
            if len(trial.time)
        ]
    return rows


def _possible(case: Case, run: Run) -> bool:
    """Whether the release is outside of the walls."""
    _, ring = take_ring(run.settings, run.support, case.cylinder.tan_alpha)
    if ring is None or case.initial is None:
        return True
    needed = clearance_needed(case.cylinder, case.initial.tilt, ring.ring_inclination)
    return needed <= ring.ring_clearance


def _row(case: Case, run: Run, trial: Trace, recess: Trace, flat: Trace) -> RingRow:
    out = _rolled_out(trial, case.cylinder.base_radius)
    largest = float(trial.energy.max())
    return RingRow(
        case=case.name,
        support=run.support,
        settings=dict(run.settings),
        outcome=trial.outcome,
        first_contact=trial.first("wall_contact"),
        contact_time=float(trial.wall_contact[-1]),
        passes=len(trial.passes),
        loss=-float(trial.energy_error[-1]) / largest if largest > 0.0 else math.nan,
        rolled_out=float(out.max(initial=0.0)),
        at_end=float(out[-1]) if len(out) else 0.0,
        residual=trial.residual_displacement / case.cylinder.base_radius,
        twist=trial.residual_twist,
        peak=trial.peak_tilt / case.cylinder.alpha,
        recess_peak=recess.peak_tilt / case.cylinder.alpha,
        against_recess=tilt_rms_relative(make_pair(case.cylinder, recess, trial)),
        against_flat=tilt_rms_relative(make_pair(case.cylinder, flat, trial)),
    )


def _rolled_out(trial: Trace, radius: float) -> FloatArray:
    """Distance from O of the place to which a cylinder would come down, while it is tilted [b].

    The contact point less a radius in the direction of the lean: in the recess model that is O.
    """
    lean = np.column_stack([np.cos(trial.rolling_angle), np.sin(trial.rolling_angle)])
    place = trial.contact_point - radius * lean
    distance: FloatArray = np.hypot(place[:, 0], place[:, 1]) / radius
    return distance[np.isfinite(distance)]
