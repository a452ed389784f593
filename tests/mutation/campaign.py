"""Many faults, side by side, with a table that is written after each: a run that was stopped goes on."""

from __future__ import annotations

import csv
import os
import queue
import tempfile
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from .sites import GeneratedFault
from .targets import PACKAGES, all_faults, group_of
from .trees import Tree, copy_tree, digest
from .trial import NOTHING, Limits, Verdict, ask_check, ask_tests, limits_from

Tell = Callable[[str], None]
Choose = Callable[[dict[str, list[GeneratedFault]]], Sequence[GeneratedFault]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One line of the table.

    Parameters
    ----------
    fault, change : str
        Name of the fault, and what it changes.
    check : str
        What the check said: a layer, "crash", "timeout" or "nothing".
    tests : str
        The same of the tests: "tests", "crash", "timeout" or "nothing"; empty where they were not asked.
    seconds : str
        On the clock.
    detail : str
        The check or test that failed.
    tree : str
        Hash of the sources that the fault was put into.
    """

    fault: str
    change: str
    check: str
    tests: str
    seconds: str
    detail: str
    tree: str

    @property
    def found(self) -> bool:
        """Whether anything found the fault."""
        return self.check != NOTHING or self.tests not in ("", NOTHING)


COLUMNS = tuple(each.name for each in fields(Row))


class BrokenCheckoutError(RuntimeError):
    """Something fails without any fault."""


def read_rows(table: Path) -> list[Row]:
    """Return the lines of a table; none if there is no such file."""
    if not table.exists():
        return []
    with table.open(encoding="utf-8", newline="") as file:
        return [Row(**{name: line[name] for name in COLUMNS}) for line in csv.DictReader(file)]


def write_rows(table: Path, rows: Iterable[Row]) -> None:
    """Write a table, whole or not at all."""
    beside = table.with_name(f".{table.name}.part")
    with beside.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)
    beside.replace(table)


def run(
    checkout: Path,
    choose: Choose,
    table: Path,
    *,
    tests: bool,
    workers: int,
    survivors_only: bool,
    tell: Tell,
) -> list[Row]:
    """Put each of the chosen faults into a copy of the checkout, and write what found it to a table.

    Parameters
    ----------
    checkout : Path
    choose : callable
        From all faults by file to those that are to be tried, in their order.
    table : Path
        Lines that it holds of the same sources are kept and not tried again.
    tests : bool
        Ask the tests of the folder where the check finds nothing.
    workers : int
        Faults that are tried side by side.
    survivors_only : bool
        Keep what was found in other sources, too, where fault and change are still the same: what the
        checks found before they find again, unless they lost something.
    tell : callable
        Told a line at a time.

    Raises
    ------
    BrokenCheckoutError
        If the check or the tests fail in a copy without a fault.
    """
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        pristine = Path(folder) / "unchanged"
        copy_tree(checkout, pristine)
        tree = digest(pristine)
        wanted = choose(all_faults(pristine))
        kept = _kept(read_rows(table), wanted, tree, tests=tests, survivors_only=survivors_only)
        missing = [fault for fault in wanted if fault.name not in kept]
        tell(f"{len(wanted)} faults, {len(kept)} of them tried before, in sources {tree}")
        if missing:
            limits = _unchanged(pristine, missing, tests=tests, tell=tell)
            trees = [Tree(Path(folder) / f"copy-{number}", pristine) for number in range(workers)]
            for each in trees:
                copy_tree(pristine, each.root)
            for row in _tried(missing, trees, limits, tree, tests=tests, tell=tell):
                kept[row.fault] = row
                write_rows(table, _in_order(kept, wanted))
        write_rows(table, _in_order(kept, wanted))
    return _in_order(kept, wanted)


def usable_cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _in_order(kept: dict[str, Row], wanted: Sequence[GeneratedFault]) -> list[Row]:
    return [kept[fault.name] for fault in wanted if fault.name in kept]


def _kept(
    rows: Sequence[Row], wanted: Sequence[GeneratedFault], tree: str, *, tests: bool, survivors_only: bool
) -> dict[str, Row]:
    changes = {fault.name: fault.change for fault in wanted}
    return {
        row.fault: row
        for row in rows
        if changes.get(row.fault) == row.change
        and (row.tree == tree or (survivors_only and row.found))
        and (row.found or row.tests or not tests)  # not yet put to the tests
    }


def _unchanged(pristine: Path, faults: Sequence[GeneratedFault], *, tests: bool, tell: Tell) -> Limits:
    """Return the limits from what the copy without a fault takes, and leave all compiled code in it."""
    # two times: the first compiles
    for _ in range(2):
        verdict = ask_check(pristine, (), Limits(), keep_compiled=True)
        tell(f"unchanged: the check found {verdict.found_by} in {verdict.seconds:.0f} s {verdict.detail}")
        _require_nothing(verdict, "the check")
    took = {}
    for folder in sorted({_folder(fault) for fault in faults}) if tests else ():
        of_folder = ask_tests(pristine, folder, Limits())
        tell(f"unchanged: the tests of {folder} found {of_folder.found_by} in {of_folder.seconds:.0f} s")
        _require_nothing(of_folder, f"tests/{folder}")
        took[folder] = of_folder.seconds
    return limits_from(verdict, took)


def _require_nothing(verdict: Verdict, what: str) -> None:
    if verdict.found_by != NOTHING:
        raise BrokenCheckoutError(
            f"{what} must pass without a fault, got {verdict.found_by}: {verdict.detail}"
        )


def _tried(
    faults: Sequence[GeneratedFault],
    trees: Sequence[Tree],
    limits: Limits,
    tree: str,
    *,
    tests: bool,
    tell: Tell,
) -> Iterable[Row]:
    free: queue.SimpleQueue[Tree] = queue.SimpleQueue()
    for each in trees:
        free.put(each)

    def tried(fault: GeneratedFault) -> Row:
        place = free.get()
        try:
            return _row(fault, place, limits, tree, tests=tests)
        finally:
            free.put(place)

    begun = time.monotonic()
    pool = ThreadPoolExecutor(len(trees))
    try:
        futures = [pool.submit(tried, fault) for fault in faults]
        for done, future in enumerate(as_completed(futures), start=1):
            row = future.result()
            left = (time.monotonic() - begun) / done * (len(faults) - done) / 60.0
            found = row.check if row.check != NOTHING or not row.tests else row.tests
            tell(f"[{done}/{len(faults)}, {left:.0f} min left] {found} ({row.seconds} s): {row.fault}")
            yield row
    finally:
        pool.shutdown(cancel_futures=True)


def _row(fault: GeneratedFault, place: Tree, limits: Limits, tree: str, *, tests: bool) -> Row:
    with place.holding(fault) as root:
        verdict = ask_check(root, group_of(fault.file).layers, limits)
        seconds, detail, asked = verdict.seconds, verdict.detail, ""
        if verdict.found_by == NOTHING and tests:
            by_tests = ask_tests(root, _folder(fault), limits, module=Path(fault.file).stem)
            seconds, detail, asked = seconds + by_tests.seconds, by_tests.detail, by_tests.found_by
    return Row(
        fault=fault.name,
        change=fault.change,
        check=verdict.found_by,
        tests=asked,
        seconds=f"{seconds:.0f}",
        detail=detail,
        tree=tree,
    )


def _folder(fault: GeneratedFault) -> str:
    """Return the folder of the tests of the package that a fault is in."""
    (folder,) = [package for package in PACKAGES if fault.file.startswith(f"{package}/")]
    return folder
