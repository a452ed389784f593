"""How the lines of methods are drawn: colour by family, mark by line, alike on the screen and on paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rockwobble.multibody.engines.registry import engine_packages

Dash = Literal["-", "--", ":", "-."]

# M. Okabe and K. Ito, Color Universal Design, 2008
_ENGINES = ("#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9")  # in the order in which they are known
_COLOURS = {"reduced": "#000000", "scipy": "#CC79A7"} | dict(zip(engine_packages(), _ENGINES, strict=False))
_OTHER = "#F0E442"
# in plotly's words and in matplotlib's
_MARKS = (
    ("circle", "o"), ("square", "s"), ("diamond", "D"), ("triangle-up", "^"), ("triangle-down", "v"),
    ("star", "*"), ("cross", "P"), ("x", "X"), ("pentagon", "p"),
)  # fmt: skip
_DASHES: tuple[tuple[str, Dash], ...] = (("solid", "-"), ("dash", "--"), ("dot", ":"), ("dashdot", "-."))


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """Colour, symbol and dash of a line, the last two as (plotly, matplotlib)."""

    colour: str
    symbol: tuple[str, str]
    dash: tuple[str, Dash]


def marks(lines: Sequence[tuple[str, str]]) -> dict[str, Mark]:
    """Return the mark of each line, given as (family, line): the same for the same lines."""
    found: dict[str, Mark] = {}
    seen: dict[str, int] = {}
    for family, line in dict.fromkeys(lines):
        place = seen.setdefault(family, 0)
        seen[family] += 1
        found[line] = Mark(
            colour=_COLOURS.get(family, _OTHER),
            symbol=_MARKS[place % len(_MARKS)],
            dash=_DASHES[place % len(_DASHES)],
        )
    return found
