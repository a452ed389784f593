"""Clock times in the place of times, as loggers write them, as seconds from the first."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

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
    return ":" in line and len(line) <= _LONGEST_LINE and len(_TIME.findall(line)) == 1


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
    begin = next(
        (
            at
            for at, line in enumerate(lines)
            if has_clock_time(line) and is_row(_TIME.sub("0", line, count=1))
        ),
        len(lines),
    )
    first, before, days = None, 0, 0
    answer = list(lines[:begin])
    for line in lines[begin:]:
        match = _TIME.search(line) if has_clock_time(line) else None
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
