"""Text of columns as a table: header lines, and rows of equally many numbers."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .component import RecordFile
from .dates import has_clock_time, with_seconds
from .fill import without_missing_end
from .numbers import (
    CHUNK,
    damaged_line,
    foreign_line,
    is_number,
    only_numbers,
    parse_number,
    plain_numbers,
    refuse_long_touching,
    separate,
    touching,
    widths_of,
)

_QUOTED = re.compile(r'"([^"]*)"')
_NO_SEPARATORS = str.maketrans(",;", "  ")
_COMMENTS = ("#", "%", "!", "//")
_WORD = re.compile(r"[^\W\d_]{2}")
_COMMA_NUMBER = re.compile(r"[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?")
_LONGEST_HEADER = 5000  # lines in which numbers begin, if the text is a record
_BEGIN_OF_NUMBER = frozenset("0123456789+-.,nNiI")
_LONGEST_BARRED = 400  # characters of a line that is looked at for bars
_RULE = re.compile(r"[-+:|= ]{1,400}")  # of a table, below its names; also a blank line
_EMPTY_CELL = re.compile(r"[,;][ \t]*[,;]|(?:^|\n)[ \t]*[,;]")


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of numbers under a header.

    Attributes
    ----------
    header : tuple of str
        Lines above the first row, without marks of comments.
    values : ndarray, shape (n, columns)
    lines : sequence of int
        Number of the line of each row, from 1.
    notes : tuple of str
        What was left out.
    """

    header: tuple[str, ...]
    values: NDArray[np.float64]
    lines: Sequence[int]
    notes: tuple[str, ...] = ()


def bare_header(line: str) -> str:
    """Return a line of a header without quotation marks, blanks and the mark of a comment.

    Within quotation marks, commas and semicolons are blanks: they part no cells.

    Examples
    --------
    >>> bare_header('# "Acc., east";"Acc., north"')
    'Acc.  east;Acc.  north'
    """
    if '"' in line:
        line = _QUOTED.sub(lambda match: match[1].translate(_NO_SEPARATORS), line)
    return re.sub(r"^(?:[#%!;$*]+|//+)", "", line.replace('"', "").strip()).strip()


def is_comment(text: str) -> bool:
    """Return whether a line, without blanks at its begin, is a comment; ";0.1" is an empty cell."""
    return text.startswith(_COMMENTS) or (text.startswith(";") and _WORD.search(text) is not None)


def cells_of(line: str) -> list[str]:
    """Return the cells of a row of numbers, with points for decimal commas.

    Examples
    --------
    >>> cells_of("0,01; 1,5"), cells_of("0.01, 1.5,"), cells_of("0.01 1.5"), cells_of("0,01 1,5")
    (['0.01', '1.5'], ['0.01', '1.5'], ['0.01', '1.5'], ['0.01', '1.5'])
    """
    text = line.replace('"', "").strip().rstrip(",;\t ")
    separator, comma = _form(text)
    if comma:
        text = text.replace(",", ".")
    return [cell.strip() for cell in text.split(separator)] if text else []


def _form(text: str) -> tuple[str | None, bool]:
    """Return what separates the cells of a row (None: blanks), and whether a comma is its decimal point."""
    if ";" in text:
        return ";", "," in text and "." not in text
    cells = text.split()
    if "," not in text:
        return None, False
    comma = len(cells) > 1 and all(_COMMA_NUMBER.fullmatch(cell) or is_number(cell) for cell in cells)
    return (None, True) if comma else (",", False)


def _is_row(text: str) -> bool:
    """Return whether a line holds nothing but numbers, which may touch."""
    # a clock time takes long to refuse cell by cell
    if text[:1] not in _BEGIN_OF_NUMBER or ":" in text:
        return False
    cells = cells_of(text)
    return all(map(is_number, cells)) or (not re.search("[,;]", text) and only_numbers(text))


def first_row(lines: Sequence[str]) -> int:
    """Return the place of the first row; the number of lines where there is none.

    A line of numbers alone among words, or above rows of another width, such as "4096 0.025", belongs to the
    header.
    """
    candidate, width = None, 0
    for place, line in enumerate(lines[:_LONGEST_HEADER]):
        text = line.replace('"', "").strip()
        if not text or is_comment(text):
            continue
        if not _is_row(text):
            candidate = None
            continue
        count = len(cells_of(text))
        # rows of touching numbers differ in what blanks part, and the last may be shorter
        if candidate is not None and not (count > width and _may_be_count(lines[candidate])):
            return candidate
        candidate, width = place, count
    return len(lines) if candidate is None else candidate


def notes_of_header(
    lines: Sequence[str], first: int, width: int, step: float | None = None
) -> tuple[str, ...]:
    """Say which lines above the first row, and above words, are numbers as its rows are.

    They are what is left of samples where a row below them is damaged. A count and the time step `step` [s]
    of a record stand there by right.
    """
    notes = []
    for number, line in enumerate(lines[:first], start=1):
        text = line.replace('"', "").strip()
        if is_comment(text) or not text or not _is_row(text) or _may_be_count(text):
            continue
        cells = cells_of(text)
        alike = len(cells) == width and all(map(is_number, cells))  # numbers may touch in a row
        if alike and float(cells[0].upper().replace("D", "E")) != step:
            notes.append(
                f"line {number} holds numbers alone, {text[:30]!r}, above words: taken for the header"
            )
    return tuple(notes)


def _may_be_count(line: str) -> bool:
    """Return whether a line may hold the number of samples, and their time step: "240", "4096 0.025"."""
    cells = cells_of(line)
    # more digits than a count has make none
    return 1 <= len(cells) <= 2 and cells[0].isdecimal() and len(cells[0]) < 12 and int(cells[0]) > 1


def rows_of(file: RecordFile, first: int) -> tuple[Sequence[int], list[str]]:
    """Return number (from 1) and text of the lines from `first` on that are neither comments nor blank."""
    lines = file.text[first:]
    whole = "\n".join(lines)
    if not any(mark in whole for mark in (*_COMMENTS, '"', "\n;")) and whole[:1] != ";":
        close = whole.replace(" ", "").replace("\t", "")  # to strip each line takes longer than to read
        if "\n\n" not in close and close[:1] != "\n" != close[-1:] and close.isascii():
            return range(first + 1, first + 1 + len(lines)), list(lines)
    numbers, rows = [], []
    for number, line in enumerate(whole.replace('"', "").split("\n"), start=first + 1):
        text = line.strip()
        if text and (text[0] in _BEGIN_OF_NUMBER or not is_comment(text)):
            numbers.append(number)
            rows.append(text)
    return numbers, rows


def with_clock(file: RecordFile) -> RecordFile:
    """Return a file whose clock times in its rows are seconds from the first; the same without any."""
    if not has_clock_time(file.text[-1]):
        return file
    return RecordFile(file.path, "\n".join(with_seconds(file.text, _is_row)).encode())


def without_bars(file: RecordFile) -> RecordFile:
    """Return a file whose bars between columns, "| 0.01 | 0.2 |", are semicolons; the same without any."""
    if "|" not in file.text[-1][:_LONGEST_BARRED]:
        return file
    lines = [
        "" if _RULE.fullmatch(text := line.strip()) else text.strip("|").replace("|", ";")
        for line in file.text
    ]
    return RecordFile(file.path, "\n".join(lines).encode())


def table_of(file: RecordFile) -> Table:
    """Return the header and the rows of a file.

    Raises
    ------
    ValueError
        If there are fewer than two rows, one has another width than the first, a cell is empty or no finite
        number, or numbers touch and cannot be parted.
    """
    lines = file.text
    first = first_row(lines)
    if first == len(lines):
        _refuse_damaged_row(file, first)
        raise ValueError(_without_rows(file))
    header = tuple(text for line in lines[:first] if (text := bare_header(line)))
    numbers, filled = rows_of(file, first)
    rows, notes = without_missing_end(filled)
    numbers = numbers[: len(rows)]
    _refuse_damaged_row(file, first)
    if len(rows) < 2:
        raise ValueError(f"{file.name} must hold at least two samples, got {len(rows)}")
    text, width = _blank_separated(file, numbers, rows)
    values = plain_numbers(text)
    if values is None and ("." in text):
        text = _parted_rows(file, numbers, rows, text)
        values = plain_numbers(text)
        width = len(text[: text.find("\n")].split())
    if values is None or (widths_of(text) != width).any():
        raise ValueError(_damage(file, numbers, rows, text.split("\n"), width))
    values = values.reshape(len(rows), width)
    if width == 2 and values[0, 0] == len(values) - 1 > _FEWEST_COUNTED and 0.0 < values[0, 1] < 1.0:
        header = (*header, rows[0].strip())  # "4096 0.025" above two columns
        return Table(header, values[1:], numbers[1:], notes)
    return Table(header, values, numbers, (*notes, *notes_of_header(lines, first, width)))


_FEWEST_COUNTED = 10  # rows; a number of fewer may be a sample by chance


def _blank_separated(file: RecordFile, numbers: Sequence[int], rows: Sequence[str]) -> tuple[str, int]:
    """Return the rows with blanks between the cells, and how many cells the first has."""
    first = rows[0].replace('"', "").strip().rstrip(",;\t ")
    separator, comma = _form(first)
    if not comma and len(rows) > 1:  # the first may hold whole numbers only
        separator, comma = _form(rows[1].replace('"', "").strip().rstrip(",;\t "))
    text = "\n".join(rows)
    if '"' in text:
        text = text.replace('"', "")
    if separator is not None:
        close = text.replace(" ", "").replace("\t", "")  # as patterns, these take longer than to read
        text = text.replace(separator + "\n", "\n")  # of each row, which is quicker than row by row
        close = text.replace(" ", "").replace("\t", "") if separator + "\n" in close else close
        if any(mark + "\n" in close or close.endswith(mark) for mark in ",;"):
            text = "\n".join(row.rstrip(",;\t ") for row in text.split("\n"))
            close = text.replace(" ", "").replace("\t", "")
        doubled = any(pair in close for pair in (2 * separator, "\n" + separator))
        if doubled or close.startswith((",", ";")):
            empty = _EMPTY_CELL.search(text)
            assert empty is not None  # what was found without blanks is there with them
            at = text.count("\n", 0, empty.end() - 1)
            raise ValueError(
                f"{file.name}, line {numbers[at]}: a cell is empty, got {rows[at].strip()[:60]!r}"
            )
    if comma:
        text = text.replace(",", ".")
    if separator is not None:
        text = text.replace(separator, " ")
    return text, len(text.split("\n", 1)[0].split())


def _parted_rows(file: RecordFile, numbers: Sequence[int], rows: Sequence[str], text: str) -> str:
    """Return rows of which some hold numbers that touch with blanks between them."""
    lines = text.split("\n")
    if damaged_line(lines) is not None:
        return text
    refuse_long_touching(file, lines)
    answer = separate(text)
    if answer is None or plain_numbers(answer) is None:
        at = next((at for at, line in enumerate(lines) if plain_numbers(line) is None), 0)
        raise ValueError(touching(file, numbers[at], rows[at]))
    return answer


def _damage(
    file: RecordFile, numbers: Sequence[int], rows: Sequence[str], texts: Sequence[str], width: int
) -> str:
    """Return what is wrong with the first damaged row."""
    begin = _first_damaged(texts, width)
    for number, row, text in zip(numbers[begin:], rows[begin:], texts[begin:], strict=True):
        cells = text.split()
        if len(cells) != width or not all(map(is_number, cells)):
            return (
                f"{file.name}, line {number}: expected {width} number{'s' * (width > 1)} as in line "
                f"{numbers[0]}, got {row.strip()[:60]!r}"
            )
        try:
            for cell in cells:
                parse_number(file.path, number, cell)
        except ValueError as error:
            return str(error)
    return f"{file.name} holds something else than numbers"


def _first_damaged(texts: Sequence[str], width: int) -> int:
    """Return the place from which the first damaged row is not far."""
    whole = "\n".join(texts)
    if plain_numbers(whole) is not None:
        return int((widths_of(whole) != width).argmax())
    foreign = foreign_line(whole)
    if foreign is not None:
        return foreign
    for begin in range(0, len(texts), CHUNK):
        if plain_numbers("\n".join(texts[begin : begin + CHUNK])) is None:
            return begin
    return 0


_DATES = re.compile(r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}|\d{1,2}:\d{2}:\d{2}")


def _without_rows(file: RecordFile) -> str:
    """Return the refusal of a text without any row of numbers."""
    line = next((text for line in reversed(file.text) if (text := line.strip())), "")
    dates = (
        ": its times are dates, which are read in one column, as 2024-11-26T10:20:30.005"
        if _DATES.search(line[:200])
        else ""
    )
    return (
        f"{file.name} must hold at least two samples, got 0 rows of numbers{dates}; it ends in {line[:60]!r}"
    )


def _refuse_damaged_row(file: RecordFile, first: int) -> None:
    """Refuse a header whose last line is a damaged first row: without it the record would be another."""
    for number in range(first, 0, -1):
        text = file.text[number - 1].replace('"', "").strip()
        if not text:
            continue
        cells = re.split(r"\s*[,;]\s*", text) if re.search("[,;]", text) else text.split()
        known = sum(map(is_number, cells))
        damaged = 2 * known >= len(cells) and is_number(cells[0]) and not all(map(str.isdecimal, cells))
        if damaged and not is_comment(text) and not _may_be_count(text):
            if "" in cells:
                raise ValueError(f"{file.name}, line {number}: a cell is empty, got {text[:60]!r}")
            raise ValueError(f"{file.name}, line {number}: expected numbers alone, got {text[:60]!r}")
        return
