"""The reference of the studies at the top: the function of each and its results."""

from __future__ import annotations

from typing import Any, ClassVar

from docutils import nodes
from public_studies import public_studies
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


class Studies(SphinxDirective):
    """`rockwobble-studies::` documents them, one after another."""

    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {}

    def run(self) -> list[nodes.Node]:
        """Return what autodoc makes of them."""
        lines = [
            line
            for function, made in public_studies().values()
            for line in (f".. autofunction:: {function}", f".. autoclass:: {made}", "")
        ]
        return self.parse_text_to_nodes("\n".join(lines), offset=self.content_offset)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("rockwobble-studies", Studies)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
