"""Numbers in record files: in blocks, fixed columns and tables, with fill values for missing samples."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .component import Component, RecordFile

# a single way to match each text, so that the time is linear in the length of a line
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][-+]?\d+)?"
_ALLOWED = b"0123456789+-.eE \t\n\r"
# columns without a blank before the sign of the next, or after an exponent of two digits
_TOUCHING = re.compile(r"(?<=[\d.])(?=[-+])|(?<=[EeDd][-+]\d\d)(?=\d?\.\d)")
_LOST_E = re.compile(r"(?<=\d)([-+]\d{3})(?![\d.])")  # Fortran leaves out the E before three digits
_MANY_DIGITS = re.compile(r"(?<![\d.])\d{17}")  # more than a double holds: whole numbers that touch
# "(8F10.3)", "(1E15.6)", "(10I8)": repetitions and width
_FORMAT = re.compile(r"\(?\b(\d{1,3})\s*[FEGI](\d{1,3})(?:\.\d{1,3})?\b", re.IGNORECASE)
_CHUNK = 4096  # lines parsed together in the search for a damaged one
_LONGEST_LINE = 200  # [characters]; bounds the time of a pattern on a damaged line
_FILL = re.compile(r"-?9{3,}(?:\.(?:9+|0))?|-12345\.0")
_FAR = 5.0  # ratio to the largest of all other samples
_BEYOND = 1e6  # ratio to the largest of all other samples: no record has such a spike, whatever its digits
_LEAST = 999.0  # least absolute value of a fill number


def parse_number(path: Path, line_number: int, token: str) -> float:
    """Parse a finite number; Fortran writes D for the exponent of a double.

    Raises
    ------
    ValueError
        If the token is not a number, or not a finite one.
    """
    try:
        value = float(re.sub("[Dd](?=[-+0-9])", "E", token))
    except ValueError:
        raise ValueError(f"{path.name}, line {line_number}: expected a number, got {token[:60]!r}") from None
    if not math.isfinite(value):
        raise ValueError(
            f"{path.name}, line {line_number}: a sample must be a finite number, got {token[:60]!r}"
        )
    return value


def is_number(cell: str) -> bool:
    """Whether a text is a number, including NaN and infinity."""
    return re.fullmatch(NUMBER, cell) is not None or cell.lower().lstrip("+-") in ("nan", "inf", "infinity")


def plain_numbers(text: str) -> NDArray[np.float64] | None:
    """Numbers of a text separated by blanks; None if there is other text, or numbers touch."""
    if "D" in text or "d" in text:
        text = text.replace("D", "E").replace("d", "E")
    if not text.isascii():
        return None
    content = text.encode("ascii")
    if content.translate(None, _ALLOWED):
        return None
    count = int(_begins(content).sum())
    try:
        values = np.fromstring(content, dtype=np.float64, sep=" ")
    except ValueError:  # the rest of the text holds no numbers
        return None
    # touching numbers parse as more than the cells between blanks
    return values if len(values) == count and np.isfinite(values).all() else None


def _begins(content: bytes) -> NDArray[np.bool_]:
    """Positions in a text at which a cell begins after a blank."""
    blank = np.frombuffer(content, dtype=np.uint8) <= ord(" ")
    before = np.concatenate([[True], blank[:-1]]) if len(blank) else blank
    return np.asarray(~blank & before)


def widths_of(text: str) -> NDArray[np.int64]:
    """Number of cells between blanks in each line, none of which is blank (n,)."""
    content = text.encode()
    ends = np.flatnonzero(np.frombuffer(content, dtype=np.uint8) == ord("\n"))
    before = np.searchsorted(np.flatnonzero(_begins(content)), np.concatenate([[0], ends, [len(content)]]))
    return np.asarray(np.diff(before), dtype=np.int64)


def block_of_numbers(file: RecordFile, first: int, last: int | None = None) -> NDArray[np.float64]:
    """The numbers of lines `first` (counted from 0) to `last` (left out), in reading order (n,).

    Blanks part them, or what takes the place of a blank in the fixed columns of Fortran: the sign of a
    number, or the end of an exponent.

    Raises
    ------
    ValueError
        If a line holds something else, numbers that touch, or a number that is not finite: the line is named.
    """
    lines = file.text[first:last]
    values = _signed_numbers("\n".join(lines))
    if values is not None:
        return values
    at = _first_damaged(len(lines), lambda a, b: _signed_numbers("\n".join(lines[a:b])) is not None)
    for token in lines[at].split():
        if re.fullmatch(NUMBER, token):
            parse_number(file.path, first + 1 + at, token)
    raise ValueError(
        f"{file.name}, line {first + 1 + at}: expected accelerations that do not touch, got "
        f"{lines[at].strip()[:60]!r}"
    )


def _signed_numbers(text: str) -> NDArray[np.float64] | None:
    if _MANY_DIGITS.search(text):
        return None
    values = plain_numbers(text)
    if values is None and not ("." in text and _LOST_E.search(text)):
        values = plain_numbers(_TOUCHING.sub(" ", text))
    return values


def _first_damaged(count: int, is_whole: Callable[[int, int], bool]) -> int:
    """First incomplete of `count` lines; parsed in chunks, as a million one by one take seconds."""
    chunks = range(0, count, _CHUNK)
    begin = next((at for at in chunks if not is_whole(at, min(at + _CHUNK, count))), 0)
    return next((at for at in range(begin, min(begin + _CHUNK, count)) if not is_whole(at, at + 1)), begin)


def stated_format(line: str, default: tuple[int, int]) -> tuple[int, int]:
    """Count and width of the numbers of a line, from a format such as "(8F10.3)" in a header.

    Parameters
    ----------
    line : str
    default : tuple of int
        Default of a header that states none.
    """
    match = _FORMAT.search(line[:_LONGEST_LINE])
    return (int(match[1]), int(match[2])) if match and int(match[1]) * int(match[2]) else default


def fixed_width_block(
    file: RecordFile, first: int, count: int, shape: tuple[int, int]
) -> NDArray[np.float64]:
    """Return `count` numbers in fixed columns from line `first` (counted from 0) on.

    Parameters
    ----------
    file : RecordFile
    first : int
        Line of the first number, counted from 0.
    count : int
        Numbers of the block.
    shape : tuple of int
        Numbers in a line, and characters of each.

    Raises
    ------
    ValueError
        If the file ends before, or a line holds something else: the line is named.
    """
    columns, width = shape
    rows, size = -(-count // columns), columns * width
    lines = file.text[first : first + rows]
    if len(lines) < rows:
        raise ValueError(
            f"{file.name}, line {first + 1}: announces {count} samples, the file ends after "
            f"{len(lines) * columns} of them"
        )
    text = "".join(line[:size].ljust(size) for line in lines)[: count * width]
    values = _fields(text, width)
    damaged = next((at for at, line in enumerate(lines) if len(line.rstrip()) > size), None)
    if damaged is None and values is None:
        damaged = _first_damaged(rows, lambda a, b: _fields(text[a * size : b * size], width) is not None)
    if damaged is not None:
        raise ValueError(
            f"{file.name}, line {first + damaged + 1}: expected {min(columns, count - damaged * columns)} "
            f"numbers of {width} characters, got {lines[damaged].strip()[:60]!r}"
        )
    assert values is not None
    return values


def _fields(text: str, width: int) -> NDArray[np.float64] | None:
    """Numbers of a text of equal fields; None if one is no finite number."""
    text = text.upper().replace("D", "E")  # Fortran writes D for the exponent of a double
    if not text.isascii() or text.translate(_NO_NUMBER):
        return None
    try:
        values = np.frombuffer(text.encode(), dtype=f"S{width}").astype(np.float64)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


_NO_NUMBER = str.maketrans("", "", "0123456789.+-E ")


def table_of_numbers(
    file: RecordFile, first: int, columns: int, *, count: int | None = None, separator: str | None = None
) -> NDArray[np.float64]:
    """Table of numbers from line `first` (counted from 0) to the end, without blank lines.

    Parameters
    ----------
    file : RecordFile
    first : int
        Line of the first row, counted from 0.
    columns : int
        Numbers in a row.
    count : int, optional
        Rows that the file announces.
    separator : str, optional
        Between the numbers, in place of blanks.

    Returns
    -------
    ndarray, shape (rows, columns)

    Raises
    ------
    ValueError
        If there are fewer or more rows, or a row holds something else: the line is named.
    """
    lines = [(at, line) for at, line in enumerate(file.text[first:], first + 1) if line.strip()]
    rows = [line.strip().rstrip(separator or " ").split(separator) for _, line in lines]
    values = _table(rows, columns)
    if values is None:
        at, line = lines[_first_damaged(len(rows), lambda a, b: _table(rows[a:b], columns) is not None)]
        raise ValueError(f"{file.name}, line {at}: expected {columns} numbers, got {line.strip()[:60]!r}")
    if not len(rows) or len(rows) != (count or len(rows)):
        raise ValueError(f"{file.name}: announces {count or 'no'} samples, the file holds {len(rows)}")
    return values


def _table(rows: list[list[str]], columns: int) -> NDArray[np.float64] | None:
    if any(len(row) != columns for row in rows):
        return None
    try:
        values = np.array(rows, dtype=np.float64).reshape(-1, columns)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def without_fill(values: NDArray[np.float64]) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """Values without the fill values after the last sample, such as 9999.9, and a note of them.

    Examples
    --------
    >>> without_fill(np.array([0.1, 0.2, -999.0, -999.0]))
    (array([0.1, 0.2]), ('2 fill values of -999 after the last sample are left out',))
    """
    last = float(values[-1]) if len(values) else 0.0
    others = np.flatnonzero(values != last)
    if not _FILL.fullmatch(repr(last)) and not _is_beyond(last, values[others]):
        return values, ()
    count = len(values) - (int(others[-1]) + 1 if len(others) else 0)
    note = f"{count} fill value{'s' * (count > 1)} of {last:g} after the last sample are left out"
    return values[: len(values) - count], (note,)


def without_filled_end(component: Component, *, cut: bool) -> Component:
    """Component without fill values after its last sample; refused where they are not cut.

    Raises
    ------
    ValueError
        If one stands among its samples: the sample is missing, and no other number would be right.
    """
    values, notes = without_fill(component.values)
    if notes and not cut:
        last = float(component.values[-1])
        raise ValueError(f"{component.path.name} ends in fill values of {last:g}: leave out their rows")
    if notes:
        component = replace(component, values=values, notes=(*component.notes, *notes))
    largest = float(np.abs(values).max())
    if not largest >= _LEAST:
        return component
    at = int(np.abs(values).argmax())
    fill = float(values[at])
    rest = values[values != fill]
    known = _FILL.fullmatch(repr(fill)) and len(rest) and largest > _FAR * float(np.abs(rest).max())
    if known or _is_beyond(fill, rest):
        raise ValueError(
            f"{component.path.name}: sample {at + 1}{f' of {component.label}' * bool(component.label)} is "
            f"{fill:g}, which stands for a missing one: give a whole record"
        )
    return component


def _is_beyond(value: float, others: NDArray[np.float64]) -> bool:
    """Whether a number is too large for a sample beside all others, some of which are not zero."""
    largest = float(np.abs(others).max(initial=0.0))
    return abs(value) >= _LEAST and 0.0 < largest < abs(value) / _BEYOND
