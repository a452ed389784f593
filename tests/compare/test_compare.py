from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest

from rockwobble import comparison, simulate
from rockwobble.compare import SUMMARY_COLUMNS
from rockwobble.compare.comparison import driver
from rockwobble.compare.comparison.prediction import close_pass
from rockwobble.compare.comparison.summary import summary_row
from rockwobble.compare.runs import execution
from rockwobble.compare.runs.execution import Job, simulate_run
from rockwobble.compare.storage.manifest import read_manifests
from rockwobble.models import Case, Cylinder, Diagnostic, GroundMotion, InitialState, Run, Suite
from rockwobble.models.trace import lost_trace

ROUNDING = 1e-12

CONTRACT = [
    "case",
    "engine",
    "support",
    "reference_engine",
    "reference_support",
    "time_step",
    "outcome",
    "reference_outcome",
    "diagnostics",
    "peak_tilt",
    "reference_peak_tilt",
    "peak_tilt_difference",
    "tilt_rms",
    "tilt_rms_relative",
    "contact_rms",
    "turn_difference",
    "uplift_time_difference",
    "uplift_direction_difference",
    "agreement_time",
    "diverged",
    "agreed_passes",
    "predicted_agreement_time",
    "displacement_difference",
    "residual_displacement",
    "residual_twist",
    "energy_loss",
    "wall_time",
    "time_ratio",
]


@pytest.fixture
def case(cylinder):
    ground = GroundMotion(np.zeros((2, 2)), 10.0, "still")
    return Case(cylinder, ground, initial=InitialState(tilt=0.3 * cylinder.alpha), name="synthetic")


@pytest.fixture
def made_up(monkeypatch, cylinder, make_trace):
    """Traces in place of simulations, with given fields of the engine's and of the model's trace."""
    time = np.arange(1001) * 0.01
    tilt = 0.3 * cylinder.alpha * np.ones_like(time)

    def use(engine=None, model=None):
        def run_job(job: Job):
            fields = {"case": job.case, "run": job.run}
            if job.run.is_model:
                offset = 0.002 if job.run.support == "flat" else 0.0
                fields |= {"passes": [(3.0, 1e-5)], "wall_time": 0.5} | (model or {})
            else:
                offset = 0.005 * cylinder.alpha
                fields |= {
                    "time_step": job.run.time_step or 1e-4,
                    "wall_time": 2.0,
                    "contact_resolution": 2e-5,
                    "residual_displacement": 0.5 * cylinder.base_radius,
                    "twist": np.full_like(time, math.radians(3.0)),
                } | (engine or {})
            return make_trace(time, fields.pop("tilt", tilt + offset), **fields)

        monkeypatch.setattr(execution, "run_job", run_job)

    return use


def test_columns_have_the_names_and_order_of_the_contract(made_up, case):
    made_up()
    summary = comparison(case, runs=[Run("mujoco", "recess")], workers=1).summary
    assert list(summary.columns[: len(CONTRACT)]) == CONTRACT
    assert list(summary.columns) == list(SUMMARY_COLUMNS)


def test_every_value_of_a_row_has_its_column(case):
    trace = simulate(case)
    given = summary_row(case, "a", trace, "b", trace, prediction=close_pass(trace, 1e-5, case.length))
    assert set(given) == set(SUMMARY_COLUMNS)


def test_numbers_of_a_row_follow_from_its_traces(made_up, case, cylinder):
    made_up()
    row = comparison(case, runs=[Run("mujoco", "recess", 1e-3)], workers=1).summary.iloc[0]
    assert (row.case, row.engine, row.support) == ("synthetic", "mujoco", "recess")
    assert (row.reference_engine, row.reference_support) == ("reduced", "recess")
    assert row.time_step == 1e-3
    assert row.peak_tilt == pytest.approx(0.305, rel=ROUNDING)
    assert row.reference_peak_tilt == pytest.approx(0.3, rel=ROUNDING)
    assert row.peak_tilt_difference == pytest.approx(0.005, rel=1e-9)
    assert row.tilt_rms == pytest.approx(0.005, rel=1e-9)
    assert row.tilt_rms_relative == pytest.approx(0.005 / 0.3, rel=1e-9)
    assert (row.agreement_time, row.diverged, row.agreed_passes) == (10.0, False, 1)
    assert row.predicted_agreement_time == 3.0
    assert row.residual_displacement == pytest.approx(0.5, rel=ROUNDING)
    assert row.residual_twist == pytest.approx(3.0, rel=ROUNDING)
    assert row.time_ratio == 4.0
    assert row.diagnostics == ""


def test_a_suite_is_cases_times_runs_with_a_row_for_each_reference(made_up, case, cylinder, monkeypatch):
    made_up()
    # no engine runs, so none needs to be installed: PyBullet is not everywhere
    monkeypatch.setattr(driver, "require_runnable", lambda case, run: None)
    other = Case(cylinder, case.motion, name="second")
    results = comparison(Suite([case, other], [Run("mujoco", "recess"), Run("pybullet", "flat")]), workers=1)
    rows = [("mujoco", "recess", "recess"), ("pybullet", "flat", "recess"), ("pybullet", "flat", "flat")]
    expected = [(name, *row) for name in ("synthetic", "second") for row in rows]
    columns = ["case", "engine", "support", "reference_support"]
    assert [*results.summary[columns].itertuples(index=False, name=None)] == expected
    labels = ("recess model", "flat-ground model", "mujoco recess", "pybullet flat")
    assert set(results.traces) == {(name, label) for name in ("synthetic", "second") for label in labels}
    assert not results.summary.diverged.any()


def test_a_window_affects_only_the_rms(made_up, case, cylinder):
    time = np.arange(1001) * 0.01
    tilt = (0.3 + np.where(time > 5.0, 0.1, 0.0)) * cylinder.alpha
    made_up(engine={"tilt": tilt})
    row = comparison(case, runs=[Run("mujoco", "recess")], workers=1, until=5.0).summary.iloc[0]
    assert row.tilt_rms == 0.0
    assert row.contact_rms == 0.0
    assert row.diverged
    assert row.agreement_time == pytest.approx(5.01)


def test_two_motions_at_rest_agree(made_up, case):
    still = {"tilt": np.zeros(1001), "uplift_time": math.nan, "uplift_direction": math.nan, "rests": True}
    made_up(still, still)
    row = comparison(case, runs=[Run("mujoco", "recess")], workers=1).summary.iloc[0]
    assert (row.tilt_rms, row.diverged, row.agreement_time) == (0.0, False, 10.0)
    assert math.isnan(row.uplift_time_difference)


def test_a_run_that_fails_half_way_is_compared_until_then(made_up, case, cylinder):
    tilt = np.where(np.arange(1001) > 400, np.nan, 0.3 * cylinder.alpha)
    facts = (Diagnostic(code="not_finite", time=4.01), *[Diagnostic(code="slip", time=2.0)] * 2)
    failed = {"tilt": tilt, "outcome": "failed", "facts": facts, "peak_tilt": math.nan}
    made_up(failed, {"outcome": "overturned"})
    row = comparison(case, runs=[Run("mujoco", "recess")], workers=1).summary.iloc[0]
    assert (row.outcome, row.reference_outcome) == ("failed", "overturned")
    assert row.diagnostics == "not_finite, slip"
    assert math.isnan(row.peak_tilt)
    assert row.tilt_rms == 0.0
    assert (row.agreement_time, row.diverged) == (4.0, True)


def test_a_run_without_samples_is_a_failed_row(monkeypatch, made_up, case):
    made_up()
    run_job = execution.run_job

    def dying(job: Job):
        return run_job(job) if job.run.is_model else lost_trace(job.case, job.run, "status -11")

    monkeypatch.setattr(execution, "run_job", dying)
    row = comparison(case, runs=[Run("mujoco", "recess")], workers=1).summary.iloc[0]
    assert (row.outcome, row.diverged, row.diagnostics) == ("failed", True, "died")
    assert row.reference_peak_tilt == pytest.approx(0.3)
    assert math.isnan(row.tilt_rms)


def test_files_hold_the_whole_result(made_up, case, tmp_path):
    made_up()
    results = comparison(case, runs=[Run("mujoco", "recess"), Run("mujoco", "flat")], workers=1, out=tmp_path)
    (manifest,) = read_manifests(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"manifest.json", *manifest.files, *manifest.pages}
    assert {"summary.parquet", "summary.csv", "traces.parquet", "passes.parquet"} <= set(manifest.files)
    summary = pd.read_csv(tmp_path / "summary.csv", keep_default_na=False, na_values=["nan"])
    assert list(summary.columns) == list(SUMMARY_COLUMNS)
    # the default parser of older pandas is off by a rounding
    assert summary.tilt_rms.tolist() == pytest.approx(results.summary.tilt_rms.tolist(), rel=ROUNDING)
    samples = pd.read_parquet(tmp_path / "traces.parquet")
    assert samples.groupby("run").size().to_dict() == dict.fromkeys(
        ["recess model", "flat-ground model", "mujoco recess", "mujoco flat"], 1001
    )
    assert list(pd.read_parquet(tmp_path / "passes.parquet").columns[:2]) == ["case", "run"]
    assert manifest.versions["mujoco"]


def test_bad_folders_and_windows_are_refused_before_anything_runs(monkeypatch, case, tmp_path):
    monkeypatch.setattr(execution, "run_job", lambda _: pytest.fail("it ran"))
    (tmp_path / "taken").write_text("")
    (tmp_path / "manifest.json").write_text('{"name": "app"}')
    for words, bad in (
        ("must be a folder", {"out": tmp_path / "taken"}),
        (r"output folder must have no manifest\.json but one of rockwobble", {"out": tmp_path}),
        *((r"until must be positive \[s\], got ", {"until": until}) for until in (0.0, -1.0, math.nan)),
    ):
        with pytest.raises(ValueError, match=words):
            comparison(case, runs=[Run("mujoco", "recess")], workers=1, **bad)


@pytest.mark.parametrize(
    ("run", "reference"),
    [
        (Run(None, "recess", rtol=1e-3), None),
        (Run(None, "recess", plane=0.0), Run(None, "recess", plane=1.5)),
        (Run("mujoco", "recess", 1e-3), Run("mujoco", "recess", 5e-4)),
        (Run("mujoco", "recess", 1e-3), Run(None, "recess", rtol=1e-3)),
    ],
)
def test_no_run_is_compared_with_itself(cylinder: Cylinder, run: Run, reference: Run | None) -> None:
    pushed = Case(cylinder, GroundMotion([[3.0, 1.0], [3.0, 1.0]], 0.5, "push"))
    results = comparison(pushed, runs=[run], reference=reference, workers=1)
    (row,) = results.summary.to_dict("records")
    assert row["run"] != row["reference"]
    for label, wanted in ((row["run"], run), (row["reference"], reference or Run(None, "recess"))):
        assert results.traces["push", label].peak_tilt == simulate_run(pushed, wanted).peak_tilt
    assert row["peak_tilt_difference"] != 0.0
