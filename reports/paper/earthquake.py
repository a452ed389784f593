"""Figure 5: the response to the 1940 El Centro record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, el_centro_1940

from ..figures.drawing import drawn, drawn_samples, line, with_grid

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from rockwobble.reduced import Response

Array = NDArray[np.float64]

CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
_GRAVITY = 9.81
_RTOL = 1e-10
_SAMPLE_STEP = 5e-4  # [s]; half a turn in a typical pass takes tens of it
# Passes near upright make one response one of many. What the paper sees in one is therefore counted
# over neighbours too: the record scaled by up to a tenth, evenly.
_NEIGHBOURS = tuple(0.9 + 0.005 * i for i in range(41))
_NEIGHBOUR_STEP = 2e-3  # [s]; enough to count by
# "abruptly": faster by this factor than the steady wobble at half of alpha
_ABRUPT = 10.0
# less than tells two instruments apart
NUDGE = 1e-3
_PARTED = 0.01  # of alpha
_HEIGHT = 8.6
_COLOUR = "#0072B2"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Part:
    """How the contact point moves in a part of the record.

    Attributes
    ----------
    passes : int
        By upright.
    half_turn : float
        Median time in which the middle half of the turn of a pass is made [s].
    abrupt : int
        Passes in which that is faster than `abrupt_time`.
    energy_change : float
        Median change of the energy from one pass to the next, over the larger of the two [-].
    scatter : float
        Standard deviation of the size of the angle of turn [rad].
    reversals : int
        Passes after which the contact point rolls the other way round.
    """

    passes: int
    half_turn: float
    abrupt: int
    energy_change: float
    scatter: float
    reversals: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Shaken:
    """The response of figure 5, its two parts, and those of its neighbours.

    Attributes
    ----------
    motion : GroundMotion
    response : Response
    strong_end : float
        Last time the record by itself could uplift the cylinder [s].
    strong, weak : Part
        Before and after.
    neighbours : sequence of (Part, Part)
        The same of the neighbours that do not overturn.
    horizon : float
        Time at which a twin, its record stronger by `NUDGE`, first differs by 1 % of alpha [s]; infinite
        if it never does.
    """

    motion: GroundMotion
    response: Response
    strong_end: float
    strong: Part
    weak: Part
    neighbours: Sequence[tuple[Part, Part]]
    horizon: float

    def to_frame(self) -> pd.DataFrame:
        """Return the samples at the time step of the record, and the record."""
        response = self.response
        every = round(self.motion.time_step / _SAMPLE_STEP)
        table = drawn_samples(response, slice(None, None, every))
        times = np.arange(len(self.motion.acceleration)) * self.motion.time_step
        for i, name in enumerate(("ground_x", "ground_y")):
            table[name] = np.interp(table["time"], times, self.motion.acceleration[:, i])
        return table


def shaken() -> Shaken:
    """Run the record, its neighbours and the twin."""
    motion = el_centro_1940()
    response = _run(motion)
    twin = _run(motion.scaled(1.0 + NUDGE))
    count = min(len(response.tilt), len(twin.tilt))
    apart = np.abs(response.tilt[:count] - twin.tilt[:count]) > _PARTED * CYLINDER.alpha
    end = strong_end(motion)
    strong, weak = parts(response, end)
    neighbours = []
    for scale in _NEIGHBOURS:
        scaled = motion.scaled(scale)
        other = _run(scaled, _NEIGHBOUR_STEP)
        if other.outcome != "overturned":
            neighbours.append(parts(other, strong_end(scaled)))
    return Shaken(
        motion=motion,
        response=response,
        strong_end=end,
        strong=strong,
        weak=weak,
        neighbours=neighbours,
        horizon=float(response.time[apart.argmax()]) if apart.any() else math.inf,
    )


def _run(motion: GroundMotion, sample_step: float = _SAMPLE_STEP) -> Response:
    return reduced.simulate(Case(CYLINDER, motion), rtol=_RTOL, sample_step=sample_step)


def strong_end(motion: GroundMotion) -> float:
    """Return the last time the record by itself could uplift the cylinder, (25) [s]."""
    over = np.hypot(*motion.acceleration[:, :2].T) >= _GRAVITY * CYLINDER.tan_alpha
    return float(np.flatnonzero(over)[-1] * motion.time_step)


def parts(response: Response, end: float) -> tuple[Part, Part]:
    """Return how the contact point moves before and after `end` [s]."""
    passes = response.passes
    time, turn = passes["time"].to_numpy(), passes["angle_of_turn"].to_numpy()
    half = half_turn_times(response)
    energy = np.interp(time, response.time, response.energy)
    change = np.abs(np.diff(energy)) / np.maximum(energy[1:], energy[:-1])
    found = []
    for inside in (time < end, time >= end):
        pairs = inside[1:] & inside[:-1]
        found.append(
            Part(
                passes=int(inside.sum()),
                half_turn=_median(half[inside]),
                abrupt=int((half < abrupt_time())[inside].sum()),
                energy_change=_median(change[pairs]),
                scatter=float(np.abs(turn[inside]).std()) if inside.any() else math.nan,
                reversals=int((turn[1:] * turn[:-1] < 0.0)[pairs].sum()),
            )
        )
    return found[0], found[1]


def abrupt_time() -> float:
    """Return the time below which the middle half of a turn counts as abrupt [s]."""
    # a turn is half of the way round, or a little more
    steady = 0.25 * reduced.wobbling_period(CYLINDER, 0.5 * CYLINDER.alpha)
    return steady / _ABRUPT


def half_turn_times(response: Response) -> Array:
    """Return for each pass the time in which the middle half of its turn is made (n,) [s]."""
    passes = response.passes
    time, angle = response.time, response.rolling_angle
    times = []
    for at, turn in zip(passes["time"], passes["angle_of_turn"], strict=True):
        # counted in the direction of the turn, from where the tilt is least
        way = (angle - np.interp(at, time, angle)) * math.copysign(1.0, turn)
        begin, end = np.searchsorted(time, [at, at])
        while begin > 0 and way[begin - 1] > -0.25 * abs(turn):
            begin -= 1
        while end < len(way) and way[end] < 0.25 * abs(turn):
            end += 1
        times.append(_reached(way, time, end, abs(turn)) - _reached(way, time, begin, -abs(turn)))
    return np.array(times)


def _reached(way: Array, time: Array, index: int, turn: float) -> float:
    """Time between samples index - 1 and index at which a quarter of `turn` is made [s]."""
    if not 0 < index < len(way):
        return math.nan
    return float(np.interp(0.25 * turn, way[index - 1 : index + 1], time[index - 1 : index + 1]))


def _median(values: Array) -> float:
    known = values[~np.isnan(values)]
    return float(np.median(known)) if len(known) else math.nan


def earthquake_figure(data: Shaken) -> bytes:
    """Return the figure as SVG: response above, record below, the strong part shaded."""

    def draw(figure: Figure) -> None:
        response, motion = data.response, data.motion
        at = np.arange(len(motion.acceleration), dtype=np.float64) * motion.time_step
        rows = figure.subplots(6, 1, sharex=True, height_ratios=[1.3, 1, 1.3, 1.1, 0.9, 0.9])
        shown = (
            (response.time, response.tilt / CYLINDER.alpha, "θ / α [-]"),
            (response.time, response.tilt_rate, "θ' [rad/s]"),
            (response.time, response.rolling_angle / math.pi, "φ / π [-]"),
            (response.time, response.rolling_rate, "φ' [rad/s]"),
            (at, motion.acceleration[:, 0] / _GRAVITY, "east-west\n[g]"),
            (at, motion.acceleration[:, 1] / _GRAVITY, "north-south\n[g]"),
        )
        for axes, (time, values, label) in zip(rows, shown, strict=True):
            axes.axvspan(response.uplift_time, data.strong_end, color="#f3e3c3", linewidth=0)
            if math.isfinite(data.horizon):
                axes.axvline(data.horizon, color="#777777", linewidth=0.9, linestyle=(0, (4, 2)))
            colour = "#444444" if time is at else _COLOUR
            line(axes, time, values, color=colour, linewidth=0.8)
            axes.set_ylabel(label)
            with_grid(axes)
        rows[0].set_ylim(bottom=0.0)
        _signed_log(rows[3])
        rows[0].set_title(_title(data))
        largest = 1.1 * float(np.abs(motion.acceleration[:, :2]).max()) / _GRAVITY
        for axes in rows[4:]:
            axes.set_ylim(-largest, largest)
        rows[-1].set_xlim(0.0, response.time[-1])
        rows[-1].set_xlabel("time [s]")
        figure.align_ylabels(rows)

    return drawn(draw, _HEIGHT)


def _signed_log(axes: Axes) -> None:
    axes.set_yscale("symlog", linthresh=1.0)
    ticks = [-1000.0, -10.0, 0.0, 10.0, 1000.0]
    axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])


def _title(data: Shaken) -> str:
    note = f"R = {CYLINDER.semidiagonal:g} m, tan α = {CYLINDER.tan_alpha:g}; shaded: the record can uplift"
    if not math.isfinite(data.horizon):
        return note
    return f"{note}; dashed: a record {100.0 * NUDGE:g} % stronger parts here"
