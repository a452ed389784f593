"""Many runs of one problem: perturbed copies, and other records of equal strength."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from functools import partial

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockwobble.compare.metrics.contrast import Contrast
from rockwobble.compare.metrics.pair import beyond_yield
from rockwobble.compare.metrics.statistics import (
    FEWEST,
    Interval,
    covering,
    quantile_interval,
    share_interval,
    value_if_enough,
)
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import (
    Case,
    GroundMotion,
    RockingBody,
    Run,
    Trace,
    el_centro_1940,
    far_field_motions,
    synthetic_motions,
)
from rockwobble.models.cpus import in_threads
from rockwobble.models.records import p695
from rockwobble.models.trace import NO_PEAK

from ..fragility import intensity
from ..spectrum.parts import uplift_factor
from .demands import COVERED, SHARES, UNITS, all_alike, demands_of

Array = NDArray[np.float64]

COPIES, ACCELERATION, VELOCITY = "copies", "acceleration", "velocity"
OTHER = "other support"  # group of the copies on the other support
# groups of copies with the vertical component of a record that the case leaves out, and without the one
# that it has
VERTICAL, HORIZONTAL = "with vertical", "without vertical"
# groups outside of the stated problem: shown, without effect on grades and demands
BESIDE_THE_PROBLEM = (OTHER, HORIZONTAL)
# [s] of the samples of demands: of a short motion 99 % of the time at 0.02 s are all but its largest spike,
# which rounding moves by a fifth; at 0.005 s they are within 2 % of those at 0.002 s
DEMAND_STEP = 0.005
# members of each group that are run at each intensity of weaker shaking: all other records, and as many
# copies, of which 95 % are all but one
WEAKER_COUNT = 22
_CLOSE = 1e-9  # relative margin of an uplift threshold, for rounding
_SEED = 1  # seed of synthetic ground motions where the records are not installed
_QUANTILES = {"05": 0.05, "50": 0.5}
# columns with percentiles over the members
DEMANDS = (*UNITS, *SHARES)


def top_displacement(cylinder: RockingBody, tilt: ArrayLike) -> Array:
    """Horizontal displacement of the top while the contact circle stays in place [m].

    Of the centre of the top of a cylinder or, in a frame, of the slab: over it the rim of the top rolls as
    that of the base rolls over the ground.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
    tilt : array_like
        [rad]; infinite where it overturns, and so is then the displacement.
    """
    theta = np.asarray(tilt, dtype=np.float64)
    ends = 2.0 if cylinder.carries_slab else 1.0
    stands = np.where(np.isinf(theta), 0.0, theta)
    moved = ends * cylinder.base_radius * (1.0 - np.cos(stands)) + 2.0 * cylinder.half_height * np.sin(stands)
    return np.where(np.isinf(theta), math.inf, moved)


def peak_velocity(motion: GroundMotion) -> float:
    """Peak horizontal resultant of the ground velocity [m/s], with the mean acceleration removed."""
    return intensity.largest_resultant(intensity.velocity(motion, centred=True))


def other_records(case: Case) -> tuple[dict[str, list[Case]], str]:
    """The case under other records, scaled to its peak acceleration and to its peak velocity.

    Those of FEMA P-695 where they are installed, else synthetic ones; and "p695" or "synthetic". None for a
    release and without a ground motion.
    """
    motion = case.motion
    if motion is None or motion.peak == 0.0 or case.is_release:
        return {}, ""
    if p695.missing_packages():
        source, motions = "synthetic", synthetic_motions(p695.PAIRS, peak=motion.peak, seed=_SEED)
    else:
        source, motions = "p695", far_field_motions(peak=motion.peak)
    velocity = peak_velocity(motion)
    as_fast = [each.scaled(velocity / peak_velocity(each)) for each in motions]
    return {
        name: [dataclasses.replace(case, motion=each, duration=None, name=each.name) for each in scaled]
        for name, scaled in ((ACCELERATION, motions), (VELOCITY, as_fast))
    }, source


def member_row(trace: Trace, group: str, factor: float = 1.0) -> dict[str, float | str]:
    """Table row of one run.

    group, member, factor [-], model, outcome, peak_tilt [alpha], yields, see `beyond_yield`, and demands.
    """
    return {
        "group": group,
        "member": trace.case.name,
        "factor": factor,
        "model": str(trace.run),
        "outcome": trace.outcome,
        "peak_tilt": trace.peak_tilt / trace.case.cylinder.alpha,
        "yields": bool(beyond_yield(trace.peak_tilt, trace.case)),
        **(demands_of(trace) if trace.outcome not in NO_PEAK else {}),
    }


def member_rows(group: str, traces: Iterable[Trace]) -> list[dict[str, float | str]]:
    """Table rows of some runs, see `member_row`."""
    return list(in_threads(partial(member_row, group=group), traces))


def run_rows(
    group: str, cases: Sequence[Case], model: Run, factor: float = 1.0
) -> list[dict[str, float | str]]:
    """Rows of the cases of one group by a reduced model, with a factor on their ground motions."""

    def row(case: Case) -> dict[str, float | str]:
        motion = case.motion if case.motion is None or factor == 1.0 else case.motion.scaled(factor)
        trace = simulate_run(dataclasses.replace(case, motion=motion), model, sample_step=DEMAND_STEP)
        return member_row(trace, group, factor)

    # one run at rest stands for all motions too weak to uplift
    still = [each for each in cases if not each.is_release and uplift_of(each) > factor * (1.0 + _CLOSE)]
    at_rest = row(still[0]) if still else {}
    names = {id(each) for each in still}
    moving = iter(in_threads(row, [each for each in cases if id(each) not in names]))
    return [at_rest | {"member": each.name} if id(each) in names else next(moving) for each in cases]


def tendon_uplift_factor(case: Case) -> float:
    """Factor by which a tendon raises the uplift threshold [-]."""
    return 1.0 if case.tendon is None else case.tendon.uplift_factor(case.cylinder)


def uplift_of(case: Case, motion: GroundMotion | None = None) -> float:
    """Uplift factor on the motion of a case, or on another motion [-]; inf if it never uplifts."""
    motion = motion or case.motion
    if motion is None:
        return math.inf
    return tendon_uplift_factor(case) * uplift_factor(
        motion, case.cylinder.tan_alpha, case.gravity, until=case.length
    )


def with_vertical(motion: GroundMotion) -> GroundMotion | None:
    """Ground motion with its vertical component, or else with that of the shipped record.

    None where it has none and is no scaled part of the shipped record from its start.
    """
    if motion.has_vertical:
        return motion
    record = el_centro_1940(vertical=True)
    count = len(motion.acceleration)
    if motion.time_step != record.time_step or count > len(record.acceleration):
        return None
    samples = record.acceleration[:count]
    largest = float(np.abs(samples[:, :2]).max())
    factor = float(np.abs(motion.acceleration[:, :2]).max()) / largest if largest else 0.0
    if not factor or not np.allclose(
        motion.acceleration[:, :2], factor * samples[:, :2], rtol=0.0, atol=1e-9 * factor * largest
    ):
        return None
    return motion.with_samples(factor * samples, "with the vertical component of the record")


def without_vertical(motion: GroundMotion) -> GroundMotion:
    """Two horizontal components of a ground motion."""
    if not motion.has_vertical:
        return motion
    return motion.with_samples(motion.acceleration[:, :2], "without the vertical component")


def ratios_of(contrast: Contrast) -> dict[str, float]:
    """Statistics of the ratio of peak tilts of copies by two methods.

    Returns
    -------
    dict
        members, copies run both ways; overturned and against_overturned, those that overturn; count, copies
        with a ratio, higher and lower, those with one above and below 1; ratio, low and high, the median and
        its interval, ratio_05 and ratio_95: NaN where they may not be stated, see `stated`.
    """
    names = {"ratio": contrast.ratio, "ratio_05": contrast.ratio_05, "ratio_95": contrast.ratio_95}
    return {
        "members": contrast.count,
        "overturned": contrast.overturned,
        "against_overturned": contrast.against_overturned,
        "count": contrast.compared,
        "higher": contrast.higher,
        "lower": contrast.lower,
        **{name: value_if_enough(each.value, contrast.compared, ratio=True) for name, each in names.items()},
        "low": contrast.ratio.low,
        "high": contrast.ratio.high,
    }


def group_table(members: pd.DataFrame) -> pd.DataFrame:
    """One row per group of members: overturning count and percentiles; without the other support.

    Columns: group, runs, failed, overturned; yielded, those of which no more is known than that their tendon
    yields, which do not count as overturned; single, whether all moved alike, which makes them one run;
    counts, whether grades and demands rest on it; chance with chance_low and chance_high; covered, how many
    of the runs that did not fail make 95 % of them; and for peak_tilt [alpha], inf where it overturns or
    yields, and
    each of `DEMANDS` the percentiles _05 and _50, and _95, which `covered` of the runs do not exceed. NaN
    where too few runs differ, see `stated`.
    """
    rows = []
    numbers = ["peak_tilt", *(name for name in DEMANDS if name in members.columns)]
    for group, runs in members[members["group"] != OTHER].groupby("group", sort=False):
        known = runs[~runs["outcome"].isin(NO_PEAK)]
        yields = known["yields"].astype(bool)
        fell = (known["outcome"] == "overturned") & ~yields
        single = all_alike(known)
        chance = share_interval(int(fell.sum()), len(known))
        if single:
            chance = Interval(value=math.nan, low=math.nan, high=math.nan)
        values = known[numbers].assign(peak_tilt=known["peak_tilt"].mask(fell | yields, math.inf))
        values = values[:1] if single else values
        upper = dict.fromkeys(numbers, (math.nan, 0))
        if single or len(values) >= FEWEST:
            upper = {name: covering(values[name].to_numpy(float), COVERED) for name in numbers}
        rows.append(
            {
                "group": group,
                "runs": len(runs),
                "failed": len(runs) - len(known),
                "overturned": int(fell.sum()),
                "yielded": int(yields.sum()),
                "single": single,
                "counts": group not in BESIDE_THE_PROBLEM,
                **chance.columns("chance"),
                "covered": upper["peak_tilt"][1],
                **{
                    f"{name}_{label}": quantile_interval(values[name].to_numpy(float), share).value
                    for name in numbers
                    for label, share in _QUANTILES.items()
                },
                **{f"{name}_95": value for name, (value, _) in upper.items()},
            }
        )
    return pd.DataFrame(rows)
