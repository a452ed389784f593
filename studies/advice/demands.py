"""Demands on ground, recess and slab: of one run, of a group of runs, and up to an intensity.

A demand of a run is what it does not exceed in 99 % of its time in motion; where the run overturns, of the
motion up to overturning. A demand of a group is what 95 % of its runs do not exceed, the order statistic of
that rank. The design demand is the largest of all groups, under the shaking as given and under weaker shaking
of the same records (`weaker_factors`): weaker shaking may ask more, as where a cylinder rocks for long that
stronger shaking overturns at once, and a recess meets both.

What acts together is the largest shear, and the largest moment, of any run at a time at which nothing else is
beyond its demand: at the very time at which a run reaches a demand, another force may be in the hundredth of
the time, or in the twentieth of the runs, that its own demand leaves out.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockwobble.compare.metrics.pair import balance_of
from rockwobble.compare.metrics.statistics import FEWEST, covering
from rockwobble.models import RockingBody, Trace
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.support import support_named
from rockwobble.models.trace import NO_PEAK
from rockwobble.multibody.ring import rim_overhang

Array = NDArray[np.float64]

# percentile of the moving time [%], which leaves out the spikes of the nearest passes
SPIKES = 0.01
# share of the runs of a group within its demand
COVERED = 0.95
# ratio of neighbouring intensities of weaker shaking
LEVEL_RATIO = 2.0**0.25
# [alpha] tilt that a run asks of a wall at least if it passes the balance, whether it overturns or comes back
PASSED = 1.25
ROUNDING = 1e-12  # relative tolerance of sums and ratios of simultaneous actions
_FIRST_LEVEL = -4  # first level, in steps from the uplift threshold

_BASE = {"friction": "-", "shear": "weights", "force": "weights"}
_TOP = {f"top_{name}": unit for name, unit in _BASE.items()}
_SUMS = ("moment", "shear_and_wall")  # forces on a wall, without and with shear
_RECESS = {"moment": "weights × b", "shear_and_wall": "weights", "tilt": "alpha"}
# demands of a run with their units
_TENDON = "tendon"  # tension, in weights of a column alone
UNITS: Mapping[str, str] = {**_BASE, **_TOP, **_RECESS, _TENDON: "weights"}
# further columns of each run
SHARES = ("slip", "lost")
# demands that are also stated as maxima over all samples
PEAKS = {name: f"{name}_peak" for name in ("shear", "force")}
# demands stated with their simultaneous actions, and these actions
_LEADING = ("shear", "moment")
_TOGETHER = ("shear", "force", "moment")
_PAIRS = tuple(itertools.product(_LEADING, _TOGETHER))
_NOT_PLANE = "all runs stay in one plane, in which no moment arises: a real motion leaves it"


def overturning_time(trace: Trace) -> float:
    """Time at which an overturning run last passes its balance tilt [s]; inf if it stands.

    A fall asks nothing.
    """
    if trace.outcome != "overturned":
        return math.inf
    below = trace.time[trace.tilt <= balance_of(trace.case)]
    return float(below[-1]) if len(below) else 0.0


def demands_of(trace: Trace) -> dict[str, float]:
    """Demands of a run on ground, recess and slab, up to its overturning time.

    Samples at which the base is closed, see `Trace.open_base`, ask nothing.

    Returns
    -------
    dict
        friction [-], shear and (normal) force [weights] at the base and, as top_friction, top_shear and
        top_force, under the slab of a frame [weights of the share of the slab]; moment, of the recess about
        the vertical through the contact point, (1 + cos(tilt)) |kappa| [weights times b]; shear_and_wall,
        the sum at one time of shear and of the force on a wall that supplies the moment over the lever arm b
        [weights]: each not exceeded in 99 % of the moving time; shear_peak and force_peak, the largest of all
        samples: of rigid contact, in a near pass. shear_with_shear, shear_with_force and
        shear_with_moment: what acts together where the shear is largest of all times at which contact is
        kept and none of these is exceeded; moment_with_shear and so on, where the moment is. tilt, the
        largest [alpha]: at least `PASSED` of the balance where it passes that. tendon, the largest tension
        [weights of one column], with a tendon. slip and lost, shares of that time
        in which the friction of the case does not suffice and in which contact is lost, at base or top. All
        zero, and a force of one weight, where nothing moves.
    """
    cylinder, tendon = trace.case.cylinder, trace.case.tendon
    moving = trace.open_base & (trace.time <= overturning_time(trace))
    ends = [(_BASE, trace.contact_force, trace.friction_needed)]
    if cylinder.slab_mass_ratio > 0.0:
        ends.append((_TOP, trace.top_contact_force, trace.top_friction_needed))
    largest, balance = trace.peak_tilt / cylinder.alpha, balance_of(trace.case) / cylinder.alpha
    if trace.outcome == "overturned":
        largest = float(trace.tilt[moving].max(initial=0.0)) / cylinder.alpha
    if trace.outcome == "overturned" or largest > balance:
        largest = max(PASSED * balance, largest)
    lengths = np.diff(trace.time, append=trace.time[-1])[moving]
    tilt, kappa = trace.tilt[moving], np.abs(trace.restraining_moment[moving]) / cylinder.base_radius
    forces = [(names, force[moving], friction[moving]) for names, force, friction in ends]
    if not moving.any():  # one sample at rest, where none moves
        lengths = tilt = kappa = np.zeros(1)
        forces = [(names, np.array([[0.0, 0.0, 1.0]]), np.zeros(1)) for names, *_ in ends]
    lost, slips = np.zeros((2, len(lengths)), dtype=bool)
    series: dict[str, Array] = {}
    for names, force, friction in forces:
        x, y, normal = force.T
        series |= dict(zip(names, (friction, np.hypot(x, y), normal), strict=True))
        lost |= normal <= 0.0
        slips |= friction > trace.case.friction
    series["moment"] = (1.0 + np.cos(tilt)) * kappa
    series["shear_and_wall"] = series["shear"] + series["moment"]
    # sample that is not exceeded in 99 % of the time: a mean with infinity would be none
    rank = max(math.ceil((1.0 - SPIKES) * len(lengths)) - 1, 0)
    entries = {name: float(np.partition(values, rank)[rank]) for name, values in series.items()}
    entries |= {peak: float(series[name].max()) for name, peak in PEAKS.items()}
    usual = np.logical_and.reduce([series[name] <= entries[name] for name in (*_BASE, *_SUMS)])
    usual &= series["force"] > 0.0
    for name, part in _PAIRS:
        place = int(np.where(usual, series[name], -math.inf).argmax())
        entries[f"{name}_with_{part}"] = float(series[part][place]) if usual.any() else math.nan
    entries["tilt"] = largest
    if tendon is not None:
        entries[_TENDON] = tendon.tension(cylinder, min(largest * cylinder.alpha, OVERTURNED_TILT))
    time = max(float(lengths.sum()), 1e-300)
    return entries | {"slip": lengths[slips & ~lost].sum() / time, "lost": lengths[lost].sum() / time}


def weaker_factors(threshold: float) -> list[float]:
    """Factors below 1 on a record at which demands are also evaluated.

    They are a fixed series of intensities in steps of `LEVEL_RATIO`, so that those of stronger shaking by the
    same record contain those of weaker: its demands do not fall. The threshold of uplift, at which models
    chatter for long, lies between two of them.

    Parameters
    ----------
    threshold : float
        Factor at which the record uplifts.

    Examples
    --------
    >>> [round(factor, 3) for factor in weaker_factors(0.5)]
    [0.273, 0.324, 0.386, 0.459, 0.545, 0.648, 0.771, 0.917]
    """
    if not 0.0 < threshold < math.inf:
        return []
    # other records of equal peak velocity may uplift at scales below this threshold
    levels = (threshold * LEVEL_RATIO ** (step + 0.5) for step in itertools.count(_FIRST_LEVEL))
    return list(itertools.takewhile(lambda factor: factor < 1.0, levels))


def demand_table(
    members: pd.DataFrame, cylinder: RockingBody, *, gravity: float, support: str, mass: float | None = None
) -> pd.DataFrame:
    """Design demands on ground, recess and slab: the largest of all groups and intensities.

    Parameters
    ----------
    members : DataFrame
        Rows of `member_rows` that count, with the factor on the ground motion.
    cylinder : Cylinder or WobblingFrame
    gravity : float
        [m/s^2]
    support : str
        That is built.
    mass : float, optional
        Mass of one cylinder or column [t].

    Returns
    -------
    DataFrame
        demand, value, unit; per_tonne, the value for a mass of 1 t of what is carried, the cylinder or, in a
        frame, a column with its share of the slab or, at the top, this share, and for_mass, for that of
        `mass` [kN, kNm]; group and factor, of which it is, with runs, those of them that differ, covered, how
        many of these do not exceed it, and overturned, how many fall; with_shear, with_force and with_moment
        of shear and of moment: what acts together where one of them is largest and none is beyond its value
        [weights, weights times b]; peak, of shear and of force, what 95 % of the runs of a group exceed at no
        time, and peak_for_mass [kN]; reason, why a value is NaN: too few runs; "yields" or, of a wall,
        "overturns", where that is so of more than 5 % of a group, in covered runs.

        Demands: those of `demands_of` and, of the tilt, wall_height, at which the rim stands out farthest and
        a wall takes its force, and clearance, by which a vertical wall of this height must stand back [m].
    """
    facts, b = support_named(support), cylinder.base_radius
    groups = list(_groups(members))
    if not groups:
        return pd.DataFrame(columns=[*_COLUMNS, "per_tonne", "for_mass", "peak_for_mass"])
    rows: list[dict[str, Any]] = []
    yields, falls = (_most(groups, column) for column in ("yields", "overturns"))
    moves = any(runs["tilt"].gt(0.0).any() for *_, runs in groups if facts.is_recess)
    for name, unit in UNITS.items():
        lacks_slab = name in _TOP and not cylinder.slab_mass_ratio > 0.0
        lacks_recess = name in _RECESS and not facts.is_recess
        if lacks_slab or lacks_recess or (name == _TENDON and name not in members):
            continue
        row = {"demand": name, "unit": unit, **_largest(name, groups)}
        if yields is not None and name != _TENDON:
            row |= yields | {"value": math.nan, "reason": "yields"}
        elif name in PEAKS:
            row["peak"] = _largest(PEAKS[name], groups)["value"]
        elif name == "moment" and row["value"] == 0.0 and moves:
            row |= {"value": math.nan, "reason": _NOT_PLANE}
        rows.append(row)
    recess = {row["demand"]: row for row in rows}
    limits = {name: row["value"] for name, row in recess.items() if not math.isnan(row["value"])}
    for name in _LEADING:
        if name in limits:
            recess[name] |= _together(name, groups, limits)
    if "tilt" in recess:
        if math.isnan(recess["moment"]["value"]):
            recess["shear_and_wall"] |= {name: recess["moment"][name] for name in ("value", "reason")}
        theta = recess["tilt"]["value"] * cylinder.alpha
        overhang, height = (b * part for part in rim_overhang(theta))
        walls = {"wall_height": height, "clearance": max(overhang, height * math.tan(theta))}
        end = {}
        if falls is not None and yields is None:
            end = falls | {"value": math.nan, "reason": "overturns"}
        rows += [
            recess["tilt"] | {"demand": name, "unit": "m", "value": size} | end
            for name, size in walls.items()
        ]
    table = pd.DataFrame(rows, columns=_COLUMNS)
    arms = table["unit"].map({"weights": gravity, "weights × b": gravity * b}).astype(float)
    table["per_tonne"] = table["value"] * arms
    slab = cylinder.slab_mass_ratio
    carried = table["demand"].map({**dict.fromkeys(_TOP, slab), _TENDON: 1.0}).fillna(1.0 + slab)
    carried *= math.nan if mass is None else mass
    table["for_mass"], table["peak_for_mass"] = table["per_tonne"] * carried, table["peak"] * arms * carried
    return table


_COLUMNS = [
    *("demand", "value", "unit", "group", "factor", "runs", "covered", "overturned"),
    *("with_shear", "with_force", "with_moment", "peak", "reason"),
]


def _groups(members: pd.DataFrame) -> Iterator[tuple[str, float, pd.DataFrame]]:
    """Groups with enough runs to state a demand, at each intensity: `FEWEST` unless all runs are equal."""
    if not len(members):
        return
    for (group, _), runs in members.groupby(["group", "factor"], sort=False):
        known = runs[~runs["outcome"].isin(NO_PEAK)]
        if all_alike(known):
            known = known[:1]
        elif len(known) < FEWEST:
            continue
        yield str(group), float(known["factor"].iloc[0]) if len(known) else 1.0, known


def all_alike(runs: pd.DataFrame) -> bool:
    """Whether all moving runs of a group are equal, as when most records are too weak for uplift."""
    numbers = [name for name in ("peak_tilt", *UNITS) if name in runs.columns]
    return len(runs) > 1 and runs["peak_tilt"].min() > 0.0 and bool(runs[numbers].nunique().max() == 1)


def _most(groups: list[tuple[str, float, pd.DataFrame]], what: str) -> dict[str, Any] | None:
    """Group with the largest share of runs that yield or overturn, if above what a demand leaves out."""
    worst: dict[str, Any] | None = None
    share = 1.0 - COVERED
    for group, factor, runs in groups:
        ends = runs["outcome"] == "overturned" if what == "overturns" else runs["yields"]
        if ends.mean() > share * (1.0 + ROUNDING):
            share = float(ends.mean())
            worst = {"group": group, "factor": factor, "runs": len(runs), "covered": int(ends.sum())}
    return worst


def _largest(name: str, groups: list[tuple[str, float, pd.DataFrame]]) -> dict[str, Any]:
    """Largest value of a demand over all groups, with its group."""
    best: dict[str, Any] = {"value": math.nan, "reason": f"fewer than {FEWEST} runs differ"}
    for group, factor, runs in groups:
        value, covered = covering(runs[name].to_numpy(float), COVERED)
        if value <= best["value"]:  # false while the best is NaN, too
            continue
        best = {
            **{"value": value, "group": group, "factor": factor, "runs": len(runs), "covered": covered},
            "overturned": int((runs["outcome"] == "overturned").sum()),
            "reason": "",
        }
    return best


def _together(
    name: str, groups: list[tuple[str, float, pd.DataFrame]], limits: Mapping[str, float]
) -> dict[str, float]:
    """Simultaneous actions at the time of the largest shear or moment of a run within all limits."""
    runs = pd.concat([each for *_, each in groups])
    load = pd.DataFrame({part: runs[f"{name}_with_{part}"].astype(float) for part in _TOGETHER})
    acting = {part: load[part] for part in _TOGETHER}
    acting["friction"] = load["shear"] / load["force"].where(load["force"] > 0.0)
    acting["shear_and_wall"] = load["shear"] + load["moment"]
    within = pd.DataFrame(
        {part: values <= limits[part] * (1.0 + ROUNDING) for part, values in acting.items() if part in limits}
    )
    usual = load[within.all(axis=1)]
    if not len(usual):
        return {}
    place = int(usual[name].to_numpy().argmax())
    return {f"with_{part}": float(usual[part].iloc[place]) for part in _TOGETHER}
