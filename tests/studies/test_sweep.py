from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest

from rockwobble import reduced, sweep
from rockwobble.compare import IncompleteError, Progress
from rockwobble.compare.runs.progress import FailedTask
from rockwobble.compare.runs.scheduler import ClusterError
from rockwobble.compare.storage.claim import CACHE
from rockwobble.compare.storage.manifest import read_results
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run, Suite, el_centro_1940
from rockwobble.studies import Grid, Sweep, study
from rockwobble.studies.sweep import KIND

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
STANDING = Case(PIER, duration=1.0, name="a")
SIZES, SCALES = [0.5, 2.0, 6.0, 20.0], [0.4, 1.0, 2.5, 6.0, 8.0]
SHORT = GroundMotion(el_centro_1940().acceleration[:500], el_centro_1940().time_step, "short")


def grid(**changes) -> Grid:
    given = {"semidiagonals": SIZES, "tan_alphas": [0.1, 0.2], "scales": SCALES, "motions": [SHORT]}
    return Grid(**(given | changes))


def files(folder) -> dict[str, int]:
    return {path.name: path.stat().st_ino for path in (folder / CACHE / KIND).glob("*.parquet")}


def test_the_sweep_table_equals_peak_tilts_in_axis_order():
    table = sweep(grid(models=["recess", "planar"]), workers=1).table
    assert len(table) == 2 * 2 * 4 * 5
    cells = table.set_index(["model", "tan_alpha"])["peak_tilt"]
    for model in ("recess", "planar"):
        for tan_alpha in (0.1, 0.2):
            peaks = reduced.peak_tilts(SIZES, tan_alpha, SHORT, SCALES, **reduced.MODELS[model])
            assert np.array_equal(cells.loc[(model, tan_alpha)].to_numpy(), peaks.ravel())
    one = table[(table.model == "recess") & (table.semidiagonal == 2.0) & (table.tan_alpha == 0.2)]
    assert one["scale"].tolist() == SCALES
    assert np.array_equal(one.peak_tilt_over_alpha, one.peak_tilt / math.atan(0.2))
    expected = np.where(table.peak_tilt == 0.5 * math.pi, "overturned", "stands")
    assert table.outcome.tolist() == expected.tolist()
    assert 0 < (expected == "stands").sum() - (table.peak_tilt == 0.0).sum() < len(table)


@pytest.mark.slow
def test_no_cell_depends_on_chunks_workers_or_neighbours(tmp_path):
    whole = sweep(grid(), workers=1).table
    for options in ({"chunk_size": 1}, {"chunk_size": 3}, {"chunk_size": 7, "out": tmp_path, "workers": 2}):
        pd.testing.assert_frame_equal(
            sweep(grid(), **({"workers": 1} | options)).table, whole, check_exact=True
        )


def test_enlarged_grid_reuses_finished_chunks(tmp_path):
    sweep(grid(tan_alphas=[0.2]), out=tmp_path, workers=1, chunk_size=5)
    before = set(files(tmp_path).values())
    events = []
    table = sweep(grid(), out=tmp_path, workers=1, chunk_size=5, progress=events.append).table
    assert (events[0].found, events[0].total) == (4, 8)
    assert before < set(files(tmp_path).values())
    pd.testing.assert_frame_equal(table, sweep(grid(), workers=1).table, check_exact=True)
    pd.testing.assert_frame_equal(table, Sweep.load(tmp_path).table, check_exact=True)


def test_sweep_error_names_dead_task_and_kept_chunks(tmp_path, monkeypatch):
    run_tasks = study.run_tasks

    def losing(*args, **options):
        assert options["tries"] == 3
        return [FailedTask("killed"), *run_tasks(*args, **options)[1:]]

    def gone(*args, **options):
        raise ClusterError("the Dask scheduler does not answer any more")

    for run, words in (
        (losing, r"1 of 8 chunks ended their processes 3 times.*killed"),
        (gone, f"any more; 8 chunks are kept in {tmp_path}$"),
    ):
        monkeypatch.setattr(study, "run_tasks", run)
        with pytest.raises(IncompleteError, match=words):
            sweep(grid(), chunk_size=5, out=tmp_path, workers=1)
    assert len(files(tmp_path)) == 8
    with pytest.raises(ValueError, match="does not hold results"):
        Sweep.load(tmp_path)


def test_chunk_key_depends_on_every_input():
    base = next(grid().chunks()).key()
    others = [
        grid(semidiagonals=SIZES[1:]),
        grid(tan_alphas=[0.15]),
        grid(scales=SCALES[:4]),
        grid(motions=[GroundMotion(SHORT.acceleration * 1.1, SHORT.time_step, "short")]),
        grid(motions=[GroundMotion(SHORT.acceleration, 0.011, "short")]),
        grid(motions=[GroundMotion(SHORT.acceleration, SHORT.time_step, "renamed")]),
        grid(models=["flat"]),
        grid(rtol=1e-8),
        grid(rest_tilt=1e-6),
        grid(gravity=9.8),
    ]
    keys = [next(other.chunks()).key() for other in others]
    assert len({base, *keys}) == 1 + len(others)
    assert base == next(grid().chunks()).key()


def test_suite_of_engines_and_models_is_swept():
    cases = [
        Case(PIER, initial=InitialState(tilt * PIER.alpha, rolling_rate=0.5), duration=0.5, name=f"{tilt:g}")
        for tilt in (0.3, 0.5)
    ]
    in_recess = Run("mujoco", "recess", 1e-3)
    events: list[Progress] = []
    suite = Suite(cases, [Run(None, "recess"), in_recess])
    table = sweep(suite, workers=1, chunk_size=2, progress=events.append).table
    assert table["case"].tolist() == ["0.3", "0.5"] * 2
    runs = ["recess model", "mujoco recess"]
    assert table["run"].tolist() == [runs[0], runs[0], runs[1], runs[1]]
    assert {event.label for event in events} == {f"0.3, {run} and 1 more" for run in runs}
    assert table.peak_tilt_over_alpha.tolist() == pytest.approx([0.3, 0.5, 0.3, 0.5], rel=1e-3)
    again = sweep(Suite(cases, [in_recess]), workers=1).table
    pd.testing.assert_frame_equal(again, table.tail(2).reset_index(drop=True), check_exact=True)


def test_manifest_and_summary_describe_the_sweep(tmp_path):
    swept = sweep(grid(), out=tmp_path, workers=1)
    made = read_results(tmp_path, KIND).manifest
    assert made.headline == {"runs": 40, **swept.table["outcome"].value_counts().to_dict()}
    assert (made.about["semidiagonals"], made.about["runs"]) == (SIZES, 40)
    assert swept.facts == made.about
    motions = read_results(tmp_path, KIND).table("motions")
    assert np.array_equal(motions[["acceleration_x", "acceleration_y"]], SHORT.acceleration)
    assert motions["acceleration_z"].isna().all()
    summary = swept.summary()
    assert list(summary["tan_alpha"]) == [0.1, 0.2]
    for (_, row), (_, own) in zip(summary.iterrows(), swept.table.groupby("tan_alpha"), strict=True):
        counts = own["outcome"].value_counts().reindex(swept.outcomes, fill_value=0)
        assert row[swept.outcomes].to_dict() == counts.to_dict()
        fell = own["outcome"] == "overturned"
        # an overturned run ranks as infinite
        assert row["median"] == own["peak_tilt_over_alpha"].where(~fell, math.inf).median()
        assert row["largest"] == own.loc[~fell, "peak_tilt_over_alpha"].max()
    pd.testing.assert_frame_equal(Sweep.load(tmp_path).summary(), summary, check_exact=True)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: grid(semidiagonals=[]), "semidiagonals must hold at least one"),
        (lambda: grid(semidiagonals=[0.0]), "semidiagonals must be above zero"),
        (lambda: grid(scales=[-1.0]), "scales must be a sequence of finite numbers, none negative"),
        (lambda: grid(scales=[1.0, 1.0]), "scales must differ, got 1.0 twice"),
        (lambda: grid(tan_alphas=[math.nan]), "tan_alphas must be a sequence of finite numbers"),
        (lambda: grid(motions=[SHORT, SHORT]), "motions must differ, got 'short' twice"),
        (lambda: grid(models=["glued"]), "must be one of recess, flat, planar, got 'glued'"),
        (lambda: grid(rtol=1.0), "rtol must be from"),
        (lambda: sweep([]), "at least one case"),
        (lambda: sweep([STANDING, STANDING]), "got 'a' twice"),
        (lambda: sweep(Suite([STANDING], [Run(None, "recess")] * 2)), "got 'recess model' twice"),
        (lambda: sweep(Suite([STANDING], [Run("mujoco", "glued")])), "got 'glued'"),
        (lambda: sweep(grid(), chunk_size=0), "chunk_size must be a whole number, at least 1"),
        (
            lambda: grid(semidiagonals=[*range(1, 20_001)], scales=[*range(20_000)]),
            "at most 100,000,000 runs",
        ),
        (lambda: Sweep.load("/"), "does not hold results"),
    ],
)
def test_bad_input_gets_one_clear_line(make, words):
    with pytest.raises(ValueError, match=words):
        make()
