"""Free text as a table: header lines, and rows of numbers separated by blanks, tabs, commas or semicolons."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .component import RecordFile
from .numbers import is_number, plain_numbers, widths_of

_QUOTED = re.compile(r'"([^"]*)"')
_NO_SEPARATORS = str.maketrans(",;", "  ")
_COMMENT = re.compile(r"\s*(?:[#%!]|//|;.*[^\W\d_]{2}|$)")  # or blank; ";0.1" is an empty cell
_COMMA_NUMBER = re.compile(r"[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?")
_EMPTY_CELL = re.compile(r"[,;][ \t]*[,;]|^[ \t]*[,;]", re.MULTILINE)
_NUMBERS = re.compile(r"[-+.,;\deEdD\s]*")
_STAMP = re.compile(r'"?(\d{4}-\d\d-\d\d)[T ](\d\d:\d\d:\d\d(?:\.\d{1,9})?)Z?"?(?=[ \t,;]|$)')  # ISO 8601
_FOREIGN_WORD = re.compile(
    r"[^\x00-\x7f]{3}"
)  # in western Europe and Turkey letters with accents stand singly
_LONGEST_HEADER = 5000  # lines before the numbers begin, in a text that is a record
_LONGEST_LINE = 400  # [characters] of a row with a stamp


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of numbers under a header.

    Attributes
    ----------
    header : list of str
        Lines above the first row, without marks of comments.
    values : ndarray
        All numbers in the order of reading.
    width : int
        Numbers of a row; the last row may be shorter.
    lines : sequence of int
        Number of the line of each row, from 1.
    comments : sequence of str
        Comments between the rows.
    """

    header: list[str]
    values: NDArray[np.float64]
    width: int
    lines: Sequence[int]
    comments: Sequence[str] = ()

    @property
    def rows(self) -> NDArray[np.float64]:
        """Numbers of the rows of full width, shape (n, width)."""
        return self.values[: len(self.values) // self.width * self.width].reshape(-1, self.width)


def table_of(file: RecordFile) -> Table:
    """Header and rows of a text, with seconds from the first in place of ISO stamps.

    Raises
    ------
    ValueError
        If a row has another width than the first, a cell is empty or no finite number, the header may hold a
        row, or the text is in another encoding than UTF-8, UTF-16 and that of western Europe and Turkey.
    """
    lines = _with_seconds(file.text)
    first = _first_row(lines)
    if first is None:
        end = next(line.strip() for line in reversed(lines) if line.strip())
        raise ValueError(
            f"{file.name} must hold at least two samples, got 0 rows of numbers: write them as columns below "
            f"a line such as 'time,E,N'; it ends in {end[:60]!r}"
        )
    utf8 = file.content.decode(errors="ignore").encode() == file.content
    if not utf8 and _FOREIGN_WORD.search("\n".join(file.text)):
        raise ValueError(f"{file.name} is text in an encoding that is not read: save it as UTF-8")
    places = [at for at in range(first, len(lines)) if not _COMMENT.match(lines[at])]
    text = _blank_separated(file, places, [lines[at] for at in places])
    values, widths = plain_numbers(text), widths_of(text)
    width = int(widths[0])
    if values is None or (widths[:-1] != width).any() or widths[-1] > width:
        raise ValueError(_damage(file, places, text.split("\n"), width))
    _refuse_rows_in_header(file, lines[:first], width)
    header = [text for line in lines[:first] if (text := _bare(line))]
    comments = [line for line in lines[first : places[-1]] if line.strip() and _COMMENT.match(line)]
    return Table(header, values, width, [at + 1 for at in places], comments)


def _with_seconds(lines: Sequence[str]) -> Sequence[str]:
    """Lines whose ISO stamps are seconds from the first."""
    if not _STAMP.search(lines[-1][:_LONGEST_LINE]):
        return lines
    rows = [_STAMP.split(line[:_LONGEST_LINE], maxsplit=1) for line in lines]
    stamped = [len(row) > 1 and _is_row(f"{row[0]}0{row[-1]}") for row in rows]
    stamps = [f"{row[1]}T{row[2]}" for row, is_row in zip(rows, stamped, strict=True) if is_row]
    times = np.array(stamps, dtype="datetime64[ns]")
    seconds = iter(((times - times[:1]).astype(np.int64) / 1e9).tolist())
    return [
        f"{row[0]}{next(seconds)!r}{row[-1]}" if is_row else line
        for line, row, is_row in zip(lines, rows, stamped, strict=True)
    ]


def _first_row(lines: Sequence[str]) -> int | None:
    """Index of the first of two consecutive rows; numbers above words belong to the header."""
    first = None
    for at, line in enumerate(lines[:_LONGEST_HEADER]):
        if not _COMMENT.match(line):
            row = _is_row(line)
            if row and first is not None:
                return first
            first = at if row else None
    return first


def _is_row(line: str) -> bool:
    text = line.replace('"', "").strip().rstrip(",;\t ")
    if not text or not (_NUMBERS.fullmatch(text) or "n" in text.casefold()):  # NaN is refused as a number
        return False
    separator, comma = _form(text)
    return all(
        is_number(cell.strip()) for cell in (text.replace(",", ".") if comma else text).split(separator)
    )


def _form(text: str) -> tuple[str | None, bool]:
    """Separator of the cells of a row (None: blanks), and whether a comma is its decimal point."""
    if ";" in text:
        return ";", "," in text and "." not in text
    cells = text.split()
    if "," not in text:
        return None, False
    comma = len(cells) > 1 and all(_COMMA_NUMBER.fullmatch(cell) or is_number(cell) for cell in cells)
    return (None, True) if comma else (",", False)


def _blank_separated(file: RecordFile, places: Sequence[int], rows: Sequence[str]) -> str:
    text = re.sub(r"[,;\t ]+$", "", "\n".join(rows).replace('"', ""), flags=re.MULTILINE)
    separator, comma = _form(text.split("\n", 1)[0])
    second = _form(text.split("\n", 2)[1]) if len(rows) > 1 else (None, False)
    if second[1]:  # the first may hold only whole numbers
        separator, comma = second
    empty = _EMPTY_CELL.search(text) if separator else None
    if empty:
        at = text.count("\n", 0, empty.start())
        raise ValueError(
            f"{file.name}, line {places[at] + 1}: a cell is empty, got {rows[at].strip()[:60]!r}"
        )
    text = text.replace(",", ".") if comma else text
    return text.replace(separator, " ") if separator else text


def _damage(file: RecordFile, places: Sequence[int], rows: Sequence[str], width: int) -> str:
    """Description of the first damaged row."""
    damaged = (
        at
        for at, row in zip(places, rows, strict=True)
        if widths_of(row) != width or plain_numbers(row) is None
    )
    at = next(damaged)
    model = f", as in line {places[0] + 1}" * (at != places[0])
    return (
        f"{file.name}, line {at + 1}: expected {width} finite number{'s' * (width > 1)}, blanks or "
        f"separators between{model}, got {file.text[at].strip()[:60]!r}"
    )


def _refuse_rows_in_header(file: RecordFile, header: Sequence[str], width: int) -> None:
    """Refuse numbers in a header that may be samples above a damaged row."""
    texts = {
        at: line.replace('"', "").strip() for at, line in enumerate(header, 1) if not _COMMENT.match(line)
    }
    for at, text in texts.items():
        cells = [cell.strip() for cell in re.split("[,;]" if re.search("[,;]", text) else r"\s+", text)]
        known, last = sum(map(is_number, cells)), at == max(texts)
        touching = "." in text and known < len(cells)
        row = known == len(cells) == width or (_NUMBERS.fullmatch(text) and (last or touching))
        damaged = last and is_number(cells[0]) and 2 * known >= len(cells)
        if (row or damaged) and not all(map(str.isdecimal, cells)):
            below = f"above the whole rows that begin in line {len(header) + 1}"
            raise ValueError(f"{file.name}, line {at}: expected words {below}, got {text[:60]!r}")


def _bare(line: str) -> str:
    """Header line without quotation marks, which separate no cells, and without the comment sign."""
    line = _QUOTED.sub(lambda match: match[1].translate(_NO_SEPARATORS), line)
    return re.sub(r"^(?:[#%!;$*]+|//+)", "", line.replace('"', "").strip()).strip()
