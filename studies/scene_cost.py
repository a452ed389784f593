"""Cost of each part of an engine's scene: degrees of freedom, contacts, constraint rows, time of a step.

Every scene is opened anew in each round and all are timed in turn, round after round, so that a change of
the machine's speed meets them alike; the ratio to the cheapest scene of the same engine is taken inside
each round. Timed is the engine alone, in processor time of this thread: for MuJoCo the rollout in C, for
Bullet its loop in Python.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import asdict, dataclass, field
from typing import Any, cast

import numpy as np
import pandas as pd

from rockwobble.compare.runs.progress import Stage
from rockwobble.models import Case, GroundMotion, InitialState
from rockwobble.models.cylinder import PIER
from rockwobble.models.support import support_named
from rockwobble.multibody.engines.registry import find_engine, own_engines
from rockwobble.multibody.protocol import SceneCounts
from rockwobble.multibody.simulation import open_scene

ROUNDS = 9
STEPS = 2000  # that are timed, 0.2 s of the cylinder of 6 m
_WARM_UP = 100  # steps before them: contact settles, the machine fetches the scene
_WALLS = 8, 32, 128
_PUSH = 0.1  # [m/s^2] of each component that a scene has; far from uplift


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """A scene, and the one feature that distinguishes it from the others in the table.

    Attributes
    ----------
    support : str
    option : str
        What is special, for the table.
    standing : bool
        Upright at rest, or released at half of alpha.
    components : str
        Components of the ground acceleration: "", "xy" or "xyz".
    settings : mapping
        Settings of the engine.
    """

    support: str
    option: str
    standing: bool = False
    components: str = ""
    settings: Mapping[str, object] = field(default_factory=dict)


def variants(engine: str) -> list[Variant]:
    """Return the scenes of an engine: each support plain, and then with one thing changed at a time.

    Raises
    ------
    ValueError
        If there is no such engine, or it is not installed.
    """
    backend = find_engine(engine)
    facts, supports = backend.facts, [support_named(name) for name in backend.supports]
    # what changes is the main support of an engine: the ideal recess, where it has one
    main = next((support for support in supports if support.guided), supports[0])
    return [
        *(Variant(support=each, option="released") for each in supports if each.has_model),
        Variant(support=main, option="ground motion x, y", components="xy"),
        Variant(support=main, option="ground motion x, y, z", components="xyz"),
        *(
            Variant(support=main, option=option, settings=given)
            for option, given in facts.alternatives.items()
        ),
        *(
            Variant(
                support=each,
                option=f"{count} walls",
                settings={"ring_facets": count, "ring_clearance": 0.1},
            )
            for each in supports
            if each.walls
            for count in _WALLS
        ),
        *(
            Variant(support=main, option=option, standing=True, components="xy", settings=given)
            for option, given in (facts.standing_alternatives or {"standing": {}}).items()
            if backend.uplifts
        ),
    ]


def scene_costs(
    engines: Sequence[str] | None = None,
    *,
    rounds: int = ROUNDS,
    steps: int = STEPS,
    stage: Stage = nullcontext,
) -> pd.DataFrame:
    """Measure the cost of a step in every scene.

    Parameters
    ----------
    engines : sequence of str, optional
        Default: ours, as far as they are installed.
    rounds, steps : int
        Times that each scene is measured, and steps each time.
    stage : callable, optional
        Of the label of a round: the block in which it runs, as of `stages`.

    Returns
    -------
    DataFrame
        One row for each scene: engine, support, option, degrees_of_freedom, contacts, constraint_rows,
        microseconds (of a step, median), ratio (to the cheapest scene of the engine, median of rounds).

    Raises
    ------
    ValueError
        If an engine is unknown or not installed, or a number is not positive.
    """
    if rounds < 1 or steps < 1:
        raise ValueError(f"rounds and steps must be positive, got {rounds} and {steps}")
    names = engines or own_engines()
    scenes = [(name, variant) for name in names for variant in variants(name)]
    times = np.empty((rounds, len(scenes)))
    counts: list[SceneCounts] = []
    for number in range(rounds):
        with stage(f"scenes, round {number + 1} of {rounds}"):
            for place, scene in enumerate(scenes):
                times[number, place], count = step_cost(*scene, steps)
                if not number:
                    counts.append(count)
    ratio = np.empty(len(scenes))
    for name in names:
        ours = np.array([engine == name for engine, _ in scenes])
        cheapest = np.flatnonzero(ours)[np.argmin(np.median(times[:, ours], axis=0))]
        ratio[ours] = np.median(times[:, ours] / times[:, [cheapest]], axis=0)
    rows = [
        {"engine": engine, "support": variant.support, "option": variant.option, **asdict(count)}
        for (engine, variant), count in zip(scenes, counts, strict=True)
    ]
    return pd.DataFrame(rows).assign(microseconds=1e6 * np.median(times, axis=0), ratio=ratio)


def step_cost(engine: str, variant: Variant, steps: int) -> tuple[float, SceneCounts]:
    """Return the mean processor time of one step [s], and the size of the problem that it solves."""
    initial = None if variant.standing else InitialState(0.5 * PIER.alpha, rolling_rate=0.5)
    motion = None
    if variant.components:
        motion = GroundMotion(np.full((2, len(variant.components)), _PUSH), 1.0)
    case = Case(PIER, motion, initial=initial, duration=1.0, name="cost")
    push = np.array([_PUSH if name in variant.components else 0.0 for name in "xyz"])
    with open_scene(case, engine, variant.support, variant.settings) as stepper:
        stepper.advance(np.tile(push, (_WARM_UP, 1)))
        rows = np.tile(push, (steps, 1))
        begin = time.thread_time()
        stepper.advance(rows)
        spent = (time.thread_time() - begin) / steps
        counts: SceneCounts = cast("Any", stepper).counts()  # which its engine adds
        return spent, counts
