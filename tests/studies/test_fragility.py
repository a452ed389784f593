"""Fragility of the reduced models: input, refusals, limits, gaps, contrasts."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockwobble import fragility, reduced
from rockwobble.compare.runs.plan import options_of
from rockwobble.models import Case, Cylinder, Run, el_centro_1940, read_records, synthetic_motions
from rockwobble.studies import LIMITS, MEASURES, Fragility
from rockwobble.studies.fragility.runs import methods_of, own_model
from rockwobble.studies.fragility.study import fragility_of
from rockwobble.studies.fragility.tables import below_gaps, exceedance, incremental
from rockwobble.studies.plans import FragilityPlan

COLUMN = Cylinder(semidiagonal=3.0, tan_alpha=0.15)
LEVELS = (1.25, 1.6, 2.0, 2.5, 3.2, 4.0, 5.5, 8.0)
COUNT = len(LEVELS)
MOTIONS = synthetic_motions(12, peak=1.0, seed=4, duration=10.0)
NAN = math.nan
RECORDS = Path(__file__).parents[2] / "models" / "records"


@pytest.fixture(scope="module")
def study() -> Fragility:
    return fragility(COLUMN, MOTIONS, levels=LEVELS, resamples=60, workers=1)


def rows(study: Fragility, method: str) -> pd.DataFrame:
    return study.runs[study.runs["method"] == method].sort_values(["motion", "step"])


@pytest.mark.slow
def test_every_method_runs_under_the_same_motions(study):
    methods = list(dict.fromkeys(study.runs["method"]))
    assert methods == ["recess model", "flat-ground model", "planar x", "planar y", "worse plane"]
    assert len(study.runs) == 5 * 12 * COUNT
    assert len(study.points) == 12 * COUNT
    for _, part in study.points.groupby("step"):
        assert set(part["peak_acceleration"]) == {LEVELS[int(part["step"].iloc[0])]}
    # reproducible by a single run, here at a level that rocks in each plane and stands
    point = study.points[study.points["step"] == 3].iloc[0]
    motion = next(each for each in MOTIONS if each.name == point["motion"])
    models = {
        "flat-ground model": {"support": "flat"},
        "planar x": {"plane": 0.0},
        "planar y": {"plane": 0.5 * math.pi},
    }
    for name, options in models.items():
        alone = reduced.simulate(Case(COLUMN, motion.scaled(point["scale"])), rtol=1e-7, **options)
        own = rows(study, name)
        own = own[(own["motion"] == point["motion"]) & (own["step"] == point["step"])].iloc[0]
        assert own["outcome"] == alone.outcome == "stands", name
        assert own["peak_tilt"] == pytest.approx(alone.peak_tilt / COLUMN.alpha, abs=1e-12), name


@pytest.mark.slow
def test_runs_with_contact_forces_match_batch_kernel_peaks(study):
    # at the strongest level, where contact is lost
    options = {"methods": ["recess"], "levels": LEVELS[-1:], "resamples": 2, "workers": 1}
    whole = fragility(COLUMN, MOTIONS, limits=["contact_lost"], **options).runs.sort_values("motion")
    quick = rows(study, "recess model")
    quick = quick[quick["step"] == COUNT - 1]
    np.testing.assert_allclose(whole["peak_tilt"], quick["peak_tilt"], rtol=1e-12)
    assert study.runs["contact_lost"].isna().all()
    assert set(whole["contact_lost"]) <= {0.0, 1.0}
    lost = [
        bool(reduced.simulate(Case(COLUMN, m.scaled(s)), rtol=1e-7).assumptions.least_normal_force <= 0.0)
        for m in MOTIONS[:4]
        for s in study.points[(study.points["motion"] == m.name)]["scale"].iloc[-1:]
    ]
    own = whole.set_index("motion")["contact_lost"]
    assert [bool(own[motion.name]) for motion in MOTIONS[:4]] == lost


def test_worse_plane_peak_is_the_larger_of_both_planes(study):
    x, y, worse = (rows(study, name) for name in ("planar x", "planar y", "worse plane"))
    np.testing.assert_array_equal(
        worse["peak_tilt"], np.maximum(x["peak_tilt"].to_numpy(), y["peak_tilt"].to_numpy())
    )
    fell = (x["outcome"] == "overturned").to_numpy() | (y["outcome"] == "overturned").to_numpy()
    np.testing.assert_array_equal(worse["outcome"] == "overturned", fell)


def test_limit_exceedances_are_nested(study):
    counts = study.counts.pivot_table(index=["method", "intensity"], columns="limit", values="k")
    tilts = ["uplift", "0.1 alpha", "0.25 alpha", "0.5 alpha", "1 alpha", "overturned"]
    assert (np.diff(counts[tilts].to_numpy(), axis=1) <= 0).all()
    assert (study.counts["n"] == 12).all()
    total = study.runs.groupby("method")["outcome"].apply(lambda part: (part == "overturned").sum())
    fallen = study.counts[study.counts["limit"] == "overturned"].groupby("method")["k"].sum()
    assert fallen.to_dict() == total.to_dict()


def test_a_run_exceeds_the_limits_below_its_peak():
    table = pd.DataFrame(
        {
            "peak_tilt": [0.0, 1e-9, 0.5, 1.2, 8.0, NAN],
            "outcome": ["stands", "stands", "stands", "stands", "overturned", "failed"],
            "contact_lost": [0.0, 0.0, NAN, 1.0, 0.0, NAN],
        }
    )
    expected = {
        "uplift": [0, 1, 1, 1, 1, NAN],
        "0.5 alpha": [0, 0, 1, 1, 1, NAN],
        "1 alpha": [0, 0, 0, 1, 1, NAN],
        "overturned": [0, 0, 0, 0, 1, NAN],
        "contact_lost": [0, 0, NAN, 1, 1, NAN],
    }
    for limit, values in expected.items():
        np.testing.assert_array_equal(exceedance(table, limit), np.array(values, dtype=float))


def test_bodies_are_stated_with_their_sizes_only_if_several(study):
    (body,) = (each for each in study.findings() if each.key == "fragility.body")
    assert set(body.values) == {"name", "factor"}
    facts = {**study.facts, "cylinders": dict.fromkeys("ab", study.facts["cylinders"][body.runs])}
    several = Fragility(tables=study.tables, facts=facts).findings().to_frame()
    sizes = several[(several["key"] == "fragility.body") & (several["name"] == "length")]
    assert list(sizes["value"]) == [3.0, 3.0]


def test_gaps_are_hidden_by_stopping_at_the_first_overturning():
    y = np.array([[0, 1, 0, 1], [0, 0, 1, 1], [1, NAN, 0, 0], [0, NAN, 1, NAN], [1, 0, 1, 0]], dtype=float)
    gaps = below_gaps(y)
    assert gaps.astype(int).tolist() == [[0, 1, 0, 0], [0] * 4, [1, 0, 0, 0], [0] * 4, [1, 0, 1, 0]]
    stopped = incremental(y)
    expected = [[0, 1, 1, 1], [0, 0, 1, 1], [1, 1, 1, 1], [0, NAN, 1, 1], [1, 1, 1, 1]]
    np.testing.assert_array_equal(stopped, np.array(expected, dtype=float))


def test_stopping_at_the_first_overturning_lowers_the_median(study):
    some = study.gaps[study.gaps["runs_below_gaps"] > 0]
    assert len(some) >= 3
    assert (some["bias"] < 1.0).all()
    np.testing.assert_allclose(study.gaps["bias"], study.gaps["median_incremental"] / study.gaps["median"])


def test_curve_ends_at_the_levels_if_all_or_none_exceed(study):
    calm = study.runs.assign(peak_tilt=0.3, outcome="stands")
    limits = ["0.1 alpha", "1 alpha"]
    facts = {**study.facts, "limits": limits, "resamples": 2}
    curves = fragility_of(calm, study.points, facts).curves
    curves = curves[curves["method"] == "recess model"].set_index("limit")["intensity"]
    # all exceed the first limit, none the second; elsewhere a curve goes to half or twice the levels
    assert (curves["0.1 alpha"].min(), curves["0.1 alpha"].max()) == pytest.approx((LEVELS[0], 16.0))
    assert (curves["1 alpha"].min(), curves["1 alpha"].max()) == pytest.approx((0.625, LEVELS[-1]))
    assert (curves.groupby("limit").count() == 60).all()


def test_contrasts_are_ratios_of_fits_and_equivalent_for_identical_methods(study):
    medians = study.fits[study.fits["limit"] == "0.5 alpha"].set_index("method")["median"]
    pairs = study.contrasts[study.contrasts["limit"] == "0.5 alpha"]
    assert len(pairs) == 10
    for row in pairs.to_dict("records"):
        assert row["ratio"] == pytest.approx(medians[row["method"]] / medians[row["against"]], rel=1e-9)
        assert row["ratio_low"] <= row["ratio"] <= row["ratio_high"]
    twice = study.runs[study.runs["method"] == "recess model"]
    both = pd.concat([twice, twice.assign(method="the same")])
    same = fragility_of(both, study.points, study.facts).contrasts.set_index("limit")
    for limit in ("0.5 alpha", "1 alpha"):
        row = same.loc[limit]
        assert (row["ratio"], row["verdict"]) == (1.0, "within")
        assert np.isnan([row["ratio_low"], row["ratio_high"]]).all()
        assert row["within"] == 0.0


def test_failed_first_method_does_not_affect_other_methods(study: Fragility) -> None:
    runs = study.runs[study.runs["method"].isin(["recess model", "planar x"])].copy()
    runs.loc[runs["method"] == "recess model", ["outcome", "peak_tilt"]] = ["failed", NAN]
    assert set(fragility_of(runs, study.points, study.facts).fits["method"]) == {"planar x"}
    with pytest.raises(ValueError, match=rf"got {12 * COUNT} runs that all failed"):
        fragility_of(runs[runs["outcome"] == "failed"], study.points, study.facts)


def test_pairs_exclude_motions_that_failed_in_either_method(study):
    runs = study.runs[study.runs["method"].isin(["recess model", "planar x"])].copy()
    lost = (runs["method"] == "planar x") & (runs["motion"] == MOTIONS[0].name)
    runs.loc[lost, ["peak_tilt", "outcome"]] = [NAN, "failed"]
    whole = fragility_of(runs, study.points, study.facts)
    gone = runs["motion"] != MOTIONS[0].name
    fits = fragility_of(runs[gone], study.points[study.points["motion"] != MOTIONS[0].name], study.facts).fits
    medians = fits[fits["limit"] == "0.5 alpha"].set_index("method")["median"]
    row = whole.contrasts[whole.contrasts["limit"] == "0.5 alpha"].iloc[0]
    assert row["ratio"] == pytest.approx(medians["planar x"] / medians["recess model"], rel=1e-9)
    own = whole.fits[(whole.fits["method"] == "planar x") & (whole.fits["limit"] == "0.5 alpha")].iloc[0]
    assert (own["failed"], own["runs"]) == (COUNT, 11 * COUNT)


@pytest.mark.slow
@pytest.mark.parametrize("fate", [0, 1])
def test_bounds_contain_the_curve_had_failed_runs_ended(study: Fragility, fate: int) -> None:
    """Failed runs that overturn or stand: the result of all runs lies between the bounds."""
    method, other = study.runs["method"].unique()[:2]
    runs = study.runs.copy()
    over = runs["outcome"] == "overturned"
    lost = runs.index[(runs["method"] == method) & (over == bool(fate))][::3]
    assert len(lost) > 1
    runs.loc[lost, ["outcome", "peak_tilt"]] = ["failed", math.nan]
    broken = fragility_of(runs, study.points, study.facts)

    def of(table: pd.DataFrame, **values: str) -> pd.Series:
        keys = {"cylinder": table["cylinder"].iloc[0], "limit": "overturned", **values}
        return table[np.all([table[name] == value for name, value in keys.items()], axis=0)].iloc[0]

    whole, fit = of(study.fits, method=method), of(broken.fits, method=method)
    assert fit["failed"] == len(lost)
    assert fit["median_if_exceeded"] < whole["median"] * (1 + 1e-9)
    assert fit["median_if_not"] > whole["median"] * (1 - 1e-9)
    # outcome of the lost runs is the true one
    right = "median_if_exceeded" if fate else "median_if_not"
    assert fit[right] == pytest.approx(whole["median"], rel=1e-9)
    before = of(study.contrasts, method=other, against=method)
    after = of(broken.contrasts, method=other, against=method)
    assert before["ratio_least"] == before["ratio"] == before["ratio_most"]
    assert after["ratio_least"] < after["ratio_most"]
    assert after["ratio_most" if fate else "ratio_least"] == pytest.approx(before["ratio"], rel=1e-9)


@pytest.mark.slow
def test_mean_over_cylinders_is_geometric():
    bodies = {"column": COLUMN, "pier": Cylinder(semidiagonal=6.0, tan_alpha=0.2)}
    study = fragility(bodies, MOTIONS, methods=["recess", "planar-x"], levels=LEVELS, resamples=20, workers=1)
    pairs = study.contrasts[study.contrasts["limit"] == "0.5 alpha"].set_index("cylinder")["ratio"]
    assert pairs["all"] == pytest.approx(math.sqrt(pairs["column"] * pairs["pier"]), rel=1e-12)


def test_most_efficient_measure_has_the_least_dispersion(study):
    table = study.efficiency
    best = table[table["best"]].iloc[0]
    assert best["dispersion"] == table["dispersion"].min()
    assert best["over_best"] == 1.0
    assert np.isnan(best["over_best_low"])
    # with one cylinder p and g tan(alpha) are constant: levels' measure, fitted both ways
    own = table[table["measure"] == "peak_acceleration"].iloc[0]
    fit = study.fits[(study.fits["method"] == "recess model") & (study.fits["limit"] == "overturned")].iloc[0]
    assert own["dispersion"] == pytest.approx(fit["dispersion"], rel=1e-9)


def test_cloud_uses_motions_at_the_given_scales():
    motions = [motion.scaled(2.0 + 0.4 * place) for place, motion in enumerate(MOTIONS)]
    study = fragility(COLUMN, motions, methods=["recess"], scales=[1.0, 2.0], resamples=20, workers=1)
    assert (study.counts["n"] == 1).all()
    assert study.points["scale"].tolist() == [1.0, 2.0] * 12
    fit = study.fits[study.fits["limit"] == "0.5 alpha"].iloc[0]
    assert (fit["kind"], fit["runs"]) == ("fitted", 24)


def test_bodies_unsupported_by_the_batch_kernel_are_simulated_singly():
    hollow = Cylinder(semidiagonal=3.0, tan_alpha=0.15, transverse_inertia=4.0)
    study = fragility(hollow, MOTIONS[:3], methods=["recess"], levels=[3.0], resamples=5, workers=1)
    point = study.points.iloc[0]
    alone = reduced.simulate(Case(hollow, MOTIONS[0].scaled(point["scale"])), rtol=1e-7)
    assert study.runs["peak_tilt"].iloc[0] == pytest.approx(alone.peak_tilt / hollow.alpha, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(("motions", "levels", "few"), [(5, 3, True), (6, 1, True), (6, 2, False)])
def test_too_few_motions_or_levels_give_counts_without_curve(motions: int, levels: int, few: bool) -> None:
    options = {"methods": ["recess", "planar-x"], "resamples": 20, "workers": 1}
    made = fragility(COLUMN, MOTIONS[:motions], levels=LEVELS[3 : 3 + levels], **options)
    overturned = made.fits[made.fits["limit"] == "overturned"]
    assert overturned["runs"].to_list() == [motions * levels] * 2
    assert (overturned["exceeded"].sum() == made.counts.query("limit == 'overturned'")["k"].sum()) > 0
    fitted = made.fits[["median", "median_low", "median_high", "dispersion"]].notna().to_numpy().any()
    stated = [fitted, *(len(getattr(made, name)) > 0 for name in ("curves", "contrasts", "gaps"))]
    assert stated == [not few] * 4


@pytest.mark.slow
def test_engine_runs_beside_its_model_and_ring_wall_holds_overturned_cylinder():
    runs = [Run("mujoco", "recess"), Run("mujoco", "ring", ring_clearance=0.01, ring_inclination=0.5)]
    study = fragility(
        COLUMN,
        [MOTIONS[0], MOTIONS[2]],
        methods=["recess", *runs],
        levels=[12.0],
        step_factor=8.0,
        friction=3.0,
        resamples=5,
        workers=1,
    )
    strong = study.runs
    assert (strong["outcome"] == "overturned").all()
    ring = strong[strong["method"] == "mujoco ring"]
    assert (ring["peak_tilt"] > 1.0).all()
    assert (ring["peak_tilt"] < 0.5 * math.pi / COLUMN.alpha).all()
    assert study.facts["methods"]["mujoco ring"]["own_model"] == ""
    assert study.facts["methods"]["mujoco recess"]["own_model"] == "recess model"


def test_methods_are_selected_by_name():
    methods = methods_of(["worse-plane", "recess", Run("mujoco", "flat"), "flat"], restitution="momentum")
    labels = ["planar x", "planar y", "worse plane", "recess model", "mujoco flat", "flat-ground model"]
    assert [each.label for each in methods] == labels
    assert [each.support for each in methods] == ["planar", "planar", "planar", "recess", "flat", "flat"]
    assert methods[0].run == Run(None, "recess", plane=0.0, restitution="momentum")
    assert own_model(methods[4], methods) == "flat-ground model"
    assert [each.label for each in methods_of(["recess", "recess"])] == ["recess model"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"methods": ["planar"]}, "a reduced model must be one of recess, flat"),
        ({"methods": [Run("mujoco", "recess"), Run("mujoco", "recess")]}, "must differ"),
        ({"limits": ["2 alpha"]}, "limits must be one of uplift"),
        ({"margin": 0.0}, "margin must be above 0, got 0.0"),
        ({"restitution": 0.9, "methods": ["recess"]}, "restitution is of planar models, got 0.9"),
        ({"step_factor": 2.0, "methods": ["recess"]}, "step_factor is for engines at their default"),
        (
            {"step_factor": 2.0, "methods": [Run("mujoco", "recess", 1e-4)]},
            "step_factor is for engines at their default",
        ),
    ],
)
def test_bad_input(options, words):
    with pytest.raises(ValueError, match=words):
        fragility(COLUMN, MOTIONS, **{"workers": 1, "levels": None, **options})


def test_plan_accepts_every_measure_and_limit() -> None:
    stated = options_of(FragilityPlan)
    assert (stated["measure"].choices, stated["limits"].choices) == (tuple(MEASURES), tuple(LIMITS))


def test_motions_and_cylinders_without_distinct_names_are_refused():
    with pytest.raises(ValueError, match="at least two ground motions with different names, got 2 with 1"):
        fragility(COLUMN, [el_centro_1940()] * 2, levels=[1.0])
    with pytest.raises(ValueError, match="need names"):
        fragility([COLUMN, COLUMN], MOTIONS)


def test_folder_of_records_with_table_is_read(tmp_path):
    for name in ("RSN6_IMPVALL.I_I-ELC270-hor2.AT2", "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"):
        (tmp_path / name).write_bytes((RECORDS / name).read_bytes())
    east, north = "RSN6_IMPVALL.I_I-ELC270-hor2.AT2", "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"
    table = tmp_path / "records.csv"
    table.write_text(f"name,x,y,scale\nas it is,{east},{north},\ndoubled,{east},{north},2\n")
    one, two = read_records(tmp_path)
    assert (one.name, two.name) == ("as it is", "doubled")
    np.testing.assert_array_equal(one.acceleration, el_centro_1940().acceleration)
    assert two.peak == pytest.approx(2.0 * one.peak)
    for text, words in (
        ("x,north\n", "must have the columns x and y"),
        (f"x,y\n{east},\n", "line 2: both horizontal components"),
        (f"x,y,scale\n{east},{north},-1\n", "line 2: scale must be a positive number, got '-1'"),
        (f"x,y\n\n{east},none.AT2\n", "line 3: cannot read the record"),
        (f"x,y,name,scale\n{east},{north},El Centro, 1940,2\n", "line 2: must have 4 cells, got 5"),
        ("x,y\n", "must list ground motions, one in a line, got none"),
    ):
        table.write_text(text)
        with pytest.raises(ValueError, match=words):
            read_records(tmp_path)
    with pytest.raises(ValueError, match="cannot be read"):
        read_records(tmp_path / "nowhere.csv")
