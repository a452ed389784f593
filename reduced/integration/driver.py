"""Time integration through a record: uplift, motion, turning points, rest, overturning.

One driver serves the three models; they differ in their equations and in the number of variables.
`systems` says which.
Every step ends at the next record sample at the latest, because the forcing has a kink there.

A run that ends with more energy than standing on the rim at alpha takes is carried on over still ground
until it is decided whether the cylinder overturns: free motion returns to the same largest tilt, so its
next maximum tells.
"""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import NDArray

from .._compile import borrowed, once
from ..body import Body
from .endings import may_overturn
from .events import NO_TURN
from .log import as_table, empty_log, mark_of
from .progress import Stage, make_progress, time_in
from .record import piece_of_record
from .result import (
    COMPLETED,
    DECIDED,
    MAXIMUM,
    MINIMUM,
    REST,
    Driver,
    IntegrationResult,
    Options,
    write,
)
from .stepping import Stepper
from .systems import System
from .tsit5 import State

_FIRST_STEP = 1e-3  # of 1/p, where a run begins in motion
# a literal 0 has a type of its own, for which its users would be compiled too
_FIRST_SAMPLE = cast("int", np.int64(0))
# of 1/p; what leaves the balance, or unstable steady wobble, grows by exp(p t): in this time all motion turns
# or falls but what is nearer to them than 3e-7, which nobody could tell from resting there
_UNDECIDED = 15.0


def make_driver(system: System, stepper: Stepper) -> Driver:
    """Return the compiled time integration of one model by one method."""
    lifted, lift_in, at_beginning, at_rest, stood, moved = make_progress(system, stepper)
    workspace, derivative, momenta = stepper.workspace, system.derivative, system.momenta

    @once
    def integrate(
        body: Body,
        options: Options,
        record: NDArray[np.float64],
        time_step: float,
        initial: State,
        times: NDArray[np.float64],
        later: NDArray[np.float64],
    ) -> IntegrationResult:
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
        owned = workspace(initial), np.zeros((len(times), len(initial))), np.zeros(len(times), dtype=np.bool_)
        # borrowed until the last use of what they were borrowed from, at the end
        work, wanted = borrowed(owned[0]), (borrowed(times), borrowed(owned[1]), borrowed(owned[2]))
        bounds = borrowed(later)
        log = empty_log(initial)
        resting = initial[0] == 0.0
        uplift = (np.nan, np.nan) if resting else (0.0, initial[2])  # time and direction
        h_next = _FIRST_STEP / body.p
        run = Stage(0.0, initial, initial, h_next, True, resting, initial[0], _FIRST_SAMPLE, 0, COMPLETED)
        now, index = 0.0, 0
        end, deciding, mark = options.duration, False, mark_of(run.y, run.peak, log)

        while run.status == COMPLETED:
            jumps = False
            if now >= end:
                if deciding or run.resting or not may_overturn(body, run.y[0], run.y[1], *momenta(run.y)):
                    break
                end, deciding, mark = now + _UNDECIDED / body.p, True, mark_of(run.y, run.peak, log)
                index, jumps = len(record), True
            piece = piece_of_record(record, time_step, index, now, end)
            if now == 0.0 and not resting and initial[1] == 0.0:  # a release at rest is a turning point
                kind = MAXIMUM if derivative(body, initial, piece.a)[1] < 0.0 else MINIMUM
                log.extrema.append((0.0, initial[0], initial[2], kind))
            # the forcing jumps where a record begins or ends, and only there
            run = at_beginning(run, jumps or index == 0 or index == len(record) - 1)
            while now < piece.finish and run.status == COMPLETED:
                if run.resting:
                    lift = lift_in(body, options.rtol, time_step, piece, run.elapsed, run.y)
                    last = run.y
                    run = stood(body, time_step, piece, lift, wanted, run)
                    if not run.resting:
                        begin = piece.begin + lift.at
                        if np.isnan(uplift[0]):
                            uplift = begin, lifted(body, time_step, piece, lift.at, 0.0, last)[2]
                        if len(log.rests) > 0:
                            log.rests[-1] = (log.rests[-1][0], begin)
                    now = time_in(piece, run.elapsed)
                    continue
                begin = now
                run, turn, landing = moved(body, options, piece, bounds, index, deciding, work, wanted, run)
                now = time_in(piece, run.elapsed)
                if turn.kind != NO_TURN:
                    log.extrema.append((begin + turn.at, turn.tilt, turn.angle, turn.kind))
                if landing.kind != NO_TURN:
                    log.extrema.append((now, landing.tilt, landing.angle, landing.kind))
                if options.record_steps and now > begin:
                    log.steps.append((now, *run.y))
                if run.resting:
                    log.rests.append((now, np.nan))
                    run = at_rest(body, run)
            index += 1

        y, peak, status = run.y, run.peak, run.status
        if deciding and status in (COMPLETED, DECIDED):
            y, peak, now, status = mark.y, mark.peak, options.duration, COMPLETED
        else:
            mark = mark_of(y, peak, log)
            if status == COMPLETED and run.resting:
                status = REST
        final = np.empty(len(y))
        write(y, final)
        owned[0][0] = 0.0
        return IntegrationResult(
            status,
            now,
            peak,
            uplift[0],
            uplift[1],
            owned[1],
            owned[2],
            run.sample,
            final,
            as_table(log.extrema, mark.counts[0], 4),
            as_table(log.rests, mark.counts[1], 2),
            as_table(log.steps, mark.counts[2], 1 + len(y)),
            run.step_count,
        )

    return integrate
