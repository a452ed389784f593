"""Many runs of one problem: copies of it, each a little different, and other records as strong as its own."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.models import Case, GroundMotion, Trace, far_field_motions, synthetic_motions
from rockwobble.models.records import p695

from ...metrics.distributions import Contrast
from ...metrics.order_statistics import Interval, quantile_interval, share_interval, stated
from ...metrics.pair import is_release
from ..fragility.intensity import largest_resultant, velocity

Array = NDArray[np.float64]

COPIES, ACCELERATION, VELOCITY = "copies", "acceleration", "velocity"
_SEED = 1  # of motions that are made up where the records are not installed
# what is not exceeded in 99 % of the moving time leaves out the spikes of the nearest passes
SPIKES = 0.01
_QUANTILES = {"05": 0.05, "50": 0.5, "95": 0.95}
# what each run asks, and of which it has a percentile over the members
DEMANDS = ("friction", "moment", "force", "slip", "lost")
_MOTION = ["peak_tilt", *DEMANDS]


def fall_of(trace: Trace) -> float:
    """Return when a run that overturns last passes alpha [s], inf where it does not: a fall asks nothing."""
    if trace.outcome != "overturned":
        return math.inf
    below = trace.time[trace.tilt <= trace.case.cylinder.alpha]
    return float(below[-1]) if len(below) else 0.0


def demands_of(trace: Trace) -> dict[str, float]:
    """Return the demands of a run on ground and recess, until it last passes alpha if it overturns.

    Returns
    -------
    dict
        friction [-], moment of the recess [weights times b] and normal force [weights], each not exceeded in
        99 % of the moving time; slip and lost, shares of that time in which the friction of the case does not
        suffice and in which contact is lost. All zero, and a force of one weight, where nothing moves.
    """
    moving = (trace.tilt > 0.0) & (trace.time <= fall_of(trace))
    if not moving.any():
        return dict(zip(DEMANDS, (0.0, 0.0, 1.0, 0.0, 0.0), strict=True))
    lengths = np.diff(trace.time, append=trace.time[-1])[moving]
    needed, force = trace.friction_needed[moving], trace.contact_force[moving, 2]
    lost = force <= 0.0
    values = (needed, np.abs(trace.restraining_moment[moving]) / trace.case.cylinder.base_radius, force)
    # a value of the sample, because a mean with infinity is none
    usual = [float(np.quantile(each, 1.0 - SPIKES, method="inverted_cdf")) for each in values]
    time = max(float(lengths.sum()), 1e-300)
    slip = (needed > trace.case.friction) & ~lost
    return dict(zip(DEMANDS, (*usual, lengths[slip].sum() / time, lengths[lost].sum() / time), strict=True))


def peak_velocity(motion: GroundMotion) -> float:
    """Return the peak horizontal resultant of the ground velocity [m/s], of the record without its mean."""
    return largest_resultant(velocity(motion, centred=True))


def other_records(case: Case) -> tuple[dict[str, list[Case]], str]:
    """Return the case under other records, as strong as its own by peak acceleration and by peak velocity.

    Those of FEMA P-695 where they are installed, else made-up ones; and "p695" or "synthetic". None for a
    release and without a ground motion.
    """
    motion = case.motion
    if motion is None or motion.peak == 0.0 or is_release(case):
        return {}, ""
    source = "synthetic" if p695.missing_packages() else "p695"
    motions = (
        synthetic_motions(p695.PAIRS, peak=motion.peak, seed=_SEED)
        if source == "synthetic"
        else far_field_motions(peak=motion.peak)
    )
    own = peak_velocity(motion)
    scaled = {
        ACCELERATION: motions,
        VELOCITY: [each.scaled(own / peak_velocity(each)) for each in motions],
    }
    return {
        name: [dataclasses.replace(case, motion=each, duration=None, name=each.name) for each in found]
        for name, found in scaled.items()
    }, source


def member_rows(group: str, traces: Iterable[Trace]) -> list[dict[str, float | str]]:
    """Return a row for each run: group, member, model, outcome, peak_tilt [alpha], and what it asks."""
    return [
        {
            "group": group,
            "member": trace.case.name,
            "model": str(trace.run),
            "outcome": trace.outcome,
            "peak_tilt": trace.peak_tilt / trace.case.cylinder.alpha,
            **(demands_of(trace) if trace.outcome != "failed" else {}),
        }
        for trace in traces
    ]


def ratios_of(found: Contrast) -> dict[str, float]:
    """Return what may be stated of the largest tilts of copies by one of two ways over those by the other.

    Returns
    -------
    dict
        members, copies run both ways; overturned and against_overturned, those that overturn; count, copies
        with a ratio, higher and lower, those with one above and below 1; ratio, low and high, the median and
        its interval, ratio_05 and ratio_95: NaN where they may not be stated, see `stated`.
    """
    names = {"ratio": found.ratio, "ratio_05": found.ratio_05, "ratio_95": found.ratio_95}
    return {
        "members": found.count,
        "overturned": found.overturned,
        "against_overturned": found.against_overturned,
        "count": found.compared,
        "higher": found.higher,
        "lower": found.lower,
        **{name: stated(each.value, found.compared, ratio=True) for name, each in names.items()},
        "low": found.ratio.low,
        "high": found.ratio.high,
    }


def answers(members: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each group of members: how many overturn, and percentiles of the rest.

    Columns: group, runs, failed, overturned, single, whether all moved alike, which makes them one run;
    chance with chance_low and chance_high, and for peak_tilt [alpha], infinite where it overturns, and each
    of `DEMANDS` the percentiles _05, _50 and _95. NaN where too few runs differ, see `stated`.
    """
    rows = []
    for group, runs in members.groupby("group", sort=False):
        known = runs[runs["outcome"] != "failed"]
        # of records that differ none move alike, but many not at all
        single = len(known) > 1 and known["peak_tilt"].min() > 0.0 and known[_MOTION].nunique().max() == 1
        failed, counted = len(runs) - len(known), int((known["outcome"] == "overturned").sum())
        chance = Interval(value=math.nan, low=math.nan, high=math.nan)
        if not single:
            chance = share_interval(counted, len(known))
        known = known[:1] if single else known
        fell = known["outcome"] == "overturned"
        numbers: Mapping[str, Array] = {
            "peak_tilt": known["peak_tilt"].mask(fell, math.inf).to_numpy(float),
            **{name: known[name].to_numpy(float) for name in DEMANDS},
        }
        rows.append(
            {
                "group": group,
                "runs": len(runs),
                "failed": failed,
                "overturned": counted,
                "single": single,
                **chance.columns("chance"),
                **{
                    f"{name}_{label}": quantile_interval(values, share).value
                    for name, values in numbers.items()
                    for label, share in _QUANTILES.items()
                },
            }
        )
    return pd.DataFrame(rows)
