"""Options of a case and of a method in one mapping, as tests vary them, and tables of references."""

import csv
from pathlib import Path
from typing import Any

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, Trace

OF_CASE = ("initial", "duration", "gravity", "friction")


def solve(cylinder: Cylinder, motion: GroundMotion | None = None, **options: Any) -> Trace:
    """Run a reduced model; `model` stands for its options, "planar" for plane=0."""
    stated = {name: options.pop(name) for name in OF_CASE if name in options}
    method = {**reduced.MODELS[options.pop("model", "recess")], **options}
    return reduced.simulate(Case(cylinder, motion, **stated), **method)


def table(name: str) -> list[dict[str, str]]:
    """The rows of a table in this folder, by column."""
    lines = (Path(__file__).parent / name).read_text("utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))
