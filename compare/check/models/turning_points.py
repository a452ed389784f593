"""Layer properties, second part: turning points, peaks and passes against densely sampled tilts.

Where the tilt turns follows from its samples alone: the vertex of the polynomial through those around a
change of direction. The samples are a four-hundredth of the time scale of the motion apart, so that the
polynomial is exact to rounding.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

from ..bench import Bench
from ..finding import Finding, at_most
from ..polyline import polyline

LAYER = "properties"
GRAVITY = 9.81
CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
THRESHOLD = GRAVITY * CYLINDER.tan_alpha
_SAMPLE = 0.002  # [s] 1/400 of 1/p, and 1/20 of the shortest pass
_REACH = 3  # samples on either side of the lowest or highest one
# 4e-10 s, 1e-12 and 2e-8 rad were measured: what the polynomial leaves of the fastest pass
TIME, TILT, TURN = 1e-8, 1e-10, 1e-6


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    values = np.array(
        [[0.0, 0.0, 0.0], [1.5, 1.1, 0.2], [-1.0, 1.0, -0.3], [0.8, -0.9, 0.2], [0.0, 0.0, 0.0]]
    )
    shaken = polyline([0.0, 0.5, 1.0, 1.5, 2.0], values * THRESHOLD, 0.5)
    runs: dict[str, tuple[str, GroundMotion | None, InitialState | None]] = {
        "shaken, recess": ("recess", shaken, None),
        "shaken, flat ground": ("flat", shaken, None),
        "released, recess": ("recess", None, InitialState(0.5 * CYLINDER.alpha, -0.1, 0.3, 0.3)),
        "released upwards, flat ground": (
            "flat",
            None,
            InitialState(0.2 * CYLINDER.alpha, 0.1, 0.3, -0.6),
        ),
    }
    for name, (model, motion, initial) in runs.items():
        found = bench.reduced.simulate(
            Case(CYLINDER, motion, initial=initial, duration=8.0, gravity=GRAVITY),
            sample_step=_SAMPLE,
            rtol=1e-11,
            rest_tilt=0.0,
            **bench.reduced.MODELS[model],
        )
        yield from _one(name, found)


def _one(name: str, found: Any) -> Iterator[Finding]:
    turns = _turns(found)
    rows = found.extrema[found.extrema[:, 0] > 0.0]
    part = "turning points: where the tilt rate is zero within a step"
    same = len(rows) == len(turns) > 2 and bool((rows[:, 3] == turns[:, 3]).all())
    for column, what, bound, unit in (
        (0, "times", TIME, "s"),
        (1, "tilts", TILT, "rad"),
        (2, "angles", TURN, "rad"),
    ):
        yield at_most(
            LAYER,
            f"{what} of turning points, {name}",
            np.abs(rows[:, column] - turns[:, column]).max() if same else math.nan,
            bound,
            unit=unit,
            reason="vertex of the polynomial through samples 0.002 s apart",
            part=part,
            note=f"{len(turns)} of them" if same else f"{len(rows)} where the samples have {len(turns)}",
        )
    tops = turns[turns[:, 3] > 0.0, 1]
    yield at_most(
        LAYER,
        f"peak of the continuous motion, {name}",
        abs(found.peak_tilt - max([*tops, found.tilt[0], found.tilt[-1]])),
        TILT,
        unit="rad",
        reason="the highest turning point of the samples",
        part="peak tilt: turning points within a step",
    )
    expected = _passes(turns)
    passes = found.passes.iloc[:, :3].to_numpy(dtype=float)
    yield at_most(
        LAYER,
        f"passes, {name}",
        np.abs(passes - expected).max(initial=0.0) if passes.shape == expected.shape else math.nan,
        TURN,
        unit="s, rad",
        reason="minima between two maxima, and the turn from one to the other",
        part="passes: their times, minimum tilts or angles of turn",
        note=f"{len(expected)} of them",
    )


def _turns(found: Any) -> NDArray[np.float64]:
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


def _passes(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return time, minimum tilt and angle of turn of each minimum between two maxima."""
    return np.array(
        [
            [low[0], low[1], after[2] - before[2]]
            for before, low, after in zip(turns, turns[1:], turns[2:], strict=False)
            if low[3] < 0.0
        ]
    ).reshape(-1, 3)
