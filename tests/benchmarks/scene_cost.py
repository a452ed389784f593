"""Print what each part of an engine's scene costs: a step of every support and option, see `scene_costs`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rockwobble.compare.runs.progress import stages
from rockwobble.studies.scene_cost import ROUNDS, STEPS, scene_costs

from .console import options_of

if TYPE_CHECKING:
    import pandas as pd


def print_table(table: pd.DataFrame) -> None:
    """Print the table of `scene_costs` for a person to read."""
    from rich.box import SIMPLE
    from rich.console import Console
    from rich.table import Table

    shown = Table(
        title="Cost of one step, R = 6 m, tan alpha = 0.2, h = 1e-4 s",
        title_justify="left",
        box=SIMPLE,
        show_edge=False,
        pad_edge=False,
        padding=(0, 1, 0, 0),
    )
    for name in ("engine", "support", "scene"):
        shown.add_column(name, no_wrap=True)
    for name in ("dof", "contacts", "rows", "us/step", "ratio"):
        shown.add_column(name, justify="right", no_wrap=True)
    before = ("", "")
    for row in table.to_dict("records"):
        here = row["engine"], row["support"]
        if before[0] and here[0] != before[0]:
            shown.add_section()
        shown.add_row(
            here[0] if here[0] != before[0] else "",
            here[1] if here != before else "",
            row["option"],
            str(row["degrees_of_freedom"]),
            str(row["contacts"]),
            str(row["constraint_rows"]),
            f"{row['microseconds']:.2f}",
            f"{row['ratio']:.2f}",
        )
        before = here
    Console().print(shown)
    Console().print("dof: degrees of freedom; rows: scalar constraints; ratio: to the cheapest")


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    import sys

    parser = options_of(
        "scene_cost",
        "Cost of one step of every support and option. Example: --engine mujoco --out cost.csv",
    )
    parser.add_argument(
        "--engine", action="append", help="mujoco or pybullet; may be repeated (default: all)"
    )
    parser.add_argument(
        "--rounds", type=int, default=ROUNDS, help="times each scene is measured (%(default)s)"
    )
    parser.add_argument("--steps", type=int, default=STEPS, help="steps each time (%(default)s)")
    parser.add_argument("--out", help="also write the table there, as CSV")
    given = parser.parse_args(arguments)
    try:
        table = scene_costs(
            given.engine,
            rounds=given.rounds,
            steps=given.steps,
            stage=stages(lambda at: print(at.state, at.label, file=sys.stderr), [1.0] * given.rounds),
        )
    except ValueError as error:
        parser.error(str(error))
    print_table(table)
    if given.out:
        table.to_csv(given.out, index=False)
    return 0
