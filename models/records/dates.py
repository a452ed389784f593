"""Clock times in the place of times, as loggers write them, as seconds from the first."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

_MONTH_OR_NUMBER = r"(?:\d{1,4}|[A-Za-z]{3,9})"
_DATE = rf"{_MONTH_OR_NUMBER}[-/.]{_MONTH_OR_NUMBER}[-/.]\d{{1,4}}\.?(?:T|[ ]{{1,3}})"
# a comma is a decimal point where semicolons or tabs part the cells
_CLOCK = r"(\d{1,2}):(\d{2}):(\d{2})(?:\.(\d{1,9})|,(\d{1,9})(?=[ \"]*[;\t]))?"
_ZONE = r"(?: ?Z| ?(?:UTC|GMT)|[ ]?[+-]\d{2}:?\d{2})?"
_TIME = re.compile(rf"\"?(?:{_DATE})?{_CLOCK}{_ZONE}\"?(?=[ \t,;]|$)")
_DAY = 86_400_000_000_000  # [ns]
_LONGEST_LINE = 400  # [characters]


def has_clock_time(line: str) -> bool:
    """Return whether a line holds one clock time, such as 2024-11-26T10:20:30.005Z or 10:20:30.005."""
    return _clock_in(line) is not None


def _clock_in(line: str) -> re.Match[str] | None:
    """Return the clock time of a line that holds one; None of any other line."""
    match = _TIME.search(line) if ":" in line and len(line) <= _LONGEST_LINE else None
    return match if match is not None and _TIME.search(line, match.end()) is None else None


_BEHIND = (" ", "\t", ",", ";", "")  # a clock time
_MOST_OTHERS = 1000  # lines without a clock time among rows that have one


def _with_even_clocks(lines: Sequence[str], is_row: Callable[[str], bool]) -> list[str] | None:
    """Return what `with_seconds` does where all clock times stand at one place; None where they do not.

    All at once: line by line, a million rows take seconds.
    """
    last = lines[-1]
    match = _clock_in(last)
    if match is None or match[5] or not last.isascii():
        return None
    a, b = match.span()
    begin = last[:a]
    places = [
        at
        for at, line in enumerate(lines)
        if len(line) >= b and line[:a] == begin and line[b : b + 1] in _BEHIND
    ]
    cells = "".join([lines[at][a:b] for at in places])
    if not cells.isascii():
        return None
    codes = np.frombuffer(cells.encode(), dtype=np.uint8).reshape(len(places), b - a)
    form = np.frombuffer(last[a:b].encode(), dtype=np.uint8)
    digits = (form >= ord("0")) & (form <= ord("9"))
    numbers = codes - np.uint8(ord("0"))  # what is below wraps to above 9
    alike = (numbers[:, digits] <= 9).all(axis=1) & (codes[:, ~digits] == form[~digits]).all(axis=1)
    places, numbers = np.asarray(places)[alike].tolist(), numbers[alike]
    others = sorted(set(range(len(lines))).difference(places)) if len(places) < len(lines) else []
    if len(others) > _MOST_OTHERS or not _is_clock_row(lines[places[0]], is_row):
        return None
    if any(_is_clock_row(lines[at], is_row) for at in others):
        return None

    def of_group(group: int) -> NDArray[np.int64]:
        start, end = match.start(group) - a, match.end(group) - a
        powers = 10 ** np.arange(end - start - 1, -1, -1)
        return np.asarray(numbers[:, start:end].astype(np.int64) @ powers, dtype=np.int64)

    clock = ((of_group(1) * 60 + of_group(2)) * 60 + of_group(3)) * 1_000_000_000
    if match[4]:
        clock += of_group(4) * 10 ** (9 - len(match[4]))
    clock += np.cumsum(np.diff(clock, prepend=clock[0]) < -_DAY // 2) * _DAY  # past midnight
    seconds = ((clock - clock[0]) / 1e9).tolist()
    answer = list(lines)
    if len(others) == places[0]:  # the header alone
        rows = zip(seconds, lines[places[0] :], strict=True)
        answer[places[0] :] = [f"{begin}{each!r}{line[b:]}" for each, line in rows]
        return answer
    for at, each in zip(places, seconds, strict=True):
        answer[at] = f"{begin}{each!r}{lines[at][b:]}"
    return answer


def _is_clock_row(line: str, is_row: Callable[[str], bool]) -> bool:
    return has_clock_time(line) and is_row(_TIME.sub("0", line, count=1).strip())


def with_seconds(lines: Sequence[str], is_row: Callable[[str], bool]) -> list[str]:
    """Return lines whose clock times are seconds from the first, from the first row on.

    Parameters
    ----------
    lines : sequence of str
    is_row : callable
        Whether a line holds nothing but numbers.

    Examples
    --------
    >>> with_seconds(["from 9:00:00 on", "9:00:01.5, 3", "9:00:01.75, 4"], lambda line: line[:1].isdecimal())
    ['from 9:00:00 on', '0.0, 3', '0.25, 4']
    """
    answer = _with_even_clocks(lines, is_row)
    if answer is not None:
        return answer
    begin = next(
        (at for at, line in enumerate(lines) if _is_clock_row(line, is_row)),
        len(lines),
    )
    first, before, days = None, 0, 0
    answer = list(lines[:begin])
    for line in lines[begin:]:
        match = _clock_in(line)
        if match is None:
            answer.append(line)
            continue
        hours, minutes, seconds = (int(match[group]) for group in (1, 2, 3))
        part = int((match[4] or match[5] or "0").ljust(9, "0"))
        clock = ((hours * 60 + minutes) * 60 + seconds) * 1_000_000_000 + part
        days += clock < before - _DAY // 2  # past midnight
        before = clock
        first = clock if first is None else first
        since = repr((clock + days * _DAY - first) / 1e9).replace(".", "," if match[5] else ".")
        answer.append(f"{line[: match.start()]}{since}{line[match.end() :]}")
    return answer
