"""Coverage of stated friction and restraining moment requirements by new motions.

`python tests/benchmarks needs_coverage --seed 7` prints them by slenderness and intensity, with counts. The
stated needs are computed from the published tables; the cylinders are of sizes drawn at random between the
least and the largest mapped, evenly in the logarithm, under records drawn at random, or with `--synthetic`
under synthetic motions of the seed. Those that rock without overturning count. `--friction 1.64 --moment
0.12` tries one need for all in place of the stated ones.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rockwobble import reduced
from rockwobble.compare.runs.progress import stages
from rockwobble.models import Case, Cylinder, GroundMotion, synthetic_motions
from rockwobble.studies.validity.limits import needs
from rockwobble.studies.validity.plan import AMPLE, GRAVITY, motion_named, record_names
from rockwobble.studies.validity.study import Validity

from .console import options_of, tell

if TYPE_CHECKING:
    import pandas as pd

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "validity"
DRAWS = 150  # of a slenderness and intensity: a share of 0.9 is then known to 0.025
RECORDS = 22


def coverage(
    stated: pd.DataFrame, sizes: tuple[float, float], motions: Sequence[GroundMotion], draws: int, seed: int
) -> pd.DataFrame:
    """`stated` with counts of standing, rocking motions, and of those within their requirement.

    The columns more: standing, friction_covered, moment_covered.
    """
    random, counts = np.random.default_rng(seed), []
    stage = stages(tell, [1.0] * len(stated))
    for row in stated.to_dict("records"):
        covered = []
        with stage(f"tan alpha {row['tan_alpha']:g}, {row['intensity']:g} g tan alpha"):
            for size in np.exp(random.uniform(math.log(sizes[0]), math.log(sizes[1]), draws)):
                cylinder = Cylinder(semidiagonal=float(size), tan_alpha=row["tan_alpha"])
                motion = motions[int(random.integers(len(motions)))]
                motion = motion.scaled(row["intensity"] * GRAVITY * row["tan_alpha"] / motion.peak)
                run = reduced.simulate(Case(cylinder, motion, friction=AMPLE), rtol=1e-7)
                if run.peak_tilt > 0.0 and run.outcome not in ("overturned", "failed"):
                    assert run.assumptions is not None
                    covered.append(
                        (
                            run.assumptions.largest_friction_needed <= row["friction"] * row["tan_alpha"],
                            run.assumptions.largest_restraining_moment
                            <= row["moment"] * cylinder.base_radius,
                        )
                    )
        friction, moment = np.array(covered, dtype=int).reshape(-1, 2).sum(axis=0)
        counts.append({"standing": len(covered), "friction_covered": friction, "moment_covered": moment})
    return stated.assign(**{name: [row[name] for row in counts] for name in counts[0]})


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the two tables."""
    parser = options_of("needs_coverage", "Shares of fresh motions for which the stated needs suffice.")
    parser.add_argument("--seed", type=int, default=1, help="of sizes and motions (%(default)s)")
    parser.add_argument(
        "--draws", type=int, default=DRAWS, help="of each slenderness and intensity (%(default)s)"
    )
    parser.add_argument("--synthetic", action="store_true", help="motions of the seed in place of records")
    parser.add_argument("--limits", type=Path, default=PUBLISHED, help="folder of the validity study")
    parser.add_argument("--friction", type=float, help="one need for all [tan alpha]")
    parser.add_argument("--moment", type=float, help="one need for all [weight x b]")
    given = parser.parse_args(arguments)
    tables = Validity.load(given.limits).tables
    mapped = tables["peaks"]["semidiagonal"]
    motions = (
        synthetic_motions(RECORDS, peak=1.0, seed=given.seed)
        if given.synthetic
        else [GroundMotion(m.acceleration[:, :2], m.time_step, m.name) for m in _records()]
    )
    for_all = {"friction": given.friction, "moment": given.moment}
    stated = needs(tables).assign(**{name: need for name, need in for_all.items() if need is not None})
    table = coverage(stated, (float(mapped.min()), float(mapped.max())), motions, given.draws, given.seed)
    for name in ("friction", "moment"):
        print(f"\nStated {name} and the share of motions for which it suffices, by intensity [g tan alpha]")
        for tan_alpha, own in table.groupby("tan_alpha"):
            print(f"tan alpha {tan_alpha:g}")
            for row in own.to_dict("records"):
                covered, count = row[f"{name}_covered"], row["standing"]
                print(f"{row['intensity']:8g}{row[name]:10.3g}{covered / count:9.1%}  {covered} of {count}")
        print(f"all: {table[f'{name}_covered'].sum()} of {table['standing'].sum()}")
    return 0


def _records() -> list[GroundMotion]:
    return [motion_named(name) for name in record_names(RECORDS)]
