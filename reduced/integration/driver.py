"""Time integration through a record: uplift, motion, turning points, rest, overturning.

One driver serves the three models; they differ in their equations and in the number of variables.
`systems` says which.
Every step ends at the next record sample at the latest, because the forcing has a kink there.

A run that ends while the cylinder moves is followed over still ground to the next maximum of the tilt, or
until it overturns; where rounding decides which, the run is undecided (`balance`). Of the maxima over still
ground the first is the largest, but on flat ground with a loss:

- Recess: energy and L are conserved, so the tilt oscillates between the same two turning points.
- Flat ground: Lambda' and S' are theta' times what is linear in (Lambda, S) with coefficients of theta alone.
  Both are thus functions of the tilt throughout a motion, whose two constants are integrals beside the
  energy (Appell and Chaplygin, of a rolling disc): the tilt again has the same two turning points.
- Losses lower each maximum: impacts in a plane, and rolling resistance in the recess, whose effect on the
  energy at the maximum goes with theta'^2 + sin^2(theta) phi' (phi' - L/B(theta_max)) >= 0.
- Flat ground with rolling resistance: no proof, and it is not so. The couple changes Lambda and S by itself,
  so that a motion which wobbles low with much spin may rise when that is lost. It is followed from maximum to
  maximum until its energy, which only falls, is below that of a standstill at the largest tilt so far.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from .._compile import borrowed, once
from ..body import Body
from .balance import can_exceed_peak, departs, is_undecided, longest_stay, turn_since, turns_back
from .events import NO_TURN
from .progress import Stage, absolute_time, make_progress
from .record import piece_of_record, still_from
from .result import (
    COMPLETED,
    MAXIMUM,
    MINIMUM,
    OVERTURNED,
    REST,
    TURNED,
    UNDECIDED,
    Driver,
    IntegrationResult,
    Options,
    Task,
    as_table,
    empty_log,
    has_turned,
    mark_of,
    write,
)
from .stepping import Stepper
from .systems import System

_FIRST_STEP = 1e-3  # first step in 1/p of a run that begins in motion
# numba gives a literal 0 a type of its own, for which its users would be compiled again
_FIRST_SAMPLE = cast("int", np.int64(0))
# time in 1/p after which a motion has turned or fallen; exceptions are stable steady wobble and a tilt nearer
# than 3e-7 to the balance, which is followed on
_LONGEST = 15.0


def make_driver(system: System, stepper: Stepper) -> Driver:
    """Return the compiled time integration of one model by one method."""
    lifted, detect_uplift, at_beginning, at_rest, stood, moved = make_progress(system, stepper)
    workspace, derivative = stepper.workspace, system.derivative
    momenta, creeps, grows = system.momenta, system.creeps, system.grows

    @once
    def integrate(body: Body, options: Options, task: Task) -> IntegrationResult:
        """Solve one problem."""
        record, time_step, initial, times, later = task
        owned = workspace(initial), np.zeros((len(times), len(initial))), np.zeros(len(times), dtype=np.bool_)
        # arrays borrowed without counting references; their owners are used last at the end of the function
        work, wanted = borrowed(owned[0]), (borrowed(times), borrowed(owned[1]), borrowed(owned[2]))
        bounds = borrowed(later)
        log = empty_log(initial)
        resting = initial[0] == 0.0
        uplift = (np.nan, np.nan) if resting else (0.0, initial[2])  # time and direction
        h_next = _FIRST_STEP / body.p
        run = Stage(0.0, initial, initial, h_next, True, resting, initial[0], _FIRST_SAMPLE, 0, COMPLETED)
        now, index, turned = 0.0, 0, np.nan
        still = still_from(record, time_step)
        end, following, mark = options.duration, False, mark_of(run.y, log)

        while run.status == COMPLETED:
            jumps = False
            if now >= end:
                stays = False  # a flag: `continue` makes numba count references
                if following and not run.resting and departs(body, run.y[0], momenta(run.y)[0]):
                    longest, since, _ = turn_since(log, still, now)
                    stays = longest <= longest_stay(body) and not (grows and has_turned(log, still))
                    if stays:
                        end = since + 1.01 * longest_stay(body)
                if not stays:
                    if following or run.resting:
                        break
                    rises = grows and can_exceed_peak(body, momenta, run.y, run.peak)
                    if has_turned(log, still) and not rises:
                        break
                    if creeps(body, run.y):
                        break
                    end, following, mark = now + _LONGEST / body.p, True, mark_of(run.y, log)
                    index, jumps = len(record), True
            piece = piece_of_record(record, time_step, index, now, end)
            if now == 0.0 and not resting and initial[1] == 0.0:  # a release at rest is a turning point
                back = turns_back(body, derivative(body, initial, piece.a)[1])
                kind = MAXIMUM if back else MINIMUM
                log.extrema.append((0.0, initial[0], initial[2], kind))
            # the forcing jumps where a record begins or ends, and only there
            run = at_beginning(run, jumps or index == 0 or index == len(record) - 1)
            while now < piece.finish and run.status == COMPLETED:
                if run.resting:
                    lift = detect_uplift(body, options.rtol, time_step, piece, run.elapsed, run.y)
                    last = run.y
                    run = stood(body, time_step, piece, lift, wanted, run)
                    if not run.resting:
                        begin = piece.begin + lift.at
                        if np.isnan(uplift[0]):
                            uplift = begin, lifted(body, time_step, piece, lift.at, 0.0, last)[2]
                        if len(log.rests) > 0:
                            log.rests[-1] = (log.rests[-1][0], begin)
                    now = absolute_time(piece, run.elapsed)
                    continue
                begin = now
                run, turn, landing = moved(body, options, piece, bounds, index, following, work, wanted, run)
                now = absolute_time(piece, run.elapsed)
                if turn.kind != NO_TURN:
                    turned = begin + turn.at
                    log.extrema.append((turned, turn.tilt, turn.angle, turn.kind))
                if landing.kind != NO_TURN:
                    log.extrema.append((now, landing.tilt, landing.angle, landing.kind))
                if options.record_steps and now > begin:
                    log.steps.append((now, *run.y))
                if run.resting:
                    log.rests.append((now, np.nan))
                    run = at_rest(body, run)
            index += 1

        y, status, followed = run.y, run.status, np.nan
        if following:
            followed = turned if status == TURNED else log.rests[-1][0] if run.resting else now
        falls = status == OVERTURNED
        moves = not run.resting and not creeps(body, run.y)
        if moves and now >= still and status in (OVERTURNED, COMPLETED, TURNED):
            L = momenta(run.y)[0]
            if is_undecided(body, run.y[0], L, log, still, now, falls, grows):
                status = UNDECIDED
        if following and status in (COMPLETED, TURNED, UNDECIDED):
            y, now, status = mark.y, options.duration, UNDECIDED if status == UNDECIDED else COMPLETED
        else:
            mark = mark_of(y, log)
            if status == COMPLETED and run.resting:
                status = REST
        final = np.empty(len(y))
        write(y, final)
        owned[0][0] = 0.0
        return IntegrationResult(
            status,
            now,
            followed,
            run.peak,
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
