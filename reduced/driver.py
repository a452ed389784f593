"""The march through a record: rest, uplift, motion, turning points, seating, overturning.

One driver serves the three models; they differ in their equations and in the number of variables.
The first three are always tilt, tilt rate and rolling angle; the recess adds L; the rolling model
adds Lambda, tau, S and the two coordinates of the centre of the circle that the rim rolls on.
Every step ends at the next record sample at the latest, because the forcing has a kink there.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, pi, sin, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._compile import jit
from .body import Body
from .equations import energy
from .stepping import copy, ground, is_flat, make_stepper, work_space
from .tsit5 import STAGES, Derivative
from .uplift import START, excess, nearest_branch, start_length, started, uplift_in

REST, COMPLETED, OVERTURNED, OVER_BUDGET, STALLED = range(5)  # how a march ends
MAXIMUM, MINIMUM = 1.0, -1.0

_HALF_PI = 0.5 * pi


class Options(NamedTuple):
    """What steers a march."""

    rtol: float  # tolerance of one step, relative
    seating: float  # tilt of the seating rule over alpha; 0 leaves the rule out
    restitution: float  # of the tilt rate where the base meets the ground in planar motion
    duration: float  # [s]
    step_budget: int
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


@jit
def with_row(
    rows: NDArray[np.float64], count: int, first: float, rest: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Write (first, *rest) as row `count` of a table, and return the table, doubled if it was full."""
    if count == len(rows):
        doubled = np.empty((2 * count, rows.shape[1]))
        for i in range(count):
            copy(rows[i], doubled[i])
        rows = doubled
    rows[count, 0] = first
    copy(rest, rows[count, 1:])
    return rows


@jit
def piece_of_record(
    samples: NDArray[np.float64],
    scale: float,
    time_step: float,
    index: int,
    a: NDArray[np.float64],
    slope: NDArray[np.float64],
) -> float:
    """Write acceleration and rate from sample `index` on to `a` and `slope`; return where it ends [s]."""
    if index >= len(samples) - 1:  # the ground is still after the record
        for i in range(3):
            a[i] = slope[i] = 0.0
        return np.inf
    for i in range(3):
        a[i] = scale * samples[index, i]
        slope[i] = (scale * samples[index + 1, i] - a[i]) / time_step
    return (index + 1) * time_step


@jit
def lift_off(
    body: Body,
    a: NDArray[np.float64],
    slope: NDArray[np.float64],
    at: float,
    time: float,
    last: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Write to `out` the state `time` after an uplift; `last` is the state in which it stood."""
    theta, omega, angle, rate = started(body, a, slope, at, time)
    copy(last, out)
    out[0], out[1], out[2] = theta, omega, nearest_branch(angle, last[2])
    if len(out) > 3:
        s = sin(theta)
        t = s / (1.0 + cos(theta))
        out[3] = s * s * (body.J + (2.0 * body.E + body.C * t) * t) * rate


@jit
def sits_down(body: Body, seating: float, y: NDArray[np.float64], ax: float, ay: float, az: float) -> bool:
    """Return whether the cylinder comes to rest: f < 0 and too little energy left to matter.

    The bound is the energy of a standstill at the tilt `seating` alpha, less what the ground
    acceleration takes off the restoring moment.
    """
    limit = seating * body.alpha
    if y[0] > 10.0 * limit:  # above the bound, unless az exceeds 9 g
        return False
    share = 1.0 + az / body.g - hypot(ax, ay) * body.cos_alpha / (body.g * body.sin_alpha)
    if share <= 0.0 or excess(body, ax, ay, az) >= 0.0:
        return False
    L = y[3] if len(y) > 3 else 0.0
    S = y[5] if len(y) > 5 else 0.0
    return energy(body, y[0], y[1], L, S) < share * energy(body, limit, 0.0, 0.0, 0.0)


@jit
def stand(y: NDArray[np.float64]) -> None:
    """Put the cylinder upright and at rest; rolling angle, twist and place stay."""
    y[0], y[1] = 0.0, 0.0
    if len(y) > 3:
        y[3] = 0.0
    if len(y) > 5:
        y[5] = 0.0


@jit
def surely_falls(body: Body, theta: float, strongest: float, lightest: float, time: float) -> bool:
    """Return whether a tilt above alpha that does not decrease is bound to reach pi/2 within `time`.

    `strongest` is the largest |a| and `lightest` the least g + az to come: beyond the equilibrium
    tilt under these two, theta'' is positive and grows with theta. The spin only adds to it.
    """
    if lightest <= 0.0:
        return False
    beyond = theta - body.alpha
    least = body.p2 / body.g * (lightest * sin(beyond) - strongest * cos(beyond))
    return least > 0.0 and 2.0 * (_HALF_PI - theta) < least * time * time


def make_driver(derivative: Derivative, size: int) -> Driver:
    """Return the compiled march of a model with `size` variables; see `tsit5.make_step`."""
    stepper = make_stepper(derivative, size)
    advance, partial, turning_point, crossing = stepper

    @jit
    def march(
        body: Body,
        options: Options,
        record: NDArray[np.float64],
        scale: float,
        time_step: float,
        initial: NDArray[np.float64],
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
        initial : ndarray, shape (size,)
            State at time zero; zero tilt stands at rest.
        times : ndarray, shape (n,)
            Increasing times at which the state is wanted [s]; they do not influence the steps.
        later : ndarray, shape (m, 2)
            From each sample on, the largest |a| and the least az of `record`, by which a fall that
            nothing can stop ends the march early; m = 0 marches on until the side is down.
        """
        y, work = initial.copy(), work_space(size)
        a, slope, a_now, turned = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
        samples, moving = np.zeros((len(times), size)), np.zeros(len(times), dtype=np.bool_)
        sample = 0
        extrema, extremum_count = np.empty((64, 4)), 0
        steps, recorded = np.empty((64, 1 + size)), 0
        step_count = 0
        first_start = START / sqrt(body.p2)

        resting = y[0] == 0.0
        uplift_time, uplift_direction = np.nan, np.nan
        if not resting:
            uplift_time, uplift_direction = 0.0, y[2]
        peak = y[0]
        h_next = first_start
        now, piece, status = 0.0, 0, COMPLETED

        while now < options.duration and status == COMPLETED:
            begin = now
            finish = min(piece_of_record(record, scale, time_step, piece, a, slope), options.duration)
            length = finish - begin
            elapsed = 0.0
            # the forcing jumps where a record begins or ends, and only there
            restart = piece == 0 or piece == len(record) - 1

            while now < finish and status == COMPLETED:
                if resting:
                    lift = uplift_in(body, a, slope, elapsed, length)
                    # one within a hair of the next sample is taken up there, already above the threshold
                    stays = lift < 0.0 or length - lift < 1e-3 * first_start
                    now = finish if stays else begin + lift
                    while sample < len(times) and times[sample] <= now:
                        copy(y, samples[sample])
                        sample += 1
                    if stays:
                        break
                    series = min(start_length(body, a, slope, lift), length - lift)
                    lift_off(body, a, slope, lift, series, y, work.y_new)
                    elapsed = lift + series
                    if work.y_new[0] <= 0.0:  # touched the threshold and fell back
                        continue
                    if np.isnan(uplift_time):
                        lift_off(body, a, slope, lift, 0.0, y, work.aside)
                        uplift_time, uplift_direction = now, work.aside[2]
                    while sample < len(times) and times[sample] <= begin + elapsed:
                        lift_off(body, a, slope, lift, times[sample] - now, y, samples[sample])
                        moving[sample] = True
                        sample += 1
                    copy(work.y_new, y)
                    peak = max(peak, y[0])
                    now = finish if elapsed >= length else begin + elapsed
                    h_next = 0.1 * series
                    resting, restart = False, True
                    continue

                ground(a, slope, elapsed, a_now)
                if restart:
                    derivative(body, y, a_now[0], a_now[1], a_now[2], work.k[0])
                    restart = False
                    if now == 0.0 and y[1] == 0.0:  # a release at rest is a turning point
                        turned[0], turned[1] = y[0], y[2]
                        turned[2] = MAXIMUM if work.k[0, 1] < 0.0 else MINIMUM
                        extrema = with_row(extrema, extremum_count, 0.0, turned)
                        extremum_count += 1

                h, h_next, trials = advance(
                    body, options.rtol, y, work, h_next, length - elapsed, a_now, slope
                )
                step_count += trials
                if h == 0.0 or step_count > options.step_budget:
                    status = STALLED if h == 0.0 else OVER_BUDGET
                    break

                turns = y[1] * work.y_new[1] < 0.0
                turn = 0.0
                if turns:
                    turn = turning_point(body, y, work, h, a_now, slope)
                    turned[0], turned[1] = work.aside[0], work.aside[2]
                    turned[2] = MAXIMUM if y[1] > 0.0 else MINIMUM
                    peak = max(peak, turned[0])
                # with spin the tilt stays positive; without it the base meets the ground
                lands = is_flat(y) and (work.y_new[0] <= 0.0 or (turns and turned[0] <= 0.0))
                falls = work.y_new[0] >= _HALF_PI
                if len(later) > 0 and work.y_new[0] > body.alpha and work.y_new[1] >= 0.0:
                    strongest, lightest = scale * later[piece, 0], body.g + scale * later[piece, 1]
                    if surely_falls(body, work.y_new[0], strongest, lightest, options.duration - now - h):
                        peak, status = _HALF_PI, OVERTURNED
                        break
                if lands or falls:
                    level = _HALF_PI if falls else 0.0
                    h = crossing(body, y, work, turn if lands and turns else h, a_now, slope, level)
                    copy(work.aside, work.y_new)
                    work.y_new[0] = level
                    turns = False
                whole = elapsed + h >= length
                after = finish if whole else begin + (elapsed + h)

                while sample < len(times) and times[sample] <= after:
                    if times[sample] == after:
                        copy(work.y_new, samples[sample])
                    else:
                        partial(body, y, work, times[sample] - now, a_now, slope, samples[sample])
                    moving[sample] = True
                    sample += 1
                if turns:
                    extrema = with_row(extrema, extremum_count, now + turn, turned)
                    extremum_count += 1

                copy(work.y_new, y)
                elapsed = length if whole else elapsed + h
                now = after
                peak = max(peak, y[0])
                copy(work.k[STAGES - 1], work.k[0])
                if falls:
                    status = OVERTURNED
                elif lands:
                    turned[0], turned[1], turned[2] = 0.0, y[2], MINIMUM
                    extrema = with_row(extrema, extremum_count, now, turned)
                    extremum_count += 1
                    y[1] = options.restitution * abs(y[1])
                    y[2] += -pi if y[2] > 0.0 else pi  # the opposite end of the diameter
                    restart = True
                if options.record_steps:
                    steps = with_row(steps, recorded, now, y)
                    recorded += 1
                if options.seating > 0.0 and not falls:
                    ground(a, slope, elapsed, a_now)
                    if sits_down(body, options.seating, y, a_now[0], a_now[1], a_now[2]):
                        resting = True
                        stand(y)
            piece += 1

        if status == COMPLETED and resting:
            status = REST
        return March(
            status,
            now,
            peak,
            uplift_time,
            uplift_direction,
            samples,
            moving,
            sample,
            y,
            extrema[:extremum_count],
            steps[:recorded],
            step_count,
        )

    return march
