"""Limits of the reduced model on a tiny grid: measured, cached, and changed with a model constant."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from showing import loads_as_it_was, shows_itself
from tiny_validity import TINY, kept_engine_runs, tiny_tables, tiny_validity

from rockwobble.compare.metrics.pair import make_pair, tilt_rms_relative
from rockwobble.compare.metrics.statistics import MARGIN
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import Case, Cylinder, InitialState, Run, Tendon, Trace, WobblingFrame
from rockwobble.models.finding import Value
from rockwobble.models.support import RECESS
from rockwobble.reduced import body, free_response, restoring, simulate, steady_wobble_rate
from rockwobble.reduced.body import Body
from rockwobble.reports.pages.wording import words
from rockwobble.studies.plans import ValidityPlan
from rockwobble.studies.validity.limits import (
    ALIKE,
    FEWEST,
    cells,
    contrasts,
    damping,
    findings_of,
    limit_of,
    limits_of,
    needs,
    quantile_reached,
    traces,
    vertical,
)
from rockwobble.studies.validity.measurements import PARTS, has_room, losses, needs_of, tasks_of
from rockwobble.studies.validity.plan import (
    ALONE,
    EL_CENTRO,
    FREE,
    FULL,
    HALVED,
    LARGEST_PEAK,
    QUICK,
    REFERENCE_SIZE,
    Structure,
    shaken_case,
    source_of,
)
from rockwobble.studies.validity.study import Validity, measure_all, measure_validity, validity_of

pytestmark = pytest.mark.slow

Tables = Mapping[str, pd.DataFrame]
PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "validity"
# of the transverse inertia: far above every error of an engine, and no other body
HEAVIER = 1.1


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Tables:
    return tiny_tables(tmp_path_factory.getbasetemp())


def said(tables: Tables, structure: Structure = ALONE) -> dict[str, Mapping[str, Value]]:
    """Values of each finding by its key."""
    return {each.key: each.values for each in findings_of(tables, structure)}  # noqa: PD011


@contextmanager
def heavier_models() -> Iterator[None]:
    """Reduced models with a wrong transverse inertia; engines are unchanged."""

    def heavier_body(cylinder: Cylinder, gravity: float, rolling_resistance: float = 0.0) -> Body:
        true = body.body_of(cylinder, gravity, rolling_resistance)
        I1 = HEAVIER * true.I1
        A, J = true.A - true.I1 + I1, true.J - true.I1 + I1
        p2 = true.p2 * true.A / A
        return true._replace(I1=I1, A=A, J=J, p2=p2, p=p2**0.5)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(restoring, "body_of", heavier_body)
        yield


@pytest.fixture(scope="module")
def heavier(tables: Tables, tmp_path_factory: pytest.TempPathFactory) -> Tables:
    """Tables of the wrong models; engine runs are reused, as one test confirms."""
    with heavier_models(), kept_engine_runs(tmp_path_factory.getbasetemp()):
        return measure_all(TINY, tmp_path_factory.mktemp("heavier"), workers=1)


def test_every_part_has_a_table_and_every_limit_has_numbers(tables: Tables) -> None:
    assert set(tables) == set(PARTS)
    assert all(len(table) for table in tables.values())
    ring = tables["rings"].query("support == 'ring'")
    assert set(ring[ring["peak"] > 0.0]["motion"]) == {FREE, EL_CENTRO}
    for name in ("peak", "halved_peak"):  # early end: supports cannot differ
        known = tables["rings"].dropna(subset=name)
        assert known[name].to_list() == pytest.approx(known["recess_peak"].to_list(), rel=1e-2)
    groups = {limit.partition(".")[0] for limit in limits_of(tables, ALONE)["limit"]}
    limits = {f"limit_{each}" for each in ("model", "requirement", "records", "release", "force", "ring")}
    assert groups == {*limits, "vertical", "traces"}


def test_limits_change_with_the_reduced_model_and_engine_runs_do_not(tables: Tables, heavier: Tables) -> None:
    right, wrong = (said(each)["limit_release.decided"] for each in (tables, heavier))
    names = ["runs", "runs_contradicted", "runs_all"]
    np.testing.assert_equal([right[name] for name in names], [2, math.nan, 2])
    assert [wrong[name] for name in names] == [0, 2, 2]
    assert "limit_model.contradicted" in said(heavier).keys() - said(tables).keys()
    rests = {"limit_requirement.friction", "limit_requirement.contact", "limit_requirement.recess"}
    rests |= {"limit_requirement.stiffness", "limit_release.off", "limit_force.friction", "limit_force.slip"}
    rests |= {"limit_force.normal", "limit_ring.worst", "vertical.vertical", "vertical.copy"}
    rests |= {"traces.recess_recess", "traces.flat_recess", "traces.flat_flat"}
    numbers = [limits_of(each, ALONE).groupby("limit")["value"].agg(list) for each in (tables, heavier)]
    assert all(numbers[0][limit] != numbers[1][limit] for limit in rests)
    ours, theirs = (each["records"] for each in (tables, heavier))
    engine = ~ours["method"].isin((RECESS.model, "flat-ground model", "perturbed copy"))
    np.testing.assert_array_equal(ours[engine]["peak"], theirs[engine]["peak"])
    assert (ours[~engine]["peak"].to_numpy() != theirs[~engine]["peak"].to_numpy()).all()
    case, run = shaken_case(EL_CENTRO, 0.2, 6.0, 2.0, duration=3.0), Run("mujoco", "recess", 1e-3)
    with heavier_models():
        again = simulate_run(case, run)
    np.testing.assert_array_equal(again.tilt, simulate_run(case, run).tilt)
    assert again.peak_tilt > 0.0


def test_quick_extent_is_a_subset_and_motions_have_plausible_peaks() -> None:
    quick, full = ([part for part, *_ in tasks_of(extent)] for extent in (QUICK, FULL))
    assert all(0 < quick.count(part) <= full.count(part) for part in PARTS)
    for name in ("tan_alphas", "releases", "shaken_tan_alphas", "sizes"):
        assert set(getattr(QUICK, name)) <= set(getattr(FULL, name)), name
    assert FULL.members >= 20
    assert {ring.friction for ring in FULL.rings} >= {0.0, 0.5, 1.0}
    assert len({ring.clearance for ring in FULL.rings}) >= 4
    points = [*QUICK.record_points, *QUICK.trace_points, *FULL.record_points, *FULL.trace_points]
    assert max(tan_alpha * intensity for tan_alpha, _, intensity in points) <= LARGEST_PEAK
    beyond = 1.001 * LARGEST_PEAK / 0.4
    (row,) = PARTS["peaks"](EL_CENTRO, 0.4, 6.0, (1.0, beyond), ALONE)
    assert row["intensity"] == 1.0


@pytest.mark.parametrize(
    ("factor", "scatter", "verdict", "key"),
    [
        (1.001, 0.0, "within", "established"),
        (1.1, 0.0, "beyond", "contradicted"),
        (1.0, 0.3, "undecided", "undecided"),
    ],
)
def test_agreement_over_records_needs_the_interval_within_the_margin(
    tables: Tables, factor: float, scatter: float, verdict: str, key: str
) -> None:
    random, count = np.random.default_rng(1), 22
    peaks = random.lognormal(-1.2, 0.8, count)
    scattered = factor * peaks * np.exp(scatter * random.standard_normal(count))
    rows = [
        {"motion": f"record {i}", "tan_alpha": 0.2, "semidiagonal": 6.0, "intensity": 2.0, "method": method,
         "peak": peak, "outcome": "stands", "contact_time": 0.0, "loss": 0.0}
        for method, values in (
            (RECESS.model, peaks), ("recess", scattered), ("ring", 2.0 * peaks), (HALVED, peaks)
        )
        for i, peak in enumerate(values)
    ]  # fmt: skip
    members = {**tables, "records": pd.DataFrame(rows)}
    table = contrasts(members).set_index(["method", "against"])
    assert table.loc[("recess", RECESS.model), "verdict"] == verdict
    # a ring is another system, and is compared with itself for how far it has converged
    assert table.loc[("ring", RECESS.model), "ratio"] == pytest.approx(2.0)
    assert table.loc[(HALVED, "ring"), "ratio"] == pytest.approx(0.5)
    keys = said(members)
    (model,) = {f"limit_model.{each}" for each in ("established", "contradicted", "undecided")} & set(keys)
    assert model == f"limit_model.{key}"
    assert ("limit_model.strays" in keys) == (key != "contradicted")
    assert {"limit_clearance.unconservative", "limit_records.not_converged"} <= set(keys)
    # one contradicted release outweighs any agreement
    other = tables["verification"].assign(engine_turn=tables["verification"]["engine_turn"] * 1.1)
    assert "limit_model.contradicted" in said({**members, "verification": other})


@pytest.mark.parametrize(
    ("least", "largest", "converges"),
    [
        (1.0 / (1.0 + MARGIN), 1.0 + MARGIN, True),
        (1.0 / (1.0 + MARGIN) - 1e-3, 1.0, False),
        (1.0, 1.0 + MARGIN + 1e-3, False),
    ],
)
def test_convergence_needs_both_tails_within_the_margin(
    tables: Tables, least: float, largest: float, converges: bool
) -> None:
    ring = pd.concat([tables["records"].query("method == 'ring'").iloc[:1]] * 22, ignore_index=True)
    ring = ring.assign(motion=[f"record {n}" for n in range(22)], peak=1.0)
    halved = ring.assign(method=HALVED, peak=[least, least, *[1.0] * 18, largest, largest])
    rows = pd.concat([tables["records"], ring.assign(intensity=7.0), halved.assign(intensity=7.0)])
    key = "converged" if converges else "not_converged"
    assert f"limit_records.{key}" in said({**tables, "records": rows})


def test_map_cells_count_records_signed_changes_and_overturning(tables: Tables) -> None:
    fallen = 0.5 * math.pi / math.atan(0.2)
    rows = {
        "recess": [0.1, 0.2, 0.4, fallen] * 2,
        "flat": [0.05, 0.1, fallen, fallen] * 2,
        "copy": [0.1, 0.2, 0.4, 0.9] * 2,
    }
    nothing = dict.fromkeys(("friction", "least_normal", "moment"), math.nan)
    table = pd.DataFrame(rows).assign(
        motion=[f"record {n}" for n in range(8)], tan_alpha=0.2, semidiagonal=6.0, intensity=2.0, **nothing
    )
    cell = cells({**tables, "peaks": table}).iloc[0]
    assert (cell["members"], cell["rocked"]) == (8, 8)
    assert (cell["overturned"], cell["flat_overturned"], cell["copy_overturned"]) == (0.25, 0.5, 0.0)
    # half, half, and one overturning on flat ground only; twice overturned has no ratio
    assert cell["flat_ratio"] == pytest.approx(0.5)
    assert cell["flat_90"] == math.inf
    assert cell["copy_ratio"] == pytest.approx(1.0)


def test_requirements_by_slenderness_and_intensity_need_enough_motions(tables: Tables) -> None:
    def cell(tan_alpha: float, size: float, intensity: float, largest: float, standing: int) -> pd.DataFrame:
        shares = np.where(np.arange(10) < standing, np.arange(1, 11) / 10.0, math.nan)
        return pd.DataFrame(
            {
                "motion": [f"record {n}" for n in range(10)],
                "recess": 0.5, "flat": 0.5, "copy": 0.5, "least_normal": 1.0 - shares,
                "friction": 2.0 * largest * shares * tan_alpha, "moment": largest * shares,
            }
        ).assign(tan_alpha=tan_alpha, semidiagonal=size, intensity=intensity)  # fmt: skip

    peaks = pd.concat(
        [
            cell(0.1, 4.0, 2.0, 0.05, FEWEST),
            cell(0.1, 8.0, 2.0, 0.06, FEWEST),
            cell(0.1, 8.0, 5.0, 0.2, FEWEST - 1),
            cell(0.4, 8.0, 2.0, 0.3, FEWEST),
        ]
    )
    requirements = needs({**tables, "peaks": peaks}).set_index(["tan_alpha", "intensity"])
    assert list(requirements.index) == [(0.1, 2.0), (0.4, 2.0)]
    # 90 % of the size with the largest need
    assert requirements["moment"].to_list() == pytest.approx([0.9 * 0.06, 0.9 * 0.3])
    assert requirements["friction"].to_list() == pytest.approx([1.8 * 0.06, 1.8 * 0.3])
    assert requirements[["sizes", "motions"]].to_numpy().tolist() == [[2, 20], [1, 10]]


def test_vertical_component_counts_records_it_alone_overturns() -> None:
    fell = 0.5 * math.pi / math.atan(0.2)
    recess, other = [0.5] * 8 + [0.5, fell, fell], [0.55] * 8 + [fell, 0.5, fell]
    table = pd.DataFrame({"tan_alpha": 0.2, "recess": recess, "vertical": other, "copy": recess})
    changed = vertical({"peaks": table})
    assert changed["overturned"].to_dict() == {"vertical": 2, "copy": 2, "recess": 2}
    row = changed.loc["vertical"]
    assert (row["cells"], row["compared"], row["other"]) == (11, 10, 2)  # twice overturned there is no ratio
    assert (row["apart"], changed.loc["copy", "apart"]) == (10, 0)  # each changes by a tenth, or overturns
    assert row["least"] == row["largest"] == pytest.approx(1.1)


def test_friction_limit_excludes_values_that_slip_at_any_release(tables: Tables) -> None:
    slip = pd.DataFrame(
        {"share": [0.5, 0.9, 1.0] * 2, "slip": [0.0, 0.0, 0.0, 0.1, 0.1, 0.0], "tilt_rms": 0.0}
    ).assign(outcome="stands")
    # under a slab it slips at the top, which an engine does not count: the tilt errs, or energy ends the run
    signs = {"tilt_rms": [0.1, 0.1, 0.0]}, {"outcome": ["failed", "failed", "stands"]}
    for table in (slip, *(slip.iloc[:3].assign(**sign) for sign in signs)):
        values = said({**tables, "slip": table})["limit_force.slip"]
        assert (values["share"], values["bound"]) == (0.9, 1.0)


def test_soft_contact_is_identified_by_damping_and_failures_counted(tables: Tables) -> None:
    rows = [
        {"damping": damping, "softness": softness, "time_constant": round(softness, 3), "loss": 0.1,
         "peak": peak, "recess_peak": 0.5, "free_outcome": "stands", "outcome": outcome}
        for damping, softness, peak, outcome in (
            # one contact, slightly softer for the stouter, which it moves
            (0.1, 0.0098, 0.51, "stands"),
            (0.3, 0.01, 0.8, "stands"),
            (1.0, 0.002, 0.5, "stands"),
            (1.0, 0.001, math.nan, "failed"),
            (1.0, 0.02, math.nan, "failed"),
        )
    ]  # fmt: skip
    changed = {**tables, "contact": pd.DataFrame(rows)}
    by_damping = damping(changed).set_index("damping")
    assert by_damping["largest"].to_dict() == pytest.approx({0.1: 1.02, 0.3: 1.6, 1.0: 1.0})
    assert by_damping["failed"].to_dict() == {0.1: 0, 0.3: 0, 1.0: 2}
    values = said(changed)["limit_requirement.stiffness"]
    assert (values["bound"], values["share"], values["ratio"]) == (0.002, 0.0, 0.001)
    assert (values["runs"], values["runs_ended"], values["given_least"]) == (2, 1, 1.0)


def test_limits_and_quantiles_handle_infinite_and_unknown_values() -> None:
    points, holds = pd.Series([0.1, 0.1, 0.2, 0.2, 0.3]), pd.Series([True, True, True, False, True])
    assert limit_of(points, holds) == (0.1, 0.2)  # points count only if every row holds
    np.testing.assert_equal(limit_of(points, holds & False), (math.nan, 0.1))
    np.testing.assert_equal(limit_of(points, holds | True), (0.3, math.nan))
    np.testing.assert_equal(limit_of(points[:0], holds[:0]), (math.nan, math.nan))
    # infinite values count, unknown ones do not
    assert quantile_reached(pd.Series([1.0, 2.0, math.inf, math.nan]), 0.6) == 2.0
    assert quantile_reached(pd.Series([1.0, 2.0, math.inf]), 0.9) == math.inf


def test_contact_loss_is_reported_from_its_first_slenderness(tables: Tables) -> None:
    peaks = tables["peaks"]
    lost = peaks["least_normal"].mask(peaks["least_normal"].notna() & (peaks["tan_alpha"] > 0.3), -0.1)
    stated = said({**tables, "peaks": peaks.assign(least_normal=lost)})
    values = stated["limit_requirement.contact_lost"]
    assert "limit_requirement.contact" not in stated
    assert (values["runs_lost"], values["runs"]) == ((lost < 0.0).sum(), lost.notna().sum())
    assert (values["ratio"], values["factor"]) == (0.4, peaks[lost < 0.0]["intensity"].min())
    assert values["bound"] == lost[lost > 0.0].min()


def test_validity_has_repr_table_and_plot(tmp_path_factory: pytest.TempPathFactory, tmp_path: Path) -> None:
    validity = tiny_validity(tmp_path_factory.getbasetemp())
    shows_itself(validity, "motions ", "peaks 24 rows")
    loads_as_it_was(validity, tmp_path)
    # as where the records are not installed
    synthetic = replace(validity, facts={**validity.facts, "records": source_of("synthetic 1")})
    shows_itself(synthetic, "motions synthetic records", "peaks 24 rows")
    assert validity.plot("slip").axes


SQUAT = Cylinder(semidiagonal=6.0, tan_alpha=1.0)
# error of an engine at its default step, in the tilt against its own model, over 1.2 s
ENGINE = 1e-4


def off_models(trace: Trace) -> dict[str, float]:
    """Relative RMS tilt difference from the models, by their support."""
    models = {support: simulate(trace.case, support=support) for support in ("recess", "flat")}
    return {name: tilt_rms_relative(make_pair(SQUAT, model, trace)) for name, model in models.items()}


def test_losses_and_model_differences_identify_the_support() -> None:
    case = Case(SQUAT, initial=InitialState(SQUAT.alpha / 2, rolling_rate=0.5), duration=1.2, friction=3.0)
    # the release would start inside of such walls
    assert not has_room(case, Run("mujoco", "ring", ring_inclination=0.1))
    assert has_room(case, Run("mujoco", "ring"))
    traces = {support: simulate_run(case, Run("mujoco", support)) for support in ("recess", "flat", "ring")}
    off = {support: off_models(trace) for support, trace in traces.items()}
    assert off["recess"]["recess"] < ENGINE < off["recess"]["flat"]
    assert off["flat"]["flat"] < ENGINE < off["flat"]["recess"]
    recess, flat, ring = (losses(trace) for trace in traces.values())
    # in a recess the cylinder would always come down in its place, on flat ground it rolls away from it
    assert float(recess["rolled_out"]) < 1e-5 < 1e-3 < float(flat["rolled_out"])
    free = traces["flat"]
    lean = np.array([math.cos(free.rolling_angle[-1]), math.sin(free.rolling_angle[-1])])
    moved = math.hypot(*(free.contact_point[-1] / SQUAT.base_radius - lean))
    assert flat["at_end"] == pytest.approx(moved, rel=1e-9)
    assert flat["first_contact"] == math.inf
    assert abs(float(flat["loss"])) < ENGINE
    assert 0.5 < float(ring["first_contact"]) < 1.2
    assert float(ring["contact_time"]) > 0.0
    assert float(ring["loss"]) > 100.0 * abs(float(flat["loss"]))


# one number of each part that slab or tendon changes
OF_THE_BODY = {
    "free_response": "period",
    "verification": "half_period",
    "peaks": "friction",
    "slip": "needed",
    "contact": "recess_peak",
    "following": "reference_peak_tilt",
    "records": "peak",
    "rings": "recess_peak",
}
SLAB = Structure(slab_mass_ratio=1.0)
TIED = Structure(tendon_prestress=0.5, tendon_stiffness=2.0)


@pytest.mark.parametrize("structure", [SLAB, TIED])
def test_every_part_uses_the_slab_or_the_tendon(tables: Tables, structure: Structure, tmp_path: Path) -> None:
    extent = replace(TINY, sizes=(4.0,)).of(structure)
    validity = validity_of(measure_all(extent, tmp_path, workers=1), extent)
    slab = structure == SLAB
    assert set(validity.tables) == {*PARTS, "limits"} - ({"rings"} if slab else set())
    stated = {"slab_mass_ratio": 1.0} if slab else {"tendon_prestress": 0.5, "tendon_stiffness": 2.0}
    assert all((table[[*stated]] == [*stated.values()]).all(axis=None) for table in validity.tables.values())
    for name in PARTS.keys() & validity.tables.keys():
        # besides the release, which is at alpha/2
        known, alone = (
            set(each[name][OF_THE_BODY[name]].dropna()) - {0.5} for each in (validity.tables, tables)
        )
        assert known, name
        assert not known & alone, name
    values = said(validity.tables, validity.structure)
    # the engine has them, too, and one end of its column slips where the model says
    release = values["limit_release.decided" if slab else "limit_release.confirmed"]
    assert release["runs"] == release["runs_all"] == (2 if slab else 1)
    assert (values["limit_force.slip"]["share"], values["limit_force.slip"]["bound"]) == (0.9, 1.05)
    assert traces(validity.tables).query("support == 'recess'")["worst"].item() < ALIKE
    methods, plain = set(validity.records["method"]), set(tables["records"]["method"])
    if slab:
        assert methods == plain - {"ring", HALVED}
        assert "limit_scope.slab" in values
        assert not any(key.startswith("limit_ring.") for key in values)
        assert "ratio" not in values["limit_force.slip"]
        frame = WobblingFrame(Cylinder(semidiagonal=REFERENCE_SIZE, tan_alpha=0.2), 1.0, columns=1)
        tilt = 0.5 * frame.alpha
        initial = InitialState(tilt, rolling_rate=0.1 * steady_wobble_rate(frame, tilt))
        assert validity.free_response["period"].iloc[0] == free_response(frame, initial).period
    else:
        assert methods == plain - {"flat-ground model"}
        assert validity.peaks["flat"].isna().all()
        assert set(validity.following["support"]) == {"recess"}
        # what is asked of the tendon is its tension at the peak tilt
        stands = validity.peaks.dropna(subset="tension").iloc[0]
        cylinder = Cylinder(semidiagonal=stands["semidiagonal"], tan_alpha=stands["tan_alpha"])
        tension = Tendon(prestress=0.5, stiffness=2.0).tension(cylinder, stands["recess"] * cylinder.alpha)
        assert stands["tension"] == pytest.approx(tension, rel=1e-12)
        assert values["limit_requirement.tendon"]["ratio"] == validity.peaks["tension"].max()


@pytest.mark.parametrize(("prestress", "share"), [(0.5, 0.0), (2.0, 0.0), (0.5, 0.4)])
def test_a_prestress_multiplies_forces_and_leaves_the_friction(prestress: float, share: float) -> None:
    # of the column without a tendon that moves alike, larger by 1/(1 - share of the neutral stiffness): the
    # forces grow as that of uplift, not their ratio, but for the pull of the tendon at a tilt
    held = Structure(tendon_prestress=prestress, tendon_stiffness=share / 0.2)
    alone, tied = (
        needs_of(
            simulate(
                shaken_case(EL_CENTRO, 0.2, size, 1.5 * structure.uplift, structure=structure), rtol=1e-9
            )
        )
        for structure, size in ((ALONE, 6.0 / (1.0 - share)), (held, 6.0))
    )
    assert tied["friction"] == pytest.approx(alone["friction"], rel=0.02)  # measured 0.010
    for name in ("least_normal", "moment"):
        assert tied[name] == pytest.approx((1.0 + prestress) * alone[name], rel=5e-3), name
    assert set(tied) == {*alone, "tension"}


def test_intensities_relative_to_uplift_are_unchanged_by_a_tendon() -> None:
    structure = Structure(slab_mass_ratio=0.5, tendon_prestress=1.0)
    assert structure.uplift == 1.0 + 2.0 * 1.0 / 2.0
    assert QUICK.of(structure).intensities == tuple(2.0 * level for level in QUICK.intensities)
    assert FULL.of(ALONE) == FULL
    points = FULL.of(Structure(tendon_prestress=1.0)).record_points
    assert (0.2, 6.0, 7.0) in points
    assert max(tan_alpha * level for tan_alpha, _, level in points) <= LARGEST_PEAK
    with pytest.raises(ValueError, match=r"raises uplift to 51"):
        measure_validity("nowhere", ValidityPlan(quick=True, tendon_prestress=50.0))


@pytest.mark.checkout
def test_findings_match_counts_of_published_tables() -> None:
    loaded = Validity.load(PUBLISHED)
    values, records, rings = said(loaded.tables), loaded.records, loaded.rings.query("support == 'ring'")
    standing = records.query("method == 'ring' and outcome == 'stands'")["peak"]
    beyond = values["limit_records.beyond_alpha"]
    counts = (standing >= 1.0).sum(), len(standing), standing.max()
    assert (beyond["runs"], beyond["runs_all"], beyond["peak"]) == counts
    ends, left_out = records["outcome"].value_counts(), values["limit_records.left_out"]
    assert (left_out["count"], left_out["count_undecided"]) == (ends["failed"], ends["undecided"])
    twist = rings["twist"].abs().groupby(rings["motion"]).max()
    place = values["limit_ring.place"]
    assert (place["bound"], place["bound_free"]) == (twist[EL_CENTRO], twist[FREE])
    shaken = rings.query("motion != 'free response' and outcome != 'failed'")
    ratio = shaken["peak"] / shaken["recess_peak"]
    worst = ratio[pd.concat([ratio, 1.0 / ratio], axis=1).max(axis=1).idxmax()]
    assert values["limit_ring.worst"]["ratio"] == worst
    table = loaded.verification
    turns = table.groupby(["tan_alpha", "release", "spin"])["turn"]
    error = (table["engine_turn"] - table["turn"]).abs() / (turns.transform("max") - turns.transform("min"))
    unsure, decided = int((error >= 0.5).sum()), values["limit_release.decided"]
    assert (decided["runs"], decided["runs_open"]) == (len(table) - unsure, unsure)
    assert decided["count"] == turns.ngroups


def test_bounds_are_rounded_to_the_safe_side() -> None:
    checked = 0
    for group in ("requirement", "records", "release", "force", "ring"):
        for line in words()[f"limit_{group}"].values():
            text = line if isinstance(line, str) else line[-1]
            # a softness limit is rounded down
            for side, form in re.findall(r"at (most|least) \{\w+:([^}]*)\}(?!/p)", text):
                assert form.startswith(side), text
                checked += 1
    assert checked >= 10
