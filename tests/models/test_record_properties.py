"""What holds of any file of a kind: of any table, of columns in any order, of components of either side."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from rockwobble.models import read_record
from rockwobble.models.records.component import open_record
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


def words_of(numbers: Sequence[float], width: int) -> str:
    """Return numbers in lines of several."""
    texts = [f"{number:.6g}" for number in numbers]
    return "\n".join(" ".join(texts[at : at + width]) for at in range(0, len(texts), width)) + "\n"


@pytest.mark.parametrize("width", [1, 5, 8, 1000])
@pytest.mark.parametrize("count", [11, 24, 57])
@pytest.mark.parametrize("step", [0.002, 0.025, 0.1])
def test_values_may_begin_with_their_number_and_their_step(
    write: Write, width: int, count: int, step: float
) -> None:
    """In either order, in lines of their own or in those of the values."""
    values = np.random.default_rng(count).normal(size=count).round(4)
    for front in ([count], [count, step], [step, count]):
        texts = [words_of([*front, *values], width)]
        if front[0] == count:
            texts.append(words_of(front, 2) + words_of(values, width))
        for text in texts:
            stated = {} if step in front else {"time_step": step}
            motion = read_record(write(text), "zero", units="m/s2", **stated)
            assert motion.time_step == pytest.approx(step, rel=EXACT), text
            assert motion.acceleration[:, 0] == pytest.approx(values, abs=EXACT), text


def unit_vector(azimuth: float) -> NDArray[np.float64]:
    """Return east and north of an azimuth [deg]."""
    return np.array([math.sin(math.radians(azimuth)), math.cos(math.radians(azimuth))])


@pytest.mark.parametrize(
    "first", [0, 20, 44, 45, 46, 70, 90, 100, 135, 160, 180, 200, 225, 250, 300, 315, 340]
)
@pytest.mark.parametrize("turn", [90, -90])
def test_of_two_azimuths_x_is_the_nearer_to_east(write: Write, first: int, turn: int) -> None:
    """Where both are as near, x is clockwise of y as seen from above; turned to north they are one motion."""
    second = (first + turn) % 360
    east_north = MOTION[:, :2]
    columns = [east_north @ unit_vector(azimuth) for azimuth in (first, second)]
    path = write(table([0.01 * np.arange(len(MOTION)), *columns], f"time,{first:03d},{second:03d}"))
    motion = read_record(path, units="m/s2")
    nearer = [abs(unit_vector(azimuth)[0]) for azimuth in (first, second)]
    # x follows y clockwise where its azimuth is y's and 90 deg
    x = int(nearer[1] > nearer[0]) if abs(nearer[0] - nearer[1]) > 1e-9 else int(turn == 90)
    assert motion.acceleration == pytest.approx(np.column_stack([columns[x], columns[1 - x]]), abs=1e-4)
    turned = read_record(path, units="m/s2", rotate="north")
    assert turned.acceleration == pytest.approx(east_north, abs=2e-4)  # of the digits in the file


LONGEST_ROW = 400  # characters of a row in which a clock time is looked for


@pytest.mark.parametrize("length", [60, 200, LONGEST_ROW - 1, LONGEST_ROW, LONGEST_ROW + 1, 500])
@pytest.mark.parametrize("alike", [True, False])
def test_a_clock_time_is_read_in_a_row_of_any_usual_length(write: Write, length: int, alike: bool) -> None:
    """At one place of all rows, or at several: one blank more in some."""
    rows = []
    for at, (east, north) in enumerate(MOTION[:, :2]):
        blank = " " if at % 3 == 1 and not alike else ""
        row = f"{blank}10:20:{30 + 0.02 * at:06.3f},{east:.4f},{north:.4f},"
        rows.append(row + "0." + "0" * (length - len(row) - 2))
    path = write("clock,E [m/s2],N [m/s2],volts [V]\n" + "\n".join(rows) + "\n")
    if length > LONGEST_ROW:
        with pytest.raises(ValueError, match=r"its times are dates|expected"):
            read_record(path)
        return
    motion = read_record(path)
    assert motion.time_step == pytest.approx(0.02, rel=1e-9)
    assert motion.acceleration == pytest.approx(MOTION[:, :2], abs=EXACT)


@pytest.mark.parametrize("lines", [0, 2, 40, 4500, 6000])
def test_a_damaged_sample_is_refused_with_its_line_in_whatever_block(write: Write, lines: int) -> None:
    """Velocities stand before it, in so many lines."""
    velocities = ["Velocity (cm/s)", *["0.25"] * lines] if lines else []
    for damaged in (7, 20, len(MOTION) - 1):
        samples = [f"{value:.4f}" for value in MOTION[:, 0]]
        samples[damaged] = "x.5"
        text = [*velocities, "Acceleration (m/s2), dt = 0.01 s", *samples, "Displacement (cm)", "1.0", "2.0"]
        at = len(velocities) + 2 + damaged
        with pytest.raises(ValueError, match=rf"^x\.txt, line {at}: .*got 'x\.5'"):
            read_record(write("\n".join(text) + "\n"), "zero")


HEADS = [",".join(["time", *names]) for names in itertools.permutations(("E", "N", "Z"))]


@pytest.mark.parametrize("lower", HEADS)
def test_of_two_lines_that_name_columns_the_lower_one_does(write: Write, lower: str) -> None:
    times = 0.02 * np.arange(len(MOTION))
    places = {name: place for place, name in enumerate(lower.split(","))}
    for upper in HEADS:
        for between in ("", "# a line of words\n"):
            path = write(table([times, *MOTION.T], f"{upper}\n{between}{lower}"))
            found = read_record(path, units="m/s2").acceleration
            due = MOTION[:, [places[name] - 1 for name in "ENZ"]]
            assert found == pytest.approx(due, abs=EXACT), (upper, lower)


@pytest.mark.parametrize("count", [2, 40, 181])
@pytest.mark.parametrize("step", [0.005, 0.01, 0.02])
def test_the_line_of_a_record_states_its_samples_their_step_and_each_component(
    write: Write, count: int, step: float
) -> None:
    """A mean above a twentieth of the peak is said beside it."""
    chance = np.random.default_rng(count)
    for offset in (0.0, 0.04, 0.06, 0.5):
        values = chance.choice([-1.0, 1.0], (count, 2)) * chance.uniform(0.2, 1.0, (count, 2))
        values -= values.mean(axis=0)
        values /= np.abs(values).max(axis=0) * np.array([3.0, 2.0])
        values[:, 0] += offset / 3.0
        columns = [step * np.arange(count), *values.T.round(6)]
        rows = "\n".join(",".join(f"{cell:.6f}" for cell in row) for row in np.column_stack(columns))
        motion = read_record(write(f"time,090,N [g]\n{rows}\n"), units="g")
        x, y = (column.round(6) for column in values.T)
        mean = f" (mean {x.mean():.3g} g)" if abs(x.mean()) > 0.05 * np.abs(x).max() else ""
        assert motion.source is not None
        first, east, north = motion.source.line.split("; ")[:3]
        duration = (count - 1) * step
        assert first == f"x.txt: columns, {count} samples of {step:g} s, {duration:.5g} s"
        assert east == f"x: 090 [g] {np.abs(x).max():.4g} g{mean} at 90 deg"
        assert north == f"y: N [g] {np.abs(y).max():.4g} g"
        assert motion.source.duration == pytest.approx(duration, rel=EXACT)


@pytest.mark.parametrize("before", [150, 195, 196, 197, 250])
def test_a_format_is_known_by_the_first_200_characters_of_a_line(write: Write, before: int) -> None:
    path = write("NPTS".rjust(before + 4, ".") + "\nwords\n")
    assert any("NPTS" in line for line in open_record(path).head) == (before + 4 <= 200)


@pytest.mark.parametrize("line", [0, 1, 30, 58, 59, 60, 61])
def test_a_format_is_known_by_the_first_60_lines(write: Write, line: int) -> None:
    path = write("\n".join([*["words"] * line, "a mark", *["words"] * 70]))
    assert ("A MARK" in open_record(path).head) == (line < 60)


# one unit in m/s^2, and how files spell it; in capitals and with blanks and brackets as well
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
WORDS = [(unit, word) for unit, (_, words) in SPELLINGS.items() for word in words.split()]


@pytest.mark.parametrize(("unit", "word"), WORDS)
def test_numbers_are_in_the_unit_that_is_spelled_wherever_it_stands(
    write: Write, unit: str, word: str
) -> None:
    """In the name of each column, in a row of units, in a line of words, or as the user gives it."""
    due = SPELLINGS[unit][0] * MOTION[:, :2]
    columns = [0.01 * np.arange(len(MOTION)), *MOTION[:, :2].T]
    heads = [
        f"time [s],E [{word}],N [{word}]",
        f"time [s];E ({word});N ({word})",
        f"# units: {word}\ntime,E,N",
    ]
    heads += [f"time,E,N\ns,{word},{word}"]
    for head in heads:
        motion = read_record(write(table(columns, head)))
        assert motion.acceleration == pytest.approx(due, rel=1e-12, abs=0.0), head
        assert motion.source is not None
        assert [part.unit for part in motion.source.components] == [unit, unit]
        assert [part.peak for part in motion.source.components] == pytest.approx(
            np.abs(due).max(axis=0) / 9.81, rel=1e-12
        )
    silent = write(table(columns, "time,E,N"))
    assert read_record(silent, units=word).acceleration == pytest.approx(due, rel=1e-12, abs=0.0)
    # what the user gives beside it is the same unit, or contradicts it
    for other in SPELLINGS:
        path = write(table(columns, heads[0]))
        if other == unit:
            assert read_record(path, units=other).acceleration == pytest.approx(due, rel=1e-12, abs=0.0)
        else:
            with pytest.raises(ValueError, match="says that it is in"):
                read_record(path, units=other)


SECONDS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "msec": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}


@pytest.mark.parametrize("word", SECONDS)
@pytest.mark.parametrize("step", [0.002, 0.01, 0.025])
def test_times_are_in_the_unit_that_is_spelled(write: Write, word: str, step: float) -> None:
    steps = step / SECONDS[word] * np.arange(len(MOTION))
    for head in (f"time [{word}],E,N", f"t ({word}),E,N", f"Time in {word},E,N", f"time,E,N\n{word},g,g"):
        motion = read_record(write(table([steps, *MOTION[:, :2].T], head)), units="g")
        assert motion.time_step == pytest.approx(step, rel=1e-9), head
        assert motion.source is not None
        assert motion.source.time_step == pytest.approx(step, rel=1e-9)


def of_times(times: NDArray[np.float64], values: NDArray[np.float64]) -> str:
    return "".join(f"{t:.9g},{value!r}\n" for t, value in zip(times.tolist(), values.tolist(), strict=True))


@pytest.mark.parametrize("drift", [-0.06, -0.04, 0.0, 0.04, 0.06])
@pytest.mark.parametrize("count", [50, 400])
def test_components_may_drift_apart_by_a_twentieth_of_a_step(write: Write, drift: float, count: int) -> None:
    """Over the whole record, by their steps, or from the start."""
    step, values = 0.01, np.random.default_rng(1).normal(size=count)
    x = write("t,a [g]\n" + of_times(step * np.arange(count), values), "x")
    other_step = step * (1.0 + drift / count)
    slower = write("t,a [g]\n" + of_times(other_step * np.arange(count), values), "slower")
    later = write("t,a [g]\n" + of_times(step * (np.arange(count) + drift), values), "later")
    for y, words in ((slower, "one time step"), (later, "start at one time")):
        if abs(drift) > 0.05:
            with pytest.raises(ValueError, match=f"the components of a record must .*{words}, got"):
                read_record(x, y)
        else:
            motion = read_record(x, y)
            assert motion.time_step == pytest.approx(step, rel=EXACT)
            assert motion.acceleration == pytest.approx(9.81 * np.column_stack([values, values]), rel=EXACT)


@pytest.mark.parametrize(
    ("more", "size"), [(4, 1.0), (5, 1.0), (5, 0.051), (5, 0.049), (300, 0.051), (300, 0.049)]
)
@pytest.mark.parametrize("longer", [0, 1])
def test_what_is_left_of_a_longer_component_is_little_or_over(
    write: Write, more: int, size: float, longer: int
) -> None:
    """A hundredth of its samples, or below a twentieth of its peak; else the user says what becomes of it."""
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
        motion = read_record(x, y, lengths=way)
        assert motion.acceleration == pytest.approx(due, rel=EXACT)
        assert f"{count}" in str(motion.source)
    if more > 0.01 * (count + more) and size > 0.05:
        with pytest.raises(
            ValueError, match=rf"got {count + more} samples in .* {100 * size:.0f} % of its peak"
        ):
            read_record(x, y)
    else:
        assert read_record(x, y).acceleration == pytest.approx(cut, rel=EXACT)


@pytest.mark.parametrize(
    ("parts", "others"), [(1, 2), (1, 5), (2, 3), (3, 4), (7, 9), (19, 20), (20, 21), (21, 22)]
)
def test_components_are_resampled_to_the_largest_step_that_divides_theirs(
    write: Write, parts: int, others: int
) -> None:
    """At least a twentieth of the smaller step; every sample stays, at its time."""
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


@pytest.mark.parametrize("digits", [1, 8, 15, 16, 17, 18, 25, 40])
@pytest.mark.parametrize("head", ["UNITS OF G\nNPTS= 27, DT= .01 SEC\n", "dt=0.01 s, acc in g\n"])
def test_more_digits_than_a_number_has_are_numbers_that_touch(write: Write, digits: int, head: str) -> None:
    """Whole numbers of fixed columns without a blank between them cannot be parted."""
    chance = np.random.default_rng(digits)
    cells = ["".join(map(str, chance.integers(1, 10, digits))) for _ in range(27)]
    rows = [" ".join(cells[at : at + 6]) for at in range(0, 27, 6)]
    path = write(head + "\n".join(rows) + "\n")
    if digits > 16:
        with pytest.raises(ValueError, match=rf"^x\.txt, line {head.count(chr(10)) + 1}: its numbers touch"):
            read_record(path, "zero")
        return
    found = read_record(path, "zero").acceleration[:, 0] / 9.81
    assert found == pytest.approx([float(cell) for cell in cells], rel=1e-15)


@pytest.mark.parametrize(("ratio", "refused"), [(1.0, False), (0.997e6, False), (1.003e6, True), (1e9, True)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_spike_of_a_million_times_all_others_is_no_sample(
    write: Write, ratio: float, refused: bool, sign: float
) -> None:
    """Among samples it is refused; behind the last it is left out, and said."""
    others = MOTION[:, 0] / np.abs(MOTION[:, 0]).max() * 0.25
    spike = sign * 0.25 * ratio
    times = 0.01 * np.arange(len(others) + 1)
    within, behind = np.insert(others, 20, spike), np.append(others, spike)
    if refused:
        with pytest.raises(
            ValueError, match=rf"sample 21 of a is {re.escape(f'{spike:g}')}, which stands for a missing"
        ):
            read_record(write("t,a [m/s2]\n" + of_times(times, within)), "zero")
    else:
        found = read_record(write("t,a [m/s2]\n" + of_times(times, within)), "zero")
        assert found.acceleration[:, 0] == pytest.approx(within, rel=EXACT)
    motion = read_record(write("t,a [m/s2]\n" + of_times(times, behind)), "zero")
    assert motion.acceleration[:, 0] == pytest.approx(others if refused else behind, rel=EXACT)
    assert ("1 fill value of" in str(motion.source)) == refused


@pytest.mark.parametrize(
    "fill", ["-999", "999", "-9999.9", "9999", "99999", "-999.0", "-12345", "-998", "9990"]
)
@pytest.mark.parametrize("times", [4.9, 5.1])
def test_a_number_that_fills_places_is_one_where_it_is_five_times_all_others(
    write: Write, fill: str, times: float
) -> None:
    """Of nines alone, or -12345; where the motion itself is as large, it is a sample."""
    value = float(fill)
    others = MOTION[:, 0] / np.abs(MOTION[:, 0]).max() * abs(value) / times
    samples = np.insert(others, 20, value)
    path = write("t,a [cm/s2]\n" + of_times(0.01 * np.arange(len(samples)), samples))
    if times > 5.0 and set(fill.lstrip("-").replace(".0", "")) in ({"9"}, {"9", "."}, set("12345")):
        with pytest.raises(ValueError, match=r"sample 21 of a is .*, which stands for a missing one"):
            read_record(path, "zero")
    else:
        found = read_record(path, "zero").acceleration[:, 0]
        assert found == pytest.approx(0.01 * samples, rel=EXACT)


@pytest.mark.parametrize("columns", [1, 2, 3])
@pytest.mark.parametrize("place", [1, 2, 5, 20])
def test_samples_above_a_damaged_row_do_not_vanish_in_silence(write: Write, columns: int, place: int) -> None:
    """Words may end a header: what stands above them as samples do is refused or named."""
    rows = table(list(MOTION.T[:columns])).splitlines()
    rows[place] = "damaged"
    path = write("\n".join(rows) + "\n")
    given = (path, "zero") if columns == 1 else (path,)
    places = [*range(1, columns + 1)] if columns > 1 else None
    try:
        said = str(read_record(*given, columns=places, units="m/s2", time_step=0.02).source)
    except ValueError as error:
        said = str(error)
    assert re.search(r"line 1 holds numbers alone|x\.txt, line \d+: ", said)


@pytest.mark.parametrize(
    "head",
    [
        "0.02\nacceleration",
        "2.0D-02\nacceleration",
        "40\nacceleration",
        "acceleration\n40",
        "# 0.3\n",
        "0.12-0.34\nacceleration",
        ";\nacceleration",
        ",\nacceleration",
        "-\nacceleration",
    ],
)
def test_what_is_no_lone_sample_stands_in_a_header_by_right(write: Write, head: str) -> None:
    motion = read_record(write(table([MOTION[:, 0]], head)), "zero", units="m/s2", time_step=0.02)
    assert motion.acceleration[:, 0] == pytest.approx(MOTION[:, 0], abs=EXACT)
    assert "holds numbers alone" not in str(motion.source)


_SCRAPS = [
    "0.12",
    "-0.3",
    "1e-3",
    "2.0D-02",
    "40",
    ",",
    ";",
    "-",
    "+",
    ".",
    "nan",
    "inf",
    "words",
    "m/s2",
    "g",
    "#",
    "%",
    "0.12-0.34",
    "12:00:01",
    "2024-01-02",
    "|",
    '"',
    "{",
    "}",
    "()",
]


@pytest.mark.slow
def test_whatever_stands_in_a_text_it_is_read_or_refused_in_one_line(write: Write) -> None:
    random = np.random.default_rng(57)

    def scraps(most: int) -> str:
        return " ".join(random.choice(_SCRAPS, random.integers(1, most)))

    for _ in range(1500):
        width, separator = random.integers(1, 5), random.choice([" ", ",", ";", "\t"])
        rows = [scraps(5) for _ in range(random.integers(0, 7))]
        samples = random.normal(size=(random.integers(0, 40), width))
        rows += [separator.join(f"{value:.4f}" for value in row) for row in samples]
        if random.random() < 0.3:
            rows.insert(random.integers(len(rows) + 1), scraps(5))
        path = write("\n".join(rows) + "\n")
        given = (path, "zero") if random.random() < 0.5 else (path,)
        try:
            read_record(*given, units="g", time_step=0.01 if random.random() < 0.7 else None)
        except ValueError as error:
            said = str(error)
            if "\n" in said or "could not convert" in said or len(said) > 500:  # of the inside of Python
                pytest.fail(f"{said}: {rows[:8]}")
