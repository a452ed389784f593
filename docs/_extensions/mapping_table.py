"""Tables of names, units and meanings, and of findings, from what the code itself uses."""

from __future__ import annotations

import importlib
import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from rockwobble.models.diagnostic import CODES
from rockwobble.models.finding import unit_of
from rockwobble.reports.pages.wording import words


def table(head: tuple[str, ...], widths: tuple[int, ...], rows: list[tuple[nodes.Node, ...]]) -> nodes.table:
    """Return a table with one row of titles."""
    group = nodes.tgroup("", *(nodes.colspec(colwidth=width) for width in widths), cols=len(head))
    titles = tuple(nodes.paragraph("", word) for word in head)
    for section, lines in ((nodes.thead(), [titles]), (nodes.tbody(), rows)):
        for cells in lines:
            section += nodes.row("", *(nodes.entry("", cell) for cell in cells))
        group += section
    return nodes.table("", group)


class MappingTable(SphinxDirective):
    """`mapping-table:: MODULE:NAME`, of a mapping from a name to its unit and meaning."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the table."""
        module, _, name = self.arguments[0].partition(":")
        mapping: dict[str, tuple[str, str]] = getattr(importlib.import_module(module), name)
        rows: list[tuple[nodes.Node, ...]] = [
            (
                nodes.paragraph("", "", nodes.literal(key, key)),
                nodes.paragraph("", unit),
                nodes.paragraph("", meaning.replace("`", "")),
            )
            for key, (unit, meaning) in mapping.items()
        ]
        return [table(("name", "unit", "meaning"), (30, 10, 60), rows)]


class FindingsTable(SphinxDirective):
    """`findings-table:: GROUP ...`, of the lines of the file of words whose keys are of these groups."""

    required_arguments = 1
    final_argument_whitespace = True

    def run(self) -> list[nodes.Node]:
        """Return the table."""
        rows: list[tuple[nodes.Node, ...]] = []
        for group in self.arguments[0].split():
            for name, line in words()[group].items():
                sentence = line if isinstance(line, str) else line[-1]
                values = dict.fromkeys(re.findall(r"\{(\w+)", sentence))
                key = f"{group}.{name}"
                units = {value: unit_of(value) for value in values}
                if group == "diagnostic":
                    units["size"] = CODES[name.partition(":")[0]]
                said = ", ".join(f"{value} [{units[value]}]".removesuffix(" []") for value in values)
                rows.append((nodes.paragraph("", "", nodes.literal(key, key)), nodes.paragraph("", said)))
                rows[-1] += (nodes.paragraph("", sentence),)
        return [table(("key", "values", "sentence"), (25, 25, 50), rows)]


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("mapping-table", MappingTable)
    app.add_directive("findings-table", FindingsTable)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
