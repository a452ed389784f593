"""Layer: whether the engines still follow the reduced models on a suite.

Guided engines are held against the recess model, those on open ground against the flat-ground model. A ring
of walls has no model of its own: until the first touch of a wall it is open ground, and after it only
what every motion in a recess must show is asked for.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from rockwobble.models import Case, Run

from ...comparison.prediction import Prediction, estimated_error, predict, time_scale, verdict
from ...metrics.agreement import agreement_time
from ...metrics.tilt import tilt_rms
from ...runs.choice import own_model
from ...traces.pair import make_pair
from ..bench import Bench, crashed, why
from ..finding import Finding, at_most, not_run
from . import engine_settings, stated_bounds

LAYER = "agreement"
# RMS of the tilt difference [alpha] at a step of 1e-4 s (R = 6 m), from release: 2e-6 tan^2(alpha) was
# measured with both engines on the slender, and from rest 6e-5 to 1.4e-4, which near passes magnify
RELEASED, RELEASED_LEAST = 1e-5, 1e-7
FROM_REST = 5e-4
# a ring gives back what it takes up in wobble, but for what friction at the walls takes: 9 % was measured
RING_LOSS = 0.3
RING_PLACE = 0.05  # of b; the wall stands back by a thousandth, and leans


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer."""
    if bench.shipped:
        yield from engine_settings.check(bench)
    responses: dict[tuple[str, str], Any] = {}
    for case, run, label, trajectory in bench.rows():
        model = model_of(bench, run)
        key = case.name, model
        if key not in responses:
            responses[key] = bench.response(case, model)
        yield from check_run(bench, case, run, label, trajectory, responses[key])


def model_of(bench: Bench, run: Run) -> str:
    """Return the reduced model that a run is held against."""
    if bench.suite.bounds is not None:
        return stated_bounds.reference_of(bench.suite.bounds, run)
    return own_model(run).support


def check_run(
    bench: Bench, case: Case, run: Run, label: str, trajectory: Any, response: Any
) -> Iterator[Finding]:
    """Yield the findings on one engine run; `response` is that of `model_of`."""
    model = model_of(bench, run)
    name = f"{case.name}, {label} against {model}"
    if crashed(trajectory):
        yield at_most(
            LAYER,
            name,
            math.nan,
            tilt_bound(case, None),
            unit="alpha",
            reason="the run must reach its end",
            part=f"contact of {run.engine} ({run.support}): the run failed",
            note=why(trajectory),
        )
        return
    prediction = predict(
        case,
        reference=response,
        own=response,
        contact_resolution=trajectory.contact_resolution,
        error=estimated_error(case, run.engine, trajectory.time_step),
        simulate=lambda other, run: bench.response(other, run.support),
    )
    if bench.suite.bounds is not None:
        yield from stated_bounds.check(bench.suite.bounds, case, run, label, trajectory, response, prediction)
        return
    until = None
    if run.support == "ring":
        yield from _ring(case, label, trajectory)
        if math.isfinite(trajectory.first("wall_contact")):
            until = trajectory.first("wall_contact")
    yield _by_rule(case, run, name, response, trajectory, prediction, until)


def _by_rule(
    case: Case,
    run: Run,
    name: str,
    response: Any,
    trajectory: Any,
    prediction: Prediction,
    until: float | None,
) -> Finding:
    """Return the finding where the suite states no bounds."""
    pair = make_pair(case.cylinder, response, trajectory, until=case.length if until is None else until)
    horizon = agreement_time(pair)
    # what near passes have magnified says nothing: half of the way to where the traces have to part
    end = min(pair.end, pair.start + 0.5 * prediction.length) if prediction.reason else pair.end
    part = f"{run.engine} ({run.support}), its contact and step, or the reduced model"
    lifted = [math.isfinite(trace.uplift_time) for trace in (response, trajectory)]
    if not any(lifted) or end <= pair.start:
        reason = "neither uplifts" if not any(lifted) else "traces have to part at once"
        return not_run(LAYER, name, part=part, note=f"{reason}: there is nothing to compare")
    words = verdict(horizon.length, horizon.diverged, prediction.length, prediction.reason)
    return at_most(
        LAYER,
        name,
        tilt_rms(make_pair(case.cylinder, response, trajectory, until=end)),
        tilt_bound(case, trajectory.time_step),
        unit="alpha",
        reason="error of contact at this step, first order in it",
        part=part,
        note=f"to {end:.3g} s" + (f"; they part {words}" if horizon.diverged else ""),
    )


def tilt_bound(case: Case, time_step: float | None) -> float:
    """Return the largest RMS difference of tilts that the step and its contact explain [alpha]."""
    step = 1.0 if time_step is None else max(1.0, time_step / (1e-4 * time_scale(case)))
    if case.initial is not None and case.initial.tilt > 0.0 and case.motion is None:
        return step * max(RELEASED * case.cylinder.tan_alpha**2, RELEASED_LEAST)
    return step * FROM_REST


def _ring(case: Case, label: str, trajectory: Any) -> Iterator[Finding]:
    from ...metrics.energy import energy_loss

    touched = trajectory.first("wall_contact")
    note = f"first touch at {touched:.3g} s" if math.isfinite(touched) else "no wall was touched"
    yield at_most(
        LAYER,
        f"{case.name}, {label}: share of the energy lost",
        abs(energy_loss(trajectory, case.motion)),
        RING_LOSS,
        reason="walls that only hold the cylinder in place; 0.09 was measured",
        part="ring: inclination, friction or clearance of its walls",
        note=note,
    )
    yield at_most(
        LAYER,
        f"{case.name}, {label}: base centre away from its place",
        trajectory.residual_displacement / case.cylinder.base_radius,
        RING_PLACE,
        unit="b",
        reason="clearance of the walls, and 1 - cos of the tilt at the end",
        part="ring: its walls let the cylinder out",
        note=note,
    )
