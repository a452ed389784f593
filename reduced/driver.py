"""The march through a record: rest, uplift, motion, turning points, seating, overturning.

One driver serves the three models; they differ in their equations and in the number of variables.
`systems` says which.
Every step ends at the next record sample at the latest, because the forcing has a kink there.
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._compile import borrowed, inlined, jit
from .body import Body
from .endings import HALF_PI, may_sit_down, surely_falls
from .stepping import Stepper, make_events
from .systems import System
from .trigonometry import sin_cos
from .tsit5 import State, Vector, ground
from .uplift import START, nearest_branch, start_length, started, uplift_in

REST, COMPLETED, OVERTURNED, OVER_BUDGET, STALLED = range(5)  # how a march ends
MAXIMUM, MINIMUM = 1.0, -1.0
MOST_SEATING = 0.1  # tilt of the seating rule over alpha
_LEAST_STEP = 1e-200  # a step that must be shorter fails whatever its length [s]


class Options(NamedTuple):
    """What steers a march."""

    rtol: float  # tolerance of one step, relative
    seating: float  # tilt of the seating rule over alpha; 0 leaves the rule out
    restitution: float  # of the tilt rate where the base meets the ground in planar motion
    duration: float  # [s]
    step_budget: int
    relief: int  # steps by which the budget grows when it is used up, and the seating tenfold; 0: the end
    record_steps: bool


class March(NamedTuple):
    """What a march returns; `size` is the number of variables of the model."""

    status: int
    end: float  # time reached [s]
    peak: float  # largest tilt [rad]
    uplift_time: float  # first uplift, or 0 for a release [s]; NaN if there is none
    uplift_direction: float  # rolling angle there [rad]
    samples: NDArray[np.float64]  # (n, size) state at the times asked for
    moving: NDArray[np.bool_]  # (n,) False where the cylinder stands
    reached: int  # how many samples were reached
    final: NDArray[np.float64]  # (size,) state at the end
    extrema: NDArray[np.float64]  # (k, 4) time, tilt, rolling angle, MAXIMUM or MINIMUM
    steps: NDArray[np.float64]  # (j, 1 + size) time and state after each step, if recorded
    step_count: int


Driver = Callable[..., March]


# Loops instead of slice assignment: that carries shape checks with formatted messages, which double
# the time to compile.
@jit
def write(source: State, target: NDArray[np.float64]) -> None:
    """Copy a tuple to an array of its length."""
    for i in range(len(source)):
        target[i] = source[i]


@jit
def as_table(rows: Any, width: int) -> NDArray[np.float64]:
    """Return a list of tuples as an array (n, width)."""
    table = np.empty((len(rows), width))
    for i in range(len(rows)):
        write(rows[i], table[i])
    return table


@inlined
def piece_of_record(
    record: NDArray[np.float64], scale: float, time_step: float, index: int
) -> tuple[Vector, Vector, float]:
    """Return the acceleration at sample `index`, its rate from there on, and where that ends [s]."""
    if index >= len(record) - 1:  # the ground is still after the record
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), np.inf
    end = index + 1
    a = (scale * record[index, 0], scale * record[index, 1], scale * record[index, 2])
    slope = (
        (scale * record[end, 0] - a[0]) / time_step,
        (scale * record[end, 1] - a[1]) / time_step,
        (scale * record[end, 2] - a[2]) / time_step,
    )
    return a, slope, end * time_step


@jit
def spin_momentum(body: Body, theta: float, phi_rate: float) -> float:
    """Return L = B phi' [m^2/s]."""
    s, c = sin_cos(theta)
    t = s / (1.0 + c)
    return s * s * (body.J + (2.0 * body.E + body.C * t) * t) * phi_rate


def make_driver(system: System, stepper: Stepper) -> Driver:
    """Return the compiled march of one model by one method."""
    workspace, restarted, advance, partial = stepper
    turning_point, crossing = make_events(partial)
    derivative, momenta = system.derivative, system.momenta
    placed: Callable[..., State] = system.placed

    @jit
    def is_flat(y: State) -> bool:
        """Return whether a state has neither spin nor twist rate: exactly planar motion."""
        L, S = momenta(y)
        return bool(L == 0.0 and S == 0.0)

    @jit
    def lifted(body: Body, a: Vector, slope: Vector, at: float, time: float, last: State) -> State:
        """Return the state `time` after an uplift; `last` is the state in which it stood."""
        theta, omega, angle, rate = started(body, a, slope, at, time)
        return placed(last, theta, omega, nearest_branch(angle, last[2]), spin_momentum(body, theta, rate))

    @jit
    def march(
        body: Body,
        options: Options,
        record: NDArray[np.float64],
        scale: float,
        time_step: float,
        initial: State,
        times: NDArray[np.float64],
        later: NDArray[np.float64],
    ) -> March:
        """Solve one problem.

        Parameters
        ----------
        body : Body
        options : Options
        record : ndarray, shape (m, 3)
            Samples of the ground acceleration [m/s^2]; m = 0 for still ground.
        scale : float
            Factor on them.
        time_step : float
            Their spacing [s].
        initial : tuple of float
            State at time zero; zero tilt stands at rest.
        times : ndarray, shape (n,)
            Increasing times at which the state is wanted [s]; they do not influence the steps.
        later : ndarray, shape (m, 2)
            From each sample on, the largest |a| and the least az of `record`, by which a fall that
            nothing can stop ends the march early; m = 0 marches on until the side is down.
        """
        size = len(initial)
        y, k = initial, initial
        owned = workspace(initial)  # until its last use, at the end
        work = borrowed(owned)
        samples, moving = np.zeros((len(times), size)), np.zeros(len(times), dtype=np.bool_)
        sample = 0
        # lists, typed by a row and emptied: a growing array would have its references counted in each step
        extrema, steps = [(0.0, 0.0, 0.0, 0.0)], [(0.0, *initial)]
        extrema.clear()
        steps.clear()
        step_count = 0
        first_start = START / body.p

        resting = y[0] == 0.0
        uplift_time, uplift_direction = np.nan, np.nan
        if not resting:
            uplift_time, uplift_direction = 0.0, y[2]
        peak = y[0]
        seating, step_budget = options.seating, options.step_budget
        h_next = first_start
        now, piece, status = 0.0, 0, COMPLETED
        restart = True  # kept until a step has been made ready, also when an uplift ends at a sample

        while now < options.duration and status == COMPLETED:
            begin = now
            a, slope, finish = piece_of_record(record, scale, time_step, piece)
            finish = min(finish, options.duration)
            length = finish - begin
            elapsed = 0.0
            # the forcing jumps where a record begins or ends, and only there
            restart = restart or piece == 0 or piece == len(record) - 1

            while now < finish and status == COMPLETED:
                if resting:
                    wait = uplift_in(body, ground(a, slope, elapsed), slope, length - elapsed)
                    lift = elapsed + wait
                    # one within a hair of the next sample is taken up there, already above the threshold
                    stays = wait < 0.0 or length - lift < 1e-3 * first_start
                    now = finish if stays else begin + lift
                    while sample < len(times) and times[sample] <= now:
                        write(y, samples[sample])
                        sample += 1
                    if stays:
                        break
                    series = min(start_length(body, a, slope, lift), length - lift)
                    y_new = lifted(body, a, slope, lift, series, y)
                    elapsed = lift + series
                    if y_new[0] <= 0.0:  # touched the threshold and fell back
                        continue
                    if np.isnan(uplift_time):
                        uplift_time, uplift_direction = now, lifted(body, a, slope, lift, 0.0, y)[2]
                    while sample < len(times) and times[sample] <= begin + elapsed:
                        write(lifted(body, a, slope, lift, times[sample] - now, y), samples[sample])
                        moving[sample] = True
                        sample += 1
                    y = y_new
                    peak = max(peak, y[0])
                    now = finish if elapsed >= length else begin + elapsed
                    h_next = 0.1 * series
                    resting, restart = False, True
                    continue

                a_now = ground(a, slope, elapsed)
                if restart:
                    k = restarted(body, y, a_now, work)
                    restart = False
                    if now == 0.0 and y[1] == 0.0:  # a release at rest is a turning point
                        kind = MAXIMUM if derivative(body, y, a_now)[1] < 0.0 else MINIMUM
                        extrema.append((0.0, y[0], y[2], kind))

                h, h_next, trials, y_new, k, path = advance(
                    body, options.rtol, y, k, work, h_next, length - elapsed, a_now, slope
                )
                step_count += trials
                if step_count > step_budget:
                    if options.relief == 0 or seating >= MOST_SEATING:
                        status = OVER_BUDGET
                        break
                    seating, step_budget = min(10.0 * seating, MOST_SEATING), step_budget + options.relief
                if h == 0.0:
                    if h_next < _LEAST_STEP:
                        status = STALLED
                        break
                    continue

                turns = y[1] * y_new[1] < 0.0
                turn = turned_tilt = turned_angle = 0.0
                if turns:
                    turn, turned_tilt, turned_angle = turning_point(body, work, path, y, h, y_new[1])
                    peak = max(peak, turned_tilt)
                # with spin the tilt stays positive; without it the base meets the ground
                lands = is_flat(y) and (y_new[0] <= 0.0 or (turns and turned_tilt <= 0.0))
                falls = y_new[0] >= HALF_PI
                if len(later) > 0 and y_new[0] > body.alpha and y_new[1] >= 0.0:
                    strongest, lightest = scale * later[piece, 0], body.g + scale * later[piece, 1]
                    if surely_falls(body, y_new[0], strongest, lightest, options.duration - now - h):
                        peak, status = HALF_PI, OVERTURNED
                        break
                if lands or falls:
                    level = HALF_PI if falls else 0.0
                    # a hop within one step lands after its highest point, a dip before its lowest
                    hops = lands and turns and turned_tilt > 0.0
                    first = turn if hops else 0.0
                    last = turn if lands and turns and not hops else h
                    h, y_new = crossing(body, work, path, y, first, last, level)
                    turns = hops
                whole = elapsed + h >= length
                after = finish if whole else begin + (elapsed + h)

                while sample < len(times) and times[sample] <= after:
                    if times[sample] == after:
                        write(y_new, samples[sample])
                    else:
                        y_at, _ = partial(body, work, path, times[sample] - now)
                        write(y_at, samples[sample])
                    moving[sample] = True
                    sample += 1
                if turns:
                    kind = MAXIMUM if y[1] > 0.0 else MINIMUM
                    extrema.append((now + turn, turned_tilt, turned_angle, kind))

                y = y_new
                elapsed = length if whole else elapsed + h
                now = after
                peak = max(peak, y[0])
                if falls:
                    status = OVERTURNED
                elif lands:
                    extrema.append((now, 0.0, y[2], MINIMUM))
                    opposite = y[2] + (-pi if y[2] > 0.0 else pi)  # the other end of the diameter
                    y = placed(y, 0.0, options.restitution * abs(y[1]), opposite, 0.0)
                    restart = True
                if options.record_steps:
                    steps.append((now, *y))
                if options.seating > 0.0 and not falls:
                    L, S = momenta(y)
                    a_now = ground(a, slope, elapsed)
                    if may_sit_down(body, seating, y[0], y[1], L, S, a_now):
                        resting = True
                        y = placed(y, 0.0, 0.0, y[2], 0.0)
            piece += 1

        if status == COMPLETED and resting:
            status = REST
        final = np.empty(size)
        write(y, final)
        owned[0] = 0.0
        return March(
            status,
            now,
            peak,
            uplift_time,
            uplift_direction,
            samples,
            moving,
            sample,
            final,
            as_table(extrema, 4),
            as_table(steps, 1 + size),
            step_count,
        )

    return march
