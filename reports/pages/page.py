"""Report framework: one Markdown template for terminal, document and HTML page.

A template is given plain values and says the words. In it stand ``{{ picture("name") }}``,
``{{ table(rows, [["key", "heading [unit]", ".3g"], ...]) }}`` and ``{{ block("name") }}``, each alone in a
paragraph; numbers in sentences are ``{{ value | number(".3g") }}``, commands ``{{ command | code }}``. What
stands between ``{{ fold("Details") }}`` and ``{{ fold() }}`` is opened where a page is read, under a heading
in a document, and left out of a terminal unless details are asked for.
`output` is "terminal", "markdown" or "html" where one of the three is to say more or less, and
`shows("key")` whether a table above has room for a column that a legend is to explain.
"""

from __future__ import annotations

import html
import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Literal

from jinja2 import Environment, PackageLoader, StrictUndefined
from markdown_it import MarkdownIt
from rich.cells import cell_len
from rich.console import Console
from rich.markdown import Markdown
from rich.text import Text

from ..figures.interactive import charts, colour_bar
from ..figures.picture import Picture
from .cases import conditions, source_lines
from .command_line import command_lines
from .diagnostics import warnings
from .table import Row, Table, columns_of, number
from .wording import sentence

Output = Literal["terminal", "markdown", "html"]
_PLACE = re.compile(r"\n?@@(\d+)@@\n?")
# characters of a name that are markup in Markdown; an underscore only where a word begins or ends
_MARKUP = re.compile(r"([\\`*<])|(?<!\w)_|_(?!\w)")
# a command at the end of a line
_COMMAND = re.compile(r"^(.*\S) `([^`\n]* [^`\n]*)`$", re.MULTILINE)
_HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)
_LEAST_WIDTH = 80  # width for output that is not a terminal, such as a file


class MarkdownText(str):
    """Text in Markdown, not to be escaped."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Details:
    """Start of a foldable section under a title, or its end, without title."""

    title: str


Part = str | Picture | Table | MarkdownText | Details


@dataclass(frozen=True, slots=True, kw_only=True)
class Page:
    """One report.

    Attributes
    ----------
    name : str
        Name of its files.
    template : str or Path
        Name in the folder templates, without its ending; or a file elsewhere.
    values : mapping
        What the template is given: plain values.
    pictures : iterable of Picture
    alone : sequence of str, optional
        Pictures that stand beside the page as files, with their titles, by name. Default: all of them,
        without: the document has the titles.
    blocks : mapping of str to str
        HTML that only a page can show, such as motion in three dimensions.
    outputs : sequence of {"markdown", "html"}
        What is written.
    """

    name: str
    template: str | Path
    values: Mapping[str, object]
    pictures: Iterable[Picture] = ()
    alone: Sequence[str] | None = None
    blocks: Mapping[str, str] = field(default_factory=dict)
    outputs: Sequence[Output] = ("markdown", "html")

    def files(self, *, document: bool = True) -> dict[str, bytes]:
        """Files by name: NAME.html, and with `document` NAME.md and its SVG pictures."""
        titled, texts = self.alone is not None, {}
        if "markdown" in self.outputs and document:
            texts[f"{self.name}.md"] = self.markdown()
        if "html" in self.outputs:
            texts[f"{self.name}.html"] = self.html()
        if not document:
            return {name: text.encode() for name, text in texts.items()}
        from ..figures.svg import svg

        return {
            **{name: text.encode() for name, text in texts.items()},
            **{
                f"{picture.name}.svg": svg(_worded(picture), titled=titled)
                for picture in self.pictures
                if self.alone is None or picture.name in self.alone
            },
        }

    def exports(self, forms: Sequence[str], *, width: float | None = None) -> dict[str, bytes]:
        """Figures as "pdf" or "png", and tables as "tex", by file name.

        Figures are `width` wide [inch]. A table has the name of the page and of the heading above it.
        """
        entries: dict[str, bytes] = {}
        for form in dict.fromkeys(forms):
            if form == "tex":
                entries |= {f"{name}.tex": table.latex().encode() for name, table in self._named_tables()}
            else:
                from ..figures.svg import image

                entries |= {f"{each.name}.{form}": image(each, form, width=width) for each in self.pictures}
        return entries

    def _named_tables(self) -> Iterator[tuple[str, Table]]:
        heading, seen = "", Counter[str]()
        for part in self._parts("markdown"):
            if isinstance(part, Table):
                name = re.sub(r"[^a-z0-9]+", "-", f"{self.name} {heading}".lower()).strip("-")
                seen[name] += 1
                yield name + (f"-{seen[name]}" if seen[name] > 1 else ""), part
            elif titles := re.findall(r"^##+ (.*)$", str(part), re.MULTILINE):
                heading = titles[-1]

    def markdown(self) -> str:
        """The report as Markdown document."""

        def as_text(thing: Part) -> str:
            if isinstance(thing, Details):
                return thing.title and f"## {thing.title}"
            if isinstance(thing, Picture):
                caption = f"*{thing.title}.* {thing.caption}".strip()
                return f"![{thing.title}]({thing.name}.svg)\n\n{caption}"
            return thing.markdown() if isinstance(thing, Table) else ""

        parts = (part if isinstance(part, str) else as_text(part) for part in self._parts("markdown"))
        return "\n\n".join(filter(None, parts)) + "\n"

    def html(self) -> str:
        """The report as self-contained HTML page."""
        parts = self._parts("html")
        body = "\n".join(_html(part) for part in parts)
        title = re.search(r"<h1.*?>(.*?)</h1>", body)
        drawn = any(isinstance(part, Picture) for part in parts) or bool(self.blocks)
        return (
            _environment()
            .get_template("page/base.html.j2")
            .render(
                title=re.sub("<.*?>", "", title[1]) if title else self.name,
                body=body,
                drawn=drawn,
            )
        )

    def show(self, console: Console | None = None, *, details: bool = False) -> None:
        """Print the report in a terminal, folded sections only with `details`."""
        console = console or Console()
        if not console.is_terminal:
            console.width = max(console.width, _LEAST_WIDTH)
        before: str | Table = ""
        for part in _unfold(self._parts("terminal", console.width), details):
            if before and not (isinstance(before, str) and before.endswith(":")):
                console.print()
            if isinstance(part, Table):
                console.print(part.rich(console.width))
            else:
                _print_words(console, _HEADING.sub(r"**\1**", part))
            before = part

    def _parts(self, output: Output, width: int = 0) -> list[Part]:
        """Rendered template, split at pictures, tables, blocks and folds."""
        things: list[Part] = []
        keys: set[str] = set()
        pictures = {picture.name: _worded(picture) for picture in self.pictures}

        def place(thing: Part) -> MarkdownText:
            things.append(thing)
            return MarkdownText(f"@@{len(things) - 1}@@")

        def table(
            rows: Iterable[Row], columns: Sequence[Sequence[str]], group: str = "", **look: bool
        ) -> MarkdownText:
            made = Table(columns=columns_of(columns), rows=list(rows), group=group, **look)
            if not made.rows:
                return MarkdownText("")
            keys.update(column.key for column in (made.fitting_columns(width) if width else made.columns))
            return place(made)

        def block(name: str) -> MarkdownText | str:
            return place(MarkdownText(self.blocks[name])) if output == "html" and name in self.blocks else ""

        known = _environment()
        text = (
            known.from_string(self.template.read_text(encoding="utf-8"))
            if isinstance(self.template, Path)
            else known.get_template(f"{self.template}.md.j2")
        ).render(
            {
                **self.values,
                "output": output,
                "picture": lambda name: place(pictures[name]),
                "block": block,
                "table": table,
                "fold": lambda title="": place(Details(title)),
                "shows": keys.__contains__,
            }
        )
        text = re.sub(r"\n{3,}", "\n\n", text).strip()
        cut = _PLACE.split(text)
        return [
            things[int(part)] if index % 2 else part.strip()
            for index, part in enumerate(cut)
            if index % 2 or part.strip()
        ]


def _unfold(parts: Iterable[Part], details: bool) -> Iterator[str | Table]:
    """Yield the words and tables for a terminal; folded ones only with `details`."""
    folded = False
    for part in parts:
        if isinstance(part, Details):
            folded = bool(part.title) and not details
        elif not folded and isinstance(part, str | Table) and not isinstance(part, MarkdownText):
            yield part


def _print_words(console: Console, text: str) -> None:
    """Print Markdown; a command at the end of a line stays one for a shell."""
    words, *rest = _COMMAND.split(text)
    for lead, command, more in zip(rest[::3], rest[1::3], rest[2::3], strict=True):
        shown = _as_printed(console, f"{words}{lead}")
        room = console.width - cell_len(Text.from_ansi(shown).plain.rpartition("\n")[2])
        console.out(shown, end="", highlight=False)
        # overlong words run on, as a break would be copied
        whole = [f" {command}"] if len(command) < room else ["", *command_lines(command, console.width)]
        for line in whole:
            console.print(line, markup=False, highlight=False, soft_wrap=True)
        words = more.lstrip("\n")
    if words:
        console.out(_as_printed(console, words), highlight=False)


def _as_printed(console: Console, text: str) -> str:
    with console.capture() as shown:
        console.print(Markdown(text), highlight=False)
    # a list begins with an empty line, and ends in spaces
    return shown.get().strip("\n").rstrip()


def _worded(picture: Picture) -> Picture:
    words = picture.caption
    if isinstance(words, str):
        return picture
    return replace(picture, title=picture.title or sentence(words, short=True), caption=sentence(words))


def _html(part: Part) -> str:
    if isinstance(part, Details):
        summary = f'<details class="fold"><summary>{html.escape(part.title)}</summary>'
        return summary if part.title else "</details>"
    if isinstance(part, Picture):
        return figure_html(part)
    if isinstance(part, Table):
        return part.html()
    return str(part) if isinstance(part, MarkdownText) else to_html(part)


def figure_html(picture: Picture) -> str:
    """HTML element of a picture, with title and caption."""
    shown = _worded(picture)
    panels = "".join(
        f"<div>{f'<h4>{html.escape(title)}</h4>' if title else ''}{plot}</div>"
        for title, plot in charts(shown)
    )
    columns = f' class="panels" style="--columns: {shown.columns}"'
    several = columns if len(shown.panels) > 1 and not shown.link_x else ""
    words = f"<h3>{html.escape(shown.title)}</h3><p>{html.escape(str(shown.caption))}</p>"
    scale = colour_bar(shown.shades) if shown.shades else ""
    return f'<figure id="{html.escape(shown.name)}">{words}<div{several}>{panels}</div>{scale}</figure>'


def to_html(text: str) -> str:
    """HTML from Markdown; heading ids as on GitHub."""
    parser = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = parser.parse(text)
    for opening, content in pairwise(tokens):
        if opening.type == "heading_open":
            opening.attrSet("id", re.sub(r"[^\w\- ]", "", content.content.lower()).replace(" ", "-"))
    return str(parser.renderer.render(tokens, parser.options, {}))


def fragment(template: str, **values: object) -> str:
    """HTML piece of a page with escaped values."""
    return _templates(autoescape=True).get_template(template).render(**values)


def _templates(autoescape: bool | Callable[[str | None], bool]) -> Environment:
    made = Environment(
        loader=PackageLoader("rockwobble.reports.pages", "templates"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=autoescape,
    )
    filters = {"warnings": warnings, "conditions": conditions, "sources": source_lines}
    texts = {"number": number, "code": lambda text: MarkdownText(f"`{text}`"), "md": MarkdownText}
    made.filters |= filters | texts
    made.tests["known"] = math.isfinite
    return made


@cache
def _environment() -> Environment:
    made = _templates(autoescape=lambda name: str(name).endswith(".html.j2"))
    made.finalize = _escape
    return made


def _escape(value: object) -> object:
    """Text with Markdown characters escaped, unless it is Markdown."""
    if isinstance(value, str) and not isinstance(value, MarkdownText) and not hasattr(value, "__html__"):
        return _MARKUP.sub(lambda match: f"\\{match[0]}", value)
    return value
