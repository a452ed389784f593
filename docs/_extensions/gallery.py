"""A gallery of published figures, each with its title, its page and the command that made it."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

PUBLISHED = Path(__file__).parents[2] / "reports" / "published"
_FIGURE = re.compile(r"^!\[([^\]]+)\]\(([^)]+\.svg)\)", re.MULTILINE)


def figures_of(folder: Path) -> dict[str, str]:
    """Return the titles of the figures of a folder of results by file, in the order of its pages."""
    found: dict[str, str] = {}
    for page in sorted(folder.glob("*.md")):
        for title, name in _FIGURE.findall(page.read_text(encoding="utf-8")):
            found.setdefault(name, title)
    return found


def command_of(folder: Path) -> str:
    """Return the command that made a folder of results: of its manifest, or the first of its README."""
    manifest = folder / "manifest.json"
    if manifest.exists():
        made = json.loads(manifest.read_text(encoding="utf-8"))
        return str(made.get("results", [made])[0]["command"])
    given = re.search(r"^    (python .*)$", (folder / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    return given[1] if given else ""


class Gallery(SphinxDirective):
    """`figure-gallery::` with lines FOLDER PAGE: all figures of a folder of results, linked to a page."""

    has_content = True
    option_spec: ClassVar[dict[str, Any]] = {}

    def run(self) -> list[nodes.Node]:
        """Return a section of figures for each line."""
        here = Path(self.env.doc2path(self.env.docname)).parent
        found: list[nodes.Node] = []
        for line in map(str.strip, self.content):
            name, page = line.split()
            folder = PUBLISHED / name
            figures = figures_of(folder)
            if not figures:
                raise self.error(f"{folder} has no page with figures")
            command = command_of(folder)
            link = addnodes.pending_xref(
                "", reftype="doc", refdomain="std", reftarget=page, refexplicit=False, refwarn=True
            )
            link += nodes.inline("", page)
            found.append(nodes.paragraph("", "", link, nodes.Text(": "), nodes.literal(command, command)))
            box = nodes.container(classes=["gallery"])
            for file, title in figures.items():
                place = Path(os.path.relpath(folder / file, here)).as_posix()
                figure = nodes.figure("", nodes.image(uri=place, alt=title), nodes.caption("", title))
                box += figure
            found.append(box)
        return found


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("figure-gallery", Gallery)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
