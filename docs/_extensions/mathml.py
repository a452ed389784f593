"""Formulas as MathML, which browsers draw themselves: a page asks for nothing outside of the site."""

from __future__ import annotations

import html
import re
import unicodedata
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

# the converter leaves no space between a factor and the function behind it
_FUNCTION = re.compile(r"<mi>(sin|cos|tan|sgn|atan)</mi>")
_SPACED = r'<mrow><mspace width="0.17em"/><mi>\1</mi></mrow>'
# browsers know no bold variant of a letter, but bold letters
_BOLD = re.compile(r'<mi mathvariant="(bold|bold-italic)">(&#x[0-9A-F]+;|[A-Za-z])</mi>')


def _mathml(source: str, display: str) -> str:
    return _BOLD.sub(_bold, _FUNCTION.sub(_SPACED, convert(source, display=display)))


def _bold(found: re.Match[str]) -> str:
    letter = html.unescape(found[2])
    kind = "GREEK" if "\u0370" <= letter <= "\u03ff" else "LATIN"
    name = unicodedata.name(letter).replace(f"{kind} ", "").replace("LETTER ", "")
    style = found[1].upper().replace("-", " ")
    return f"<mi>{unicodedata.lookup(f'MATHEMATICAL {style} {name}')}</mi>"


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
