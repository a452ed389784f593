"""Values without times, one or several a line, as OpenSees and many folders of test motions have them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..column_names import names_of, refuse_other_quantity, refuse_scale, unit_of_time
from ..component import ALLOWED_UNITS, Component, ReadingOptions, RecordFile
from ..fill import without_fill, without_missing_end
from ..numbers import is_number, numbers_of_lines, separate, widths_of
from ..table import bare_header, cells_of, first_row, is_comment, notes_of_header
from ..times import even_step, is_counting, rises_evenly, stated_step
from ..units import stated_unit, unit_of

NAME = "values without times"
ROW_BY_ROW = "values"
_MOST_COMPONENTS = 4  # columns of a table of components with times; more numbers in a line are samples
_QUANTITIES = ("acceleration", "velocity", "displacement")
_COMMENTS = ("#", "%", "!", "//")
_MARKS = (*_COMMENTS, *',;"{}')
_SEPARATORS = str.maketrans(dict.fromkeys(',;"{}', " "))
_SEEN = 50  # rows that are looked at to tell values from columns


def recognizes(file: RecordFile) -> bool:
    """Return whether rows hold one number, more than a table of components would, or differ in length."""
    if file.lines is None:
        return False
    first = first_row(file.lines)
    rows = [
        line for line in file.lines[first : first + _SEEN] if line.strip() and not is_comment(line.strip())
    ]
    if not rows:
        return False
    cells = _cells(rows)
    if cells is None:
        return False
    widths = [len(row) for row in cells]
    width = widths[0]
    header = [bare_header(line) for line in file.lines[:first]]
    if max(widths) == 1:
        return True
    if width == 2 and len(widths) > 1 and set(widths[1:]) == {1}:  # "4096 0.025" above one number a line
        return True
    names, _ = names_of(header, width)
    if names is not None and any(name.kind in ("time", "index") or name.direction for name in names):
        return False
    last = next(line for line in reversed(file.lines) if line.strip() and not is_comment(line.strip()))
    shorter = len((_cells([last]) or [[]])[0]) < width
    if not (width > _MOST_COMPONENTS or (shorter and width > 1)):
        return False
    if len(set(widths[:-1])) > 1:
        # the first row of another length than all others belongs to a header that is not known
        return width > _MOST_COMPONENTS and (len(set(widths[1:-1])) > 1 or len(widths) < _FEWEST_LINES)
    if width % 2 == 0 and len(cells) > 1:
        pairs = np.array([float(cell) for row in cells for cell in row[::2]])
        if width > 2 and rises_evenly(pairs):  # of time and acceleration, several in a line
            return True
    column = np.array([float(row[0]) for row in cells[: max(len(cells) - 1, 1)]])
    return not (len(column) > 2 and rises_evenly(column))


def _cells(rows: Sequence[str]) -> list[list[str]] | None:
    """Return the numbers of rows as texts, parted where they touch; None where a row holds something else."""
    cells = [cells_of(row) for row in rows]
    if not all(is_number(cell) for row in cells for cell in row):
        answer = separate("\n".join(rows))
        cells = [line.split() for line in (answer or "").split("\n")]
        if not answer or not all(is_number(cell) for row in cells for cell in row):
            # numbers that touch in a way that cannot be settled are refused by the reader of values
            return [["0"] * (_MOST_COMPONENTS + 1)] if len(rows) == 1 and "." in rows[0] else None
    return [[cell.upper().replace("D", "E") for cell in row] for row in cells]


def read(file: RecordFile, options: ReadingOptions) -> list[Component]:
    """Read the samples of one component in the order of reading.

    Raises
    ------
    ValueError
        If a line holds something else than numbers, they touch and cannot be parted, or no time step is
        stated or given.
    """
    first = first_row(file.text)
    header = [text for line in file.text[:first] if (text := bare_header(line))]
    lines, of_end = without_missing_end(_rows(file, first))
    samples = numbers_of_lines(file, lines, first + 1)
    samples, of_lines = _without_line_numbers(samples, lines)
    samples, of_pairs, step = _without_times(file, samples)
    values, count_step = _without_counts(samples)
    values, of_fill = without_fill(values)
    step = step or count_step
    stated = stated_step(file, header, len(values)) or step
    of_header = notes_of_header(file.text, first, 1, options.time_step if stated is None else stated)
    notes = (*of_header, *of_lines, *of_pairs, *of_fill, *of_end)
    names, _ = names_of(header, 1)
    word = names[0].unit if names else ""
    if names and names[0].kind in _QUANTITIES and word and unit_of(word) is None and not unit_of_time(word):
        raise ValueError(f"{file.name} is in {word[:20]}, allowed are {ALLOWED_UNITS}")
    refuse_other_quantity(file, header)
    refuse_scale(file, header)
    unit = stated_unit(file.path, header)
    return [
        Component(
            path=file.path,
            values=values,
            time_step=options.settled_step(file.name, stated),
            unit=unit,
            format=NAME,
            notes=(*notes, "time step as given" if stated is None else "time step as its header states it"),
        )
    ]


def _rows(file: RecordFile, first: int) -> Sequence[str]:
    """Return the lines from one on with numbers alone, without comments, braces and separators."""
    whole = file.text[first:]
    text = "\n".join(whole)
    if not any(mark in text for mark in _MARKS):
        return whole
    if not any(mark in text for mark in (*_COMMENTS, " ", "\t")):  # so a comma is no decimal point
        return text.translate(_SEPARATORS).split("\n")
    lines = []
    for line in whole:
        text = line.strip()
        if is_comment(text):
            lines.append("")
        elif any(mark in text for mark in ',;"{}'):
            lines.append(" ".join(cells_of(text.replace("{", " ").replace("}", " "))))
        else:
            lines.append(line)
    return lines


def _without_line_numbers(
    samples: NDArray[np.float64], lines: Sequence[str]
) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """Return samples without numbers of lines that end each line, as in files of SHAKE, and a note of it."""
    filled = [line for line in lines if line.strip()]
    if len(filled) < _FEWEST_LINES or not filled[-1].split()[-1].lstrip("+").isdecimal():
        return samples, ()
    text = "\n".join(filled)
    if widths_of(text).sum() != len(samples):  # some touch
        text = separate(text) or text
    ends = np.cumsum(widths_of(text)) - 1
    if ends[-1] != len(samples) - 1 or ends[0] < 1 or not is_counting(samples[ends]):
        return samples, ()
    return np.delete(samples, ends), ("line numbers at the end of the lines left out",)


def _without_times(
    file: RecordFile, samples: NDArray[np.float64]
) -> tuple[NDArray[np.float64], tuple[str, ...], float | None]:
    """Return the accelerations of pairs of time and acceleration, with a note and their step [s]."""
    if len(samples) < _LEAST_COUNT or len(samples) % 2 or not rises_evenly(samples[::2]):
        return samples, (), None
    if rises_evenly(samples):  # a ramp
        return samples, (), None
    times = samples[::2]
    step = even_step(file, times, range(1, 1 + len(times)), 1.0)
    return samples[1::2], ("pairs of time and acceleration",), step


def _without_counts(values: NDArray[np.float64]) -> tuple[NDArray[np.float64], float | None]:
    """Return values without their number and step in front, and that step [s]."""
    count = len(values)
    if count > _LEAST_COUNT and values[0] == count - 1:
        return values[1:], None
    if count > _LEAST_COUNT and values[0] == count - 2 and 0.0 < values[1] <= _LARGEST_STEP:
        return values[2:], float(values[1])
    if count > _LEAST_COUNT and values[1] == count - 2 and 0.0 < values[0] <= _LARGEST_STEP:
        return values[2:], float(values[0])
    return values, None


_FEWEST_LINES = 4  # of which the last numbers count, which is no chance
_LEAST_COUNT = 10  # samples; fewer may equal a value by chance
_LARGEST_STEP = 0.1  # [s]
