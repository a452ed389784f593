"""Damaged files: a reader returns a motion or raises one clear line."""

from __future__ import annotations

import random
import time
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import read_record

pytestmark = pytest.mark.slow

DAMAGED_FILES = 400  # per seed; some 2 s altogether
LONGEST_MESSAGE = 250  # a line of a terminal or two, with the path of a temporary folder
# a pattern that backtracks needs minutes for a line of 25 digits; this line takes milliseconds
LONG_LINE, PATIENCE = 20_000, 2.0

AT2 = "TITLE\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 20, DT= .0100 SEC\n" + 4 * (
    "  -.9429229E-03  -.9236815E-03  -.9042380E-03  -.8847564E-03  -.8651242E-03\n"
)
CSV = "time [s],acceleration [cm/s^2]\r\n" + "\r\n".join(f"{0.01 * i:.2f},{0.003 * i}" for i in range(20))
SCRAPS = (
    *("nan", "inf", "-", "1e999", "1D+03", "1e", "..", "0", "-1", "9" * 400, "1_0", "0x10", "1e-400"),
    *("NPTS", "NPTS=", "NPTS= 0, DT= .1", "NPTS= 4, DT= 0 SEC", "DT= 1E400", "g", "UNITS OF", "UNITS OF G"),
    *("\x00", "é", "²", "٣", "\ufeff", "\u2028", "\x0c", "\t", "\r", "\n", ",", ";", "[", "]", "(", "#"),
)


def damaged(text: str, rng: random.Random) -> bytes:
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(text) + 1)
        match rng.randrange(5):
            case 0 | 1:
                text = text[:at] + rng.choice(SCRAPS) + text[at:]
            case 2:
                text = text[:at] + text[at + rng.randint(1, 30) :]
            case 3:
                text = text[:at] + chr(rng.randrange(128)) + text[at + 1 :]
            case 4:
                lines = text.splitlines()
                rng.shuffle(lines)
                text = "\n".join(lines)
    data = bytearray(text.encode())
    if rng.random() < 0.2 and data:
        data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


@pytest.mark.parametrize("original", [AT2, CSV], ids=["at2", "csv"])
def test_a_damaged_file_is_read_or_refused_in_one_line(tmp_path: Path, original: str) -> None:
    rng = random.Random(1940)
    path = tmp_path / "damaged.txt"
    read = 0
    for _ in range(DAMAGED_FILES):
        data = damaged(original, rng)
        path.write_bytes(data)
        try:
            motion = read_record(path, path, units=rng.choice([None, "g", "cm/s2"]))
        except ValueError as error:
            message = str(error)
            assert "damaged.txt" in message, data
            assert message.isprintable(), data
            assert len(message) <= LONGEST_MESSAGE, data
        else:
            read += 1
            assert np.isfinite(motion.acceleration).all()
    assert 0 < read < DAMAGED_FILES


@pytest.mark.parametrize("header", ["", "UNITS OF G\nNPTS= 6, DT= .01\n"], ids=["columns", "at2"])
def test_a_long_bad_line_is_refused_at_once(tmp_path: Path, header: str) -> None:
    path = tmp_path / "long.txt"
    for part, end in (("1", "x"), ("1 ", "x"), ("1..5", ""), (" ", "x")):
        path.write_text(header + part * LONG_LINE + end)
        begin = time.perf_counter()
        with pytest.raises(ValueError, match=r"long.txt") as caught:
            read_record(path, path, units="g")
        assert time.perf_counter() - begin < PATIENCE
        assert len(str(caught.value)) <= LONGEST_MESSAGE
