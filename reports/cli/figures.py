"""`rockwobble figures`: the figures of the paper, computed again."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..console.terminal import interruptible, user_input
from .inputs import options

if TYPE_CHECKING:
    from ..paper.page import Section

# three sizes make bands to compare, and a map
_LEAST_GRID, _MOST_GRID = 3, 1000

Grid = Annotated[int, typer.Option("--grid", help="Sizes, and intensities, of the maps of figure 6.")]


def figures(grid: Grid = 100, out: options.Out = Path("rockwobble-out")) -> None:
    """Compute figures 3 to 6 of the paper again, and hold its claims against the numbers.

    Writes paper.md with the figures and a verdict on each claim, figure-3.svg
    to figure-6.svg, the data of each as Parquet, and claims.csv.
    """
    with interruptible():
        with user_input():
            from rockwobble.compare import replace_files, require_writable

            if not _LEAST_GRID <= grid <= _MOST_GRID:
                raise ValueError(f"--grid must be from {_LEAST_GRID} to {_MOST_GRID}, got {grid}")
            require_writable(out)
        for line in _described(grid):
            print(line)
        sections = _sections(grid)
        contents = paper_files(sections)
        with user_input():
            replace_files(out, contents)
    _print_verdicts(sections)
    print(f"\nWritten to {out}: {', '.join(contents)}")


def _described(grid: int) -> list[str]:
    from ..console.spectrum_output import describe_grid
    from ..paper import earthquake, free, overturning

    bodies = [(4, free.CYLINDER), (5, earthquake.CYLINDER)]
    lines = [
        f"Figure {number}: R = {body.semidiagonal:g} m, tan alpha = {body.tan_alpha:g}, "
        f"b = {body.base_radius:.4g} m, 2h = {2.0 * body.half_height:.4g} m, "
        f"alpha = {math.degrees(body.alpha):.4g} deg"
        for number, body in bodies
    ]
    return lines + [f"Figure 6: {line}" for line in describe_grid(**overturning.problem(grid))]


def paper_files(sections: list[Section]) -> dict[str, bytes]:
    """Return the files of the figures by name."""
    from rockwobble.compare.storage.fingerprint import fingerprint
    from rockwobble.compare.storage.provenance import reduced_makers

    from ..pages.provenance import parquet
    from ..paper.page import claims_frame, paper_page

    contents = {"paper.md": paper_page(sections).encode()}
    for section in sections:
        contents[section.picture] = section.svg
        for name, table in section.tables.items():
            # what the figures of the paper take is the code itself
            inputs = fingerprint((name, reduced_makers()))
            contents[name] = parquet(table, "rockwobble paper", inputs)
    contents["claims.csv"] = claims_frame(sections).to_csv(index=False).encode()
    return contents


def _sections(grid: int) -> list[Section]:
    from ..paper import sections

    make: list[Callable[[], Section]] = [
        sections.period_section,
        sections.free_section,
        sections.earthquake_section,
        lambda: sections.overturning_section(grid),
    ]
    made = []
    for run in make:
        started = time.perf_counter()
        made.append(run())
        print(f"figure {made[-1].number} took {time.perf_counter() - started:.1f} s", file=sys.stderr)
    return made


def _print_verdicts(sections: list[Section]) -> None:
    from rich.console import Console

    console = Console()
    for section in sections:
        console.print(f"\nFigure {section.number}: {section.title}", style="bold", highlight=False)
        for claim in section.claims:
            console.print(f"- {claim.verdict}: {claim.says}", highlight=False, markup=False)
