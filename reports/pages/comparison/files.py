"""What a person opens of a comparison: the page and the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.compare import Comparison

# up to so many cases each has a table and a part of the page of its own
SINGLY = 3


def comparison_pages(comparison: Comparison, command: str = "") -> dict[str, bytes]:
    """Return name and content of each file: a page for few cases or for many, and the main picture."""
    from ...figures.budget_figure import budget_figure
    from ...figures.comparison_picture import comparison_picture
    from ...figures.svg import svg
    from .page import comparison_page
    from .suite_page import suite_page

    page = suite_page if len(comparison.cases) > SINGLY else comparison_page
    return {
        "report.html": page(comparison, command).encode(),
        "figure.svg": svg(comparison_picture(comparison, next(iter(comparison.cases)))),
        **({"budget.svg": budget_figure(comparison)} if comparison.budgets else {}),
    }
