"""An ensemble as a page in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from .ensemble_words import LEGEND, WORDS, facts, statements, tables
from .paper.provenance import made_by

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble


def ensemble_document(found: Ensemble) -> str:
    """Return the page as Markdown; its picture is ensemble.svg."""
    headline, *rest = statements(found)
    (_, headings, rows), *others = tables(found)
    parts = [
        "# Distributions of peak tilt",
        "Once traces have parted, single runs say nothing about each other; distributions over many members "
        "do. " + "; ".join(facts(found)) + ".",
        f"**{headline}**",
        "![Share of the members whose peak tilt is at most that of the axis, by method](ensemble.svg)",
        "Each curve is the share of the members with at most this peak tilt; what it lacks to 1 overturns.",
        "\n".join(f"- {sentence}" for sentence in rest),
        _table(headings, rows),
        LEGEND,
    ]
    for title, headings, rows in others:
        parts += [f"## {title}", _table(headings, rows)]
    return "\n\n".join([*parts, made_by(found.about["versions"], found.about.get("command"))]) + "\n"


def _table(headings: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    rule = ["---" if heading in WORDS else "---:" for heading in headings]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (headings, rule, *rows))
