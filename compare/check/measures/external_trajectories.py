"""Layer metrics, third part: files of external trajectories, of one motion that is known in every form.

The cylinder wobbles and twists on a place that drifts away: tilt, azimuth, twist and place are functions
of time that are written down.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rockwobble.models import Trace

from ...comparison.summary import SUMMARY_COLUMNS, external_row
from ...external.trajectory import External, read_trajectory
from ...external.verdict import numbers_of
from ..bench import Array, Bench, largest
from ..finding import Bound, Finding, worst_of
from ..models import lagrange
from ..problems import PIER, released
from .made_traces import made

B, H, ALPHA = PIER.base_radius, PIER.mass_centre_height, PIER.alpha
LENGTH = 5.0
CASE = released(0.5, 0.0, LENGTH, name="made")
LATE = 0.6  # [rad] phase of the tilt at the start
DRIFT = np.array([0.1, -0.05, 0.0])  # of b, in the whole run
KNOWN, UNIT = "a motion that is written down", "s, rad, m"
PRINTED = Bound(1e-9, f"{KNOWN}; twelve digits are printed", UNIT)
# (0.02 w)^3 of a wobble of w = 4 rad/s; 3e-5 was measured
COARSE = Bound(2e-4, f"{KNOWN}; local cubic between samples 0.02 s apart", UNIT)
TURNING = Bound(1e-5, f"{KNOWN}; parabola through three samples", UNIT)
PART = "external trajectories: units, quaternions, places or turning points"


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this part."""
    del bench
    fine, coarse = (step * np.arange(round(LENGTH / step) + 1, dtype=np.float64) for step in (0.01, 0.02))
    late = _quaternions(fine - 2.5, placed=True, shift=2.5)
    forms = {
        "angles in degrees, ms": (_angles(fine), 0.0, PRINTED),
        "quaternions": (_quaternions(fine, placed=False), 0.0, PRINTED),
        "quaternions and places in mm, another clock": (late, 2.5, PRINTED),
        "samples twice as far apart, places": (_quaternions(coarse, placed=True), 0.0, COARSE),
    }
    for name, (text, offset, bound) in forms.items():
        yield worst_of(f"external trajectory, {name}", _errors(_read(text, offset), name), bound, PART)
    turning = _turning(_read(_quaternions(fine, placed=True), 0.0))
    yield worst_of("turning points of an external trajectory", turning, TURNING, PART)
    row = _row(_read(_quaternions(fine, placed=True), 0.0), fine)
    yield worst_of("a row of the summary, of an external trajectory", row, TURNING, PART)


def _motion(time: Array) -> tuple[Array, Array, Array, Array]:
    """Tilt, azimuth, twist (n,) [rad] and drift of the place (n, 3) [m]."""
    tilt = ALPHA * (0.5 + 0.3 * np.cos(2.0 * time - LATE) - 0.02 * time)
    return tilt, 0.4 + 1.5 * time, 2.2 * time, np.outer(time / LENGTH, DRIFT) * B


def _centre(time: Array) -> Array:
    tilt, azimuth, _, drift = _motion(time)
    return lagrange.mass_centre(lagrange.shape_of(PIER), tilt, azimuth) + drift


def _row(trial: Trace, time: Array) -> dict[str, float]:
    """What the summary says of a file that has the very motion of the reference, but for the turn."""
    tilt, azimuth, _, _ = _motion(time)
    at = B * np.column_stack([np.cos(azimuth), np.sin(azimuth)])
    reference = made(time, tilt, rolling_angle=azimuth, contact_point=at, uplift_direction=0.4)
    found = external_row(CASE, "made", reference, "file", trial)
    known = {"tilt_rms": 0.0, "peak_tilt_difference": 0.0, "diverged": 0.0, "agreement_time": LENGTH}
    known |= {"uplift_time_difference": 0.0, "uplift_direction_difference": 0.0}
    numbers = numbers_of(found)
    errors = {name: numbers[name] - value for name, value in known.items()}
    return {**errors, "columns": float(len({*SUMMARY_COLUMNS} ^ {*found}))}


def _errors(found: Trace, form: str) -> dict[str, float]:
    tilt, azimuth, twist, drift = _motion(found.time)
    outward = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
    placed = "places" in form
    at = drift if placed else 0.0 * drift
    whole = round(float(found.rolling_angle[0] - azimuth[0]) / (2.0 * math.pi)) * 2.0 * math.pi
    errors = {
        "times": largest(found.time - 0.01 * np.arange(501)) if len(found.time) == 501 else math.inf,
        "tilt": largest(found.tilt - tilt),
        "rolling angle": largest(found.rolling_angle - azimuth - whole),
        "contact point": largest(found.contact_point - B * outward - at[:, :2]),
        "mass centre": largest(found.centre_of_mass - _centre(found.time) + drift - at),
        "time of uplift": found.uplift_time,
        "direction of uplift": math.remainder(found.uplift_direction - 0.4, 2.0 * math.pi),
    }
    if form.startswith("angles"):
        unknown = np.isnan(found.twist).all() and math.isnan(found.residual_displacement)
        return errors | {"what is not known": 0.0 if unknown else math.inf}
    errors |= {
        "twist": largest(found.twist - twist),
        "residual twist": found.residual_twist - twist[-1],
    }
    if placed:
        # the base centre is off its place by b (1 - cos theta) as well
        base = drift[-1, :2] + B * (1.0 - math.cos(tilt[-1])) * outward[-1]
        errors["residual displacement"] = found.residual_displacement - math.hypot(*base)
    return errors


def _turning(found: Trace) -> dict[str, float]:
    """Where the tilt turns: 0.6 sin(2 t - LATE) = -0.02; the two maxima are a period of pi apart."""
    early = math.asin(0.02 / 0.6)
    lowest, highest = 0.5 * (LATE + math.pi + early), 0.5 * (LATE - early)
    tilts = _motion(np.array([lowest, highest]))[0]
    if len(found.passes) != 1:
        return {f"{len(found.passes)} passes": math.inf}
    only = found.passes.iloc[0]
    return {
        "time of the pass": float(only["time"]) - lowest,
        "its minimum tilt": float(only["minimum_tilt"]) - tilts[0],
        "its turn": float(only["angle_of_turn"]) - 1.5 * math.pi,
        "peak": found.peak_tilt - tilts[1],
    }


def _angles(time: Array) -> str:
    tilt, azimuth, _, _ = _motion(time)
    # azimuths as an instrument gives them, within one turn
    rows = np.column_stack([1e3 * time, np.degrees(tilt), np.degrees(azimuth) % 360.0])
    return _csv("time [ms], tilt [deg], azimuth [deg]", rows)


def _quaternions(time: Array, *, placed: bool, shift: float = 0.0) -> str:
    tilt, azimuth, twist, _ = _motion(time + shift)
    own = twist - azimuth  # about the axis of the cylinder
    half, lean, mean = 0.5 * tilt, 0.5 * (azimuth - own), 0.5 * twist
    w, x = np.cos(half) * np.cos(mean), -np.sin(half) * np.sin(lean)
    y, z = np.sin(half) * np.cos(lean), np.cos(half) * np.sin(mean)
    # as an instrument gives them: q and -q are one pose, and the scalar part is not negative
    columns = [time, *(np.where(w < 0.0, -1.0, 1.0) * part for part in (w, x, y, z))]
    head = "time, qw, qx, qy, qz"
    if placed:
        rows = np.column_stack([*columns, 1e3 * _centre(time + shift)])
        return _csv(f"{head}, x [mm], y [mm], z [mm]", rows)
    return _csv(head, np.column_stack(columns))


def _csv(head: str, rows: Array) -> str:
    return "\n".join([head, *(", ".join(f"{value:.12g}" for value in row) for row in rows.tolist())]) + "\n"


def _read(text: str, offset: float) -> Trace:
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "made.csv"
        path.write_text(text, encoding="utf-8")
        return read_trajectory(External(path=path, time_offset=offset), CASE)
