"""The page in a browser: drawn, quiet and no wider than the window. Runs where Chromium is installed."""

from __future__ import annotations

import html
import re
import shutil
import subprocess

import pytest

from rockwobble.reports.page import comparison_page

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FIGURES = 13

# hints on speed that the browser gives plotly for a scene without a graphics card: no errors
_HINTS = ("willReadFrequently", "GPU stall due to ReadPixels")

# said by the page itself once it is drawn; an inner page may tell its outer one
_LOOK = """
<script>
window.addEventListener("load", () => setTimeout(() => {
  const plots = Array.from(document.querySelectorAll(".plotly-graph-div"));
  const found = [
    "drawn", plots.filter((plot) => plot.querySelector(".main-svg")).length,
    "cut off", plots.filter(
      (plot) => plot.querySelector(".main-svg").getBoundingClientRect().right >
        plot.parentElement.getBoundingClientRect().right + 1).length,
    "players drawn", Array.from(document.querySelectorAll(".player")).filter((player) => {
      const [clock, slider] = ["clock", "time"].map((part) => player.querySelector(`[data-part="${part}"]`));
      slider.value = 1.5;
      slider.dispatchEvent(new Event("input"));
      return player.querySelector("canvas") && clock.textContent.startsWith("1.50 s of");
    }).length,
    "too wide by", document.documentElement.scrollWidth - document.documentElement.clientWidth,
  ].join(" ");
  document.body.dataset.found = found;
  window.parent.postMessage(found, "*");
}, 1500));
</script>
"""
_OUTER = """<!doctype html><body><iframe src="page.html" width="{width}" style="border:0"></iframe>
<script>window.addEventListener("message", (event) => document.body.dataset.inner = event.data);</script>"""


@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")
@pytest.mark.parametrize("width", [1280, 390])
def test_page_is_drawn_without_error_and_without_horizontal_scrolling(comparison, tmp_path, width):
    page = comparison_page(comparison).replace("</body>", f"{_LOOK}</body>")
    (tmp_path / "page.html").write_text(page)
    # a window narrower than 500 pixels is not to be had, a frame is
    (tmp_path / "outer.html").write_text(_OUTER.format(width=width))
    command = [
        str(CHROMIUM),
        "--headless",
        "--no-sandbox",
        # the scene in three dimensions is drawn without a graphics card
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--disable-quic",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--enable-logging=stderr",
        f"--user-data-dir={tmp_path / 'profile'}",
        "--window-size=1400,1000",
        "--virtual-time-budget=15000",
        "--dump-dom",
        (tmp_path / "outer.html").as_uri(),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    said = re.search(r'data-inner="([^"]*)"', done.stdout)
    assert said, done.stdout[-500:]
    assert html.unescape(said.group(1)) == f"drawn {FIGURES} cut off 0 players drawn 1 too wide by 0"
    complaints = [
        line
        for line in done.stderr.splitlines()
        if "CONSOLE" in line and not any(hint in line for hint in _HINTS)
    ]
    assert complaints == []
