"""Layer properties, second part: turning points, peaks and passes against densely sampled tilts.

Where the tilt turns follows from its samples alone: the vertex of the polynomial through those around a
change of direction. The samples are a four-hundredth of the time scale of the motion apart, so that the
polynomial is exact to rounding.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace

from ..bench import Array, Bench, largest
from ..finding import Bound, Finding, at_most
from ..problems import MODELS, PIER, THRESHOLD, polyline

_SAMPLE = 0.002  # [s] 1/400 of 1/p, and 1/20 of the shortest pass
# under a threshold of the same acceleration, large enough to stand most noise of that strength
_LARGE = Cylinder(semidiagonal=15.0, tan_alpha=PIER.tan_alpha)
_NOISE = ((2, 0.1), (13, 0.05), (23, 0.05))  # seed, and spacing of the samples [s]
_REACH = 3  # samples on either side of the lowest or highest one
# 4e-10 s, 1e-12 and 2e-8 rad were measured: what the polynomial leaves of the fastest pass
VERTEX = "vertex of the polynomial through samples 0.002 s apart"
COLUMNS = {
    "times": Bound(1e-8, VERTEX, "s"),
    "tilts": Bound(1e-10, VERTEX, "rad"),
    "angles": Bound(1e-6, VERTEX, "rad"),
}
PEAK = Bound(1e-10, "the highest turning point of the samples", "rad")
LISTED = Bound(0.0, "every change of direction of the samples is a turning point")
HIGHEST = Bound(0.0, "no sample is higher than the peak", "alpha")
PASSES = Bound(1e-6, "minima between two maxima, and the turn from one to the other", "s, rad")
WAY = Bound(1e-9, "the azimuth of the shaking, or the opposite one", "rad")
SHAKEN = polyline(
    [0.0, 0.5, 1.0, 1.5, 2.0],
    np.array([[0.0, 0.0, 0.0], [1.5, 1.1, 0.2], [-1.0, 1.0, -0.3], [0.8, -0.9, 0.2], [0.0, 0.0, 0.0]])
    * THRESHOLD,
    0.5,
)
_AZIMUTH = 0.6  # [rad] of shaking in a plane
_ALONG = Case(
    PIER,
    GroundMotion(
        THRESHOLD * np.outer([0.0, 1.6, -1.3, 0.9, 0.0], [math.cos(_AZIMUTH), math.sin(_AZIMUTH)]), 0.5
    ),
    duration=6.0,
)


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    down = InitialState(0.5 * PIER.alpha, -0.1, 0.3, 0.3)
    up = InitialState(0.2 * PIER.alpha, 0.1, 0.3, -0.6)
    for name, model, case in (
        ("shaken, recess", "recess", Case(PIER, SHAKEN, duration=8.0)),
        ("shaken, flat ground", "flat", Case(PIER, SHAKEN, duration=8.0)),
        ("released, recess", "recess", Case(PIER, initial=down, duration=8.0)),
        ("released upwards, flat ground", "flat", Case(PIER, initial=up, duration=8.0)),
    ):
        yield from _one(name, bench.solve(case, model, sample_step=_SAMPLE, rtol=1e-11, rest_tilt=0.0))
    for model in MODELS:
        yield from _rough(bench, model)
    for model, options in (("recess", {}), ("planar", {"plane": _AZIMUTH})):
        yield _in_plane(bench.solve(_ALONG, model, **options), model)


def _in_plane(found: Trace, model: str) -> Finding:
    """Shaking along one azimuth: every turning point leans that way or the other, and so does the uplift."""
    time, _, angle, kind = found.extrema.T
    away = np.sin(np.append(angle, found.uplift_direction) - _AZIMUTH)
    listed = len(time) > 2 and bool((np.abs(kind) == 1.0).all())
    name = f"azimuth of turning points, shaken in a plane, {model}"
    part = "turning points or uplift: azimuth of the plane of motion"
    return at_most(name, largest(away) if listed else math.nan, WAY, part, f"{len(time)} of them")


def _rough(bench: Bench, model: str) -> Iterator[Finding]:
    """Noise whose samples are so far apart that tilts turn twice in a step, which begins and ends alike."""
    unlisted, above = 0, 0.0
    for seed, step in _NOISE:
        noise = THRESHOLD * np.random.default_rng(seed).normal(size=(round(10.0 / step), 2))
        found = bench.solve(Case(_LARGE, GroundMotion(noise, step)), model, sample_step=_SAMPLE)
        turns = _turns(found)
        times = found.extrema[:, 0]
        unlisted += sum(np.abs(times - at).min(initial=math.inf) > _SAMPLE for at in turns[:, 0])
        above = max(above, float(found.tilt.max() - found.peak_tilt) / _LARGE.alpha)
    part = "turning points: two of them in one step"
    yield at_most(f"turning points that are not found, noise, {model}", unlisted, LISTED, part)
    yield at_most(f"peak of the continuous motion, noise, {model}", above, HIGHEST, part)


def _one(name: str, found: Trace) -> Iterator[Finding]:
    turns = _turns(found)
    rows = found.extrema
    same = len(rows) == len(turns) > 2 and bool((rows[:, 3] == turns[:, 3]).all())
    note = f"{len(turns)} of them" if same else f"{len(rows)} where the samples have {len(turns)}"
    for column, (what, bound) in enumerate(COLUMNS.items()):
        apart = largest(rows[:, column] - turns[:, column]) if same else math.nan
        part = "turning points: where the tilt rate is zero within a step"
        yield at_most(f"{what} of turning points, {name}", apart, bound, part, note)
    tops = turns[turns[:, 3] > 0.0, 1]
    apart = abs(found.peak_tilt - max([*tops, found.tilt[0], found.tilt[-1]]))
    part = "peak tilt: turning points within a step"
    yield at_most(f"peak of the continuous motion, {name}", apart, PEAK, part)
    expected = _passes(turns)
    passes = found.passes[["time", "minimum_tilt", "angle_of_turn"]].to_numpy(dtype=float)
    yield at_most(
        f"passes, {name}",
        np.abs(passes - expected).max(initial=0.0) if passes.shape == expected.shape else math.nan,
        PASSES,
        "passes: their times, minimum tilts or angles of turn",
        f"{len(expected)} of them",
    )


def _turns(found: Trace) -> Array:
    """Return time, tilt, rolling angle and 1 or -1 of each extremum of the samples."""
    # at rest before the uplift the tilt is zero and turns nowhere; the end may stand off the grid
    moving = np.flatnonzero(np.isfinite(found.rolling_angle))
    first, last = int(moving[0]), len(found.time) - 1
    rising = np.diff(found.tilt[first:last]) > 0.0
    rows = []
    for index in (first + 1 + np.flatnonzero(rising[1:] != rising[:-1])).tolist():
        low = min(max(index - _REACH, first), last - 2 * _REACH - 1)
        around = slice(low, low + 2 * _REACH + 1)
        at = found.time[around] - found.time[index]
        tilt, angle = (
            np.polynomial.Polynomial.fit(at, values[around], 2 * _REACH)
            for values in (found.tilt, found.rolling_angle)
        )
        roots = tilt.deriv().roots()
        roots = roots[np.abs(roots.imag) == 0.0].real
        vertex = float(roots[np.argmin(np.abs(roots))])
        kind = -1.0 if float(tilt.deriv(2)(vertex)) > 0.0 else 1.0
        rows.append([found.time[index] + vertex, float(tilt(vertex)), float(angle(vertex)), kind])
    return np.array(rows).reshape(-1, 4)


def _passes(turns: Array) -> Array:
    """Return time, minimum tilt and angle of turn of each minimum between two maxima."""
    triples = zip(turns, turns[1:], turns[2:], strict=False)
    rows = [[low[0], low[1], after[2] - before[2]] for before, low, after in triples if low[3] < 0.0]
    return np.array(rows).reshape(-1, 3)
