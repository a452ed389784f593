"""The help of commands as a page: what `rockwobble COMMAND --help` says, from the same source."""

from __future__ import annotations

import inspect
from typing import Any, ClassVar

import typer
from docutils import nodes
from mapping_table import table
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from rockwobble.reports.cli.main import app as command_line
from rockwobble.reports.registry import COMMANDS, HEADINGS

GENERAL = "Options"


class CommandHelp(SphinxDirective):
    """`rockwobble-command:: NAME` gives what it does with an example, and its options in a table a group."""

    required_arguments = 1
    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {}

    def run(self) -> list[nodes.Node]:
        """Return the paragraphs and tables."""
        name = self.arguments[0]
        if name not in COMMANDS:
            raise self.error(f"there is no command {name!r}; there are {', '.join(sorted(COMMANDS))}")
        return _help(name)


class GroupHelp(SphinxDirective):
    """`rockwobble-commands:: GROUP ...` gives a section for each command of groups of the registry."""

    required_arguments = 1
    final_argument_whitespace = True
    has_content = False
    option_spec: ClassVar[dict[str, Any]] = {}

    def run(self) -> list[nodes.Node]:
        """Return the sections."""
        groups = self.arguments[0].split()
        if unknown := [group for group in groups if group not in HEADINGS]:
            raise self.error(f"there is no group {unknown[0]!r}; there are {', '.join(HEADINGS)}")
        found: list[nodes.Node] = []
        for name, entry in COMMANDS.items():
            if entry.group in groups:
                section = nodes.section("", nodes.title(name, name), *_help(name), names=[name])
                self.state.document.note_implicit_target(section, section)
                found.append(section)
        return found


def _help(name: str) -> list[nodes.Node]:
    """Return the paragraphs and tables of a command."""
    commands: dict[str, Any] = typer.main.get_command(command_line).commands  # type: ignore[attr-defined]
    command = commands[name]
    paragraphs = inspect.cleandoc(command.help or "").split("\n\n")
    found: list[nodes.Node] = [
        nodes.literal_block(words, words, language="sh")
        if words.startswith("rockwobble ")
        else _paragraph(words)
        for words in map(str.strip, paragraphs)
    ]
    groups: dict[str, list[Any]] = {}
    for parameter in command.params:
        if not getattr(parameter, "hidden", False) and parameter.name != "help":
            group = getattr(parameter, "rich_help_panel", None) or GENERAL
            groups.setdefault(group, []).append(parameter)
    for group, parameters in groups.items():
        rows = [_row(each) for each in parameters]
        head, widths = ("option", "default", "meaning"), (30, 15, 55)
        if not any(default.astext() for _, default, _ in rows):  # an empty column takes a phone's width
            rows = [(option, meaning) for option, _, meaning in rows]
            head, widths = ("option", "meaning"), (30, 70)
        found += [nodes.rubric("", group), table(head, widths, rows)]
    return found


def _paragraph(words: str) -> nodes.paragraph:
    return nodes.paragraph("", " ".join(words.split()))


def _row(parameter: Any) -> tuple[nodes.Node, nodes.Node, nodes.Node]:
    argument = parameter.param_type_name == "argument"
    names = [parameter.name.upper()] if argument else [*parameter.opts, *parameter.secondary_opts]
    option = nodes.paragraph()
    for index, name in enumerate(names):
        option += [nodes.Text(", ")] * bool(index) + [nodes.literal(name, name)]
    default = parameter.default() if callable(parameter.default) else parameter.default
    nothing = default is None or default is False or default in ((), [], "")
    shown = nodes.paragraph() if nothing else nodes.paragraph("", "", nodes.literal("", str(default)))
    return option, shown, _paragraph(parameter.help or "")


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("rockwobble-command", CommandHelp)
    app.add_directive("rockwobble-commands", GroupHelp)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
