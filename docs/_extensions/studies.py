"""The reference of the studies at the top: the function of each and its results, from the registry."""

from __future__ import annotations

from typing import Any, ClassVar

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

import rockwobble
from rockwobble import compare
from rockwobble.reports.registry import COMMANDS

GROUP = "many"


def studies() -> dict[str, tuple[str, str]]:
    """Return the full names of function and class of each study of the group, by its name at the top."""
    found = {}
    for name, entry in COMMANDS.items():
        if entry.group == GROUP and name in rockwobble.__all__:
            made = entry.results_class()
            function = f"rockwobble.compare.{name}" if name in compare.__all__ else f"rockwobble.{name}"
            public = made.__name__ in compare.__all__
            module = "rockwobble.compare" if public else made.__module__
            found[name] = function, f"{module}.{made.__name__}"
    return found


class Studies(SphinxDirective):
    """`rockwobble-studies::` documents them, one after another."""

    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {}

    def run(self) -> list[nodes.Node]:
        """Return what autodoc makes of them."""
        lines = [
            line
            for function, made in studies().values()
            for line in (f".. autofunction:: {function}", f".. autoclass:: {made}", "")
        ]
        return self.parse_text_to_nodes("\n".join(lines), offset=self.content_offset)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("rockwobble-studies", Studies)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
