"""What a check found, for people: a table in the terminal, layer by layer, as it is found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .check_output import bound, measured

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from rockwobble.compare.check import Finding

_STYLES = {"passed": "green", "FAILED": "bold red", "no baseline": "yellow", "not run": "yellow"}
_MINIMUM_WIDTH = 150  # where there is no terminal
_ROOM_FOR_REASONS = 120
LAYER_WORDS = {
    "records": "Records: files of every form, the records that ship, pulses",
    "equations": "Equations: Lagrange's, (18) and (19) on computed motions; accelerations in the engines",
    "conserved": "Conserved: energy and L in free motion, and the work of the ground",
    "exact": "Exact solutions: uplift, periods, angles of turn, steady wobble",
    "rest": "Rest: uplift at once, rest, landings, and what comes after the end of a record",
    "invariance": "Invariance: mirror, size, rotation, delay, gravity, sampling",
    "properties": "Properties: one motion stated in several ways; turning points, peaks and passes",
    "order": "Order: error against tolerance and time step",
    "residual": "Residual: no displacement and no twist is left",
    "metrics": "Metrics: differences, agreement times and external trajectories on made-up traces",
    "studies": "Studies: peak_tilts, suites and sweeps against single runs",
    "traces": "Traces: every field of an engine's trace",
    "agreement": "Agreement: engines against the reduced models",
    "baseline": "Baseline: the numbers that were kept",
}


def layer_table(layer: str, findings: Sequence[Finding], *, reasons: bool = True) -> Table:
    """Return the table of one layer, with the reasons of the bounds where there is room for them."""
    from rich.table import Table
    from rich.text import Text

    table = Table(title=LAYER_WORDS[layer], title_justify="left", title_style="bold", expand=False)
    table.add_column("check", overflow="fold", ratio=4)
    table.add_column("measured", justify="right", no_wrap=True)
    table.add_column("bound", justify="right", no_wrap=True)
    table.add_column("outcome", no_wrap=True)
    if reasons:
        table.add_column("reason of the bound", overflow="fold", ratio=3, style="dim")
    for finding in findings:
        table.add_row(
            Text(finding.name),
            measured(finding),
            bound(finding),
            Text(finding.outcome, style=_STYLES[finding.outcome]),
            *([Text(finding.reason)] if reasons else []),
        )
    return table


def print_layer(console: Console, layer: str, findings: Sequence[Finding]) -> None:
    """Print one layer, and below it what is wrong."""
    if not console.is_terminal:
        console.width = max(console.width, _MINIMUM_WIDTH)
    console.print()
    console.print(layer_table(layer, findings, reasons=console.width >= _ROOM_FOR_REASONS))
    for finding in findings:
        if finding.failed:
            note = f" ({finding.note})" if finding.note else ""
            console.print(f"wrong: {finding.part}", style="bold red", highlight=False, markup=False, end="")
            console.print(
                f" - {finding.name}: {measured(finding)}, at most {bound(finding)}{note}",
                highlight=False,
                markup=False,
            )
        elif finding.outcome != "passed":
            console.print(f"{finding.name}: {finding.note}", style="yellow", highlight=False, markup=False)
