"""One stage of a run: at rest, to the end of a piece of the record or to an uplift; in motion, one step.

What there is to list of it is left to the driver: a list that is handed on has its references counted in
every step.
"""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._compile import inlined, jit
from ..body import Body
from ..equations import base_inertia, energy
from ..restoring import standing_force, surely_overturns
from ..rolling import rolling_momentum
from ..trigonometry import sin_cos
from .balance import can_exceed_peak
from .events import NONE, REPEATED, Turn, make_events
from .record import Piece, Vector, ground
from .result import (
    COMPLETED,
    MAXIMUM,
    MINIMUM,
    OVER_BUDGET,
    OVERTURNED,
    OVERTURNED_TILT,
    STALLED,
    TURNED,
    Options,
    State,
    write,
)
from .stepping import Stepper
from .systems import System
from .uplift import excess, nearest_branch, start, start_length, uplift_in


@inlined
def may_come_to_rest(
    body: Body, rest_tilt: float, theta: float, omega: float, L: float, S: float, a: Vector
) -> bool:
    """Return whether the cylinder comes to rest: f < 0 and too little energy left to matter.

    The bound is the energy of a standstill at the tilt `rest_tilt` alpha, less what the ground
    acceleration takes off the restoring moment, to which the couple of rolling resistance adds: it wears the
    motion down where the ground overcomes the weight but not both. With it a twist rate may be left over,
    which near upright stays what it is, as B phi' does: then the bound is the energy with both at that tilt,
    beyond which the motion cannot rise. The twist is left to the friction of the base that closes.
    """
    limit = rest_tilt * body.alpha
    if theta > 10.0 * limit:  # above the bound of rest, unless az exceeds 9 g
        return False
    standing = energy(body, limit, 0.0, 0.0, 0.0)
    held = (1.0 + a[2] / body.g) * (1.0 + body.delta / body.b)
    share = held - hypot(a[0], a[1]) * body.cos_alpha / (body.g * body.sin_alpha)
    prestress = standing_force(body, 0.0) / body.g - 1.0
    share = (share + (1.0 + body.delta / body.b) * prestress) / (1.0 + prestress)
    if share <= 0.0 or excess(body, a) >= 0.0:
        return False
    if body.delta > 0.0 and S != 0.0:
        L_there = rolling_momentum(body, theta, L, S) - rolling_momentum(body, limit, 0.0, S)
        highest = energy(body, limit, 0.0, L_there, S) - (1.0 - share) * standing
        return theta < limit and energy(body, theta, omega, L, S) < highest
    return energy(body, theta, omega, L, S) < share * standing


Wanted = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]  # times, states there, in motion


class Sampling(NamedTuple):
    """Compiled functions that fill in samples; each returns the index of the next sample to fill."""

    of_rest: Callable[..., int]
    of_uplift: Callable[..., int]
    of_step: Callable[..., int]


def make_sampling(lifted: Callable[..., State], partial: Callable[..., tuple[State, State]]) -> Sampling:
    """Build the sampler of output times."""

    @inlined
    def of_rest(wanted: Wanted, sample: int, until: float, y: State) -> int:
        """Fill in samples during a rest."""
        times, states, _ = wanted
        while sample < len(times) and times[sample] <= until:
            write(y, states[sample])
            sample += 1
        return sample

    @inlined
    def of_uplift(
        wanted: Wanted,
        sample: int,
        until: float,
        body: Body,
        time_step: float,
        piece: Piece,
        lift: float,
        begin: float,
        y: State,
    ) -> int:
        """Fill in samples within the series of an uplift, which begins at the time `begin`."""
        times, states, moving = wanted
        while sample < len(times) and times[sample] <= until:
            write(lifted(body, time_step, piece, lift, times[sample] - begin, y), states[sample])
            moving[sample] = True
            sample += 1
        return sample

    @inlined
    def of_step(
        wanted: Wanted,
        sample: int,
        until: float,
        body: Body,
        work: NDArray[np.float64],
        path: object,
        begin: float,
        y_new: State,
    ) -> int:
        """Fill in samples of a step from the time `begin` to `until`, where the state is `y_new`."""
        times, states, moving = wanted
        while sample < len(times) and times[sample] <= until:
            if times[sample] == until:
                write(y_new, states[sample])
            else:
                y_at, _ = partial(body, work, path, times[sample] - begin)
                write(y_at, states[sample])
            moving[sample] = True
            sample += 1
        return sample

    return Sampling(of_rest, of_uplift, of_step)


_LEAST_STEP = 1e-200  # [s]; a run that needs a shorter step has stalled
_HAIR = 1e-6  # time in 1/p; an uplift nearer to the next sample begins there, short of a tilt of its square


@jit
def spin_momentum(body: Body, theta: float, phi_rate: float) -> float:
    """Return L = B phi' [m^2/s]."""
    s, c = sin_cos(theta)
    return s * s * base_inertia(body, s / (1.0 + c)) * phi_rate


class Lift(NamedTuple):
    """Uplift, or none, of a cylinder at rest within a piece of the record."""

    stays: bool
    at: float  # time of uplift since the beginning of the piece [s]
    length: float  # for which the series of the uplift is used [s]
    y: State  # state after the uplift


class Stage(NamedTuple):
    """State of a run between two steps, in a piece of the record."""

    elapsed: float  # since the beginning of the piece [s]
    y: State
    k: State  # values handed to the next step
    h_next: float  # length proposed for the next step [s]
    restart: bool  # whether the state or the forcing jumps here, so that `k` is computed anew
    resting: bool
    peak: float  # largest tilt so far [rad]
    sample: int  # index of the next sample to fill
    step_count: int
    status: int


class Step(NamedTuple):
    """One step of a run, with the turning point and the landing in it."""

    run: Stage  # run after the step
    turn: Turn  # the turning point inside it
    landing: Turn  # landing of the base, with the state at its end


@inlined
def absolute_time(piece: Piece, elapsed: float) -> float:
    """Time `elapsed` after the beginning of a piece; where the piece is over, exactly its end [s]."""
    return piece.finish if elapsed >= piece.length else piece.begin + elapsed


class Progress(NamedTuple):
    """Compiled functions that advance a run."""

    lifted: Callable[..., State]  # (body, time_step, piece, at, time, last)
    detect_uplift: Callable[..., Lift]  # (body, rtol, time_step, piece, elapsed, y)
    at_beginning: Callable[..., Stage]  # (run, jumps)
    at_rest: Callable[..., Stage]  # (body, run)
    stood: Callable[..., Stage]  # (body, time_step, piece, lift, wanted, run)
    moved: Callable[..., Step]  # (body, options, piece, later, index, following, work, wanted, run)


def make_progress(system: System, stepper: Stepper) -> Progress:
    """Functions that advance the runs of one model by one method."""
    _, restarted, _, partial, _ = stepper
    tried, ending_of = make_events(system, stepper)
    momenta = system.momenta
    placed: Callable[..., State] = system.placed
    prepares, ready, grows = system.prepares, system.ready, system.grows

    @jit
    def uplift_state(
        body: Body, time_step: float, piece: Piece, at: float, time: float, last: State
    ) -> State:
        """Return the state `time` after an uplift; `last` is the state in which it stood."""
        theta, omega, angle, rate = start(body, time_step, piece.a, piece.slope, at, time)
        angle = nearest_branch(angle, last[2])
        return placed(body, last, theta, omega, angle, spin_momentum(body, theta, rate))

    @inlined
    def detect_uplift(
        body: Body, rtol: float, time_step: float, piece: Piece, elapsed: float, y: State
    ) -> Lift:
        """Uplift of a cylinder at rest in the rest of a piece after `elapsed`, if there is one.

        An uplift within a hair of the next sample is taken up there, already above the threshold,
        however short that sample is.
        """
        wait = uplift_in(body, ground(piece.a, piece.slope, elapsed), piece.slope, piece.length - elapsed)
        at = elapsed + wait
        if wait < 0.0 or (at > 0.0 and piece.length - at < _HAIR / body.p):
            return Lift(True, at, 0.0, y)
        length = min(start_length(body, rtol, piece.a, piece.slope, at), piece.length - at)
        return Lift(False, at, length, uplift_state(body, time_step, piece, at, length, y))

    @inlined
    def bounce(body: Body, y: State, restitution: float) -> State:
        """State after the base met the ground in planar motion, where contact changes sides."""
        turn = -pi if y[2] > 0.0 else pi
        return placed(body, y, 0.0, restitution * abs(y[1]), y[2] + turn, 0.0)

    sample_rest, sample_uplift, sample_step = make_sampling(uplift_state, partial)

    @inlined
    def at_beginning(run: Stage, jumps: bool) -> Stage:
        """Run at the beginning of a piece; `jumps` says whether the forcing jumps there."""
        _, y, k, h_next, restart, resting, peak, sample, step_count, status = run
        return Stage(0.0, y, k, h_next, restart or jumps, resting, peak, sample, step_count, status)

    @inlined
    def falls(body: Body, y: State, later: NDArray[np.float64], index: int) -> bool:
        """Whether no later ground motion can keep the side from the ground."""
        outward = index < len(later) and y[0] > body.balance and y[1] >= 0.0
        return outward and surely_overturns(body, y[0], later[index, 0], body.g + later[index, 1])

    @inlined
    def at_rest(body: Body, run: Stage) -> Stage:
        """Run at rest from this time on."""
        elapsed, y, k, h_next, restart, _, peak, sample, step_count, status = run
        y = placed(body, y, 0.0, 0.0, y[2], 0.0)
        return Stage(elapsed, y, k, h_next, restart, True, peak, sample, step_count, status)

    @inlined
    def advance_at_rest(
        body: Body, time_step: float, piece: Piece, lift: Lift, wanted: Wanted, run: Stage
    ) -> Stage:
        """Carry a cylinder at rest to the end of a piece, or as far as the series of its uplift reaches."""
        _, y, k, h_next, restart, _, peak, sample, step_count, status = run
        begin = piece.finish if lift.stays else piece.begin + lift.at
        sample = sample_rest(wanted, sample, begin, y)
        elapsed = piece.length if lift.stays else lift.at + lift.length
        if lift.stays or lift.y[0] <= 0.0:  # no uplift, or one that only touched the threshold
            return Stage(elapsed, y, k, h_next, restart, True, peak, sample, step_count, status)
        until = piece.begin + elapsed
        sample = sample_uplift(wanted, sample, until, body, time_step, piece, lift.at, begin, y)
        peak, h_next = max(peak, lift.y[0]), 0.1 * lift.length
        return Stage(elapsed, lift.y, k, h_next, True, False, peak, sample, step_count, status)

    @inlined
    def move(
        body: Body,
        options: Options,
        piece: Piece,
        later: NDArray[np.float64],
        index: int,
        following: bool,
        work: NDArray[np.float64],
        wanted: Wanted,
        run: Stage,
    ) -> Step:
        """Advance by one step in the piece after sample `index`, at most to the next event.

        `following` says that the duration is over, so that the next maximum ends the run.
        """
        elapsed, y, k, h_next, restart, _, peak, sample, step_count, status = run
        a = ground(piece.a, piece.slope, elapsed)
        if prepares:
            before = momenta(y)
            y = ready(body, options.rtol, y, a, piece.slope)
            restart = restart or momenta(y) != before
        if restart:
            k = restarted(body, y, a, work)
        trial = tried(body, options.rtol, y, k, work, h_next, piece.length - elapsed, a, piece.slope)
        k, h_next, step_count = trial.k, trial.h_next, step_count + trial.trials
        restart, resting, turn, landing = False, False, NONE, NONE
        if step_count > options.step_budget:
            status = OVER_BUDGET
        elif trial.verdict == REPEATED:
            restart = trial.h > 0.0
            status = STALLED if h_next < _LEAST_STEP and not restart else COMPLETED
        elif falls(body, trial.y, later, index):
            peak, status = OVERTURNED_TILT, OVERTURNED
        else:
            ending = ending_of(body, work, y, trial)
            begin = absolute_time(piece, elapsed)
            elapsed = min(elapsed + ending.h, piece.length)
            until = absolute_time(piece, elapsed)
            sample = sample_step(wanted, sample, until, body, work, trial.path, begin, ending.y)
            if ending.turns:
                turn = trial.turn
                peak = max(peak, turn.tilt)
                status = TURNED if following and turn.kind == MAXIMUM else COMPLETED
            y, peak = ending.y, max(peak, ending.y[0])
            if grows and status == TURNED and can_exceed_peak(body, momenta, y, peak):
                status = COMPLETED
            if ending.overturns:
                status = OVERTURNED
            elif ending.lands:
                landing = Turn(MINIMUM, ending.h, 0.0, y[2])
                y, restart = bounce(body, y, options.restitution), True
                resting = y[1] == 0.0  # no speed is left: it stands, or uplifts again by (25) and (26)
            if not ending.overturns:
                a = ground(piece.a, piece.slope, elapsed)
                if options.rest_tilt > 0.0:
                    L, S = momenta(y)
                    resting = resting or may_come_to_rest(body, options.rest_tilt, y[0], y[1], L, S, a)
        after = Stage(elapsed, y, k, h_next, restart, resting, peak, sample, step_count, status)
        return Step(after, turn, landing)

    return Progress(uplift_state, detect_uplift, at_beginning, at_rest, advance_at_rest, move)
