"""What holds of any file of a kind: of any table, of columns in any order, of components of either side."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from rockwobble.models import read_record
from rockwobble.models.records.numbers import separate

Write = Callable[..., Path]

EXACT = 1e-12
MOTION = np.random.default_rng(3).normal(size=(40, 3)).round(4)


def table(columns: Sequence[NDArray[np.float64]], head: str = "") -> str:
    rows = "\n".join(" ".join(f"{value:.4f}" for value in row) for row in np.column_stack(columns))
    return f"{head}\n{rows}\n".lstrip("\n")


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("timed", [True, False])
@pytest.mark.parametrize("stated_step", [True, False])
def test_columns_are_those_that_are_named_in_any_order(
    write: Write, count: int, timed: bool, stated_step: bool
) -> None:
    """Times where they are named, and where no column of values could be them; else a step is stated."""
    times = 0.02 * np.arange(len(MOTION))
    for time_at, order in itertools.product(range(4), itertools.permutations(range(3), count)):
        columns = list(MOTION.T)
        columns.insert(time_at, times)
        places = [place + (place >= time_at) for place in order]
        named = [time_at, *places] if timed else places
        path = write(table(columns))
        read = {"columns": [place + 1 for place in named], "units": "m/s2"}
        if stated_step and not timed:
            read["time_step"] = 0.05
        given = (path,) if count > 1 else (path, "zero")
        if not (timed or stated_step):
            with pytest.raises(ValueError, match=r"--record-|times must rise"):
                read_record(*given, **read)
            continue
        motion = read_record(*given, **read)
        assert motion.time_step == pytest.approx(0.02 if timed else 0.05, rel=EXACT)
        assert motion.acceleration[:, :count] == pytest.approx(MOTION[:, list(order)], abs=EXACT)


WEST, SOUTH = ("W", "WEST", "270"), ("S", "SOUTH", "180")
EAST, NORTH = ("E", "EAST", "90", "090"), ("N", "NORTH", "360", "0")


@pytest.mark.parametrize("along", [*EAST, *WEST])
@pytest.mark.parametrize("across", [*NORTH, *SOUTH])
def test_an_at2_component_looks_to_the_side_that_its_title_states(
    write: Write, along: str, across: str
) -> None:
    """The same motion by components of either side, once it is turned to east and north."""

    def component(word: str, values: NDArray[np.float64], name: str) -> Path:
        numbers = "\n".join(f"{value:.6e}" for value in values)
        title = f"PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/1999, Station, {word}\n"
        units = "ACCELERATION TIME SERIES IN UNITS OF G\n"
        return write(f"{title}{units}NPTS= {len(values)}, DT= .0100 SEC\n{numbers}\n", name)

    x = component(along, MOTION[:, 0] * (-1.0 if along in WEST else 1.0), "x.AT2")
    y = component(across, MOTION[:, 1] * (-1.0 if across in SOUTH else 1.0), "y.AT2")
    motion = read_record(x, y, rotate="north")
    assert motion.acceleration / 9.81 == pytest.approx(MOTION[:, :2], abs=1e-9)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("last", [1, 2, 3])
def test_touching_columns_of_any_widths_are_parted_where_each_ends_in_some_line(seed: int, last: int) -> None:
    """Each column has its own decimals; a line of it is followed by a sign, others by digits."""
    chance = np.random.default_rng(seed)
    decimals = chance.permutation([2, 3, 4])  # none has those of another, so that no shape parts them
    count = int(chance.integers(2, 5))
    values = chance.uniform(1000.0, 9999.0, (count, 3))  # which leave no blank
    values[chance.integers(count - 1 if last < 3 else count)] *= -0.1
    rows = [
        [f"{value:{5 + places}.{places}f}" for value, places in zip(row, decimals, strict=True)]
        for row in values
    ]
    rows[-1] = rows[-1][:last]
    found = separate("\n".join("".join(row) for row in rows))
    assert found is not None
    assert found.split() == [cell.strip() for row in rows for cell in row]
