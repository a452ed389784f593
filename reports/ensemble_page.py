"""The page of an ensemble: its picture and its tables, in one file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .ensemble_figure import ensemble_figure
from .template import render

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble


def ensemble_page(found: Ensemble) -> str:
    """Return the page as HTML."""
    picture = ensemble_figure(found).decode()
    return render(
        "ensemble.html.j2",
        picture=picture[picture.index("<svg") :],
        about=found.about,
        tables=[
            (title, table.round(4).to_html(index=False, border=0, na_rep="–"))
            for title, table in (("Methods", found.methods), ("Each against each", found.contrasts))
        ],
    )
