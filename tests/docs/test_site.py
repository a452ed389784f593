"""Built site: valid links, glossary links at first use, and page widths.

`python -m sphinx -W --keep-going -n docs docs/_build/html` builds it; ROCKWOBBLE_SITE may name another place.
"""

from __future__ import annotations

import html
import os
import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from browser import complaints_of_all, needs_chromium
from fontTools.ttLib import TTFont

BUILT = Path(os.environ.get("ROCKWOBBLE_SITE", Path(__file__).parents[2] / "docs" / "_build" / "html"))
TEACHING = ("guide/", "theory/", "notebooks/", "start.html", "index.html")
THEME = "[PST]"  # what the theme tells of itself is no complaint
# pages that one browser looks at together, in either width
TOGETHER = 8

pytestmark = [
    pytest.mark.skipif(not (BUILT / "index.html").exists(), reason=f"needs the site, built in {BUILT}"),
    pytest.mark.checkout,
]

_SILENT = {"a", "code", "pre", "math", "script", "style", "nav", "title", "dt"} | {
    f"h{i}" for i in range(1, 7)
}
_VOID = {"area", "br", "col", "hr", "img", "input", "link", "meta", "source", "wbr"}


class Page(HTMLParser):
    """Links, anchors, and the text of the article in its order."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.anchors: set[str] = set()
        self.said: list[tuple[str, bool]] = []  # texts, and whether they link to the glossary
        self.terms: list[str] = []  # terms defined by the page
        self._open: list[tuple[str, str]] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.anchors |= {str(given[name]) for name in ("id", "name") if given.get(name)}
        self.links += [str(given[name]) for name in ("href", "src") if given.get(name)]
        if tag not in _VOID:
            self._open.append((tag, given.get("class") or ""))

    def handle_endtag(self, tag: str) -> None:
        while self._open and self._open.pop()[0] != tag:
            pass

    def handle_data(self, data: str) -> None:
        if not any("bd-article" in kind for _, kind in self._open):
            return
        if self._open[-1][0] == "dt":
            self.terms.append(data.strip().lower())
        if self._open[-1][0] == "a" and "first-use" in self._open[-1][1]:
            self.said.append((data, True))
        elif not any(tag in _SILENT or "cell_output" in kind for tag, kind in self._open):
            self.said.append((data, False))


def names() -> list[str]:
    pages = [path.relative_to(BUILT).as_posix() for path in sorted(BUILT.rglob("*.html"))]
    return [name for name in pages if not name.startswith("_")]  # without pages of the theme


@pytest.fixture(scope="module")
def pages() -> dict[str, Page]:
    return {name: Page(BUILT / name) for name in names()}


def test_every_link_inside_resolves_and_outside_are_pages(pages: dict[str, Page]) -> None:
    assert len(pages) > 30
    broken = []
    for name, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            place = (BUILT / name).parent / unquote(parts.path) if parts.path else BUILT / name
            target = place.resolve()
            if not target.exists():
                broken.append(f"{name}: {link}")
            elif parts.fragment and target.suffix == ".html":
                known = pages[target.relative_to(BUILT.resolve()).as_posix()].anchors
                if unquote(parts.fragment) not in known:
                    broken.append(f"{name}: {link}")
    assert broken == []
    schemes = {(name, urlsplit(link).scheme) for name, page in pages.items() for link in page.links}
    # a page in the sense of a browser: the address of a scheduler in a text is none
    assert {each for each in schemes if each[1] not in ("", "https", "data")} == set()


def test_formula_font_has_every_character_used() -> None:
    known = set(TTFont(BUILT / "_static" / "math.woff").getBestCmap())
    lacking = set()
    for name in names():
        for formula in re.findall(r"<math.*?</math>", (BUILT / name).read_text(encoding="utf-8"), re.DOTALL):
            letters = set(html.unescape(re.sub(r"<[^>]*>", "", formula)))
            lacking |= {
                f"{name}: {each}" for each in letters if not each.isspace() and ord(each) not in known
            }
            assert 'mathvariant="bold' not in formula  # not drawn by browsers
    assert lacking == set()


def test_first_use_of_each_term_links_to_the_glossary(pages: dict[str, Page]) -> None:
    terms = set(pages["glossary.html"].terms) - {"pass", "guide", "record"}  # words with other senses, too
    assert len(terms) > 25
    loose = []
    for name, page in pages.items():
        linked: set[str] = set()
        for text, is_link in page.said if name.startswith(TEACHING) else []:
            words = " ".join(text.lower().split())
            here = {
                term for term in terms if re.search(rf"(?<![\w-]){re.escape(term)}(?:e?s)?(?![\w-])", words)
            }
            # "ideal recess" is not also a use of "recess"
            whole = {term for term in here if not any(term in other for other in here - {term})}
            if not is_link:
                loose += [f"{name}: {term}" for term in sorted(whole - linked)]
            linked |= here
    assert loose == []


@needs_chromium
def test_every_page_is_drawn_quiet_and_no_wider_than_the_window(tmp_path: Path) -> None:
    # what `rockwobble explore` writes is looked at in its own test, by a worker that the browser waits for
    wrong, waiting = [], [name for name in names() if name != "explore.html"]
    while waiting:
        together, waiting = waiting[:TOGETHER], waiting[TOGETHER:]
        sources = []
        for name in together:
            base = f'<head><base href="{(BUILT / name).resolve().as_uri()}">'
            sources.append((BUILT / name).read_text(encoding="utf-8").replace("<head>", base, 1))
        home = f'window.home = "{BUILT.resolve().as_uri()}/";'
        complaints = complaints_of_all(sources, tmp_path, figures=0, further=home)
        wrong += [f"{together[place]}: {line}" for place, lines in complaints.items() for line in lines]
    wrong = [line for line in wrong if THEME not in line]
    assert wrong == []


def test_cells_of_a_stacked_table_carry_their_headings() -> None:
    for page in ("guide/advice.html", "guide/limits.html", "guide/frames.html", "theory/tendon.html"):
        text = (BUILT / page).read_text(encoding="utf-8")
        for table in re.findall(r'<table[^>]*class="[^"]*stacked.*?</table>', text, flags=re.DOTALL):
            heads = [re.sub("<[^>]*>", "", each) for each in re.findall(r"<th.*?</th>", table, re.DOTALL)]
            heads = [html.unescape(" ".join(each.split())) for each in heads]
            for row in re.findall(r"<tr.*?</tr>", table, flags=re.DOTALL)[1:]:
                labels = re.findall(r'<span class="[^"]*head-of-cell[^"]*">(.*?)</span>', row)
                assert [html.unescape(each).strip() for each in labels] == [f"{head}:" for head in heads[1:]]
