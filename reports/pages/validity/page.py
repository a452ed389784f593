"""The report as a page and as a document: the same sections, pictures and words."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from rockwobble.compare.studies.validity import Validity

from ...figures.interactive import plots
from ...figures.picture import Picture
from ..origin_words import made_by
from ..template import render
from .about import about
from .headline import headline
from .sections import Section

HEADINGS = ("Limit", "Use the reduced model", "Error to expect", "Do not use it")
_LEAD = (
    "The reduced model has two degrees of freedom, tilt and rolling angle, for a cylinder that neither "
    "slips nor "
    "rolls out of its place, as in an ideal recess. Its neighbours are the flat-ground model, a cylinder on "
    "open ground "
    "with friction enough, and a multibody engine, which knows contact and friction."
)


def validity_page(sections: Sequence[Section], found: Validity) -> str:
    """Return the page as HTML that needs nothing else."""
    return render(
        "validity.html.j2",
        lead=_LEAD,
        headline=headline([section.limit for section in sections]),
        about=about(found.extent, found.motions, found.records),
        extent=found.extent.name,
        headings=HEADINGS,
        sections=[
            {
                "limit": section.limit,
                "pictures": [
                    {"title": picture.title, "caption": picture.caption, "panels": _panels(picture)}
                    for picture in section.pictures
                ],
            }
            for section in sections
        ],
        origin=found.origin,
    )


def _panels(picture: Picture) -> list[dict[str, str]]:
    return [{"title": title, "plot": plot} for title, plot in plots(picture)]


def validity_document(sections: Sequence[Section], found: Validity) -> str:
    """Return the report in Markdown; the pictures are SVG files beside it."""
    limits = [section.limit for section in sections]
    parts = [
        "# Where the reduced model may be trusted",
        f"**{headline(limits)}**",
        _LEAD,
        "\n".join(f"- {line}" for line in about(found.extent, found.motions, found.records)),
    ]
    for section in sections:
        limit = section.limit
        parts += [f"## {limit.subject}"]
        for picture in section.pictures:
            parts += [f"![{picture.title}]({picture.name}.svg)", f"*{picture.title}.* {picture.caption}"]
        parts += [
            f"- Use the reduced model: {limit.use}",
            f"- Error to expect: {limit.error}",
            f"- Do not use it: {limit.avoid}",
        ]
    parts += ["## Limits", limits_table(sections), "---"]
    parts += [f"{made_by(found.origin)} Extent: {found.extent.name}.", ""]
    return _joined(parts)


def limits_table(sections: Sequence[Section]) -> str:
    """Return the table of limits in Markdown."""
    rows = [HEADINGS, ("---",) * len(HEADINGS)] + [
        (section.limit.subject, section.limit.use, section.limit.error, section.limit.avoid)
        for section in sections
    ]
    # a vertical bar would end a cell
    return "\n".join(f"| {' | '.join(cell.replace('|', '∣') for cell in row)} |" for row in rows)


def _joined(parts: Sequence[str]) -> str:
    """Join paragraphs; items of one list stay together."""
    text = parts[0]
    for before, part in pairwise(parts):
        together = before.startswith("- ") and part.startswith("- ")
        text += ("\n" if together else "\n\n") + part
    return text
