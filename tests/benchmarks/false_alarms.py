"""How often `rockwobble check` calls an ordinary case wrong, and how often it finds a model that is.

`python tests/benchmarks false_alarms` takes random piers (R 1 to 30 m, tan alpha 0.08 to 0.5) under five
records of 1.1 to 3 times what uplifts, each with every engine in the recess and on flat ground, and holds the
runs against their models as a suite without bounds is held; then once more with models whose R is 0.5 % too
large. It is done in parts: rows are kept in a file, and a later call goes on where the last one ended.
"""

from __future__ import annotations

import dataclasses
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rockwobble import reduced
from rockwobble.compare.check import FAILED, NOT_RUN
from rockwobble.compare.check.suite import SuiteRuns, check_suite
from rockwobble.compare.runs.execution import Job
from rockwobble.models import Case, Cylinder, GroundMotion, Run, Trace, el_centro_1940, p695_far_field
from rockwobble.models.support import MODELLED
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import standard_engines

from .console import options_of

if TYPE_CHECKING:
    import pandas as pd

OFF = 1.005  # of R, in the model that is wrong
LENGTH = 20.0  # [s]
PAIRS = (1, 6, 11, 19)  # of FEMA P-695, beside El Centro
_KEPT = Path("false-alarms.csv")


def larger(case: Case, **options: Any) -> Trace:
    """Return the trace of the reduced model of a cylinder that is 0.5 % too large."""
    cylinder = dataclasses.replace(case.cylinder, semidiagonal=OFF * case.cylinder.semidiagonal)
    return reduced.simulate(dataclasses.replace(case, cylinder=cylinder), **options)


def engines_here() -> tuple[str, ...]:
    """Return the standard engines that are installed."""
    return tuple(name for name in standard_engines() if name in available_engines())


def records() -> list[GroundMotion]:
    """Return the five records.

    Raises
    ------
    ValueError
        If the records of FEMA P-695 are not installed.
    """
    return [el_centro_1940(), *(p695_far_field(pair) for pair in PAIRS)]


def case_of(number: int, motions: Sequence[GroundMotion]) -> Case:
    """Return one of the random cases, always the same of a number."""
    random = np.random.default_rng([7, number])
    size, tan_alpha = (math.exp(random.uniform(*np.log(ends))) for ends in ((1.0, 30.0), (0.08, 0.5)))
    times, turn = random.uniform(1.1, 3.0), random.uniform(0.0, 2.0 * math.pi)
    motion = motions[number % len(motions)]
    motion = motion.scaled(times * 9.81 * tan_alpha / motion.peak).rotated(turn)
    cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    name = f"{number}: R {size:.3g} m, tan alpha {tan_alpha:.2g}, {times:.2g} times"
    return Case(cylinder, motion, duration=min(LENGTH, motion.duration), name=name)


def measure(case: Case, *, workers: int | None = None) -> list[dict[str, Any]]:
    """Return a row for each check of one case, with the right models and with those that are not."""
    runs = [Run(engine, support) for engine in engines_here() for support in MODELLED]
    kept: dict[str, Trace] = {}
    rows = []
    for model, reference in (("right", reduced.simulate), ("R 0.5 % off", larger)):
        made = SuiteRuns(reference=reference, workers=workers, kept=kept)
        rows += [
            {"case": case.name, "model": model, "motion": "" if case.motion is None else case.motion.name}
            | {name: getattr(result, name) for name in ("name", "value", "bound", "outcome", "cause", "note")}
            for result in check_suite(made, [Job(case=case, run=run) for run in runs], None)
        ]
    return rows


def rates(table: pd.DataFrame) -> str:
    """Return both rates in words."""
    table = table[table["outcome"] != NOT_RUN]
    lines = []
    for model, of_model in table.groupby("model", sort=False):
        failed = of_model["outcome"] == FAILED
        cases = failed.groupby(of_model["case"]).any()
        worst = (of_model["value"] / of_model["bound"]).max()
        lines.append(
            f"{model}: {failed.sum()} of {len(failed)} checks and {cases.sum()} of {len(cases)} cases fail, "
            f"largest value over its bound {worst:.2g}"
        )
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Go on with the trial, and print both rates; return 1 if there was a false alarm."""
    import pandas as pd

    options = options_of("false_alarms", "False alarms of the check, and wrong models that it finds.")
    options.add_argument("--cases", type=int, default=4, help="how many more to run (%(default)s)")
    options.add_argument("--first", type=int, default=0, help="number of the first case (%(default)s)")
    options.add_argument("--kept", type=Path, default=_KEPT, help="file of rows (%(default)s)")
    options.add_argument("--workers", type=int, help="processes; default: one for each core")
    given = options.parse_args(arguments)
    table = pd.read_csv(given.kept) if given.kept.is_file() else pd.DataFrame()
    motions = records()
    done = given.first + (table["case"].nunique() if len(table) else 0)
    for number in range(done, done + given.cases):
        case = case_of(number, motions)
        print(f"{case.name}, {'' if case.motion is None else case.motion.name} ...", file=sys.stderr)
        table = pd.concat([table, pd.DataFrame(measure(case, workers=given.workers))], ignore_index=True)
        table.to_csv(given.kept, index=False)
    print(rates(table))
    false = (table["model"] == "right") & (table["outcome"] == FAILED)
    return 1 if false.any() else 0
