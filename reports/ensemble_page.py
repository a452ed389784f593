"""The page of an ensemble: its picture and its tables, in one file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .ensemble_figure import ensemble_figure

if TYPE_CHECKING:
    from rockwobble.compare import Ensemble


def ensemble_page(found: Ensemble) -> str:
    """Return the page as HTML."""
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("rockwobble.reports", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    picture = ensemble_figure(found).decode()
    return environment.get_template("ensemble.html.j2").render(
        picture=picture[picture.index("<svg") :],
        about=found.about,
        tables=[
            (title, table.round(4).to_html(index=False, border=0, na_rep="–"))
            for title, table in (("Methods", found.methods), ("Each against each", found.contrasts))
        ],
    )
