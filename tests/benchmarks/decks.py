"""Benefit of a deck: a pier alone, under slabs, and as cylinders of equal planar motion.

Motion in one plane without loss has two parameters, alpha and p: a pier under a slab moves as a cylinder of
the same slenderness that is larger by the ratio of p^2. In three dimensions that need not be so. All bodies
meet the same motions at the same intensities, and ratios of medians are of the same resamples of the motions.

`python tests/benchmarks decks` prints the tables that are published; ``--motions p695`` or ``--motions 300``
(so many synthetic ones) makes them first, and ``--out FOLDER`` writes them there with their figure.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, RockingBody, WobblingFrame, synthetic_motions
from rockwobble.reduced.body import body_of
from rockwobble.reports.figures.palette import Style, run_styles
from rockwobble.reports.figures.picture import Axis, Line, Panel, Picture, bar_ends
from rockwobble.reports.figures.svg import svg
from rockwobble.studies.fragility.fit import interval, resamples
from rockwobble.studies.fragility.study import Fragility, fragility
from rockwobble.studies.fragility.tables import blocks_of, curves_of

from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "decks"
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RATIOS = (0.0, 1.0, 4.0)
METHODS = ("recess", "planar-x", "planar-y", "worse-plane")
LEVELS = (1.5, 2.0, 2.75, 3.75, 5.0, 6.5, 9.0, 12.0)  # over g tan(alpha)
SEED, RESAMPLES = 16, 1000
_NEEDS_LEVEL, _NEEDS_MOTIONS = 2.75, 22  # at which forces are compared
_OVERTURNED = "overturned"


def deck(ratio: float) -> RockingBody:
    """Pier under a slab of a mass ratio."""
    return WobblingFrame(PIER, ratio) if ratio else PIER


def equivalent(ratio: float) -> Cylinder:
    """Cylinder of equal slenderness and equal p."""
    p2 = [body_of(each, 9.81).p2 for each in (PIER, deck(ratio))]
    return Cylinder(semidiagonal=PIER.semidiagonal * p2[0] / p2[1], tan_alpha=PIER.tan_alpha)


def bodies() -> dict[str, RockingBody]:
    """Bodies by name."""
    return {f"deck {ratio:g}": deck(ratio) for ratio in RATIOS} | {
        f"as deck {ratio:g}": equivalent(ratio) for ratio in RATIOS if ratio
    }


def motions_of(name: str) -> Sequence[GroundMotion]:
    """Ground motions named by the option."""
    if name == "p695":
        from rockwobble.models.records.p695 import recorded_far_field

        return recorded_far_field()
    return synthetic_motions(int(name), peak=1.0, seed=SEED)


def overturning(study: Fragility) -> pd.DataFrame:
    """Return medians with intervals, and ratios to the pier alone, to the equivalent cylinder, to 3D."""
    import pandas as pd

    blocks = blocks_of(study.runs, study.points, [_OVERTURNED], str(study.facts["measure"]))
    count = len(blocks.motions)
    weights = resamples(count, RESAMPLES, SEED)
    curves = [curves_of(blocks), curves_of(blocks, weights)]

    def stated(name: str, body: str, method: str, over: tuple[str, str] | None) -> dict[str, float]:
        if over is not None and over[0] not in blocks.cylinders:
            return dict.fromkeys((name, f"{name}_low", f"{name}_high"), math.nan)
        centres = [
            each[body, method, _OVERTURNED].centre
            - (0.0 if over is None else each[*over, _OVERTURNED].centre)
            for each in curves
        ]
        return interval(float(centres[0][0]), centres[1], count).exponential().columns(name)

    rows = []
    for ratio, method in itertools.product(RATIOS, blocks.methods):
        body = f"deck {ratio:g}"
        rows.append(
            {"slab_mass_ratio": ratio, "method": method}
            | stated("median", body, method, None)
            | stated("over_alone", body, method, ("deck 0", method))
            | stated("over_equivalent", body, method, (f"as deck {ratio:g}", method))
            | stated("over_3d", body, method, (body, blocks.methods[0]))
        )
    return pd.DataFrame(rows)


def needs(motions: Sequence[GroundMotion], support: str = "recess") -> Iterator[dict[str, float]]:
    """Yield for each ratio the median demands over the motions that do not overturn it."""
    threshold = 9.81 * PIER.tan_alpha
    for ratio in RATIOS:
        demands = []
        for motion in motions[:_NEEDS_MOTIONS]:
            trace = reduced.simulate(
                Case(deck(ratio), motion.scaled(_NEEDS_LEVEL * threshold / motion.peak)), support=support
            )
            if trace.outcome == "stands":
                at_top = trace.top_contact_force if ratio else np.full((1, 3), math.nan)
                demands.append(
                    (
                        trace.peak_tilt / PIER.alpha,
                        float(np.nanmax(trace.friction_needed)),
                        float(np.nanmax(trace.top_friction_needed)) if ratio else math.nan,
                        float(trace.contact_force[:, 2].min()),
                        float(at_top[:, 2].min()),
                        float(np.abs(trace.restraining_moment).max()) / PIER.base_radius,
                    )
                )
        names = ("peak_tilt", "friction_base", "friction_top", "least_load_base", "least_load_top", "moment")
        yield {"slab_mass_ratio": ratio, "motions": len(demands)} | dict(
            zip(names, np.median(np.array(demands), axis=0), strict=True)
        )


def picture(table: pd.DataFrame, title: str) -> Picture:
    """Return medians over the mass ratio."""
    methods = list(dict.fromkeys(table["method"]))
    styles = run_styles(methods)
    layers = []
    for place, method in enumerate(methods):
        own = table[table["method"] == method]
        x = own["slab_mass_ratio"].to_numpy(float) + 0.03 * place  # beside each other
        columns = (own[name].to_numpy(float) for name in ("median", "median_low", "median_high"))
        y, low, high = columns
        layers.append(Line(x=x, y=y, name=method, style=styles[method]))
        bar = Style(colour=styles[method].colour)
        layers.append(Line(x=np.repeat(x, 3), y=bar_ends(low, high), style=bar, width=0.9))
    ticks = [(ratio, f"{ratio:g}") for ratio in RATIOS]
    panel = Panel(
        x=Axis(
            label="mass of the deck / mass of the piers",
            unit="-",
            low=-0.1,
            high=RATIOS[-1] + 0.1,
            ticks=ticks,
        ),
        y=Axis(label="median overturning intensity", unit="g tan α", low=0.0),
        layers=layers,
        height=3.2,
    )
    return Picture(name="decks", title=title, panels=[panel], legend="below")


def main(arguments: Sequence[str]) -> int:
    """Print the tables, computing them first if motions are named."""
    import pandas as pd

    parser = options_of("decks", "Median overturning intensities of a pier under slabs.")
    parser.add_argument("--motions", help="p695, or a number of synthetic motions")
    parser.add_argument("--out", type=Path, help="folder for the table and its figure")
    options = parser.parse_args(arguments)
    if options.motions is None:
        tables = {path.stem: pd.read_csv(path) for path in sorted(PUBLISHED.glob("*.csv"))}
    else:
        motions = motions_of(options.motions)
        study = fragility(bodies(), motions, methods=METHODS, levels=LEVELS, resamples=RESAMPLES, seed=SEED)
        tables = {
            f"medians-{options.motions}": overturning(study),
            f"needs-{options.motions}": pd.DataFrame(needs(motions)),
        }
        if options.out is not None:
            options.out.mkdir(parents=True, exist_ok=True)
            for name, table in tables.items():
                table.to_csv(options.out / f"{name}.csv", index=False, float_format="%.4g")
            drawn = picture(tables[f"medians-{options.motions}"], "Overturning of a pier under a deck")
            (options.out / f"decks-{options.motions}.svg").write_bytes(svg(drawn))
    for name, table in tables.items():
        show(table, name, {column: "" if column == "method" else ".3g" for column in table.columns})
    return 0
