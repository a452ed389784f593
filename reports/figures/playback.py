"""Playback in 3D: page data of the motions of a case."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from rockwobble.compare.metrics.pair import balance_of
from rockwobble.models import Trace

from .case_view import CaseView
from .interactive import base64_of

# frames in a second: the page interpolates between them
_PICTURES = 25.0
_TRAIL = 4.0  # how much of the path of the contact point is seen [s]
_TRANSLUCENT, _SOLID = 0.35, 1.0
_FACTORS = (1, 3, 10, 30)  # magnifications of the tilt
# magnified tilt: largest that may be chosen, and at first
_STEEPEST, _SEEN = np.radians(60.0), np.radians(25.0)
_BEFORE = 0.5  # uplift, from when on the motion is shown [s]


def playback(view: CaseView) -> dict[str, object] | None:
    """Data for `playback.js`: the runs of a case and their reduced models.

    A pose is stated by tilt, rolling angle, twist and contact point, not by a matrix: so the page can
    magnify the tilt and keep the cylinder on its rim. Nothing is to be played where nothing moves.

    Parameters
    ----------
    view : CaseView

    Returns
    -------
    dict or None
        Numbers, texts and, as base64 of little-endian float32, arrays: ready for JSON.
    """
    cylinder = view.case.cylinder
    largest = _largest_upright_tilt(view)
    factors = [factor for factor in _FACTORS if factor * largest < _STEEPEST or factor == 1]
    runs = [_body(label, trace, view.styles[label].colour, _SOLID) for label, trace in view.runs.items()]
    models = [_body(label, trace, "#8a8a8a", _TRANSLUCENT) for label, trace in view.references.items()]
    if not any(body["moves"] for body in [*runs, *models]):
        return None
    return {
        "base_radius": cylinder.base_radius,
        "height": 2.0 * cylinder.half_height,
        # playback continues after the case until the overturned side is down
        "length": max(view.case.length, *(float(trace.time[-1]) for trace in view.traces.values())),
        "runs": runs,
        "models": models,
        # initial partner of each run: its reduced model
        "partners": [list(view.references).index(view.partner(label)) for label in view.runs]
        if view.references
        else [],
        "slab": cylinder.carries_slab,
        "tendon": view.case.tendon is not None,
        "start": _start(view),
        "magnify": factors,
        "shown": max((each for each in factors if each * largest < _SEEN), default=1),
        "trail": round(_TRAIL * _PICTURES),
    }


def require_motion(name: str, traces: Iterable[Trace]) -> None:
    """Refuse the traces of a case if nothing moves in any.

    Raises
    ------
    ValueError
    """
    if not any(_pose(trace)["tilt"].any() for trace in traces if len(trace.time)):
        raise ValueError(f"there is nothing to play in {name!r}: the cylinder never uplifts")


def _body(label: str, trace: Trace, colour: str, opacity: float) -> dict[str, object]:
    step = _picture_step(trace.time)
    keep = slice(None, None, step)
    pose = _pose(trace)
    return {
        "label": label,
        "colour": colour,
        "opacity": opacity,
        "moves": bool(np.any(pose["tilt"] > 0.0)),
        **{name: base64_of(values[keep]) for name, values in {"time": trace.time, **pose}.items()},
    }


def _pose(trace: Trace) -> Mapping[str, NDArray[np.float64]]:
    """Tilt, rolling angle, twist and contact point, with finite values while the cylinder stands."""
    standing = ~np.isfinite(trace.rolling_angle) | ~np.isfinite(trace.contact_point[:, 0])
    tilt = np.where(standing, 0.0, trace.tilt)
    rolling_angle = np.where(standing, 0.0, trace.rolling_angle)
    # a standing cylinder touches everywhere: any rim point serves
    touch_x = np.where(
        standing, trace.centre_of_mass[:, 0] + trace.case.cylinder.base_radius, trace.contact_point[:, 0]
    )
    touch_y = np.where(standing, trace.centre_of_mass[:, 1], trace.contact_point[:, 1])
    return {
        "tilt": tilt,
        "rolling_angle": rolling_angle,
        "twist": np.nan_to_num(trace.twist),
        "contact_x": touch_x,
        "contact_y": touch_y,
    }


def _picture_step(time: NDArray[np.float64]) -> int:
    if len(time) < 2:
        return 1
    return max(1, round(1.0 / (_PICTURES * float(time[1] - time[0]))))


def _start(view: CaseView) -> float:
    """Start of the playback: half a second before the first uplift [s]."""
    uplifts = [trace.uplift_time for trace in view.traces.values() if math.isfinite(trace.uplift_time)]
    return max(0.0, min(uplifts, default=0.0) - _BEFORE)


def _largest_upright_tilt(view: CaseView) -> float:
    """Largest tilt of all samples below 1.2 of the balance tilt [rad]."""
    tilts = [trace.tilt for trace in view.traces.values()]
    upright = [tilt[np.isfinite(tilt) & (tilt < 1.2 * balance_of(view.case))] for tilt in tilts]
    return max((float(tilt.max(initial=0.0)) for tilt in upright), default=0.0)
