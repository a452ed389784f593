"""Figure 5: the response to the 1940 El Centro record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import AGREEMENT, Case, GroundMotion, Trace, el_centro_1940
from rockwobble.reports.published.paper.free import RESIDUAL, displacement
from rockwobble.reports.published.paper.statements import PIER, Statement, verdict_of

Array = NDArray[np.float64]

_GRAVITY = 9.81
_RTOL = 1e-10
_SAMPLE_STEP = 5e-4  # [s]; half a turn in a typical pass takes tens of it
# Passes near upright make one response one of many. What the paper sees in one is therefore counted
# over neighbours too: the record scaled by up to a tenth, evenly.
_NEIGHBOURS = tuple(0.9 + 0.005 * i for i in range(41))
_NEIGHBOUR_STEP = 2e-3  # [s]; enough to count by
# "abruptly": faster by this factor than the steady wobble at half of alpha
_ABRUPT = 10.0
# smaller than the difference of two instruments
NUDGE = 1e-3
# a difference of a quarter is seen in a figure
_PLAINLY = 1.25


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """Motion of the contact point in a part of the record.

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
    """The response, its parts before and after `strong_end`, and those of its neighbours.

    `strong_end` is the last time the record by itself could uplift the cylinder [s]; from `agreement` [s] on
    a perturbed copy, its record stronger by `NUDGE`, differs by 1 % of alpha: inf if it never does.
    """

    trace: Trace
    strong_end: float
    strong: Part
    weak: Part
    neighbours: Sequence[tuple[Part, Part]]
    agreement: float


def shaken() -> Shaken:
    """Run the record, its standing neighbours (scaled records), and the perturbed copy."""
    motion = el_centro_1940()
    trace = _run(Case(PIER, motion))
    copy = _run(Case(PIER, motion.scaled(1.0 + NUDGE)))
    beyond = np.abs(copy.tilt - trace.tilt) > AGREEMENT * PIER.alpha
    end = strong_end(motion)
    strong, weak = parts(trace, end)
    neighbours = [motion.scaled(scale) for scale in _NEIGHBOURS]
    others = [(scaled, _run(Case(PIER, scaled), _NEIGHBOUR_STEP)) for scaled in neighbours]
    return Shaken(
        trace=trace,
        strong_end=end,
        strong=strong,
        weak=weak,
        neighbours=[
            parts(other, strong_end(scaled)) for scaled, other in others if other.outcome != "overturned"
        ],
        agreement=float(trace.time[beyond].min(initial=math.inf)),
    )


def _run(case: Case, sample_step: float = _SAMPLE_STEP) -> Trace:
    return reduced.simulate(case, rtol=_RTOL, sample_step=sample_step)


def strong_end(motion: GroundMotion) -> float:
    """Last time at which the record could uplift the resting cylinder, equation (25) [s]."""
    over = np.hypot(*motion.acceleration[:, :2].T) >= _GRAVITY * PIER.tan_alpha
    return float(np.flatnonzero(over)[-1] * motion.time_step)


def parts(trace: Trace, end: float) -> tuple[Part, Part]:
    """Motion of the contact point before and after `end` [s]."""
    time, turn = (trace.passes[name].to_numpy() for name in ("time", "angle_of_turn"))
    half = half_turn_times(trace)
    energy = np.interp(time, trace.time, trace.energy)
    change = np.abs(np.diff(energy)) / np.maximum(energy[1:], energy[:-1])
    entries = []
    for inside in (time < end, time >= end):
        pairs = inside[1:] & inside[:-1]
        entries.append(
            Part(
                passes=int(inside.sum()),
                half_turn=_median(half[inside]),
                abrupt=int((half < abrupt_time())[inside].sum()),
                energy_change=_median(change[pairs]),
                scatter=float(np.abs(turn[inside]).std()) if inside.any() else math.nan,
                reversals=int((turn[1:] * turn[:-1] < 0.0)[pairs].sum()),
            )
        )
    return entries[0], entries[1]


def abrupt_time() -> float:
    """Time below which the middle half of a turn counts as abrupt [s]."""
    # a turn is half of the way round, or a little more
    steady = 0.25 * float(reduced.wobbling_period(PIER, 0.5 * PIER.alpha))
    return steady / _ABRUPT


def half_turn_times(trace: Trace) -> Array:
    """Duration of the middle half of the turn for each pass (n,) [s]."""
    time, angle = trace.time, trace.rolling_angle
    times = []
    for at, turn in zip(trace.passes["time"], trace.passes["angle_of_turn"], strict=True):
        # counted in the direction of the turn, from where the tilt is least
        way = (angle - np.interp(at, time, angle)) * math.copysign(1.0, turn)
        begin, end = np.searchsorted(time, [at, at])
        while begin > 0 and way[begin - 1] > -0.25 * abs(turn):
            begin -= 1
        while end < len(way) and way[end] < 0.25 * abs(turn):
            end += 1
        times.append(_time_to_turn(way, time, end, abs(turn)) - _time_to_turn(way, time, begin, -abs(turn)))
    return np.array(times)


def _time_to_turn(way: Array, time: Array, index: int, turn: float) -> float:
    """Time between samples index - 1 and index at which a quarter of `turn` is made [s]."""
    if not 0 < index < len(way):
        return math.nan
    return float(np.interp(0.25 * turn, way[index - 1 : index + 1], time[index - 1 : index + 1]))


def _median(values: Array) -> float:
    known = values[~np.isnan(values)]
    return float(np.median(known)) if len(known) else math.nan


def statements(data: Shaken) -> list[Statement]:
    """Compare the paper's statements on the figure with the response and its neighbours."""
    strong, weak, trace = data.strong, data.weak, data.trace
    both = {f"{name}_{key}": value for name, part in (("strong", strong), ("weak", weak))
            for key, value in asdict(part).items()}  # fmt: skip
    abrupt = both | {
        "from": trace.uplift_time,
        "until": data.strong_end,
        "abrupt_time": abrupt_time(),
        "neighbours": len(data.neighbours),
        "neighbours_abrupt": sum(2 * part.abrupt > part.passes for part, _ in data.neighbours),
        "agreement": data.agreement,
        "nudge": NUDGE,
    }
    tests = {"free": _quasi_free, "slower": _slower, "smoother": _smoother}
    counts = {name: sum(test(*pair) for pair in data.neighbours) for name, test in tests.items()}
    away = displacement(float(trace.passes["minimum_tilt"].min()))
    twist = float(np.abs(trace.twist).max())
    place = {
        "peak": trace.peak_tilt / PIER.alpha,
        "last_tilt": float(trace.tilt[-1]) / PIER.alpha,
        "last_away": displacement(float(trace.tilt[-1])),
        "rests": trace.rests,
        "passes": len(trace.passes),
        "away": away,
        "twist": twist,
    }
    smooth = verdict_of(*(test(strong, weak) for test in tests.values()))
    back = verdict_of(trace.outcome == "stands", away < RESIDUAL, twist == 0.0)
    judged = [
        ("abrupt", abrupt, verdict_of(strong.abrupt > 0, 2 * strong.abrupt > strong.passes)),
        ("smooth", both | counts | {"neighbours": len(data.neighbours), "until": data.strong_end}, smooth),
        ("place", place, back),
    ]
    return [Statement(figure=5, name=name, numbers=n, verdict=verdict) for name, n, verdict in judged]


def _quasi_free(strong: Part, weak: Part) -> bool:
    return _PLAINLY * weak.energy_change < strong.energy_change


def _slower(strong: Part, weak: Part) -> bool:
    return weak.half_turn > _PLAINLY * strong.half_turn


def _smoother(strong: Part, weak: Part) -> bool:
    # reversals by the pass, without a division where there is none
    steadier = _PLAINLY * weak.scatter < strong.scatter
    return steadier and _PLAINLY * weak.reversals * strong.passes < strong.reversals * weak.passes
