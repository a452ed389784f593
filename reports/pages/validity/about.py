"""What the report was made from, in lines that a reader can check."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from rockwobble.compare.studies.validity.statistics import SIZE, TAN_ALPHA
from rockwobble.models import Cylinder

if TYPE_CHECKING:
    from rockwobble.compare.studies.validity import Extent


def about(extent: Extent, motions: Mapping[str, str], records: str) -> list[str]:
    """Return what is mapped, and the cylinders where one was chosen.

    Parameters
    ----------
    extent : Extent
    motions : mapping
        Titles of the motions of the maps, by name.
    records : str
        What the motions of the ensemble are.
    """
    small, large = (
        Cylinder(semidiagonal=size, tan_alpha=extent.shaken_tan_alphas[0])
        for size in extent.sizes[:: len(extent.sizes) - 1]
    )
    return [
        f"Free response: tan α from {extent.tan_alphas[0]:g} to {extent.tan_alphas[-1]:g}, released at "
        f"{extent.releases[0]:g} to {extent.releases[-1]:g} α with {extent.spins[0]:g} to "
        f"{extent.spins[-1]:g} of "
        "the rolling rate of steady wobble. It does not depend on size (Froude).",
        f"Shaking: {'; '.join(motions.values())}. Tan α from "
        f"{extent.shaken_tan_alphas[0]:g} to "
        f"{extent.shaken_tan_alphas[-1]:g}, R from {extent.sizes[0]:g} to {extent.sizes[-1]:g} m (at tan α = "
        f"{extent.shaken_tan_alphas[0]:g} b = {small.base_radius:.3g} to {large.base_radius:.3g} m, 2h = "
        f"{2.0 * small.half_height:.3g} to {2.0 * large.half_height:.3g} m), peaks from "
        f"{extent.intensities[0]:g} to "
        f"{extent.intensities[-1]:g} g tan α.",
        f"Distributions: {extent.members} {records}; {_body(TAN_ALPHA, SIZE)}.",
        f"At R = 6 m: rings at tan α {_list(extent.ring_tan_alphas)}, soft contact at "
        f"{_list(extent.contact_tan_alphas)}, slip at "
        f"{_list(sorted({point[0] for point in extent.slip_points}))}.",
        f"Traces: {len(extent.trace_points)} problems under El Centro, {extent.trace_length:g} s.",
    ]


def _body(tan_alpha: float, size: float) -> str:
    body = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    return (
        f"R = {size:g} m, b = {body.base_radius:.4g} m, 2h = {2.0 * body.half_height:.4g} m, "
        f"alpha = {math.degrees(body.alpha):.4g} deg (tan α = {tan_alpha:g})"
    )


def _list(values: object) -> str:
    assert isinstance(values, list | tuple)
    return ", ".join(f"{value:g}" for value in values)
