from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import pytest
from showing import loads_as_it_was, shows_itself

import rockwobble as rw
import rockwobble.compare as rc
import rockwobble.studies as rs
from rockwobble.compare.comparison.result import View
from rockwobble.compare.metrics.pair import make_pair
from rockwobble.compare.runs.execution import Job
from rockwobble.models import Bounds
from rockwobble.models.shown import LONGEST, CompactRepr
from rockwobble.multibody.engines.registry import engine_facts, engine_names
from rockwobble.studies.single_run import single_run

PIER = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = rw.Case(PIER, initial=rw.InitialState(tilt=0.5 * PIER.alpha, rolling_rate=0.5), duration=1.0)


@pytest.fixture(scope="module")
def comparison() -> rw.Comparison:
    other = rw.Case(PIER, initial=RELEASE.initial, duration=1.0, gravity=9.0, name="lighter")
    suite = rw.Suite([RELEASE, other], [])
    return rw.comparison(suite, runs=[rw.Run(None, "flat")], reference=rw.Run(None, "recess"), workers=1)


def test_trace_has_repr_table_and_plot():
    shows_itself(rw.simulate(RELEASE), "recess model", "stands at 1 s")


@pytest.mark.slow
def test_comparison_has_repr_table_and_plot_per_case(comparison, tmp_path):
    shows_itself(comparison, "cases 2")
    loads_as_it_was(comparison, tmp_path)
    first, second = comparison.plot(), comparison.plot("lighter")
    assert "lighter" not in first.get_suptitle()
    assert not np.array_equal(*(each.axes[0].lines[0].get_ydata() for each in (first, second)))


def test_ensembles_and_sweeps_have_repr_table_and_plot(tmp_path):
    grid = rs.Grid(semidiagonals=[1, 6], tan_alphas=[0.2], scales=[0.1, 2], motions=[rw.el_centro_1940()])
    for ensemble, *facts in (
        (rw.ensemble(RELEASE, runs=[], copies=4, workers=1), "4, perturbed copies", "overturned 0 of 8"),
        (rw.sweep([RELEASE], workers=1), "runs 1, stands 1"),
        (rw.sweep(grid, workers=1), "runs 4, stands 2, overturned 2"),
    ):
        shows_itself(ensemble, *facts)
        loads_as_it_was(ensemble, tmp_path / facts[0])


@pytest.mark.slow
def test_error_budgets_and_external_trajectories_survive_save_and_load(tmp_path):
    external = tmp_path / "mine.csv"
    trace = rw.simulate(RELEASE)
    pd.DataFrame({"time [s]": trace.time, "tilt [rad]": trace.tilt}).to_csv(external, index=False)
    run = rw.Run("mujoco", "recess", 1e-3)
    made = rw.comparison(RELEASE, runs=[run], external=[external], budget=True, workers=1)
    assert len(made.budgets) == 1
    loads_as_it_was(made, tmp_path / "comparison")
    loads_as_it_was(View.of(made, RELEASE.name), tmp_path / "view")


def test_single_run_survives_save_and_load(tmp_path):
    tied = rw.Case(
        rw.WobblingFrame(PIER), initial=RELEASE.initial, duration=0.2, tendon=rw.Tendon(prestress=0.1)
    )
    for case, run in ((RELEASE, rw.Run(None, "flat")), (tied, rw.Run(None, "recess", rtol=1e-9))):
        loads_as_it_was(single_run(case, run), tmp_path / case.name)


def test_facts_that_would_not_survive_loading_are_refused(tmp_path):
    made = rw.sweep([RELEASE], workers=1)
    for facts, named in (({"steps": (1, 2)}, "steps, tuple"), ({"order": np.float64(2.0)}, "order, float64")):
        with pytest.raises(TypeError, match=f"got facts.{named}"):
            replace(made, facts=facts).save(tmp_path)
    assert not [*tmp_path.iterdir()]


def test_value_classes_have_a_one_line_repr(comparison):
    trace, *_ = comparison.traces.values()
    engine = rw.simulate(RELEASE, engine="mujoco", time_step=1e-3)
    pair = make_pair(PIER, trace, trace)
    record = rw.el_centro_1940()
    values = [
        PIER,
        record,
        RELEASE,
        RELEASE.initial,
        trace.run,
        pair,
        rw.Suite([rw.Case(PIER, record.scaled(scale), name=str(scale)) for scale in range(1, 5)], []),
        rw.External(path="shake table.csv"),
        rs.Grid(semidiagonals=range(1, 100), tan_alphas=[0.2], scales=[1.0], motions=[record]),
        Job(case=RELEASE, run=trace.run),
        *trace.diagnostics,
        trace.source,
        engine.source,
        trace.assumptions,
        Bounds(tilt_rms=1e-3, agreement_time=3.0),
        rw.reduced.free_response(PIER, RELEASE.initial),
        comparison.made_by("rockwobble compare " + 20 * "--record-x EW.AT2 ").manifest,
        rc.Progress(label="x" * 200, state="started", done=0, total=1),
        *(engine_facts(name) for name in engine_names()),
    ]
    for value in values:
        line = repr(value)
        assert line.startswith(type(value).__name__)
        assert line.isprintable()
        assert len(line) <= LONGEST, line
    assert f"time=array({len(pair.time)},)" in repr(pair)
    assert "99 items" in repr(values[8])


def test_repr_states_the_size_of_long_fields():
    @dataclass(repr=False)
    class Made(CompactRepr):
        share: float
        few: tuple[int, ...]
        many: list[int]
        table: np.ndarray
        words: str

    made = Made(1.0 / 3.0, (1, 2), [1] * 9, np.zeros((4, 2)), "x" * 200)
    text = f"{32 * 'x'}..."
    assert repr(made) == f"Made(share=0.333333, few=(1, 2), many=9 items, table=array(4, 2), words='{text}')"


def test_dir_lists_public_names():
    assert {"simulate", "Case", "comparison", "compare", "__version__"} <= set(dir(rw))
    for part in (rw.compare, rw.studies, rw.models, rw.reduced, rw.multibody):
        assert dir(part) == sorted(part.__all__)
    for name in rc.__all__:
        assert getattr(rw.compare, name) is not None
    with pytest.raises(AttributeError, match="attribute nothing"):
        _ = rc.nothing
