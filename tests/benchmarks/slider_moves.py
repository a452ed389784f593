"""How soon the page of `rockwobble explore` shows what a slider does, under El Centro.

Chromium, driven over its DevTools pipe, moves sliders away and back again. Of each move: the time from the
input event until the trace is painted, and its parts. The processor times of the threads, such as the worker
that solves, hardly depend on what else the machine does. ``python tests/benchmarks slider_moves`` prints the
table.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import random
import select
import shutil
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rockwobble.models import Cylinder
from rockwobble.reports.pages.explore import State, explore_page, standard_shakings

from .console import options_of

MOVES = 50
PARTS = ("total", "solver", "transfer", "wait for a frame", "drawing", "painting")
SLIDERS = ("height", "diameter", "intensity", "prestress", "stiffness", "slab", "loss")
SHIFT = (5, 60)  # of the 1000 steps of a slider
PAUSE = 0.2  # between two moves [s]: the map beside begins after half a second of rest
PATIENCE = 60.0  # for an answer of the browser [s]

# Stands before the scripts of the page; a move is painted when a message comes after the frame that drew it.
_WATCH = """
let move = null;
const Real = window.Worker, frame = window.requestAnimationFrame.bind(window);
let solver = null;  // the first worker; what is compared and the map have others
window.Worker = class extends Real {
  constructor(...given) {
    super(...given);
    solver ??= this;
  }
  postMessage(data, ...more) {
    if (data.problem) this.posted = performance.now();
    super.postMessage(data, ...more);
  }
  set onmessage(answer) {
    super.onmessage = (event) => {
      const { run, took } = event.data, { posted } = this;
      // not what was asked before the move, nor what comes after its frame
      const counts = this === solver && move && run && !move.began && posted >= move.input;
      if (counts) Object.assign(move, { posted, arrived: performance.now(), solver: took });
      answer(event);
    };
  }
};
window.requestAnimationFrame = (draw) => frame((stamp) => {
  if (move && move.arrived) move.began ??= performance.now();
  draw(stamp);
});
const drawn = () => {
  const done = move, channel = new MessageChannel();
  if (!done || !done.began) return;
  move = null;
  done.drawn = performance.now();
  channel.port1.onmessage = () => done.tell({
    total: performance.now() - done.input, solver: done.solver, transfer: done.arrived - done.posted - done.solver,
    "wait for a frame": done.began - done.arrived, drawing: done.drawn - done.began, painting: performance.now() - done.drawn,
  });
  channel.port2.postMessage(0);
};
addEventListener("load", () => new MutationObserver(drawn).observe(document.querySelector("#tilt svg"), { childList: true }));
const sliderOf = (name) => document.querySelector(`[data-field="${name}"] input[type="range"]`);
const part = (name) => document.querySelector(`[data-part="${name}"]`);
const compared = (what) => {
  part("beside").value = what;
  part("beside").dispatchEvent(new Event("change"));
};
const moved = (name, shift) => new Promise((tell) => {
  const slider = sliderOf(name);
  slider.value = Number(slider.value) + shift;
  move = { input: performance.now(), tell };
  slider.dispatchEvent(new Event("input"));
});
"""  # noqa: E501


class Browser:
    """A page in Chromium, over its DevTools pipe; the process is `pid`."""

    def __init__(self, pid: int, write: int, read: int) -> None:
        self.pid, self._write, self._read = pid, write, read
        self._rest, self._count, self._session = b"", 0, ""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def call(self, method: str, **parameters: object) -> Any:
        """Return the answer to a command of the protocol.

        Raises
        ------
        RuntimeError
            If the browser says that it failed, or says nothing.
        """
        self._count += 1
        message: dict[str, object] = {"id": self._count, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def value(self, expression: str) -> Any:
        """Return the value of an expression, or of its promise, in the page."""
        found = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in found:
            raise RuntimeError(f"{expression}: {found['exceptionDetails']['text']}")
        return found["result"].get("value")

    def _next(self) -> Any:
        while b"\0" not in self._rest:
            if not select.select([self._read], [], [], PATIENCE)[0]:
                raise RuntimeError(f"Chromium has not answered for {PATIENCE:g} s")
            part = os.read(self._read, 1 << 20)
            if not part:
                raise RuntimeError("Chromium has ended")
            self._rest += part
        message, self._rest = self._rest.split(b"\0", 1)
        return json.loads(message)


def chromium() -> str | None:
    """Return the program, or None where it is not installed."""
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


@contextlib.contextmanager
def browser() -> Iterator[Browser]:
    """Open Chromium, which reads commands from its file 3 and answers to its file 4."""
    program = chromium()
    if program is None:
        raise ValueError("needs Chromium: no chromium, chromium-browser or google-chrome on PATH")
    pipes = [*os.pipe(), *os.pipe()]
    # away from 3 and 4, which they are copied to
    apart = [fcntl.fcntl(each, fcntl.F_DUPFD_CLOEXEC, 10) for each in pipes]
    theirs_in, ours_out, ours_in, theirs_out = apart
    for each in pipes:
        os.close(each)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--window-size=1280,900"]
        pid = os.posix_spawn(
            program,
            [program, *options, "--remote-debugging-pipe", f"--user-data-dir={profile}", "about:blank"],
            os.environ,
            file_actions=[
                (os.POSIX_SPAWN_DUP2, theirs_in, 3),
                (os.POSIX_SPAWN_DUP2, theirs_out, 4),
                (os.POSIX_SPAWN_OPEN, 2, os.devnull, os.O_WRONLY, 0),
            ],
        )
        os.close(theirs_in)
        os.close(theirs_out)
        try:
            yield Browser(pid, ours_out, ours_in)
        finally:
            os.close(ours_out)  # Chromium ends with its pipe
            os.close(ours_in)
            os.waitpid(pid, 0)


def processor_times(pid: int) -> dict[str, float]:
    """Return the processor time of the threads of a process and its children, summed by name [s]."""
    parents = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            with contextlib.suppress(OSError):
                parents[int(entry.name)] = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
    family = {pid}
    while more := {child for child, parent in parents.items() if parent in family} - family:
        family |= more
    found: dict[str, float] = {}
    for member in family:
        for thread in Path(f"/proc/{member}/task").iterdir():
            with contextlib.suppress(OSError):
                name = (thread / "comm").read_text().strip()
                spent = int((thread / "schedstat").read_text().split()[0])
                found[name] = found.get(name, 0.0) + 1e-9 * spent
    return found


def measure(
    moves: int = MOVES, *, beside: str = "", seed: int = 3
) -> tuple[list[dict[str, float]], dict[str, float]]:
    """Move sliders of the page in a browser.

    Parameters
    ----------
    moves : int
        Each away from where a slider stood, or back again.
    beside : str, optional
        What the column is compared with, by its name in the page, such as "stronger". Default: nothing.
    seed : int, optional
        Of the shifts.

    Returns
    -------
    rows : list of dict
        Of each move its `PARTS` [ms].
    spent : dict
        Processor time by name of thread, per move [ms].

    Raises
    ------
    ValueError
        If there is no Chromium.
    RuntimeError
        If it does not answer.
    """
    draws, rows = random.Random(seed), []
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    state = State(height=2.0 * pier.half_height, diameter=2.0 * pier.base_radius)
    with tempfile.TemporaryDirectory() as folder, browser() as page:
        file = Path(folder, "explore.html")
        file.write_text(explore_page(standard_shakings(), state), encoding="utf-8")
        page.call("Page.enable")
        page.call("Page.addScriptToEvaluateOnNewDocument", source=_WATCH)
        page.call("Page.navigate", url=file.as_uri())
        time.sleep(3.0)  # the first picture, and the beginning of the map
        # the motion is not played: it would be drawn at every frame, and is no part of a move
        page.value('part("play").click()')
        if beside:
            page.value(f"compared({json.dumps(beside)})")
            time.sleep(1.0)
        before = processor_times(page.pid)
        for place in range(moves):
            if place % 2 == 0:
                name = SLIDERS[(place // 2) % len(SLIDERS)]
                shift = draws.choice((-1, 1)) * draws.randint(*SHIFT)
                at = int(page.value(f'Number(sliderOf("{name}").value)'))
                shift = min(max(shift, -at), 1000 - at) or SHIFT[1]  # a slider at its end goes the other way
            rows.append(page.value(f'moved("{name}", {shift if place % 2 == 0 else -shift})'))
            time.sleep(PAUSE)
        after = processor_times(page.pid)
    return rows, {name: 1e3 * (spent - before.get(name, 0.0)) / moves for name, spent in after.items()}


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = options_of(
        "slider_moves",
        "Time from a move of a slider to the painted trace, with its parts. Example: --beside stronger",
    )
    parser.add_argument("--moves", type=int, default=MOVES, help="moves of sliders (%(default)s)")
    kinds = ("stronger", "planar", "other")
    parser.add_argument("--beside", choices=kinds, default="", help="what the column is compared with")
    given = parser.parse_args(arguments)
    rows, spent = measure(given.moves, beside=given.beside)
    print(f"{'[ms]':18} {'median':>8} {'90 %':>8} {'most':>8}")
    for name in PARTS:
        values = np.array([row[name] for row in rows])
        print(f"{name:18} {np.median(values):8.1f} {np.quantile(values, 0.9):8.1f} {values.max():8.1f}")
    print("processor time of a move [ms], by thread:")
    for name, value in sorted(spent.items(), key=lambda each: -each[1])[:6]:
        print(f"  {name:16} {value:8.1f}")
    return 0
