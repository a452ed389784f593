"""The page of an advice in a browser, as wide as a phone. Runs where Chromium is installed."""

from __future__ import annotations

import html
import re
import shutil
import subprocess

import pytest

from rockwobble.compare.advice import advise
from rockwobble.models import Case, Cylinder, el_centro_1940
from rockwobble.reports.advise_page import advice_page

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FIGURES = 4
QUIET = ["--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-quic"]
LOOK = """<script>
window.addEventListener("load", () => setTimeout(() => {
  const plots = Array.from(document.querySelectorAll(".plotly-graph-div"));
  window.parent.postMessage([
    "drawn", plots.filter((plot) => plot.querySelector(".main-svg")).length,
    "too wide by", document.documentElement.scrollWidth - document.documentElement.clientWidth,
  ].join(" "), "*");
}, 1000));
</script></body>"""
OUTER = """<!doctype html><body><iframe src="page.html" width="390" style="border:0"></iframe>
<script>window.addEventListener("message", (event) => document.body.dataset.inner = event.data);</script>"""


@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")
def test_the_page_is_drawn_on_a_phone_without_error_and_without_horizontal_scrolling(tmp_path):
    case = Case("El Centro", Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940())
    page = advice_page(advise(case, count=20), "rockwobble advise")
    (tmp_path / "page.html").write_text(page.replace("</body>", LOOK))
    (tmp_path / "outer.html").write_text(OUTER)
    command = [str(CHROMIUM), "--headless", "--no-sandbox", "--no-first-run", *QUIET]
    command += ["--enable-logging=stderr", f"--user-data-dir={tmp_path / 'profile'}"]
    command += ["--virtual-time-budget=8000", "--dump-dom", (tmp_path / "outer.html").as_uri()]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    said = re.search(r'data-inner="([^"]*)"', done.stdout)
    assert said, done.stdout[-500:]
    assert html.unescape(said.group(1)) == f"drawn {FIGURES} too wide by 0"
    assert [line for line in done.stderr.splitlines() if "CONSOLE" in line] == []
