"""What limits a run that did not fail, in words for the message of its trajectory."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..scene.froude import Scale
from .recorder import Recorder

if TYPE_CHECKING:
    import pandas as pd


def remarks(recorder: Recorder, passes: pd.DataFrame, resolution: float, scale: Scale) -> str:
    """Return the remarks, separated by semicolons; empty if there are none.

    `passes` and `resolution` [rad] are those of the trajectory, in the time of the user. How the side comes
    down in a fall that is followed beyond the end asked for limits nothing: what happens there is not said.
    """
    end = recorder.asked
    # what never happened has the time NaN, which is no time before the end
    found = [recorder.reason] if recorder.reason else []
    if recorder.slip_time <= end:
        found.append(f"contact slipped from {recorder.slip_time * scale.time:.4g} s on")
    if recorder.pull_time <= end:
        found.append(
            f"a joint holds the rim down at {recorder.pull_time * scale.time:.4g} s: contact is lost"
        )
    if recorder.grip_time <= end:
        found.append(
            f"a joint holds the rim at {recorder.grip_time * scale.time:.4g} s, where the friction of the "
            "case would let it slip"
        )
    if recorder.flight_time <= end:
        found.append(f"the cylinder left the ground at {recorder.flight_time * scale.time:.4g} s")
    if recorder.walls.first <= end:
        found.append(f"the cylinder touched a wall from {recorder.walls.first * scale.time:.4g} s on")
    since, share = recorder.energy.remark(end)
    if not math.isnan(since):
        found.append(
            f"contact {'made' if share > 0.0 else 'took'} {abs(share):.1e} of the energy of the motion, "
            f"which shows from {since * scale.time:.4g} s on"
        )
    if recorder.undecided:
        found.append("it ends in the middle of a fall, and whether that overturns it is not decided")
    if recorder.unsolved:
        found.append(
            f"the solver had not converged in {recorder.unsolved} of the {recorder.looks} steps looked at"
        )
    close = passes[~passes["resolved"]]
    if len(close):
        found.append(
            f"{len(close)} of {len(passes)} passes are closer to upright than the {resolution:.1e} rad that "
            f"the run resolves, first at {close['time'].iloc[0]:.4g} s"
        )
    return "; ".join(found)
