"""Layer exact, second part: the exact solutions that users call, against runs and against quadratures."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rockwobble.models import Case, Cylinder, InitialState, Trace

from ..bench import Bench
from ..finding import Bound, Finding, none_wrong, worst_of
from ..models import quadrature
from ..models.lagrange import shape_of
from ..problems import PIER

WEAKER = 9.0  # [m/s^2]
OWN = Cylinder(semidiagonal=2.0, tan_alpha=0.6, height=3.0, transverse_inertia=1.1, axial_inertia=0.7)
SQUAT = Cylinder(semidiagonal=4.0, tan_alpha=1.0)
# tilt over alpha, tilt rate and rolling rate: swinging down and up, faster than steady wobble, backwards
RELEASES: tuple[tuple[Cylinder, float, float, float], ...] = (
    (PIER, 0.5, 0.0, 1.2),
    (PIER, 0.3, 0.05, -0.4),
    (SQUAT, 0.4, -0.3, 0.8),
    (OWN, 0.6, 0.2, -0.5),
    (PIER, 0.4, 0.06, 0.0),
)
RATES = tuple(0.02 * k for k in range(-14, 15))  # [rad/s] of the tilt, some of which overturn
RUN = Bound(1e-10, "a run at a tolerance of 1e-12, of which a pass magnifies the error")
CLOSED = Bound(1e-8, "quadrature of the energies, and J from B at 1e-4 rad: 2e-9 was measured")
PART = "exact solutions (reduced/exact)"


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    errors = {
        f"{what}, release {number}": error
        for number, release in enumerate(RELEASES, 1)
        for what, error in _response(bench, *release)
    }
    yield worst_of(f"exact responses to {len(RELEASES)} releases, against runs", errors, RUN, PART)
    yield _falls(bench)
    yield worst_of("exact periods and rates", _periods(bench), CLOSED, PART)


def _response(
    bench: Bench, cylinder: Cylinder, share: float, tilt_rate: float, spin: float
) -> Iterator[tuple[str, float]]:
    """Yield by how much each number of an exact response is off one of a run."""
    initial = InitialState(share * cylinder.alpha, tilt_rate=tilt_rate, rolling_rate=spin)
    exact = bench.reduced.free_response(cylinder, initial, gravity=WEAKER)
    case = Case(cylinder, initial=initial, duration=3.5 * exact.period, gravity=WEAKER)
    trace = _run(bench, case, "planar" if spin == 0.0 else "recess")
    highest = trace.extrema[trace.extrema[:, 3] > 0.0]
    lowest = trace.extrema[trace.extrema[:, 3] < 0.0]
    # of a release at a turning tilt the first is no extremum of the run
    (first, second), lower = highest[-2:], lowest[-1]
    between = lowest[(lowest[:, 0] > first[0]) & (lowest[:, 0] < second[0])][0]
    yield "largest tilt", exact.maximum_tilt / second[1] - 1.0
    yield "smallest tilt", (exact.minimum_tilt - lower[1]) / second[1]
    yield "period", exact.period / (second[0] - first[0]) - 1.0
    yield "half period", exact.half_period / (between[0] - first[0]) - 1.0
    yield "energy", exact.energy / trace.energy[0] - 1.0
    shape = replace(shape_of(cylinder), g=WEAKER)
    momentum = quadrature.turn_inertia(shape, np.array([initial.tilt]))[0] * spin
    yield "momentum", exact.angular_momentum - momentum
    if spin:
        yield "angle of turn", exact.angle_of_turn - (second[2] - first[2])
        yield (
            "the same on its own",
            bench.reduced.angle_of_turn(cylinder, initial, gravity=WEAKER) - (second[2] - first[2]),
        )


def _falls(bench: Bench) -> Finding:
    """Hold which releases fall by the exact solution, which then has no next maximum, against runs."""
    wrong, fallen = [], 0
    for spin in (0.0, 0.3):
        for rate in RATES:
            initial = InitialState(0.5 * PIER.alpha, tilt_rate=rate, rolling_rate=spin)
            case = Case(PIER, initial=initial, duration=12.0)
            falls = _run(bench, case, "recess" if spin else "planar").outcome == "overturned"
            fallen += falls
            if falls != _has_no_maximum(bench, initial):
                wrong.append(f"{rate:g} rad/s outward, {spin:g} rad/s of spin")
    name = "releases of which run and exact solution disagree"
    return none_wrong(name, wrong, "a fall has no next maximum", PART, made=0 < fallen < 2 * len(RATES))


def _has_no_maximum(bench: Bench, initial: InitialState) -> bool:
    try:
        bench.reduced.free_response(PIER, initial)
    except ValueError:
        return True
    return False


def _periods(bench: Bench) -> dict[str, float]:
    """Return by how much closed forms are off quadratures, of several tilts at once and of one."""
    shape = replace(shape_of(OWN), g=WEAKER)
    tilts = OWN.alpha * np.array([0.2, 0.5, 0.9])
    rates = np.array([quadrature.steady_rate(shape, tilt) for tilt in tilts])
    quarters = np.array([quadrature.planar_quarter(shape, tilt) for tilt in tilts])
    limit = math.pi * math.sqrt(quadrature.tilt_inertia(shape) / quadrature.cone_inertia(shape))
    expected = {
        "steady_wobble_rate": rates,
        "wobbling_period": 2.0 * math.pi / rates,
        "planar_quarter_period": quarters,
        "rocking_period": 4.0 * quarters,
    }
    errors = {"limiting_angle_of_turn": bench.reduced.limiting_angle_of_turn(OWN) / limit - 1.0}
    for name, values in expected.items():
        function = getattr(bench.reduced, name)
        errors[name] = float(np.abs(function(OWN, tilts, gravity=WEAKER) / values - 1.0).max())
        errors[f"{name} of one"] = float(function(OWN, float(tilts[1]), gravity=WEAKER)) / values[1] - 1.0
    return errors


def _run(bench: Bench, case: Case, model: str) -> Trace:
    return bench.solve(case, model, rtol=1e-12, rest_tilt=0.0)
