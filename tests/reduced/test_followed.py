"""A swing that goes on when a run ends counts to its next maximum, over still ground."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from shaken_problems import Problem, problem

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SAME = 1e-7  # of the peak: steps of tolerance 1e-9 that end elsewhere, over some swings
LEAST = 1e-8  # [rad] a smaller tilt has a thousand passes in the time that is compared
MODELS: dict[str, dict[str, Any]] = {
    "recess": {},
    "flat": {"support": "flat"},
    "planar": {"plane": 0.4},
    "planar with impacts": {"plane": 0.4, "restitution": "momentum"},
}


def cut(seed: int) -> Problem:
    """A shaken problem whose record ends with a sample that is not zero."""
    given = problem(seed, sizes=(1.0, 50.0), slenderness=(0.08, 0.6))
    share = np.random.default_rng(seed).uniform(0.2, 0.6)
    acceleration = given.motion.acceleration[: round(share * len(given.motion.acceleration))]
    return given._replace(motion=GroundMotion(acceleration, given.motion.time_step))


def solve(given: Problem, model: str, still: float = 0.0, **options: Any) -> Trace:
    case = Case(given.cylinder, given.motion, duration=given.motion.duration + still)
    return reduced.simulate(case, **{"rtol": 1e-9, "sample_step": 0.05, **MODELS[model], **options})


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS)
def test_still_ground_after_the_record_changes_no_peak(model: str) -> None:
    higher, later = 0, 0
    for seed in range(30):
        given = cut(seed)
        short = solve(given, model)
        # the same in a grid
        size, tan_alpha = given.cylinder.semidiagonal, given.cylinder.tan_alpha
        (peak,) = reduced.peak_tilts([size], tan_alpha, given.motion, [1.0], rtol=1e-9, **MODELS[model])[0]
        assert peak == short.peak_tilt, seed
        if given.chatters:
            continue
        long = solve(given, model, 10.0)
        assert (short.outcome, short.peak_tilt == 0.0) == (long.outcome, long.peak_tilt == 0.0), seed
        if short.outcome == "overturned" or short.peak_tilt == 0.0:
            continue
        assert short.time[-1] == given.motion.duration
        assert short.peak_tilt == pytest.approx(long.peak_within_run, rel=SAME, abs=LEAST), seed
        higher += short.peak_within_run < 0.98 * short.peak_tilt
        if not short.rests:
            later += 1
            ends = np.array([*long.extrema[long.extrema[:, 3] > 0.0, 0], *long.rest_intervals[:, 0]])
            end = ends[ends > given.motion.duration].min()
            assert short.followed_until == pytest.approx(end, rel=SAME), seed
        for still in (1e-4, 0.1, 1.3):
            assert solve(given, model, still).peak_tilt == pytest.approx(
                short.peak_tilt, rel=SAME, abs=LEAST
            ), seed
    assert higher > 3
    assert later > 10


def test_motion_past_its_maximum_over_still_ground_or_at_rest_is_not_followed() -> None:
    released = Case(PIER, initial=InitialState(0.5 * PIER.alpha, rolling_rate=0.5), duration=0.1)
    weak = Case(PIER, el_centro_1940().scaled(0.3))
    for case in (released, weak):
        assert math.isnan(reduced.simulate(case).followed_until)
    assert not reduced.simulate(released).rests
    assert reduced.simulate(weak).rests


@pytest.mark.parametrize(("size", "tan_alpha", "scale", "end", "peak"), [
    (24.7, 0.1751, 1.312, 5.42, 0.0668),
    (4.446, 0.2457, 3.234, 2.94, 0.646),
])  # fmt: skip
def test_peaks_of_el_centro_cut_in_the_middle_of_a_swing(
    size: float, tan_alpha: float, scale: float, end: float, peak: float
) -> None:
    # three digits from another code's integration over still ground
    cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    trace = reduced.simulate(Case(cylinder, el_centro_1940().scaled(scale), duration=end))
    assert trace.peak_tilt / cylinder.alpha == pytest.approx(peak, abs=6e-4 * peak + 5e-5)
