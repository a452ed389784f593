"""Effect of a tendon on overturning: medians over prestress and stiffness, in 3D and in planes.

The bodies meet the same motions at the same intensities, and ratios of medians are of the same resamples of
the motions. Stiffness is stated over the one at which the static couple neither falls nor grows with the
tilt, w h/(n^2 b) weights per base radius.

`python tests/benchmarks tendons` prints the tables that are published; ``--motions p695`` makes that of
medians first, ``--motions 2000`` that of so many synthetic ones at fewer points, each at intensities about
its own median, ``--engine mujoco`` that of flat ground, where the tendon takes the place of the recess, and
``--out FOLDER`` writes them there, medians with their figure.
"""

from __future__ import annotations

import itertools
import math
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rockwobble import multibody, reduced
from rockwobble.compare.metrics.statistics import quantile_interval
from rockwobble.models import Case, Cylinder, GroundMotion, RockingBody, Tendon, WobblingFrame
from rockwobble.reports.figures.palette import Style, run_styles
from rockwobble.reports.figures.picture import Axis, Line, Panel, Picture, bar_ends
from rockwobble.reports.figures.svg import svg
from rockwobble.studies.fragility.fit import Curves, Sample, interval, resamples
from rockwobble.studies.fragility.study import fragility
from rockwobble.studies.fragility.tables import Key, blocks_of, curves_of

from .console import options_of, show
from .decks import METHODS, RESAMPLES, SEED, motions_of

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "tendons"
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
BODIES = {
    "pier": PIER,
    "pier under a deck": WobblingFrame(PIER, 0.5),
    "column": Cylinder(semidiagonal=3.0, tan_alpha=0.15),
    "tower": Cylinder(semidiagonal=10.0, tan_alpha=0.1),
}
PRESTRESS = (0.0, 0.25, 0.5, 1.0)
# over the neutral one: at it and beyond the couple brings it back from all tilts
STIFFNESS = (0.0, 0.5, 1.0, 1.5)
LEVELS = tuple(float(f"{level:.3g}") for level in np.geomspace(1.5, 60.0, 12))  # over g tan(alpha)
# of many synthetic motions: prestress and stiffness, and what the medians grow by there, as those of P-695
GROWTH = {
    (0.0, 0.0): 1.0,
    (0.5, 0.0): 1.5,
    (1.0, 0.0): 2.0,
    (0.0, 0.5): 2.0,
    (0.5, 0.5): 2.7,
    (0.0, 1.0): 9.0,
}
# levels without a tendon [g tan(alpha)]: the median in 3D is near the second, in a plane near the third
ABOUT = {"pier": 3.8, "pier under a deck": 4.6, "column": 2.3, "tower": 6.5}
_STEPS = (0.65, 1.0, 1.5, 2.2, 3.2)
FLAT_LEVEL, FLAT_STEP = 2.75, 5e-4  # [g tan(alpha)], [s]
_SIDE_DOWN = 0.5 * math.pi * (1.0 - 1e-9)  # peak of what overturns [rad]
_OVERTURNED = "overturned"


def neutral_stiffness(body: RockingBody) -> float:
    """Stiffness at which the static couple has zero slope [weights per base radius]."""
    gaps = 2 if body.slab_mass_ratio > 0.0 else 1
    return (1.0 + 2.0 * body.slab_mass_ratio) / (gaps**2 * body.tan_alpha)


def medians(motions: Sequence[GroundMotion]) -> Iterator[dict[str, float | str]]:
    """Yield medians with intervals, and ratios to the body without a tendon and to 3D."""
    weights = resamples(len(motions), RESAMPLES, SEED)
    for name, body in BODIES.items():
        without: list[dict[Key, Curves]] = []
        for stiffness, prestress in itertools.product(STIFFNESS, PRESTRESS):
            study = fragility(
                {name: body},
                motions,
                methods=METHODS,
                levels=LEVELS,
                resamples=RESAMPLES,
                seed=SEED,
                limits=[_OVERTURNED],
                tendon_prestress=prestress,
                tendon_stiffness=stiffness * neutral_stiffness(body),
            )
            blocks = blocks_of(study.runs, study.points, [_OVERTURNED], str(study.facts["measure"]))
            curves = [curves_of(blocks), curves_of(blocks, weights)]
            without = without or curves
            for method in blocks.methods:
                of_3d = blocks.methods[0]
                own, alone, in_3d = (
                    [each[name, which, _OVERTURNED].centre for each in of]
                    for of, which in ((curves, method), (without, method), (curves, of_3d))
                )
                yield {
                    **{"body": name, "prestress": prestress, "stiffness": stiffness, "method": method},
                    **_stated("median", own, None, len(motions)),
                    **_stated("over_without", own, alone, len(motions)),
                    **_stated("over_3d", own, in_3d, len(motions)),
                }


def medians_of_many(motions: Sequence[GroundMotion]) -> Iterator[dict[str, float | str]]:
    """Yield rows as `medians`, at fewer points and by the batch kernel."""
    weights = resamples(len(motions), RESAMPLES, SEED)
    for name, body in BODIES.items():
        without: dict[str, list[Curves]] = {}
        for (prestress, stiffness), growth in GROWTH.items():
            tendon = Tendon(prestress=prestress, stiffness=stiffness * neutral_stiffness(body))
            levels = ABOUT[name] * growth * np.array(_STEPS)
            samples = _overturned(body, tendon, motions, levels)
            curves = {method: [own.curves(), own.curves(weights)] for method, own in samples.items()}
            without = without or curves
            for method in curves:
                own, alone, in_3d = (
                    [each.centre for each in of]
                    for of in (curves[method], without[method], curves["recess model"])
                )
                share = float(np.nanmean(samples[method].y[:, -1]))
                yield {
                    **{"body": name, "prestress": prestress, "stiffness": stiffness, "method": method},
                    **_stated("median", own, None, len(motions)),
                    **_stated("over_without", own, alone, len(motions)),
                    **_stated("over_3d", own, in_3d, len(motions)),
                    **{"highest_level": float(levels[-1]), "overturned_there": share},
                }


def _overturned(
    body: RockingBody, tendon: Tendon, motions: Sequence[GroundMotion], levels: Array
) -> dict[str, Sample]:
    """Overturning of a body by motion and level [g tan(alpha)], by method."""
    peaks: dict[str, list[Array]] = {"recess model": [], "planar x": [], "planar y": []}
    planes = (None, 0.0, 0.5 * math.pi)
    for motion in motions:
        scales = levels * 9.81 * body.tan_alpha / motion.peak
        for own, plane in zip(peaks.values(), planes, strict=True):
            ratio = body.slab_mass_ratio
            peak = partial(reduced.peak_tilts, plane=plane, slab_mass_ratio=ratio, tendon=tendon)
            of_scales = peak([body.semidiagonal], body.tan_alpha, motion, scales)
            own.append(of_scales[0])
    tilts = {method: np.array(own) for method, own in peaks.items()}
    tilts["worse plane"] = np.maximum(tilts["planar x"], tilts["planar y"])
    x = np.broadcast_to(np.log(levels), (len(motions), len(levels)))
    return {
        method: Sample(x=x, y=np.where(np.isnan(own), np.nan, (own >= _SIDE_DOWN).astype(float)))
        for method, own in tilts.items()
    }


def _stated(name: str, centres: list[Array], over: list[Array] | None, motions: int) -> dict[str, float]:
    differences = [
        each - (0.0 if over is None else other) for each, other in zip(centres, over or centres, strict=True)
    ]
    return interval(float(differences[0][0]), differences[1], motions).exponential().columns(name)


def on_flat_ground(motions: Sequence[GroundMotion], engine: str) -> Iterator[dict[str, float | str]]:
    """Yield residual displacements of the pier by prestress: medians over runs in which it stands."""
    scale = FLAT_LEVEL * 9.81 * PIER.tan_alpha
    for prestress in PRESTRESS:
        tendon = Tendon(prestress=prestress) if prestress else None
        left, fallen = [], 0
        for motion in motions:
            case = Case(PIER, motion.scaled(scale / motion.peak), friction=3.0, tendon=tendon)
            trace = multibody.simulate(case, engine=engine, support="flat", time_step=FLAT_STEP)
            fallen += trace.outcome == _OVERTURNED
            if trace.outcome == "stands":
                left.append(float(np.hypot(*trace.centre_of_mass[-1, :2])) / PIER.base_radius)
        interval = quantile_interval(np.array(left), 0.5)
        yield {
            **{"engine": engine, "prestress": prestress, "motions": len(motions), "overturned": fallen},
            **interval.columns("displacement"),
        }


def picture(table: pd.DataFrame) -> Picture:
    """Medians of the pier in 3D over the prestress, by stiffness."""
    own = table[(table["body"] == "pier") & (table["method"] == "recess model")]
    names = [f"k/k_n = {each:g}" for each in STIFFNESS]
    styles, layers = run_styles(names), []
    for place, (name, stiffness) in enumerate(zip(names, STIFFNESS, strict=True)):
        rows = own[own["stiffness"] == stiffness]
        x, y, low, high = (
            rows[each].to_numpy(float) for each in ("prestress", "median", "median_low", "median_high")
        )
        x = x + 0.01 * place  # beside each other
        layers.append(Line(x=x, y=y, name=name, style=styles[name]))
        bar = Style(colour=styles[name].colour)
        layers.append(Line(x=np.repeat(x, 3), y=bar_ends(low, high), style=bar, width=0.9))
    panel = Panel(
        x=Axis(label="prestress", unit="weights of the pier", low=-0.05, high=1.05),
        y=Axis(label="median overturning intensity", unit="g tan α", low=0.0),
        layers=layers,
        height=3.2,
    )
    title = "Overturning of a pier with a tendon, in three dimensions"
    return Picture(name="tendons", title=title, panels=[panel], legend="below")


def main(arguments: Sequence[str]) -> int:
    """Print the tables; make them first where motions or an engine are named."""
    import pandas as pd

    parser = options_of("tendons", "Median overturning intensities with a tendon.")
    parser.add_argument("--motions", help="p695, or a number of synthetic motions, for the medians")
    parser.add_argument("--engine", help="for flat ground under the motions of P-695")
    parser.add_argument("--out", type=Path, help="folder for the tables and the figure")
    options = parser.parse_args(arguments)
    tables: dict[str, pd.DataFrame] = {}
    if options.motions is not None:
        motions, many = motions_of(options.motions), options.motions != "p695"
        rows = medians_of_many(motions) if many else medians(motions)
        count = len(BODIES) * (4 * len(GROWTH) if many else 64)
        tables[f"medians-{options.motions}"] = _table(rows, count)
    if options.engine is not None:
        left = on_flat_ground(motions_of("p695"), options.engine)
        tables[f"flat-{options.engine}"] = _table(left, len(PRESTRESS))
    if options.out is not None:
        options.out.mkdir(parents=True, exist_ok=True)
        for name, table in tables.items():
            table.to_csv(options.out / f"{name}.csv", index=False, float_format="%.4g")
            if name == "medians-p695":
                (options.out / "tendons.svg").write_bytes(svg(picture(table)))
    if not tables:
        tables = {path.stem: pd.read_csv(path) for path in sorted(PUBLISHED.glob("*.csv"))}
    for name, table in tables.items():
        words = ("body", "method", "engine")
        show(table, name, {column: "" if column in words else ".3g" for column in table.columns})
    return 0


def _table(rows: Iterator[dict[str, float | str]], count: int) -> pd.DataFrame:
    """Return rows as a table, and say on standard error how many there are."""
    import pandas as pd

    table = []
    for number, row in enumerate(rows, start=1):
        table.append(row)
        print(f"\r{number} of {count} rows", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return pd.DataFrame(table)
