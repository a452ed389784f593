"""No slip, in every state of every model: the material point at the contact has no velocity.

The pose of the body is put together from the samples of a trace alone. Its velocity is a central difference
over one sample step and over two: of a smooth motion without slip the first is a quarter of the second, so
that their difference bounds it, whatever the motion. A contact that moves while the rim does not roll, or
otherwise than it rolls, keeps its velocity in both.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState, Trace, WobblingFrame, el_centro_1940

PIER = Cylinder(semidiagonal=1.0, tan_alpha=0.2)
BODIES = {"cylinder": PIER, "frame": WobblingFrame(PIER, 1.5)}
MODELS: dict[str, dict[str, Any]] = {"recess": {}, "flat": {"support": "flat"}, "planar": {"plane": 0.3}}
# of b/sample step: rounding of positions in a central difference
ROUNDING = 1e-13
RESOLVED = 0.05  # azimuth [rad] of the contact from one sample to the next
Array = NDArray[np.float64]


def rotations(trace: Trace) -> Array:
    """Return the matrices (n, 3, 3) from the axes of the body to those of the world."""
    # phi + psi is the twist, so psi turns the body about its axis
    angles = [trace.rolling_angle, trace.tilt, trace.twist - trace.rolling_angle]
    return np.asarray(Rotation.from_euler("ZYZ", np.transpose(angles)).as_matrix())


def slip_velocities(trace: Trace) -> tuple[Array, Array]:
    """Velocity of the material point at the contact (n - 4, 3) [m/s], and its error."""
    step = float(trace.time[1] - trace.time[0])
    turned, centre = rotations(trace), trace.centre_of_mass
    contact = np.column_stack([trace.contact_point, np.zeros(len(trace.time))])
    arm = np.einsum("nji,nj->ni", turned, contact - centre)  # in the axes of the body

    def difference(apart: int) -> Array:
        here = slice(2, len(arm) - 2)

        def place(offset: int) -> Array:
            there = slice(2 + offset, len(arm) - 2 + offset)
            return np.asarray(centre[there] + np.einsum("nij,nj->ni", turned[there], arm[here]))

        return (place(apart) - place(-apart)) / (2.0 * apart * step)

    near, far = difference(1), difference(2)
    return near, np.abs(near - far).max(axis=1)


def smooth(trace: Trace) -> NDArray[np.bool_]:
    """Mask (n - 4,) of samples in smooth motion, away from landings."""
    step = float(trace.time[1] - trace.time[0])
    landings = trace.extrema[trace.extrema[:, 1] <= 0.0, 0]
    # a speed below the tolerance stops or begins at once: its rates jump
    still = trace.tilt_rate == 0.0
    stops = trace.time[1:][still[1:] != still[:-1]]
    events = np.concatenate([[trace.uplift_time], trace.rest_intervals.ravel(), landings, stops])
    events = np.sort(events[np.isfinite(events)])
    # a pass within 1e-5 alpha of the ground may turn the contact by more than a radian from sample to sample
    moves = np.isfinite(trace.rolling_angle) & (np.abs(trace.rolling_rate) * step < RESOLVED)
    moves = np.logical_and.reduce([moves[i : len(moves) - 4 + i] for i in range(5)])
    time = trace.time[2:-2]
    before = np.searchsorted(events, time - 3.0 * step)
    after = np.searchsorted(events, time + 3.0 * step)
    return np.asarray(moves & (before == after))


def cases(body: Cylinder, share: float) -> list[Case]:
    """Return a record with uplifts, and releases that wobble, stop, pivot and stand on the rim."""
    length = share * body.base_radius
    starts = [InitialState(0.9 * body.alpha, rolling_rate=2.0), InitialState(0.5 * body.alpha, 0.1, 0.3)]
    if share:  # the couple holds it on its rim, at once or after it has stopped
        starts += [InitialState(0.97 * body.alpha, 1e-3, 0.0, 0.05), InitialState(0.97 * body.alpha)]
    releases = [Case(body, initial=start, duration=2.0, rolling_resistance=length) for start in starts]
    return [Case(body, el_centro_1940().scaled(2.0), duration=4.0, rolling_resistance=length), *releases]


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.0, 0.02, 0.1])
@pytest.mark.parametrize("kind", BODIES)
@pytest.mark.parametrize("model", MODELS)
def test_the_point_at_the_contact_stands_still(model: str, kind: str, share: float) -> None:
    moving = 0
    for case in cases(BODIES[kind], share):
        if model == "planar" and case.initial is not None:
            tilt = case.initial.tilt
            case = Case(
                case.cylinder,
                initial=InitialState(tilt, 0.0, MODELS[model]["plane"]),
                duration=case.length,
                rolling_resistance=case.rolling_resistance,
            )
        trace = reduced.simulate(case, rtol=1e-10, sample_step=2e-4, **MODELS[model])
        checked = smooth(trace)
        velocity, error = (values[checked] for values in slip_velocities(trace))
        # rounding of positions, and the error of the solution where the couple reverses at small tilts
        allowed = 2.0 * error + (ROUNDING / 2e-4 + 1e-6) * trace.case.cylinder.base_radius
        size = np.abs(velocity).max(axis=1)
        assert (size <= allowed).all(), (case, trace.time[2:-2][checked][np.argmax(size - allowed)])
        moving += int(checked.sum())
    assert moving > 5000
