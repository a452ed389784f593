"""Pages in Chromium at desktop and phone width: faults that a reader would meet.

A page must not ask for anything outside of itself, or of its `window.home` where it is one of a site: no name
of a host resolves here.
"""

from __future__ import annotations

import html
import itertools
import re
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from pathlib import Path

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
# [pixel]
WIDTHS = {"screen": 1280, "phone": 390}

needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")

# for the look that a page takes at itself, in the browser's own time, which runs ahead of ours [ms]
_PATIENCE = 2_500
# for all of it, on a machine that has other things to do [s]
_DEADLINE = 300
_LOOK = Path(__file__).with_name("browser.js").read_text()
# a hint on speed that the browser gives whoever reads a canvas: no error
_HINT = "willReadFrequently"
_OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-quic",
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--enable-logging=stderr",
    f"--window-size={sum(WIDTHS.values()) + 80},1000",
)

_OUTER = """<!doctype html><body>
<script>window.addEventListener("message", (event) => {
  const [name, ...lines] = event.data.split("\\n");
  document.body.dataset[name] = lines.join("\\n");
});</script>
"""
_FRAME = (
    '<iframe name="{name}{place}" src="page{place}.html" width="{width}" height="900" style="border:0">'
    "</iframe>"
)


def dumped(page: Path) -> str:
    """Elements of a page after its scripts, as HTML."""
    return _opened(page).stdout


def _opened(page: Path) -> subprocess.CompletedProcess[str]:
    command = [str(CHROMIUM), *_OPTIONS, f"--user-data-dir={page.parent / 'profile'}"]
    command += [f"--virtual-time-budget={_PATIENCE}", "--dump-dom", page.as_uri()]
    return subprocess.run(command, capture_output=True, text=True, timeout=_DEADLINE, check=True)


def complaints(
    page: str, folder: Path, *, figures: int, further: str = "", widths: Iterable[str] = tuple(WIDTHS)
) -> list[str]:
    """Faults of a page; empty if there are none.

    Parameters
    ----------
    page : str
        The HTML.
    folder : Path
        For the files of the browser.
    figures : int
        Interactive figures that must be drawn.
    further : str, optional
        Script that defines `lookFurther(found)`, which adds lines of its own to the array `found`.
    widths : iterable of str, optional
        Of `WIDTHS`, by name.
    """
    (wrong,) = complaints_of_all([page], folder, figures=figures, further=further, widths=widths).values()
    return wrong


def complaints_of_all(
    pages: Sequence[str],
    folder: Path,
    *,
    figures: int,
    further: str = "",
    widths: Iterable[str] = tuple(WIDTHS),
) -> dict[int, list[str]]:
    """Faults of several pages, by index; see `complaints`.

    What the browser itself complains of is among that of the last.
    """
    inside = f"<script>{further}\n{_LOOK}</script></body>"
    frames = []
    for place, page in enumerate(pages):
        (folder / f"page{place}.html").write_text(inside.join(page.rsplit("</body>", 1)))
        frames += [_FRAME.format(place=place, name=name, width=WIDTHS[name]) for name in widths]
    # a window narrower than 500 pixels is not to be had, a frame is
    (folder / "outer.html").write_text(_OUTER + "".join(frames))
    done = _opened(folder / "outer.html")
    wrong: dict[int, list[str]] = {place: [] for place in range(len(pages))}
    for place, name in itertools.product(wrong, widths):
        said = re.search(rf'data-{name}{place}="([^"]*)"', done.stdout)
        if said is None:
            wrong[place].append(f"{name}: the page did not come to its end")
            continue
        drawn, *lines = html.unescape(said.group(1)).splitlines()
        wrong[place] += [f"{name}: {line}" for line in lines]
        if int(drawn) != figures:
            wrong[place].append(f"{name}: {drawn} figures, expected {figures}")
    wrong[len(pages) - 1] += [
        line for line in done.stderr.splitlines() if "CONSOLE" in line and _HINT not in line
    ]
    return wrong
