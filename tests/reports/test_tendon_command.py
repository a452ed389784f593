"""Tendon options and suites: ratios, steel data, the page, and refusals."""

from __future__ import annotations

import dataclasses
import html
import json
from importlib.util import find_spec
from pathlib import Path

import pandas as pd
import pytest
from showing import call

import rockwobble as rw
from rockwobble.studies.stated import case_findings

PIER = ["--diameter", "1.6", "--height", "9", "--release-tilt-deg", "4", "--duration", "2"]
STEEL = ["--tendon-force", "400e3", "--tendon-rigidity", "30e6", "--tendon-length", "10", "--mass", "45"]
DRAWN = {"prestress": 400e3, "axial_rigidity": 30e6, "length": 10.0, "column_mass": 45e3, "base_radius": 0.8}


@pytest.mark.slow
def test_comparison_with_tendon_skips_or_refuses_flat_ground_before_any_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    given = ["compare", *PIER, "--engine", "mujoco", "--tendon-prestress", "0.5", "--out"]
    assert call(*given, str(tmp_path / "out")) == 0
    summary = (tmp_path / "out" / "summary.csv").read_text()
    assert "recess" in summary
    assert "flat" not in summary
    capsys.readouterr()
    assert call(*given, str(tmp_path / "flat"), "--support", "flat") == 2
    said = capsys.readouterr().err.splitlines()
    assert said[-1].startswith("rockwobble: a tendon is part of the models in the recess and in a plane")
    assert not any(line.startswith("running") for line in said)


@pytest.mark.slow
def test_tendon_ratios_and_steel_data_give_equal_tendons(tmp_path: Path) -> None:
    drawn = rw.Tendon.from_steel(**DRAWN)
    ratios = ["--tendon-prestress", repr(drawn.prestress), "--tendon-stiffness", repr(drawn.stiffness)]
    traces = []
    for name, options in {"drawn": STEEL, "ratios": ratios}.items():
        assert call("simulate", *PIER, *options, "--out", str(tmp_path / name)) == 0
        traces.append(rw.Trace.load(tmp_path / name / "run.parquet"))
    for trace in traces:
        assert trace.case.tendon == drawn
        assert trace.tilt.tolist() == traces[0].tilt.tolist()
    page = html.unescape((tmp_path / "drawn" / "run.html").read_text())
    tied = "Tendon: prestress 0.9061 weights of a column, stiffness 5.437 weights per base radius"
    assert f"{tied}, elastic without limit" in page
    largest = traces[0].peak_tendon_force
    assert f"largest {largest:.3g} weights of a column" in page
    # output of advise, which accepts a tendon
    answer = json.loads((tmp_path / "drawn" / "manifest.json").read_text())["about"]["single_trace"]["answer"]
    assert answer.startswith("rockwobble advise")
    assert "--tendon-force" in answer


def test_suite_file_defines_tendons(tmp_path: Path) -> None:
    path = tmp_path / "tied.toml"
    path.write_text(
        '[[cases]]\nname = "pier"\nduration = 2.0\ncylinder = { semidiagonal = 6.0, tan_alpha = 0.2 }\n'
        "release = { tilt_over_alpha = 0.5 }\n"
        "tendon = { prestress = [0.0, 0.5], stiffness = 2.0, yield_force = 3.0 }\n"
        '[[runs]]\nengine = "mujoco"\n'
    )
    cases = rw.read_suite(path).cases
    tied = [rw.Tendon(prestress=prestress, stiffness=2.0, yield_force=3.0) for prestress in (0.0, 0.5)]
    assert [case.tendon for case in cases] == tied
    assert [case.name for case in cases] == ["pier: prestress 0", "pier: prestress 0.5"]
    path.write_text(path.read_text().replace("[0.0, 0.5]", "4.0"))
    with pytest.raises(ValueError, match=r"cases\[0\]\.tendon: yield_force must be above the prestress"):
        rw.read_suite(path)


def test_uplift_threshold_includes_the_prestress() -> None:
    pier, tendon = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2), rw.Tendon(prestress=1.0)
    motion = rw.el_centro_1940(vertical=True)
    for body in (pier, rw.WobblingFrame(pier, 1.0)):
        free, tied = (case_findings(rw.Case(body, motion, tendon=held)) for held in (None, tendon))
        stated = [{each.key: each.values for each in said}["input.ground"] for said in (free, tied)]  # noqa: PD011
        factors = [each["factor"] for each in stated]
        assert factors[0] / factors[1] == pytest.approx(tendon.uplift_factor(body))


@pytest.mark.skipif(find_spec("exudyn") is None, reason="an engine of flat ground alone")
def test_case_with_a_tendon_skips_flat_ground_by_default() -> None:
    from rockwobble.compare import default_runs

    release = rw.InitialState(0.1)
    case = rw.Case(rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2), initial=release, duration=1.0)
    tied = dataclasses.replace(case, tendon=rw.Tendon(prestress=0.5))
    assert {run.support for run in default_runs(cases=[case])} == {"recess", "flat"}
    assert {run.support for run in default_runs(cases=[case, tied])} == {"recess"}
    # named supports run or are refused, without replacement
    named = default_runs(["mujoco", "exudyn"], cases=[tied])
    assert named == (rw.Run("mujoco", "recess"), rw.Run("exudyn", "flat"))
    with pytest.raises(ValueError, match="a tendon is part of the models in the recess"):
        rw.comparison(tied, runs=named)


SIZE = ["--diameter", "1.6", "--height", "9"]
BODY = rw.Cylinder.from_dimensions(base_radius=0.8, height=9.0)
BY_SIZE = ["--semidiagonal", repr(BODY.semidiagonal), "--tan-alpha", repr(BODY.tan_alpha)]
FRAGILITY = "--synthetic 2 --model recess --levels 2,4 --resamples 2 --limit overturned"
# study of one body: its table and options
STUDIES = {
    "fragility": ("runs", [*SIZE, *FRAGILITY.split(), "--limit", "tendon yields"]),
    "spectrum": ("spectrum", [*BY_SIZE, "--intensity", "1,2,4", "--search-step", "0.5", "--probes", "0"]),
    "sweep": ("sweep", [*BY_SIZE, "--scale", "2,3"]),
    "ensemble": (
        "members",
        [*SIZE, *["--engine", "none", "--copies", "2", "--scale", "3", "--duration", "4"]],
    ),
}


@pytest.mark.slow
@pytest.mark.usefixtures("in_this_process")
@pytest.mark.parametrize("command", STUDIES)
def test_study_of_one_body_accepts_a_tendon_from_steel_data(command: str, tmp_path: Path) -> None:
    drawn = rw.Tendon.from_steel(**DRAWN, yield_force=900e3)
    ratios = ["--tendon-prestress", repr(drawn.prestress), "--tendon-stiffness", repr(drawn.stiffness)]
    steel = [*STEEL]
    if command in ("fragility", "spectrum"):  # plans state the yield force
        steel += ["--tendon-yield-force", "900e3"]
        ratios += ["--tendon-yield", repr(drawn.yield_force)]
    peaks, (table, stated) = [], STUDIES[command]
    for place, options in enumerate((steel, ratios)):
        out = tmp_path / str(place)
        assert call(command, *stated, *options, "--out", str(out)) == 0
        peaks.append(pd.read_parquet(out / f"{table}.parquet")["peak_tilt"].to_numpy(float))
    assert peaks[0].max() > 0.0
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-6)  # base radius known to rounding
