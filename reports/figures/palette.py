"""Colours, dashes and symbols: distinct to colour-blind readers and in black and white."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from rockwobble.models.support import FLAT, RECESS

# M. Okabe and K. Ito, Color Universal Design, 2008; without black (the reference) and the pale yellow
ORDER = ("#0072B2", "#D55E00", "#56B4E9", "#E69F00", "#009E73", "#CC79A7")
DARK, GREY, PALE = "#222222", "#9a9a9a", "#e8eef4"
SHADED = "#f3e3c3"  # a strip behind lines

# dashes, and what they are in matplotlib
DASHES: Mapping[str, str | tuple[float, tuple[float, ...]]] = {
    "solid": "-",
    "dash": (0, (5, 2)),
    "dashdot": (0, (5, 2, 1, 2)),
    "dot": (0, (1, 1.5)),
    "longdash": (0, (9, 3)),
    "longdashdot": (0, (9, 3, 1, 3)),
    "none": "none",
}
# symbols, and what they are in matplotlib
SYMBOLS: Mapping[str, str] = {
    **{"circle": "o", "square": "s", "triangle-up": "^", "diamond": "D", "triangle-down": "v"},
    **{"star": "*", "cross": "P", "x": "X", "pentagon": "p", "hexagon": "h"},
    **{"triangle-left": "<", "triangle-right": ">", "cross-thin": "+", "x-thin": "x"},
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Style:
    """Colour, dash and symbol of a line; no symbol: no marks, dash "none": only marks."""

    colour: str
    dash: str = "solid"
    symbol: str = ""


_MODEL_STYLES = {
    RECESS.model: Style(colour="#000000"),
    FLAT.model: Style(colour="#666666", dash="dash"),
}
_OTHER_MODEL = Style(colour="#000000", dash="dot")


def model_style(label: str) -> Style:
    """Style of a reduced model."""
    return _MODEL_STYLES.get(label, _OTHER_MODEL)


def run_styles(labels: Sequence[str]) -> dict[str, Style]:
    """Style of each run, the same for the same order of runs."""
    dashes = [dash for dash in DASHES if dash != "none"]
    return {
        label: Style(colour=ORDER[index % len(ORDER)], dash=dashes[index % len(dashes)])
        for index, label in enumerate(labels)
    }


def label_styles(labels: Sequence[str], models: Collection[str] = ()) -> dict[str, Style]:
    """Style of each label: model style for labels of `models`, else run style.

    Of models of one style the first has it, and the others are drawn as runs.
    """
    of_models: dict[Style, str] = {}
    for label in filter(models.__contains__, labels):
        of_models.setdefault(model_style(label), label)
    styles = {label: style for style, label in of_models.items()}
    runs = run_styles([label for label in labels if label not in styles])
    return {label: (styles | runs)[label] for label in labels}


def mark_styles(labels: Sequence[str], *, lines: bool = True) -> dict[str, Style]:
    """Return styles with a symbol each, with lines or without."""
    symbols = list(SYMBOLS)
    return {
        label: Style(
            colour=style.colour,
            dash=style.dash if lines else "none",
            symbol=symbols[index % len(symbols)],
        )
        for index, (label, style) in enumerate(run_styles(labels).items())
    }


def pale(colour: str) -> str:
    """Colour mixed with white, used in place of transparency, which renderers draw differently."""
    parts = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return "#" + "".join(f"{round(0.45 * part + 0.55 * 255):02x}" for part in parts)
