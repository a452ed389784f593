"""Independent solutions: the two rolling models by DOP853, written out again from the equations.

Nothing here comes from the package but the values of its models. State of both models: theta, theta',
phi, Lambda (the paper's L), tau, S; with S = 0 throughout it is the model in the recess.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Trace
from rockwobble.multibody import available_engines, simulate
from rockwobble.multibody.engines.registry import find_engine

Array = NDArray[np.float64]
Acceleration = Callable[[float], Array]

_RTOL = 1e-11
_ATOL = np.array([1e-15, 1e-13, 1e-12, 1e-18, 1e-14, 1e-14])


@dataclass(frozen=True, slots=True)
class Solution:
    time: Array
    tilt: Array
    rolling_angle: Array
    twist: Array
    uplift_time: float
    uplift_direction: float


@dataclass(frozen=True, slots=True)
class Constants:
    b: float
    h: float
    I1: float
    I2: float
    rolls_out: bool
    g: float = 9.81

    @property
    def A(self) -> float:
        return self.I1 + self.h**2 + self.b**2

    def inertia(self, theta: float) -> float:
        """B of the rolling angle."""
        t = math.tan(0.5 * theta)
        J, C, E = self.I1 + self.h**2, self.I2 + self.b**2, self.h * self.b
        return math.sin(theta) ** 2 * (J + 2.0 * E * t + C * t * t)

    def derivative(self, y: Array, acceleration: Array) -> list[float]:
        theta, theta_rate, phi, Lambda, _, S = y
        b, h, I1, I2 = self.b, self.h, self.I1, self.I2
        J, C, E = I1 + h * h, I2 + b * b, h * b
        Delta = J * C - E * E
        t, s, c = math.tan(0.5 * theta), math.sin(theta), math.cos(theta)
        ax, ay, az = acceleration
        radial = ax * math.cos(phi) + ay * math.sin(phi)
        tangential = -ax * math.sin(phi) + ay * math.cos(phi)
        H, H_theta = J + 2 * E * t + C * t * t, (E + C * t) * (1 + t * t)
        B, B_theta = s * s * H, 2 * s * c * H + s * s * H_theta
        D, D_theta, D_curve = s * (h + b * t), b * s + h * c, b * c - h * s
        M, M_theta = Delta / H, -Delta * H_theta / (H * H)
        ratio = (E + C * t) / (s * H)
        ratio_theta = (C * (1 + t * t) / 2 * s * H - (E + C * t) * (c * H + s * H_theta)) / (s * H) ** 2
        N1 = (
            (1 + t * t)
            / (2 * t * H * H)
            * (b * b * I1 - 2 * I2 * E * t + (C * (I1 - I2) + I2 * h * h) * t * t)
        )
        twist_rate = S / M
        push = -(self.g + az) * D_curve - D_theta * radial
        push += (
            B_theta * Lambda**2 / (2 * B * B) + M_theta * S * S / (2 * M * M) - ratio_theta * Lambda * S / M
        )
        return [
            theta_rate,
            push / self.A,
            Lambda / B + ratio * twist_rate,
            -b * D_theta * theta_rate * twist_rate - D * tangential,
            twist_rate,
            (N1 * theta_rate * Lambda + (b * I1 - h * I2 * t) / H * tangential) if self.rolls_out else 0.0,
        ]


def _constants(cylinder: Cylinder, rolls_out: bool) -> Constants:
    b, h = cylinder.base_radius, cylinder.mass_centre_height
    height = 2.0 * cylinder.half_height
    I1 = cylinder.transverse_inertia or (3 * b * b + height * height) / 12
    I2 = cylinder.axial_inertia or b * b / 2
    return Constants(b, h, I1, I2, rolls_out)


def free_response(
    cylinder: Cylinder, initial: InitialState, time: Array, *, rolls_out: bool = False
) -> Solution:
    """Solve from a release, at the given times."""
    model = _constants(cylinder, rolls_out)
    Lambda = model.inertia(initial.tilt) * initial.rolling_rate
    start = [initial.tilt, initial.tilt_rate, initial.rolling_angle, Lambda, 0.0, 0.0]
    still = np.zeros(3)
    run = solve_ivp(
        lambda _, y: model.derivative(y, still),
        (0.0, time[-1]),
        start,
        method="DOP853",
        rtol=_RTOL,
        atol=_ATOL,
        t_eval=time,
    )
    return Solution(run.t, run.y[0], run.y[2], run.y[4], 0.0, initial.rolling_angle)


def forced_response(
    cylinder: Cylinder, motion: GroundMotion, end: float, *, rolls_out: bool = False
) -> Solution:
    """Solve from rest, at the samples of the motion from the one after the uplift until `end`.

    Starts 0.2 ms after the uplift on the ramp theta = K t^3/6 + K2 t^4/24.
    """
    model = _constants(cylinder, rolls_out)
    g, step, alpha = model.g, motion.time_step, cylinder.alpha
    samples = np.zeros((len(motion.acceleration), 3))
    samples[:, : motion.acceleration.shape[1]] = motion.acceleration
    excess = np.hypot(samples[:, 0], samples[:, 1]) - (g + samples[:, 2]) * cylinder.tan_alpha
    index = int(np.argmax(excess >= 0.0)) - 1

    def at(time: float) -> Array:
        part = time / step - index
        return (1.0 - part) * samples[index] + part * samples[index + 1]

    def over(time: float) -> float:
        a = at(time)
        return float(np.hypot(a[0], a[1]) - (g + a[2]) * cylinder.tan_alpha)

    uplift = float(brentq(over, index * step, (index + 1) * step, xtol=1e-15))
    a, slope = at(uplift), (samples[index + 1] - samples[index]) / step
    size = float(np.hypot(a[0], a[1]))
    growth = float(a[:2] @ slope[:2]) / size
    turning = float(a[0] * slope[1] - a[1] * slope[0]) / size**2
    p2 = g * cylinder.semidiagonal / model.A
    K = p2 * math.cos(alpha) * (growth - cylinder.tan_alpha * slope[2]) / g
    K2 = p2 * math.cos(alpha) * size * turning**2 / g
    direction = math.atan2(-a[1], -a[0])
    t = 2e-4
    theta = K * t**3 / 6 + K2 * t**4 / 24
    state = np.array(
        [
            theta,
            K * t**2 / 2 + K2 * t**3 / 6,
            direction + turning * t,
            model.inertia(theta) * turning,
            0.0,
            0.0,
        ]
    )
    now, times, states = uplift + t, [], []
    while now < end - 1e-9:
        until = (index + 1) * step
        if until > now + 1e-9:
            run = solve_ivp(
                lambda time, y: model.derivative(y, at(time)),
                (now, until),
                state,
                method="DOP853",
                rtol=_RTOL,
                atol=_ATOL,
            )
            state = run.y[:, -1]
        now, index = until, index + 1
        times.append(now)
        states.append(state)
    table = np.array(states)
    return Solution(np.array(times), table[:, 0], table[:, 2], table[:, 4], uplift, direction)


def _is_exact(name: str) -> bool:
    """Whether an engine serves any case, in double precision; in single precision it has its own tests."""
    engine = find_engine(name)
    return engine.uplifts and engine.facts.rounding < 1e-12


@pytest.fixture(params=filter(_is_exact, available_engines()))
def engine(request: pytest.FixtureRequest) -> str:
    """Every engine that is installed here and serves any case."""
    return str(request.param)


@pytest.fixture
def time_step(engine: str) -> float | None:
    """Time step at the reference size that an engine's bounds need [s]; None is the default.

    A step of Drake costs ten times another's, and it keeps every bound at larger ones.
    """
    return 2.5e-4 if engine == "drake" else None


@pytest.fixture
def solve_free() -> Callable[..., Solution]:
    return free_response


@pytest.fixture
def run_release(solve_free: Callable[..., Solution]) -> Callable[..., tuple[Trace, Solution]]:
    """A release at half of alpha in an engine, which tells how far it is, and the solution of its model."""

    def run(
        engine: str, support: str, tan_alpha: float, *, duration: float, **options: Any
    ) -> tuple[Trace, Solution]:
        cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
        release = InitialState(cylinder.alpha / 2, rolling_rate=0.5)
        told: list[float] = []
        case = Case(cylinder, initial=release, duration=duration)
        trace = simulate(case, engine=engine, support=support, progress=told.append, **options)
        assert told == sorted(told)
        assert told[-1] == 1.0
        return trace, solve_free(cylinder, release, trace.time, rolls_out=support == "flat")

    return run


@pytest.fixture(scope="session")
def solve_forced() -> Callable[..., Solution]:
    return forced_response


def released_response(cylinder: Cylinder, motion: GroundMotion, initial: InitialState, time: Array) -> Array:
    """Tilt on flat ground from a release under a motion of two components, at the given times."""
    model = _constants(cylinder, rolls_out=True)
    samples = np.arange(len(motion.acceleration)) * motion.time_step
    state = np.array([initial.tilt, initial.tilt_rate, initial.rolling_angle, 0.0, 0.0, 0.0])
    state[3] = model.inertia(initial.tilt) * initial.rolling_rate

    def slope(now: float, y: Array) -> list[float]:
        ax, ay = (np.interp(now, samples, component) for component in motion.acceleration.T)
        return model.derivative(y, np.array([ax, ay, 0.0]))

    tilts = []
    # from sample to sample, because the forcing has a kink there
    for begin, end in itertools.pairwise(samples):
        at = time[(time >= begin - 1e-12) & (time < end - 1e-12)]
        run = solve_ivp(
            slope, (begin, end), state, method="DOP853", rtol=_RTOL, atol=_ATOL, t_eval=[*at, end]
        )
        state = run.y[:, -1]
        tilts.append(run.y[0, :-1])
    return np.append(np.concatenate(tilts), state[0])


@pytest.fixture
def solve_released() -> Callable[..., Array]:
    return released_response


@pytest.fixture
def pier() -> Cylinder:
    """The example of the paper."""
    return Cylinder(semidiagonal=6.0, tan_alpha=0.2)
