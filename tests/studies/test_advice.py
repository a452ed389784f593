"""What an advice rests on: members, scales, trust, and the grades at their thresholds."""

from __future__ import annotations

import dataclasses
import math
import os
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
import scheduled
from showing import loads_as_it_was, shows_itself

from rockwobble import reduced
from rockwobble.compare.comparison.driver import comparison
from rockwobble.compare.metrics.contrast import Pairs
from rockwobble.compare.metrics.pair import overturned
from rockwobble.compare.runs import execution
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import (
    CLOSED_TILT,
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    Run,
    Tendon,
    WobblingFrame,
    el_centro_1940,
    synthetic_motions,
)
from rockwobble.studies.advice import advice as study
from rockwobble.studies.advice.advice import Advice, advice_of, advise, vertical_effect
from rockwobble.studies.advice.demands import (
    PASSED,
    ROUNDING,
    SPIKES,
    demand_table,
    demands_of,
    weaker_factors,
)
from rockwobble.studies.advice.grades import (
    BETWEEN_SCALES,
    BROKEN,
    NEAR,
    SENSITIVE,
    UNSAFE,
    grade_chance,
    graded,
    overall,
)
from rockwobble.studies.advice.members import (
    other_records,
    peak_velocity,
    ratios_of,
    top_displacement,
    with_vertical,
)
from rockwobble.studies.advice.scales import (
    AS_STRONG,
    FACTORS,
    planar_runs,
    planar_shares,
    scan_as_strong,
    scan_scales,
)
from rockwobble.studies.advice.trust import trust_of, verify_run
from rockwobble.studies.plans import AdvicePlan, SpectrumPlan
from rockwobble.studies.single_run import single_run
from rockwobble.studies.spectrum.maps import tilt_maps
from rockwobble.studies.spectrum.parts import intensity_unit, uplift_factor

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RECESS = Run(None, "recess")
SAME_RUN = 1e-9  # relative difference of two runs that differ after their end only
COUNTED = 1e-6  # a growth that rounding moves, against uplifts a second apart
SHORT = GroundMotion(el_centro_1940().acceleration[:1000], 0.01, "short")


def case(scale: float = 1.0, **fields) -> Case:
    return Case(PIER, el_centro_1940().scaled(scale), name="El Centro", **fields)


def with_table(advice: Advice, **tables: pd.DataFrame) -> Advice:
    return advice_of({**advice.tables, **tables}, advice.facts)


@pytest.fixture(scope="module", autouse=True)
def few_records() -> Iterator[None]:
    """Six other records in each advice: all 22 take most of its time; another test counts them."""

    def few(case: Case) -> tuple[dict[str, list[Case]], str]:
        records, source = other_records(case)
        return {name: cases[:6] for name, cases in records.items()}, source

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "other_records", few)
        yield


@pytest.fixture
def no_records(few_records: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """No other records, for tests of the given record only."""
    monkeypatch.setattr(study, "other_records", lambda _: ({}, ""))


@pytest.fixture(scope="module")
def advice(few_records: None) -> Advice:
    return advise(Case(PIER, SHORT), copies=20)


@pytest.mark.slow
def test_demands_from_samples_match_the_continuous_solution():
    trace = reduced.simulate(Case(PIER, el_centro_1940(), friction=0.15), sample_step=1e-4)
    sampled, demands = demands_of(trace), trace.assumptions
    slip = next(breach for breach in demands.breaches if breach.code == "friction_needed")
    moving = trace.open_base.sum() * 1e-4
    assert sampled["slip"] == pytest.approx(slip.duration / moving, rel=1e-3)
    assert 0.1 < sampled["friction"] < demands.largest_friction_needed
    assert 0.0 < sampled["moment"] < 2.0 * demands.largest_restraining_moment / PIER.base_radius
    assert 1.0 < sampled["force"] < demands.largest_normal_force
    shear = np.hypot(*trace.contact_force[trace.open_base, :2].T)
    assert np.mean(shear <= sampled["shear"]) == pytest.approx(1.0 - SPIKES, abs=1e-4)  # a sample
    assert sampled["lost"] == 0.0
    still = demands_of(reduced.simulate(case(0.5)))
    weight = {"force", "force_peak", "shear_with_force", "moment_with_force"}  # acts where nothing else does
    assert {name: value for name, value in still.items() if value} == dict.fromkeys(weight, 1.0)


def test_demands_exclude_the_fall():
    trace = reduced.simulate(case(4.0))
    assert trace.outcome == "overturned"
    assert math.isinf(trace.assumptions.largest_friction_needed)
    assert demands_of(trace)["friction"] < 0.5


def test_other_records_are_scaled_to_equal_peak_acceleration_or_velocity():
    records, source = other_records(case())
    assert source in ("p695", "synthetic")
    own = el_centro_1940()
    assert [len(cases) for cases in records.values()] == [22, 22]
    for each in records["acceleration"]:
        assert each.motion.peak == pytest.approx(own.peak, rel=1e-12)
    for each in records["velocity"]:
        assert peak_velocity(each.motion) == pytest.approx(peak_velocity(own), rel=1e-12)
    time = np.arange(2000) * 0.001
    wave = GroundMotion(np.column_stack([np.cos(2.0 * math.pi * time), 0.0 * time]), 0.001)
    assert peak_velocity(wave) == pytest.approx(0.5 / math.pi, rel=1e-3)
    assert other_records(Case(PIER, initial=InitialState(0.1), duration=1.0)) == ({}, "")


@pytest.mark.slow
def test_group_table_counts_overturned_members_and_excludes_failed_ones(advice):
    members = advice.members.copy()
    copies = members.index[members["group"] == "copies"]
    members.loc[copies[:2], "outcome"] = "overturned"
    members.loc[copies[2], "outcome"] = "failed"
    group = with_table(advice, members=members).groups.set_index("group").loc["copies"]
    assert (group["runs"], group["failed"], group["overturned"]) == (20, 1, 2)
    assert group["chance"] == 2 / 19
    assert group["chance_low"] < 2 / 19 < group["chance_high"]
    assert group["peak_tilt_95"] == math.inf  # 2 of 19 are more than 5 %
    assert group["covered"] == 19  # ceil(0.95 19)
    stands = members.loc[copies[3:], "peak_tilt"]
    assert stands.min() <= group["peak_tilt_50"] <= stands.max()


@pytest.mark.parametrize(
    ("methods", "data", "peak", "expected"),
    [
        (math.inf, math.inf, 5.0, ("trace", 10.0, "")),
        (10.0, 12.0, 5.0, ("trace", 10.0, "")),
        (8.0, 9.0, 8.0, ("peak", 8.0, "methods")),
        (9.0, 8.0, 8.01, ("statistics", 8.0, "data")),
    ],
)
def test_trust_depends_on_divergence_before_the_largest_tilt(methods, data, peak, expected):
    trust = trust_of(methods, data, peak, 10.0)
    assert (trust.kind, trust.until, trust.because) == expected


ENGINE = {"label": "mujoco recess", "version": "4.0.0", "time_step": 1e-4, "outcome": "stands", "moves": True}
ENGINE |= {"diagnostics": "", "peak_tilt": 0.25, "agreed_until": 5.0, "diverged": True, "divergence": "later"}
TENDON = {"yield_force": 1.0, "prestress": 0.5}
FALLS = 0.5 * math.pi


@pytest.mark.parametrize(
    ("columns", "facts", "key", "level"),
    [
        ({}, {}, "overturning.none_but", "satisfied"),
        ({"lowest": {"factor": NEAR * 0.99}}, {}, "overturning.scale", "caution"),
        ({"groups": {"chance": UNSAFE}}, {}, "overturning.group", "caution"),
        ({"groups": {"chance": UNSAFE * 1.01}}, {}, "overturning.group", "not satisfied"),
        ({"lowest": {"factor": math.nan}}, {}, "overturning.none_up_to", "satisfied"),
        ({"scales": {"yields": True}}, {}, "overturning.yields_at", "not tested"),
        ({"groups": {"yielded": 1}}, {}, "overturning.yielded", "not tested"),
        ({}, {"friction": None}, "friction.not_given", "caution"),
        ({}, {"friction": 0.19}, "friction.below_border", "not satisfied"),
        ({"groups": {"slip_95": BROKEN}}, {"friction": 0.3}, "friction.too_little", "caution"),
        ({"groups": {"slip_95": BROKEN * 1.01}}, {"friction": 0.3}, "friction.too_little", "not satisfied"),
        ({"groups": {"slip_95": 0.0}}, {"friction": 0.3}, "friction.enough", "satisfied"),
        ({"groups": {"single": True}}, {"friction": 3.0}, "friction.few", "not tested"),
        ({"groups": {"lost_95": BROKEN * 1.01}}, {}, "contact.lost", "not satisfied"),
        ({"groups": {"yielded": 1}}, {}, "contact.yielded", "not tested"),
        ({}, {"trust": ("statistics", "data")}, "trace.statistics", "caution"),
        ({}, {"trust": ("peak", "methods")}, "trace.peak", "satisfied"),
        ({}, {"trust": ("trace", "")}, "trace.whole", "satisfied"),
        ({}, {"tendon": TENDON, "tension": 1.01}, "tendon.above", "not satisfied"),
        ({}, {"tendon": TENDON, "tension": 0.99}, "tendon.below", "satisfied"),
        ({}, {"tendon": TENDON | {"yield_force": None}, "tension": 1.0}, "tendon.no_yield_force", "caution"),
        ({"as_strong": {"peak_tilt": 0.99 * SENSITIVE / BETWEEN_SCALES}}, {}, "intensity.ratio", "satisfied"),
        ({"as_strong": {"peak_tilt": SENSITIVE}}, {}, "intensity.ratio", "caution"),
        ({"as_strong": {"peak_tilt": 0.0}}, {}, "intensity.hardly", "caution"),
        ({"as_strong": {"peak_tilt": math.inf}}, {}, "intensity.overturns", "caution"),
        ({"as_strong": {"yields": True}}, {}, "intensity.yields_at", "not tested"),
        ({}, {}, "engine.not_run", "not tested"),
        ({}, {"verification": {}}, "engine.agrees", "satisfied"),
        ({}, {"verification": {"divergence": "earlier", "moves": False}}, "engine.earlier", "not satisfied"),
        ({}, {"verification": {"moves": False}}, "engine.rests", "caution"),
        ({}, {"verification": {"outcome": "overturned"}}, "engine.overturns", "caution"),
        ({}, {"verification": {"divergence": "much later"}}, "engine.untested", "not tested"),
        ({}, {"verification": {"divergence": "too little motion"}}, "engine.little", "not tested"),
        ({}, {"verification": {"outcome": "failed"}}, "engine.failed", "not tested"),
    ],
)
def test_the_first_criterion_that_holds_gives_reason_and_grade(advice, columns, facts, key, level):
    """An advice without overturning, its peak tilt equal to that of equally strong shaking."""
    plain: dict[str, dict[str, Any]] = {"groups": {"chance": 0.0}, "lowest": {"factor": NEAR}}
    plain["as_strong"] = {"peak_tilt": 1.0}
    columns = {name: plain.get(name, {}) | columns.get(name, {}) for name in (*plain, *columns)}
    columns["as_strong"]["peak_tilt"] = min(
        columns["as_strong"]["peak_tilt"] * advice.peak * PIER.alpha, FALLS
    )
    tables = {name: advice.tables[name].assign(**values) for name, values in columns.items()}
    stated = {**advice.facts, **facts}
    if "trust" in facts:
        stated["trust"] = dict(zip(("kind", "because", "until"), (*facts["trust"], 3.0), strict=True))
    if "verification" in facts:
        stated["verification"] = ENGINE | facts["verification"]
    if "tension" in facts:
        stated["response"] = advice.response | {"tension": facts["tension"]}
    table = dataclasses.replace(advice, tables={**advice.tables, **tables}, facts=stated)
    finding = next(each for each in graded(table) if each.key.split(".")[0] == key.split(".")[0])
    assert (finding.key, finding.level) == (key, level)
    assert table.grades[key.split(".")[0]] == level


def test_overall_grade_is_the_worst_and_untested_topics_do_not_improve_it():
    assert overall(["satisfied", "not satisfied", "caution", "not tested"]) == "not satisfied"
    assert overall(["not tested", "caution"]) == "caution"
    assert overall(["satisfied", "not tested"]) == overall([]) == "not tested"
    # a failed group does not hide others
    assert overall(map(grade_chance, [math.nan, 0.5])) == "not satisfied"


def test_scale_scan_equals_single_runs():
    table, lowest = scan_scales(Case(PIER, SHORT))
    peaks = {name: rows["peak_tilt"].to_numpy() for name, rows in table.groupby("series")}
    here = int(np.abs(FACTORS - 1.0).argmin())
    assert peaks["3d"][here] == reduced.simulate(Case(PIER, SHORT)).peak_tilt
    assert peaks["planar_y"][here] == reduced.simulate(Case(PIER, SHORT), plane=0.5 * math.pi).peak_tilt
    for series, options in (("3d", {}), ("planar_x", {"plane": 0.0})):
        factor = lowest.set_index("series")["factor"][series]
        assert reduced.simulate(Case(PIER, SHORT.scaled(factor)), **options).outcome == "overturned"
        assert factor <= FACTORS[overturned(peaks[series]).argmax()]
    still = scan_scales(Case(PIER, GroundMotion(np.zeros((9, 2)), 0.1)))
    assert [len(each) for each in still] == [0, 0]


def test_lowest_overturning_scale_of_a_release_is_searched_from_still_ground():
    motion = GroundMotion(SHORT.acceleration[:300], 0.01)
    _, lowest = scan_scales(Case(PIER, motion, initial=InitialState(tilt=0.9 * PIER.alpha)))
    assert lowest.drop(columns="factor").to_dict("records") == [
        {"series": "3d", "confirmed": True, "start": 0.0}
    ]
    _, gone = scan_scales(Case(PIER, motion, initial=InitialState(tilt=1.05 * PIER.alpha)))
    assert gone["factor"].tolist() == [0.0]


def test_advice_and_spectrum_uplift_at_the_same_factor(advice):
    spectrum = tilt_maps(
        0.2, SHORT, SpectrumPlan(semidiagonals=[6.0], intensities=[1.0, 2.0], search_step=1.0, probes=0)
    )
    unit = intensity_unit(0.2, SHORT, 9.81)
    for row in advice.lowest.itertuples():
        assert row.start == pytest.approx(unit * spectrum.searched_from[row.series], rel=1e-12)


def test_planar_shares_count_records_that_move():
    fall = 0.5 * math.pi
    rows = [("a", 0.2, 0.1, 0.1), ("b", fall, 0.3, 0.0), ("c", 0.1, fall, 0.0), ("d", 0.0, 0.0, 0.0)]
    table = pd.DataFrame(rows, columns=["member", "3d", "planar_x", "planar_y"]).assign(scale=1.0)
    (row,) = planar_shares(table)
    assert (row["moving"], row["larger"], row["unconservative"]) == (3, 2, 1)
    assert row["larger_share"] == 2 / 3
    assert row["larger_low"] < 2 / 3 < row["larger_high"]
    real = planar_runs([Case(PIER, SHORT)])
    single = reduced.simulate(Case(PIER, SHORT), rtol=1e-8)
    assert real.loc[real["scale"] == 1.0, "3d"].item() == pytest.approx(single.peak_tilt, rel=SAME_RUN)


def acts_within_its_rows(demands: pd.DataFrame) -> None:
    """Simultaneous actions lie below the demands of their table, and near the demand they belong to."""
    rows = demands.set_index("demand")
    limits = rows["value"].dropna()
    for name in ("shear", "moment"):
        if name not in limits:
            continue
        acting = {part: rows[f"with_{part}"][name] for part in ("shear", "force", "moment")}
        assert acting["force"] > 0.0
        acting["friction"] = acting["shear"] / acting["force"]
        acting["shear_and_wall"] = acting["shear"] + acting["moment"]
        for part in limits.index.intersection([*acting]):
            assert acting[part] <= limits[part] * (1.0 + ROUNDING), (name, part)


def loads_of(*rows: tuple[float, float, float]) -> pd.DataFrame:
    """Members of copies: a shear, with simultaneous force and moment."""
    return pd.DataFrame(
        {
            "group": "copies",
            "factor": 1.0,
            "outcome": "stands",
            "peak_tilt": 0.1 + 0.01 * place,
            "yields": False,
            **{
                "shear_peak": 2.0 * shear,
                "force_peak": 1.5,
                "friction": 0.2,
                "shear": shear,
                "force": 1.2,
                "moment": 0.01,
                "tilt": 0.1,
            },
            "shear_and_wall": shear + 0.005,
            **{"shear_with_shear": shear, "shear_with_force": force, "shear_with_moment": moment},
            **{"moment_with_shear": 0.5 * shear, "moment_with_force": 1.0, "moment_with_moment": 0.01},
        }
        for place, (shear, force, moment) in enumerate(rows)
    )


@pytest.mark.parametrize(
    "beyond",
    [(0.119, 1.9, 0.005), (0.119, 1.1, 0.05), (0.119, 0.1, 0.005), (0.119, -1.0, 0.005)],
    ids=["force", "moment", "friction", "contact lost"],
)
@pytest.mark.parametrize("support", ["recess", "flat"])
def test_simultaneous_forces_are_within_the_demands(beyond, support):
    usual = [(0.1 + 0.001 * place, 1.1, 0.005) for place in range(20)]
    members = loads_of(*usual[:18], beyond, (0.3, 1.1, 0.005))
    demands = demand_table(members, PIER, gravity=9.81, support=support)
    acts_within_its_rows(demands)
    shear = demands.set_index("demand").loc["shear"]
    assert (shear["value"], shear["covered"]) == (0.119, 19)  # independent of simultaneous actions
    held = beyond == (0.119, 1.1, 0.05) and support == "flat"  # on flat ground a moment has no limit
    expected = beyond if held else (0.117, 1.1, 0.005)
    assert tuple(shear[[f"with_{part}" for part in ("shear", "force", "moment")]]) == expected


def test_simultaneous_forces_are_near_the_demands_of_a_run():
    demands = demands_of(simulate_run(case(2.0), RECESS, sample_step=0.005))
    for name in ("shear", "moment"):
        acting = {part: demands[f"{name}_with_{part}"] for part in ("shear", "force", "moment")}
        assert 0.9 * demands[name] <= acting[name] <= demands[name]
        assert all(value <= demands[part] for part, value in acting.items())
        assert acting["shear"] / acting["force"] <= demands["friction"] * (1.0 + ROUNDING)


def test_demand_is_the_maximum_over_groups_and_weaker_shaking(advice):
    demands = advice.demands.set_index("demand")
    rows = pd.concat([advice.members[advice.members["group"] != "other support"], advice.weaker])
    sets = [(key, group) for key, group in rows.groupby(["group", "factor"]) if len(group) >= 6]
    for name in ("friction", "shear", "force", "moment", "shear_and_wall", "tilt"):
        ranked = {key: np.sort(group[name])[math.ceil(0.95 * len(group)) - 1] for key, group in sets}
        assert demands["value"][name] == max(ranked.values())
        assert ranked[demands["group"][name], demands["factor"][name]] == demands["value"][name]
    assert (demands["peak"][["shear", "force"]] > demands["value"][["shear", "force"]]).all()
    b = PIER.base_radius
    assert demands["per_tonne"]["moment"] == pytest.approx(9.81 * b * demands["value"]["moment"])  # [kNm]
    # walls are sized for standing cylinders, up to the outermost point of the rim
    falls = any((group["outcome"] == "overturned").mean() > 0.05 for _, group in sets)
    assert (demands["value"][["wall_height", "clearance"]].isna() == falls).all()
    standing = demand_table(rows[rows["outcome"] == "stands"], PIER, gravity=9.81, support="recess")
    wall = standing.set_index("demand")["value"]
    theta = wall["tilt"] * PIER.alpha
    assert wall["wall_height"] == pytest.approx(0.5 * b * theta, rel=theta)
    assert wall["clearance"] == pytest.approx(0.5 * b * theta**2, rel=theta)
    # simultaneous actions are smaller than separate maxima
    assert demands["value"]["shear_and_wall"] <= demands["value"]["shear"] + demands["value"]["moment"]
    acts_within_its_rows(advice.demands)
    flat = demand_table(rows, PIER, gravity=9.81, support="flat")
    acts_within_its_rows(flat)
    assert list(flat["demand"]) == ["friction", "shear", "force"]
    assert not len(demand_table(rows[:0], PIER, gravity=9.81, support="recess"))


PULSE = synthetic_motions(1, peak=4.0, seed=3, duration=8.0)[0]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "motion"), [(PIER, PULSE), (WobblingFrame(PIER, 0.5), SHORT)], ids=["alone", "deck"]
)
def test_demands_do_not_decrease_with_record_scale(body, motion, monkeypatch):
    """With all other records, as six scatter; values without part in demands are left out."""
    monkeypatch.setattr(study, "other_records", other_records)
    monkeypatch.setattr(study, "planar_runs", lambda *_: pd.DataFrame())
    nothing = scan_scales(Case(PIER, GroundMotion(np.zeros((9, 2)), 0.1)))
    monkeypatch.setattr(study, "scan_scales", lambda *_: nothing)
    monkeypatch.setattr(study, "scan_as_strong", lambda *_: pd.DataFrame(columns=["factor", "peak_tilt"]))
    largest: dict[str, float] = {}
    for scale in (0.3, 0.6, 1.0, 1.4, 2.0):
        advice = advise(Case(body, motion.scaled(scale)), copies=20).demands
        demands = dict(zip(advice["demand"], advice["value"], strict=True))
        acts_within_its_rows(advice)
        for name, value in largest.items():
            if name not in ("wall_height", "clearance"):  # no value if too many overturn
                assert demands[name] >= 0.9 * value, (name, scale)  # 10 % scatter allowed
        largest |= {name: value for name, value in demands.items() if value > 0.0}
    assert largest["tilt"] >= PASSED  # overturns at the end
    assert largest["moment"] > 0.0


@pytest.mark.slow
def test_case_with_a_closed_base_is_not_compared_with_the_other_support(monkeypatch):
    """Nothing can be compared, and chatter of the rim costs the flat-ground model minutes."""
    monkeypatch.setattr(study, "other_records", lambda _: ({}, ""))
    nothing = scan_scales(Case(PIER, GroundMotion(np.zeros((9, 2)), 0.1)))
    monkeypatch.setattr(study, "scan_scales", lambda *_: nothing)
    monkeypatch.setattr(study, "scan_as_strong", lambda *_: pd.DataFrame(columns=["factor", "peak_tilt"]))
    threshold = uplift_factor(SHORT, PIER.tan_alpha, 9.81)
    for factor, opens in ((1.03, False), (1.1, True)):
        advice = advise(Case(PIER, SHORT.scaled(factor * threshold)), copies=20)
        assert advice.moves
        assert (advice.peak > CLOSED_TILT) == opens
        assert (advice.facts["other_support"] is not None) == opens
        assert ("other support" in set(advice.members["group"])) == opens


def test_scaled_records_are_nested():
    # of a record twice as strong the threshold is at half the factor
    weak = weaker_factors(0.4)
    strong = 2.0 * np.array(weaker_factors(0.2))
    assert [factor for factor in strong if factor < 1.0] == pytest.approx(weak)
    assert weaker_factors(math.inf) == []


def test_top_displacement_matches_the_traces():
    motion = el_centro_1940().scaled(0.9)
    frame = reduced.simulate(Case(WobblingFrame(PIER, slab_mass_ratio=2.0), motion))
    moved = np.linalg.norm(frame.slab_displacement[:, :2], axis=1)
    assert top_displacement(frame.case.cylinder, frame.tilt) == pytest.approx(moved, abs=SAME_RUN)
    # at alpha the mass centre stands over the rim: the top of the axis is twice as far out, less the base
    theta, b, h = PIER.alpha, PIER.base_radius, PIER.half_height
    assert top_displacement(PIER, theta) == pytest.approx(
        2.0 * h * math.sin(theta) + b * (1.0 - math.cos(theta))
    )
    assert list(top_displacement(PIER, [0.0, math.inf])) == [0.0, math.inf]


@pytest.mark.slow
def test_a_frame_has_demands_at_base_and_top_in_kilonewtons(no_records):
    mass, gamma = 40.0, 0.5
    advice = advise(
        Case(WobblingFrame(PIER, slab_mass_ratio=gamma), SHORT, friction=0.15), copies=20, mass=mass
    )
    members = advice.demands.set_index("demand")
    for name, carried in (("shear", 1.0 + gamma), ("top_shear", gamma)):
        for column, force in (("value", "for_mass"), ("peak", "peak_for_mass")):
            assert members[force][name] == pytest.approx(
                9.81 * carried * mass * members[column][name], nan_ok=True
            )
    base = ["friction", "shear", "force"]
    assert list(advice.demands["demand"])[:6] == [*base, *(f"top_{name}" for name in base)]
    trace = reduced.simulate(Case(WobblingFrame(PIER, slab_mass_ratio=0.5), SHORT, friction=0.15))
    own, moving = demands_of(trace), trace.tilt > 0.0
    needed = np.maximum(trace.friction_needed, trace.top_friction_needed)[moving]
    assert own["slip"] == pytest.approx(np.mean(needed > 0.15), abs=2.0 / moving.sum())
    assert own["top_friction"] > own["friction"]  # a light slab needs more friction than the ground
    ends = {
        "contact_force": trace.top_contact_force,
        "top_contact_force": trace.contact_force,
        "friction_needed": trace.top_friction_needed,
        "top_friction_needed": trace.friction_needed,
    }
    names = ("case", "outcome", "time", "tilt", "restraining_moment", "open_base", "peak_tilt")
    swapped = demands_of(SimpleNamespace(**{name: getattr(trace, name) for name in names}, **ends))
    # maximum over both ends
    assert (swapped["slip"], swapped["lost"]) == (own["slip"], own["lost"])
    assert swapped["friction"] == own["top_friction"]


@pytest.mark.slow
def test_the_vertical_component_is_judged_by_pairs_of_copies():
    plan = AdvicePlan()
    own, without = vertical_effect(Case(PIER, el_centro_1940(vertical=True)), RECESS, plan)
    shipped, with_it = vertical_effect(Case(PIER, el_centro_1940()), RECESS, plan)
    assert (own.source, shipped.source) == ("own", "shipped")
    assert (list(without), list(with_it)) == (["without vertical"], ["with vertical"])
    assert own.ratios["ratio"] == pytest.approx(shipped.ratios["ratio"], rel=1e-6)  # equal copies
    other, none = vertical_effect(Case(PIER, PULSE), RECESS, plan)
    assert (other.source, none) == ("other", {})


def test_the_vertical_component_of_the_shipped_record_is_known_at_any_scale():
    whole = el_centro_1940(vertical=True)
    recorded = with_vertical(el_centro_1940().scaled(0.7))
    np.testing.assert_allclose(recorded.acceleration, 0.7 * whole.acceleration, rtol=1e-12)
    assert with_vertical(SHORT).acceleration.shape == (1000, 3)
    assert with_vertical(whole) is whole
    assert with_vertical(PULSE) is None


def test_the_vertical_component_is_part_of_the_grade_of_overturning(advice):
    members = advice.members.copy()
    fallen = members[members["group"] == "copies"].assign(group="with vertical", outcome="overturned")
    graded = with_table(advice, members=pd.concat([members, fallen], ignore_index=True))
    assert graded.grades["overturning"] == "not satisfied"
    assert [each.level for each in graded.findings().of("vertical")] == ["not satisfied"]
    beside = fallen.assign(group="without vertical")
    assert with_table(advice, members=pd.concat([members, beside])).grades == advice.grades


@pytest.mark.slow
def test_cylinder_at_rest_has_no_demand_but_its_weight():
    advice = advise(Case(PIER, SHORT.scaled(0.3)), copies=20)
    assert not advice.moves
    assert advice.grades == {}
    demands = advice.demands.set_index("demand")["value"]
    assert demands["force"] == 1.0  # its weight
    assert not demands.drop("force").any()
    assert advice.facts["motion"]["uplift_factor"] == pytest.approx(uplift_factor(SHORT, 0.2, 9.81) / 0.3)
    assert advice.facts["motion"]["friction_at_rest"] == pytest.approx(0.3 * SHORT.peak / 9.81)


def test_scan_of_equally_strong_shaking_is_fine_and_contains_single_runs(advice):
    scan = advice.as_strong
    factors = scan["factor"].to_numpy()
    assert (factors.min(), factors.max()) == pytest.approx(AS_STRONG)
    assert np.diff(np.log(factors)).max() < 1e-3
    assert scan["peak_tilt"][scan["factor"] == 1.0].item() == pytest.approx(
        advice.peak * PIER.alpha, rel=1e-4
    )
    low, high = advice.range_as_strong
    assert low <= advice.peak <= high
    falls = scan.assign(peak_tilt=np.where(factors > 1.1, 0.5 * math.pi, scan["peak_tilt"]))
    scanned = with_table(advice, as_strong=falls)
    assert scanned.range_as_strong[1] == math.inf
    assert scanned.grades["intensity"] == "caution"
    assert scanned.lowest_factor == factors[factors > 1.1].min()
    assert not len(scan_as_strong(Case(PIER, SHORT), "recess", 0.5 * math.pi))


def test_the_overturning_share_is_independent_of_the_scales_run(advice):
    """Most scales lie near the peak tilts: nine tenths of them may cover a tenth of the range."""
    low, high = AS_STRONG
    coarse = np.geomspace(low, high, 101)
    fine = np.unique([*coarse, *np.geomspace(high / 1.02, high, 900)])
    for factors in (coarse, fine):
        tilts = np.where(factors > high / 1.024, 0.5 * math.pi, 0.1)
        table = with_table(advice, as_strong=pd.DataFrame({"factor": factors, "peak_tilt": tilts}))
        lowest, share = table.overturning_as_strong
        assert share == pytest.approx(math.log(1.024) / math.log(high / low), abs=0.01)
        assert lowest == factors[factors > high / 1.024].min()
    assert (
        with_table(advice, as_strong=advice.as_strong.assign(peak_tilt=0.1)).overturning_as_strong[1] == 0.0
    )


def test_identical_copies_count_as_one_run(advice):
    members = advice.members.copy()
    copies = members["group"] == "copies"
    one = members[copies].iloc[0]
    numbers = ["peak_tilt", "friction", "shear", "moment", "force", "shear_and_wall", "tilt", "slip", "lost"]
    members.loc[copies, numbers] = one[numbers].to_numpy(float)
    single = with_table(advice, members=members)
    row = single.groups.set_index("group").loc["copies"]
    assert (row["single"], row["runs"], row["failed"], row["overturned"]) == (True, 20, 0, 0)
    assert np.isnan(row[["chance", "chance_low", "chance_high", "peak_tilt_50"]].to_numpy(float)).all()
    assert not single.copies_differ
    # groups with all members at rest, or all overturned, are single runs
    members.loc[copies, numbers] = 0.0
    assert not with_table(advice, members=members).groups["single"].any()
    members.loc[copies, "peak_tilt"] = 0.5 * math.pi / PIER.alpha
    members.loc[copies, "friction"] = np.linspace(0.2, 0.3, copies.sum())
    assert not with_table(advice, members=members).groups["single"].any()


def test_topics_without_runs_are_graded_not_tested():
    up = el_centro_1940(vertical=True).acceleration[:800] * [0.0, 0.0, 7.0]
    advice = advise(Case(PIER, GroundMotion(up, 0.01, "up")), copies=20)
    assert (advice.moves, len(advice.lowest), advice.copies_differ) == (True, 0, False)
    grades = advice.grades
    for topic in ("overturning", "intensity", "engine"):
        assert grades[topic] == "not tested"
    # lifts without a tilt that opens its base: no demands on ground and recess
    assert grades["contact"] == "not tested"
    assert advice.response["tolerance"] == pytest.approx(0.1 * advice.peak)


def test_ratios_of_overturned_copies_are_counts():
    peaks = np.linspace(0.1, 0.3, 20)
    fell, stands = np.arange(20) < 15, np.zeros(20, dtype=bool)
    most = ratios_of(Pairs(peaks, peaks, stands, fell).contrast())
    assert math.isnan(most["ratio"])  # 0: fifteen overturn in that group only
    assert [most[name] for name in ("members", "count", "higher", "lower")] == [20, 20, 0, 15]
    assert (most["overturned"], most["against_overturned"]) == (0, 15)
    both = ratios_of(Pairs(2.0 * peaks, peaks, fell, fell).contrast())
    assert (both["count"], both["higher"]) == (5, 5)
    assert math.isnan(both["ratio"])  # of five
    assert ratios_of(Pairs(2.0 * peaks, peaks, stands, stands).contrast())["ratio"] == pytest.approx(2.0)


@pytest.mark.slow
def test_overturning_after_the_record_counts_in_every_group(no_records):
    time = np.arange(121) * 0.01
    wave = 4.0 * 9.81 * 0.2 * np.sin(2.0 * np.pi * time / 1.2)  # one sine of 4 g tan(alpha) and 1.2 s

    def after(still: float) -> Advice:
        along = np.concatenate([wave, np.zeros(round(100.0 * still))])
        return advise(
            Case(PIER, GroundMotion(np.column_stack([along, np.zeros_like(along)]), 0.01)), copies=20
        )

    cut, followed = after(0.0), after(20.0)
    for advised in (cut, followed):
        assert advised.overturned
        assert advised.groups.set_index("group").loc["copies", "chance"] == 1.0
        assert advised.grades["overturning"] == "not satisfied"
        # all above half of it overturn, by the exact step of the search or less
        assert advised.lowest_factor == pytest.approx(0.506, abs=0.01)
    ends = [advised.response["peak_time"] for advised in (cut, followed)]
    assert ends[0] == pytest.approx(ends[1], rel=SAME_RUN)
    assert cut.facts["length"] == pytest.approx(ends[0], abs=0.011)  # a sample
    assert cut.facts["motion"]["samples"] == 121
    # every copy has overturned at the end
    assert cut.band["low"].iloc[-1] > 1.0
    assert cut.response["in_one_plane"]


@pytest.mark.slow
def test_shortened_run_ends_at_its_duration_unless_it_overturns(no_records):
    fallen = advise(case(4.0, duration=5.0), copies=20)
    assert fallen.overturned
    assert fallen.facts["motion"]["samples"] == 501
    assert fallen.response["end"] == pytest.approx(fallen.facts["length"], abs=0.011)
    stands = advise(case(1.0, duration=5.0), copies=20)
    assert stands.facts["length"] == stands.response["end"] == 5.0


@pytest.mark.slow
def test_single_run_and_advice_report_equal_divergence_time(no_records):
    # a cylinder whose largest tilt an input 1 % off changes by half of it and more
    slender = Cylinder(semidiagonal=6.0847320541999865, tan_alpha=0.08996054265853794)
    chaotic = Case(slender, el_centro_1940().scaled(1.28359029043245))
    single = single_run(chaotic, RECESS).facts["single_trace"]
    advised = advise(chaotic, copies=20)
    assert single["perturbation"] == advised.facts["perturbation"] == 0.01
    assert single["copies_part"] == pytest.approx(advised.divergence_time)
    assert single["copies_part"] < advised.response["peak_time"]
    # no amplification without passes
    swing = Case(slender, initial=InitialState(0.5 * slender.alpha, rolling_rate=1.0), duration=5.0)
    assert single_run(swing, RECESS).facts["single_trace"]["copies_part"] == math.inf


def test_advice_on_flat_ground_uses_the_flat_ground_model():
    advice = advise(
        Case(PIER, initial=InitialState(0.05, rolling_rate=0.5), duration=2.0), support="flat", copies=20
    )
    assert (advice.facts["model"], advice.facts["other_model"]) == ("flat-ground model", "recess model")
    assert advice.groups["moment_95"].tolist() == [0.0]
    assert (advice.trust.kind, advice.vertical.source, len(advice.planar)) == ("trace", "", 0)


@pytest.mark.slow
def test_advice_has_repr_table_and_plot(advice, tmp_path):
    shows_itself(advice, "outcome as given ", "grade ")
    loads_as_it_was(advice, tmp_path)


@pytest.mark.slow
def test_leading_rest_does_not_change_the_predicted_agreement() -> None:
    shaking, predictions = el_centro_1940().scaled(1.5), []
    for rest in (0, 1):
        still = np.zeros((round(rest / shaking.time_step), shaking.acceleration.shape[1]))
        motion = GroundMotion(np.vstack([still, shaking.acceleration]), shaking.time_step)
        case = Case(Cylinder(semidiagonal=3.0, tan_alpha=0.15), motion, duration=9.0 + rest)
        reference = reduced.simulate(case)
        predictions.append(verify_run(case, Run("mujoco", "recess"), reference)[1])
    first, later = predictions
    assert first.reason == later.reason != ""
    assert later.length == pytest.approx(first.length, rel=COUNTED)


@pytest.mark.slow
def test_verification_values_equal_the_comparison_summary_row() -> None:
    """A run on flat ground, with another reference than its own model."""
    shaken, run = Case(PIER, el_centro_1940(), duration=5.0), Run("mujoco", "flat")
    row = comparison(shaken, runs=[run], reference=Run(None, "recess"), workers=1).summary.iloc[0]
    verified, prediction, trace = verify_run(shaken, run, reduced.simulate(shaken))
    assert (verified.label, verified.version) == (row["run"], row["engine_version"])
    for name in ("time_step", "outcome", "diagnostics", "peak_tilt", "divergence"):
        assert getattr(verified, name) == row[name], name
    assert (verified.agreed_until, verified.diverged) == (
        row["within_tolerance_until"],
        row["left_tolerance"],
    )
    assert prediction.reason == row["predicted_by"] == "model form"
    assert row["reference_uplift_time"] + prediction.length == pytest.approx(
        row["predicted_until"], rel=1e-12
    )
    assert trace.run.engine == "mujoco"


@pytest.mark.slow
def test_engine_crash_does_not_abort_the_advice(monkeypatch: pytest.MonkeyPatch) -> None:
    here = [str(Path(scheduled.__file__).parent), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, here)))
    monkeypatch.setattr(execution, "run_job", scheduled.killed)
    release = Case(PIER, initial=InitialState(0.1, rolling_rate=0.5), duration=1.0)
    verified, prediction, trace = verify_run(release, Run("mujoco", "recess"), reduced.simulate(release))
    assert (verified.outcome, verified.diagnostics, verified.diverged) == ("failed", "died", True)
    assert (prediction.length, prediction.reason, len(trace.time)) == (1.0, "", 0)


@pytest.mark.slow
def test_advice_states_uplift_stiffness_and_balance_of_a_tendon(no_records: None) -> None:
    """Uplift, initial stiffness and balance match the static couple; its demand is the tension."""
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    tendon = Tendon(prestress=0.5, stiffness=1.0, yield_force=0.6)
    case = Case(pier, el_centro_1940().scaled(2.0), duration=12.0, tendon=tendon)
    tied, plain = (advise(each, copies=20) for each in (case, Case(pier, case.motion, duration=12.0)))
    facts = tied.facts["tendon"]
    assert facts["uplift_factor"] == 1.5
    ratio = tied.facts["motion"]["uplift_factor"] / plain.facts["motion"]["uplift_factor"]
    assert ratio == pytest.approx(1.5, rel=1e-12)
    b, h = pier.base_radius, pier.mass_centre_height

    def couple(tilt: float) -> float:  # static couple over m g
        pull = tendon.prestress + tendon.stiffness * 2.0 * math.sin(0.5 * tilt)
        return b * math.cos(tilt) - h * math.sin(tilt) + b * pull * math.cos(0.5 * tilt)

    assert couple(facts["balance_tilt"] * pier.alpha) == pytest.approx(0.0, abs=1e-12)
    # V'' upright, over m g b
    assert facts["initial_stiffness"] == pytest.approx((couple(1e-6) - couple(0.0)) / 1e-6 / b, rel=1e-4)
    rows = tied.demands.set_index("demand")
    assert rows["value"]["tendon"] > 0.6
    assert tied.grades["tendon"] == "not satisfied"
    # most runs yield at 0.25 alpha and have no further result; without yield force they have
    assert tied.grades["overturning"] == "not tested"
    assert tied.yielded > 5
    assert rows["value"].drop("tendon").isna().all()
    elastic = advise(
        dataclasses.replace(case, tendon=dataclasses.replace(tendon, yield_force=None)), copies=20
    )
    assert (elastic.grades["overturning"], elastic.yielded) != ("not tested", tied.yielded)
    assert "tendon" not in plain.grades
    # the search starts at the raised uplift scale
    starts = tied.lowest["start"].to_numpy() / plain.lowest["start"].to_numpy()
    assert starts == pytest.approx(1.5, rel=1e-12)
    with pytest.raises(ValueError, match="is for support 'recess', got 'flat'"):
        advise(case, support="flat", copies=20)
