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
from typing import NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from .._compile import borrowed, inlined, jit, once
from ..body import Body
from ..trigonometry import sin_cos
from .endings import HALF_PI, may_overturn, may_sit_down, surely_overturns
from .events import REPEATED, make_events
from .log import as_table, empty_log, mark_of
from .march import (
    COMPLETED,
    DECIDED,
    MAXIMUM,
    MINIMUM,
    OVER_BUDGET,
    OVERTURNED,
    REST,
    STALLED,
    Driver,
    March,
    Options,
    Piece,
    piece_of_record,
    write,
)
from .sampling import make_sampling
from .stepping import Stepper
from .systems import System
from .tsit5 import State, ground
from .uplift import nearest_branch, start_length, started, uplift_in

_LEAST_STEP = 1e-200  # a step that must be shorter fails whatever its length [s]
_FIRST_STEP = 1e-3  # of 1/p, where a run begins in motion
# a literal 0 has a type of its own, for which its users would be compiled too
_FIRST_SAMPLE = cast("int", np.int64(0))
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


class Lift(NamedTuple):
    """Uplift, or none, of a cylinder at rest within a piece of the record."""

    stays: bool
    at: float  # time of uplift since the beginning of the piece [s]
    length: float  # for which the series of the uplift is used [s]
    y: State  # after it


def make_driver(system: System, stepper: Stepper) -> Driver:
    """Return the compiled march of one model by one method."""
    workspace, restarted, _, partial, _ = stepper
    tried, ending_of = make_events(system, stepper)
    derivative, momenta = system.derivative, system.momenta
    placed: Callable[..., State] = system.placed

    @jit
    def lifted(body: Body, time_step: float, piece: Piece, at: float, time: float, last: State) -> State:
        """Return the state `time` after an uplift; `last` is the state in which it stood."""
        theta, omega, angle, rate = started(body, time_step, piece.a, piece.slope, at, time)
        return placed(last, theta, omega, nearest_branch(angle, last[2]), spin_momentum(body, theta, rate))

    @inlined
    def lift_in(body: Body, rtol: float, time_step: float, piece: Piece, elapsed: float, y: State) -> Lift:
        """Return the uplift of a cylinder at rest after `elapsed` of a piece, if it does.

        An uplift within a hair of the next sample is taken up there, already above the threshold,
        however short that sample is.
        """
        wait = uplift_in(body, ground(piece.a, piece.slope, elapsed), piece.slope, piece.length - elapsed)
        at = elapsed + wait
        if wait < 0.0 or (at > 0.0 and piece.length - at < _HAIR / body.p):
            return Lift(True, at, 0.0, y)
        length = min(start_length(body, rtol, piece.a, piece.slope, at), piece.length - at)
        return Lift(False, at, length, lifted(body, time_step, piece, at, length, y))

    @inlined
    def rebounded(y: State, restitution: float) -> State:
        """Return the state after the base met the ground in planar motion: contact changes sides."""
        opposite = y[2] + (-pi if y[2] > 0.0 else pi)
        return placed(y, 0.0, restitution * abs(y[1]), opposite, 0.0)

    sample_rest, sample_uplift, sample_step = make_sampling(lifted, partial)

    @once
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
        y, k, peak = initial, initial, initial[0]
        owned = workspace(y), np.zeros((len(times), len(y))), np.zeros(len(times), dtype=np.bool_)
        # borrowed until the last use of what they were borrowed from, at the end
        work, wanted = borrowed(owned[0]), (borrowed(times), borrowed(owned[1]), borrowed(owned[2]))
        log = empty_log(y)
        resting = y[0] == 0.0
        uplift = (np.nan, np.nan) if resting else (0.0, y[2])  # time and direction
        now, index, sample, step_count, status = 0.0, 0, _FIRST_SAMPLE, 0, COMPLETED
        h_next, restart = _FIRST_STEP / body.p, True  # until a step has been made ready
        end, deciding, mark = options.duration, False, mark_of(y, peak, log)

        while status == COMPLETED:
            if now >= end:
                if deciding or resting or not may_overturn(body, y[0], y[1], *momenta(y)):
                    break
                end, deciding, mark = now + _UNDECIDED / body.p, True, mark_of(y, peak, log)
                index, restart = len(record), True
            piece = piece_of_record(record, time_step, index, now, end)
            elapsed = 0.0
            # the forcing jumps where a record begins or ends, and only there
            restart = restart or index == 0 or index == len(record) - 1

            while now < piece.finish and status == COMPLETED:
                if resting:
                    lift = lift_in(body, options.rtol, time_step, piece, elapsed, y)
                    now = piece.finish if lift.stays else piece.begin + lift.at
                    sample = sample_rest(wanted, sample, now, y)
                    elapsed = lift.at + lift.length
                    if lift.stays or lift.y[0] <= 0.0:  # or touched the threshold and fell back
                        continue
                    if np.isnan(uplift[0]):
                        uplift = now, lifted(body, time_step, piece, lift.at, 0.0, y)[2]
                    if len(log.rests) > 0:
                        log.rests[-1] = (log.rests[-1][0], now)
                    until = piece.begin + elapsed
                    sample = sample_uplift(wanted, sample, until, body, time_step, piece, lift.at, now, y)
                    y, peak, h_next = lift.y, max(peak, lift.y[0]), 0.1 * lift.length
                    now = piece.finish if elapsed >= piece.length else until
                    resting, restart = False, True
                    continue

                a = ground(piece.a, piece.slope, elapsed)
                if restart:
                    k = restarted(body, y, a, work)
                    restart = False
                    if now == 0.0 and y[1] == 0.0:  # a release at rest is a turning point
                        kind = MAXIMUM if derivative(body, y, a)[1] < 0.0 else MINIMUM
                        log.extrema.append((0.0, y[0], y[2], kind))
                trial = tried(body, options.rtol, y, k, work, h_next, piece.length - elapsed, a, piece.slope)
                k, h_next = trial.k, trial.h_next
                step_count += trial.trials
                if step_count > options.step_budget:
                    status = OVER_BUDGET
                    break
                if trial.verdict == REPEATED:
                    restart = trial.h > 0.0
                    status = STALLED if h_next < _LEAST_STEP and not restart else COMPLETED
                    continue
                outward = index < len(later) and trial.y[0] > body.alpha and trial.y[1] >= 0.0
                if outward and surely_overturns(body, trial.y[0], later[index, 0], body.g + later[index, 1]):
                    peak, status = HALF_PI, OVERTURNED
                    break

                ending = ending_of(body, work, y, trial)
                elapsed += ending.h
                now, begin = piece.begin + elapsed, now
                if elapsed >= piece.length:
                    elapsed, now = piece.length, piece.finish
                sample = sample_step(wanted, sample, now, body, work, trial.path, begin, ending.y)
                if ending.turns:
                    turn = trial.turn
                    log.extrema.append((begin + turn.at, turn.tilt, turn.angle, turn.kind))
                    peak = max(peak, turn.tilt)
                    status = DECIDED if deciding and turn.kind == MAXIMUM else COMPLETED
                y, peak = ending.y, max(peak, ending.y[0])
                if ending.overturns:
                    status = OVERTURNED
                elif ending.lands:
                    log.extrema.append((now, 0.0, y[2], MINIMUM))
                    y, restart = rebounded(y, options.restitution), True
                    resting = y[1] == 0.0  # no speed is left: it stands, or lifts off again by (25) and (26)
                if options.record_steps:
                    log.steps.append((now, *y))
                if options.rest_tilt > 0.0 and not ending.overturns:
                    a = ground(piece.a, piece.slope, elapsed)
                    L, S = momenta(y)
                    resting = resting or may_sit_down(body, options.rest_tilt, y[0], y[1], L, S, a)
                if resting:
                    log.rests.append((now, np.nan))
                    y = placed(y, 0.0, 0.0, y[2], 0.0)
            index += 1

        if deciding and status in (COMPLETED, DECIDED):
            y, peak, now, status = mark.y, mark.peak, options.duration, COMPLETED
        else:
            mark = mark_of(y, peak, log)
            if status == COMPLETED and resting:
                status = REST
        final = np.empty(len(y))
        write(y, final)
        owned[0][0] = 0.0
        return March(
            status,
            now,
            peak,
            uplift[0],
            uplift[1],
            owned[1],
            owned[2],
            sample,
            final,
            as_table(log.extrema, mark.counts[0], 4),
            as_table(log.rests, mark.counts[1], 2),
            as_table(log.steps, mark.counts[2], 1 + len(y)),
            step_count,
        )

    return march
