"""Page of `explore`: files and refusals of the command, and the page in a browser."""

from __future__ import annotations

import json
import re
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from browser import complaints, needs_chromium
from showing import call as command_line

call = partial(command_line, "explore", "--no-open")

MOST = 400_000  # bytes with El Centro
PEER = "example\nof a record\nACCELERATION IN G\nNPTS= 5, DT= .01 SEC\n 0.0 0.1 0.3 -.2 0.0\n"

# worker inside the page: virtual browser time does not wait for others
WORKER = """
class Worker {
  constructor(address) {
    const asked = new XMLHttpRequest();
    asked.open("GET", address, false);
    asked.send();
    this.inside = new Function("postMessage", `let onmessage; ${asked.responseText}; return (data) => onmessage({ data });`);
    this.run = this.inside((data) => setTimeout(() => this.onmessage({ data })));
  }
  postMessage(data) {
    if (data.row === undefined) { this.run(data); return; }
    // a map in which all overturns, but for the run of the sliders
    setTimeout(() => this.onmessage({ data: { ...data, peaks: data.problems.map(() => Infinity) } }));
  }
}
"""  # noqa: E501
# moved, the page must say what it shows; its address, its command and its Python must have the state
MOVED = """
window.lookFurther = (found) => {
  const root = document.getElementById("explore"), part = (name) => root.querySelector(`[data-part="${name}"]`);
  const say = (words) => found.push(words);
  if (part("outcome").textContent !== "Stands") say(`at first it says ${part("outcome").textContent}`);
  if (!part("results").textContent.includes("0.243 α")) say(`peak: ${part("results").textContent}`);
  const slider = root.querySelector('[data-field="intensity"] input[type="range"]');
  // the cell of the map under the dot has the verdict of the run
  const dot = root.querySelector("#map circle"), palette = JSON.parse(root.querySelector("#map script").textContent).legend;
  dot.scrollIntoView({ block: "center" });
  const { left, top, width, height } = dot.getBoundingClientRect();
  const cell = document.elementsFromPoint(left + width / 2, top + height / 2).find((each) => each.matches("path.mark"));
  if (!cell || cell.getAttribute("fill") !== palette.find(({ name }) => name === "peak below α/4").colour) say("map and verdict differ");
  // a value out of range is marked, and nothing is computed with it
  const typed = (name, value) => {
    const input = document.getElementById(`of-${name}`);
    input.value = value;
    input.dispatchEvent(new Event("input"));
  };
  for (const [name, value, back] of [["stiffness", "900", "0"], ["height", "", "11.767"], ["height", "-5", "11.767"], ["intensity", "1000", "1"]]) {
    typed(name, value);
    const range = root.querySelector(`[data-field="${name}"] .range`);
    root.querySelector("details").open = true;
    if (!part("outcome").textContent.includes(range.textContent) || !range.offsetWidth || !part("command").closest("[inert]")) say(`${name} ${value}: ${part("outcome").textContent}`);
    typed(name, back);
    if (part("command").closest("[inert]")) say(`${name} ${back} is refused`);
  }
  for (const [name, value] of [["beside", "stronger"]]) { part(name).value = value; part(name).dispatchEvent(new Event("change")); }
  slider.value = 800;
  slider.dispatchEvent(new Event("input"));
  const { state, commandOf, pythonOf } = window.rockwobbleExplore;
  if (!commandOf(state).includes(`--scale ${state.intensity}`)) say(commandOf(state));
  if (!pythonOf(state).includes(`.scaled(${state.intensity})`)) say(pythonOf(state));
  if (innerWidth < 500) {  // on a phone the result stays above the slider that is moved
    root.querySelector("details").open = true;
    const last = root.querySelector('[data-field="stiffness"] input[type="range"]');
    last.scrollIntoView({ block: "center" });
    const { top, bottom } = root.querySelector(".result").getBoundingClientRect();
    if (top < -1 || bottom > last.getBoundingClientRect().top) say(`the result stands at ${top} px, over ${bottom}`);
  }
  for (const input of root.querySelectorAll("input, select, canvas, button")) {
    if (!(input.labels && input.labels.length) && !input.ariaLabel && !input.textContent.trim()) say(`no label: ${input.outerHTML}`);
  }
};
"""  # noqa: E501


# its words and controls are legible (WCAG 2.2, 1.4.3), and what it offers for download is whole
LEGIBLE = """
const beforeLegible = window.lookFurther;
window.lookFurther = (found) => {
  beforeLegible(found);
  const root = document.getElementById("explore"), say = (words) => found.push(words);
  const numbers = (colour) => (colour.match(/[\\d.]+/g) || []).map(Number);
  const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  const bright = ([r, g, b]) => 0.2126 * linear(r / 255) + 0.7152 * linear(g / 255) + 0.0722 * linear(b / 255);
  const ground = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const colour = numbers(getComputedStyle(at).backgroundColor);
      if (colour.length === 3 || colour[3] === 1) return colour;
    }
    return [255, 255, 255];
  };
  const speaks = (element) => element.matches("input:not([type=range]), select")
    || [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
  for (const element of root.querySelectorAll(":not(option, script, style, :disabled)")) {
    if (!element.offsetWidth || !speaks(element)) continue;
    const style = getComputedStyle(element);
    const [dark, light] = [numbers(style.color), ground(element)].map(bright).sort((a, b) => a - b);
    const ratio = (light + 0.05) / (dark + 0.05), least = parseFloat(style.fontSize) >= 24 ? 3 : 4.5;
    if (ratio < least) say(`contrast ${ratio.toFixed(2)}: ${element.outerHTML.slice(0, 90)}`);
  }
  const given = {}, made = URL.createObjectURL;
  HTMLAnchorElement.prototype.click = function () { given.name = this.download; };
  URL.createObjectURL = (content) => {
    Object.assign(given, { size: content.size, type: content.type });
    return made.call(URL, content);
  };
  const files = [["csv", "rockwobble-trace.csv", "text/csv"], ["svg", "rockwobble-tilt.svg", "image/svg+xml"]];
  for (const [part, name, type] of files) {
    root.querySelector(`[data-part="${part}"]`).click();
    if (given.name !== name || given.type !== type || given.size < 1000) say(`${name}: ${JSON.stringify(given)}`);
  }
};
"""  # noqa: E501


def given(page: Path) -> dict[str, Any]:
    """Input data of the page."""
    match = re.search(r'id="given">(.*?)</script>', page.read_text(encoding="utf-8"), re.DOTALL)
    assert match
    return json.loads(match[1])


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in ("EW.AT2", "NS.AT2"):
        (tmp_path / name).write_text(PEER)
    return tmp_path


# of a column with less friction than it needs the page knows no result
SLIPS = """
window.lookFurther = (found) => {
  const part = (name) => document.querySelector(`[data-part="${name}"]`), said = part("outcome");
  if (said.className !== "undecided" || !said.textContent.includes("it slips")) found.push(`${said.className}: ${said.textContent}`);
  if (part("results").textContent.includes("α")) found.push(part("results").textContent);
};
"""  # noqa: E501


@pytest.mark.slow
@needs_chromium
def test_page_gives_no_result_with_insufficient_friction(folder: Path) -> None:
    released = ["--release-tilt-deg", "5", "--support", "flat", "--overwrite"]
    wrong = {}
    for friction in (0.05, 1.4):
        assert call(*released, "--friction", f"{friction}") == 0
        page = (folder / "explore.html").read_text(encoding="utf-8")
        page = page.replace("<body>", f"<body><script>{WORKER}</script>")
        wrong[friction] = complaints(page, folder, figures=2, further=SLIPS, widths=["screen"])
    assert wrong[0.05] == []
    assert len(wrong[1.4]) == 2


@pytest.mark.slow
@needs_chromium
def test_explore_page_is_drawn_with_legible_words(folder: Path) -> None:
    assert call() == 0
    page = (folder / "explore.html").read_text(encoding="utf-8")
    assert len(page.encode()) <= MOST
    page = page.replace("<body>", f"<body><script>{WORKER}</script>")
    assert complaints(page, folder, figures=4, further=MOVED + LEGIBLE) == []


def test_sliders_start_at_the_given_options(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    size = ["--diameter", "0.5", "--height", "3", "--slab-mass-ratio", "1", "--rolling-resistance", "0.002"]
    record = ["--record-x", "EW.AT2", "--record-y", "NS.AT2", "--scale", "2"]
    assert call(*size, *record, "--support", "flat", "--out", "mine.html") == 0
    assert "mine.html: " in capsys.readouterr().out
    page_data = given(folder / "mine.html")
    state = {name: page_data["state"][name] for name in ("diameter", "height", "slab", "loss", "intensity")}
    assert state == pytest.approx(
        {"diameter": 0.5, "height": 3.0, "slab": 1.0, "loss": 2.0, "intensity": 2.0}
    )
    assert page_data["state"]["support"] == "flat"
    (stated,) = page_data["records"]
    assert stated["options"] == {"record-x": "EW.AT2", "record-y": "NS.AT2"}
    assert stated["python"] == "rw.read_record('EW.AT2', 'NS.AT2')"


def test_page_starts_with_the_given_release_and_plane(folder: Path) -> None:
    assert call("--release-tilt-deg", "4", "--rolling-rate", "0.3", "--duration", "7") == 0
    page_data = given(folder / "explore.html")
    assert (page_data["state"]["record"], page_data["state"]["rate"], page_data["free"]) == (-1, 0.3, 7.0)
    assert page_data["state"]["tilt"] == pytest.approx(4.0)
    assert call("--plane", "1", "--overwrite") == 0
    state = given(folder / "explore.html")["state"]
    assert (state["support"], state["plane"]) == ("planar", pytest.approx(57.2957795))


def test_page_written_with_other_options_is_not_overwritten(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call() == 0
    assert call() == 0  # repeated command
    assert call("--scale", "2") == 2
    assert "--overwrite" in capsys.readouterr().err
    assert call("--scale", "2", "--overwrite") == 0
