"""Cost of each part of an engine's scene: degrees of freedom, contacts, constraint rows, time of a step.

Every scene is opened anew in each round and all are timed in turn, round after round, so that a change of
the machine's speed meets them alike; the ratio to the cheapest scene of the same engine is taken inside
each round. Timed is the engine alone, in processor time of this thread: for MuJoCo the rollout in C, for
Bullet its loop in Python.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, cast

import numpy as np
import pandas as pd

from rockwobble import multibody, reduced
from rockwobble.models import Case, GroundMotion, InitialState
from rockwobble.reports.published.tradeoff.problem import ENGINES, PIER, RECESS

_WARM_UP = 100  # steps before them: contact settles, the machine fetches the scene
_WALLS = 8, 32, 128
_PUSH = 0.1  # [m/s^2] of each component that a scene has; far from uplift


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """Scene that differs from the plain one by a single feature.

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
    """Scenes of an engine: each support plain, and with single changes."""
    backend = multibody.find_engine(engine)
    facts, supports = backend.facts, backend.supports
    # what changes is the main support of an engine: the ideal recess, where it has one
    main = RECESS if RECESS in supports else supports[0]
    return [
        *(Variant(support=each, option="released") for each in supports if each in reduced.SUPPORTS),
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
            if each == "ring"
            for count in _WALLS
        ),
        *(
            Variant(support=main, option=option, standing=True, components="xy", settings=given)
            for option, given in (facts.standing_alternatives or {"standing": {}}).items()
            if backend.uplifts
        ),
    ]


def scene_costs(*, rounds: int, steps: int) -> pd.DataFrame:
    """Cost of a step in every scene, over rounds of steps.

    Returns
    -------
    DataFrame
        One row for each scene: engine, support, option, degrees_of_freedom, contacts, constraint_rows,
        microseconds (of a step, median), ratio (to the cheapest scene of the engine, median of rounds).
    """
    scenes = [(name, variant) for name in ENGINES for variant in variants(name)]
    costs = [[step_cost(*scene, steps) for scene in scenes] for _ in range(rounds)]
    times = np.array([[seconds for seconds, _ in row] for row in costs])
    ratio = np.empty(len(scenes))
    for name in ENGINES:
        ours = np.array([engine == name for engine, _ in scenes])
        cheapest = np.flatnonzero(ours)[np.argmin(np.median(times[:, ours], axis=0))]
        ratio[ours] = np.median(times[:, ours] / times[:, [cheapest]], axis=0)
    rows = [
        {"engine": engine, "support": variant.support, "option": variant.option, **counts}
        for (engine, variant), (_, counts) in zip(scenes, costs[0], strict=True)
    ]
    return pd.DataFrame(rows).assign(microseconds=1e6 * np.median(times, axis=0), ratio=ratio)


def step_cost(engine: str, variant: Variant, steps: int) -> tuple[float, dict[str, int]]:
    """Mean processor time of one step [s], and the size of its problem."""
    initial = None if variant.standing else InitialState(0.5 * PIER.alpha, rolling_rate=0.5)
    motion = None
    if variant.components:
        motion = GroundMotion(np.full((2, len(variant.components)), _PUSH), 1.0)
    case = Case(PIER, motion, initial=initial, duration=1.0, name="cost")
    push = np.array([_PUSH if name in variant.components else 0.0 for name in "xyz"])
    with multibody.open_scene(case, engine, variant.support, variant.settings) as stepper:
        stepper.advance(np.tile(push, (_WARM_UP, 1)))
        rows = np.tile(push, (steps, 1))
        begin = time.thread_time()
        stepper.advance(rows)
        spent = (time.thread_time() - begin) / steps
        return spent, asdict(cast("Any", stepper).counts())  # which its engine adds
