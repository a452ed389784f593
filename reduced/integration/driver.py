"""Time integration through a record: rest, uplift, motion, turning points, rest_tilt, overturning.

One driver serves the three models; they differ in their equations and in the number of variables.
`systems` says which.
Every step ends at the next record sample at the latest, because the forcing has a kink there.

A run that ends with more energy than standing on the rim at alpha takes is carried on over still ground
until it is decided whether the cylinder overturns: free motion returns to the same largest tilt, so its
next maximum tells.
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
from numpy.typing import NDArray

from .._compile import borrowed, jit
from ..body import Body
from ..trigonometry import sin_cos
from .endings import HALF_PI, may_overturn, may_sit_down, surely_falls
from .march import (
    COMPLETED,
    MAXIMUM,
    MINIMUM,
    OVER_BUDGET,
    OVERTURNED,
    REST,
    STALLED,
    Driver,
    March,
    Options,
    as_table,
    piece_of_record,
    write,
)
from .stepping import Stepper, make_events
from .systems import System
from .tsit5 import State, Vector, ground
from .uplift import nearest_branch, start_length, started, uplift_in

_LEAST_STEP = 1e-200  # a step that must be shorter fails whatever its length [s]
_FIRST_STEP = 1e-3  # of 1/p, where a run begins in motion
_RETRY = 1.0 / 32.0  # of a step that went wrong; the next may be four times as long
_HAIR = 1e-6  # of 1/p; an uplift so near to the next sample leaves no more than its square
# of 1/p; what leaves the balance, or unstable steady wobble, grows by exp(p t): in this time all motion turns
# or falls but what is nearer to them than 3e-7, which nobody could tell from resting there
_UNDECIDED = 15.0


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
    def lifted(
        body: Body, time_step: float, a: Vector, slope: Vector, at: float, time: float, last: State
    ) -> State:
        """Return the state `time` after an uplift; `last` is the state in which it stood."""
        theta, omega, angle, rate = started(body, time_step, a, slope, at, time)
        return placed(last, theta, omega, nearest_branch(angle, last[2]), spin_momentum(body, theta, rate))

    @jit
    def march(
        body: Body,
        options: Options,
        record: NDArray[np.float64],
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
        time_step : float
            Their spacing [s].
        initial : tuple of float
            State at time zero; zero tilt stands at rest.
        times : ndarray, shape (n,)
            Increasing times at which the state is wanted [s]; they do not influence the steps.
        later : ndarray, shape (m, 2)
            From each sample on, the largest |a| and the least az of `record` [m/s^2], by which a fall that
            nothing can stop ends the integration early; m = 0 goes on until the side is down.
        """
        size = len(initial)
        y, k = initial, initial
        owned = workspace(initial)  # until its last use, at the end
        work = borrowed(owned)
        samples, moving = np.zeros((len(times), size)), np.zeros(len(times), dtype=np.bool_)
        sample = 0
        # lists, typed by a row and emptied: a growing array would have its references counted in each step
        extrema, rests, steps = [(0.0, 0.0, 0.0, 0.0)], [(0.0, 0.0)], [(0.0, *initial)]
        extrema.clear()
        rests.clear()
        steps.clear()
        step_count = 0

        resting = y[0] == 0.0
        uplift_time, uplift_direction = np.nan, np.nan
        if not resting:
            uplift_time, uplift_direction = 0.0, y[2]
        peak = y[0]
        h_next = _FIRST_STEP / body.p
        now, piece, status = 0.0, 0, COMPLETED
        restart = True  # kept until a step has been made ready, also when an uplift ends at a sample
        end, deciding, decided = options.duration, False, False
        y_end, peak_end, kept = y, peak, (0, 0, 0)  # what stood when the duration was over

        while status == COMPLETED and not decided:
            if now >= end:
                if deciding or resting or not may_overturn(body, y[0], y[1], *momenta(y)):
                    break
                deciding, end = True, now + _UNDECIDED / body.p
                y_end, peak_end, kept = y, peak, (len(extrema), len(rests), len(steps))
                piece, restart = len(record), True
            begin = now
            a, slope, finish = piece_of_record(record, time_step, piece)
            finish = min(finish, end)
            length = finish - begin
            elapsed = 0.0
            # the forcing jumps where a record begins or ends, and only there
            restart = restart or piece == 0 or piece == len(record) - 1

            while now < finish and status == COMPLETED and not decided:
                if resting:
                    wait = uplift_in(body, ground(a, slope, elapsed), slope, length - elapsed)
                    lift = elapsed + wait
                    # one within a hair of the next sample is taken up there, already above the threshold,
                    # however short that sample is
                    stays = wait < 0.0 or (lift > 0.0 and length - lift < _HAIR / body.p)
                    now = finish if stays else begin + lift
                    while sample < len(times) and times[sample] <= now:
                        write(y, samples[sample])
                        sample += 1
                    if stays:
                        break
                    series = min(start_length(body, options.rtol, a, slope, lift), length - lift)
                    y_new = lifted(body, time_step, a, slope, lift, series, y)
                    elapsed = lift + series
                    if y_new[0] <= 0.0:  # touched the threshold and fell back
                        continue
                    if np.isnan(uplift_time):
                        uplift_time = now
                        uplift_direction = lifted(body, time_step, a, slope, lift, 0.0, y)[2]
                    if len(rests) > 0:
                        rests[-1] = (rests[-1][0], now)
                    while sample < len(times) and times[sample] <= begin + elapsed:
                        y_at = lifted(body, time_step, a, slope, lift, times[sample] - now, y)
                        write(y_at, samples[sample])
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
                if step_count > options.step_budget:
                    status = OVER_BUDGET
                    break
                if h == 0.0:
                    if h_next < _LEAST_STEP:
                        status = STALLED
                        break
                    continue

                turns = y[1] * y_new[1] < 0.0
                turn = turned_tilt = turned_angle = 0.0
                if turns:
                    turn, turned_tilt, turned_angle = turning_point(body, work, path, y, h, y_new[1])
                # with spin the tilt stays positive; without it the base meets the ground
                flat = is_flat(y) and is_flat(y_new)
                lands = flat and (y_new[0] <= 0.0 or (turns and turned_tilt <= 0.0))
                if turns and not flat and turned_tilt <= 0.0:  # it jumped the barrier and came back
                    h_next, restart = _RETRY * h, True
                    continue
                falls = y_new[0] >= HALF_PI
                outward = piece < len(later) and y_new[0] > body.alpha and y_new[1] >= 0.0
                if outward and surely_falls(body, y_new[0], later[piece, 0], body.g + later[piece, 1]):
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
                    peak = max(peak, turned_tilt)
                    decided = deciding and kind == MAXIMUM

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
                    resting = y[1] == 0.0  # no speed is left: it stands, or lifts off again by (25) and (26)
                if options.record_steps:
                    steps.append((now, *y))
                if options.rest_tilt > 0.0 and not falls:
                    L, S = momenta(y)
                    a_now = ground(a, slope, elapsed)
                    resting = resting or may_sit_down(body, options.rest_tilt, y[0], y[1], L, S, a_now)
                if resting:
                    rests.append((now, np.nan))
                    y = placed(y, 0.0, 0.0, y[2], 0.0)
            piece += 1

        if deciding and status == COMPLETED:
            y, peak, now = y_end, peak_end, options.duration
        else:
            kept = (len(extrema), len(rests), len(steps))
        if status == COMPLETED and resting and not deciding:
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
            as_table(extrema, kept[0], 4),
            as_table(rests, kept[1], 2),
            as_table(steps, kept[2], 1 + size),
            step_count,
        )

    return march
