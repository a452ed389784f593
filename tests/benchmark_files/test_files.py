"""Benchmark files: complete, small, certified, and consistent with their README."""

from __future__ import annotations

import csv
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from benchmark_files.conftest import EXIT, Judge
from benchmark_files.definitions import definitions
from benchmark_files.references import reference
from benchmark_files.submission import cases_of
from benchmark_files.write import PUBLISHED, case_file
from rockwobble import reduced
from rockwobble.models import Case
from rockwobble.reduced.exact import free_response, steady_wobble_rate

pytestmark = pytest.mark.checkout

CASES = sorted(path.name for path in (PUBLISHED / "cases").iterdir())
SHORT = ("turn-flat", "turn-recess", "uplift-directions", "near-upright-pass", "onset-of-slip", "tendon")
SHORT += ("impact", "slide-line", "slide-curve")
REFERENCE = Path(__file__).resolve().parents[1] / "reference"


def read(case: str, name: str) -> Any:
    return json.loads((PUBLISHED / "cases" / case / f"{name}.json").read_text())


def table(case: str) -> dict[str, np.ndarray]:
    path = PUBLISHED / "cases" / case / "reference.csv"
    values = np.loadtxt(path, delimiter=",", skiprows=1)
    return dict(zip(path.read_text().split("\n", 1)[0].split(","), values.T, strict=True))


def follows(schema: str, content: Any) -> None:
    expected = json.loads((PUBLISHED / "schemas" / f"{schema}.schema.json").read_text())
    jsonschema.validate(content, expected, cls=jsonschema.Draft202012Validator)


def test_the_fifteen_cases_are_those_defined_and_follow_their_schemas() -> None:
    assert sorted(one.name for one in definitions()) == CASES
    assert len(CASES) == 15
    for case in CASES:
        for name in ("case", "accept", "reference"):
            follows(name, read(case, name))
    text = (PUBLISHED / "README.md").read_text()
    assert all(f"| {case} |" in text for case in CASES)
    assert "CC0" in text
    assert "CC0 1.0 Universal" in (PUBLISHED / "LICENSE").read_text()


def test_results_follow_their_schema() -> None:
    for path in (PUBLISHED / "results").glob("*/*.json"):
        stored = json.loads(path.read_text())
        if path.name == "about.json":
            assert {"code", "version", "settings", "seconds_a_step"} <= set(stored)
        else:
            follows("result", stored)


@pytest.mark.parametrize("case", CASES)
def test_each_criterion_and_run_has_a_reference_value(case: str) -> None:
    runs = [run["name"] for run in read(case, "case")["runs"]]
    known = {(one["name"], one["run"]) for one in read(case, "reference")["quantities"]}
    titles = set(table(case))
    for one in read(case, "accept")["criteria"]:
        assert one["pass"] > one["good"] >= one["exact"]
        for run in one.get("runs", runs):
            if one["kind"] == "trace":
                column = "x" if one["name"] == "path" else "tilt"
                assert {column, f"{column}:{run}"} & titles
            else:
                assert (one["name"], run) in known


@pytest.mark.parametrize("case", CASES)
def test_each_number_is_certified_by_formulations_that_agree(case: str) -> None:
    given = read(case, "reference")
    quantities = given["quantities"]
    loose = []
    for one in quantities:
        values = list(one["certified"].values())
        assert len(values) >= 2
        assert one["value"] in values
        assert max(values) - min(values) <= 0.1 * one["bound"]
        loose += [one] if one["bound"] > 1e-9 * max(1.0, abs(one["value"])) else []
    for name, one in given["traces"].items():
        assert one["bound"] < (1e-6 if name == "azimuth" else 1e-9)
        assert len(set(one["certified_by"])) == 2
    # only single peaks under records of that length are sensitive: their distribution is not
    if case != "records-distribution":
        assert not loose
        return
    ways = np.array([list(one["certified"].values()) for one in quantities]).T
    shares = [np.searchsorted(np.sort(way), ways.ravel(), side="right") / len(way) for way in ways]
    assert np.abs(shares[0] - shares[1]).max() < 1.5 / 22.0


@pytest.mark.parametrize(("case", "number"), [("turn-flat", 10), ("turn-recess", 4), ("tendon", 6)])
def test_engines_of_hard_contact_tend_to_the_same_numbers(case: str, number: int) -> None:
    # README.md of the folder says so
    near = {"exudyn": 1e-10, "dart": 1e-6 if case == "tendon" else 5e-7}
    said = [
        (by.partition(" ")[0], value / one["value"] - 1.0)
        for one in read(case, "reference")["quantities"]
        for by, value in one.get("engines", {}).items()
    ]
    assert len(said) == number
    assert all(abs(off) < near[engine] for engine, off in said)


@pytest.mark.slow
@pytest.mark.parametrize("case", SHORT)
def test_published_files_equal_recomputed_references(case: str) -> None:
    definition = next(one for one in definitions() if one.name == case)
    assert json.loads(json.dumps(case_file(definition))) == read(case, "case")
    computed = reference(definition)
    stored = {(one["name"], one["run"]): one for one in read(case, "reference")["quantities"]}
    for one in computed.quantities:
        old = stored[one["name"], one["run"]]
        assert all(abs(value - old["value"]) <= old["bound"] for value in one["certified"].values())
    for name, column in table(case).items():
        np.testing.assert_allclose(column, computed.columns[name], rtol=0, atol=1e-8)


def test_angles_of_turn_match_the_independent_table() -> None:
    lines = (REFERENCE / "finite_release.csv").read_text().splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    checked = 0
    for support, case in (("rolling", "turn-flat"), ("recess", "turn-recess")):
        known = {(one["name"], one["run"]): one["value"] for one in read(case, "reference")["quantities"]}
        for row in (row for row in rows if row["h_over_b"] == "2"):
            run = f"spin-{float(row['phi_rate']):g}"
            turn, period = float(row[f"{support}_turn_deg"]), float(row[f"{support}_period_s"])
            assert math.degrees(known["turn_1", run]) == pytest.approx(turn, abs=1e-6)
            assert known["period_1", run] == pytest.approx(period, abs=1e-6)
            checked += 1
    assert checked == 6


def test_references_match_closed_forms_and_quadratures() -> None:
    for case in ("turn-recess", "near-upright-pass", "tendon"):
        for run, (given, _) in cases_of(PUBLISHED / "cases" / case).items():
            if given.initial is None:
                continue
            exact = free_response(given.cylinder, given.initial, gravity=given.gravity, tendon=given.tendon)
            asked = read(case, "reference")["quantities"]
            known = {one["name"]: one["value"] for one in asked if one["run"] == run}
            assert known["turn_1"] == pytest.approx(exact.angle_of_turn, rel=1e-12)
            assert known["period_1"] == pytest.approx(exact.period, rel=1e-12)
    (given, _) = cases_of(PUBLISHED / "cases" / "steady-wobble")["wobble"]
    assert given.initial is not None
    rate = float(steady_wobble_rate(given.cylinder, given.initial.tilt, gravity=given.gravity))
    (known,) = read("steady-wobble", "reference")["quantities"]
    assert known["value"] == pytest.approx(200.0 * math.pi / rate, rel=1e-12)


def test_rigid_body_start_equals_start_in_angles() -> None:
    """The contact point lies on the original circle with zero velocity, and the twist rate is zero."""
    for case in CASES:
        for run in read(case, "case")["runs"]:
            start = run["start"]
            if not start["tilt"]:
                continue
            w, x, y, z = start["quaternion"]
            axis = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z])
            assert math.hypot(w, x, y, z) == pytest.approx(1.0)
            assert z == 0.0
            assert math.atan2(axis[1], axis[0]) == pytest.approx(start["azimuth"])
            assert math.acos(axis[2]) == pytest.approx(start["tilt"])
            spin, centre = np.array(start["angular_velocity"]), np.array(start["position"])
            down = np.array([0.0, 0.0, -1.0]) + axis[2] * axis
            base = centre - run["mass_centre_height"] * axis
            contact = base + run["base_radius"] * down / np.linalg.norm(down)
            assert contact[2] == pytest.approx(0.0, abs=1e-12 * run["base_radius"])
            assert np.hypot(*contact[:2]) == pytest.approx(run["base_radius"])
            slip = np.array(start["velocity"]) + np.cross(spin, contact - centre)
            assert np.abs(slip).max() < 1e-12
            # z_world + z_body has no share of the angular velocity without a twist
            assert spin @ (np.array([0.0, 0.0, 1.0]) + axis) == pytest.approx(0.0, abs=1e-12)


def test_the_window_of_el_centro_ends_where_a_copy_no_longer_agrees() -> None:
    ends = {
        one["runs"][0]: one["window"][1] for one in read("el-centro", "accept")["criteria"] if "window" in one
    }
    for run, (case, support) in cases_of(PUBLISHED / "cases" / "el-centro").items():
        assert case.motion is not None
        longer = Case(case.cylinder, case.motion, duration=case.length, gravity=case.gravity)
        copy = Case(case.cylinder, case.motion.scaled(1.001), duration=case.length, gravity=case.gravity)
        one, other = (reduced.simulate(c, support=support, rtol=1e-11) for c in (longer, copy))
        count = min(len(one.tilt), len(other.tilt))
        beyond = np.abs(one.tilt[:count] - other.tilt[:count]) > 0.01 * case.cylinder.alpha
        end = float(one.time[int(np.argmax(beyond))])
        assert beyond.any()
        assert ends[run] < end < ends[run] + 1.0


def test_programs_need_numpy_only(copied: Path) -> None:
    for name in ("check", "verdict", "scoreboard"):
        code = (
            "import sys; before = set(sys.modules); sys.path.insert(0, sys.argv[1]); "
            "__import__(sys.argv[2]); new = set(sys.modules) - before; "
            "print(*sorted({name.partition('.')[0] for name in new}))"
        )
        command = [sys.executable, "-I", "-c", code, str(copied), name]
        loaded = set(subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())
        needs = {"check": {"external", "numpy"}, "verdict": {"numpy"}}.get(name, set())
        allowed = sys.stdlib_module_names | needs | {name}
        assert not {m for m in loaded - allowed if not m.startswith("_")}, name


@pytest.mark.slow
@pytest.mark.parametrize("path", sorted((PUBLISHED / "examples").iterdir()), ids=lambda path: path.stem)
@pytest.mark.parametrize("place", ["archive", "checkout"])
def test_example_trajectories_are_graded_exact(path: Path, place: str, copied: Path, tmp_path: Path) -> None:
    folder = copied if place == "archive" else PUBLISHED
    command = [sys.executable, "-E", "-s", str(folder / "check.py"), "turn-recess", str(path)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == EXIT["exact"]
    result = json.loads((tmp_path / "result.json").read_text())
    assert result["verdict"] == "exact", done.stdout
    follows("result", result)


def test_scoreboard_distinguishes_impossible_from_not_run() -> None:
    lines = (PUBLISHED / "scoreboard.md").read_text().splitlines()
    table = [line.strip("| ").split(" | ") for line in lines if line.startswith("| ")]

    def cells(code: str) -> dict[str, str]:
        row = next(row for row in table[1:] if row[0].startswith(code))
        return dict(zip(table[0], row, strict=True))

    assert cells("exudyn")["Angle of turn and period in a recess"] == "cannot"  # flat ground only
    assert cells("drake")["Energy over 100 passes"] == "not run"  # step that takes twenty times as long
    about = json.loads((PUBLISHED / "results" / "rapier-extrapolated" / "about.json").read_text())
    extrapolated = cells(f"rapier {about['version']}, extrapolated")
    assert extrapolated["Energy over 100 passes"] == "left out"
    until = about["extrapolated_until"]["near-upright-pass"]
    assert f"extrapolated to {until:.2g} s" in extrapolated["Passes near the upright position at three spins"]
    assert "not run" not in extrapolated.values()


def test_scale_invariance_needs_all_five_sizes(judge: Judge) -> None:
    columns = table("scale-invariance")
    given = {"r-1": {name: columns[name] for name in ("time", "tilt", "azimuth")}}
    assert judge("scale-invariance", given).verdict == "rejected"


def test_scoreboard_uses_results_judged_by_current_references(copied: Path, tmp_path: Path) -> None:
    def made(folder: Path) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-I", str(folder / "scoreboard.py")]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    assert made(copied).returncode == 0
    for name in ("scoreboard.md", "scoreboard.html", "scoreboard.json"):
        assert (copied / name).read_text() == (PUBLISHED / name).read_text(), name
    page = (copied / "scoreboard.md").read_text()
    for path in (PUBLISHED / "results").glob("*/about.json"):
        about = json.loads(path.read_text())
        assert f"{about['code']} {about['version']}, {about['settings']}" in page
    other = shutil.copytree(copied, tmp_path / "other")
    path = next((other / "results").glob("*/turn-flat.json"))
    path.write_text(path.read_text().replace('"reference_sha256": "', '"reference_sha256": "00')[:-1])
    refused = made(other)
    assert (refused.returncode, "judged by other references" in refused.stderr) == (1, True)
