"""Formulas as MathML, which browsers draw themselves: a page asks for nothing outside of the site."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

# the converter leaves no space between a factor and the function behind it
_FUNCTION = re.compile(r"<mi>(sin|cos|tan|sgn|atan)</mi>")
_SPACED = r'<mrow><mspace width="0.17em"/><mi>\1</mi></mrow>'


def _mathml(source: str, display: str) -> str:
    return _FUNCTION.sub(_SPACED, convert(source, display=display))


def _inline(writer: HTML5Translator, node: nodes.math) -> None:
    writer.body.append(_mathml(node.astext(), "inline"))
    raise nodes.SkipNode


def _displayed(writer: HTML5Translator, node: nodes.math_block) -> None:
    writer.body.append(writer.starttag(node, "div", CLASS="formula", ids=node.get("ids", [])))
    writer.body.append(_mathml(node.astext().strip(), "block"))
    writer.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the renderer, which conf.py chooses; equations have the numbers of the paper alone."""
    app.add_html_math_renderer("mathml", (_inline, None), (_displayed, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
