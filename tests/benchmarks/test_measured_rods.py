"""Estimators recover a known loss from an artificial track, and the table matches its description."""

from __future__ import annotations

import hashlib

import numpy as np
import pandas as pd
import pytest

from benchmarks.measured_rods import TABLE, TRACKS_SHA256, kept, main, passes_of

KEPT = 0.95
# error of the parabola fit over a hundred passes, with a noise of 0.3 px
FITTED = 2e-3


def made_track() -> np.ndarray:
    """Track under a constant pull to the centre that keeps KEPT of the speed at each pass."""
    random = np.random.default_rng(1)
    pull, speed, begin, step = 4e4, 6000.0, 0.0, 1.0 / 240.0
    times, places, side = [], [], 1.0
    while speed > 2200.0:
        swing = 2.0 * speed / pull
        inside = np.arange(np.ceil(begin / step), np.ceil((begin + swing) / step)) * step
        since = inside - begin
        times.append(inside)
        places.append(side * (speed * since - 0.5 * pull * since**2))
        begin, side, speed = begin + swing, -side, KEPT * speed
    time, place = np.concatenate(times), np.concatenate(places)
    # a camera that magnifies one side by a tenth
    place = np.where(place > 0.0, 1.1 * place, place)
    noise = random.normal(scale=0.3, size=(len(time), 2))
    return np.column_stack([time, place + noise[:, 0], noise[:, 1]])


def test_both_estimators_recover_a_known_loss() -> None:
    names = ["pass", "time_s", "amplitude_before_px", "amplitude_after_px"]
    names += ["speed_before_px_s", "speed_after_px_s"]
    table = pd.DataFrame(passes_of(made_track()), columns=names)
    assert len(table) > 15
    rod = kept(table.assign(diameter_mm=6, length_mm=80, release_deg=0)).iloc[0]
    assert rod["at_pass"] == pytest.approx(KEPT, abs=FITTED)
    assert rod["pass_to_pass"] == pytest.approx(KEPT, abs=FITTED)
    # the load takes nothing here, so the length is that of the pass: kept = (A - delta b)/(A + delta b)
    b, h = 3.0, 40.0
    A = b * b / 4.0 + h * h / 3.0 + b * b + h * h
    expected = (A - rod["delta_mm"] * b) / (A + rod["delta_mm"] * b)
    assert rod["pass_to_pass"] == pytest.approx(expected, rel=1e-12)  # rounding


def test_the_table_of_rods_matches_its_description() -> None:
    told = (TABLE.parent / "README.md").read_text(encoding="utf-8")
    assert hashlib.sha256(TABLE.read_bytes()).hexdigest() in told
    assert TRACKS_SHA256 in told
    table = pd.read_csv(TABLE)
    assert f"{len(table)} passes" in told
    shares = kept(table)
    assert len(shares) == 12
    assert shares["tracks"].sum() == table.groupby(["diameter_mm", "length_mm", "release_deg"]).ngroups
    assert main([]) == 0
