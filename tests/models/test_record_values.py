"""Values without times, numbers that touch, and what is said of a record."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import read_record
from rockwobble.models.records.units import doubts

Write = Callable[..., Path]
VALUES = np.round(np.sin(np.arange(37) * 0.7) * np.exp(-0.1 * np.arange(37)) * 0.3, 5)


def lines(width: int, form: str = "{:10.5f}") -> str:
    texts = [form.format(value) for value in VALUES]
    return "\n".join("".join(texts[i : i + width]) for i in range(0, len(texts), width)) + "\n"


@pytest.mark.parametrize("width", [1, 5, 8])
@pytest.mark.parametrize(
    ("header", "step"),
    [
        ("dt=0.005 sec", 0.005),
        ("37 points at equal spacing of 0.02 sec", 0.02),
        ("37 0.025000", 0.025),
        ("# Time Step: 0.005", 0.005),
        ("Sampling rate (Hz): 200", 0.005),
        ("sampling interval (ms): 10", 0.01),
    ],
)
def test_a_step_in_words(write: Write, width: int, header: str, step: float) -> None:
    path = write(f"{header}\n{lines(width)}")
    motion = read_record(path, "zero", units="g")
    assert motion.time_step == pytest.approx(step, rel=1e-12)
    assert motion.acceleration[:, 0] == pytest.approx(9.81 * VALUES, abs=1e-12)
    with pytest.raises(ValueError, match="but --record-step"):
        read_record(path, "zero", units="g", time_step=3.0 * step)


def test_a_step_that_is_given(write: Write) -> None:
    path = write(lines(5))
    with pytest.raises(ValueError, match=r"no times and states no time step: .* --record-step"):
        read_record(path, "zero", units="g")
    assert read_record(path, "zero", units="g", time_step=0.01).time_step == 0.01


@pytest.mark.parametrize("form", ["{:.5f}", "{:8.5f}"])
def test_all_numbers_on_one_line_without_blanks(write: Write, form: str) -> None:
    path = write(lines(1000, form).replace(" ", "") + "\x1a")
    motion = read_record(path, "zero", units="g", time_step=0.01)
    assert motion.acceleration[:, 0] == pytest.approx(9.81 * VALUES, abs=1e-12)


@pytest.mark.parametrize("text", ["0.50.25", "1.5-100 2.5-200 1.1", "0.12.123 1.1234.5 0.1"])
def test_numbers_that_touch_in_two_ways_are_refused(write: Write, text: str) -> None:
    with pytest.raises(ValueError, match=r"touch|expected"):
        read_record(write(text + "\n" + text + "\n"), "zero", units="g", time_step=0.01)


TIME = np.arange(400) * 0.01
WAVE = np.sin(20.0 * TIME) * np.exp(-2.0 * TIME)


def pair(x: np.ndarray, y: np.ndarray, unit: str = "g", step: float = 0.01) -> str:
    rows = (f"{i * step:g},{a:.6f},{b:.6f}" for i, (a, b) in enumerate(zip(x, y, strict=True)))
    return f"time [s],E [{unit}],N [{unit}]\n" + "\n".join(rows) + "\n"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (pair(0.2 * WAVE + 0.05, 0.2 * WAVE), "offset"),
        (pair(0.2 * WAVE, 0.2 * WAVE + 1.0), "gravity_in_record"),
        (pair(3.0 * WAVE, 2.0 * WAVE), "large_peak"),
        (pair(0.2 * WAVE, 0.2 * np.flip(WAVE)), "ends_in_strong_motion"),
        (pair(0.4 * WAVE, 0.01 * np.roll(WAVE, 3)), "unlike_components"),
        (pair(0.2 * WAVE, 0.1 * WAVE, step=0.5), "unlikely_step"),
    ],
)
def test_a_doubt_is_said_and_stays(write: Write, text: str, code: str) -> None:
    motion = read_record(write(text))
    for copy in (motion, motion.scaled(0.1), motion.rotated(0.5)):
        assert code in [fact.code for fact in doubts(copy)]
    assert motion.source is not None
    assert "\n" not in motion.source.line


def test_what_was_done_is_said(write: Write) -> None:
    motion = read_record(write(pair(0.2 * WAVE + 0.05, 0.2 * WAVE)), remove_mean=True)
    assert motion.acceleration.mean(axis=0) == pytest.approx([0.0, 0.0], abs=1e-12)
    assert doubts(motion) == ()
    line = motion.scaled(2.0).rotated(np.pi / 6.0).source
    assert line is not None
    assert line.changes[-2:] == ("scaled by 2", "rotated by 30 deg")


@pytest.mark.parametrize(("lengths", "count"), [("pad", 400), ("cut", 300)])
def test_lengths_that_differ(write: Write, lengths: str, count: int) -> None:
    x = write(
        "t [s],a [g]\n" + "\n".join(f"{t:.2f},{v:.5f}" for t, v in zip(TIME, WAVE[::-1], strict=True)), "x"
    )
    y = write(
        "t [s],a [g]\n" + "\n".join(f"{t:.2f},{v:.5f}" for t, v in zip(TIME[:300], WAVE[:300], strict=True)),
        "y",
    )
    with pytest.raises(ValueError, match=r"--lengths pad .* --lengths cut"):
        read_record(x, y)
    assert len(read_record(x, y, lengths=lengths).acceleration) == count
