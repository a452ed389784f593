"""TIMESERIES text of the FDSN data centres, in both its lists, by invented values."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import read_record

Write = Callable[..., Path]
CHANNELS = {"x": "HNE", "y": "HNN", "z": "HNZ"}
UNITS = {"M/S**2": 1.0, "cm/s^2": 0.01, "G": 9.81}


def channel(values: np.ndarray, code: str, rate: int, *, pairs: bool, unit: str, kind: str = "FLOAT") -> str:
    form = "TSPAIR" if pairs else "SLIST"
    head = f"TIMESERIES XX_TST__{code}_R, {len(values)} samples, {rate} sps, 2001-02-03T04:05:06.000000, "
    texts = [f"{value:.5f}" for value in values]
    if pairs:
        rows = [f"2001-02-03T04:05:{6.0 + at / rate:09.6f}  {text}" for at, text in enumerate(texts)]
    else:
        rows = ["  ".join(texts[at : at + 6]) for at in range(0, len(texts), 6)]
    return "\n".join([f"{head}{form}, {kind}, {unit}", *rows]) + "\n"


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("pairs", [True, False])
@pytest.mark.parametrize(("count", "rate"), [(12, 100), (37, 50), (60, 200)])
def test_channels_in_any_order_are_one_record(
    write: Write, count: int, rate: int, pairs: bool, unit: str
) -> None:
    motion = np.random.default_rng(count).uniform(-1.0, 1.0, (count, 3)).round(5)
    for order in ("xyz", "zyx", "yxz"):
        parts = [
            channel(motion[:, "xyz".index(axis)], CHANNELS[axis], rate, pairs=pairs, unit=unit)
            for axis in order
        ]
        found = read_record(write("".join(parts), "a.txt"))
        assert found.time_step == pytest.approx(1.0 / rate, rel=1e-12)
        assert found.acceleration == pytest.approx(UNITS[unit] * motion, rel=1e-12)
        assert "XX_TST__HNE_R" in str(found.source)


@pytest.mark.parametrize("pairs", [True, False])
def test_what_is_no_whole_record_of_accelerations_is_refused(write: Write, pairs: bool) -> None:
    values = np.linspace(-1.0, 1.0, 20)
    whole = channel(values, "HNE", 100, pairs=pairs, unit="M/S**2")
    for text, words in (
        (whole + whole, "XX_TST__HNE_R has a gap"),
        (whole.replace("20 samples", "21 samples"), "line 1: announces 21 samples, the file holds 20"),
        (whole.replace("M/S**2", "counts"), "line 1: XX_TST__HNE_R holds counts"),
        (whole.replace("FLOAT", "INTEGER"), "line 1: XX_TST__HNE_R holds counts"),
        (whole.replace("100 sps", "0 sps"), "line 1: expected channel, samples, sps"),
        (whole.replace("M/S**2", "M/S"), "M/S, allowed are"),
    ):
        with pytest.raises(ValueError, match=r"^a\.txt") as caught:
            read_record(write(text, "a.txt"), "zero")
        assert words in str(caught.value)
