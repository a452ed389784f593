"""The score of the checks as a page: how many generated faults are found, by what, and which are not."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Container, Iterator, Sequence
from pathlib import Path

from .campaign import Row
from .targets import GROUPS, group_of
from .trial import CRASH, NOTHING, TIMEOUT

_HEAD = """# Faults that the checks find

One fault at a time is put into the sources, and `rockwobble check` is run to its first failure; where it
finds nothing, the tests of the folder are run if they are asked for. The faults are generated from the
sources: operators, numbers, comparisons, conditions, indices, names, arguments, statements. They are drawn
from every file and, in a file, from every kind in turn, so that rare kinds count as much as frequent ones.
Left out are messages, and the conditions under which bad input is refused. A crash and a run out of time
count as found. A fault that changes no result (equivalent) does not count: the share is that of the others.
Made by

    {command}"""


def read_reasons(path: Path) -> dict[tuple[str, str], str]:
    """Return why faults are equivalent, by their name and change.

    Raises
    ------
    ValueError
        If an entry has no reason, or there are two of one fault.
    """
    found: dict[tuple[str, str], str] = {}
    for entry in tomllib.loads(path.read_text(encoding="utf-8")).get("equivalent", []):
        key = (entry["fault"], entry["change"])
        if key in found or not entry["reason"].strip():
            raise ValueError(f"{path.name} must give one reason for each fault, got {entry}")
        found[key] = " ".join(entry["reason"].split())
    return found


def page(rows: Sequence[Row], reasons: dict[tuple[str, str], str], command: str) -> str:
    """Return the page of a table of faults.

    Parameters
    ----------
    rows : sequence of Row
    reasons : dict
        As `read_reasons` returns them. One for a fault that something found is not believed.
    command : str
        With which the table was made.
    """
    return "\n".join([_HEAD.format(command=command), *_parts(rows, reasons)]) + "\n"


def stale(
    rows: Sequence[Row], reasons: dict[tuple[str, str], str], known: Container[tuple[str, str]]
) -> list[str]:
    """Return the names of faults with a reason that no longer fits: found after all, or not `known`."""
    found = {(row.fault, row.change) for row in rows if row.found}
    return [key[0] for key in reasons if key in found or key not in known]


def _parts(rows: Sequence[Row], reasons: dict[tuple[str, str], str]) -> Iterator[str]:
    def equivalent(row: Row) -> bool:
        return not row.found and (row.fault, row.change) in reasons

    groups = [group.name for group in GROUPS]
    yield from _table("files", rows, lambda row: group_of(row.fault.split(":")[0]).name, groups, equivalent)
    kinds = sorted({_kind(row) for row in rows})
    yield from _table("kind", rows, _kind, kinds, equivalent)
    unknown = [row for row in rows if not row.found and not equivalent(row)]
    yield from _listed("Not found", unknown, lambda row: _asked(row))
    yield from _listed("Equivalent", filter(equivalent, rows), lambda row: reasons[row.fault, row.change])
    only_tests = [row for row in rows if row.check == NOTHING and row.found]
    yield from _listed("Found by the tests alone", only_tests, lambda row: row.detail)
    for what, title in ((TIMEOUT, "Out of time"), (CRASH, "Crashed")):
        ended = [row for row in rows if what in (row.check, row.tests)]
        yield from _listed(title, ended, lambda row: row.detail)


def _table(
    title: str,
    rows: Sequence[Row],
    of: Callable[[Row], str],
    names: Sequence[str],
    equivalent: Callable[[Row], bool],
) -> Iterator[str]:
    columns = (
        title,
        "faults",
        "equivalent",
        "found by check",
        "by the tests alone",
        "not found",
        "share of check",
    )
    yield f"\n{_line(columns)}"
    yield "|---|--:|--:|--:|--:|--:|--:|"
    for name in (*names, "all"):
        own = [row for row in rows if name == "all" or of(row) == name]
        if not own:
            continue
        by_check = sum(row.check != NOTHING for row in own)
        by_tests = sum(row.check == NOTHING and row.found for row in own)
        same = sum(equivalent(row) for row in own)
        count = len(own) - same
        share = f"{100.0 * by_check / count:.0f} %" if count else ""
        yield _line((name, len(own), same, by_check, by_tests, count - by_check - by_tests, share))


def _line(cells: Sequence[object]) -> str:
    return f"| {' | '.join(map(str, cells))} |"


def _listed(title: str, rows: Iterator[Row] | Sequence[Row], say: Callable[[Row], str]) -> Iterator[str]:
    lines = [f"| `{row.fault}` | {_code(row.change)} | {_cell(say(row))} |" for row in rows]
    if lines:
        yield f"\n## {title}: {len(lines)}\n"
        yield "| fault | change | |"
        yield "|---|---|---|"
        yield from sorted(lines)


def _asked(row: Row) -> str:
    return "not found" if row.tests else "not found by the check; the tests were not asked"


def _kind(row: Row) -> str:
    return row.fault.split(":")[-2]


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _code(text: str) -> str:
    return f"`{_cell(text)}`"
