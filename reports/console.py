"""The terminal: the command line, progress, messages and exit codes."""

from __future__ import annotations

import io
import math
import shlex
import shutil
import sys
import textwrap
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import typer

import rockwobble.compare as rc

from .pages.wording import some_of, written

if TYPE_CHECKING:
    from rockwobble.compare.runs.progress import Progress, ProgressCallback
    from rockwobble.compare.storage.results import Results
    from rockwobble.models.finding import Value

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130


def command_line() -> str:
    """The running command, as typed."""
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
            print(
                textwrap.fill(
                    line,
                    shutil.get_terminal_size().columns,
                    subsequent_indent="  ",
                    break_long_words=False,
                    break_on_hyphens=False,
                ),
                file=sys.stderr if line.startswith("Warning: ") else sys.stdout,
            )


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
    """Turn Ctrl-C into one line and exit code 130, and incomplete tasks into one line and code 1.

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
    """Replace characters that the encoding of the output lacks."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="namereplace", line_buffering=True)


_PAUSE = 10.0  # between two lines where there is no terminal [s]


@contextmanager
def shown_progress(what: str = "runs") -> Iterator[ProgressCallback]:
    """Yield a callback that shows the progress of tasks; `what`: the tasks in words.

    In a terminal by a bar, elsewhere by a line from time to time. A damaged file of finished tasks is named.
    """
    named, running = set[str](), dict[str, None]()
    with _bar() if sys.stderr.isatty() else _lines() as show:

        def show_progress(event: Progress) -> None:
            for path in sorted({*event.damaged} - named):
                named.add(path)
                complain(f"{path} is damaged, what it held is computed again")
            if event.state == "started":
                running[event.label] = None
            else:
                running.pop(event.label, None)
            show(event, ": ".join([sentence(event, what), *[*running][-1:]]))

        yield show_progress


def sentence(event: Progress, what: str = "runs") -> str:
    """Progress in words."""
    going = event.done < event.total and math.isfinite(event.left)
    values: dict[str, Value] = {"count": event.done, "count_all": event.total, "name": what}
    values |= {"count_before": event.found or None, "duration": event.left if going else None}
    return written("progress.tasks", values, {})


@contextmanager
def _bar() -> Iterator[Callable[[Progress, str], None]]:
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    # brackets in a name would be read as markup
    words = TextColumn("{task.description}", markup=False)
    with Bar(BarColumn(), TimeElapsedColumn(), words, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None)

        def show(event: Progress, far: str) -> None:
            # a single task that reports its progress is shown by its share, not by the count
            done = event.share * event.total if event.found == 0 else event.done
            bar.update(task, total=event.total, completed=done, description=far)

        yield show


@contextmanager
def _lines() -> Iterator[Callable[[Progress, str], None]]:
    following = -math.inf

    def show(event: Progress, far: str) -> None:
        nonlocal following
        if (now := time.monotonic()) >= following:
            following = now + _PAUSE
            print(far, file=sys.stderr, flush=True)

    yield show


def open_page(page: Path, wanted: bool | None) -> None:
    """Open a page in the browser; with None only in a terminal."""
    if sys.stdout.isatty() if wanted is None else wanted:
        import webbrowser

        webbrowser.open(page.resolve().as_uri())


def save_with_page(results: Results, out: Path) -> Callable[..., None]:
    """Write results with their HTML page but no Markdown document, and return the printer of the page."""
    from .pages import page_of

    results = results.made_by(command_line())
    page = page_of(results)
    pages = page.files(document=False)
    with user_input():
        results.save(out, pages=pages)

    def show(*, details: bool = False) -> None:
        page.show(details=details)
        sheets = sorted(results.sheets(), key=lambda name: name.endswith(".json"))  # tables before findings
        names = [*dict.fromkeys([*reversed(pages), *sheets, "manifest.json"])]
        echo([f"Written to {out}: {some_of(names[:2], len(names) + len(results.tables) - 2)}"])

    return show
