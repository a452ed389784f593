"""`rockwobble check --model` and `--trajectory`: right models pass, wrong ones fail where they are wrong."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.compare import read_trajectory
from rockwobble.compare.check import FAILED, NOT_RUN, PASSED, Finding
from rockwobble.compare.check.outside import (
    check_model,
    check_trajectory,
    load_model,
)
from rockwobble.models import Case, Cylinder, InitialState, Trace

# layers that ask for what neither a model nor a trajectory returns
LEFT_OUT = {
    f"checks of the layer {layer}" for layer in ("equations", "properties", "order", "residual", "baseline")
}


def ours(case: Case, support: str) -> Trace:
    return reduced.simulate(case, support=support, rtol=1e-9, sample_step=case.length / 1000)


def without(*names: str) -> Callable[[Case, str], dict[str, Any]]:
    def model(case: Case, support: str) -> dict[str, Any]:
        trace = ours(case, support)
        columns = {"time": trace.time, "tilt": trace.tilt, "azimuth": trace.rolling_angle}
        columns["energy"] = trace.energy
        return {name: column for name, column in columns.items() if name not in names}

    return model


def outcomes(findings: list[Finding], outcome: str) -> set[str]:
    return {finding.name for finding in findings if finding.outcome == outcome}


@pytest.mark.parametrize("support", ["recess", "flat"])
def test_our_own_model_passes_every_check_tightly(support: str) -> None:
    found = list(check_model(ours, support=support, tolerance=1e-5))
    assert len(outcomes(found, PASSED)) == 11
    assert {finding.name for finding in found} == outcomes(found, PASSED) | LEFT_OUT
    assert outcomes(found, NOT_RUN) == LEFT_OUT


def test_what_a_model_does_not_return_is_listed_and_the_rest_is_checked() -> None:
    found = list(check_model(without("azimuth", "energy")))
    assert outcomes(found, NOT_RUN) == {
        "angle of turn",
        "energy of a release",
        "another azimuth",
        "the mirror image",
        *LEFT_OUT,
    }
    # a tilt alone is held against the tilt
    assert not outcomes(found, FAILED), [f for f in found if f.failed]
    assert len(outcomes(found, PASSED)) == 7


def heavier(case: Case, support: str) -> Trace:
    body = case.cylinder
    return ours(
        dataclasses.replace(case, cylinder=dataclasses.replace(body, semidiagonal=1.01 * body.semidiagonal)),
        support,
    )


def left_handed(case: Case, support: str) -> dict[str, Any]:
    trace = ours(case, support)
    azimuth = trace.rolling_angle if case.motion is None else -trace.rolling_angle
    return {"time": trace.time, "tilt": trace.tilt, "azimuth": azimuth}


def fixed_tolerance(case: Case, support: str) -> dict[str, Any]:
    trace = ours(case, support)
    return {"time": trace.time, "tilt": trace.tilt + 1e-2 * trace.time / case.cylinder.semidiagonal**2}


def lossy(case: Case, support: str) -> dict[str, Any]:
    trace = ours(case, support)
    return {
        "time": trace.time,
        "tilt": trace.tilt * np.exp(-0.02 * trace.time),
        "azimuth": trace.rolling_angle,
    }


def restless(case: Case, support: str) -> dict[str, Any]:
    trace = ours(case, support)
    return {"time": trace.time, "tilt": np.maximum(trace.tilt, 1e-3)}


@pytest.mark.parametrize(
    ("model", "fails", "holds"),
    [
        (heavier, {"period of a release", "lean under El Centro, 12 s"}, {"another azimuth"}),
        (left_handed, {"lean under El Centro, 12 s"}, {"angle of turn", "the mirror image"}),
        (fixed_tolerance, {"four times the size, half as fast"}, set()),
        (lossy, {"tilt that it returns to", "tilt of a steady wobble"}, {"another azimuth"}),
        (restless, {"tilt where it must stand"}, {"period of a release"}),
    ],
)
def test_a_wrong_model_fails_where_it_is_wrong(
    model: Callable[[Case, str], Any], fails: set[str], holds: set[str]
) -> None:
    found = list(check_model(model))
    assert fails <= outcomes(found, FAILED)
    assert holds <= outcomes(found, PASSED)


def test_a_model_that_cannot_do_a_case_is_told_and_the_others_run() -> None:
    def only_releases(case: Case, support: str) -> Trace:
        if case.initial is None:
            raise NotImplementedError("it must be released")
        return ours(case, support)

    found = list(check_model(only_releases))
    ours_not_run = outcomes(found, NOT_RUN) - LEFT_OUT
    notes = {finding.name: finding.note for finding in found if finding.name in ours_not_run}
    assert notes == dict.fromkeys(
        ["standing", "uplift", "El Centro"], "NotImplementedError: it must be released"
    )
    assert len(outcomes(found, PASSED)) == 8


@pytest.mark.parametrize(
    ("result", "reason"),
    [
        ({"tilt": [0.1, 0.2]}, "must return time"),
        ({"time": [0.0, 1.0], "tilt": [0.1, math.nan]}, "finite numbers"),
        ({"time": [0.0, 0.0], "tilt": [0.1, 0.1]}, "time must rise"),
        ({"time": [0.0, 1.0], "tilt": [0.1]}, "as long as time"),
    ],
)
def test_what_is_no_motion_is_told(result: dict[str, Any], reason: str) -> None:
    found = list(check_model(lambda case, support: result))
    assert outcomes(found, NOT_RUN) == {finding.name for finding in found}
    assert all(reason in finding.note for finding in found if finding.name not in LEFT_OUT)


def test_a_model_is_found_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "my_rocking.py").write_text("def model(case, support):\n    return {}\n")
    monkeypatch.chdir(tmp_path)
    assert load_model("my_rocking:model")(None, "recess") == {}  # type: ignore[arg-type]
    for name, reason in (("my_rocking", "module:function"), ("my_rocking:other", "cannot be imported")):
        with pytest.raises(ValueError, match=reason):
            load_model(name)


PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = Case(PIER, initial=InitialState(0.5 * PIER.alpha, 0.0, 0.3, 0.5), duration=5.0)


def table(trace: Trace, head: str, every: int = 1) -> str:
    """The file of a motion, with tilt and azimuth in degrees, the tilt alone, or quaternions."""
    half, twist = 0.5 * trace.tilt, 0.7  # about its axis, which is nobody's concern
    lean = trace.rolling_angle - 0.5 * twist
    turn = (np.cos(half) * np.cos(0.5 * twist), -np.sin(half) * np.sin(lean))
    turn += (np.sin(half) * np.cos(lean), np.cos(half) * np.sin(0.5 * twist))
    known = {"time [s]": trace.time, "tilt [deg]": np.degrees(trace.tilt)}
    known |= {"azimuth [deg]": np.degrees(trace.rolling_angle)}
    known |= dict(zip(("qw", "qx", "qy", "qz"), turn, strict=True))
    known |= dict(zip("xyz", trace.centre_of_mass.T, strict=True))
    rows = np.column_stack([known[name] for name in head.split(", ")])[::every]
    return "\n".join([head, *(", ".join(f"{value:.12g}" for value in row) for row in rows)]) + "\n"


def checked(place: Path, text: str, **given: Any) -> list[Finding]:
    path = place / "mine.csv"
    path.write_text(text)
    return list(check_trajectory(read_trajectory(path, RELEASE), **given))


@pytest.mark.parametrize("head", ["tilt [deg], azimuth [deg]", "qw, qx, qy, qz", "tilt [deg]"])
def test_a_trajectory_is_held_against_its_case_as_far_as_one_motion_tells(tmp_path: Path, head: str) -> None:
    # at its own samples, 0.03 s apart: between them nothing is as exact
    found = checked(tmp_path, table(ours(RELEASE, "recess"), f"time [s], {head}", 6), tolerance=1e-6)
    assert outcomes(found, PASSED) == {"tilt at release", "lean up to 5 s", "peak tilt"}
    assert outcomes(found, NOT_RUN) == {
        "energy",
        *(["azimuth"] if head == "tilt [deg]" else []),
        *(f"checks of the layer {layer}" for layer in ("exact", "invariance")),
        *LEFT_OUT,
    }


def test_a_trajectory_of_another_body_fails(tmp_path: Path) -> None:
    found = checked(tmp_path, table(heavier(RELEASE, "recess"), "time [s], tilt [deg], azimuth [deg]"))
    assert outcomes(found, FAILED) == {"lean up to 5 s"}


def test_a_trajectory_that_no_comparison_would_read_is_refused(tmp_path: Path) -> None:
    trace = ours(RELEASE, "recess")
    lines = table(trace, "time [s], tilt [deg], azimuth [deg]").splitlines()
    with pytest.raises(ValueError, match=r"line 501: a gap of 0\.5 s where the usual step is"):
        checked(tmp_path, "\n".join([*lines[:500], *lines[599:]]))
    with pytest.raises(ValueError, match="must have tilt, or qw, qx, qy and qz"):
        checked(tmp_path, table(trace, "time [s], x, y, z"))
