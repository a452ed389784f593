"""Module check.py: right trajectories pass in every format, wrong ones fail with named mistakes."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

from benchmark_files.conftest import SINGLE, SPIN, Judge
from benchmark_files.definitions import definitions
from benchmark_files.planted import MISTAKES as MISTAKES_OF_A_CODE
from benchmark_files.planted import WITHOUT_GYROSCOPIC_TERM
from benchmark_files.planted import judged as planted
from benchmark_files.submission import (
    Table,
    cases_of,
    positions,
    quaternions,
    spacing,
    tilt_and_azimuth,
)
from benchmark_files.write import PUBLISHED
from rockwobble import reduced
from rockwobble.models import Tendon, Trace

pytestmark = pytest.mark.checkout

CASES = sorted(path.name for path in (PUBLISHED / "cases").iterdir())
SLIDING, IMPACT = "onset-of-slip", "impact"
Form = Callable[[Trace], Table]


@cache
def traces(name: str, *, larger: float = 0.0) -> dict[str, Trace]:
    """Every run of a case by the reduced model, optionally of a relatively larger body."""
    sampled = {}
    for run, (case, support) in cases_of(PUBLISHED / "cases" / name).items():
        body, size = case.cylinder, 1.0 + larger
        scaled = {"semidiagonal": size * body.semidiagonal, "height": size * body.height}
        scaled |= {key: size**2 * getattr(body, key) for key in ("transverse_inertia", "axial_inertia")}
        given = dataclasses.replace(case, cylinder=dataclasses.replace(body, **scaled))
        step = min(spacing(case), 0.01)
        plane: dict[str, Any] = {"plane": 0.0, "restitution": "momentum"} if name == IMPACT else {}
        sampled[run] = reduced.simulate(given, support=support, rtol=1e-9, sample_step=step, **plane)
    return sampled


def tables(name: str, form: Form, **more: float) -> dict[str, Table]:
    return {run: form(trace) for run, trace in traces(name, **more).items()}


def sparse(runs: dict[str, Table]) -> dict[str, Table]:
    """Every fourth of two thousand samples."""
    return {run: {key: values[::4] for key, values in table.items()} for run, table in runs.items()}


def with_sliding(runs: dict[str, Table]) -> dict[str, Table]:
    """Trajectory with sliding added by its closed form, x'' = -(a_x - mu (g + a_z))."""
    for run, (case, _) in cases_of(PUBLISHED / "cases" / SLIDING).items():
        if not run.startswith("slides"):
            continue
        table, motion = runs[run], case.motion
        assert motion is not None
        for key in ("tilt", "azimuth", "qx", "qy", "qz"):
            if key in table:
                table[key] = np.zeros_like(table[key])
        slope = motion.acceleration[-1] / motion.duration
        rate = slope[0] - case.friction * slope[2]
        past = np.maximum(table["time"] - case.friction * case.gravity / rate, 0.0)
        table |= {"x": -rate * past**3 / 6.0, "y": 0.0 * past}
        table["z"] = np.full_like(past, case.cylinder.mass_centre_height)
    return runs


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_converged_solution_is_graded_exact(judge: Judge, name: str) -> None:
    runs = tables(name, tilt_and_azimuth)
    judged = judge(name, with_sliding(runs) if name == SLIDING else runs)
    assert judged.verdict == "exact", judged.text
    assert all(one["level"] == "exact" for one in judged.result["criteria"])
    assert not judged.mistakes


@pytest.mark.parametrize("form", [quaternions, positions])
@pytest.mark.parametrize("name", ["turn-recess", "scale-invariance"])
def test_every_file_format_is_read(judge: Judge, name: str, form: Form) -> None:
    judged = judge(name, tables(name, form))
    assert judged.verdict == "exact", judged.text
    # positions alone do not reveal the tilt direction on flat ground
    complete = form is quaternions or name == "turn-recess"
    assert judged.result["grade"] == ("satisfied" if complete else "caution")
    asked = len(judged.result["criteria"])
    assert judged.result["judged"] == [asked if complete else asked - 1, asked]


def test_missing_columns_are_refused_and_unread_ones_named(judge: Judge) -> None:
    kept = {"time": "time", "tilt": "tilt", "azimuth": "azimut"}
    runs = {
        run: {title: table[key] for key, title in kept.items()}
        for run, table in tables("turn-recess", tilt_and_azimuth).items()
    }
    judged = judge("turn-recess", runs)
    assert (judged.verdict, judged.result["grade"]) == ("rejected", "not tested")
    assert "turn_1" in judged.result["reason"]
    assert "azimut" in judged.result["reason"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["turn-flat", "turn-recess", "scale-invariance"])
def test_a_body_one_percent_too_large_fails_and_is_recognised(judge: Judge, name: str) -> None:
    judged = judge(name, sparse(tables(name, tilt_and_azimuth, larger=0.01)))
    assert judged.verdict == "fail"
    assert list(judged.mistakes) == ["time_scale"]
    # an unscaled spin contributes a little
    assert 1.0 <= 100.0 * (judged.mistakes["time_scale"] ** 2 - 1.0) <= 1.2
    # times scale with the root of the size
    assert 0.95 < judged.errors["period_1"] / (np.sqrt(1.01) - 1.0) < 1.3


@pytest.mark.slow
def test_published_table_of_planted_mistakes_is_reproduced() -> None:
    lines = [line for line in (PUBLISHED / "mistakes.md").read_text().splitlines() if line.startswith("|")]
    rows = {row[0]: row[1:] for row in ([cell.strip() for cell in line.split("|")[1:-1]] for line in lines)}
    assert set(rows) == {"case", "---", *CASES}
    assert rows["case"] == list(MISTAKES_OF_A_CODE)
    seen = zip(*(rows[case] for case in CASES), strict=True)
    assert all(any(cell.startswith("fail") for cell in column) for column in seen)
    (definition,) = (one for one in definitions() if one.name == "rolling-disc")
    for mistake in ("axial inertia 10 % too large", WITHOUT_GYROSCOPIC_TERM):
        judgement = planted(definition, mistake)
        assert judgement is not None
        assert rows["rolling-disc"][rows["case"].index(mistake)] == f"fail, {judgement[1]:.2g}"


@pytest.mark.slow
def test_wrong_tendon_fails_without_explanation(judge: Judge) -> None:
    for prestress, stiffness in ((1.02, 1.0), (1.0, 1.02), (0.0, 0.0)):
        judgements = {}
        for run, (case, support) in cases_of(PUBLISHED / "cases" / "tendon").items():
            assert case.tendon is not None
            held = Tendon(
                prestress=prestress * case.tendon.prestress, stiffness=stiffness * case.tendon.stiffness
            )
            other = dataclasses.replace(case, tendon=held)
            trace = reduced.simulate(other, support=support, rtol=1e-9, sample_step=2e-3)
            judgements[run] = tilt_and_azimuth(trace)
        judged = judge("tendon", judgements)
        assert (judged.verdict, judged.mistakes) == ("fail", {}), (prestress, stiffness)


@pytest.mark.slow
def test_model_errors_fail_without_explanation_by_a_file_mistake(judge: Judge) -> None:
    runs = tables("records-distribution", tilt_and_azimuth)
    weak = {run: {"time": table["time"], "tilt": table["tilt"] / 3.0} for run, table in runs.items()}
    larger = tables("el-centro", tilt_and_azimuth, larger=0.01)
    for name, given in (("records-distribution", weak), ("el-centro", larger)):
        judged = judge(name, given)
        assert (judged.verdict, judged.mistakes) == ("fail", {}), name


def y_up(table: Table) -> Table:
    """Columns in axes with y up: x east, z south."""
    names = {"y": "z", "z": "-y", "qy": "qz", "qz": "-qy"}
    taken = {
        key: -table[own[1:]] if own[0] == "-" else table[own] for key, own in names.items() if key in table
    }
    return table | taken


# change of a file, and the expected codes and values
MISTAKES: dict[str, tuple[Form, Callable[[Table], Table], dict[str, float | None]]] = {
    "degrees": (
        tilt_and_azimuth,
        lambda t: t | {key: np.degrees(t[key]) for key in ("tilt", "azimuth")},
        {"angle_unit": np.degrees(1.0)},
    ),
    "milliseconds": (tilt_and_azimuth, lambda t: t | {"time": 1e3 * t["time"]}, {"time_unit": 1e3}),
    "north, east, down": (
        positions,
        lambda t: t | {"x": t["y"], "y": t["x"], "z": -t["z"]},
        {"z_reversed": None, "axes_exchanged": None},
    ),
    "y up, quaternion": (quaternions, y_up, {"y_up": None}),
    "scalar last": (
        quaternions,
        lambda t: t | {"qw": t["qx"], "qx": t["qy"], "qy": t["qz"], "qz": t["qw"]},
        {"quaternion_scalar_last": None},
    ),
    "late": (tilt_and_azimuth, lambda t: t | {"time": t["time"] + 0.05}, {"time_offset": -0.05}),
}


@pytest.mark.slow
@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_in_units_axes_or_clock_is_named(judge: Judge, mistake: str) -> None:
    form, change, wanted = MISTAKES[mistake]
    judged = judge(SINGLE, {SPIN: change(sparse(tables("turn-recess", form))[SPIN])})
    assert judged.verdict == "fail", judged.text
    assert list(judged.mistakes) == list(wanted)
    for code, value in wanted.items():
        assert judged.mistakes[code] == (None if value is None else pytest.approx(value, rel=0.01))


def test_mistakes_hidden_in_planar_runs_are_found_in_others(judge: Judge) -> None:
    # an uplift in one direction is a turn as well as a mirror image
    runs = sparse(tables("uplift-directions", tilt_and_azimuth))
    mirrored = {run: table | {"azimuth": -table["azimuth"]} for run, table in runs.items()}
    assert list(judge("uplift-directions", mirrored).mistakes) == ["y_reversed"]


def test_header_units_and_data_after_the_window_are_accepted(judge: Judge) -> None:
    runs = tables("turn-flat", tilt_and_azimuth)
    for table in runs.values():
        table["azimuth"] = np.where(table["time"] > 3.05, 0.0, table["azimuth"])
        table |= {"time": 1e3 * table["time"], "tilt": np.degrees(table["tilt"])}
    judged = judge("turn-flat", runs, {"time": "time [ms]", "tilt": "Tilt (deg)"})
    assert judged.verdict == "exact", judged.text


RUNS = ("spin-0.03", "spin-0.1", "spin-1")
SAMPLES = "".join(f"{{run}},{0.01 * i},0.1,0.2\n" for i in range(60))
BAD = {  # what the reason must name
    "run,time,tilt,azimuth\n": "samples",
    "run,time,angle\nspin-1,0,0.1\n": "tilt",
    "run,time,tilt,azimuth\n" + SAMPLES.format(run="nobody"): "run",
    "run,time [h],tilt\nspin-1,0,0.1\n": "time",
    "run,time,tilt\nspin-1,0,a\n": "line 2",
    "run,time,tilt,azimuth\n" + SAMPLES.format(run="spin-1"): "run",
    "run,time,tilt,azimuth\n"
    + "".join(f"{run},0,0.1,0\n{run},0,0.1,0\n{run},1,0.1,0\n" for run in RUNS): "time",
    "run,time,tilt,azimuth\n"
    + "".join(f"{run},0,,1\n{run},1,0.1,0\n{run},2,0.1,0\n" for run in RUNS): "tilt",
    "run,time,tilt,azimuth\n" + "".join(SAMPLES.format(run=run) for run in RUNS): "window",
}


@pytest.mark.slow
def test_a_file_that_cannot_be_judged_is_rejected_with_its_reason(judge: Judge) -> None:
    for text, word in BAD.items():
        judged = judge("turn-flat", text)
        assert judged.verdict == "rejected"
        assert word in judged.result["reason"]


def test_missing_tilt_maximum_in_a_complete_file_fails(judge: Judge) -> None:
    late, early = tables(IMPACT, tilt_and_azimuth), {}
    for run, one in late.items():
        early[run] = {key: column[one["time"] < 1.5] for key, column in one.items()}
        one["tilt"] = np.where(one["time"] < 1.5, one["tilt"], 0.0)
    assert judge(IMPACT, late).verdict == "fail"
    assert judge(IMPACT, early).verdict == "rejected"
