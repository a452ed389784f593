"""Figures: what they show, and how they are drawn."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# class of what is drawn: the module here whose `pictures` says what its figures show; imported where it is
# drawn, because one figure must not wait for the imports of all
_MODULES: Mapping[str, str] = {
    "Advice": "advice",
    "Comparison": "comparison",
    "Ensemble": "ensemble",
    "Extremes": "extremes",
    "Fragility": "fragility",
    "OverturningSpectrum": "spectrum",
    "Sweep": "sweep",
    "Trace": "trace",
    "Tradeoff": "tradeoff",
    "Validity": "validity",
}


def draw(value: object, part: str | None = None) -> Figure:
    """Return a matplotlib figure of a trace or of results.

    Parameters
    ----------
    value : Trace or Results
    part : str, optional
        Name of the picture, where there are several. Default: the first.

    Raises
    ------
    ValueError
        If there is no such picture, or nothing to draw.
    """
    from .svg import figure

    pictures = importlib.import_module(f".{_MODULES[type(value).__name__]}", __name__).pictures(value)
    names = []
    for picture in pictures:
        if part in (None, picture.name):
            return figure(picture)
        names.append(picture.name)
    if not names:
        raise ValueError(f"there is nothing to draw of {value!r}")
    raise ValueError(f"the figures are {', '.join(names)}, got {part!r}")
