"""Blocks of numbers as the files of networks have them: fixed columns, which may touch, and tables."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from .component import RecordFile

# "(8F10.3)", "(1E15.6)", "(10I8)": repetitions and width
_FORMAT = re.compile(r"\(?\b(\d{1,3})\s*[FEGI](\d{1,3})(?:\.\d{1,3})?\b", re.IGNORECASE)
_CHUNK = 20_000  # lines
_LONGEST_LINE = 200  # [characters]; bounds what a pattern can cost on a damaged line


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
    rows = -(-count // columns)
    lines = file.text[first : first + rows]
    if len(lines) < rows:
        raise ValueError(
            f"{file.name}, line {first + 1}: announces {count} samples, the file ends after "
            f"{len(lines) * columns} of them"
        )
    text = "".join(line[: columns * width].ljust(columns * width) for line in lines)
    values = _fields(text, width, count)
    longer = (index for index, line in enumerate(lines) if len(line.rstrip()) > columns * width)
    damaged = next(longer, None)
    if values is None:
        damaged, after = 0, rows  # halved, since line by line a million take seconds
        while after - damaged > 1:
            middle = (damaged + after) // 2
            half = text[damaged * columns * width : middle * columns * width]
            if _fields(half, width, (middle - damaged) * columns) is None:
                after = middle
            else:
                damaged = middle
    if damaged is not None:
        raise ValueError(
            f"{file.name}, line {first + damaged + 1}: expected {min(columns, count - damaged * columns)} "
            f"numbers of {width} characters, got {lines[damaged].strip()[:60]!r}"
        )
    assert values is not None
    return values


def _fields(text: str, width: int, count: int) -> NDArray[np.float64] | None:
    """Return the numbers of a text of equal fields, None if one is no finite number."""
    text = text[: count * width].upper().replace("D", "E")  # Fortran writes D for the exponent of a double
    if not text.isascii() or text.translate(_NO_NUMBER):
        return None
    try:
        values = np.frombuffer(text.ljust(count * width).encode(), dtype=f"S{width}").astype(np.float64)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


_NO_NUMBER = str.maketrans("", "", "0123456789.+-E ")


def table_of_numbers(
    file: RecordFile, first: int, columns: int, *, count: int | None = None, separator: str | None = None
) -> NDArray[np.float64]:
    """Return a table of numbers from line `first` (counted from 0) to the end; blank lines are passed over.

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
    parts: list[NDArray[np.float64]] = []
    rows = 0
    for begin in range(first, len(file.text), _CHUNK):  # so that damage ends it early
        cells = [_cells(line, separator) for line in file.text[begin : begin + _CHUNK] if line.strip()]
        rows += len(cells)
        alike = all(len(row) == columns for row in cells)
        values = _row([cell for row in cells for cell in row]) if alike else None
        if values is None:
            _refuse_row(file, begin, columns, separator)
            continue
        parts.append(values)
        if count is not None and rows > count + _CHUNK:
            break
    if not parts or rows != (rows if count is None else count):
        more = "more than " if count is not None and rows > count + _CHUNK else ""
        raise ValueError(f"{file.name}: announces {count or 'no'} samples, the file holds {more}{rows}")
    return np.concatenate(parts).reshape(-1, columns)


def _refuse_row(file: RecordFile, begin: int, columns: int, separator: str | None) -> None:
    for number, line in enumerate(file.text[begin : begin + _CHUNK], start=begin + 1):
        if line.strip() and not _is_row(line, columns, separator):
            raise ValueError(
                f"{file.name}, line {number}: expected {columns} numbers, got {line.strip()[:60]!r}"
            )


def _cells(line: str, separator: str | None) -> list[str]:
    """Return the cells of a row; none of a line that is longer than a row can be."""
    if len(line) > _LONGEST_LINE:
        return []
    return line.split() if separator is None else line.strip().rstrip(separator).split(separator)


def _is_row(line: str, columns: int, separator: str | None) -> bool:
    cells = _cells(line, separator)
    return len(cells) == columns and _row(cells) is not None


def _row(cells: list[str]) -> NDArray[np.float64] | None:
    try:
        values = np.array(cells, dtype=np.float64)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None
