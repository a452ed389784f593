"""Layer records: record files, from made-up ones whose numbers are known, in every form that is read.

The numbers have as many digits as the files print, so that what is read is the same to the last bit but
for one product with the unit.
"""

from __future__ import annotations

import math
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rockwobble.models import GroundMotion, read_record

from ..bench import Array, Bench, largest
from ..finding import Bound, Finding, at_most, none_wrong, worst_of

# m/s^2 of a unit; 1 g is 9.81 m/s^2, as everywhere in the package
UNITS = {"g": 9.81, "m/s2": 1.0, "cm/s2": 0.01}
SAMPLES = Bound(1e-15, "the numbers of the file times its unit")
STEP = Bound(1e-6, "DT of the header, or the mean of printed times")
COMPONENTS = Bound(1e-15, "each in its column, in its unit, a still end cut to the shortest", "m/s^2")
_COUNT = 23  # no multiple of the five numbers of a line
_HEAD = "NPTS= {n}, DT= .0100 SEC"


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    del bench
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        yield from _forms(folder)
        yield _components(folder)
        yield _tables(folder)
        yield _damaged(folder)


def _forms(folder: Path) -> Iterator[Finding]:
    values = _numbers(1)
    samples, steps = {}, {}
    for name, (text, unit, given, step) in _written(values).items():
        motion = _read(folder, [text, text], given)
        expected = UNITS[unit] * values
        same = motion.acceleration.shape == (_COUNT, 2)
        apart = largest(motion.acceleration - expected[:, None]) if same else math.inf
        samples[name] = apart / largest(expected)
        steps[name] = motion.time_step / step - 1.0
    name = f"samples of one record in {len(samples)} forms of file"
    yield worst_of(name, samples, SAMPLES, "record files: header, numbers or units")
    yield worst_of("time steps of these files", steps, STEP, "record files: time step")


def _components(folder: Path) -> Finding:
    """Three files of different length and unit: each in its column, what is still at their end cut off."""
    count = _COUNT - 6
    x, y, z = (_numbers(seed)[: _COUNT - 3 * seed] for seed in (0, 1, 2))
    for longer in (x, y):
        longer[count:] = 0.0
    motion = _read(folder, [_at2(x, _HEAD), _csv(y, 0.01, "cm/s^2", ","), _csv(z, 0.01, "m/s^2", ";")], None)
    expected = np.column_stack([9.81 * x[:count], 0.01 * y[:count], z])
    same = motion.acceleration.shape == expected.shape
    apart = largest(motion.acceleration - expected) if same else math.inf
    part = "record files: components, their units or their common length"
    return at_most("components of three files with three units", apart, COMPONENTS, part)


def _tables(folder: Path) -> Finding:
    """One file for all components: columns by their names, and by their order where they have none."""
    columns = {axis: _numbers(seed) for seed, axis in enumerate("xyz")}
    wrong = {}
    for heading in ("time [s], x [g], y [g], z [g]", "time [s], z [g], x [g], y [g]", "t, y, x in g", "in g"):
        order = re.findall(r"\b[xyz]\b", heading) or ["x", "y", "z"]
        rows = zip(*(columns[axis] for axis in order), strict=True)
        cells = (f"{0.01 * i:.2f}," + ",".join(f"{value:.6e}" for value in row) for i, row in enumerate(rows))
        motion = _read(folder, ["\n".join([heading, *cells]) + "\n"], "g")
        expected = np.column_stack([9.81 * columns[axis] for axis in sorted(order)])
        same = motion.acceleration.shape == expected.shape
        wrong[heading] = largest(motion.acceleration - expected) if same else math.inf
    part = "record files: names and order of columns"
    return worst_of(f"{len(wrong)} files of all components, columns in any order", wrong, COMPONENTS, part)


def _damaged(folder: Path) -> Finding:
    """Files that must be refused, because any reading of them would be a guess, and say where they can."""
    values = _numbers(1)
    good, even = _at2(values, _HEAD), _csv(values, 0.01, "g", ",")
    lines = even.splitlines()
    counts = f"NPTS= {_COUNT}"
    damaged: dict[str, tuple[list[str], str | None]] = {
        "fewer samples than announced": ([good.replace(counts, f"NPTS= {_COUNT + 2}")] * 2, None),
        "more samples than announced": ([good.replace(counts, f"NPTS= {_COUNT - 2}")] * 2, None),
        "two time steps": ([good, good.replace(".0100", ".0050")], None),
        "another unit than given": ([good] * 2, "m/s2"),
        "no unit at all": ([good.replace("IN UNITS OF G", "")] * 2, None),
        "a velocity": ([good.replace("ACCELERATION TIME SERIES IN UNITS OF G", "VELOCITY")] * 2, "g"),
        "a unit that is unknown": ([_csv(values, 0.01, "mm/s^2", ",")] * 2, None),
        "a sample left out": (["\n".join([*lines[:9], *lines[10:]])] * 2, None),
        "times that fall": (["\n".join([lines[0], *lines[:0:-1]])] * 2, None),
        "half a component": ([good, _at2(values[:12], _HEAD)], None),
        "two starts": ([even, _csv(values, 0.01, "g", ",", start=0.5)], None),
        "a sample that is no number": (["\n".join([*lines[:9], "0.08,nan", *lines[10:]])] * 2, None),
        "one sample": (["\n".join(lines[:2])] * 2, None),
        "times in ms": ([even.replace("time [s]", "time [ms]")] * 2, None),
        "a word among the numbers": ([good.replace("\n", "\nlost", 5)] * 2, None),
        "two columns of one name": (["t,x,x,y [g]\n0,1,2,3\n1,4,5,6\n"], None),
    }
    places = {"a sample that is no number": "line 10", "a word among the numbers": "line 5"}
    wrong = []
    for name, (texts, given) in damaged.items():
        try:
            _read(folder, texts, given)
            wrong.append(f"{name}, which is read")
        except ValueError as refused:
            if places.get(name, "") not in str(refused):
                wrong.append(f"{name}, which is refused with the words {refused}")
    name = f"damaged record files that are read, or whose damage is not placed, of {len(damaged)}"
    return none_wrong(name, wrong, "each is refused with a message", "record files: what must be refused")


def _numbers(seed: int) -> Array:
    """Numbers of either sign and of seven digits, the last one not zero."""
    drawn = np.random.default_rng(seed).uniform(-0.9, 0.9, _COUNT)
    return np.array([float(f"{value:.6e}") for value in drawn])


def _written(values: Array) -> dict[str, tuple[str, str, str | None, float]]:
    """Return text, unit, unit given and time step of each form, by name."""
    named = _at2(values, "NPTS= {n}, DT= .0050 SEC,")
    touching = _at2(values, "NPTS= {n}, DT= .0050 SEC,", "{:13.6E}")
    columns, even = _columns(values, 0.01), _csv(values, 0.01, "g", ",")
    return {
        "AT2": (named, "g", None, 0.005),
        "AT2, numbers before names": (_at2(values, "{n:5d}    .0050   NPTS, DT"), "g", "g", 0.005),
        "AT2, colons": (_at2(values, "NPTS: {n}, DT: 0.02"), "g", None, 0.02),
        "AT2, columns that touch": (touching, "g", None, 0.005),
        "AT2, exponents with D": (named.replace("E+", "D+").replace("E-", "D-"), "g", None, 0.005),
        "AT2, last line filled up": (named + "  0.0  0.0\n", "g", None, 0.005),
        "AT2, cm/s^2": (named.replace("OF G", "OF CM/SEC2"), "cm/s2", None, 0.005),
        "columns, unit given": (columns, "m/s2", "m/s2", 0.01),
        "columns, unit in a comment": ("# acceleration in gal\n" + columns, "cm/s2", None, 0.01),
        "columns, times of four digits": (_columns(values, 1.0 / 60.0), "g", "g", 0.3667 / 22.0),
        "CSV": (_csv(values, 0.004, "g", ","), "g", None, 0.004),
        "CSV, lines that end with a comma": (even.replace("\n", ",\n"), "g", None, 0.01),
        "CSV, semicolons": (_csv(values, 0.01, "m/s^2", ";"), "m/s2", None, 0.01),
        "CSV, a start that is not zero": (_csv(values, 0.01, "cm/s/s", ",", start=7.3), "cm/s2", None, 0.01),
    }


def _at2(values: Array, counts: str, cell: str = "{:15.6E}") -> str:
    head = ["PEER NGA STRONG MOTION DATABASE RECORD", "Made up, 1/1/2000, Nowhere, 90"]
    head += ["ACCELERATION TIME SERIES IN UNITS OF G", counts.format(n=len(values))]
    rows = ["".join(map(cell.format, values[i : i + 5])) for i in range(0, len(values), 5)]
    return "\n".join([*head, *rows]) + "\n"


def _columns(values: Array, step: float) -> str:
    return "".join(f"{index * step:9.4f} {value:.6e}\n" for index, value in enumerate(values))


def _csv(values: Array, step: float, unit: str, mark: str, *, start: float = 0.0) -> str:
    rows = [f"{start + index * step:.4f}{mark}{value:.6e}" for index, value in enumerate(values)]
    return "\n".join([f"time [s]{mark} acceleration [{unit}]", *rows]) + "\n"


def _read(folder: Path, texts: list[str], units: str | None) -> GroundMotion:
    paths = [folder / f"component{index}.txt" for index in range(len(texts))]
    for path, text in zip(paths, texts, strict=True):
        path.write_text(text, encoding="utf-8")
    return read_record(*paths, units=units)
