"""The files of the report, and what the terminal says of it."""

from __future__ import annotations

from collections.abc import Sequence

from rockwobble.compare.studies.validity import Validity

from ...figures.svg import svg
from .headline import headline
from .page import HEADINGS, validity_document, validity_page
from .sections import Section, sections_of


def validity_pages(found: Validity) -> dict[str, bytes]:
    """Return the files by name: page, document, pictures, and the limits as a table."""
    sections = sections_of(dict(found.tables))
    pictures = [picture for section in sections for picture in section.pictures]
    about = {"command": found.origin.command, "extent": found.extent.name}
    return {
        "validity.html": validity_page(sections, found).encode(),
        "validity.md": validity_document(sections, found).encode(),
        **{f"{picture.name}.svg": svg(picture) for picture in pictures},
        "limits.parquet": limits_file(sections, about),
    }


def limits_file(sections: Sequence[Section], about: dict[str, str]) -> bytes:
    """Return the table of limits, one row for each number behind a limit."""
    import pandas as pd

    from rockwobble.compare.storage.parquet_file import pack

    rows = [
        {
            "limit": section.limit.subject,
            "number": name,
            "value": value,
            "use": section.limit.use,
            "error": section.limit.error,
            "avoid": section.limit.avoid,
        }
        for section in sections
        for name, value in section.limit.numbers.items()
    ]
    return pack(pd.DataFrame(rows), {"kind": "validity: limits", **about})


def print_limits(found: Validity) -> None:
    """Print the headline, and each limit with its three sentences."""
    from rich.console import Console

    sections = sections_of(dict(found.tables))
    console = Console()
    console.print()
    console.print(headline([section.limit for section in sections]), style="bold", highlight=False)
    for section in sections:
        limit = section.limit
        console.print(f"\n{limit.subject}", style="bold", highlight=False)
        for heading, words in zip(HEADINGS[1:], (limit.use, limit.error, limit.avoid), strict=True):
            console.print(f"  {heading}: {words}", highlight=False, markup=False)
