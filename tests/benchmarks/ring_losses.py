"""Print what a ring costs against clearance, inclination, facets and friction of its ring of walls.

The engine in an ideal recess and on flat ground stands above the rings: what they differ by from their models
is the error of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import reduced
from rockwobble.compare.metrics.pair import make_pair, tilt_rms_relative
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.compare.runs.progress import Lost
from rockwobble.compare.runs.scheduler import run_tasks
from rockwobble.models import Case, Run, Trace
from rockwobble.studies.validity.measurements import has_room, losses, release_of
from rockwobble.studies.validity.plan import EL_CENTRO, shaken_case

from .console import options_of, tell

if TYPE_CHECKING:
    import pandas as pd

CLEARANCES = (0.0, 1e-4, 1e-3, 3e-3, 1e-2, 5e-2)  # [b]
INCLINATIONS = (0.1, 0.2, 0.3, 0.5, 0.8, 1.1)  # [rad]
FACETS = (8, 16, 32, 64, 128, 256)
FRICTIONS = (0.0, 0.2, 0.5, 1.0)
# azimuths by which each case is turned [deg]: the same problem, but for the walls and for chance
TURNS = (0.0, 2.0, 5.0, 9.0)
# tan(alpha): peak of the record over the acceleration that uplifts. Large motion, and the ground keeps hold
INTENSITIES = {0.2: 2.0, 1.0: 1.3}
_LENGTH, _RECORD = 8.0, 15.0  # [s] of a free response, and of the strong part of the record


def ring_runs() -> tuple[Run, ...]:
    """Return the runs of each case: recess, flat, and rings that differ from the default in one setting."""
    varied: dict[str, Sequence[Any]] = {
        "ring_clearance": CLEARANCES,
        "ring_inclination": INCLINATIONS,
        "ring_facets": FACETS,
        "ring_friction": FRICTIONS,
    }
    rings = [Run("mujoco", "ring", **{name: value}) for name, values in varied.items() for value in values]
    return (Run("mujoco", "recess"), Run("mujoco", "flat"), *rings)


def ring_cases(tan_alpha: float, turn: float = 0.0) -> dict[str, Case]:
    """Return free response and El Centro by name, turned by an azimuth [rad]."""
    name = f"tan alpha {tan_alpha:g}"
    shaken = shaken_case(EL_CENTRO, tan_alpha, 6.0, INTENSITIES[tan_alpha], duration=_RECORD, turn=turn)
    return {f"free response, {name}": release_of(tan_alpha, turn, _LENGTH), f"El Centro, {name}": shaken}


def measure(task: tuple[str, Case, Run]) -> dict[str, object]:
    """Return the row of one run: case, run, what it cost, and its RMS differences from the models."""
    name, case, run = task
    trace = simulate_run(case, run)
    changed = " ".join(f"{key.removeprefix('ring_')} {value:g}" for key, value in run.settings.items())
    return {"case": name, "run": changed or run.support, **losses(trace), **against_models(trace)}


def against_models(trace: Trace) -> dict[str, float]:
    """Return the RMS of the tilt difference over that of the model's tilt, by the support of the model."""
    models = {support: reduced.simulate(trace.case, support=support) for support in ("recess", "flat")}
    cylinder = trace.case.cylinder
    return {
        support: tilt_rms_relative(make_pair(cylinder, model, trace)) for support, model in models.items()
    }


def medians(rows: pd.DataFrame) -> pd.DataFrame:
    """Return a row for each case and run: medians over the turns, and the span of the energy lost [%]."""
    import pandas as pd

    found = []
    for (case, run), own in rows.groupby(["case", "run"], sort=False):
        lost = 100.0 * own["loss"]
        passes = own["passes"].where(own["passes"] > 0)
        sizes = own[["contact_time", "rolled_out", "at_end", "recess", "flat"]].median()
        first = own["first_contact"].replace(np.inf, np.nan).median()
        found.append(
            {"case": case, "run": run, "first": first, "passes": own["passes"].median(),
             "lost": lost.median(), "from": lost.min(), "to": lost.max(), "a pass": (lost / passes).median(),
             "twist": own["twist"].abs().median(),
             "broken": int(own["outcome"].isin(("failed", "overturned")).sum())} | sizes.to_dict()
        )  # fmt: skip
    return pd.DataFrame(found)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    import pandas as pd

    parser = options_of(
        "ring_losses",
        "What a ring costs, against clearance, inclination, facets and friction. "
        "Example: --turns 1 --tan-alpha 1",
    )
    parser.add_argument(
        "--turns",
        type=int,
        choices=range(1, len(TURNS) + 1),
        default=2,
        help="azimuths by which each case is turned, up to five minutes on two cores each (%(default)s)",
    )
    parser.add_argument(
        "--tan-alpha",
        type=float,
        action="append",
        choices=list(INTENSITIES),
        help="slenderness, may be repeated (default: all)",
    )
    given = parser.parse_args(arguments)
    tasks = [
        (name, case, run)
        for tan_alpha in given.tan_alpha or INTENSITIES
        for turn in TURNS[: given.turns]
        for name, case in ring_cases(tan_alpha, math.radians(turn)).items()
        for run in ring_runs()
        if has_room(case, run)
    ]
    found = run_tasks(
        measure,
        tasks,
        label=lambda task: f"{task[0]}, {task[2]}",
        progress=tell,
    )
    table = medians(pd.DataFrame([row for row in found if not isinstance(row, Lost)]))
    print(
        "MuJoCo, R = 6 m, ample friction. A ring has its default settings but for the one named.\n"
        f"Medians of runs turned by {', '.join(f'{turn:g}' for turn in TURNS[: given.turns])} deg.\n"
        "first contact with a wall [s]; lost [%] of the largest energy reached; rolled_out, at_end: how\n"
        "far from its place it would come down [b]; recess, flat: relative RMS against the models."
    )
    for case, own in table.groupby("case", sort=False):
        print(f"\n{case}\n{own.drop(columns='case').to_string(index=False, float_format='{:.4g}'.format)}")
    return 0
