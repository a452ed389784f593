"""Slides are judged by displacement, mode and twist; the command adds them up."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rockwobble import reduced

from .who_can_slide import draws, judged, main


def test_slide_with_displacement_error_or_twist_is_wrong() -> None:
    case = next(draws())
    exact = reduced.simulate(case, support="flat", sample_step=0.01)
    assert judged(case, exact) == (0.0, "")
    assert case.motion is not None
    other = reduced.simulate(replace(case, motion=case.motion.scaled(1.1)), support="flat", sample_step=0.01)
    wrong = judged(case, replace(other, twist=other.twist + 0.02))[1].split(", ")
    assert wrong[0].endswith(" %")
    assert wrong[1:] == ["twist 0.020"]


def test_who_can_slide_counts_correct_draws(capsys: pytest.CaptureFixture[str]) -> None:
    main(["mujoco", "exudyn", "--draws", "1"])
    told = capsys.readouterr().out
    assert "mujoco: right without a diagnostic 1 of 1, wrong without one 0" in told
    assert "exudyn: cannot start from rest" in told
