"""Verdict on an external trajectory compared with a model, in numbers and codes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from rockwobble.models import AGREEMENT, Case, Trace
from rockwobble.models.case import MOST_RESISTANCE
from rockwobble.models.frames import column_meanings, pd

from ..metrics.pair import TILTED, start_of
from ..runs.execution import simulate_run
from .mistakes import ENERGY_LOSS, ROLLING_RESISTANCE, Mistake, explanations
from .motion import Difference, Motion, Part, Reference, exceeds, motion_at
from .table import Array, Values
from .trajectory import external_motion, measurement, trajectory_of, twist_since_start

LEAST_LOSS = 5e-3  # smallest relative loss of a maximum from swing to swing that is reported
FEWEST_MAXIMA = 3
LESS_DIFFERENCE = 0.25  # largest share of the tilt difference that may remain with a rolling resistance
LEAST_RESISTANCE = 1e-4  # smallest rolling resistance tried, over b
# standard deviations of the noise: margin for the first of some hundred samples above a tilt
CONFIDENCE = 4.0

Row = dict[str, Any]  # row of a summary
# columns of an external trajectory besides case, run and reference: unit, meaning
VERDICT_COLUMNS = column_meanings("rockwobble.compare", "verdict")
# columns that hold a tuple
LISTS = (
    *("differs_in", "not_compared", "not_given", "differs_without_mistake"),
    *("likely_mistake", "likely_mistake_in", "likely_mistake_value"),
)
# values of a trajectory without differences
NO_VERDICT: Row = {name: () if name in LISTS else math.nan for name in VERDICT_COLUMNS}


def reference_of(trace: Trace, case: Case) -> Reference:
    """Reference of an external trajectory of a case."""
    cylinder = case.cylinder
    motion = motion_at(trace.time, trace.tilt, trace.rolling_angle, trace.centre_of_mass)
    return Reference(
        motion=replace(motion, twist=twist_since_start(trace)),
        alpha=cylinder.alpha,
        base_radius=cylinder.base_radius,
        time_scale=math.sqrt(cylinder.semidiagonal / case.gravity),
        start=start_of(trace),
        is_free=case.motion is None,
        tilt_bound=AGREEMENT,
        least_lean=TILTED,
    )


def judge(trajectory: Trace, reference: Trace, case: Case) -> Row:
    """Verdict on an external trajectory of a case and the trace of a model.

    The columns are `VERDICT_COLUMNS`, and the differences at uplift where both uplift.
    """
    model, motion, source = (
        reference_of(reference, case),
        external_motion(trajectory),
        measurement(trajectory),
    )
    residual = model.difference(motion)
    uplift = dict(
        zip(("uplift_time", "uplift_direction"), uplift_differences(trajectory, reference), strict=True)
    )
    later = [name for name, part in uplift.items() if part is not None and part.differs]
    parts = (("azimuth", residual.azimuth, motion.lean), ("path", residual.path, motion.path))
    row: Row = NO_VERDICT | {
        "differs_in": (*residual.differs_in, *later),
        "not_compared": tuple(name for name, part, _ in parts if part is None),
        "not_given": tuple(name for name, _, given in parts if given is None),
        "tilt_bound": residual.tilt.bound,
        "noise": source.poses.noise / case.cylinder.alpha,
    }
    for name, part in uplift.items():
        if part is not None:
            row |= {f"{name}_difference": part.size, f"{name}_uncertainty": part.bound}
    for name, part in {"azimuth": residual.azimuth, "path": residual.path, "twist": residual.twist}.items():
        if part is not None:
            size = part.size if name == "path" else math.degrees(part.size)
            row |= {f"{name}_rms": size, f"{name}_differs_from": part.first_time}

    def read(values: Values) -> Motion | None:
        try:
            other = trajectory_of(replace(source.table, values=values), source.given, case)
        except ValueError:
            return None
        return external_motion(other)

    explained = next(explanations(source.table.values, read, model), None) if residual.differs_in else None
    mistakes: tuple[Mistake, ...] = explained.mistakes if explained else ()
    left = explained.left if explained else residual
    if residual.tilt.differs and left.tilt.differs:  # a loss is sought before passes are blamed
        lost, without = losses(motion, model, reference, case)
        mistakes, left = (*lost, *mistakes), without if len(lost) > 1 and not mistakes else left
    if mistakes:
        row |= {
            "likely_mistake": tuple(mistake.code for mistake in mistakes),
            "likely_mistake_in": tuple(mistake.concerns for mistake in mistakes),
            "likely_mistake_value": tuple(mistake.value for mistake in mistakes),
            "differs_without_mistake": left.differs_in,
            # as of the agreement time: the length of the run where they never diverge
            "agreement_without_mistake": left.length if left.tilt.differs else left.end,
        }
    return row


def losses(
    motion: Motion, reference: Reference, trace: Trace, case: Case
) -> tuple[tuple[Mistake, ...], Difference]:
    """Rolling resistance that explains the tilt difference, if one does, and the difference without it.

    The models of recess and flat ground lose nothing: over still ground each maximum of the tilt is as high
    as the one before, whatever becomes of the azimuths in the passes between. `trace` is that of the model.
    """
    before, share = reference.difference(motion), loss_of(motion, reference)
    if not (before.tilt.differs and share > LEAST_LOSS and trace.run.is_model):
        return (), before
    loss = Mistake(code=ENERGY_LOSS, concerns="tilt", value=share)
    radius = case.cylinder.base_radius

    def difference(length: float) -> Difference:
        other = simulate_run(replace(case, rolling_resistance=length), trace.run)
        moved = motion_at(other.time, other.tilt, other.rolling_angle, other.centre_of_mass)
        return replace(reference, motion=moved).difference(motion)

    low, high, count = LEAST_RESISTANCE * radius, MOST_RESISTANCE * radius, 17
    for _ in range(4):
        lengths = np.geomspace(low, high, count).tolist()
        tried = [difference(length) for length in lengths]
        best = min(range(count), key=lambda at: tried[at].tilt.size)
        low, high, count = lengths[max(best - 1, 0)], lengths[min(best + 1, count - 1)], 7
    if tried[best].tilt.size > LESS_DIFFERENCE * before.tilt.size:
        return (loss,), before
    return (loss, Mistake(code=ROLLING_RESISTANCE, concerns="tilt", value=lengths[best])), tried[best]


def loss_of(motion: Motion, reference: Reference) -> float:
    """Share of a maximum of the tilt lost to the next, the median; 0 where unknown.

    That of a release on still ground alone: elsewhere the ground makes and takes energy. 0 too where a
    maximum is higher than the one before by more than noise.
    """
    if not reference.is_free:
        return 0.0
    height = maxima(motion.tilt, 5.0 * motion.noise + 1e-3 * float(motion.tilt.max(initial=0.0)))
    if len(height) < FEWEST_MAXIMA:
        return 0.0
    lost = 1.0 - height[1:] / height[:-1]
    return float(np.median(lost)) if lost.min() > -0.5 * LEAST_LOSS else 0.0


def maxima(tilt: Array, least: float) -> Array:
    """Maxima of a tilt from which it falls by more than `least` [rad], the first included."""
    entries: list[float] = []
    highest, lowest = float(tilt[0]), math.inf
    for value in tilt.tolist():
        if lowest == math.inf:  # increasing, or just after a maximum
            highest = max(highest, value)
            if value < highest - least:
                entries.append(highest)
                lowest = value
        else:
            lowest = min(lowest, value)
            if value > lowest + least:
                highest, lowest = value, math.inf
    return np.array(entries)


def uplift_differences(trajectory: Trace, reference: Trace) -> tuple[Part | None, Part | None]:
    """Time [s] and azimuth [rad] of the first tilt of a trajectory, minus those of a model.

    A cylinder may rock for a while below the tilt that its samples can show. So what is compared is when both
    lean that far, and the model shows how well noise and samples determine that time.
    The size of each is the difference and its bound the uncertainty; both are None for a release, or where
    one of the two never leans.
    """
    source = measurement(trajectory)
    stands, blur = source.poses.stands, CONFIDENCE * source.poses.noise
    seen = source.first_lean
    passed = [first_passage(reference, tilt) for tilt in (stands - blur, stands, stands + blur)]
    if not (seen > 0.0 and 0.0 < passed[1] < math.inf):
        return None, None
    early, middle, late = passed
    # a trajectory may miss a tilt that the model only just reaches: undecided up to the largest tilt
    late = late if math.isfinite(late) else float(reference.time[int(np.argmax(reference.tilt))])
    half = 0.5 * trajectory.time_step
    apart = seen - half - middle
    uncertainty = half + max(late - middle, middle - early)
    time = Part(first_time=seen if abs(apart) > uncertainty else math.nan, size=apart, bound=uncertainty)
    if not math.isfinite(trajectory.uplift_direction):
        return time, None
    around = seen + uncertainty * np.linspace(-1.0, 1.0, 9)
    angle = np.interp(
        [seen, *around],
        reference.time,
        np.nan_to_num(reference.rolling_angle, nan=reference.uplift_direction),
    )
    turned = float(np.abs(angle[1:] - angle[0]).max())
    off = math.remainder(trajectory.uplift_direction - float(angle[0]), 2.0 * math.pi)
    bound = turned + blur / stands
    return time, Part(first_time=seen if abs(off) > bound else math.nan, size=off, bound=bound)


def first_passage(trace: Trace, tilt: float) -> float:
    """First time at which a trace reaches this tilt [s]; inf if never."""
    time = trace.time.copy()
    before = int(np.argmax(trace.tilt > tilt)) - 1
    if before >= 0 and trace.tilt[before] == 0.0:
        # growth from rest begins at the uplift, not at the sample before it
        time[before] = max(time[before], trace.uplift_time)
    return exceeds(time, trace.tilt, tilt, 3.0)


class ExternalSummaryRow(Protocol):
    """Row of the summary of an external trajectory: the columns that explain its differences."""

    likely_mistake: Sequence[str]
    likely_mistake_in: Sequence[str]
    likely_mistake_value: Sequence[float]


def mistakes_of(row: ExternalSummaryRow) -> tuple[Mistake, ...]:
    """Likely mistakes of a verdict."""
    columns = zip(row.likely_mistake, row.likely_mistake_in, row.likely_mistake_value, strict=True)
    return tuple(Mistake(code=code, concerns=part, value=value) for code, part, value in columns)


def lists_in_words(verdicts: pd.DataFrame) -> pd.DataFrame:
    """Verdicts with lists as texts, for a CSV file or a page: "azimuth; path"."""
    return verdicts.assign(**{name: verdicts[name].map(_join) for name in LISTS})


def _join(cell: Sequence[str | float]) -> str:
    return "; ".join(
        each if isinstance(each, str) else f"{each:.6g}" if math.isfinite(each) else "" for each in cell
    )


def lists_of_file(verdicts: pd.DataFrame) -> pd.DataFrame:
    """Verdicts from a file, with their lists as tuples again."""

    def with_nan(cell: Sequence[str | float | None]) -> tuple[str | float, ...]:
        return tuple(math.nan if each is None else each for each in cell)

    return verdicts.assign(**{name: verdicts[name].map(with_nan) for name in LISTS})
