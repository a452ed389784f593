"""Rings, recesses with walls and clearance, of several inclinations and frictions, against the ideal one."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState, Run, Trace
from rockwobble.multibody import DEFAULT_ENGINE
from rockwobble.multibody.scene.froude import REFERENCE_TIME_STEP
from rockwobble.multibody.scene.ring_geometry import clearance_needed
from rockwobble.multibody.scene.ring_settings import take_ring

from ...metrics.pair import FloatArray
from ...runs.execution import simulate_run
from .extent import Extent
from .motions import AMPLE, EL_CENTRO, REFERENCE_SIZE, shaken_case
from .part import Inputs, Part, Row

# strong rocking without a fall
INTENSITY = 1.5
FREE, SHAKEN = "free response", EL_CENTRO


def _tasks(extent: Extent) -> Iterable[Inputs]:
    walls = [
        {"clearance": ring.clearance, "inclination": ring.inclination, "friction": ring.friction}
        for ring in extent.rings
    ]
    none = {"clearance": math.nan, "inclination": math.nan, "friction": math.nan}
    for tan_alpha in extent.ring_tan_alphas:
        for turn in extent.ring_turns:
            problem = {"tan_alpha": tan_alpha, "turn": turn, "length": extent.ring_length}
            yield {**problem, "support": "recess", **none}
            yield {**problem, "support": "flat", **none}
            for ring in walls:
                yield {**problem, "support": "ring", **ring}


def measure(
    tan_alpha: float,
    turn: float,
    length: float,
    support: str,
    clearance: float,
    inclination: float,
    friction: float,
) -> list[Row]:
    """Return a row for free response and one for El Centro, where the walls leave room for the release.

    The columns: motion, tan_alpha, turn [rad], support, clearance [b], inclination [rad] (0 for alpha) and
    friction of the walls, those of `losses`; recess_peak, and halved_peak, that of the same ring at half the
    step [alpha].
    """
    walls: dict[str, float] = {}
    if support == "ring":
        walls = {"ring_clearance": clearance, "ring_friction": friction}
        walls |= {"ring_inclination": inclination} if inclination > 0.0 else {}
    release = release_of(tan_alpha, turn, length)
    shaken = shaken_case(EL_CENTRO, tan_alpha, REFERENCE_SIZE, INTENSITY, duration=length, turn=turn)
    rows: list[Row] = []
    for motion, case in ((FREE, release), (SHAKEN, shaken)):
        run = Run(DEFAULT_ENGINE, support, REFERENCE_TIME_STEP, **walls)
        if not has_room(case, run):
            continue
        halved = math.nan
        if support == "ring":
            finer = Run(DEFAULT_ENGINE, support, 0.5 * REFERENCE_TIME_STEP, **walls)
            halved = simulate_run(case, finer).peak_tilt / case.cylinder.alpha
        rows.append(
            {
                "motion": motion,
                "tan_alpha": tan_alpha,
                "turn": turn,
                "support": support,
                "clearance": clearance,
                "inclination": inclination,
                "friction": friction,
                **losses(simulate_run(case, run)),
                "recess_peak": reduced.simulate(case).peak_tilt / case.cylinder.alpha,
                "halved_peak": halved,
            }
        )
    return rows


def release_of(tan_alpha: float, turn: float, length: float) -> Case:
    """Return a release at alpha/2 in an azimuth [rad], of so long [s]."""
    cylinder = Cylinder(semidiagonal=REFERENCE_SIZE, tan_alpha=tan_alpha)
    initial = InitialState(tilt=0.5 * cylinder.alpha, rolling_angle=turn, rolling_rate=0.5)
    return Case(cylinder, initial=initial, duration=length, friction=AMPLE, name=FREE)


def has_room(case: Case, run: Run) -> bool:
    """Return whether the release is outside of the walls."""
    _, ring = take_ring(run.settings, run.support, case.cylinder.tan_alpha)
    if ring is None or case.initial is None:
        return True
    return clearance_needed(case.cylinder, case.initial.tilt, ring.ring_inclination) <= ring.ring_clearance


def losses(trace: Trace) -> Row:
    """Return the losses of a run in a recess of any kind.

    outcome; first_contact with a wall (inf where there is none) and contact_time [s]; passes; loss of energy
    over the largest reached; rolled_out and at_end, distance from O of the place on which the cylinder would
    come down, largest and last [b]; residual displacement of the base [b]; twist at the end [rad]; peak
    [alpha].
    """
    largest, out = float(trace.energy.max()), _rolled_out(trace)
    return {
        "outcome": trace.outcome,
        "first_contact": trace.first("wall_contact"),
        "contact_time": float(trace.wall_contact[-1]),
        "passes": len(trace.passes),
        "loss": -float(trace.energy_error[-1]) / largest if largest > 0.0 else math.nan,
        "rolled_out": float(out.max(initial=0.0)),
        "at_end": float(out[-1]) if len(out) else 0.0,
        "residual": trace.residual_displacement / trace.case.cylinder.base_radius,
        "twist": trace.residual_twist,
        "peak": trace.peak_tilt / trace.case.cylinder.alpha,
    }


def _rolled_out(trace: Trace) -> FloatArray:
    """Distance from O of the place to which a cylinder would come down, while it is tilted [b].

    The contact point less a radius in the direction of the lean: in the recess model that is O.
    """
    radius = trace.case.cylinder.base_radius
    lean = np.column_stack([np.cos(trace.rolling_angle), np.sin(trace.rolling_angle)])
    place = trace.contact_point - radius * lean
    distance: FloatArray = np.hypot(place[:, 0], place[:, 1]) / radius
    return distance[np.isfinite(distance)]


PART = Part(
    name="rings",
    title="a ring of walls in the engine",
    tasks=_tasks,
    measure=measure,
    keys=(),
    cost=lambda support, length, **_: (0.8 if support == "ring" else 0.25) * length,
    engine=DEFAULT_ENGINE,
)
