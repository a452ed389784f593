"""Common main program of the scripts `NAME/make.py`: measure, redraw, check.

python reports/published/NAME/make.py            # measure, and write tables, page and figures
python reports/published/NAME/make.py --redraw   # draw page and figures of the stored tables again
python reports/published/NAME/make.py --check    # is the page borne out by its tables?
"""

from __future__ import annotations

import argparse
import re
import shlex
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

from rockwobble.compare import Results
from rockwobble.reports.pages.page import Page

Found = TypeVar("Found", bound=Results)
# a number on a page; digits that belong to a name, a colour or a version are compared, too, and do no harm
_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def not_borne_out(stored: str, today: str) -> list[str]:
    """Numbers on a stored page that are missing from the page drawn today."""
    kept, drawn = (Counter(_NUMBER.findall(each)) for each in (stored, today))
    return sorted(kept.keys() - drawn.keys())


def run(
    path: str,
    kind: type[Found],
    measure: Callable[[argparse.Namespace], Found],
    page_of: Callable[[Found], Page],
    *,
    options: Callable[[argparse.ArgumentParser], object] = lambda _: None,
    claims: Callable[[Found], Sequence[str]] = lambda _: (),
) -> int:
    """Run the command line of a script; return the exit code.

    Parameters
    ----------
    path : str
        Of the script, in whose folder the results are.
    kind : type
        Class of the results.
    measure : callable
        (options) -> results.
    page_of : callable
        (results with a manifest) -> page.
    options : callable, optional
        Adds the options of the script to its parser.
    claims : callable, optional
        (results) -> what its tables do not bear out, a line each.
    """
    folder = Path(path).resolve().parent
    parser = argparse.ArgumentParser(description=(sys.modules["__main__"].__doc__ or "").partition("\n")[0])
    parser.add_argument("--redraw", action="store_true", help="draw page and figures of the stored tables")
    parser.add_argument("--check", action="store_true", help="compare the page with its tables")
    options(parser)
    given = parser.parse_args()
    if given.check:
        try:
            results = kind.load(folder)
        except ValueError as error:
            print(f"{folder.name}: not checked, {error}")
            return 0
        rows = _checked(folder, results, page_of, claims)
        print(*rows, sep="\n", end="\n" if rows else "")
        return int(any(row.startswith("FAULT") for row in rows))
    if given.redraw:
        for name, content in page_of(kind.load(folder)).files().items():
            (folder / name).write_bytes(content)
        return 0
    command = f"python reports/published/{folder.name}/make.py"
    results = measure(given).made_by(shlex.join([*command.split(), *sys.argv[1:]]))
    pages = page_of(results).files()
    results.save(folder, pages=pages)
    print(f"Written to {folder}: {', '.join([*pages, *results.tables])}")
    return 0


def _checked(
    folder: Path, results: Found, page_of: Callable[[Found], Page], claims: Callable[[Found], Sequence[str]]
) -> list[str]:
    page = page_of(results)
    stored, today = (folder / f"{page.name}.md").read_text(encoding="utf-8"), page.markdown()
    rows = [f"FAULT {folder.name}: {each}" for each in claims(results)]
    if extra := not_borne_out(stored, today):
        rows.append(f"FAULT {folder.name}: its page says {', '.join(extra)}, its tables do not")
    if stored != today and not extra:
        rows.append(f"{folder.name}: today's page has other words; --redraw writes them")
    return rows
