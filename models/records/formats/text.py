"""Free text: columns by their names or as the user says, and values without times."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..clocks import even_samples, is_counting, rises_evenly, since_epoch
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
from ..component import ALLOWED_UNITS, COLUMNS_OPTION, STEP_OPTION, Component, Direction, RecordFile
from ..reading import Reading
from ..table import Table, table_of
from ..units import stated_unit, unit_of

NAME, VALUES = "columns", "values without times"
_AXES: tuple[Direction, ...] = ("x", "y", "z")
_ROW_BY_ROW = ("values",)
_MOST_COLUMNS = 4  # limit for a table without names; more numbers in a row are samples
_LEAST_COUNT, _LARGEST_STEP = 10, 0.1  # samples and step [s] that may stand in front; of fewer it is chance
_SEEN = 50  # rows whose first numbers tell whether they are times
_MANY_DIGITS = re.compile(r"(?<![\d.])\d{17}")  # more than a double holds: whole numbers that touch
_QUANTITIES = ("acceleration", "velocity", "displacement")


@dataclass(frozen=True, slots=True)
class _Columns:
    """The columns of a file, to be given their roles."""

    file: RecordFile
    values: NDArray[np.float64]
    names: Sequence[ColumnName]
    reading: Reading

    def doubt(self, why: str) -> ValueError:
        """Refusal of columns that names do not settle."""
        listed = ", ".join(f"{at} {name.text[:16] or '(no name)'}" for at, name in enumerate(self.names, 1))
        return ValueError(
            f"{self.file.name}: {why}: name them by {COLUMNS_OPTION}, such as time,x,y or 1,2,3 (without "
            f"times: with {STEP_OPTION}); it has {listed[:110]}"
        )

    def by_names(self) -> tuple[int | None, dict[int, ColumnName]]:
        """Column of times, None without one, and those of accelerations, by names and what they hold."""
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
        kinds = [name.kind for name in self.names]
        times = [at for at, kind in enumerate(kinds) if kind == "time"]
        if len(times) > 1:  # apps write times since 1970 and since the start
            exact = [at for at in times if self.names[at].seconds == 1.0]
            starts = {at: self.values[0, at] * (self.names[at].seconds or 1.0) for at in times}
            times = exact if len(exact) == 1 else [at for at in times if not since_epoch(starts[at])]
        elif not times:
            unsaid = [at for at, kind in enumerate(kinds) if kind in ("unknown", "index")]
            rising = [at for at in unsaid if rises_evenly(self.values[:, at])]
            counting = [at for at in rising if is_counting(self.values[:, at])]
            times = [at for at in rising if at not in counting]
            if len(kinds) == 2 and kinds[0] == "unknown" and not (times and 0 in counting):
                steps = np.diff(self.values[:, 0])
                if 0 in counting and self.reading.time_step is None:
                    raise self.doubt("column 1 rises by 1, as sample numbers do")
                if (steps >= 0.0).all() or (steps <= 0.0).all():  # uneven times are refused with their line
                    return 0
            if times and any(kinds[at] == "unknown" for at in counting):
                raise self.doubt("two columns may be times")
        if len(times) > 1:
            raise self.doubt(f"columns {times[0] + 1} and {times[1] + 1} both may be times")
        return times[0] if times else None

    def by_option(self, stated: float | None) -> tuple[int | None, dict[int, ColumnName]]:
        """Column of times (None without one) and columns of accelerations that the user has named."""
        given, width = self.reading.column_texts, len(self.names)
        found = [self._place(text) for text in given]
        places = [at for at in found if at is not None]
        if len(places) < len(given):  # the words time, x, y and z of each column in its order
            words = ["time" if text.casefold() == "t" else text.casefold() for text in given]
            if not set(words) <= {"time", *_AXES, "-"}:
                raise self.doubt(f"it has no column {given[found.index(None)][:30]!r}")
            if len(words) != width or any(words.count(role) > 1 for role in ("time", *_AXES)):
                raise self.doubt(f"{','.join(words)[:60]} must name each column once, in their order")
            time = words.index("time") if "time" in words else None
            return time, {
                at: self._as(at, axis) for axis in _AXES for at in range(width) if words[at] == axis
            }
        if len(set(places)) < len(places) or len(places) > len(_AXES) + 1:
            raise self.doubt(f"{','.join(given)[:60]} must name each of time, x, y and z once")
        kind, timeless = self.names[places[0]].kind, (self.reading.time_step or stated) is not None
        rises = kind in ("unknown", "index") and rises_evenly(self.values[:, places[0]])
        timed = len(places) > 1 and (kind == "time" or rises or not timeless or len(places) > len(_AXES))
        time, places = (places[0], places[1:]) if timed else (None, places)
        other = [at for at in places if self.names[at].kind not in ("acceleration", "unknown")]
        if other:
            raise self.doubt(f"column {other[0] + 1} is no acceleration")
        axes = _AXES if len(places) > 1 else (None,)
        return time, {at: self._as(at, axis) for at, axis in zip(places, axes, strict=False)}

    def _as(self, place: int, axis: Direction | None) -> ColumnName:
        return replace(self.names[place], direction=axis, sign=1.0, azimuth=None)

    def _place(self, text: str) -> int | None:
        """Column of a number or a name; None where there is none."""
        names = [name.text for name in self.names]
        if text.isdecimal() and text not in names and 0 < int(text[:9]) <= len(names):
            return int(text) - 1
        for form in (str, comparison_key, lambda name: comparison_key(without_unit(name))):
            matches = [at for at, name in enumerate(names) if form(name) == form(text)]
            if len(matches) == 1:
                return matches[0]
        return None


def recognizes(file: RecordFile) -> bool:
    """Whether a file is text: what no other format claims."""
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
    names, others = names_of(header, width)
    timeless = names and names[0].kind in _QUANTITIES and not any(name.kind == "time" for name in names)
    if timeless and width > 1 and rises_evenly(rows[:, 0]) and not is_counting(rows[:, 0]):
        names, others = None, header  # a sentence that looks like names
    names = names or [ColumnName()] * width
    row_by_row = _is_row_by_row(table, names, reading)
    if row_by_row:
        _refuse_others_than_samples(file, table, reading)
        unit = next(iter(names_of(header, 1)[0] or names)).unit
        values = {0: ColumnName(unit="" if quantity_of_unit(unit) == "time" else unit)}
        time, samples, others = None, table.values[:, np.newaxis], header
    else:
        if len(rows) < 2 or rows.size < len(table.values):
            raise ValueError(
                f"{file.name}, line {table.lines[-1]}: expected at least two rows of {width} numbers; "
                f"{COLUMNS_OPTION} values takes all as one component, row by row"
            )
        wanted = [text for text in reading.column_texts if not text.isdecimal()]
        names = (names_of(header, width, wanted)[0] if wanted else None) or names
        columns = _Columns(file, rows, names, reading)
        stated = stated_step(file, header)
        time, values = columns.by_option(stated) if reading.columns else columns.by_names()
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


def _is_row_by_row(table: Table, names: Sequence[ColumnName], reading: Reading) -> bool:
    """Whether rows hold one number, more than a table of components would, or the last is shorter."""
    if table.width == 1 or reading.column_texts == _ROW_BY_ROW:
        return True
    if reading.columns or any(name.kind in ("time", "index") or name.direction for name in names):
        return False
    return table.width > _MOST_COLUMNS or table.rows.size < len(table.values)


def _refuse_others_than_samples(file: RecordFile, table: Table, reading: Reading) -> None:
    """Refuse values among which stand their number, times or numbers of lines, or that touch."""
    values, rows, count = table.values, table.rows, len(table.values) - 1
    pairs, in_front, several = values[: len(values) // 2 * 2 : 2], values[:2].tolist(), table.width > 1
    counted = values[0] == count or (count - 1 in in_front and 0.0 < min(in_front) <= _LARGEST_STEP)
    numbered = several and len(rows) > 2 and is_counting(rows[:, -1])
    timed = several and not reading.columns and len(rows) > 2 and rises_evenly(rows[:_SEEN, 0])
    paired = several and count >= _LEAST_COUNT and rises_evenly(pairs) and not rises_evenly(values)
    touch = _MANY_DIGITS.search("\n".join(file.text))
    if (counted and count > _LEAST_COUNT) or numbered or timed or paired or touch:
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
    counts = name.seconds is None and given != 1.0 and is_counting(time)
    epoch = since_epoch(time[0] * seconds)
    if given is not None and (counts or epoch):
        return samples, given, None, ("time step as given",)
    samples, step, notes = even_samples(file, time, samples, table.lines, resample=reading.resample)
    if epoch:
        raise ValueError(
            f"{file.name}: its times begin at {time[0]:.12g}, as times since an epoch do: give times from "
            f"the start of the record, or the step by {STEP_OPTION}"
        )
    step = float(f"{step * seconds:.12g}")  # 0.01 and not 0.010000000000000002
    return samples, reading.settled_step(file.name, step), float(time[0]) * seconds, notes


def _units(
    file: RecordFile, table: Table, names: Sequence[ColumnName], others: Sequence[str]
) -> list[str | None]:
    """Unit of each column of accelerations: its own, else that of the header or of the others."""
    own = [unit_of(name.unit) if name.unit else None for name in names]
    for name, unit in zip(names, own, strict=True):
        if name.unit and unit is None:
            raise ValueError(f"{file.name} is in {name.unit[:20]}, allowed are {ALLOWED_UNITS}")
    accelerates = any(own) or any(name.kind == "acceleration" for name in names)
    refuse_header(file, others, table.comments, accelerates=accelerates)
    # a column in a unit of acceleration settles what the words of the header are about
    stated = stated_unit(file.path, [*others, *(["acceleration"] if accelerates else [])])
    if stated is not None and any(unit not in (None, stated) for unit in own):
        raise ValueError(f"{file.name} states two units: {next(filter(None, own))} and {stated}")
    alike = next(iter(known)) if len(known := {unit for unit in own if unit}) == 1 else None
    return [unit or stated or alike for unit in own]
