"""First steps of a motion against the reduced model, for every engine, support, body and state."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np
import pytest

from rockwobble import multibody, reduced
from rockwobble.models import Case, Cylinder, InitialState, Tendon, WobblingFrame
from rockwobble.models.support import FLAT, RECESS
from rockwobble.multibody.engines.registry import find_engine
from rockwobble.multibody.simulation import open_scene

STEPS, TIME_STEP = 100, 1e-4  # [s]
# [m] and [rad]: a velocity half a step too early or late gives 3e-6 m after these; 3e-7 and 1.3e-6 were
# measured
DOUBLE, SINGLE = 1e-6, 3e-6
# a couple that keeps a rim from rolling is found by a solver: with the softer contact of MuJoCo 4e-5
RESISTED = {"mujoco": 1e-4}


def problems() -> Iterator[tuple[str, str, str]]:
    for name in multibody.available_engines():
        engine = find_engine(name)
        for support in (each for each in (RECESS, FLAT) if each in engine.supports):
            yield name, support, "column"
            if engine.facts.carries_slab:
                yield name, support, "frame"
            if "rolling_resistance" in engine.facts.terms:
                yield name, support, "resistance"
            if "tendon" in engine.facts.terms and support == RECESS:
                yield name, support, "tendon"
                if engine.facts.carries_slab:
                    yield name, support, "frame with tendon"


@pytest.mark.slow
@pytest.mark.parametrize(("engine", "support", "kind"), list(problems()))
def test_the_first_steps_equal_those_of_the_model(engine: str, support: str, kind: str) -> None:
    # of the reference size of a scene
    column = Cylinder(semidiagonal=6.0, tan_alpha=0.3)
    body = WobblingFrame(column, slab_mass_ratio=0.7, columns=1) if kind.startswith("frame") else column
    tendon = Tendon(prestress=0.3, stiffness=4.0) if kind.endswith("tendon") else None
    resistance = 0.02 * column.base_radius if kind == "resistance" else 0.0
    bound = SINGLE if find_engine(engine).facts.rounding > 1e-12 else DOUBLE
    if kind == "resistance":
        bound = RESISTED.get(engine, SINGLE)
    for seed, (up, left) in enumerate(itertools.product((1.0, -1.0), repeat=2)):
        chance = np.random.default_rng(seed)
        initial = InitialState(
            chance.uniform(0.3, 0.7) * column.alpha,
            tilt_rate=up * chance.uniform(0.1, 0.5),
            rolling_angle=chance.uniform(-math.pi, math.pi),
            rolling_rate=left * chance.uniform(0.3, 2.0),
        )
        case = Case(
            body, initial=initial, duration=STEPS * TIME_STEP, tendon=tendon, rolling_resistance=resistance
        )
        expected = reduced.simulate(case, support=support, sample_step=TIME_STEP)
        with open_scene(case, engine, support, {}) as stepper:
            steps = stepper.advance(np.zeros((STEPS, 3)))
        w, x, y, z = steps.quaternion.T
        tilt = 2.0 * np.arctan2(np.hypot(x, y), np.hypot(w, z))
        assert np.abs(tilt - expected.tilt[1 : STEPS + 1]).max() < bound, seed
        assert np.abs(steps.position - expected.centre_of_mass[1 : STEPS + 1]).max() < bound, seed
        turn = 2.0 * np.arctan2(z, w) - expected.twist[1 : STEPS + 1]
        assert np.abs(turn - turn[0]).max() < bound, seed
