"""Terms of the glossary become links where a page uses them first, so that no word comes undefined."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.domains.std import StandardDomain

GLOSSARY = "glossary"
CLASS = "first-use"
# terms that are verbs or names of files, too: a page links them by hand
_AMBIGUOUS = ("pass", "guide", "record")
# words in these are names, headings, or links already
_LEFT_ALONE = (
    nodes.reference,
    nodes.title,
    nodes.literal,
    nodes.literal_block,
    nodes.raw,
    nodes.math,
    nodes.math_block,
    nodes.image,
    nodes.term,
)


def linked_here(page: str) -> bool:
    """Return whether a page is one that teaches: the reference of names has its own words."""
    return page != GLOSSARY and not page.startswith("reference/")


def pattern_of(terms: list[str]) -> re.Pattern[str]:
    """Return what finds any of the terms, the longest first, in singular or plural."""
    words = "|".join(re.escape(term) for term in sorted(terms, key=len, reverse=True))
    return re.compile(rf"(?<![\w-])({words})(?:e?s)?(?![\w-])", re.IGNORECASE)


def _link_first_uses(app: Sphinx, doctree: nodes.document, page: str) -> None:
    if not linked_here(page):
        return
    standard = app.env.domains["std"]
    assert isinstance(standard, StandardDomain)
    places = {term.lower(): place for (kind, term), place in standard.objects.items() if kind == "term"}
    waiting = {term: place for term, place in places.items() if term not in _AMBIGUOUS}
    for text in list(doctree.findall(nodes.Text)):
        if waiting and not _inside(text):
            _replace(text, waiting, lambda place: _address(app, page, place))


def _inside(text: nodes.Text) -> bool:
    node = text.parent
    while node is not None:
        if isinstance(node, _LEFT_ALONE) or "cell_output" in node.get("classes", []):
            return True
        node = node.parent
    return False


def _address(app: Sphinx, page: str, place: tuple[str, str]) -> str:
    target, anchor = place
    return f"{app.builder.get_relative_uri(page, target)}#{anchor}"


def _replace(text: nodes.Text, waiting: dict[str, tuple[str, str]], address: Any) -> None:
    said, parts, done = text.astext(), [], 0
    for found in pattern_of(list(waiting)).finditer(said):
        term = found.group(1).lower()
        if term not in waiting:
            continue  # a second use in the same text
        link = nodes.reference("", "", internal=True, refuri=address(waiting.pop(term)), classes=[CLASS])
        link += nodes.Text(found.group())
        parts += [nodes.Text(said[done : found.start()]), link]
        done = found.end()
    if parts:
        text.parent.replace(text, [*parts, nodes.Text(said[done:])])


def setup(app: Sphinx) -> dict[str, Any]:
    """Link when all pages are read."""
    app.connect("doctree-resolved", _link_first_uses)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
