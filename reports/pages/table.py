"""Tables and number formats of a page, for all outputs."""

from __future__ import annotations

import html
import math
import re
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from itertools import groupby
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Group
    from rich.table import Table as RichTable

Row = Mapping[str, object]
NONE = "–"


def number(value: object, form: str = ".3g") -> str:
    """Value in words: a Python format, or "percent", "duration", "words" or "tag" (unchanged).

    After "most " a format of so many digits (".3g", ".2f", "percent") rounds up, after "least " down: a bound
    that is stated holds. What is not known, NaN and None, is a dash.

    Examples
    --------
    >>> number(0.12345), number(1e-7), number(float("nan")), number(True)
    ('0.123', '1e-7', '–', 'yes')
    >>> number(0.0312, "percent"), number(5400.0, "duration")
    ('3.1 %', '1.5 h')
    >>> number(0.2022, ".2g"), number(0.2022, "most .2g"), number(0.0494, "most percent")
    ('0.2', '0.21', '5 %')
    """
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return NONE
    if isinstance(value, str) or form in ("words", "tag"):
        return str(value)
    if isinstance(value, bool) or type(value).__name__ == "bool":  # numpy's too
        return "yes" if value else "no"
    numeric = float(value)  # type: ignore[arg-type]
    if math.isinf(numeric):
        return "∞" if numeric > 0.0 else "-∞"
    bound, _, plain = form.rpartition(" ")
    if bound:
        numeric, form = _round(numeric, plain, _BOUNDS[bound]), plain
    if form in _FORMS:
        return _FORMS[form](numeric)
    if form.endswith("d"):
        return format(int(numeric), form)
    return _short(format(numeric, form))


def scattered(scatter: float, most: int = 4) -> str:
    """Format of a number with relative scatter: last digit no finer than a tenth of the scatter.

    Examples
    --------
    >>> [number(0.24303, scattered(scatter)) for scatter in (0.6, 0.03, 1e-3, float("nan"))]
    ['0.24', '0.243', '0.243', '0.243']
    """
    if not scatter > 0.0:  # unknown or zero scatter
        return f".{most}g"
    return f".{min(max(1 + math.ceil(-math.log10(scatter)), 2), most)}g"


def interval_form(form: str, *numbers: object) -> str:
    """Format of a number and its interval ends: two digits of the half width, or of the number.

    Examples
    --------
    >>> interval_form(".3f", 0.529, 0.43, 0.709), interval_form(".3g", 10.42, 9.1, 12.3)
    ('.2f', '.3g')
    >>> interval_form(".3f", 0.252, 0.246, 0.27), interval_form(".3f", 2.6, 1.3, math.inf)
    ('.3f', '.1f')
    """
    value, low, high = (each if isinstance(each, float) else math.nan for each in numbers)
    half = min(0.5 * (high - low) if math.isfinite(high) else value - low, abs(value))
    if not re.fullmatch(r"\.\d[fg]", form) or not 0.0 < half < math.inf or not math.isfinite(value):
        return form
    places, shown = 1 - math.floor(math.log10(half)), int(form[1:-1])
    if form.endswith("f"):
        return f".{min(max(places, 0), shown)}f"
    # two digits of a hundred would take a power of ten
    whole = shown if 100.0 <= max(abs(low), abs(high)) < math.inf else 0
    return f".{max(min(places + 1 + math.floor(math.log10(abs(value))), shown), whole)}g"


def span(values: Sequence[float], form: str = ".3g") -> str:
    """Range of some numbers as text; one number if all are equal."""
    return " to ".join(dict.fromkeys(number(each, form) for each in (min(values), max(values))))


def enumeration(words: Sequence[str]) -> str:
    """Return words with commas and, before the last, "and"."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


# rounding of upper and of lower bounds
_BOUNDS: Mapping[str, str] = {"most": ROUND_CEILING, "least": ROUND_FLOOR}
_EXACT = 12  # digits beyond are binary rounding


def _round(value: float, form: str, rounding: str) -> float:
    """Number rounded to one side, to the digits of a format."""
    exact = Decimal(f"{value:.{_EXACT}g}")
    if form == "percent":
        whole = abs(exact) >= Decimal("0.1")  # as `_percent` shows it
        last = -2 if whole else exact.adjusted() - 1
    elif form.endswith("g"):
        last = exact.adjusted() - int(form[1:-1]) + 1
    else:
        last = -int(form[1:-1])
    return float(exact.quantize(Decimal(1).scaleb(last), rounding)) if exact else 0.0


def _percent(share: float) -> str:
    value = 100.0 * share
    return f"{value:.0f} %" if abs(value) >= 10.0 else f"{_short(format(value, '.2g'))} %"


def _short(text: str) -> str:
    """Number without computer notation: 1e-7 for 1e-07 and 0.00 for -0.00."""
    text = re.sub(r"^-(?=0[0.]*(e|$))", "", text)
    return re.sub(r"e([+-])0*(\d)", lambda m: f"e{m[1].replace('+', '')}{m[2]}", text)


def _duration(seconds: float) -> str:
    for unit, length in (("h", 3600.0), ("min", 60.0)):
        if seconds >= 1.5 * length or (unit == "h" and seconds >= length):
            return f"{seconds / length:.2g} {unit}"
    return f"{seconds:.0f} s" if seconds >= 10.0 else f"{seconds:.2g} s"


_FORMS: Mapping[str, Callable[[float], str]] = {"percent": _percent, "duration": _duration}


# commands of LaTeX, and letters that its text fonts lack
_LATEX = {
    "\\": r"\textbackslash{}",
    **{each: f"\\{each}" for each in "&%$#_{}"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "–": "--",
    "\u00a0": "~",
    "°": r"$^\circ$",
    "−": "$-$",
    "×": r"$\times$",
    "·": r"$\cdot$",
    "±": r"$\pm$",
    "∞": r"$\infty$",
    "√": r"$\surd$",
    "≤": r"$\le$",
    "≥": r"$\ge$",
    "′": r"$'$",
    "∣": "$|$",
    "²": "$^2$",
    "³": "$^3$",
    "µ": r"$\mu$",
    "φ": r"$\varphi$",
}
_GREEK = "GREEK SMALL LETTER "


def latex_text(text: str) -> str:
    r"""Text with every special LaTeX character escaped.

    Examples
    --------
    >>> print(latex_text("peak_tilt [α], 5 %"))
    peak\_tilt [$\alpha$], 5 \%
    """

    def shown(letter: str) -> str:
        name = unicodedata.name(letter, "")
        greek = rf"$\{name.removeprefix(_GREEK).lower()}$" if name.startswith(_GREEK) else letter
        return _LATEX.get(letter, greek)

    return "".join(map(shown, text))


@dataclass(frozen=True, slots=True)
class Column:
    """Table column: key of its values, heading with unit, and format.

    One that is `wide` is left out where a terminal has no room for it.
    """

    key: str
    heading: str
    form: str = ".3g"
    wide: bool = False

    @property
    def text(self) -> bool:
        """Whether the column holds words, aligned left."""
        return self.form in ("words", "tag")

    def form_in(self, row: Row) -> str:
        """Format in a row with an optional interval NAME_low and NAME_high."""
        name = re.sub("_(low|high)$", "", self.key)
        return interval_form(self.form, *(row.get(f"{name}{end}") for end in ("", "_low", "_high")))


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Rows under columns; with `group`, rows are grouped by that value.

    Attributes
    ----------
    columns : sequence of Column
    rows : sequence of mapping
    group : str
        Name in a row; empty: none.
    folded : bool
        Whether a page shows each group only when it is opened.
    compact : bool
        Whether a terminal has no rule under the headings.
    """

    columns: Sequence[Column]
    rows: Sequence[Row]
    group: str = ""
    folded: bool = False
    compact: bool = False

    def groups(self) -> list[tuple[str, list[list[str]]]]:
        """Cells of the rows, by group."""
        grouped = groupby(self.rows, key=lambda row: str(row[self.group]) if self.group else "")
        return [(name, [self.cells(row) for row in rows]) for name, rows in grouped]

    def cells(self, row: Row) -> list[str]:
        """Cells of one row: interval width sets the digits of a number."""
        return [number(row.get(column.key), column.form_in(row)) for column in self.columns]

    def markdown(self) -> str:
        """Table in Markdown; groups become a first column, or separate tables."""
        if self.folded:
            tables = (f"**{name}**\n\n{self._markdown([], rows)}" for name, rows in self.groups())
            return "\n\n".join(tables)
        first = [(self.group.replace("_", " "), "---")] if self.group else []
        lines = [[*([name] if self.group else []), *cells] for name, rows in self.groups() for cells in rows]
        return self._markdown(first, lines)

    def _markdown(self, first: Sequence[tuple[str, str]], lines: Sequence[Sequence[str]]) -> str:
        heads = [*first, *((c.heading, "---" if c.text else "---:") for c in self.columns)]
        whole = [[head for head, _ in heads], [rule for _, rule in heads], *lines]
        # a vertical bar would end a cell
        return "\n".join(f"| {' | '.join(cell.replace('|', '∣') for cell in line)} |" for line in whole)

    def latex(self) -> str:
        """LaTeX tabular with units in its headings; groups become a first column."""
        lead = [self.group.replace("_", " ")] if self.group else []
        heads = [*lead, *(column.heading for column in self.columns)]
        lines = [[*([name] if self.group else []), *cells] for name, rows in self.groups() for cells in rows]
        places = "l" * len(lead) + "".join("l" if column.text else "r" for column in self.columns)
        head, *body = (" & ".join(map(latex_text, line)) + r" \\" for line in (heads, *lines))
        return "\n".join(
            [
                rf"\begin{{tabular}}{{{places}}}",
                r"\hline",
                head,
                r"\hline",
                *body,
                r"\hline",
                r"\end{tabular}",
                "",
            ]
        )

    def html(self) -> str:
        """HTML table, scrollable if wider than the screen."""
        heads = "".join(f'<th scope="col"{_class(c)}>{html.escape(c.heading)}</th>' for c in self.columns)
        parts = []
        for name, rows in self.groups():
            body = "".join(self._html_row(cells) for cells in rows)
            if self.folded:
                box = self._scroll_box(heads, body)
                parts.append(f"<details><summary>{html.escape(name)}</summary>{box}</details>")
            else:
                span = f'<tr class="group"><th colspan="{len(self.columns)}">{html.escape(name)}</th></tr>'
                parts.append(f"<tbody>{span if name else ''}{body}</tbody>")
        return "\n".join(parts) if self.folded else self._scroll_box(heads, "".join(parts))

    def _scroll_box(self, heads: str, body: str) -> str:
        # only words may break on a phone
        words = ' class="words"' if all(column.text for column in self.columns) else ""
        table = f"<table{words}><thead><tr>{heads}</tr></thead>{body}</table>"
        return f'<div class="scroll" tabindex="0">{table}</div>'

    def _html_row(self, cells: Sequence[str]) -> str:
        tags = []
        for place, (column, cell) in enumerate(zip(self.columns, cells, strict=True)):
            mark = ' class="tag"' if column.form == "tag" else _class(column)
            kind, scope = ("th", ' scope="row"') if place == 0 else ("td", "")
            tags.append(f"<{kind}{scope}{mark}>{html.escape(cell)}</{kind}>")
        return f"<tr>{''.join(tags)}</tr>"

    def fitting_columns(self, width: int) -> Sequence[Column]:
        """Columns that fit a terminal width.

        The last wide ones go first, where a cell would take two lines; then the last, where a word would be
        broken. The first stays.
        """
        columns = list(self.columns)
        while any(column.wide for column in columns) and self._width(columns) > width:
            columns.remove(next(column for column in reversed(columns) if column.wide))
        while len(columns) > 1 and self._width(columns, wrapped=True) > width:
            columns.pop()
        return columns

    def rich(self, width: int) -> Group:
        """Table for a terminal width, without broken words."""
        from rich.console import Group
        from rich.text import Text

        columns = self.fitting_columns(width)
        stacked = self._width(columns, stacked=False) > width
        widths = self._widths(columns, width, stacked=stacked)
        parts: list[RichTable | Text] = [self._rich(columns, widths, stacked=stacked)]
        for name, rows in self.groups():
            if name:
                parts.append(Text(name, style="bold"))
            parts.append(self._rich(columns, widths, rows))
        if gone := len(self.columns) - len(columns):
            parts.append(Text(f"columns on the page: {gone} more", style="dim"))
        return Group(*parts)

    def _width(self, columns: Sequence[Column], **look: bool) -> int:
        return sum(self._lengths(columns, **look)) + len(columns) - 1

    def _lengths(
        self, columns: Sequence[Column], *, stacked: bool = True, wrapped: bool = False
    ) -> list[int]:
        """Length of the longest line in each column.

        The words of a heading `stacked` one above the other, or only its unit below it; words `wrapped` where
        that is needed.
        """
        from rich.cells import cell_len

        def length(column: Column) -> int:
            cells = [number(row.get(column.key), column.form_in(row)) for row in self.rows]
            if wrapped and column.text:
                cells = [word for cell in cells for word in cell.split(" ")]
            heading = column.heading.split(" " if stacked else " [")
            units = [f"[{part}" for part in heading[1:]] if not stacked else heading[1:]
            return max(map(cell_len, [heading[0], *units, *cells]))

        return [length(column) for column in columns]

    def _widths(self, columns: Sequence[Column], width: int, *, stacked: bool) -> list[int]:
        """Column widths: as needed, if the total fits."""
        most = self._lengths(columns, stacked=stacked)
        widths = self._lengths(columns, stacked=stacked, wrapped=True)
        spare = width - sum(widths) - len(columns) + 1
        while spare > 0 and widths != most:
            for place, needed in enumerate(most):
                more = widths[place] < needed and spare > 0
                widths[place], spare = widths[place] + more, spare - more
        return widths

    def _rich(
        self,
        columns: Sequence[Column],
        widths: Sequence[int],
        rows: Sequence[Sequence[str]] | None = None,
        *,
        stacked: bool = False,
    ) -> RichTable:
        """Rows or heading for rich; `stacked`: one word per line."""
        from rich import box
        from rich.table import Table as RichTable
        from rich.text import Text

        look: dict[str, Any] = (
            {"box": None, "padding": (0, 1, 0, 0)} if self.compact else {"box": box.SIMPLE_HEAD, "padding": 0}
        )
        table = RichTable(**look, pad_edge=False, show_edge=False, show_header=rows is None)
        for column, width in zip(columns, widths, strict=True):
            # as a text, because brackets are markup; the unit in a line of its own
            heading = Text(column.heading.replace(" " if stacked else " [", "\n" if stacked else "\n["))
            table.add_column(
                heading, justify="left" if column.text else "right", overflow="fold", width=width
            )
        kept = [self.columns.index(column) for column in columns]
        for cells in rows or ():
            table.add_row(*(Text(cells[place]) for place in kept))
        return table


def columns_of(given: Iterable[Sequence[str]]) -> list[Column]:
    """Columns from template lists: key, heading, and optionally format and "wide"."""
    return [
        Column(key, heading, rest[0] if rest else ".3g", "wide" in rest[1:]) for key, heading, *rest in given
    ]


def _class(column: Column) -> str:
    return ' class="words"' if column.text else ""
