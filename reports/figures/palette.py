"""Colours and line styles of runs: told apart by colour-blind readers and in black and white."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

# M. Okabe and K. Ito, Color Universal Design, 2008; without black (the reference) and the pale yellow
_ORDER = ("#0072B2", "#D55E00", "#56B4E9", "#E69F00", "#009E73", "#CC79A7")
# the dashes of plotly, and what they are in matplotlib
DASHES: Mapping[str, Any] = MappingProxyType(
    {
        "solid": "-",
        "dash": (0, (5, 2)),
        "dashdot": (0, (5, 2, 1, 2)),
        "dot": (0, (1, 1.5)),
        "longdash": (0, (9, 3)),
        "longdashdot": (0, (9, 3, 1, 3)),
    }
)
_REFERENCE = {"recess": ("#000000", "solid"), "flat": ("#666666", "dash")}
_REST = ("#000000", "dot")


@dataclass(frozen=True, slots=True, kw_only=True)
class Style:
    """Colour and dash (in plotly's words) of a line."""

    colour: str
    dash: str


def model_style(model: str) -> Style:
    """Return the style of a reduced model."""
    colour, dash = _REFERENCE.get(model, _REST)
    return Style(colour=colour, dash=dash)


def run_styles(labels: Sequence[str]) -> dict[str, Style]:
    """Return the style of each run, the same for the same order of runs."""
    dashes = tuple(DASHES)
    return {
        label: Style(colour=_ORDER[index % len(_ORDER)], dash=dashes[index % len(dashes)])
        for index, label in enumerate(labels)
    }
