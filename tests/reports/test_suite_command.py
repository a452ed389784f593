from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from showing import call

import rockwobble as rw
from rockwobble import reduced
from rockwobble.compare import Comparison
from rockwobble.compare.comparison import driver
from rockwobble.compare.comparison.result import comparison_of
from rockwobble.compare.comparison.summary import own_rows
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Run, WobblingFrame, read_suite
from rockwobble.models.finding import Value
from rockwobble.reports.cli.suite_choice import chosen_runs
from rockwobble.reports.pages import comparison as report
from rockwobble.reports.pages.page import Page
from rockwobble.studies.stated import case_findings

PAGE_LIMIT = 2_000_000  # [bytes]
CASES = 6
SUITE = """
[[runs]]
engine = "mujoco"
support = ["recess", "flat"]

[[cases]]
name = "release"
cylinder = { semidiagonal = 6, tan_alpha = [0.1, 0.2, 0.3, 0.4] }
release = { tilt_over_alpha = 0.5, rolling_rate = 0.5 }
duration = 2
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.suite.toml").write_text(SUITE)
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    start = InitialState(tilt=math.radians(5.0), rolling_rate=0.5)
    response = reduced.simulate(Case(pier, initial=start, duration=2.0))
    table = {"time": response.time, "tilt": response.tilt, "azimuth": response.rolling_angle}
    pd.DataFrame(table).to_csv(tmp_path / "table.csv", index=False)
    return tmp_path


RELEASE = ["--release-tilt-deg", "5", "--rolling-rate", "0.5", "--duration", "2"]


@pytest.mark.slow
def test_suite_is_echoed_run_summarised_and_written(folder, no_engines, capsys):
    no_engines()
    assert call("compare", "mine.suite.toml", "--out", "results") == 0
    out = capsys.readouterr().out
    assert "= 8 runs" in out
    assert "Cases: release (4)" in out
    assert re.search("mujoco recess +4 +4 +100 %", out)
    assert "8 of 8 runs" in " ".join(out.split())
    summary = pd.read_csv(folder / "results" / "summary.csv")
    assert summary["case"].nunique() == 4
    assert (folder / "results" / "report.html").read_text().count("<template id=") == 4
    # engine that diverges from the beginning
    no_engines(tilt=np.full(201, 0.3))
    assert call("compare", "mine.suite.toml", "--engine", "mujoco", "--support", "recess") == 0
    out = capsys.readouterr().out
    assert re.search("mujoco recess +4 +0 +0 %", out)
    assert re.search(r"tan_alpha 0.1 +mujoco recess +0.00 +2 ", out)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({}, ["mujoco recess", "mujoco flat", "pybullet recess"]),
        ({"engines": ["mujoco"]}, ["mujoco recess", "mujoco flat"]),
        ({"supports": ["flat"]}, ["mujoco flat"]),
        ({"supports": ["ring"]}, ["mujoco ring", "pybullet ring"]),
        ({"engines": ["exudyn"]}, ["exudyn recess", "exudyn flat"]),
        ({"engines": ["pybullet"], "supports": ["recess"]}, ["pybullet recess"]),
    ],
)
def test_options_choose_among_the_runs_of_a_suite(write_suite, options, expected):
    runs = '[[runs]]\nengine = "mujoco"\nsupport = ["recess", "flat"]\nsettings = { iterations = 7 }\n'
    suite = write_suite(runs + '[[runs]]\nengine = "pybullet"\n' + SUITE[SUITE.index("[[cases]]") :])
    chosen = chosen_runs(suite, options.get("engines"), options.get("supports"), None)
    assert [f"{run.engine} {run.support}" for run in chosen] == expected
    for run in chosen_runs(suite, None, None, 2e-4):
        assert run.time_step == 2e-4
        assert dict(run.settings) == ({"iterations": 7} if run.engine == "mujoco" else {})


def test_time_step_option_replaces_automatic_step_and_its_settings(write_suite):
    way = 'time_step = "extrapolated"\nsettings = { iterations = 7, finest_step = 1e-4 }\n'
    suite = write_suite(f'[[runs]]\nengine = "mujoco"\n{way}' + SUITE[SUITE.index("[[cases]]") :])
    (given,) = chosen_runs(suite, None, None, 2e-4)
    assert (given.time_step, dict(given.settings)) == (2e-4, {"iterations": 7})
    (same,) = chosen_runs(suite, None, None, "extrapolated")
    assert dict(same.settings) == {"iterations": 7, "finest_step": 1e-4}


@pytest.fixture
def write_suite(tmp_path: Path):
    path = tmp_path / "written.suite.toml"
    return lambda text: read_suite(path) if path.write_text(text) else None


def stated(case: Case) -> dict[str, dict[str, Value]]:
    return {each.key.partition(".")[2]: dict(each.values) for each in case_findings(case)}


def test_a_case_is_stated_in_units_of_uplift_with_slab_and_resistance():
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    level = [[0.0, 0.0], [1.5, 2.0], [0.0, 0.0]]
    falling = [[x, y, -3.0 * (x > 0.0)] for x, y in level]
    # of a record this many times weaker, the vertical component too, nothing would uplift
    for motion, drive in ((level, 2.5), (falling, 2.5 + 3.0 * 0.2)):
        ground = stated(Case(pier, GroundMotion(motion, 0.1)))["ground"]
        assert (ground["ratio"], ground["factor"]) == pytest.approx((2.5 / 9.81, drive / 9.81 / 0.2))
        assert ground["reason"] is None
    ground = stated(Case(pier, GroundMotion(level, 0.1), duration=0.05))["ground"]
    assert (ground["factor"], ground["reason"]) == (pytest.approx(0.5 * 2.5 / 9.81 / 0.2), "within_the_run")
    motion = GroundMotion([[0.0, 0.0], [2.5, 0.0], [0.0, 0.0]], 0.1)
    alone = stated(Case(pier, motion))
    loaded = stated(Case(WobblingFrame(pier, 0.25), motion, rolling_resistance=0.05 * pier.base_radius))
    assert loaded["slab"] == {"ratio": 0.25, "count": 3}
    assert loaded["resistance"]["ratio"] == pytest.approx(0.05)
    assert alone["ground"]["factor"] == pytest.approx(1.05 * loaded["ground"]["factor"])


@pytest.mark.slow
def test_external_trajectory_is_added_as_a_run(folder, no_engines, monkeypatch, capsys):
    no_engines()
    arguments = [*RELEASE, "--trajectory", "table.csv", "--trajectory-angles", "rad"]
    assert call("compare", *arguments, "--engine", "none", "--out", "alone") == 0
    assert re.search(r"table +stands", capsys.readouterr().out)
    alone = pd.read_csv(folder / "alone" / "summary.csv")
    assert alone["run"].tolist() == ["table"]
    assert alone["tilt_rms"].max() < 1e-12  # written with all digits
    monkeypatch.setattr(Page, "files", lambda *_, **__: {})
    assert call("compare", *arguments, "--engine", "mujoco", "--support", "recess", "--out", "both") == 0
    both = pd.read_csv(folder / "both" / "summary.csv")
    assert both["run"].tolist() == ["mujoco recess", "table"]


@pytest.mark.slow
def test_a_page_of_many_cases_is_small_and_draws_one(no_engines, monkeypatch):
    no_engines()
    monkeypatch.setattr(driver, "require_runnable", lambda case, run: None)
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    one = Case(pier, initial=InitialState(tilt=0.1, rolling_rate=0.5), duration=60.0, name="</script>")
    runs = [Run(engine, support) for engine in ("mujoco", "pybullet") for support in ("recess", "flat")]
    made = rw.comparison(one, runs=runs, workers=1)
    # with as many points for six cases as 44 would get, all of them would fit
    monkeypatch.setattr(report, "_ALL_POINTS", report._ALL_POINTS * CASES // 44)
    many = _repeated(made, CASES)
    summary = many.summary.assign(left_tolerance=many.summary.index % 2 == 1)
    rows = len(own_rows(summary))
    agree = int((~own_rows(summary)["left_tolerance"]).sum())
    for outcome, failed in (("stands", ""), ("failed", f"; {rows} failed")):
        other = dataclasses.replace(many, tables={**many.tables, "summary": summary.assign(outcome=outcome)})
        words = " ".join(report.page_of(other).markdown().split())
        assert f"**{agree} of {rows} runs" in words
        assert f"to the end{failed}.**" in words
    page = report.page_of(many).html()
    assert page.count("<template id=") == CASES
    assert page.count('class="chart"') >= CASES * 4
    assert 44 * len(page.encode()) / CASES < PAGE_LIMIT
    assert page.count("</script>") == page.count("<script")
    assert "&lt;/script&gt;" in page


def _repeated(comparison: Comparison, count: int) -> Comparison:
    names = [f"</script>: copy {index}" for index in range(count)]
    (case,) = comparison.cases.values()
    return comparison_of(
        pd.concat([comparison.summary.assign(case=name) for name in names], ignore_index=True),
        cases={name: dataclasses.replace(case, name=name) for name in names},
        traces={
            (name, label): dataclasses.replace(trace, case=dataclasses.replace(case, name=name))
            for name in names
            for (_, label), trace in comparison.traces.items()
        },
        versions=comparison.versions,
    ).made_by()
