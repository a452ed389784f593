"""Free text: columns by their names or as the user says, and values without times."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...record_source import ALLOWED_UNITS
from ..column_names import (
    ColumnName,
    comparison_key,
    names_of,
    pattern,
    plain,
    quantity_of_unit,
    refuse_header,
    stated_step,
    without_unit,
)
from ..component import COLUMNS_OPTION, STEP_OPTION, Component, Direction, RecordFile
from ..reading import Reading
from ..table import Table, table_of
from ..units import stated_unit, unit_of

NAME, VALUES = "columns", "values without times"
_AXES: tuple[Direction, ...] = ("x", "y", "z")
_LEAST_COUNT, _LARGEST_STEP = 10, 0.1  # samples and step [s] stated before the values; of fewer it is chance
_MANY_DIGITS = re.compile(r"(?<![\d.])\d{17}")  # more than a double holds: whole numbers that touch
_EPOCH = 1e6  # [s], 11 days: times since 1970 are later, times of a record earlier
_QUANTITIES = ("acceleration", "velocity", "displacement")
# printed times are rounded, as 0.0167 for 1/60: largest deviation of a sample from its time, in steps
_UNEVENNESS = 0.05
_LONGEST_GAP = 2.0  # median steps; a longer gap means missing samples


@dataclass(frozen=True, slots=True)
class _Columns:
    """Columns of a file before their roles are assigned."""

    file: RecordFile
    values: NDArray[np.float64]
    names: Sequence[ColumnName]
    reading: Reading

    def doubt(self, why: str) -> ValueError:
        """Refusal of columns whose roles the names do not decide."""
        listed = ", ".join(f"{at} {name.text[:16]}".strip() for at, name in enumerate(self.names, 1))
        return ValueError(
            f"{self.file.name}: {why}: name them by {COLUMNS_OPTION}, time, x and y such as 1,2,3 (without "
            f"times: with {STEP_OPTION}), or all as values; it has {listed[:90]}"
        )

    def by_names(self) -> tuple[int | None, dict[int, ColumnName]]:
        """Column of times, None without one, and those of accelerations, by names and contents."""
        time = self._time()
        others = {at: name for at, name in enumerate(self.names) if at != time}
        values = {at: name for at, name in others.items() if (name.direction or name.azimuth) is not None}
        unsaid = [at for at, name in others.items() if name.kind in ("acceleration", "unknown")]
        doubtful = [at for at in unsaid if at not in values]
        if not values and len(doubtful) == 1:
            return time, {doubtful[0]: others[doubtful[0]]}
        if not unsaid:
            raise self.doubt("no column is an acceleration")
        directions = [name.direction for name in values.values() if name.direction]
        if len(set(directions)) < len(directions):
            raise self.doubt("two columns have one direction")
        if any(self.names[at].kind == "acceleration" or len(values) < len(_AXES) for at in doubtful):
            raise self.doubt(f"which direction column {doubtful[0] + 1} has is not said")
        return time, values

    def _time(self) -> int | None:
        """Column named as times, else the first if it increases as times do."""
        kinds, first = [name.kind for name in self.names], self.values[:, 0]
        times = [at for at, kind in enumerate(kinds) if kind == "time"]
        unsaid = [at for at, kind in enumerate(kinds) if kind in ("unknown", "index")]
        rising = [at for at in unsaid if _rises_evenly(self.values[:, at])]
        counts, pair = _is_counting(first), len(kinds) == 2 and kinds[0] == "unknown"
        if not times and pair and 0 in rising and not counts:
            return 0
        if len(times) > 1 or (not times and max(rising, default=0) > 0):
            raise self.doubt(f"column {(times or rising)[-1] + 1} may be times, too")
        if times:
            return times[0]
        if counts and pair and self.reading.time_step is None:
            raise self.doubt("column 1 rises by 1, as sample numbers do")
        steps = np.diff(first)
        ordered = (steps >= 0.0).all() or (steps <= 0.0).all()  # uneven times are refused with their line
        return 0 if (rising and not counts) or (pair and ordered) else None

    def by_option(self, stated: float | None) -> tuple[int | None, dict[int, ColumnName]]:
        """Column of times (None without one) and columns of accelerations that the user has named."""
        chosen = [self._place(text) for text in self.reading.column_texts]
        if len(set(chosen)) < len(chosen) or len(chosen) > len(_AXES) + 1:
            raise self.doubt(f"{','.join(self.reading.column_texts)[:60]} must name time, x, y and z once")
        kind, timeless = self.names[chosen[0]].kind, (self.reading.time_step or stated) is not None
        rises = kind in ("unknown", "index") and _rises_evenly(self.values[:, chosen[0]])
        timed = kind == "time" or rises or not timeless or len(chosen) > len(_AXES)
        time = chosen.pop(0) if len(chosen) > 1 and timed else None
        other = [at for at in chosen if self.names[at].kind not in ("acceleration", "unknown")]
        if other:
            raise self.doubt(f"column {other[0] + 1} is no acceleration")
        pairs = zip(chosen, _AXES if len(chosen) > 1 else (None,), strict=False)
        return time, {
            at: replace(self.names[at], direction=axis, sign=1.0, azimuth=None) for at, axis in pairs
        }

    def _place(self, text: str) -> int:
        """Column of a number or a name."""
        names = [name.text for name in self.names]
        if text.isdecimal() and text not in names and 0 < int(text[:9]) <= len(names):
            return int(text) - 1
        for form in (str, comparison_key, lambda name: comparison_key(without_unit(name))):
            matches = [at for at, name in enumerate(names) if form(name) == form(text)]
            if len(matches) == 1:
                return matches[0]
        raise self.doubt(f"it has no column {text[:30]!r}")


def recognizes(file: RecordFile) -> bool:
    """Whether a file is text that no other format recognises."""
    return file.lines is not None


def read(file: RecordFile, reading: Reading) -> list[Component]:
    """Components that the columns are named after, or those that the user names; or values row by row.

    Raises
    ------
    ValueError
        If names leave a doubt, or there are none for several columns; if a row holds something else than
        numbers, or the times do not rise in even steps.
    """
    table = table_of(file)
    rows, header, width = table.rows, table.header, table.width
    row_by_row = width == 1 or reading.column_texts == ("values",)
    time: int | None
    if row_by_row:
        _refuse_others_than_samples(file, table)
        names, others, time = names_of(header, 1)[0] or [ColumnName()], header, None
        values = {0: ColumnName(unit="" if quantity_of_unit(names[0].unit) == "time" else names[0].unit)}
        samples = table.values[:, np.newaxis]
    else:
        if len(rows) < 2 or rows.size < len(table.values):
            raise ValueError(
                f"{file.name}, line {table.lines[-1]}: expected {width} numbers in every row, "
                f"of at least two; {COLUMNS_OPTION} values takes all as one component, row by row"
            )
        wanted = [text for text in reading.column_texts if not text.isdecimal()]
        known, others = names_of(header, width)
        timeless = known and known[0].kind in _QUANTITIES and not any(name.kind == "time" for name in known)
        if timeless and _rises_evenly(rows[:, 0]) and not _is_counting(rows[:, 0]):
            known, others = None, header  # no names: a sentence with words like names
        names = (names_of(header, width, wanted)[0] if wanted else None) or known or [ColumnName()] * width
        columns = _Columns(file, rows, names, reading)
        time, values = columns.by_option(stated_step(file, header)) if reading.columns else columns.by_names()
        samples = np.column_stack([name.sign * rows[:, at] for at, name in values.items()])
    units = _units(file, table, list(values.values()), others)
    notes: tuple[str, ...]
    if time is None:
        stated = stated_step(file, others)
        step, start = reading.settled_step(file.name, stated), None
        notes = ("time step as given" if stated is None else "time step as its header states it",)
    else:
        samples, step, start, notes = _timed(file, table, samples, others, time, names[time], reading)
    return [
        Component(
            path=file.path,
            values=column,
            time_step=step,
            unit=unit,
            start=start,
            format=VALUES if row_by_row else NAME,
            label="" if row_by_row else without_unit(name.text) or f"column {at + 1}",
            direction=name.direction,
            azimuth=name.azimuth,
            notes=(*notes, *(("its sense is turned",) if name.sign < 0.0 else ())),
        )
        for (at, name), column, unit in zip(values.items(), samples.T, units, strict=True)
    ]


def _refuse_others_than_samples(file: RecordFile, table: Table) -> None:
    """Refuse values that include their number, times or line numbers, or that touch."""
    values, count, in_front = table.values, len(table.values) - 1, table.values[:2].tolist()
    counted = values[0] == count or (count - 1 in in_front and 0.0 < min(in_front) <= _LARGEST_STEP)
    numbered = table.width > 1 and len(table.rows) > 2 and _is_counting(table.rows[:, -1])
    paired = table.width > 1 and _rises_evenly(values[: len(values) // 2 * 2 : 2])
    touch = _MANY_DIGITS.search("\n".join(file.text))
    if (count > _LEAST_COUNT and (counted or paired)) or numbered or touch:
        raise ValueError(
            f"{file.name} holds more than the samples of one component, such as their number, times or "
            "numbers of lines: write one a line alone, or columns below their names"
        )


def _timed(
    file: RecordFile,
    table: Table,
    samples: NDArray[np.float64],
    others: Sequence[str],
    place: int,
    name: ColumnName,
    reading: Reading,
) -> tuple[NDArray[np.float64], float, float | None, tuple[str, ...]]:
    """Samples at one time step, that step [s], the time of the first [s], and notes of both."""
    time, seconds, given = table.rows[:, place], name.seconds or 1.0, reading.time_step
    other = pattern("other_time")
    doubt = next((line for line in others if name.seconds is None and other.search(plain(line[:400]))), None)
    if doubt is not None or math.isnan(seconds):
        words = (doubt or name.text).strip()[:60]
        raise ValueError(f"{file.name} says {words!r}: allowed are times in s, ms, us and ns, as 'time [ms]'")
    if given is not None and name.seconds is None and given != 1.0 and _is_counting(time):
        return samples, given, None, ("time step as given",)
    if abs(time[0] * seconds) > _EPOCH:
        raise ValueError(
            f"{file.name}: its times begin at {time[0]:.12g}, as times since an epoch do: name the other "
            f"columns by {COLUMNS_OPTION} and give the step by {STEP_OPTION}"
        )
    samples, step, notes = _even_samples(file, table, time, samples, resample=reading.resample)
    step = float(f"{step * seconds:.12g}")  # 0.01 and not 0.010000000000000002
    return samples, reading.settled_step(file.name, step), float(time[0]) * seconds, notes


def _units(
    file: RecordFile, table: Table, names: Sequence[ColumnName], others: Sequence[str]
) -> list[str | None]:
    """Unit of each column of accelerations: its own, else that of the header or of the other columns."""
    units = [unit_of(name.unit) if name.unit else None for name in names]
    for name, unit in zip(names, units, strict=True):
        if name.unit and unit is None:
            raise ValueError(f"{file.name} is in {name.unit[:20]}, allowed are {ALLOWED_UNITS}")
    accelerates = any(units) or any(name.kind == "acceleration" for name in names)
    refuse_header(file, others, table.comments, accelerates=accelerates)
    # a column with a unit of acceleration decides the meaning of the words in the header
    stated = stated_unit(file.path, [*others, *(["acceleration"] if accelerates else [])])
    if stated is not None and any(unit not in (None, stated) for unit in units):
        raise ValueError(f"{file.name} states two units: {next(filter(None, units))} and {stated}")
    alike = next(iter(known)) if len(known := {unit for unit in units if unit}) == 1 else None
    return [unit or stated or alike for unit in units]


def _rises_evenly(time: NDArray[np.float64]) -> bool:
    """Whether numbers increase in even steps, as times do."""
    return len(time) > 1 and _uneven(time)[0] is None


def _is_counting(time: NDArray[np.float64]) -> bool:
    """Whether numbers are whole and rise by 1, as row numbers do."""
    return bool((np.diff(time) == 1.0).all() and (time[0] == round(time[0])))


def _uneven(time: NDArray[np.float64]) -> tuple[int | None, float]:
    """Place of the largest jump of the step, None where all are even, and the mean step."""
    # halves, because the difference of two large floats overflows
    step = 2.0 * float(0.5 * time[-1] - 0.5 * time[0]) / (len(time) - 1)
    if not 0.0 < step < np.inf:
        return 0, step
    with np.errstate(over="ignore", invalid="ignore"):  # an infinite distance is refused as any other
        off = np.abs((time - time[0]) / step - np.arange(len(time)))
        # the place where the step changes, not that of the largest accumulated error
        jump = np.abs(np.diff(time) / step - 1.0)
    even = off.max() <= _UNEVENNESS and jump.max() <= 2.0 * _UNEVENNESS
    return (None if even else int(jump.argmax())), step


def _even_samples(
    file: RecordFile, table: Table, time: NDArray[np.float64], samples: NDArray[np.float64], *, resample: bool
) -> tuple[NDArray[np.float64], float, tuple[str, ...]]:
    """Samples (n, columns) at even times, their step in the unit of the times, and a note of changes."""
    at, step = _uneven(time)
    if at is None:
        return samples, step, ()
    if not 0.0 < step < np.inf:
        raise ValueError(f"{file.name}: times must rise [s], got {time[0]:g} s first and {time[-1]:g} s last")
    steps = np.diff(time)
    median = float(np.median(steps))
    if not resample or not 0.0 < steps.min() <= steps.max() <= _LONGEST_GAP * median:
        raise ValueError(
            f"{file.name}, line {table.lines[at + 1]}: times must rise in even steps, got {time[at + 1]:g} s "
            f"after {time[at]:g} s where the mean step is {step:.6g} s: --resample (resample=) takes samples "
            f"at even times where no step exceeds {_LONGEST_GAP:g} times the median"
        )
    even = time[0] + median * np.arange(int((time[-1] - time[0]) / median * (1.0 + 1e-12)) + 1)
    taken = np.column_stack([np.interp(even, time, column) for column in samples.T])
    return taken, median, (f"uneven times (steps of {steps.min():.6g} to {steps.max():.6g}) resampled",)
