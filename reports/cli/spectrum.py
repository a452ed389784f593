"""`rockwobble spectrum`: which shaking overturns which size, in 3D and by planar analysis."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import rockwobble.compare as rc

from ..console.progress import shown_progress
from ..console.results import show_and_write
from ..console.terminal import command_line, interruptible, user_input
from ..pages.words.cases import describe
from .inputs import options

_grid = options.panel("Grid")
# a map of more cells than a screen has pixels is a slip of the hand
_MOST_POINTS = 2000
# a search in smaller steps would take a day
_FINEST = 1e-5

Smallest = Annotated[float, _grid("Smallest semidiagonal R, in m.")]
Largest = Annotated[float, _grid("Largest semidiagonal R, in m.")]
Sizes = Annotated[int, _grid("Number of sizes.", callback=options.whole(2, _MOST_POINTS))]
Weakest = Annotated[float, _grid("Lowest peak of the horizontal resultant, in g tan alpha.")]
Strongest = Annotated[float, _grid("Highest peak of the resultant, in g tan alpha.")]
Intensities = Annotated[int, _grid("Number of intensities.", callback=options.whole(2, _MOST_POINTS))]
SearchStep = Annotated[
    float,
    options.method("Finest step of the search for the lowest intensity that overturns, in g tan alpha."),
]
Probes = Annotated[
    int,
    options.method(
        "Random intensities that are run below each lowest until none of them overturns: so many bound the "
        "share that does. They take most of the time; 0 draws none.",
        callback=options.whole(0),
    ),
]
Support = Annotated[str, options.method("Of the model in three dimensions: recess or flat.")]


def spectrum(
    tan_alpha: options.TanAlpha = 0.1,
    record: options.Record = None,
    record_x: options.RecordX = None,
    record_y: options.RecordY = None,
    record_z: options.RecordZ = None,
    units: options.Units = None,
    resample: options.Resample = False,
    gravity: options.Gravity = 9.81,
    smallest: Smallest = 0.5,
    largest: Largest = 30.0,
    sizes: Sizes = 100,
    weakest: Weakest = 1.0,
    strongest: Strongest = 12.0,
    intensities: Intensities = 100,
    support: Support = "recess",
    search_step: SearchStep = 0.015,
    probes: Probes = 500,
    out: options.Out = Path("rockwobble-spectrum"),
) -> None:
    """Map the peak tilt over size and intensity, in 3D and by planar analysis of each component.

    The record is scaled until its peak horizontal resultant reaches each
    intensity. A planar run takes one component of the same shaking alone.

    Without options: figure 6 of the paper, the 1940 El Centro record on
    cylinders of tan alpha = 0.1.

    The lowest intensity that overturns each size is searched between the
    intensities and below them, too; what the search misses is measured.

    Writes spectrum.html, the same as spectrum.md with spectrum.svg, and as
    Parquet the cells (spectrum), the lowest intensities found to overturn
    (lowest), the safe islands above them (islands), the shares by size
    (contrast), and some cells run again to a tighter tolerance (checked).
    """
    with interruptible():
        with user_input():
            import numpy as np

            from rockwobble.compare.studies.spectrum.spectrum import SUPPORTS, intensity_unit
            from rockwobble.models.number_checks import require_increasing, require_one_of

            from .inputs.problem import Problem

            require_increasing("--weakest and --strongest", (weakest, strongest))
            require_increasing("--smallest and --largest", (smallest, largest))
            levels, radii = (
                np.linspace(weakest, strongest, intensities),
                np.linspace(smallest, largest, sizes),
            )
            case = Problem(
                semidiagonal=largest,
                tan_alpha=tan_alpha,
                record=record,
                record_x=record_x,
                record_y=record_y,
                record_z=record_z,
                units=units,
                resample=resample,
                gravity=gravity,
            ).case()
            motion = case.motion
            if motion is None:  # without a release there always is one
                raise ValueError("a spectrum needs a ground motion")
            intensity_unit(tan_alpha, motion, case.gravity)
            require_one_of("--support", support, SUPPORTS)
            if not _FINEST <= search_step < math.inf:
                finest = f"--search-step must be at least {_FINEST:g} and finite"
                raise ValueError(f"{finest}, got {search_step:g}")
            rc.require_writable(out)
        from rockwobble.compare.studies.spectrum.spectrum import overturning_spectrum
        from rockwobble.compare.studies.spectrum.tables import manifest_of, tables_of

        from ..pages.spectrum import spectrum_page

        print(
            f"Cylinders: tan alpha = {tan_alpha:g} (alpha = {math.degrees(case.cylinder.alpha):.4g} deg), "
            f"{sizes} sizes from R = {smallest:g} to {largest:g} m"
        )
        # the ground: the threshold of uplift is that of all sizes
        print(*describe(case)[1:-1], sep="\n")
        with shown_progress("series") as tell:
            found = overturning_spectrum(
                tan_alpha,
                motion,
                semidiagonals=radii,
                intensities=levels,
                support=support,
                gravity=gravity,
                search_step=search_step,
                probes=probes,
                progress=tell,
            )
        tables = tables_of(found)
        manifest = manifest_of(found, tables, command_line())
        show_and_write(out, spectrum_page(found, tables, manifest), manifest, tables)
