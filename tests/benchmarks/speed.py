"""How much faster the reduced kernel is than other solvers on the same equations.

One run: El Centro on R = 6 m, tan(alpha) = 0.2 until ten seconds after uplift. Each solver gets the
loosest tolerance with which its own error at the end is below 1e-7 alpha; then all are timed in turn,
round after round, so that a change of the machine's speed meets them alike, and the ratio is taken
inside each round. ``python tests/benchmarks speed`` prints the table, and ``--frame`` the time of a step with
a frame over that with a cylinder: both run in turn, and the ratio is taken inside each round.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, WobblingFrame, el_centro_1940
from rockwobble.reduced.body import body_of
from rockwobble.reduced.problem import Problem as ReducedProblem
from rockwobble.reduced.simulation import make_ready
from rockwobble.reduced.solution import Solution
from rockwobble.reports.published.tradeoff.methods import SOLVERS, TOLERANCE_SCALE, SolverName, start_of

from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

State = NDArray[np.float64]
TARGET = 1e-7  # error at the end, in alpha
_AFTER_UPLIFT = 10.0  # [s]
_START = 2e-3  # the other solvers start this long after uplift [s]: it is singular for them
_TOLERANCES = 10.0 ** -np.arange(5.0, 13.1, 0.25)


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """The run, for solvers that cannot uplift from just after it, and its exact end."""

    case: Case
    start: float  # [s]
    state: State  # theta, theta', phi, L at the start
    exact: State  # theta, theta' at the end

    def error(self, state: State) -> float:
        """Error of theta and theta'/p at the end, in alpha."""
        cylinder = self.case.cylinder
        p = math.sqrt(12.0 / (15.0 + math.cos(cylinder.alpha) ** 2) * 9.81 / cylinder.semidiagonal)
        tilt, rate = abs(state[0] - self.exact[0]), abs(state[1] - self.exact[1])
        return float(max(tilt, rate / p)) / cylinder.alpha


@dataclass(frozen=True, slots=True, kw_only=True)
class Solver:
    """One way to solve the problem: a function of the tolerance that returns end state and work.

    Work is what the method counts: right-hand sides, or series where it is one of Taylor.
    """

    name: str
    solve: Callable[[float], tuple[State, int]]


def el_centro_problem() -> Problem:
    """Return the problem of the benchmark."""
    cylinder, motion = Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940()
    uplift = reduced.simulate(Case(cylinder, motion), rtol=1e-13).uplift_time
    end = uplift + _AFTER_UPLIFT
    start = reduced.simulate(Case(cylinder, motion, duration=uplift + _START), rtol=1e-13).source
    assert isinstance(start, Solution)
    exact = reduced.simulate(Case(cylinder, motion, duration=end), rtol=1e-13)
    return Problem(
        case=Case(cylinder, motion, duration=end),
        start=uplift + _START,
        state=start.states[-1, :4],
        exact=np.array([exact.tilt[-1], exact.tilt_rate[-1]]),
    )


def kernel(problem: Problem) -> Solver:
    """The reduced kernel, from rest, uplift included."""

    def solve(rtol: float) -> tuple[State, int]:
        trace = reduced.simulate(problem.case, rtol=rtol, sample_step=problem.case.length)
        return np.array([trace.tilt[-1], trace.tilt_rate[-1]]), trace.step_count

    return Solver(name="rockwobble", solve=solve)


def scipy_solver(problem: Problem, method: SolverName, *, compiled: bool) -> Solver:
    """One of scipy's solvers, over the whole record, with equations in Python or compiled."""
    from scipy.integrate import solve_ivp

    rates = start_of(problem.case, compiled=compiled).function
    span = (problem.start, problem.case.length)

    def solve(rtol: float) -> tuple[State, int]:
        run = solve_ivp(rates, span, problem.state, method, rtol=rtol, atol=rtol * TOLERANCE_SCALE)
        return run.y[:2, -1], int(run.nfev)

    return Solver(name=f"scipy {method}, {'numba' if compiled else 'Python'}", solve=solve)


def heyoka_solver(problem: Problem) -> Solver | None:
    """Taylor series compiled by heyoka, sample by sample; None where it is not installed."""
    try:
        import heyoka as hy
    except ImportError:
        return None
    cylinder, motion = problem.case.cylinder, problem.case.motion
    assert motion is not None
    b, h = cylinder.base_radius, cylinder.half_height
    I1, I2, g = (3.0 * b * b + 4.0 * h * h) / 12.0, 0.5 * b * b, 9.81
    A, J, C, E = I1 + h * h + b * b, I1 + h * h, I2 + b * b, h * b
    theta, omega, phi, L = hy.make_vars("theta", "omega", "phi", "L")
    # acceleration at the last sample and its rate, time counted from that sample
    ax, ay = hy.par[0] + hy.par[2] * hy.time, hy.par[1] + hy.par[3] * hy.time
    s, c = hy.sin(theta), hy.cos(theta)
    v = s * s / (1.0 + c)
    phi_rate = L / (J * s * s + (2.0 * E * s + C * v) * v)
    acceleration = ((J * c + C * v) * s + E * (c * v + s * s)) * phi_rate * phi_rate
    acceleration -= g * (b * c - h * s) + (b * s + h * c) * (ax * hy.cos(phi) + ay * hy.sin(phi))
    lever = h * s + b * v
    system = [
        (theta, omega),
        (omega, acceleration / A),
        (phi, phi_rate),
        (L, lever * (ax * hy.sin(phi) - ay * hy.cos(phi))),
    ]
    step, samples = motion.time_step, motion.acceleration
    slopes = np.diff(samples, axis=0) / step
    integrators: dict[float, Any] = {}

    def solve(rtol: float) -> tuple[State, int]:
        if rtol not in integrators:
            integrators[rtol] = hy.taylor_adaptive(system, state=problem.state.copy(), tol=rtol)
        run = integrators[rtol]
        run.state[:] = problem.state
        end = problem.case.length
        first, last, steps = int(problem.start / step), int(end / step), 0
        for i in range(first, last + 1):
            run.pars[:2], run.pars[2:] = samples[i], slopes[i]
            run.time = problem.start - i * step if i == first else 0.0
            steps += run.propagate_until(end - i * step if i == last else step)[3]
        return np.array(run.state[:2]), steps

    return Solver(name="heyoka (compiled)", solve=solve)


def loosest_tolerance(problem: Problem, solver: Solver) -> float:
    """Return the largest tolerance from which on the error stays below the target.

    An error that happens to be small at one tolerance does not count: the next two must hold too.
    """
    errors: list[float] = []
    for rtol in _TOLERANCES:
        errors.append(problem.error(solver.solve(float(rtol))[0]))
        if len(errors) >= 3 and max(errors[-3:]) <= TARGET:
            return float(_TOLERANCES[len(errors) - 3])
    raise ValueError(f"{solver.name} does not reach an error of {TARGET:g} alpha")


def measure(
    *, rounds: int = 7, compiled: bool = True, say: Callable[[str], None] | None = None
) -> pd.DataFrame:
    """Time the solvers in turn and return one row each.

    Parameters
    ----------
    rounds : int, optional
        How often each is timed.
    compiled : bool, optional
        Whether to give scipy the equations compiled, too.
    say : callable, optional
        Called with a line of progress.

    Returns
    -------
    DataFrame
        solver, ratio (median over the rounds of its time over that of rockwobble), milliseconds
        (median), tolerance, error (in alpha), calls (right-hand sides for scipy; for rockwobble and
        heyoka Taylor series, each of which costs as much as several of them).
    """
    import pandas as pd

    problem = el_centro_problem()
    solvers = [kernel(problem)]
    for each in (False, True) if compiled else (False,):
        solvers += [scipy_solver(problem, method, compiled=each) for method in SOLVERS]
    peer = heyoka_solver(problem)
    if peer is not None:
        solvers.append(peer)
    tolerances = []
    for solver in solvers:
        if say is not None:
            say(f"finding the tolerance of {solver.name}")
        tolerances.append(loosest_tolerance(problem, solver))
    times = np.empty((rounds, len(solvers)))
    for i in range(rounds):
        if say is not None:
            say(f"round {i + 1} of {rounds}")
        for j, solver in enumerate(solvers):
            # the quick ones are repeated, so that a tick of the clock does not show
            repeats = 20 if j == 0 or times[0, j] < 0.02 else 1
            times[i, j] = np.median([_seconds(solver, tolerances[j]) for _ in range(repeats)])
    ends = [solver.solve(rtol) for solver, rtol in zip(solvers, tolerances, strict=True)]
    return pd.DataFrame(
        {
            "solver": [solver.name for solver in solvers],
            "ratio": np.median(times / times[:, :1], axis=0),
            "milliseconds": 1e3 * np.median(times, axis=0),
            "tolerance": tolerances,
            "error": [problem.error(end[0]) for end in ends],
            "calls": [end[1] for end in ends],
        }
    )


FRAME_FORMS = {"model": "", "cylinder": "", "steps": "d", "steps_frame": "d"} | dict.fromkeys(
    ("ratio", "low", "high"), ".3f"
)


def frame_ratios(rounds: int = 200) -> pd.DataFrame:
    """Return the time a step of each kernel with a frame over that with a cylinder, and its quartiles.

    Of a cylinder as its columns, and of one with its p, which in one plane makes its motion: what a step
    takes depends on the motion, too.
    """
    import pandas as pd

    pier, rows = Cylinder(semidiagonal=6.0, tan_alpha=0.2), []
    frame, motion = WobblingFrame(pier, 1.0), el_centro_1940().scaled(2.0)
    size = pier.semidiagonal * body_of(pier, 1.0).p2 / body_of(frame, 1.0).p2
    larger = Cylinder(semidiagonal=size, tan_alpha=pier.tan_alpha)
    for model, options in reduced.MODELS.items():
        given = {"support": "recess", "plane": None, "restitution": 1.0, "rest_tilt": 1e-8} | dict(options)
        for name, cylinder in (("of its columns", pier), ("of its p", larger)):
            cases = (Case(body, motion, duration=20.0) for body in (cylinder, frame))
            problems = [ReducedProblem(case, rtol=1e-8, **given) for case in cases]
            rows.append((model, name, *_step_ratio(problems, rounds)))
    return pd.DataFrame(rows, columns=list(FRAME_FORMS))


def _step_ratio(problems: Sequence[ReducedProblem], rounds: int) -> tuple[float, ...]:
    """Return the steps of two problems, and the median and quartiles of the ratio of their times a step."""
    for problem in problems:
        make_ready(problem.kernel)
    steps = [problem.solve(np.empty(0))[0].step_count for problem in problems]
    ratios = []
    for turn in range(rounds):
        times = {}
        for place in (0, 1) if turn % 2 else (1, 0):
            begin = time.perf_counter()
            problems[place].solve(np.empty(0))
            times[place] = (time.perf_counter() - begin) / steps[place]
        ratios.append(times[1] / times[0])
    return (*steps, *np.percentile(ratios, [50, 25, 75]))


def _seconds(solver: Solver, rtol: float) -> float:
    begin = time.perf_counter()
    solver.solve(rtol)
    return time.perf_counter() - begin


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    import sys

    parser = options_of("speed", "How much faster the reduced kernel is than others at equal error.")
    parser.add_argument("--frame", action="store_true", help="a frame beside a cylinder")
    if parser.parse_args(arguments).frame:
        show(
            frame_ratios(), "Time a step with a frame over that with a cylinder, with quartiles", FRAME_FORMS
        )
        return 0
    table = measure(say=lambda line: print(line, file=sys.stderr))
    seconds = _AFTER_UPLIFT
    print(f"El Centro, R = 6 m, tan alpha = 0.2, {seconds:g} s from uplift, error below {TARGET:g} alpha\n")
    print(
        f"{'solver':24} {'ratio':>8} {'ms':>9} {'us per s':>9} {'work':>13} {'rtol':>8} {'error/alpha':>11}"
    )

    def unit(solver: str) -> str:
        return "f" if solver.startswith("scipy") else "step"

    for row in table.to_dict("records"):
        per_second = 1e3 * row["milliseconds"] / seconds
        print(
            f"{row['solver']:24} {row['ratio']:8.1f} {row['milliseconds']:9.3f} {per_second:9.1f} "
            f"{row['calls']:8d} {unit(row['solver']):4} {row['tolerance']:8.1e} {row['error']:11.1e}"
        )
    return 0
