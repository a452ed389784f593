"""Formulas as MathML, which browsers draw themselves: a page asks for nothing outside of the site."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator


def _inline(writer: HTML5Translator, node: nodes.math) -> None:
    writer.body.append(convert(node.astext()))
    raise nodes.SkipNode


def _displayed(writer: HTML5Translator, node: nodes.math_block) -> None:
    source = node.astext().strip()
    if "&" in source and r"\begin" not in source:
        source = rf"\begin{{align}}{source}\end{{align}}"
    writer.body.append(writer.starttag(node, "div", CLASS="formula", ids=node.get("ids", [])))
    writer.body.append(convert(source, display="block"))
    if node["number"]:
        writer.body.append(f'<span class="formula-number">({node["number"]})</span>')
    writer.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the renderer; conf.py chooses it."""
    app.add_html_math_renderer("mathml", (_inline, None), (_displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
