"""Display of values: a repr on one line, a table in a notebook, a figure."""

from __future__ import annotations

import dataclasses
import html
from collections.abc import Iterable, Mapping, Sequence, Sized
from importlib.metadata import entry_points
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DRAWERS = "rockwobble.figures"  # group of entry points in which a package that draws registers
LONGEST = 110  # characters of a repr: a line
_FEW, _MOST = 3, 70  # items, and characters of one fact, that are shown in full


def line(name: str, facts: Iterable[str]) -> str:
    """Line `name(fact, fact, ...)` with as many of the first facts as it has room for."""
    kept = list(facts)
    whole = f"{name}({', '.join(kept)})"
    while len(whole) > LONGEST and len(kept) > 1:
        kept.pop()
        whole = f"{name}({', '.join(kept)}, ...)"
    return whole


class CompactRepr:
    """A dataclass whose repr is one line: long values by their size, defaults left out."""

    __slots__ = ()

    def __repr__(self) -> str:
        fields = dataclasses.fields(self)  # type: ignore[arg-type]  # its subclasses are dataclasses
        given = ((field, getattr(self, field.name)) for field in fields if field.repr)
        facts = (f"{field.name}={brief(value)}" for field, value in given if not _is_default(field, value))
        return line(type(self).__name__, facts)


def _is_default(field: dataclasses.Field[object], value: object) -> bool:
    if field.default_factory is not dataclasses.MISSING:
        return isinstance(value, Sized) and not len(value)
    if value is None or value is field.default:
        return True
    # equal also for NaN objects that differ
    return isinstance(value, int | float | str | tuple) and repr(value) == repr(field.default)


def _cut(text: str, length: int) -> str:
    return text if len(text) <= length else f"{text[: length - 3]}..."


def brief(value: object) -> str:
    """Value in words for a part of a line."""
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, np.ndarray):
        return f"array{value.shape}"
    if isinstance(value, str):
        return repr(_cut(value, _MOST // 2))
    items = len(value) if isinstance(value, Mapping | Sequence) else 0
    if items <= _FEW:
        text = repr(value)
        if "\n" not in text and len(text) <= _MOST:
            return text
    if isinstance(value, Mapping | Sequence):
        return f"{items} item{'' if items == 1 else 's'}"
    kind, name = type(value).__name__, getattr(value, "name", None)
    return f"{kind} {brief(name)}" if isinstance(name, str) else f"a {kind}"


class Shown:
    """Result with its main facts on a line, as a table in a notebook, and as a plot."""

    __slots__ = ()

    def _main_facts(self) -> Mapping[str, str]:
        """Return the main facts in words and numbers, by name."""
        raise NotImplementedError

    def __repr__(self) -> str:
        facts = (f"{name} {value}" for name, value in self._main_facts().items())
        return line(type(self).__name__, (_cut(fact, _MOST) for fact in facts))

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>"
            for name, value in self._main_facts().items()
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
        for entry in entry_points(group=_DRAWERS):
            drawn: Figure = entry.load()(self, part)
            return drawn
        raise ValueError("figures are drawn by rockwobble.reports, which is not installed here")
