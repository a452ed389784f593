"""`rockwobble check --model` and `--trajectory`: the checks of an external model or trajectory."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import rockwobble as rw
import rockwobble.compare as rc

from ..inputs import options

if TYPE_CHECKING:
    from rockwobble.compare.check import Finding

_outside = options.panel("A model or a trajectory of somebody else")
Model = Annotated[
    str | None,
    _outside(
        "Check a model: a function of a rockwobble.Case and a support that returns time, tilt, azimuth.",
        metavar="MODULE:FUNCTION",
    ),
]
Trajectory = Annotated[
    Path | None,
    _outside("Check a trajectory (CSV with time, tilt, azimuth) of the one case of --suite."),
]
Support = Annotated[str | None, _outside("What it models: recess or flat. Default: recess.")]
Tolerance = Annotated[float | None, _outside("How exact it claims to be. Default: 0.001.")]


def require_used(
    model: str | None,
    trajectory: Path | None,
    suite: str | None,
    support: str | None,
    tolerance: float | None,
    workers: int | None,
) -> None:
    """Refuse an option that the given ones leave without a meaning.

    Raises
    ------
    ValueError
        If there is one.
    """
    if model is None and trajectory is None:
        for name, value in (("--support", support), ("--tolerance", tolerance)):
            if value is not None:
                raise ValueError(f"{name} belongs to --model or --trajectory, got it without either")
    elif workers is not None:
        raise ValueError("--workers belongs to the engines, which --model and --trajectory do not run")
    elif model is not None and suite is not None:
        raise ValueError("--suite does not go with --model: its checks have cases of their own")


def outside_findings(
    model: str | None, trajectory: Path | None, suite: str, support: str, tolerance: float
) -> list[Finding]:
    """Return the findings of the checks, a check that cannot run included.

    Raises
    ------
    ValueError
        If both are given, one cannot be read, or the suite has more than one case.
    """
    from rockwobble.compare.check.outside import check_model, check_trajectory, load_model

    if model is not None and trajectory is not None:
        raise ValueError("--model and --trajectory exclude each other, got both")
    if model is not None:
        return list(check_model(load_model(model), support=support, tolerance=tolerance))
    assert trajectory is not None
    cases = rw.read_suite(suite).cases
    if len(cases) != 1:
        raise ValueError(f"--trajectory needs a --suite with one case, got {len(cases)} in {suite}")
    given = rc.read_trajectory(trajectory, cases[0])
    return list(check_trajectory(given, support=support, tolerance=tolerance))


def print_outside(findings: list[Finding]) -> None:
    """Print them layer by layer."""
    from rich.console import Console

    from rockwobble.compare.check import LAYERS

    from ...pages.check import print_layer

    console = Console()
    for layer in LAYERS:
        found = [finding for finding in findings if finding.layer == layer]
        if found:
            print_layer(console, layer, found)
