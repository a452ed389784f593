"""Numbers as the files of records print them: Fortran exponents, columns that touch.

Numbers that blanks part are read as they stand. Where some touch, as those of AT2 may, they are parted by
what Fortran keeps the same in all numbers of a format: the decimals and the digits of the exponent.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .component import RecordFile

# one way to match each text, so that no line takes more than linear time
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[EeDd][-+]?\d+)?"
_ALLOWED = b"0123456789+-.eE \t\n\r"
_FOREIGN = re.compile(r"[^0-9+.eEdD \t\n\r-]")  # a character that stands in no number
_ENDED = re.compile(r"\.(\d*)(?:[EeDd][-+]?(\d+))?(?=[\s,;+-]|\Z)")  # a number whose end is certain
_TWO_POINTS = re.compile(r"\.[^\s,;+.-]*(?:(?<=[EeDd])[-+][^\s,;+.-]*)?\.")
_SIGN_BEHIND = re.compile(r"(?<=[\d.])([-+])")
_LOST_E = re.compile(r"(?<=\d)([-+]\d{3})(?![\d.])")  # Fortran leaves out the E before three digits
_MANY_DIGITS = re.compile(r"(?<![\d.])\d{17}")  # more than a double holds: whole numbers that touch


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
    """Whether a text is a number, also one that is not finite."""
    return re.fullmatch(NUMBER, cell) is not None or cell.lower().lstrip("+-") in ("nan", "inf", "infinity")


def plain_numbers(text: str) -> NDArray[np.float64] | None:
    """The numbers of a text that blanks part; None where it holds anything else, or they touch."""
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
    # touching numbers are read as several: more than blanks part
    return values if len(values) == count and np.isfinite(values).all() else None


def _begins(content: bytes) -> NDArray[np.bool_]:
    """At which characters of a text a cell begins that blanks part from the one before."""
    blank = np.frombuffer(content, dtype=np.uint8) <= ord(" ")
    before = np.concatenate([[True], blank[:-1]]) if len(blank) else blank
    return np.asarray(~blank & before)


def widths_of(text: str) -> NDArray[np.int64]:
    """The number of cells that blanks part in each line, none of which is blank (n,)."""
    content = text.encode()
    ends = np.flatnonzero(np.frombuffer(content, dtype=np.uint8) == ord("\n"))
    before = np.searchsorted(np.flatnonzero(_begins(content)), np.concatenate([[0], ends, [len(content)]]))
    return np.asarray(np.diff(before), dtype=np.int64)


def separate(text: str) -> str | None:
    """A text of numbers of which some touch with blanks between them; None if none or several ways do.

    Lines stay lines. The numbers of the answer are still to be read by `plain_numbers`.

    Examples
    --------
    >>> separate("914.828 944.8281001.724")
    ' 914.828   944.828  1001.724 '
    >>> separate("0.5 0.250.125") is None
    True
    """
    if re.search("[EeDd]", text):
        text = _LOST_E.sub(r"E\1", text)
    elif _LOST_E.search(text) and "." in text:
        return None  # an exponent or a whole number
    if _TWO_POINTS.search(text) is None:  # signs alone part them
        return _SIGN_BEHIND.sub(r" \1", text)
    ends = set(_ENDED.findall(text))
    shapes = {(len(decimals), len(exponent)) for decimals, exponent in ends}
    if len(shapes) != 1:
        return None
    ((decimals, digits),) = shapes
    exponent = rf"[EeDd][-+]?\d{{{digits}}}" if digits else ""
    answer, count = re.subn(rf"[-+]?\d*\.\d{{{decimals}}}{exponent}", r" \g<0> ", text)
    if len(answer.split()) != count:
        return None
    # numbers without exponents have the zero before the point all or none
    mixed = not digits and all(re.search(style, answer) for style in (r"(?<![\d-])\.\d", r"(?<![\d-])0\.\d"))
    return None if mixed else answer


def block_of_numbers(file: RecordFile, first: int, last: int | None = None) -> NDArray[np.float64]:
    """The numbers of lines `first` (counted from 0) to `last` (left out), in reading order.

    Parameters
    ----------
    file : RecordFile
    first, last : int
        Blank lines are passed over.

    Returns
    -------
    ndarray, shape (n,)

    Raises
    ------
    ValueError
        If a line holds something else, or a number that is not finite: the line is named. If numbers touch
        and can be parted in no way, or in several.
    """
    lines, begin = file.text[first:last], first + 1
    text = "\n".join(lines)
    whole = _MANY_DIGITS.search(text) is None
    values = plain_numbers(text) if whole else None
    if values is not None:
        return values
    damaged = _damaged_line(lines)
    if damaged is None:
        length = sum(map(len, lines))
        if length > _LONGEST_TOUCHING:
            raise ValueError(
                f"{file.name}: its numbers touch, which is read up to {_LONGEST_TOUCHING:,} characters, got "
                f"{length:,}: write them with blanks between"
            )
        answer = separate(text) if whole else None
        values = None if answer is None else plain_numbers(answer)
        if values is not None:
            return values
        damaged = next(
            (at for at, line in enumerate(lines) if plain_numbers(line) is None or _MANY_DIGITS.search(line)),
            0,
        )
        raise ValueError(
            f"{file.name}, line {begin + damaged}: its numbers touch, and no way to part them is the only "
            f"one: write them with blanks between, got {lines[damaged].strip()[:60]!r}"
        )
    line = lines[damaged]
    for token in line.split():
        if re.fullmatch(NUMBER, token):
            parse_number(file.path, begin + damaged, token)
    raise ValueError(
        f"{file.name}, line {begin + damaged}: expected accelerations, got {line.strip()[:60]!r}"
    )


def _only_numbers(text: str) -> bool:
    """Whether a text holds nothing but finite numbers, which may touch."""
    left = re.sub(NUMBER, " ", text)
    if left.strip() and re.sub(r"[\s.]", "", left):
        return False
    return all(math.isfinite(float(re.sub("[Dd]", "E", token))) for token in re.findall(NUMBER, text))


def _first_non_numeric_line(text: str) -> int | None:
    """The place of the first line with a character that stands in no number; None without one."""
    foreign = _FOREIGN.search(text)
    return None if foreign is None else text.count("\n", 0, foreign.start())


_CHUNK = 4096  # lines that are read at once, to find the one that is damaged


def _damaged_line(lines: Sequence[str]) -> int | None:
    """The place of the first line that holds anything but numbers; None without one.

    Numbers may touch; of more such text than is parted no more is looked at.
    """
    at = _first_non_numeric_line("\n".join(lines))
    if at is not None:
        return at
    touched = 0
    for begin in range(0, len(lines), _CHUNK):
        chunk = lines[begin : begin + _CHUNK]
        text = "\n".join(chunk)
        if plain_numbers(text) is not None:
            continue
        if not _only_numbers(text):
            for at, line in enumerate(chunk, start=begin):
                if plain_numbers(line) is None and not _only_numbers(line):
                    return at
        touched += len(text)
        if touched > _LONGEST_TOUCHING:
            return None
    return None


_LONGEST_TOUCHING = 3_000_000  # characters: to part them takes a second
