"""Display of values: a repr on one line, a table in a notebook, a figure."""

from __future__ import annotations

import dataclasses
import html
import importlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FEW = 3  # so many items are shown themselves
_MOST = 160  # characters of one field


class Brief:
    """A dataclass whose repr fits on a line: of what is long it says how much there is, of None nothing."""

    __slots__ = ()

    def __repr__(self) -> str:
        fields = dataclasses.fields(self)  # type: ignore[arg-type]  # its subclasses are dataclasses
        given = {field.name: getattr(self, field.name) for field in fields if field.repr}
        said = (f"{name}={_brief(value)}" for name, value in given.items() if value is not None)
        return f"{type(self).__name__}({', '.join(said)})"


def _brief(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, np.ndarray):
        return f"array{value.shape}"
    many = isinstance(value, Mapping) or (isinstance(value, Sequence) and not isinstance(value, str))
    text = repr(value)
    if (many and len(value) > _FEW) or "\n" in text or len(text) > _MOST:
        return f"{len(value)} items" if many else f"a {type(value).__name__}"
    return text


class Shown:
    """A result, which says its main facts on a line, in a notebook as a table, and plots itself."""

    __slots__ = ()
    _figures: ClassVar[str]  # the module of rockwobble.reports.figures that draws it

    def _said(self) -> Mapping[str, str]:
        """Return the main facts in words and numbers, by name."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({', '.join(f'{name} {value}' for name, value in self._said().items())})"
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>"
            for name, value in self._said().items()
        )
        return f"<table>{rows}</table>"

    def plot(self, part: str | None = None) -> Figure:
        """Return a matplotlib figure, drawn by `rockwobble.reports`.

        Parameters
        ----------
        part : str, optional
            Which of several: a case of a comparison, a picture of a report. Default: the first.

        Raises
        ------
        ValueError
            If there is no such part, or nothing to draw.
        """
        # by name: a result does not depend on who draws it
        figures = importlib.import_module(f"rockwobble.reports.figures.{self._figures}")
        names = []
        for picture in figures.pictures(self):
            if part in (None, picture.name):
                drawn: Figure = importlib.import_module("rockwobble.reports.figures.svg").figure(picture)
                return drawn
            names.append(picture.name)
        if not names:
            raise ValueError(f"there is nothing to draw of {self!r}")
        raise ValueError(f"the figures are {', '.join(names)}, got {part!r}")
