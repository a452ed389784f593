"""An ensemble as a page in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..provenance import made_by
from .words import CAPTION, INTRODUCTION, LEGEND, WORDS, facts, statements, tables

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble


def ensemble_document(found: Ensemble) -> str:
    """Return the page as Markdown; its picture is ensemble.svg."""
    headline, *rest = statements(found)
    (_, headings, rows), *others = tables(found)
    parts = [
        "# Distributions of peak tilt",
        f"{INTRODUCTION} {'; '.join(facts(found))}.",
        f"**{headline}**",
        "![Distributions of peak tilt by method, and ratios of the peaks of each member](ensemble.svg)",
        CAPTION,
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
