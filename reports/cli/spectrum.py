"""`rockwobble spectrum`: which shaking overturns which size, in 3D and by planar analysis."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..console.terminal import interruptible, user_input
from .inputs import options

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from rockwobble.models import GroundMotion

    Array = NDArray[np.float64]

_GRID = "Grid"
# a map of more cells than a screen has pixels is a slip of the hand
_MOST_POINTS = 2000
# a search in smaller steps would take a day
_FINEST = 1e-5

Smallest = Annotated[
    float, typer.Option("--smallest", help="Smallest semidiagonal R, in m.", rich_help_panel=_GRID)
]
Largest = Annotated[
    float, typer.Option("--largest", help="Largest semidiagonal R, in m.", rich_help_panel=_GRID)
]
Sizes = Annotated[int, typer.Option("--sizes", help="Number of sizes.", rich_help_panel=_GRID)]
Weakest = Annotated[
    float,
    typer.Option(
        "--weakest", help="Lowest peak of the horizontal resultant, in g tan alpha.", rich_help_panel=_GRID
    ),
]
Strongest = Annotated[
    float,
    typer.Option("--strongest", help="Highest peak of the resultant, in g tan alpha.", rich_help_panel=_GRID),
]
Intensities = Annotated[
    int, typer.Option("--intensities", help="Number of intensities.", rich_help_panel=_GRID)
]
SearchStep = Annotated[
    float,
    typer.Option(
        "--search-step",
        help="Largest step of the search for the lowest intensity that overturns, in g tan alpha.",
        rich_help_panel="Method",
    ),
]
SpatialModel = Annotated[
    str,
    typer.Option("--model", help="Model in three dimensions: recess or flat.", rich_help_panel="Method"),
]


def spectrum(
    tan_alpha: options.TanAlpha = 0.1,
    record_x: options.RecordX = None,
    record_y: options.RecordY = None,
    record_z: options.RecordZ = None,
    units: options.Units = None,
    smallest: Smallest = 0.5,
    largest: Largest = 30.0,
    sizes: Sizes = 100,
    weakest: Weakest = 1.0,
    strongest: Strongest = 12.0,
    intensities: Intensities = 100,
    model: SpatialModel = "recess",
    search_step: SearchStep = 0.01,
    out: options.Out = Path("rockwobble-out"),
) -> None:
    """Map the peak tilt over size and intensity, in 3D and by planar analysis of each component.

    The record is scaled until its peak horizontal resultant reaches each
    intensity. A planar run takes one component of the same shaking alone.

    Without options: figure 6 of the paper, the 1940 El Centro record on
    cylinders of tan alpha = 0.1.

    The lowest intensity that overturns each size is searched below the grid,
    too, in steps that are stated.

    Writes spectrum.svg and spectrum.md, and as Parquet the cells (spectrum),
    the lowest intensities found to overturn (lowest), the safe islands above
    them (islands), the shares by size (contrast), and some cells run again to a
    tighter tolerance (checked).
    """
    with interruptible():
        with user_input():
            from rockwobble.compare import replace_files, require_writable

            grid = {
                "semidiagonals": _axis("smallest", smallest, "largest", largest, "sizes", sizes),
                "intensities": _axis("weakest", weakest, "strongest", strongest, "intensities", intensities),
            }
            motion = _motion(tan_alpha, largest, record_x, record_y, record_z, units)
            _require_method(model, search_step)
            require_writable(out)
        from rockwobble.compare.studies.spectrum.verification import check_cells, confirm_lowest

        from ..console.spectrum_output import (
            CHECKED_CELLS,
            describe_grid,
            print_spectrum,
            run_spectrum,
            spectrum_files,
        )

        for line in describe_grid(tan_alpha, motion, **grid):
            print(line)
        result = run_spectrum(tan_alpha, motion, model=model, search_step=search_step, **grid)
        checked, lowest = check_cells(result, CHECKED_CELLS), confirm_lowest(result)
        print_spectrum(result, checked, lowest)
        contents = spectrum_files(result, checked, lowest)
        with user_input():
            replace_files(out, contents)
    print(f"\nWritten to {out}: {', '.join(contents)}")


def _motion(
    tan_alpha: float,
    semidiagonal: float,
    record_x: Path | None,
    record_y: Path | None,
    record_z: Path | None,
    units: str | None,
) -> GroundMotion:
    from rockwobble.compare.studies.spectrum.series import intensity_unit

    from .inputs.problem import case_from_options

    case = case_from_options(
        semidiagonal=semidiagonal,
        tan_alpha=tan_alpha,
        record_x=record_x,
        record_y=record_y,
        record_z=record_z,
        units=units,
    )
    if case.motion is None:  # without a release there always is one
        raise ValueError("a spectrum needs a ground motion")
    intensity_unit(tan_alpha, case.motion, case.gravity)
    return case.motion


def _require_method(model: str, search_step: float) -> None:
    from rockwobble.compare.studies.spectrum.series import SPATIAL_MODELS

    if model not in SPATIAL_MODELS:
        raise ValueError(f"--model must be one of {', '.join(SPATIAL_MODELS)}, got {model!r}")
    if not _FINEST <= search_step < math.inf:
        raise ValueError(f"--search-step must be at least {_FINEST:g} and finite, got {search_step:g}")


def _axis(first: str, low: float, last: str, high: float, number: str, count: int) -> Array:
    import numpy as np

    if not (0.0 < low < math.inf and low < high < math.inf):
        raise ValueError(f"--{first} and --{last} must be positive and increasing, got {low:g} and {high:g}")
    if not 2 <= count <= _MOST_POINTS:
        raise ValueError(f"--{number} must be from 2 to {_MOST_POINTS}, got {count}")
    return np.linspace(low, high, count)
