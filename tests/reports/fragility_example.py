"""Fragility from invented runs: each method overturns at a known multiple of the motion's capacity."""

from __future__ import annotations

import numpy as np
import pandas as pd

from rockwobble.studies import Fragility
from rockwobble.studies.fragility.study import fragility_of

LEVELS = (1.5, 2.0, 3.0, 4.0, 6.0, 8.0)
MOTIONS = 15


def described(support: str, engine: str | None = None, own: str = "") -> dict[str, object]:
    return {"support": support, "engine": engine, "own_model": own, "run": None, "of": []}


METHODS = {
    "recess model": (1.0, described("recess")),
    "flat-ground model": (1.1, described("flat")),
    "planar x": (1.5, described("planar")),
    "mujoco recess": (1.0, described("recess", "mujoco", "recess model")),
    "mujoco flat": (1.1, described("flat", "mujoco", "flat-ground model")),
    "mujoco ring": (1.05, described("ring", "mujoco")),
    "pybullet recess": (1.02, described("recess", "pybullet", "recess model")),
}


def made_up(cylinders: tuple[str, ...] = ("pier", "tower")) -> Fragility:
    """Motions with one capacity each, multiplied by a known factor for each method."""
    random = np.random.default_rng(8)
    runs, points = [], []
    for cylinder in cylinders:
        capacity = np.exp(random.normal(np.log(3.0), 0.4, MOTIONS))
        for motion in range(MOTIONS):
            for step, level in enumerate(LEVELS):
                place = {"cylinder": cylinder, "motion": f"m{motion}", "step": step}
                wide = dict.fromkeys(("peak_velocity", "pga", "pgv", "sa"), level * (1.0 + 0.05 * motion))
                points.append(
                    {**place, "scale": level, "peak_acceleration": level, **wide, "sa_mean": np.nan}
                )
                for method, (factor, _) in METHODS.items():
                    fell = level >= factor * capacity[motion]
                    outcome = "overturned" if fell else "stands"
                    runs.append(
                        {**place, "method": method, "peak_tilt": 8.0 if fell else 0.5, "outcome": outcome}
                    )
    facts = {
        "cylinders": {name: {"semidiagonal": 6.0, "tan_alpha": 0.2} for name in cylinders},
        "motions": MOTIONS,
        "methods": {name: own for name, (_, own) in METHODS.items()},
        "measure": "peak_acceleration",
        "levels": list(LEVELS),
        "scales": None,
        "period": 1.0,
        "friction": 1.0,
        "limits": ["uplift", "0.5 alpha", "overturned"],
        "margin": 0.1,
        "resamples": 100,
        "seed": 0,
        "source": "made up",
        "inputs": "",
    }
    return fragility_of(pd.DataFrame(runs).assign(contact_lost=np.nan), pd.DataFrame(points), facts)
