"""What an advice says of other scales of the ground motion: uplift, overturning, and planar analysis."""

from __future__ import annotations

import math

from rockwobble.compare.metrics.tilt import overturned
from rockwobble.compare.studies.advice.planar import NEIGHBOURS, PlanarView
from rockwobble.compare.studies.spectrum.verification import CHECK_RTOL, NUDGE

from ..words import seconds, small

# a factor that planar analysis is off by is told only where the planar tilt is worth the name [alpha]
_WORTH_A_RATIO = 1e-3


def planar_words(view: PlanarView, alpha: float) -> str:
    """Say whether planar analysis of each component would be unconservative."""
    fell = overturned([view.spatial, view.planar])
    components = f"{_tilt(view.planar_x, alpha)} (x) and {_tilt(view.planar_y, alpha)} (y)"
    space = _tilt(view.spatial, alpha)
    if view.kind == "unknown":
        here = "At this scale nothing uplifts, in 3D or in a plane."
    elif fell[0] and not fell[1]:
        here = f"Planar analysis is unconservative: 3D overturns, the components alone tilt to {components}."
    elif fell[0]:
        here = "At this scale 3D overturns, and so does planar analysis of a component."
    elif fell[1]:
        here = f"Planar analysis is conservative at this scale: a component overturns, 3D tilts to {space}."
    elif view.kind == "equal":
        here = f"At this scale planar analysis gives the same: {components}, {space} in 3D."
    else:
        factor = f", {view.ratio:.2g} times as much" if view.ratio > 1.0 else ""
        if not view.planar > _WORTH_A_RATIO * alpha:
            factor = ""
        here = f"Planar analysis is {view.kind} at this scale: {components}, {space} in 3D{factor}."
    if not view.neighbours:
        return here
    more, alone = (f"{100.0 * share:.0f} %" for share in (view.larger, view.missed))
    near = (
        f"Of {view.neighbours} scales from 1/{NEIGHBOURS:g} to {NEIGHBOURS:g} times this one, 3D tilts more "
        f"than both planes at {more}, and overturns alone at {alone}."
    )
    return f"{here} {near}"


def uplift_words(factor: float) -> str:
    """Say how far the shaking is from the uplift of a cylinder at rest; `factor` on it reaches that."""
    if factor <= 1.0:
        return f"{factor:.3g} times this shaking is enough to uplift the cylinder from rest."
    return f"It takes {factor:.3g} times this shaking to uplift the cylinder from rest."


def overturning_words(
    *,
    falls: bool,
    fall: float,
    lowest: float,
    planar: float,
    chance: float,
    highest: float,
    search: float,
    confirmed: bool,
) -> str:
    """Say whether the cylinder overturns, and how far it is from it.

    Parameters
    ----------
    falls : bool
        Whether it overturns.
    fall : float
        When its side reaches the ground [s].
    lowest : float
        Lowest factor on the ground motion that was found to overturn; NaN if none was.
    planar : float
        The same by planar analysis.
    chance : float
        Share of the perturbed members that overturn.
    highest : float
        Largest factor that was run; NaN without a ground motion.
    search : float
        Largest step of the search for `lowest`; NaN without a ground motion.
    confirmed : bool
        Whether `lowest` overturns to a tighter tolerance and under a record that differs by a hair, too.
    """
    of_members = "" if math.isnan(chance) else f"; {100.0 * chance:.0f} % of the perturbed starts overturn"
    if falls:
        said = f"It overturns: its side reaches the ground at {seconds(fall)}{of_members}."
    else:
        said = f"It does not overturn{of_members}."
    if math.isnan(highest):
        return said
    searched = (
        f"in steps of {search:.2g} times and less; a narrower window of overturning may lie between them"
    )
    if math.isnan(lowest):
        return f"{said} No scale up to {highest:g} times this shaking was found to overturn it, {searched}."
    if lowest < 1.0 and not falls:
        said += (
            f" But it stands in a gap: {lowest:.3g} times this shaking, which is weaker, overturns it, so "
            "that this run proves no margin."
        )
    else:
        does = "overturns it" if falls else "does"
        said += f" The lowest scale found that {does} is {lowest:.3g} times this shaking."
    said += f" All below it that was run stands, {searched}."
    if not confirmed:
        said += (
            f" It is a matter of chance: at a tolerance of {CHECK_RTOL:.0e} or under a record nudged by "
            f"{NUDGE:.0e} the cylinder stands there."
        )
    if math.isfinite(planar):
        said += f" Planar analysis would say {planar:.3g} times."
    return said


def _tilt(tilt: float, alpha: float) -> str:
    if math.isnan(tilt):
        return "unsolved"
    if overturned(tilt):
        return "overturned"
    ratio = tilt / alpha
    return f"{small(ratio)} α" if 0.0 < ratio < _WORTH_A_RATIO else f"{ratio:.3g} α"
