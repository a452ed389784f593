"""Properties of any file of a kind: any table, columns in any order, components of either sense."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from rockwobble.models import read_record
from rockwobble.models.records.component import open_record

Write = Callable[..., Path]

EXACT = 1e-12
MOTION = np.random.default_rng(3).normal(size=(40, 3)).round(4)


def table(columns: Sequence[NDArray[np.float64]], head: str = "") -> str:
    rows = "\n".join(" ".join(f"{value:.4f}" for value in row) for row in np.column_stack(columns))
    return f"{head}\n{rows}\n".lstrip("\n")


WEST, SOUTH = ("W", "WEST", "270"), ("S", "SOUTH", "180")
EAST, NORTH = ("E", "EAST", "90", "090"), ("N", "NORTH", "360", "0")


@pytest.mark.parametrize("along", ["EAST", "090", "W", "270"])
@pytest.mark.parametrize("across", ["N", "360", "180"])
def test_an_at2_component_has_the_azimuth_in_its_title(write: Write, along: str, across: str) -> None:
    """One motion from components of either sense, after rotation to east and north."""

    def component(word: str, values: NDArray[np.float64], name: str) -> Path:
        numbers = "\n".join(f"{value:.6e}" for value in values)
        title = f"PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/1999, Station, {word}\n"
        units = "ACCELERATION TIME SERIES IN UNITS OF G\n"
        return write(f"{title}{units}NPTS= {len(values)}, DT= .0100 SEC\n{numbers}\n", name)

    x = component(along, MOTION[:, 0] * (-1.0 if along in WEST else 1.0), "x.AT2")
    y = component(across, MOTION[:, 1] * (-1.0 if across in SOUTH else 1.0), "y.AT2")
    motion = read_record(x, y, rotate="north")
    assert motion.acceleration / 9.81 == pytest.approx(MOTION[:, :2], abs=1e-9)


def unit_vector(azimuth: float) -> NDArray[np.float64]:
    """Return east and north of an azimuth [deg]."""
    return np.array([math.sin(math.radians(azimuth)), math.cos(math.radians(azimuth))])


@pytest.mark.parametrize("first", [44, 45, 46, 250])
@pytest.mark.parametrize("turn", [90, -90])
def test_x_is_the_azimuth_nearer_to_east(write: Write, first: int, turn: int) -> None:
    """For two alike, x is clockwise of y seen from above; rotated to north they are one motion."""
    second = (first + turn) % 360
    east_north = MOTION[:, :2]
    columns = [east_north @ unit_vector(azimuth) for azimuth in (first, second)]
    path = write(table([0.01 * np.arange(len(MOTION)), *columns], f"time,{first:03d},{second:03d}"))
    motion = read_record(path, units="m/s2")
    nearer = [abs(unit_vector(azimuth)[0]) for azimuth in (first, second)]
    # x is clockwise of y where its azimuth is that of y plus 90 deg
    x = int(nearer[1] > nearer[0]) if abs(nearer[0] - nearer[1]) > 1e-9 else int(turn == 90)
    assert motion.acceleration == pytest.approx(np.column_stack([columns[x], columns[1 - x]]), abs=1e-4)
    turned = read_record(path, units="m/s2", rotate="north")
    assert turned.acceleration == pytest.approx(east_north, abs=2e-4)  # rounding of the digits in the file


@pytest.mark.parametrize(("count", "step"), [(2, 0.02), (181, 0.005)])
def test_a_record_summary_states_samples_step_and_components(write: Write, count: int, step: float) -> None:
    """A mean above a twentieth of the peak is stated, too."""
    chance = np.random.default_rng(count)
    for offset in (0.0, 0.04, 0.06):
        values = chance.choice([-1.0, 1.0], (count, 2)) * chance.uniform(0.2, 1.0, (count, 2))
        values -= values.mean(axis=0)
        values = (values / np.abs(values).max(axis=0) / [3.0, 2.0] + [offset / 3.0, 0.0]).round(6)
        times = step * np.arange(count)
        rows = "\n".join(f"{t:.6f},{a:.6f},{b:.6f}" for t, (a, b) in zip(times, values, strict=True))
        motion = read_record(write(f"time,090,N [g]\n{rows}\n"), units="g")
        x, y = values.T
        mean = f" (mean {x.mean():.3g} g)" if abs(x.mean()) > 0.05 * np.abs(x).max() else ""
        assert motion.source is not None
        assert motion.source.line.split("; ")[:3] == [
            f"x.txt: columns, {count} samples of {step:g} s, {(count - 1) * step:.5g} s",
            f"x: 090 [g] {np.abs(x).max():.4g} g{mean} at 90 deg",
            f"y: N [g] {np.abs(y).max():.4g} g",
        ]


def test_a_format_is_known_by_200_characters_of_60_lines(write: Write) -> None:
    head = open_record(write("\n".join([*["words"] * 59, "NPTS".rjust(200), "TOO LATE"]))).head
    assert (len(head), head[-1][-4:]) == (60, "NPTS")
    assert not open_record(write("NPTS".rjust(201))).head[0].endswith("NPTS")


# one unit in m/s^2, and its spellings in files; in capitals and with blanks and brackets as well
SPELLINGS = {
    "g": (9.81, "g G g's"),
    "m/s2": (1.0, "m/s2 m/s^2 m/s² m/s/s m/sec2 m/sec/sec m/s**2 m·s⁻² ms-2"),
    "cm/s2": (1e-2, "cm/s2 cm/s^2 cm/s² cm/s/s cm/sec2 cm/sec/sec cm/s**2 gal Gals cm/seg2 cm/sn2"),
    "mm/s2": (1e-3, "mm/s2 mm/s^2 mm/s/s mm/sec2 mm·s⁻²"),
    "µm/s2": (1e-6, "µm/s2 μm/s2 µm/s^2 µm/s/s"),
    "mgal": (1e-5, "mGal mgal milligal"),
    "%g": (9.81e-2, "%g"),
    "mg": (9.81e-3, "mg milli-g mg's"),
    "µg": (9.81e-6, "µg μg micro-g"),
    "ft/s2": (0.3048, "ft/s2 ft/s^2 ft/s/s ft/sec2 feet/s2"),
    "in/s2": (0.0254, "in/s2 in/s^2 in/s/s in/sec2 inches/s2"),
}


@pytest.mark.parametrize("unit", SPELLINGS)
def test_the_spelled_unit_is_used_at_every_place(write: Write, unit: str) -> None:
    """In the name of each column, in a row of units, in a line of words, or from the user."""
    factor, words = SPELLINGS[unit]
    due = factor * MOTION[:, :2]
    columns = [0.01 * np.arange(len(MOTION)), *MOTION[:, :2].T]
    for word in words.split():
        for head in (
            f"time [s],E [{word}],N [{word}]",
            f"# units: {word}\ntime,E,N",
            f"time;E;N\ns;{word};{word}",
        ):
            motion = read_record(write(table(columns, head)))
            assert motion.acceleration == pytest.approx(due, rel=1e-12, abs=0.0), head
            assert motion.source is not None
            assert [part.unit for part in motion.source.components] == [unit, unit]
        silent = write(table(columns, "time,E,N"))
        assert read_record(silent, units=word).acceleration == pytest.approx(due, rel=1e-12, abs=0.0)
    path = write(table(columns, f"time [s],E [{word}],N [{word}]"))
    with pytest.raises(ValueError, match="says that it is in"):
        read_record(path, units="m/s2" if unit == "g" else "g")


def of_times(times: NDArray[np.float64], values: NDArray[np.float64]) -> str:
    return "".join(f"{t:.9g},{value!r}\n" for t, value in zip(times.tolist(), values.tolist(), strict=True))


@pytest.mark.parametrize("drift", [-0.06, 0.04])
def test_components_may_drift_apart_by_a_twentieth_of_a_step(write: Write, drift: float) -> None:
    """Drift over the whole record, by their steps, or from the start."""
    step, times, values = 0.01, 0.01 * np.arange(400), np.random.default_rng(1).normal(size=400)
    x = write("t,a [g]\n" + of_times(times, values), "x")
    slower = write("t,a [g]\n" + of_times((1.0 + drift / 400) * times, values), "slower")
    later = write("t,a [g]\n" + of_times(times + step * drift, values), "later")
    for y, words in ((slower, "one time step"), (later, "start at one time")):
        if abs(drift) > 0.05:
            with pytest.raises(ValueError, match=f"the components of a record must .*{words}, got"):
                read_record(x, y)
        else:
            motion = read_record(x, y)
            assert motion.time_step == pytest.approx(step, rel=EXACT)
            assert motion.acceleration == pytest.approx(9.81 * np.column_stack([values, values]), rel=EXACT)


@pytest.mark.parametrize(("more", "size"), [(4, 1.0), (5, 0.051), (300, 0.049)])
@pytest.mark.parametrize("longer", [0, 1])
def test_the_excess_of_a_longer_component_is_cut_only_if_small(
    write: Write, more: int, size: float, longer: int
) -> None:
    """A hundredth of its samples, or below a twentieth of its peak; else the user decides."""
    count = 400
    values = np.random.default_rng(2).uniform(-1.0, 1.0, count + more)
    values[7] = 1.0
    values[count:] = size * np.where(np.arange(more) % 2, 1.0, -1.0)
    texts = ["t,a [g]\n" + of_times(0.01 * np.arange(n), values[:n]) for n in (count + more, count)]
    x, y = (write(texts[at != longer], "xy"[at]) for at in range(2))
    cut = 9.81 * np.column_stack([values[:count]] * 2)
    padded = np.zeros((count + more, 2))
    padded[:, longer] = 9.81 * values
    padded[:count, 1 - longer] = 9.81 * values[:count]
    for way, due in (("cut", cut), ("pad", padded)):
        assert read_record(x, y, lengths=way).acceleration == pytest.approx(due, rel=EXACT)
    if more > 0.01 * (count + more) and size > 0.05:
        with pytest.raises(
            ValueError, match=rf"got {count + more} samples in .* {100 * size:.0f} % of its peak"
        ):
            read_record(x, y)
    else:
        assert read_record(x, y).acceleration == pytest.approx(cut, rel=EXACT)


@pytest.mark.parametrize(("parts", "others"), [(1, 5), (2, 3), (20, 21), (21, 22)])
def test_components_are_resampled_to_the_largest_step_that_divides_theirs(
    write: Write, parts: int, others: int
) -> None:
    """At least a twentieth of the smaller step; every sample keeps its time."""
    common = 0.04 / parts / others
    steps = [parts * common, others * common]
    known = [np.random.default_rng(3).normal(size=round(0.4 / step) + 1) for step in steps]
    paths = [
        write("t,a [m/s2]\n" + of_times(step * np.arange(len(values)), values), name)
        for step, values, name in zip(steps, known, "xy", strict=True)
    ]
    with pytest.raises(ValueError, match="must have one time step"):
        read_record(*paths)
    if parts > 20:
        with pytest.raises(ValueError, match="at least 1/20 of the smallest"):
            read_record(*paths, resample=True, lengths="cut")
        return
    motion = read_record(*paths, resample=True, lengths="pad")
    assert motion.time_step == pytest.approx(common, rel=1e-9)
    for column, values, every in zip(motion.acceleration.T, known, (parts, others), strict=True):
        assert column[: (len(values) - 1) * every + 1 : every] == pytest.approx(values, abs=EXACT)
        if every > 1:
            between = column[: (len(values) - 1) * every].reshape(-1, every)
            slopes = np.diff(np.column_stack([between, values[1:]]), axis=1)
            assert slopes == pytest.approx(np.repeat(slopes.mean(axis=1), every).reshape(-1, every), abs=1e-9)


@pytest.mark.parametrize("head", ["UNITS OF G\nNPTS= 27, DT= .01 SEC\n", "dt=0.01 s, acc in g\n"])
def test_numbers_with_more_digits_than_a_double_are_refused(write: Write, head: str) -> None:
    """Whole numbers in fixed columns without a blank between them cannot be separated."""
    for digits in (16, 17):
        chance = np.random.default_rng(digits)
        cells = ["".join(map(str, chance.integers(1, 10, digits))) for _ in range(27)]
        path = write(head + "\n".join(" ".join(cells[at : at + 6]) for at in range(0, 27, 6)) + "\n")
        if digits > 16:
            with pytest.raises(ValueError, match=r"^x\.txt.*touch|holds more than the samples"):
                read_record(path, "zero", columns="values")
        else:
            samples = read_record(path, "zero", columns="values").acceleration[:, 0] / 9.81
            assert samples == pytest.approx([float(cell) for cell in cells], rel=1e-15)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("fill", "ratio", "refused"),
    [
        *((None, 0.997e6, False), (None, 1.003e6, True), ("9999.9", 4.9, False), ("9999.9", 5.1, True)),
        *(("12345", 5.1, True), ("9990", 5.1, False)),
    ],
)
def test_a_spike_or_a_fill_value_is_refused(
    write: Write, fill: str | None, ratio: float, refused: bool, sign: float
) -> None:
    """A million times all others, or nines or 12345 and five times them: refused, as at the end."""
    others = MOTION[:, 0] / np.abs(MOTION[:, 0]).max() * 2500.0
    spike = sign * float(fill or 2500.0 * ratio)
    others *= abs(spike) / ratio / 2500.0
    refused = refused and (fill != "12345" or sign < 0.0)
    times = 0.01 * np.arange(len(others) + 1)
    within, behind = np.insert(others, 20, spike), np.append(others, spike)
    path = write("t,a [m/s2]\n" + of_times(times, within))
    if refused:
        with pytest.raises(ValueError, match=r"sample 21 of a is .*, which stands for a missing"):
            read_record(path, "zero")
    else:
        assert read_record(path, "zero").acceleration[:, 0] == pytest.approx(within, rel=EXACT)
    if refused or fill is None:
        path = write("t,a [m/s2]\n" + of_times(times, behind))
        if refused:
            with pytest.raises(ValueError, match="ends in fill values"):
                read_record(path, "zero")
        else:
            assert read_record(path, "zero").acceleration[:, 0] == pytest.approx(behind, rel=EXACT)
