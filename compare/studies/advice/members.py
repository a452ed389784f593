"""Many runs of one problem: copies of it, each a little different, and other records as strong as its own."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import (
    Case,
    Cylinder,
    GroundMotion,
    Trace,
    WobblingFrame,
    far_field_motions,
    synthetic_motions,
)
from rockwobble.models.records import p695
from rockwobble.models.support import support_named
from rockwobble.models.trace import NO_PEAK
from rockwobble.multibody.ring import rim_overhang

from ...metrics.statistics import Contrast, Interval, quantile_interval, share_interval, stated
from ..fragility import intensity

Array = NDArray[np.float64]

COPIES, ACCELERATION, VELOCITY = "copies", "acceleration", "velocity"
OTHER = "other support"  # group of the copies on the other support
_SEED = 1  # of synthetic ground motions where the records are not installed
# what is not exceeded in 99 % of the moving time leaves out the spikes of the nearest passes
SPIKES = 0.01
_QUANTILES = {"05": 0.05, "50": 0.5, "95": 0.95}
# demands of a run at its base and, in a frame, at the top, with their units
_BASE = {"friction": "-", "shear": "weights", "force": "weights"}
_TOP = {f"top_{name}": unit for name, unit in _BASE.items()}
# those of which there are percentiles over the members
DEMANDS = (*_BASE, *_TOP, "moment", "slip", "lost")


def fall_of(trace: Trace) -> float:
    """Return when a run that overturns last passes alpha [s], inf where it does not: a fall asks nothing."""
    if trace.outcome != "overturned":
        return math.inf
    below = trace.time[trace.tilt <= trace.case.cylinder.alpha]
    return float(below[-1]) if len(below) else 0.0


def demands_of(trace: Trace) -> dict[str, float]:
    """Return the demands of a run on ground, recess and slab, until it last passes alpha if it overturns.

    Returns
    -------
    dict
        friction [-], shear and (normal) force [weights] at the base and, as top_friction, top_shear and
        top_force, under the slab of a frame [weights of the share of the slab]; moment of the recess [weights
        times b]: each not exceeded in 99 % of the time in which the base is open (`Trace.open_base`). slip
        and lost, shares of that time in which the friction of the case does not suffice and in which contact
        is lost, at base or top. All zero, and a force of one weight, where nothing moves.
    """
    moving = trace.open_base & (trace.time <= fall_of(trace))
    ends = [(_BASE, trace.contact_force, trace.friction_needed)]
    if trace.case.cylinder.slab_mass_ratio > 0.0:
        ends.append((_TOP, trace.top_contact_force, trace.top_friction_needed))
    found: dict[str, float] = {}
    if not moving.any():
        for names, *_ in ends:
            found |= dict(zip(names, (0.0, 0.0, 1.0), strict=True))
        return found | {"moment": 0.0, "slip": 0.0, "lost": 0.0}
    lengths = np.diff(trace.time, append=trace.time[-1])[moving]
    lost, slips = np.zeros((2, len(lengths)), dtype=bool)
    for names, force, friction in ends:
        x, y, normal = force[moving].T
        values = (friction[moving], np.hypot(x, y), normal)
        found |= dict(zip(names, map(_usual, values), strict=True))
        lost |= normal <= 0.0
        slips |= friction[moving] > trace.case.friction
    found["moment"] = _usual(np.abs(trace.restraining_moment[moving]) / trace.case.cylinder.base_radius)
    time = max(float(lengths.sum()), 1e-300)
    return found | {"slip": lengths[slips & ~lost].sum() / time, "lost": lengths[lost].sum() / time}


def _usual(values: Array) -> float:
    # a value of the sample, because a mean with infinity is none
    return float(np.quantile(values, 1.0 - SPIKES, method="inverted_cdf"))


def top_displacement(cylinder: Cylinder, tilt: ArrayLike) -> Array:
    """Return the horizontal displacement of the top, over a circle of contact that stays [m].

    Of the centre of the top of a cylinder or, in a frame, of the slab: over it the rim of the top rolls as
    that of the base rolls over the ground.

    Parameters
    ----------
    cylinder : Cylinder
    tilt : array_like
        [rad]; infinite where it overturns, and so is then the displacement.
    """
    theta = np.asarray(tilt, dtype=np.float64)
    ends = 2.0 if isinstance(cylinder, WobblingFrame) else 1.0
    stands = np.where(np.isinf(theta), 0.0, theta)
    moved = ends * cylinder.base_radius * (1.0 - np.cos(stands)) + 2.0 * cylinder.half_height * np.sin(stands)
    return np.where(np.isinf(theta), math.inf, moved)


def peak_velocity(motion: GroundMotion) -> float:
    """Return the peak horizontal resultant of the ground velocity [m/s], of the record without its mean."""
    return intensity.largest_resultant(intensity.velocity(motion, centred=True))


def other_records(case: Case) -> tuple[dict[str, list[Case]], str]:
    """Return the case under other records, as strong as its own by peak acceleration and by peak velocity.

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
        name: [dataclasses.replace(case, motion=each, duration=None, name=each.name) for each in found]
        for name, found in ((ACCELERATION, motions), (VELOCITY, as_fast))
    }, source


def member_rows(group: str, traces: Iterable[Trace]) -> list[dict[str, float | str]]:
    """Return a row for each run: group, member, model, outcome, peak_tilt [alpha], and its demands."""
    return [
        {
            "group": group,
            "member": trace.case.name,
            "model": str(trace.run),
            "outcome": trace.outcome,
            "peak_tilt": trace.peak_tilt / trace.case.cylinder.alpha,
            **(demands_of(trace) if trace.outcome not in NO_PEAK else {}),
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


def group_table(members: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each group of members but the other support: how many overturn, and percentiles.

    Columns: group, runs, failed, overturned, single, whether all moved alike, which makes them one run;
    chance with chance_low and chance_high, and for peak_tilt [alpha], infinite where it overturns, and each
    of `DEMANDS` the percentiles _05, _50 and _95. NaN where too few runs differ, see `stated`.
    """
    rows = []
    numbers = ["peak_tilt", *(name for name in DEMANDS if name in members.columns)]
    for group, runs in members[members["group"] != OTHER].groupby("group", sort=False):
        known = runs[~runs["outcome"].isin(NO_PEAK)]
        fell = known["outcome"] == "overturned"
        # of records that differ none move alike, but many not at all
        single = len(known) > 1 and known["peak_tilt"].min() > 0.0 and known[numbers].nunique().max() == 1
        chance = Interval(value=math.nan, low=math.nan, high=math.nan)
        if not single:
            chance = share_interval(int(fell.sum()), len(known))
        values = known[numbers].assign(peak_tilt=known["peak_tilt"].mask(fell, math.inf))
        values = values[:1] if single else values
        rows.append(
            {
                "group": group,
                "runs": len(runs),
                "failed": len(runs) - len(known),
                "overturned": int(fell.sum()),
                "single": single,
                **chance.columns("chance"),
                **{
                    f"{name}_{label}": quantile_interval(values[name].to_numpy(float), share).value
                    for name in numbers
                    for label, share in _QUANTILES.items()
                },
            }
        )
    return pd.DataFrame(rows)


def demand_table(groups: pd.DataFrame, cylinder: Cylinder, gravity: float, support: str) -> pd.DataFrame:
    """Return the design demands on ground, recess and slab: the worst 95th percentiles of the groups.

    Columns: demand, value, unit, and per_tonne: that times g [kN], or times g b [kNm], for a mass of 1 t of
    what is carried, the cylinder or, in a frame, a column with its share of the slab or, at the top, this
    share. Demands: friction, shear and force at the base, with top_ before them those of a frame under its
    slab; and where a recess is built, of groups that stand to their 95th percentile: tilt; moment about the
    vertical through the contact point, (1 + cos(tilt)) kappa; wall_force, the least by which a wall supplies
    it, over the lever arm b; wall_height, at which the rim stands out farthest and the force acts; and
    clearance, by which a vertical wall of this height must stand back.
    """
    worst, facts = groups.max(numeric_only=True), support_named(support)
    rows = [(name, float(worst.get(f"{name}_95", math.nan)), unit) for name, unit in (_BASE | _TOP).items()]
    if len(groups) and (facts.guided or facts.walls):
        rows += _recess(groups[np.isfinite(groups["peak_tilt_95"])], cylinder)
    table = pd.DataFrame(rows, columns=["demand", "value", "unit"])
    arms = {"weights": gravity, "weights × b": gravity * cylinder.base_radius}
    table["per_tonne"] = table["value"] * table["unit"].map(arms).astype(float)
    return table[table["value"].notna()].reset_index(drop=True)


def _recess(standing: pd.DataFrame, cylinder: Cylinder) -> list[tuple[str, float, str]]:
    tilt, b = float(standing["peak_tilt_95"].max()), cylinder.base_radius
    if math.isnan(tilt):
        return []
    theta = tilt * cylinder.alpha
    moment = (1.0 + math.cos(theta)) * float(standing["moment_95"].max())
    overhang, height = (b * part for part in rim_overhang(theta))
    return [
        ("tilt", tilt, "alpha"),
        ("moment", moment, "weights × b"),
        ("wall_force", moment, "weights"),
        ("wall_height", height, "m"),
        ("clearance", max(overhang, height * math.tan(theta)), "m"),
    ]
