"""`rockwobble spectrum`: which shaking overturns which size, in 3D and by planar analysis."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import rockwobble as rw
import rockwobble.compare.storage as rs
from rockwobble.compare.studies.plans import SpectrumPlan

from ..console.progress import shown_progress
from ..console.results import show_and_save
from ..console.terminal import interruptible, user_input
from ..pages.words.cases import describe
from .inputs import options
from .inputs.plan_options import takes_options
from .inputs.problem import Record


@takes_options
def spectrum(
    record: Record,
    plan: SpectrumPlan,
    tan_alpha: options.TanAlpha = 0.1,
    workers: options.Workers = None,
    out: options.Out = Path("rockwobble-spectrum"),
) -> None:
    """Map the peak tilt over size and intensity, in 3D and by planar analysis of each component.

    The record is scaled until its peak horizontal resultant reaches each intensity. A planar run takes
    one component of the same shaking alone.

    Without options: figure 6 of the paper, the 1940 El Centro record on cylinders of tan alpha = 0.1.

    The lowest intensity that overturns each size is searched between the intensities and below them,
    too; what the search misses is measured.

    Writes spectrum.html, the same as spectrum.md with spectrum.svg, and as Parquet the cells (spectrum),
    the lowest intensities found to overturn (lowest), the gaps in the overturning region above them
    (gaps), the shares by size (contrast), and some cells run again to a tighter tolerance (checked).
    """
    with interruptible():
        with user_input():
            from rockwobble.compare.studies.spectrum.maps import intensity_unit

            motion = record.motion()
            assert motion is not None  # without a release there always is one
            intensity_unit(tan_alpha, motion, plan.gravity)
            slender = rw.Case(
                rw.Cylinder(semidiagonal=1.0, tan_alpha=tan_alpha), motion, gravity=plan.gravity
            )
            rs.require_writable(out)
        print(
            f"Cylinders: tan alpha = {tan_alpha:g} (alpha = {math.degrees(slender.cylinder.alpha):.4g} deg)"
        )
        # the ground: the threshold of uplift is that of all sizes
        print(*describe(slender)[1:-1], sep="\n")
        with shown_progress("series") as progress:
            found = rw.spectrum(
                tan_alpha, motion, workers=workers, progress=progress, **dataclasses.asdict(plan)
            )
        show_and_save(found, out)
