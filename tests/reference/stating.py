"""Options of a case and of a method in one mapping, as tests vary them."""

from typing import Any

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, Trace

OF_CASE = ("initial", "duration", "gravity", "friction")


def solve(cylinder: Cylinder, motion: GroundMotion | None = None, **options: Any) -> Trace:
    """Run a reduced model; `model` stands for its options, "planar" for plane=0."""
    stated = {name: options.pop(name) for name in OF_CASE if name in options}
    method = {**reduced.MODELS[options.pop("model", "recess")], **options}
    return reduced.simulate(Case(cylinder, motion, **stated), **method)
