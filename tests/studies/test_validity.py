"""The limits of the reduced model: measured on a tiny grid, kept, and changed by a changed constant."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from showing import loads_as_it_was, shows_itself
from tiny_validity import TINY, kept_engine_runs, tiny_tables, tiny_validity

from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import Cylinder, InitialState, Run, Tendon, WobblingFrame
from rockwobble.models.support import RECESS
from rockwobble.reduced import body, free_response, restoring, simulate, steady_wobble_rate
from rockwobble.reduced.body import Body
from rockwobble.studies.plans import ValidityPlan
from rockwobble.studies.validity.limits import (
    ALIKE,
    FEWEST,
    LIMITS,
    cells,
    contrasts,
    damping,
    friction,
    limit_of,
    limits_of,
    needs,
    quantile_reached,
    vertical,
)
from rockwobble.studies.validity.measurements import FREE, HALVED
from rockwobble.studies.validity.plan import (
    EL_CENTRO,
    FULL,
    LARGEST_PEAK,
    QUICK,
    REFERENCE_SIZE,
    Structure,
    needs_of,
    shaken_case,
    source_of,
)
from rockwobble.studies.validity.study import PARTS, measure_all, measure_validity, validity_of

pytestmark = pytest.mark.slow

Tables = Mapping[str, pd.DataFrame]
# of the transverse inertia: far above every error of an engine, and no other body
HEAVIER = 1.1


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Tables:
    return tiny_tables(tmp_path_factory.getbasetemp())


@contextmanager
def heavier_models() -> Iterator[None]:
    """The reduced models, and nothing else, have another transverse inertia."""

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
    """The tables of these models; an engine run of the same problem is the same, as a test shows on one."""
    with heavier_models(), kept_engine_runs(tmp_path_factory.getbasetemp()):
        return measure_all(TINY, tmp_path_factory.mktemp("heavier"), workers=1)


def test_every_part_measures_and_every_limit_has_numbers(tables: Tables) -> None:
    assert set(tables) == set(PARTS)
    assert all(len(table) for table in tables.values())
    ring = tables["rings"].query("support == 'ring'")
    assert set(ring[ring["peak"] > 0.0]["motion"]) == {FREE, EL_CENTRO}
    limits = limits_of(tables)
    assert set(limits) == set(LIMITS) - {"tendon"}
    assert all(isinstance(value, float) for numbers in limits.values() for value in numbers.values())


def test_engine_confirms_both_models_and_contradicts_another_body(tables: Tables, heavier: Tables) -> None:
    right, wrong = (limits_of(found)["free_response"] for found in (tables, heavier))
    assert (right["confirmed"], right["contradicted"], right["points"]) == (2.0, 0.0, 2.0)
    assert (wrong["confirmed"], wrong["contradicted"]) == (0.0, 2.0)


def test_every_limit_rests_on_the_reduced_model_and_the_engine_does_not(
    tables: Tables, heavier: Tables
) -> None:
    right, wrong = limits_of(tables), limits_of(heavier)
    assert {name for name in right if right[name] != wrong[name]} == set(LIMITS) - {"tendon"}
    ours, theirs = (found["records"] for found in (tables, heavier))
    engine = ~ours["method"].isin((RECESS.model, "flat-ground model", "perturbed copy"))
    np.testing.assert_array_equal(ours[engine]["peak"], theirs[engine]["peak"])
    assert (ours[~engine]["peak"].to_numpy() != theirs[~engine]["peak"].to_numpy()).all()
    case, run = shaken_case(EL_CENTRO, 0.2, 6.0, 2.0, duration=3.0), Run("mujoco", "recess", 1e-3)
    with heavier_models():
        again = simulate_run(case, run)
    np.testing.assert_array_equal(again.tilt, simulate_run(case, run).tilt)
    assert again.peak_tilt > 0.0


def test_no_record_is_stronger_than_earthquakes_are() -> None:
    for extent in (QUICK, FULL):
        asked = [inputs["tan_alpha"] * max(inputs["intensities"]) for inputs in PARTS["peaks"].tasks(extent)]
        assert max(asked) <= LARGEST_PEAK
        points = (*extent.record_points, *extent.trace_points)
        assert max(tan_alpha * intensity for tan_alpha, _, intensity in points) <= LARGEST_PEAK


def test_quick_is_a_part_of_the_full_report_in_every_respect() -> None:
    for part in PARTS.values():
        quick, full = list(part.tasks(QUICK)), list(part.tasks(FULL))
        assert 0 < len(quick) <= len(full)
        assert sum(part.cost(**task) for task in quick) < sum(part.cost(**task) for task in full)
    for name in ("tan_alphas", "releases", "shaken_tan_alphas", "sizes"):
        assert set(getattr(QUICK, name)) <= set(getattr(FULL, name)), name
    assert FULL.members >= 20
    assert {ring.friction for ring in FULL.rings} >= {0.0, 0.5, 1.0}
    assert len({ring.clearance for ring in FULL.rings}) >= 4


@pytest.mark.parametrize(
    ("factor", "scatter", "verdict"), [(1.001, 0.0, "within"), (1.1, 0.0, "beyond"), (1.0, 0.3, "undecided")]
)
def test_over_records_agreement_is_said_where_the_interval_shows_it(
    tables: Tables, factor: float, scatter: float, verdict: str
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
    found = contrasts(members).set_index(["method", "against"])
    assert found.loc[("recess", RECESS.model), "verdict"] == verdict
    # a ring is another system, and is compared with itself for how far it has converged
    assert found.loc[("ring", RECESS.model), "ratio"] == pytest.approx(2.0)
    assert found.loc[(HALVED, "ring"), "ratio"] == pytest.approx(0.5)
    numbers = limits_of(members)["records"]
    found_at = numbers["recess_within"], numbers["recess_beyond"]
    assert found_at == (float(verdict == "within"), float(verdict == "beyond"))
    assert (numbers["ring_beyond"], numbers["points"]) == (1.0, 1.0)


def test_a_cell_is_of_records_signed_and_knows_who_overturns(tables: Tables) -> None:
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
    found = cells({**tables, "peaks": table}).iloc[0]
    assert (found["members"], found["rocked"]) == (8, 8)
    assert (found["overturned"], found["flat_overturned"], found["copy_overturned"]) == (0.25, 0.5, 0.0)
    # halved, halved, and one that overturns on flat ground alone; twice overturned there is no ratio
    assert found["flat_ratio"] == pytest.approx(0.5)
    assert found["flat_90"] == math.inf
    assert found["copy_ratio"] == pytest.approx(1.0)


def test_needs_are_by_slenderness_and_intensity_and_of_enough_motions(tables: Tables) -> None:
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
    found = needs({**tables, "peaks": peaks}).set_index(["tan_alpha", "intensity"])
    assert list(found.index) == [(0.1, 2.0), (0.4, 2.0)]
    # nine in ten of the size that needs most
    assert found["moment"].to_list() == pytest.approx([0.9 * 0.06, 0.9 * 0.3])
    assert found["friction"].to_list() == pytest.approx([1.8 * 0.06, 1.8 * 0.3])
    assert found[["sizes", "motions"]].to_numpy().tolist() == [[2, 20], [1, 10]]


def test_the_vertical_component_counts_what_it_alone_overturns() -> None:
    fell = 0.5 * math.pi / math.atan(0.2)
    recess, other = [0.5] * 8 + [0.5, fell, fell], [0.55] * 8 + [fell, 0.5, fell]
    table = pd.DataFrame({"tan_alpha": 0.2, "recess": recess, "vertical": other, "copy": recess})
    found = vertical({"peaks": table})
    assert (found["cells"], found["vertical_compared"]) == (11.0, 10.0)  # twice overturned there is no ratio
    assert (found["vertical_apart"], found["copy_apart"]) == (10.0, 0.0)  # each changes by a tenth, or falls
    assert found["vertical_least"] == found["vertical_largest"] == pytest.approx(1.1)


def test_a_friction_that_slips_at_one_release_does_not_hold() -> None:
    slip = pd.DataFrame(
        {"share": [0.5, 0.9, 1.0] * 2, "slip": [0.0, 0.0, 0.0, 0.1, 0.1, 0.0], "tilt_rms": 0.0}
    ).assign(outcome="stands")
    needed = pd.DataFrame({"tan_alpha": [0.2], "friction": [0.2]})
    found = friction({"free_response": needed, "slip": slip, "peaks": needed})
    assert (found["slips_at"], found["holds_from"]) == (0.9, 1.0)
    # under a slab it slips at the top, which an engine does not count: the tilt errs, or energy ends the run
    for sign in ({"tilt_rms": [0.1, 0.1, 0.0]}, {"outcome": ["failed", "failed", "stands"]}):
        under = slip.iloc[:3].assign(**sign)
        found = friction({"free_response": needed, "slip": under, "peaks": needed})
        assert (found["slips_at"], found["holds_from"]) == (0.9, 1.0)


def test_soft_contact_is_identified_by_damping_and_failures_counted(tables: Tables) -> None:
    rows = [
        {"damping": damping, "softness": softness, "time_constant": round(softness, 3), "loss": 0.1,
         "peak": peak, "recess_peak": 0.5, "free_outcome": "stands", "outcome": outcome}
        for damping, softness, peak, outcome in (
            # one contact, slightly softer for the stouter, which it moves
            (0.1, 0.0098, 0.51, "stands"),
            (0.3, 0.01, 0.8, "stands"),
            (1.0, 0.002, 0.5, "stands"),
            (1.0, 0.02, math.nan, "failed"),
        )
    ]  # fmt: skip
    found = {**tables, "contact": pd.DataFrame(rows)}
    by_damping = damping(found).set_index("damping")
    assert by_damping["largest"].to_dict() == pytest.approx({0.1: 1.02, 0.3: 1.6, 1.0: 1.0})
    assert by_damping["failed"].to_dict() == {0.1: 0, 0.3: 0, 1.0: 1}
    numbers = limits_of(found)["soft_contact"]
    assert (numbers["held_up_to"], numbers["left_from"], numbers["failed"]) == (0.002, 0.0098, 1.0)


def test_measures_of_limits() -> None:
    points = np.array([0.1, 0.1, 0.2, 0.2, 0.3])
    holds = np.array([True, True, True, False, True])
    assert limit_of(points, holds) == (0.1, 0.2)  # a point needs every row
    np.testing.assert_equal(limit_of(points, np.zeros(5, bool)), (math.nan, 0.1))
    np.testing.assert_equal(limit_of(points, np.ones(5, bool)), (0.3, math.nan))
    np.testing.assert_equal(limit_of(points[:0], holds[:0]), (math.nan, math.nan))
    # what is infinite counts, what is not known does not
    assert quantile_reached(np.array([1.0, 2.0, math.inf, math.nan]), 0.6) == 2.0
    assert quantile_reached(np.array([1.0, 2.0, math.inf]), 0.9) == math.inf


def test_a_report_shows_itself_by_figure(tmp_path_factory: pytest.TempPathFactory, tmp_path: Path) -> None:
    found = tiny_validity(tmp_path_factory.getbasetemp())
    shows_itself(found, "motions ", "peaks 24 rows")
    loads_as_it_was(found, tmp_path)
    # as where the records are not installed
    synthetic = replace(found, facts={**found.facts, "records": source_of(["synthetic 1"])})
    shows_itself(synthetic, "motions synthetic records", "peaks 24 rows")
    assert found.plot("slip").axes


# a number of each part that a slab changes
OF_THE_BODY = {
    "free_response": "period",
    "verification": "half_period",
    "peaks": "friction",
    "slip": "needed",
    "contact": "recess_peak",
    "following": "reference_peak_tilt",
    "records": "peak",
}


def test_every_part_but_rings_uses_the_slab(tables: Tables, tmp_path: Path) -> None:
    extent = replace(TINY, sizes=(4.0,), structure=Structure(slab_mass_ratio=1.0))
    found = validity_of(measure_all(extent, tmp_path, workers=1), extent)
    assert set(found.tables) == {*OF_THE_BODY, "limits"} == {*PARTS, "limits"} - {"rings"}
    assert all((table["slab_mass_ratio"] == 1.0).all() for table in found.tables.values())
    for name, column in OF_THE_BODY.items():
        known, alone = (each[name][column].dropna() for each in (found.tables, tables))
        assert len(known)
        assert not set(known) & set(alone), name
    assert set(found.limits["limit"]) == set(LIMITS) - {"rings", "tendon"}
    assert "ring" not in set(found.records["method"])
    frame = WobblingFrame(Cylinder(semidiagonal=REFERENCE_SIZE, tan_alpha=0.2), 1.0, columns=1)
    tilt = 0.5 * frame.alpha
    release = InitialState(tilt, rolling_rate=0.1 * steady_wobble_rate(frame, tilt))
    assert found.free_response["period"].iloc[0] == free_response(frame, release).period
    # the engine has the slab, too, and one end of its column slips where the model says
    numbers = limits_of(found.tables)
    assert (numbers["free_response"]["confirmed"], numbers["free_response"]["points"]) == (2.0, 2.0)
    assert (numbers["friction"]["slips_at"], numbers["friction"]["holds_from"]) == (0.9, 1.05)
    assert numbers["traces"]["recess_peak_worst"] < ALIKE


# a number of each part that a tendon changes
OF_THE_TENDON = {**OF_THE_BODY, "rings": "recess_peak", "slip": "needed"}
TIED = Structure(tendon_prestress=0.5, tendon_stiffness=2.0)


def test_every_part_uses_the_tendon_and_only_engines_run_flat(tables: Tables, tmp_path: Path) -> None:
    extent = replace(TINY, sizes=(4.0,)).of(TIED)
    found = validity_of(measure_all(extent, tmp_path, workers=1), extent)
    assert set(found.tables) == {*PARTS, "limits"}
    for table in found.tables.values():
        assert (table[["tendon_prestress", "tendon_stiffness"]] == [0.5, 2.0]).all(axis=None)
    for name, column in OF_THE_TENDON.items():
        known, alone = (set(each[name][column].dropna()) - {0.5} for each in (found.tables, tables))
        assert known, name  # besides the release, which is at alpha/2
        assert not known & alone, name
    numbers = limits_of(found.tables)
    assert set(numbers) == set(LIMITS)
    assert (numbers["free_response"]["confirmed"], numbers["free_response"]["points"]) == (1.0, 1.0)
    assert (numbers["friction"]["slips_at"], numbers["friction"]["holds_from"]) == (0.9, 1.05)
    assert numbers["traces"]["recess_peak_worst"] < ALIKE
    assert found.tables["peaks"]["flat"].isna().all()
    assert set(found.records["method"]) == set(tables["records"]["method"]) - {"flat-ground model"}
    assert set(found.tables["following"]["support"]) == {"recess"}
    # what is asked of the tendon is its tension at the peak tilt
    stands = found.tables["peaks"].dropna(subset="tension").iloc[0]
    cylinder = Cylinder(semidiagonal=stands["semidiagonal"], tan_alpha=stands["tan_alpha"])
    tension = Tendon(prestress=0.5, stiffness=2.0).tension(cylinder, stands["recess"] * cylinder.alpha)
    assert stands["tension"] == pytest.approx(tension, rel=1e-12)
    assert numbers["tendon"]["shaken"] == found.tables["peaks"]["tension"].max()


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
        for structure, size in ((Structure(), 6.0 / (1.0 - share)), (held, 6.0))
    )
    assert tied["friction"] == pytest.approx(alone["friction"], rel=0.02)  # measured 0.010
    for name in ("least_normal", "moment"):
        assert tied[name] == pytest.approx((1.0 + prestress) * alone[name], rel=5e-3), name
    assert set(tied) == {*alone, "tension"}


def test_shaking_is_as_far_beyond_uplift_as_without_a_tendon() -> None:
    structure = Structure(slab_mass_ratio=0.5, tendon_prestress=1.0)
    assert structure.uplift == 1.0 + 2.0 * 1.0 / 2.0
    extent = QUICK.of(structure)
    assert extent.intensities == tuple(2.0 * level for level in QUICK.intensities)
    assert FULL.of(Structure()) == FULL
    points = FULL.of(Structure(tendon_prestress=1.0)).record_points
    assert (0.2, 6.0, 7.0) in points
    assert max(tan_alpha * level for tan_alpha, _, level in points) <= LARGEST_PEAK
    with pytest.raises(
        ValueError, match=r"shaking of 1\.5 g something to rock, got one that raises uplift to 51"
    ):
        measure_validity("nowhere", ValidityPlan(quick=True, tendon_prestress=50.0))
