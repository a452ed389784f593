"""Advice on a sliding body: mode, displacement, and gap."""

from __future__ import annotations

import math

import pytest

import rockwobble as rw
from rockwobble import reduced

CASK = rw.Cylinder(semidiagonal=3.0, tan_alpha=0.5)
CASE = rw.Case(CASK, rw.el_centro_1940().scaled(2.5), duration=8.0, friction=0.3)


def test_sliding_advice_states_displacement_and_gap_exceedance() -> None:
    advice = rw.advise(CASE, copies=20, gap=0.1)
    first, slide, *others = advice.findings().of("mode")
    trace = reduced.simulate(CASE, support="flat")
    assert (advice.facts["support"], first.key, advice.grades) == ("flat", "mode.slides", {})
    peak, low, high = slide.values["displacement"]
    assert peak == trace.peak_displacement
    assert low < peak < high
    assert slide.values["displacement_end"][0] == trace.residual_displacement
    shares = [each.values["share"][0] for each in others if each.key == "mode.gap"]
    rows = advice.tables["slides"].groupby("group", sort=False)["displacement"]
    assert shares == [(moved > 0.1).mean() for _, moved in rows]
    assert not len(advice.groups)
    assert not advice.findings().of("use")  # no statement on the rolling flat-ground model
    assert advice.headline()["residual displacement as given [m]"] == trace.residual_displacement


@pytest.mark.slow
def test_recess_walls_carry_the_shear_beyond_friction() -> None:
    advice = rw.advise(CASE, copies=20, support="recess")
    first, walls = advice.findings().of("mode")
    assert (first.key, walls.key) == ("mode.rocks", "mode.walls")
    assert walls.values["force"] == pytest.approx(0.5 - 0.3)  # until it uplifts
    with pytest.raises(ValueError, match="gap"):
        rw.advise(CASE, copies=20, support="recess", gap=0.1)


@pytest.mark.slow
def test_friction_near_sliding_limit_and_unknown_friction_are_reported() -> None:
    near = rw.Case(CASK, CASE.motion, duration=8.0, friction=0.46)
    assert [each.key for each in rw.advise(near, copies=20).findings().of("mode")][1] == "mode.border"
    both = rw.Case(CASK, CASE.motion, duration=8.0, friction=0.52)
    keys = [
        (each.key, each.level) for each in rw.advise(both, copies=20, support="flat").findings().of("mode")
    ]
    assert keys == [("mode.rocks_and_slides", "note"), ("mode.no_engine", "not tested")]
    unknown = rw.advise(rw.Case(CASK, CASE.motion, duration=3.0), copies=20, friction_given=False)
    assert unknown.findings().of("mode")[-1].key == "mode.no_friction_given"
    assert unknown.findings().of("mode")[-1].values["bound"] == 0.5
    assert math.isnan(unknown.findings().of("mode")[0].values["given"])


def test_spectrum_states_the_mode_first_and_refuses_pure_sliding() -> None:
    grid = {"semidiagonals": [3.0], "intensities": [2.0], "search_step": 1.0, "probes": 0, "support": "flat"}
    both = rw.spectrum(0.5, CASE.motion, friction=0.52, **grid)
    assert [each.key for each in both.findings()][:2] == ["mode.rocks_and_slides", "mode.no_engine"]
    with pytest.raises(ValueError, match="slides alike"):
        rw.spectrum(0.5, CASE.motion, friction=0.3, **grid)


def test_fragility_counts_displacements_beyond_the_gap() -> None:
    motions = rw.synthetic_motions(6, peak=3.0, seed=1)
    options = {"friction": 0.2, "gap": 0.05, "measure": "pga", "resamples": 20, "workers": 1}
    fragility = rw.fragility(CASK, motions, methods=["recess", "flat"], levels=[0.3, 0.6], **options)
    alone = rw.fragility(CASK, motions, levels=[0.3, 0.6], limits=["slides"], **options)
    assert {*alone.runs["method"]} == {"flat-ground model"}
    flat = fragility.runs[fragility.runs["method"] == "flat-ground model"].set_index(["motion", "step"])
    assert (flat["peak_tilt"] == 0.0).all()
    for motion in motions:
        of_motion = fragility.points["motion"] == motion.name
        for step, row in fragility.points[of_motion].set_index("step").iterrows():
            moved = reduced.peak_displacements([0.2], motion, [row["scale"]])[0, 0]
            assert flat.loc[(motion.name, step), "slides"] == float(moved > 0.05)
    counts = fragility.counts[
        (fragility.counts["limit"] == "slides") & (fragility.counts["method"] == "flat-ground model")
    ]
    assert list(counts["k"]) == [int(flat["slides"].xs(step, level="step").sum()) for step in (0, 1)]
    assert 0 < counts["k"].sum() < 12
    curve = rw.HazardCurve([0.1, 0.3, 1.0], [1e-2, 1e-3, 1e-4], measure="pga")
    rows = fragility.risk(curve, limit="slides").set_index("method")
    assert rows.loc["flat-ground model", "annual_frequency"] > 0.0
    with pytest.raises(ValueError, match="gap"):
        rw.fragility(CASK, motions, limits=["slides"])
