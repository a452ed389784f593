from __future__ import annotations

import dataclasses
import itertools
import math
import sys

import pandas as pd
import pytest

from rockwobble import ensemble, reduced, sweep
from rockwobble.compare.runs.execution import Job
from rockwobble.models import (
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    Run,
    Suite,
    Tendon,
    Trace,
    far_field_motions,
)
from rockwobble.models.records import p695
from rockwobble.studies.ensemble import Ensemble, ensemble_of

ENSEMBLE = sys.modules[Ensemble.__module__]

ROUNDING = 1e-12
RECESS = Run(None, "recess")
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
CASE = Case(PIER, initial=InitialState(0.1, rolling_rate=0.5), duration=1.0, name="release")


@pytest.mark.slow
def test_leaning_on_a_wall_beyond_balance_counts_as_overturned():
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    cases = [
        Case(cylinder, initial=InitialState(share * cylinder.alpha), duration=3.0, name=f"{share}")
        for share in (0.5, 1.3, 1.4)
    ]
    run = Run("mujoco", "ring", time_step=1e-3, ring_clearance=0.01, ring_inclination=0.5)
    study = ensemble(cases, runs=[run], models=[], workers=1)
    assert study.members["outcome"].tolist()[1:] == ["overturned", "overturned"]
    assert (study.members["peak_tilt"] < 0.5 * math.pi / cylinder.alpha).all()
    swept = sweep(Suite(cases, [run]), workers=1).table
    assert swept["outcome"].tolist() == study.members["outcome"].tolist()


def test_members_whose_tendon_yields_have_no_answer():
    tied = [Tendon(prestress=0.5, stiffness=2.0, yield_force=force) for force in (0.51, 9.0)]
    cases = [dataclasses.replace(CASE, tendon=tendon, name=f"{tendon.yield_force}") for tendon in tied]
    made = ensemble(cases, models=[RECESS], runs=[], workers=1)
    assert made.members["outcome"].tolist() == ["undecided", "stands"]
    assert made.members["peak_tilt"].isna().tolist() == [True, False]
    assert made.methods["failed_members"].tolist() == ["0.51"]
    assert "ensemble.failed" in {finding.key for finding in made.findings()}


def test_ring_run_is_compared_with_the_recess_model(monkeypatch):
    monkeypatch.setattr(ENSEMBLE, "run_job", lambda job: made_up(job, job.case.initial.tilt))
    runs = [Run("mujoco", support) for support in ("recess", "flat", "ring")]
    methods = ensemble(CASE, runs=runs, copies=2, workers=1).methods.set_index("method")
    assert methods["own_model"].to_dict() == {
        "recess model": "",
        "flat-ground model": "",
        "mujoco recess": "recess model",
        "mujoco flat": "flat-ground model",
        "mujoco ring": "recess model",
    }


def made_up(job: Job, peak: float, outcome: str = "stands") -> Trace:
    """Run replaced by one with another peak and outcome."""
    return dataclasses.replace(reduced.simulate(job.case, sample_step=1.0), peak_tilt=peak, outcome=outcome)


def test_failed_runs_are_counted_named_and_excluded_from_statistics(monkeypatch):
    def simulate(job: Job) -> Trace:
        if job.label == "flat-ground model" and job.case.name.endswith("#2"):
            return made_up(job, math.nan, "failed")
        return made_up(job, job.case.initial.tilt)

    monkeypatch.setattr(ENSEMBLE, "run_job", simulate)
    study = ensemble(CASE, runs=[], copies=7, workers=1)
    methods = study.methods.set_index("method")
    assert methods["failed"].to_dict() == {"recess model": 0, "flat-ground model": 1}
    assert methods.loc["flat-ground model", "failed_members"] == "release #2"
    assert len(study.members) == 14
    # six equal members; failed runs are excluded from counts and quantiles
    pairs = ["count", "compared", "ratio", "masked"]
    assert study.contrasts.loc[0, pairs].tolist() == [6, 6, 1.0, "release #2"]
    assert methods.loc["flat-ground model", ["runs", "uplifted", "overturned"]].tolist() == [7, 6, 0]
    assert math.isfinite(methods.loc["flat-ground model", "peak_median"])
    # fourth member failed on the way: no peak
    members = study.members[study.members["member"].str[-1].astype(int) < 5].reset_index(drop=True)
    members.loc[members["method"] == "recess model", "outcome"] = ["overturned"] * 2 + ["stands", "failed"]
    members.loc[members["member"] == "release #2", "outcome"] = "overturned"
    members.loc[members["member"].str[-1].astype(int) < 3, "peak_tilt"] = 8.0
    for labels in (["recess model", "flat-ground model"], ["flat-ground model", "recess model"]):
        again = ensemble_of(members, {**study.facts, "methods": dict.fromkeys(labels, "")})
        assert again.contrasts.loc[0, ["count", "masked"]].tolist() == [3, "release #4"]
        row = again.methods.set_index("method").loc["recess model"]
        assert row[["runs", "uplifted", "overturned", "failed"]].tolist() == [4, 3, 2, 1]


def test_member_outcome_and_peak_equal_its_single_run(monkeypatch):
    cases = [dataclasses.replace(CASE, name=name) for name in "abcdef"]
    # past its balance at the end: outcome depends on the method
    runs = {
        "recess model": made_up(Job(case=cases[0], run=RECESS), 1.5 * PIER.alpha),
        "flat-ground model": made_up(Job(case=cases[0], run=RECESS), 0.5 * math.pi, "overturned"),
    }
    monkeypatch.setattr(ENSEMBLE, "run_job", lambda job: runs[job.label])
    study = ensemble(cases, runs=[], workers=1)
    for method, run in runs.items():
        rows = study.members[study.members["method"] == method]
        assert rows["outcome"].tolist() == [run.outcome] * 6
        assert rows["peak_tilt"].tolist() == pytest.approx([run.peak_tilt / PIER.alpha] * 6, abs=ROUNDING)
    assert study.methods["overturned"].tolist() == [0, 6]
    assert study.methods["peak_median"].tolist() == [pytest.approx(1.5, abs=ROUNDING), math.inf]


def test_members_are_paired_by_name_and_not_by_row(monkeypatch):
    monkeypatch.setattr(ENSEMBLE, "run_job", lambda job: made_up(job, job.case.initial.tilt))
    study = ensemble(CASE, runs=[], copies=8, workers=1)
    shuffled = study.members.sample(frac=1.0, random_state=1)
    assert ensemble_of(shuffled, study.facts).contrasts.loc[0, "ratio_95_low"] == 1.0
    with pytest.raises(ValueError, match="one run by each method"):
        ensemble_of(pd.concat([study.members, study.members[:1]]), study.facts)


def test_bounds_contain_the_result_had_failed_runs_finished(monkeypatch):
    monkeypatch.setattr(ENSEMBLE, "run_job", lambda job: made_up(job, job.case.initial.tilt))
    study = ensemble(CASE, runs=[], copies=9, perturbation=0.05, workers=1)
    whole = study.methods.set_index("method")
    assert (whole["peak_median_least"] == whole["peak_median"]).all()
    failed = study.members.copy()
    lost = failed.index[failed["method"] == "flat-ground model"][[1, 4]]
    failed.loc[lost, "outcome"] = "failed"
    bounds = ensemble_of(failed, study.facts)
    median, ratio = bounds.methods.set_index("method").loc["flat-ground model"], bounds.contrasts.loc[0]
    assert ratio["ratio_least"] <= ratio["ratio"] <= ratio["ratio_most"]
    told = []
    for fates in itertools.product(("overturned", "stands"), repeat=2):
        known = study.members.copy()
        known.loc[lost, "outcome"] = fates
        known.loc[lost, "peak_tilt"] = [math.pi if fate == "overturned" else 1e-9 for fate in fates]
        again = ensemble_of(known, study.facts)
        told.append(
            (
                again.methods.set_index("method").loc["flat-ground model", "peak_median"],
                again.contrasts.loc[0],
            )
        )
        assert median["peak_median_least"] <= told[-1][0] <= median["peak_median_most"]
        assert ratio["ratio_least"] <= told[-1][1]["ratio"] <= ratio["ratio_most"]
    assert told[0][0] == median["peak_median_most"]
    assert told[-1][0] == median["peak_median_least"]
    assert {told[0][1]["ratio"], told[-1][1]["ratio"]} == {ratio["ratio_least"], ratio["ratio_most"]}


def test_every_input_is_in_the_hash_of_an_ensemble():
    hashes = [
        ensemble(CASE, runs=[], workers=1, **options).facts["inputs"]
        for options in (
            {"copies": 2},
            {"copies": 3},
            {"copies": 2, "seed": 1},
            {"copies": 2, "models": [RECESS]},
        )
    ]
    assert len(set(hashes)) == 4


def test_far_field_motions_have_the_stated_peak_and_distinct_names(monkeypatch):
    def pair(number: int) -> GroundMotion:
        return GroundMotion([[0.0, 0.0], [float(number), 0.0]], 0.01, f"pair {number}")

    monkeypatch.setattr(p695, "p695_far_field", pair)
    motions = far_field_motions(peak=3.0)
    assert [motion.peak for motion in motions] == pytest.approx([3.0] * 22, abs=ROUNDING)
    assert [motion.name for motion in motions] == [f"pair {number}" for number in range(1, 23)]
    with pytest.raises(ValueError, match="peak must be positive"):
        far_field_motions(peak=-1.0)
