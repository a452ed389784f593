"""Figures: pictures as data, and their renderers."""

from __future__ import annotations

import importlib
from importlib.util import find_spec
from typing import TYPE_CHECKING

from ..registry import KINDS

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(value: object, part: str | None = None) -> Figure:
    """Matplotlib figure of a trace or of results.

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

    kind = getattr(value, "kind", "")
    name = KINDS[kind].name if kind in KINDS else type(value).__name__.lower()
    if find_spec(f".{name}", __name__) is None:
        name = "tables"
    pictures = importlib.import_module(f".{name}", __name__).pictures(value)
    names = []
    for picture in pictures:
        if part in (None, picture.name):
            return figure(picture)
        names.append(picture.name)
    if not names:
        raise ValueError(f"there is nothing to draw of {value!r}")
    raise ValueError(f"the figures are {', '.join(names)}, got {part!r}")
