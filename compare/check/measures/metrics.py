"""Layer metrics: the metrics of a comparison, on traces that are made up so that their values are known.

Expected values are integrals and counts done by hand: the sum of many samples of a sine is known, and a
ramp crosses 1 % of alpha where it is drawn to.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from rockwobble.models import Case, Diagnostic, GroundMotion, Trace

from ...comparison.prediction import Prediction
from ...comparison.summary import SUMMARY_COLUMNS, lost_row, summary_row
from ...external.verdict import numbers_of
from ...metrics.agreement import Agreement, agreed_passes, agreement_time, closest_pass
from ...metrics.contact import contact_rms
from ...metrics.energy import energy_loss
from ...metrics.pair import Pair, make_pair
from ...metrics.tilt import tilt_rms, tilt_rms_relative
from ...metrics.turning import direction_difference, first_unresolved_pass, turn_difference
from ..bench import Array, Bench
from ..finding import Bound, Finding, worst_of
from ..problems import PIER
from .made_traces import made, passes

ALPHA, B = PIER.alpha, PIER.base_radius
TIME: Array = 0.01 * np.arange(1001, dtype=np.float64)
LEAN: Array = np.full(len(TIME), 0.1)
ROUNDING = Bound(1e-12, "made up so that each value is known; rounding")
ROW = "columns of the summary (compare/comparison/summary.py)"
# the slope of the velocity within a sample comes from its neighbours; 3e-9 was measured
WORK = Bound(1e-7, "made up so that each value is known; samples 0.01 s apart")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    del bench
    for name, errors, part in (
        ("differences of tilt", _tilts(), "RMS of the tilt (compare/metrics/tilt.py)"),
        ("one time axis for two traces", _axes(), "interpolation or window (compare/traces/pair.py)"),
        ("distance of the contact points", _contacts(), "contact RMS (compare/metrics/contact.py)"),
        ("differences of turn and direction", _turns(), "turning (compare/metrics/turning.py)"),
        ("agreement time and passes", _agreement(), "agreement time (compare/metrics/agreement.py)"),
        ("a row of the summary", _row(), ROW),
        ("rows of runs that end early", _early_rows(), ROW),
    ):
        yield worst_of(name, errors, ROUNDING, part)
    yield worst_of("energy lost", _energies(), WORK, "energy lost (compare/metrics/energy.py)")


def _pair(reference: Trace, trial: Trace, until: float | None = None) -> Pair:
    return make_pair(PIER, reference, trial, until=until)


def _tilts() -> dict[str, float]:
    wave = np.sin(2.0 * math.pi * TIME[:-1])  # ten whole periods
    reference = made(TIME[:-1], 0.5 * ALPHA + 0.2 * ALPHA * wave)
    trial = made(TIME[:-1], 0.5 * ALPHA + 0.23 * ALPHA * wave - 0.02 * ALPHA)
    pair = _pair(reference, trial)
    rms = math.sqrt(0.03**2 / 2.0 + 0.02**2)
    scale = math.sqrt(0.5**2 + 0.2**2 / 2.0)
    return {
        "RMS": tilt_rms(pair) - rms,
        "relative RMS": tilt_rms_relative(pair) - rms / scale,
        "sign of the difference": pair.tilt_difference[0] + 0.02,
        "RMS of what never tilts": _none(tilt_rms_relative(_pair(made(TIME, 0.0 * TIME), trial))),
    }


def _axes() -> dict[str, float]:
    """A trial on a coarser grid that begins later on it, a window, and a trace that breaks off."""
    reference = made(TIME, 0.3 * ALPHA * (1.0 + 0.1 * TIME), uplift_time=1.25)
    own = np.append(0.04 * np.arange(200), 8.013)
    trial = made(
        own,
        0.3 * ALPHA * (1.0 + 0.1 * own),
        contact_point=np.column_stack([own, -2.0 * own]),
        rolling_angle=3.0 * own,
    )
    pair, window = _pair(reference, trial), _pair(reference, trial, until=2.0)
    tilts = reference.tilt.copy()
    tilts[300:] = math.nan
    broken = _pair(reference, made(TIME, tilts))
    whole = _pair(reference, made(TIME + 1e-11, reference.tilt))
    return {
        "interpolated tilt": float(np.abs(pair.tilt_difference).max()),
        "interpolated contact": float(np.abs(pair.contact_point - np.outer(pair.time, [1.0, -2.0])).max()),
        "interpolated angle": float(np.abs(pair.rolling_angle - 3.0 * pair.time).max()),
        "end of the shorter": pair.end - 8.01,
        "end of the window": window.end - 2.0,
        "samples of the window": len(window.time) - 201.0,
        "start": pair.start - 1.25,
        "end before a tilt that is no number": broken.end - 2.99,
        "times that differ by rounding": len(whole.time) - 1001.0,
    }


def _contacts() -> dict[str, float]:
    """Half of the samples tilt by less than 5 % of the peak, and do not count."""
    low = np.arange(len(TIME)) % 2 == 1
    tilt = np.where(low, 0.04, 1.0) * 0.5 * ALPHA
    at = np.column_stack([np.cos(TIME), np.sin(TIME)]) * B
    off = np.where(low[:, None], [[3.0, 3.0]], [[0.03, -0.04]]) * B
    gap = at.copy()
    gap[::4] = math.nan
    references = {
        "RMS": made(TIME, tilt, contact_point=at),
        "RMS where one of two tilts": made(TIME, tilt + 0.01, contact_point=at),
        "RMS with a reference that rests now and then": made(TIME, tilt, contact_point=gap),
    }
    trial = made(TIME, tilt, contact_point=at + off)
    return {name: contact_rms(_pair(one, trial)) - 0.05 for name, one in references.items()}


def _turns() -> dict[str, float]:
    one, fast, turned = _rolling(2.0, 0.3), _rolling(3.0, 0.3), _rolling(2.0, 0.5 + 4.0 * math.pi)
    across = (made(TIME, LEAN, uplift_direction=sign * (math.pi - 0.1)) for sign in (1.0, -1.0))
    pair, named_apart = _pair(one, fast), direction_difference(one, turned)
    engine = made(TIME, one.tilt, passes=passes([1.0, 2.5, 4.0], [0.1, 0.1, 0.1], [False, True, False]))
    return {
        "more than a turn": turn_difference(pair, until=10.0) - 10.0,
        "until the end of the agreement": turn_difference(pair, until=2.5) - 2.5,
        "a direction that is named two turns apart": turn_difference(
            _pair(one, turned), until=10.0, direction_difference=named_apart
        )
        - 0.2,
        "a direction that is unknown": turn_difference(pair, until=2.5, direction_difference=math.nan) - 2.5,
        "direction across the cut": direction_difference(*across) - 0.2,
        "first pass that is not resolved": first_unresolved_pass(engine) - 1.0,
        "the same after the uplift of the reference": first_unresolved_pass(engine, start=1.5) - 4.0,
        "no such pass": 0.0 if math.isinf(first_unresolved_pass(engine, start=4.5)) else math.nan,
    }


def _agreement() -> dict[str, float]:
    """The trial leaves the reference on a ramp that is at 1 % of alpha at 6.005 s; uplift was at 1 s."""
    table = passes([2.0, 5.0, 6.01, 6.02, 8.0], [0.03, 0.01, 0.02, 0.001, 0.002])
    reference = made(TIME, np.full(len(TIME), 0.4 * ALPHA), uplift_time=1.0, passes=table)
    ramp = np.maximum(0.0, TIME - 5.005)

    def parts(off: Array | float) -> Agreement:
        return agreement_time(_pair(reference, made(TIME, reference.tilt + off * ALPHA)))

    up, agreement, same, early = parts(0.01 * ramp), parts(-0.01 * ramp), parts(0.0099), parts(0.02)
    cut = _pair(reference, made(TIME[:501], reference.tilt[:501]))
    broken = agreement_time(cut, broken=True)
    return {
        "a ramp upwards": 0.0 if up == agreement and agreement.diverged else math.nan,
        "end of the agreement": agreement.end - TIME[601],
        "length from the uplift": agreement.length - 5.01,
        "passes within it": agreed_passes(reference, agreement) - 3.0,
        "closest of them": closest_pass(reference, agreement) - 0.01,
        "a difference just below 1 %": same.end - 10.0 + float(same.diverged),
        "end of a trace that failed": broken.length - 4.0 + (1.0 - float(broken.diverged)),
        "a difference from the start": early.length,
    }


def _energies() -> dict[str, float]:
    """Work of a known acceleration on a known path, in three components; and a loss that is put in."""
    # a = a0 + c t along each axis, r = sin(w t): the work of -a is -[a sin(w t) + c cos(w t)/w]
    start, rates, speeds = np.array([[0.0, -1.0, 0.5], [0.3, 0.2, -0.1], [1.1, 0.7, 1.9]])
    motion = GroundMotion(start + np.outer(2.0 * np.arange(6.0), rates), 2.0)
    place = np.sin(np.outer(TIME, speeds))
    ground = start + np.outer(TIME, rates)
    swept = ground * place + rates * np.cos(np.outer(TIME, speeds)) / speeds
    work = -(swept - swept[0]).sum(axis=1)
    energy = work - work.min() + 1.0
    lossy, even = energy - 0.02 * TIME, np.ones(len(TIME))
    late = np.maximum(0.0, TIME - 4.0)[:, None] ** 3 * [0.01, 0.0, 0.0]

    def lost(energy: Array, place: Array, motion: GroundMotion | None) -> float:
        return energy_loss(made(TIME, LEAN, energy=energy, centre_of_mass=place), motion)

    still = 0.0 * place
    return {
        "none": lost(energy, place, motion),
        "some": lost(lossy, place, motion) - 0.2 / float(lossy.max()),
        "over still ground": lost(2.0 - 0.05 * TIME, still, None) - 0.25,
        "of what never moves": lost(0.0 * even, still, None),
        "after the end of the record": lost(even, late, GroundMotion([[1.0, 0.0], [1.0, 0.0]], 4.0)),
    }


def _row() -> dict[str, float]:
    """What the columns of a summary must be where two rolling cylinders differ in everything."""
    case = Case(PIER, duration=10.0, name="made")
    reference = _rolling(2.0, 0.3, peak_tilt=0.7 * ALPHA, wall_time=0.5, uplift_time=1.0)
    trial = _rolling(
        2.0,
        0.5,
        peak_tilt=0.6 * ALPHA,
        uplift_time=1.02,
        residual_displacement=0.3 * B,
        twist=np.full(len(TIME), -7.0),
        contact_resolution=1e-4,
    )
    expectation = Prediction(length=8.0, reason="pass")
    row = summary_row(case, "recess model", reference, "made", trial, prediction=expectation)
    found = numbers_of(row)
    expected: Mapping[str, float] = {
        "peak_tilt": 0.6,
        "reference_peak_tilt": 0.7,
        "peak_tilt_difference": -0.1,
        "tilt_rms": 0.0,
        "contact_rms": 2.0 * math.sin(0.1),
        "turn_difference": math.degrees(0.2),
        "uplift_time_difference": 0.02,
        "uplift_direction_difference": 0.2,
        "agreement_time": 10.0,
        "residual_displacement": 0.3,
        "residual_twist": math.degrees(-7.0),
        "energy_loss": 0.0,
        "time_ratio": 2.0,
        "predicted_agreement_time": 8.0,
        "contact_resolution": 1e-4,
    }
    return {name: found[name] - value for name, value in expected.items()}


def _early_rows() -> dict[str, float]:
    """Of a run that left no samples, and of one that leaves the model after it touched a wall, or before."""
    case, expected = Case(PIER, duration=10.0, name="made"), Prediction(length=8.0, reason="pass")
    reference = made(TIME, np.full(len(TIME), 0.4 * ALPHA), wall_time=0.5)
    lost = lost_row(case, "recess model", reference, "made", made(TIME[:1], LEAN[:1], outcome="failed"))
    known = {"diverged": 1.0, "agreement_time": 0.0, "agreed_passes": 0.0, "reference_peak_tilt": 0.4}
    found = numbers_of(lost)
    off = {f"lost: {name}": found[name] - value for name, value in known.items()}
    off["lost: columns"] = float(len({*SUMMARY_COLUMNS} ^ {*lost}))
    off |= {f"lost: {name}": _none(found[name]) for name in ("peak_tilt", "tilt_rms", "wall_time")}
    for when, said in ((1.0, "after it touched a wall"), (4.0, "earlier")):
        touch = Diagnostic(code="wall_contact", time=when, duration=0.1, size=1.0)
        tilt = reference.tilt + 0.1 * ALPHA * (TIME > 2.0)
        trial = made(TIME, tilt, facts=(touch,), rolling_angle=5.0 * (TIME > 2.5))
        row = summary_row(case, "recess model", reference, "made", trial, prediction=expected)
        off[f"left {said}"] = float(row["divergence"] != said)
        off[f"turned since it left {said}"] = numbers_of(row)["turn_difference"]
    return off


def _rolling(rate: float, start: float, **fields: Any) -> Trace:
    """A cylinder that leans by 0.3 alpha and rolls on at `rate` [rad/s] from the azimuth `start` [rad]."""
    angle = start + rate * TIME
    return made(
        TIME,
        np.full(len(TIME), 0.3 * ALPHA),
        rolling_angle=angle,
        contact_point=B * np.column_stack([np.cos(angle), np.sin(angle)]),
        **{"uplift_direction": start, **fields},
    )


def _none(value: float) -> float:
    return 0.0 if math.isnan(value) else math.inf
