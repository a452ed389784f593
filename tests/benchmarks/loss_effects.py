"""Effects of a small loss: fragility of the pier, and agreement times.

`python tests/benchmarks loss_effects` prints two tables from reports/published/loss, and with ``--run`` makes
them first: medians and dispersions of the pier over the length of rolling resistance, all under the same
motions, and the agreement time of the model with itself (the motion 1 % or 1e-6 stronger) and with MuJoCo
(friction 20, with which its couple is that of the models).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import rockwobble as rw
from rockwobble.compare.metrics.pair import agreement_time, make_pair

from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

FOLDER = Path(__file__).parents[2] / "reports" / "published" / "loss"
PIER = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
SHARES = (0.0, 0.003, 0.01, 0.03)  # delta over b
LEVELS = (1.5, 2.0, 2.75, 3.75, 5.0, 6.5, 9.0, 12.0)  # peak over g tan(alpha)
MOTIONS, SEED = 200, 16
_STRONGER = {"1 %": 1.01, "1e-6": 1.0 + 1e-6}
_ENGINE, _COMPARED, _WITH_ENGINE = "mujoco", 12, 3  # motions: El Centro, and synthetic ones
_PEAK, _DURATION, _FRICTION = 3.0, 20.0, 20.0  # [g tan alpha], [s]
_STEP = 2e-4  # [s] of the engine


def fragilities() -> pd.DataFrame:
    """Return median [g tan alpha] and dispersion of two limits, recess and flat ground, for each length."""
    import pandas as pd

    motions = rw.synthetic_motions(MOTIONS, peak=1.0, seed=SEED)
    tables = []
    for share in SHARES:
        study = rw.fragility(
            PIER,
            motions,
            methods=["recess", "flat"],
            levels=LEVELS,
            limits=["0.5 alpha", "overturned"],
            resamples=500,
            rolling_resistance=share * PIER.base_radius,
        )
        tables.append(study.fits.assign(delta_b=share))
    names = ["delta_b", "method", "limit", "runs", "exceeded", "failed", "median", "median_low"]
    return pd.concat(tables)[[*names, "median_high", "dispersion"]]


def _cases(share: float) -> Iterator[rw.Case]:
    records = [rw.el_centro_1940(), *rw.synthetic_motions(_COMPARED - 1, peak=1.0, seed=SEED)]
    unit = _PEAK * 9.81 * PIER.tan_alpha
    for record in records:
        motion = record.scaled(unit / record.peak)
        length = share * PIER.base_radius
        yield rw.Case(
            PIER, motion, duration=_DURATION, friction=_FRICTION, rolling_resistance=length, name=record.name
        )


def _agreement(case: rw.Case, reference: rw.Trace, trial: rw.Trace) -> tuple[float, bool]:
    agreement = agreement_time(make_pair(case.cylinder, reference, trial), broken=trial.outcome == "failed")
    return agreement.end - reference.uplift_time, agreement.diverged


def agreements() -> pd.DataFrame:
    """Agreement time of each motion [s from uplift], and whether the traces diverged."""
    import dataclasses

    import pandas as pd

    rows: list[tuple[Any, ...]] = []
    for share in SHARES:
        for index, case in enumerate(_cases(share)):
            assert case.motion is not None
            reference = rw.simulate(case, rtol=1e-10)
            for name, factor in _STRONGER.items():
                stronger = dataclasses.replace(case, motion=case.motion.scaled(factor))
                copy = rw.simulate(stronger, rtol=1e-10)
                rows.append((share, name, case.name, *_agreement(case, reference, copy)))
            if index < _WITH_ENGINE:
                trial = rw.simulate(case, engine=_ENGINE, time_step=_STEP)
                rows.append((share, _ENGINE, case.name, *_agreement(case, reference, trial)))
    return pd.DataFrame(rows, columns=["delta_b", "trial", "motion", "agreement_time", "diverged"])


def by_length(table: pd.DataFrame) -> pd.DataFrame:
    """Median and quartiles of the agreement time, and diverged count, by trial and length."""
    import pandas as pd

    rows = []
    for (trial, share), part in table.groupby(["trial", "delta_b"]):
        low, middle, high = np.percentile(part["agreement_time"], [25.0, 50.0, 75.0])
        rows.append((trial, share, len(part), int(part["diverged"].sum()), middle, low, high))
    names = ["trial", "delta_b", "motions", "diverged", "median", "low", "high"]
    return pd.DataFrame(rows, columns=names)


def stored(name: str) -> pd.DataFrame:
    """Table of the folder."""
    import pandas as pd

    return pd.read_csv(FOLDER / f"{name}.csv")


def main(arguments: Sequence[str]) -> int:
    """Print the tables, computing them first on request."""
    parser = options_of("loss_effects", "Fragility and agreement times with rolling resistance.")
    parser.add_argument("--run", action="store_true", help="make the tables first (minutes)")
    if parser.parse_args(arguments).run:
        FOLDER.mkdir(exist_ok=True)
        for name, made in (("fragility", fragilities), ("agreement", agreements)):
            made().to_csv(FOLDER / f"{name}.csv", index=False, float_format="%.6g", lineterminator="\n")
    forms = {"delta_b": ".3f", "method": "", "limit": "", "runs": "d", "exceeded": "d", "failed": "d"}
    forms |= {"median": ".3f", "median_low": ".3f", "median_high": ".3f", "dispersion": ".3f"}
    show(stored("fragility"), "Fragility of the pier, medians in g tan(alpha)", forms)
    forms = {"trial": "", "delta_b": ".3f", "motions": "d", "diverged": "d"}
    forms |= {"median": ".2f", "low": ".2f", "high": ".2f"}
    show(by_length(stored("agreement")), f"Agreement time of {_DURATION:g} s, in s from uplift", forms)
    return 0
