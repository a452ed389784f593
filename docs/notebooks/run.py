"""Run the notebooks and keep their outputs, with small pictures, so that a forge shows them.

    python docs/notebooks/run.py             # all of them, about two minutes
    python docs/notebooks/run.py 01 04

The site runs the notebooks anew and draws its own pictures.
"""

from __future__ import annotations

import copy
import json
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
# on the site figures are SVG; here a picture of some ten kB, at half the size of a screen
_FORMAT = "%config InlineBackend.figure_formats = ["
_SMALL = '%config InlineBackend.print_figure_kwargs = {"dpi": 60, "bbox_inches": None}'
_KEPT = ("text/plain", "text/html", "image/png")
_TIMEOUT = 300  # [s] a cell: the first waits for the compiler


def small(source: str) -> str:
    """Return the source of a cell whose figures are small pictures."""
    return re.sub(
        rf"^({re.escape(_FORMAT)}).*$", lambda line: f'{line[1]}"png"]\n{_SMALL}', source, flags=re.MULTILINE
    )


def kept(output: dict[str, Any]) -> dict[str, Any]:
    """Return an output with what a forge shows of it, without what differs from run to run."""
    made = {name: value for name, value in output.items() if name != "metadata"}
    if "data" in made:
        made["data"] = {kind: made["data"][kind] for kind in _KEPT if kind in made["data"]}
        if "image/png" in made["data"]:
            made["data"] = {
                "image/png": made["data"]["image/png"].replace("\n", ""),
                "text/plain": "<Figure>",
            }
        made["metadata"] = {}
    if "execution_count" in made:
        made["execution_count"] = None
    return made


def run(path: Path) -> None:
    """Run a notebook, and write it with its outputs.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        If a cell fails.
    """
    import nbformat
    from nbclient import NotebookClient

    notebook = nbformat.read(path, as_version=4)
    ran = copy.deepcopy(notebook)
    for cell in ran.cells:
        cell.source = small(cell.source)
    NotebookClient(ran, timeout=_TIMEOUT, resources={"metadata": {"path": str(HERE)}}).execute()
    stored = json.loads(path.read_text(encoding="utf-8"))
    for cell, after in zip(stored["cells"], ran.cells, strict=True):
        if cell["cell_type"] == "code":
            cell["outputs"] = [kept(dict(each)) for each in after.outputs if each.get("name") != "stderr"]
    text = json.dumps(stored, ensure_ascii=False, indent=1)
    path.write_text(f"{text}\n", encoding="utf-8")


def main(numbers: Sequence[str]) -> None:
    """Run the notebooks whose names begin with some numbers, or all."""
    for path in sorted(HERE.glob("*.ipynb")):
        if not numbers or path.name[:2] in numbers:
            run(path)
            print(f"{path.name}: {path.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1:])
