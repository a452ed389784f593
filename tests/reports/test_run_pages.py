"""Pages of single runs and sweeps: statements, and redrawing from a stored folder."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from browser import complaints_of_all, needs_chromium
from showing import call, is_golden

import rockwobble as rw
import rockwobble.studies as rs
from rockwobble.compare.comparison.peak_error import PeakError
from rockwobble.compare.metrics.pair import balance_of
from rockwobble.models.finding import Finding, Value
from rockwobble.reports import pages as registry
from rockwobble.reports.figures import sweep as figure
from rockwobble.reports.figures import trace as trace_figure
from rockwobble.reports.figures.heat import Heat
from rockwobble.reports.figures.picture import Rule
from rockwobble.reports.pages.run import page_of
from rockwobble.studies.single_run import SingleRun, single_run_of

PIER = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = rw.Case(PIER, initial=rw.InitialState(tilt=0.5 * PIER.alpha, rolling_rate=0.5), duration=1.0)
GRID = rs.Grid(
    semidiagonals=[1.0, 2.0, 20.0],
    tan_alphas=[0.1, 0.2],
    scales=[0.3, 1.0, 2.0],
    motions=[rw.el_centro_1940()],
)


def run_of(case: rw.Case, run: rw.Run) -> SingleRun:
    settings = dict(run.settings)
    return single_run_of(
        rw.simulate(case, engine=run.engine, support=run.support, time_step=run.time_step, **settings)
    )


def sizes(run: SingleRun) -> dict[str, dict[str, Value]]:
    return {each.key.partition(".")[2]: dict(each.values) for each in run.findings().of("quantity")}


def keys(run: SingleRun) -> list[str]:
    return [each.key for each in run.findings()]


@pytest.fixture(scope="module")
def swept() -> dict[str, rs.Sweep]:
    cases = [rw.Case(PIER, initial=RELEASE.initial, duration=0.5 * n, name=f"{n}") for n in (1, 2)]
    plans = {"grid": GRID, "cases": rw.Suite(cases, [rw.Run(None, "recess"), rw.Run(None, "flat")])}
    return {name: rw.sweep(plan, workers=1) for name, plan in plans.items()}


@pytest.mark.slow
def test_run_page_matches_golden_file():
    trace = rw.simulate(rw.Case(PIER, rw.el_centro_1940(), duration=15.0))
    error = PeakError(2.5e-3, "model form")
    single = {"copies_part": 9.0, "answer": "rockwobble ensemble", "scatter": 0.02, "error": error}
    is_golden(single_run_of(dataclasses.replace(trace, wall_time=0.01), single))


def test_sweep_page_matches_golden_file(swept):
    is_golden(swept["grid"])


def test_run_page_states_only_quantities_of_its_method():
    of_model = sizes(run_of(rw.Case(PIER, rw.el_centro_1940(), duration=15.0), rw.Run(None, "recess")))
    # the swing after the end has no known demand
    assert of_model["friction"]["reason"] == of_model["moment"]["reason"] == "until_the_end"
    assert {"end", "uplift", "passes", "closest", "computing_time"} < set(of_model)
    assert not {"time_step", "twist", "wall_contact"} & set(of_model)
    engine = sizes(run_of(RELEASE, rw.Run("mujoco", "recess", 1e-3)))
    assert engine["time_step"]["duration"] == 1e-3
    assert {"twist", "displacement_residual"} < set(engine)
    # release with an initial tilt
    assert not {"uplift", "wall_contact", "friction", "moment", "closest"} & set(engine)


def test_run_at_rest_states_whether_its_base_slides():
    weak = rw.el_centro_1940().scaled(0.3)
    for friction, slides in ((0.5, False), (0.05, True)):
        run = run_of(rw.Case(PIER, weak, friction=friction, duration=15.0), rw.Run(None, "recess"))
        assert sizes(run)["friction"]["demand"] == pytest.approx(0.0859, abs=1e-4)
        assert "run.at_rest" in keys(run)
        assert ("mode.walls" in keys(run)) == slides


def test_planar_run_states_its_plane_and_restitution():
    shaken = rw.Case(PIER, rw.el_centro_1940(), duration=6.0)
    said = sizes(run_of(shaken, rw.Run(None, "recess", plane=-4.0, restitution=0.95)))
    assert (said["plane"]["angle"], said["restitution"]["detail"]) == (-4.0, "0.95")
    assert said["uplift"]["angle"] == pytest.approx(2.0 * math.pi - 4.0)


def test_overturning_after_the_end_states_both_times():
    cut = rw.Case(
        rw.Cylinder(semidiagonal=2.9744, tan_alpha=0.2), rw.el_centro_1940().scaled(1.909), duration=3.93
    )
    end = sizes(run_of(cut, rw.Run(None, "recess")))["end"]
    assert end["time"] > end["time_still"] == 3.93


def test_failed_and_overturned_runs_are_stated():
    fallen = run_of(rw.Case(PIER, rw.el_centro_1940().scaled(5.0)), rw.Run(None, "recess"))
    assert "run.falls" in keys(fallen)
    # demand up to the overturning time
    assert sizes(fallen)["friction"]["reason"] == "until_it_falls"
    assert "run.failed" in keys(run_of(RELEASE, rw.Run("mujoco", "recess", contact_damping_ratio=0.01)))


@pytest.mark.parametrize(
    ("stiffness", "share", "key", "mark"),
    [
        (0.0, 0.9, "run.falls", "passes its balance for good"),
        (2.0, 0.9, "run.falls", "passes its balance for good"),
        (2.0, 1.1, "run.starts_beyond_balance", "passes its balance for good"),
        (6.0, 0.9, "run.falls_from_any_tilt", None),
    ],
)
def test_overturning_time_uses_the_balance_tilt_with_tendon(stiffness, share, key, mark):
    tendon = rw.Tendon(stiffness=stiffness) if stiffness else None
    case = rw.Case(PIER, duration=3.0, tendon=tendon)
    release = rw.InitialState(share * balance_of(case), tilt_rate=1.0 if stiffness < 6.0 else 3.0)
    trace = rw.simulate(dataclasses.replace(case, initial=release))
    assert trace.outcome == "overturned"
    (fall,) = single_run_of(trace).findings().of("run")
    assert (fall.key, fall.values["tilt"]) == (key, balance_of(case))
    panel = trace_figure.pictures(trace)[0].panels[0]
    marks = {layer.text: layer.at for layer in panel.layers if isinstance(layer, Rule)}
    assert list(marks) == ([] if mark is None else [mark])
    if mark and share < 1.0:
        tilts = np.interp([marks[mark], marks[mark] + 0.02], trace.time, trace.tilt)
        assert tilts[0] <= balance_of(case) < tilts[1]


def test_tilt_axis_includes_tilts_recentred_by_a_tendon():
    case = rw.Case(
        PIER, initial=rw.InitialState(1.6 * PIER.alpha), duration=1.0, tendon=rw.Tendon(stiffness=2.0)
    )
    assert trace_figure.pictures(rw.simulate(case))[0].panels[0].y.high is None
    fallen = dataclasses.replace(case, initial=rw.InitialState(1.7 * PIER.alpha), duration=3.0)
    high = trace_figure.pictures(rw.simulate(fallen))[0].panels[0].y.high
    assert high == pytest.approx(1.5 * balance_of(case) / PIER.alpha, rel=1e-15)


def test_run_decided_by_rounding_is_undecided():
    trace = rw.simulate(RELEASE)
    end = dataclasses.replace(trace, outcome="undecided", peak_tilt=math.nan)
    assert [each.key for each in single_run_of(end).findings().of("run")] == ["run.undecided"]


@pytest.mark.parametrize(("part", "before"), [(0.01, "before_largest_tilt"), (9.0, None), (math.inf, "none")])
def test_trace_is_unreliable_once_its_copies_diverge(part, before):
    trace = single_run_of(rw.simulate(rw.Case(PIER, rw.el_centro_1940(), duration=3.0))).made_by()
    single = {"copies_part": part, "perturbation": 0.01, "answer": "rockwobble ensemble"}
    spread = dataclasses.replace(trace, facts={**trace.facts, "single_trace": single})
    doubts = [each.values for each in spread.findings() if each.key == "run.not_reproducible"]
    assert [each["reason"] for each in doubts] == ([] if before == "none" else [before])
    assert ("Distribution: `rockwobble ensemble`" in page_of(spread).markdown()) == bool(doubts)


def test_sweep_of_cases_counts_runs_by_outcome(swept):
    cases, ended = swept["cases"].findings()
    assert cases.values == {"runs": 4, "count": 2, "count_of_each": 2}
    assert ended.values["count_stands"] == 4


def test_a_map_has_a_cell_per_run_or_states_the_number(monkeypatch):
    sweep = rw.sweep(GRID, workers=1)
    own = sweep.table[sweep.table["tan_alpha"] == 0.1].set_index(["scale", "semidiagonal"])
    (picture,) = figure.pictures(sweep)
    heat = picture.panels[0].layers[0]
    assert isinstance(heat, Heat)
    for i, scale in enumerate(GRID.scales):
        for j, size in enumerate(GRID.semidiagonals):
            run = own.loc[scale, size]
            moved = run["outcome"] == "stands" and run["peak_tilt"] > 0.0
            shown = heat.values[i, j]
            assert shown == run["peak_tilt_over_alpha"] if moved else math.isnan(shown)
    fell = sum(gap.cells for gap in heat.gaps if gap.name == "overturned")
    assert np.count_nonzero(fell) == (own["outcome"] == "overturned").sum() > 0
    monkeypatch.setattr(figure, "_MOST_CELLS", 4)
    monkeypatch.setattr(figure, "_MOST_MAPS", 1)
    (picture,) = figure.pictures(sweep)
    assert picture.panels[0].layers[0].values.shape == (2, 2)
    left_out = {"count_sizes": 2, "count_scales": 2, "count": 1, "count_all": 2}
    assert isinstance(picture.caption, Finding)
    assert picture.caption.values == {"names": ("El Centro 1940",), **left_out}


def test_map_axes_are_thinned_with_distinct_labels_for_close_sizes():
    counts = [(21_000, 2), (2, 21_000), (1_000, 1_000), (141, 141)]
    assert [figure._step(*each) for each in counts] == [3, 1, 8, 1]
    places, axis = figure._axis(np.array([*range(1, 14), 80.0, 200.0]), "R", "m")
    assert list(places) == list(range(15))
    assert [name for _, name in axis.ticks] == ["1", "3", "5", "7", "9", "11", "13", "200"]
    places, axis = figure._axis(np.linspace(1.0, 7.0, 13), "R", "m")
    assert (places[1], axis.ticks) == (1.5, ())
    _, axis = figure._axis(np.array([6.00001, 6.00002]), "R", "m")
    assert [name for _, name in axis.ticks] == ["6.00001", "6.00002"]


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize(
    "command",
    [
        "simulate --release-tilt-deg 5 --duration 1",
        "sweep --semidiagonal 1,6 --scale 0.3,2 --workers 1",
    ],
)
def test_stored_folder_redraws_identical_pages(tmp_path, capsys, command):
    made = tmp_path / "made"
    assert call(*command.split(), "--out", str(made)) == 0
    before = {path.name: path.read_bytes() for path in made.glob("*.*")}
    assert call("report", str(made)) == 0
    after = {path.name: path.read_bytes() for path in made.glob("*.*")}
    changed = {name for name in after if after[name] != before.get(name)} - {"manifest.json"}
    assert any(name.endswith(".html") for name in before)
    assert {name.rpartition(".")[2] for name in changed} == {"md", "svg"}
    assert "eak tilt" in capsys.readouterr().out


@pytest.mark.slow
@needs_chromium
def test_pages_of_runs_are_drawn(swept, tmp_path: Path):
    pages = [page_of(run_of(RELEASE, rw.Run(None, "recess")).made_by()), registry.page_of(swept["grid"])]
    complaints = complaints_of_all([page.html() for page in pages], tmp_path, figures=2)
    assert complaints == {0: [], 1: []}
    (wrong,) = complaints_of_all([registry.page_of(swept["cases"]).html()], tmp_path, figures=1).values()
    assert wrong == []
