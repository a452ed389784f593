"""The terminal: a command as it was typed, its progress, and how it ends."""

from __future__ import annotations

import io
import math
import shlex
import shutil
import sys
import textwrap
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING

import typer

import rockwobble.compare as rc

from .pages.wording import some_of, written

if TYPE_CHECKING:
    from rich.text import Text

    from rockwobble.compare.runs.progress import Progress, ProgressCallback
    from rockwobble.compare.storage.results import Results
    from rockwobble.models.finding import Value

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130


def command_line() -> str:
    """Return the command that runs, as it would be typed."""
    return shlex.join(["rockwobble", *sys.argv[1:]])


def complain(message: str) -> None:
    """Print one line on standard error."""
    print(f"rockwobble: {' '.join(message.split())}", file=sys.stderr)


def echo(lines: Iterable[str]) -> None:
    """Print lines, wrapped where they are longer than the terminal is wide; warnings on standard error.

    Where nothing can be printed, what runs and is written goes on: what prints the answer fails.
    """
    with suppress(OSError):
        for line in lines:
            print(_wrap(line), file=sys.stderr if line.startswith("Warning: ") else sys.stdout)


def _wrap(line: str) -> str:
    width = shutil.get_terminal_size().columns
    return textwrap.fill(line, width, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)


@contextmanager
def user_input() -> Iterator[None]:
    """Turn a ValueError, which is what bad input raises, into one line and exit code 2.

    Only what depends on the user's input belongs in the block: a ValueError elsewhere is a defect
    and keeps its traceback.
    """
    try:
        yield
    except ValueError as error:
        complain(str(error))
        raise typer.Exit(BAD_INPUT) from None


@contextmanager
def interruptible(kept: Path | None = None) -> Iterator[None]:
    """Turn Ctrl-C into one line and exit code 130, and tasks that cannot be finished into one and code 1.

    `kept` is the folder of runs that need no repetition.
    """
    try:
        yield
    except rc.IncompleteError as error:
        complain(str(error))
        raise typer.Exit(FAILED) from None
    except KeyboardInterrupt:
        if kept is not None and kept.is_dir():
            complain(f"interrupted, the finished runs are kept in {kept}, and the same command resumes")
        else:
            complain("interrupted, nothing was written")
        raise typer.Exit(INTERRUPTED) from None


def replace_unencodable_output() -> None:
    """Let no poor encoding of the output stop a command."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="namereplace", line_buffering=True)


# up to so many tasks have a line each where there is no terminal
_FEW = 12
_FIRST, _PAUSE = 2.0, 10.0  # before the first line of more, and between two [s]


@contextmanager
def shown_progress(what: str = "runs", *, heading: str = "", each: bool = True) -> Iterator[ProgressCallback]:
    """Yield a callback that shows how far tasks are; `what` they are, and what for, in words.

    Where there is no terminal a line tells of `each` of a few, and of many one from time to time.
    It names each file of finished tasks that is damaged, once.
    """
    if heading:
        _say(f"{heading} ...")
    named: set[str] = set()
    with _bar(what) if sys.stderr.isatty() else _lines(what, _FEW if each else 0) as show:

        def show_progress(event: Progress) -> None:
            for path in event.damaged:
                if path not in named:
                    named.add(path)
                    complain(f"{path} is damaged, what it held is computed again")
            show(event)

        yield show_progress


def sentence(event: Progress, what: str = "runs") -> str:
    """Progress in words."""
    going = event.done < event.total and math.isfinite(event.left)
    values: dict[str, Value] = {"count": event.done, "count_all": event.total, "name": what}
    values |= {"count_before": event.found or None, "duration": event.left if going else None}
    return written("progress.tasks", values, {})


def _say(words: str) -> None:
    print(words, file=sys.stderr, flush=True)


@contextmanager
def _bar(what: str) -> Iterator[ProgressCallback]:
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bars

    columns = (
        BarColumn(),
        TextColumn("{task.fields[far]}"),
        TimeElapsedColumn(),
        # a name may have brackets, which would be markup
        TextColumn("{task.description}", markup=False),
    )
    with Bars(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task("", total=None, far="")
        running: dict[str, None] = {}

        def show_progress(event: Progress) -> None:
            if event.state == "started":
                running[event.label] = None
            else:
                running.pop(event.label, None)
            # a single task that reports its progress is shown by its share, not by the count
            done = event.share * event.total if event.found == 0 else event.done
            far = sentence(event, what)
            bars.update(
                task, total=event.total, completed=done, far=far, description=next(reversed(running), "")
            )

        yield show_progress


@contextmanager
def _lines(what: str, few: int) -> Iterator[ProgressCallback]:
    begun: dict[str, float] = {}
    start = last = time.monotonic()

    def show_progress(event: Progress) -> None:
        nonlocal last
        now = time.monotonic()
        if event.total - event.found <= few:
            if event.state == "started":
                begun[event.label] = now
                _say(f"running {event.label} ...")
            else:
                took = now - begun.get(event.label, now)
                _say(f"  done {event.label} in {took:.1f} s ({event.done} of {event.total})")
        elif (
            now - last >= (_PAUSE if last > start else _FIRST)
            or (few and event.state == "finished" and event.done == event.total)
        ):  # fmt: skip
            last = now
            _say(sentence(event, what))

    yield show_progress


def print_facts(heading: Sequence[str | Text], facts: Mapping[str, str], *, command: str = "") -> None:
    """Print a heading and facts by their names, as text, in which brackets are no markup.

    Names and facts are wrapped each in a column. No word is broken: one that is longer than a line, such as
    a path, is a line.

    Parameters
    ----------
    heading : sequence of str or Text
    facts : mapping of str to str
    command : str, optional
        Name of the fact that is a command, to be copied.
    """
    from rich.console import Console

    from .pages.command_line import command_lines

    console = Console()
    console.print(*heading, highlight=False, soft_wrap=True)
    # a hash of forty characters stands beside the names on eighty columns
    words = [len(word) for name in facts for word in name.split()]
    indent = max(min(max(map(len, facts), default=0), console.width * 2 // 5 - 2), *words, 0) + 2

    def wrapped(text: str, width: int) -> list[str]:
        return textwrap.wrap(text, max(width, 1), break_long_words=False, break_on_hyphens=False)

    for name, fact in facts.items():
        if name == command:
            print("\n".join([name, *command_lines(fact, console.width)]))
            continue
        for left, right in zip_longest(
            wrapped(name, indent - 2), wrapped(fact, console.width - indent), fillvalue=""
        ):
            print(f"{left.ljust(indent)}{right}".rstrip())
    print()


def show_and_save(found: Results, out: Path, *, details: bool = False) -> None:
    """Write results with their page; then print the page, with what is folded where `details` are wanted."""
    save_with_page(found, out, details=details)()


def open_page(page: Path, wanted: bool | None) -> None:
    """Open a page in the browser where that is wanted; None: in a terminal."""
    if sys.stdout.isatty() if wanted is None else wanted:
        import webbrowser

        webbrowser.open(page.resolve().as_uri())


def save_with_page(found: Results, out: Path, *, details: bool = False) -> Callable[[], None]:
    """Write results with their page, without the document of `report`, and return what prints the page."""
    from .pages import page_of

    found = found.made_by(command_line())
    page = page_of(found)
    pages = page.files(document=False)
    with user_input():
        found.save(out, pages=pages)

    def show() -> None:
        page.show(details=details)
        sheets = sorted(found.sheets(), key=lambda name: name.endswith(".json"))  # tables before findings
        first, *rest = dict.fromkeys([*reversed(pages), *sheets, "manifest.json"])
        tables = [f"{name}.parquet" for name in found.tables]
        print(_wrap(f"Written to {out}: {_listed(first, [*rest, *tables], len(str(out)))}"))

    return show


def _listed(first: str, names: Sequence[str], before: int) -> str:
    """As many names as one line has room for, and how many more there are."""
    shown, room = [first], shutil.get_terminal_size().columns - before - len("Written to : , and 99 more")
    for name in names:
        if len(", ".join([*shown, name])) > room:
            break
        shown.append(name)
    more = len(names) + 1 - len(shown)
    return some_of(shown, more)
