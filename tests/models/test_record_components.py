"""Records from two or three files."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import read_record
from rockwobble.models.records.component import Component, Direction
from rockwobble.models.records.directions import in_order

Write = Callable[..., Path]


def columns(step: float, count: int, *, start: float = 0.0, unit: str = "g", value: float = 1.0) -> str:
    return f"t [s],a [{unit}]\n" + "\n".join(f"{start + i * step:.4f},{value * i}" for i in range(count))


def test_each_file_has_its_own_place_format_and_unit(write: Write) -> None:
    x = write("ACCELERATION IN UNITS OF G\nNPTS= 4, DT= 0.01 SEC\n" + "1.0\n" * 4, "east.AT2")
    y = write(columns(0.01, 4, unit="m/s2", value=2.0), "north.csv")
    z = write(columns(0.01, 4, unit="cm/s2", value=3.0), "up.csv")
    motion = read_record(x, y, z)
    assert motion.acceleration[3] == pytest.approx([9.81, 6.0, 0.09], rel=1e-15)
    assert motion.time_step == 0.01


def test_a_record_is_named_after_its_first_file_by_default(write: Write) -> None:
    x = write(columns(0.01, 4), "east.csv")
    assert read_record(x, x).name == "east"
    assert read_record(str(x), str(x), name="Somewhere 1999").name == "Somewhere 1999"


def test_steps_that_differ_by_printed_rounding_are_equal(write: Write) -> None:
    x, y = (write(columns(1.0 / 60.0, count), name) for name, count in (("x", 500), ("y", 498)))
    assert read_record(x, y).acceleration.shape == (498, 2)


def test_a_file_is_text_in_utf_8_or_utf_16_with_its_mark(tmp_path: Path) -> None:
    path, same = tmp_path / "x", tmp_path / "same"
    same.write_text(columns(0.01, 4), encoding="utf-8")
    for encoding in ("utf-16-le", "utf-16-be"):
        path.write_bytes(("\ufeff" + columns(0.01, 4)).encode(encoding))
        assert read_record(path, path, units="g") == read_record(same, same, units="g", name="x")
    for content, words in (
        (
            ("\ufeff" + columns(0.01, 4)).encode("utf-16-le")[:-1],
            "is text in UTF-16 that is damaged: save it",
        ),
        (columns(0.01, 4).encode("utf-16-le"), "is no text .*: it holds null bytes"),
        (b"\xef\xbb\xbf \r\n\t\n", "is empty"),
    ):
        path.write_bytes(content)
        with pytest.raises(ValueError, match=f"^the record .*x {words}"):
            read_record(path, path, units="g")


def test_a_component_of_zeros_is_planar_motion(write: Write) -> None:
    x = write(columns(0.01, 300, unit="m/s2"), "north.csv")
    for paths, moves in (((x, "zero"), 0), (("zero", x), 1)):
        motion = read_record(*paths)
        assert (motion.name, motion.acceleration.shape) == ("north", (300, 2))
        assert motion.acceleration[:, moves].tolist() == [float(i) for i in range(300)]
        assert not motion.acceleration[:, 1 - moves].any()
    with pytest.raises(ValueError, match="zero for both"):
        read_record("zero", "zero")


def component(direction: Direction | None, azimuth: float | None = None) -> Component:
    return Component(
        path=Path("record"),
        values=np.arange(3.0),
        time_step=0.01,
        unit="g",
        start=None,
        format="a",
        direction=direction,
        azimuth=azimuth,
    )


@pytest.mark.parametrize("azimuth", [0.0, 75.0, 90.0, 200.0, 359.0])
@pytest.mark.parametrize(("stated", "left"), [("x", "y"), ("y", "x")])
def test_a_component_takes_the_direction_left_by_the_others(
    stated: Direction, left: Direction, azimuth: float
) -> None:
    parts = [component("z"), component(None, azimuth), component(stated)]
    for given in itertools.permutations(parts):
        components = in_order(given, "record")
        assert [part.direction for part in components] == ["x", "y", "z"]
        assert {part.azimuth: part.direction for part in components}[azimuth] == left
