"""Fragility, spectrum, sweep and ensemble with a tendon: their runs, and their levels above its uplift."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

import rockwobble as rw
from rockwobble import multibody, reduced
from rockwobble.compare.metrics.pair import balance_of, beyond_yield, outcome_of
from rockwobble.models import synthetic_motions
from rockwobble.studies.fragility.runs import default_levels
from rockwobble.studies.fragility.tables import exceedance
from rockwobble.studies.plans import FragilityPlan

PIER = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
TENDON = rw.Tendon(prestress=0.5, stiffness=2.0)
STEEL = {"tendon_prestress": TENDON.prestress, "tendon_stiffness": TENDON.stiffness}
MOTIONS = synthetic_motions(4, peak=1.0, seed=3)


@pytest.mark.slow
@pytest.mark.parametrize("slab", [0.0, 1.0])
def test_fragility_includes_the_tendon_and_skips_flat_ground(slab: float) -> None:
    body = rw.WobblingFrame(PIER, slab) if slab else PIER
    fragility = rw.fragility({"it": body}, MOTIONS, levels=[3.0, 9.0], resamples=50, workers=1, **STEEL)
    assert "flat-ground model" not in fragility.facts["methods"]
    runs = fragility.runs[fragility.runs["method"] == "recess model"].set_index(["motion", "step"])
    for motion in MOTIONS:
        scale = 9.0 * 9.81 * PIER.tan_alpha / motion.peak
        own = reduced.simulate(rw.Case(body, motion.scaled(scale), tendon=TENDON), rtol=1e-7)
        assert runs["peak_tilt"][motion.name, 1] == pytest.approx(own.peak_tilt / PIER.alpha, rel=1e-9)
    with pytest.raises(ValueError, match="got support 'flat'"):
        rw.fragility(PIER, MOTIONS, methods=["flat"], levels=[3.0], workers=1, **STEEL)


def test_levels_begin_above_the_raised_uplift_and_end_where_most_overturn() -> None:
    plain = default_levels({"it": PIER}, MOTIONS, FragilityPlan())
    held = default_levels({"it": PIER}, MOTIONS, FragilityPlan(**STEEL))
    assert held[0] / plain[0] == pytest.approx(TENDON.uplift_factor(PIER), rel=5e-3)  # three digits
    options = {"methods": ["recess"], "limits": ["overturned"], "resamples": 50, "workers": 1}
    shares = rw.fragility(PIER, MOTIONS, **options, **STEEL).counts.groupby("intensity")[["k", "n"]].sum()
    assert shares["k"].iloc[0] == 0
    assert shares["k"].iloc[-1] > 0.5 * shares["n"].iloc[-1]


@pytest.mark.slow
def test_a_spectrum_searches_from_the_raised_uplift() -> None:
    options = {"semidiagonals": [3.0], "intensities": [2.0, 6.0], "search_step": 0.2, "probes": 20}
    motion = rw.el_centro_1940()
    spectrum, plain = (rw.spectrum(0.2, motion, workers=1, **options, **steel) for steel in (STEEL, {}))
    lowest, other = (one.tables["lowest"].set_index("series")["intensity"]["3d"] for one in (spectrum, plain))
    assert lowest > other
    pier = rw.Cylinder(semidiagonal=3.0, tan_alpha=0.2)
    peak = float(np.hypot(*motion.acceleration[:, :2].T).max())
    case = rw.Case(pier, motion.scaled(lowest * 9.81 * 0.2 / peak), tendon=TENDON)
    assert reduced.simulate(case, rtol=1e-7).outcome == "overturned"


def test_sweep_and_ensemble_include_the_tendon() -> None:
    motion = rw.el_centro_1940()
    grid = rw.Grid(semidiagonals=[6.0], tan_alphas=[0.2], scales=[3.0], motions=[motion], **STEEL)
    case = rw.Case(PIER, motion.scaled(3.0), tendon=TENDON)
    peak = reduced.simulate(case, rtol=1e-7).peak_tilt
    assert rw.sweep(grid, workers=1).table["peak_tilt"][0] == peak
    members = rw.ensemble(case, runs=[], copies=3, workers=1)
    assert list(members.methods["method"]) == ["recess model"]


def test_balance_tilt_without_tendon_is_exactly_alpha() -> None:
    for tan_alpha, gravity in itertools.product(np.geomspace(0.02, 1.5, 40).tolist(), (1.62, 9.81)):
        pier = rw.Cylinder(semidiagonal=3.0, tan_alpha=tan_alpha)
        for body in (pier, rw.WobblingFrame(pier, 0.7)):
            case = rw.Case(body, initial=rw.InitialState(0.01), duration=1.0, gravity=gravity)
            assert balance_of(case) == body.alpha


@pytest.mark.slow
@pytest.mark.parametrize(("share", "duration", "outcome"), [(1.4, 0.3, "stands"), (1.7, 3.0, "overturned")])
def test_a_ring_run_righted_by_a_tendon_has_not_overturned(
    share: float, duration: float, outcome: str
) -> None:
    """The balance tilt is 1.63 alpha with the tendon: a wall holds bodies beyond it only."""
    initial, tendon = rw.InitialState(share * PIER.alpha), rw.Tendon(stiffness=2.0)
    case = rw.Case(PIER, initial=initial, duration=duration, tendon=tendon)
    trace = multibody.simulate(
        case, engine="mujoco", support="ring", time_step=1e-3, ring_clearance=0.01, ring_inclination=0.5
    )
    assert trace.outcome == "stands"
    assert trace.tilt[-1] > PIER.alpha
    assert outcome_of(trace) == outcome


@pytest.mark.slow
@pytest.mark.parametrize("force", [1.1, 0.8, 0.55])
def test_results_after_tendon_yield_are_unknown_in_studies(force: float) -> None:
    column = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    motions = rw.synthetic_motions(6, peak=3.0, seed=1, duration=8.0)
    steel = {"tendon_prestress": 0.5, "tendon_stiffness": 1.0}
    given = {"methods": ["recess"], "levels": [1.5, 4.0, 12.0], "resamples": 20, "workers": 1, **steel}
    elastic, yielding = (
        rw.fragility({"pier": column}, motions, **given, **more) for more in ({}, {"tendon_yield": force})
    )
    tied = rw.Tendon(prestress=0.5, stiffness=1.0, yield_force=force)
    case = rw.Case(column, duration=1.0, tendon=tied)
    lost = beyond_yield(elastic.runs["peak_tilt"] * column.alpha * (1.0 + 1e-12), case)
    assert lost.any() == (force < 1.1)  # 1.1 is beyond the balance
    assert (yielding.runs["outcome"] == "yielded").tolist() == lost.tolist()
    for limit, of in (("uplift", 0.0), ("0.1 alpha", 0.1), ("0.5 alpha", 0.5), ("overturned", math.inf)):
        known, before = (exceedance(each.runs, limit) for each in (yielding, elastic))
        unknown = lost & (of * column.alpha > tied.yield_tilt(column))
        assert np.isnan(known).tolist() == unknown.tolist()
        assert (known[~unknown] == before[~unknown]).all()
    grid = {"semidiagonals": [2.0, 5.0], "intensities": [2.0, 4.0, 6.0], "probes": 0, **steel}
    whole, part = (
        rw.spectrum(0.2, motions[0], **grid, **more).maps for more in ({}, {"tendon_yield": force})
    )
    for name, tilts in whole.peak_tilt.items():
        assert np.isnan(part.peak_tilt[name]).tolist() == beyond_yield(tilts, case).tolist()
