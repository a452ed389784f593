"""Random problems of all kinds, the same everywhere, and perturbed copies of them.

The generator of the standard library gives the same numbers in every version.
"""

import math
from collections.abc import Iterator
from random import Random
from typing import Any, NamedTuple

import numpy as np
from stating import solve

from rockwobble.models import Cylinder, GroundMotion, InitialState, Trace, el_centro_1940

G = 9.81
MODELS = ("recess", "flat", "planar")
CHATTER = 60_000  # steps; copies of one longer run take as long as those of a hundred others


class Problem(NamedTuple):
    cylinder: Cylinder
    motion: GroundMotion
    model: str
    initial: InitialState | None

    def simulate(self, **changes: Any) -> Trace:
        """Simulate with `changes` to the motion or to any option; a planar release falls in its plane."""
        options: dict[str, Any] = {
            "model": self.model,
            "initial": self.initial,
            "rtol": 1e-9,
            "friction": 10.0,
        }
        options = {**options, "sample_step": 1.0, **changes}
        cylinder, motion = options.pop("cylinder", self.cylinder), options.pop("motion", self.motion)
        if options["model"] == "planar" and options["initial"] is not None:
            options.setdefault("plane", options["initial"].rolling_angle)
        return solve(cylinder, motion, **options)

    @property
    def threshold(self) -> float:
        """The ground acceleration that lifts it [m/s^2]."""
        return G * self.cylinder.tan_alpha

    @property
    def chatters(self) -> bool:
        """Whether it only just lifts and then chatters on and on; grids of runs are tested on that."""
        times = self.motion.duration * math.sqrt(G / self.cylinder.semidiagonal)
        return self.motion.peak < 1.03 * self.threshold and times > 30.0


def problem(
    seed: int,
    *,
    sizes: tuple[float, float] = (0.3, 100.0),
    slenderness: tuple[float, float] = (0.05, 3.0),
    time_steps: tuple[float, ...] = (0.005, 0.01, 0.02, 0.05),
    models: tuple[str, ...] = MODELS,
    released: bool = False,
) -> Problem:
    """Return a cylinder of random size and slenderness under a random motion.

    The motion begins and ends at zero, and its peak is 1.01 to 4 times what lifts the cylinder.
    """
    random = Random(seed)
    size, tan_alpha = _between(random, *sizes), _between(random, *slenderness)
    time_step = random.choice(time_steps)
    kind = random.choice(("El Centro", "noise", "noise", "pulse"))
    if kind == "El Centro":
        acceleration = np.array(el_centro_1940().acceleration)[: random.randrange(800, 2500)]
        time_step = el_centro_1940().time_step
    elif kind == "noise":
        acceleration = noise(random, time_step, random.uniform(6.0, 16.0), 2)
    else:
        acceleration = _pulse(random, time_step)
    acceleration[0] = acceleration[-1] = 0.0
    angle = random.uniform(-math.pi, math.pi)
    turned = GroundMotion(acceleration, time_step).rotated(angle)
    motion = turned.scaled(G * tan_alpha * _between(random, 1.01, 4.0) / turned.peak)
    if random.random() < 0.3:
        vertical = noise(random, time_step, motion.duration, 1)[: len(acceleration)]
        vertical *= random.uniform(0.1, 1.0) * motion.peak / np.abs(vertical).max()
        vertical = np.pad(vertical, ((0, len(acceleration) - len(vertical)), (0, 0)))
        motion = GroundMotion(np.hstack([motion.acceleration, vertical]), time_step)
    cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    model = random.choice(models)
    initial = None
    if released:
        rate = math.sqrt(G / size)
        initial = InitialState(
            random.uniform(0.01, 0.8) * cylinder.alpha,
            0.2 * random.uniform(-1.0, 1.0) * cylinder.alpha * rate,
            random.uniform(-math.pi, math.pi),
            0.0 if model == "planar" else random.uniform(-0.5, 0.5) * rate,
        )
    return Problem(cylinder, motion, model, initial)


def noise(random: Random, time_step: float, duration: float, components: int) -> np.ndarray:
    """Return coloured noise (n, components) that rises and decays, of about size 1."""
    share = np.linspace(0.0, 1.0, round(duration / time_step) + 1)
    time = share * duration
    envelope = np.minimum(share / 0.15, 1.0) * np.exp(-4.0 * np.maximum(share - 0.55, 0.0))
    corner = _between(random, 0.5, 5.0)
    columns = []
    for _ in range(components):
        column = np.zeros(len(time))
        for _ in range(40):
            frequency = _between(random, 0.15, min(10.0, 0.4 / time_step))
            height = frequency / corner / (1.0 + (frequency / corner) ** 2)
            column += height * np.cos(2.0 * math.pi * (frequency * time + random.random()))
        columns.append(envelope * column)
    return np.column_stack(columns)


def _pulse(random: Random, time_step: float) -> np.ndarray:
    period = _between(random, 0.3, 5.0)
    time = np.arange(round(2.0 * period / time_step) + 10) * time_step
    second = random.uniform(0.5, 2.0) * (time - 0.3 * period)
    return np.column_stack(
        [
            np.where(time < period, np.sin(2.0 * math.pi * time / period), 0.0),
            random.choice((1.0, 0.3)) * np.where(second > 0.0, np.sin(2.0 * math.pi * second / period), 0.0),
        ]
    )


def _between(random: Random, low: float, high: float) -> float:
    """Return a number between two others, evenly in its logarithm."""
    return low * (high / low) ** random.random()


def is_firm(
    given: Problem, response: Trace, limit: float, *, components: slice = slice(None), **options: Any
) -> bool:
    """Return whether perturbed copies and a tighter tolerance keep the outcome, and the peak to `limit`.

    The copies have 1e-7, 1e-8 and 1e-9 more of some components of the record, or the tenth part of the
    tolerance; the first that differs decides. What takes many steps counts as not firm.
    """
    if response.step_count > CHATTER or not response.peak_tilt > 0.0:
        return False

    def copies() -> Iterator[Trace]:
        for share in (1e-7, 1e-8, 1e-9):
            acceleration = np.array(given.motion.acceleration)
            acceleration[:, components] *= 1.0 + share
            yield given.simulate(**options, motion=GroundMotion(acceleration, given.motion.time_step))
        yield given.simulate(**{**options, "rtol": 0.1 * response.source.problem.rtol})

    return all(
        copy.outcome == response.outcome and abs(copy.peak_tilt / response.peak_tilt - 1.0) < limit
        for copy in copies()
    )


def resampled(motion: GroundMotion, parts: int) -> GroundMotion:
    """Return the same function of time with `parts` times as many samples."""
    whole = np.arange(len(motion.acceleration))
    at = np.arange((len(whole) - 1) * parts + 1) / parts
    columns = [np.interp(at, whole, column) for column in motion.acceleration.T]
    return GroundMotion(np.column_stack(columns), motion.time_step / parts)


def joined(first: GroundMotion, second: GroundMotion) -> GroundMotion:
    """Return one motion after the other, of the same time step."""
    width = max(first.acceleration.shape[1], second.acceleration.shape[1])
    parts = [np.pad(m.acceleration, ((0, 0), (0, width - m.acceleration.shape[1]))) for m in (first, second)]
    return GroundMotion(np.vstack(parts), second.time_step)
