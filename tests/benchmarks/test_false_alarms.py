"""The trial of false alarms: its cases, its rows and its rates."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pandas as pd
import pytest

from benchmarks import false_alarms
from rockwobble.models import Case, Cylinder, el_centro_1940

SHORT = Case(
    Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940().scaled(2.0), duration=2.0, name="short"
)


def test_cases_are_ordinary_and_always_the_same() -> None:
    cases = [false_alarms.case_of(number, [el_centro_1940()]) for number in range(50)]
    assert len({case.name for case in cases}) == 50
    for case in cases:
        assert 1.0 <= case.cylinder.semidiagonal <= 30.0
        assert 0.08 <= case.cylinder.tan_alpha <= 0.5
        assert case.motion is not None
        assert 1.1 <= case.motion.peak / (9.81 * case.cylinder.tan_alpha) <= 3.0
    assert false_alarms.case_of(7, [el_centro_1940()]).cylinder == cases[7].cylinder


def test_right_models_pass_and_wrong_ones_fail(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(false_alarms, "engines_here", lambda: ("mujoco",))
    monkeypatch.setattr(false_alarms, "records", lambda: [el_centro_1940()])
    numbers: list[int] = []

    def case_of(number: int, _: object) -> Case:
        numbers.append(number)
        return dataclasses.replace(SHORT, name=f"short {number}")

    monkeypatch.setattr(false_alarms, "case_of", case_of)
    kept = tmp_path / "rows.csv"
    options = ["--kept", str(kept), "--workers", "1", "--cases"]
    assert false_alarms.main([*options, "1"]) == 0
    # a later call takes what is there, and goes on behind it
    assert false_alarms.main([*options, "0"]) == 0
    assert numbers == [0]
    first, second = capsys.readouterr().out.splitlines()[-2:]
    assert first.startswith("right: 0 of 4 checks and 0 of 1 cases fail, largest value over its bound 0.")
    assert second.startswith("R 0.5 % off: ")
    assert " and 1 of 1 cases fail" in second
    table = pd.read_csv(kept)
    met = table[table["name"].str.endswith("met rocking") & (table["model"] != "right")]
    assert (met["outcome"] == "FAILED").all()
    assert (met["value"] > 50.0 * met["bound"]).all()
