"""One template, three outputs: equal content, and no external resources."""

from __future__ import annotations

import io
import itertools
import math
import re
import shlex
from collections import Counter

import jinja2
import numpy as np
import pytest
from browser import complaints, needs_chromium
from rich.console import Console

from rockwobble.reports.figures.picture import TIME, Axis, Line, Panel, Picture
from rockwobble.reports.pages import page as framework
from rockwobble.reports.pages.page import Page, to_html
from rockwobble.reports.pages.table import Column, Table, interval_form, number

TEMPLATE = """
# Report of {{ name }}

**It took {{ wall_time | number("duration") }}.** See [the peaks](#largest-peaks).

{{ picture("tilt") }}

## Largest peaks

{{ table(rows, [["name", "run", "words"], ["peak", "peak [α]", ".2f"], ["verdict", "verdict", "tag"],
                ["note", "note", "words", "wide"]], group="case") }}

peak: the largest.{% if shows("note") %} note: by hand.{% endif %}

{% if output == "html" %}
{{ block("player") }}
{% endif %}

{{ "- only in a terminal" | md if output == "terminal" }}

Made by {{ "rockwobble compare --scale 2_3" | code }}.
"""
ROWS = [
    {"case": "a|b", "name": "mujoco *recess*", "peak": 0.5, "verdict": "fine", "note": "n" * 90},
    {"case": "a|b", "name": "pybullet", "peak": math.nan, "verdict": "not fine", "note": "n" * 90},
    {"case": "c", "name": "dart", "peak": math.inf, "verdict": "fine", "note": "n" * 90},
]


def test_an_interval_has_a_form_whatever_is_known():
    numbers = (math.nan, math.inf, -math.inf, 0.0, -2.5, 0.04, 130.0, None)
    for form, values in itertools.product((".3f", ".3g"), itertools.product(numbers, repeat=3)):
        assert re.fullmatch(r"\.\d+[fg]", interval_form(form, *values))


@pytest.fixture
def page(monkeypatch):
    made = framework._environment()
    loader = jinja2.ChoiceLoader([jinja2.DictLoader({"test.md.j2": TEMPLATE}), made.loader])
    monkeypatch.setattr(made, "loader", loader)
    time = np.linspace(0.0, 1.0, 50)
    line = Line(x=time, y=time**2, name="run")
    panel = Panel(x=TIME, y=Axis(label="tilt / α", unit="-"), layers=[line])
    picture = Picture(name="tilt", title="Tilt", caption="Of one run.", panels=[panel])
    values = {"name": "CHI_TCU *<b>*", "wall_time": 200.0, "rows": ROWS}
    return Page(
        name="report",
        template="test",
        values=values,
        pictures=[picture],
        blocks={"player": "<video></video>"},
    )


def shown(page: Page, width: int) -> str:
    console = Console(file=io.StringIO(), force_terminal=True, width=width, no_color=True)
    page.show(console)
    return re.sub(r"\x1b\[[\d;]*m", "", console.file.getvalue())


# parts of each output, one a line, and what it leaves out
SAYS = {
    "document": """![Tilt](tilt.svg)
*Tilt.* Of one run.
**It took 3.3 min.**
| a∣b | mujoco *recess* | 0.50 | fine |
| a∣b | pybullet | – | not fine |
note: by hand.
`rockwobble compare --scale 2_3`""",
    "page": """<title>rockwobble: Report of CHI_TCU *&lt;b&gt;*</title>
<h2 id="largest-peaks">
id="tilt-0"
<td class="tag">not fine</td>
note: by hand.
<video></video>
<code>rockwobble compare --scale 2_3</code>""",
    "wide": "Report of CHI_TCU *<b>*\nonly in a terminal\nnnn\nnote: by hand.",
    "narrow": "Report of CHI_TCU *<b>*\nonly in a terminal\npeak: the largest.",
}
LACKS = {
    "document": ["video", "\n\n\n", "only in a terminal"],
    "page": ["only in a terminal", 'src="http', 'href="http'],
    "wide": ["video"],
    "narrow": ["nnn", "note: by hand."],
}


@pytest.mark.parametrize("output", SAYS)
def test_each_output_of_a_page_has_its_content(page, output):
    files = page.files()
    assert set(files) == {"report.md", "report.html", "tilt.svg"}
    text = {
        "document": files["report.md"].decode(),
        "page": files["report.html"].decode(),
        "wide": shown(page, 160),
        "narrow": shown(page, 80),
    }[output]
    assert [part for part in SAYS[output].splitlines() if part not in text] == []
    assert [part for part in LACKS[output] if part in text] == []


def random_table(random: np.random.Generator) -> Table:
    """Table of random words and numbers under headings of random words."""

    def text() -> str:
        return " ".join("x" * length for length in random.integers(1, 15, random.integers(1, 5)))

    forms = random.choice([".3g", "words", "tag", "percent"], random.integers(1, 13))
    columns = [Column(str(i), text(), form, bool(random.random() < 0.4)) for i, form in enumerate(forms)]
    rows = [
        {"group": "one group", **{c.key: text() if c.text else random.lognormal(0.0, 9.0) for c in columns}}
        for _ in range(3)
    ]
    group = "group" if random.random() < 0.5 else ""
    return Table(columns=columns, rows=rows, group=group, compact=bool(random.random() < 0.5))


@pytest.mark.parametrize("seed", range(10))
def test_tables_in_a_terminal_break_no_word(seed: int) -> None:
    random = np.random.default_rng(seed)
    for _ in range(4):
        table, width = random_table(random), int(random.integers(40, 121))
        console = Console(width=width, file=io.StringIO())
        console.print(table.rich(width))
        printed = console.file.getvalue()  # type: ignore[attr-defined]
        shown = table.fitting_columns(width)
        cells = [number(row[column.key], column.form) for row in table.rows for column in shown]
        words = Counter(" ".join([*cells, *(column.heading for column in shown)]).split())
        assert words - Counter(printed.replace("─", " ").split()) == Counter()
        assert max(map(len, printed.splitlines())) <= width
        # wide columns are omitted first
        gone = [column for column in table.columns if column not in shown]
        assert all(column.wide for column in gone) or not any(column.wide for column in shown)
        assert bool(gone) == ("on the page" in printed)


def test_headings_are_linked_and_folds_open_separately():
    assert to_html("## Peak tilt, 3D").startswith('<h2 id="peak-tilt-3d">')
    table = Table(columns=[Column("name", "run", "words")], rows=ROWS, group="case", folded=True)
    assert table.html().count("<details><summary>") == 2


@pytest.mark.slow
@needs_chromium
def test_page_has_no_browser_complaints(page, tmp_path):
    assert complaints(page.html(), tmp_path, figures=1) == []


NUMBERS = {
    (1.5e-10, ".1e"): "1.5e-10",
    (3e5, ".1e"): "3.0e5",
    (12.0, "d"): "12",
    (-0.001, ".2f"): "0.00",
    (-0.01, ".2f"): "-0.01",
    (-1021.0, ",.0f"): "-1,021",
    (-math.inf, ".3g"): "-∞",
    (None, ".3g"): "–",
    (np.bool_(False), ".3g"): "no",
    (0.0, "percent"): "0 %",
    (0.0004, "percent"): "0.04 %",
    (-0.381, "percent"): "-38 %",
    (59.0, "duration"): "59 s",
    (90.0, "duration"): "1.5 min",
    ("falls", ".3g"): "falls",
}


def test_number_formats_give_the_expected_text():
    assert {given: number(*given) for given in NUMBERS} == NUMBERS


@pytest.mark.parametrize("width", [40, 80, 200])
@pytest.mark.parametrize(
    "columns", ["--scale 2", "--out '/a long/name of a folder.d' --engine none --friction 0.5"]
)
def test_commands_on_a_page_are_copyable_in_one_piece(columns, width):
    command = f"rockwobble advise --record-x 'E W.AT2' --diameter 1.6 --height 9 {columns}"
    page = Page(name="test", template="test", values={})
    text = (
        f"# Title\n\nNext:\n\n- An engine: `{command}`\n- Another: `{command}`\n- Words\n\nA `b/h` of `c d`."
    )
    screen = io.StringIO()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Page, "_parts", lambda *_: [text])
        page.show(Console(file=screen, width=width, force_terminal=True, color_system=None))
    printed = screen.getvalue()
    lines = printed.splitlines()
    begins = [place for place, line in enumerate(lines) if "rockwobble advise" in line]
    assert len(begins) == 2
    for place in begins:
        copied = [lines[place][lines[place].index("rockwobble") :]]
        while copied[-1].endswith("\\"):
            copied.append(lines[place + len(copied)])
        assert shlex.split("\n".join(copied).replace("\\\n", "")) == shlex.split(command)
        # one option alone may be longer than the line
        assert all(len(line) <= width or line.split()[0].startswith("--") for line in copied)
    assert "" not in [line.strip() for line in lines[begins[0] : begins[1]]]  # one list
    for words in ("Title", "An engine:", "Another:", "Words", "b/h", "c d"):
        assert words in printed
