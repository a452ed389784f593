"""The checks of an external model: exact solutions, invariances, uplift, and one record.

They ask for no more than a tolerance that the caller states: how exact the model claims to be.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940
from rockwobble.reduced.exact import steady_wobble_rate

from ...external.motion import Motion
from ...external.verdict import motion_of
from ..finding import Bound, Finding, at_most, not_run
from .motion import apart, first_maximum, rises
from .outputs import Array, Model, outputs_of

G = 9.81
TOLERANCE = 1e-3  # relative, of alpha, or of a turn
_PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
_SPIN = 0.5  # [rad/s]
_LENGTH = 5.0  # [s] of a release: two periods
_LEVEL = 1e-3  # of alpha: tilt at which an uplift is seen
REASON = "tolerance that was asked for"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Outside:
    """A model of somebody else on one support, and how exact it claims to be."""

    model: Model
    support: str
    tolerance: float

    def run(self, case: Case) -> Motion:
        """Return its motion."""
        return outputs_of(self.model(case, self.support))[0]

    def energy(self, case: Case) -> Array | None:
        """Return its energy; None if it does not tell."""
        return outputs_of(self.model(case, self.support))[1]

    def finding(self, layer: str, name: str, value: float, part: str) -> Finding:
        """Hold a value against the tolerance."""
        return held(self.tolerance, layer, name, value, part)


def ours(case: Case, support: str) -> Motion:
    """Return the motion of the reduced model."""
    return motion_of(reduced.simulate(case, support=support, rtol=1e-11, sample_step=case.length / 4000))


def held(tolerance: float, layer: str, name: str, value: float, part: str) -> Finding:
    """Return the finding that holds a value against a tolerance."""
    return dataclasses.replace(at_most(name, value, Bound(tolerance, REASON), part), layer=layer)


def left_out(layer: str, name: str, part: str, note: str) -> Finding:
    """Return the finding of a check that cannot run."""
    return dataclasses.replace(not_run(name, part, note), layer=layer)


Check = Callable[[Outside], Iterator[Finding]]

# layers of `rockwobble check` that ask for more than time, tilt, azimuth and energy
NEVER = {
    "equations": "differences of positions give accelerations only where samples are exact to rounding",
    "properties": "neither contact forces nor turning points are returned",
    "order": "its steps and tolerances are its own",
    "residual": "neither its place nor its twist is returned",
    "baseline": "no earlier numbers of it are stored",
}


def check_model(model: Model, *, support: str = "recess", tolerance: float = TOLERANCE) -> Iterator[Finding]:
    """Yield the findings of the checks; one that cannot run says why.

    Parameters
    ----------
    model : callable
        Of a case and a support, see `outputs`.
    support : {"recess", "flat"}
        What it models.
    tolerance : float
        How exact it claims to be.

    Raises
    ------
    ValueError
        If the support or the tolerance is out of range.
    """
    if support not in ("recess", "flat"):
        raise ValueError(f"support must be 'recess' or 'flat', got {support!r}")
    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"tolerance must be above 0 and below 1, got {tolerance!r}")
    outside = Outside(model=model, support=support, tolerance=tolerance)
    for layer, name, check in _CHECKS:
        try:
            yield from check(outside)
        except Exception as error:  # whatever code of somebody else raises is told, and the next check runs
            note = f"{type(error).__name__}: {' '.join(str(error).split())}"
            yield left_out(layer, name, "the model", note)
    for layer, note in NEVER.items():
        yield left_out(layer, f"checks of the layer {layer}", "the model", note)


def _release(spin: float = _SPIN, azimuth: float = 0.3, body: Cylinder = _PIER) -> Case:
    unit = math.sqrt(body.semidiagonal / _PIER.semidiagonal)
    start = InitialState(0.5 * body.alpha, 0.0, azimuth, spin / unit)
    return Case(body, initial=start, duration=_LENGTH * unit, gravity=G)


def _free_response(outside: Outside) -> Iterator[Finding]:
    case = _release()
    time, tilt, azimuth = first_maximum(outside.run(case))
    wanted = first_maximum(ours(case, outside.support))
    yield outside.finding("exact", "period of a release", abs(time / wanted[0] - 1.0), "(18), or the clock")
    loss = abs(tilt / wanted[1] - 1.0)
    yield outside.finding("conserved", "tilt that it returns to", loss, "energy")
    if math.isnan(azimuth):
        yield left_out("exact", "angle of turn", "(19)", "the model returns no azimuth")
        return
    off = math.remainder(azimuth - wanted[2], 2.0 * math.pi) / (wanted[2] - 0.3)
    yield outside.finding("exact", "angle of turn", abs(off), "(19)")


def _steady(outside: Outside) -> Iterator[Finding]:
    tilt = 0.5 * _PIER.alpha
    spin = float(steady_wobble_rate(_PIER, tilt, gravity=G))
    given = outside.run(_release(spin))
    off = float(np.abs(given.tilt - tilt).max()) / _PIER.alpha
    yield outside.finding("exact", "tilt of a steady wobble", off, "(24), the balance of (18)")


def _energy(outside: Outside) -> Iterator[Finding]:
    energy = outside.energy(_release())
    if energy is None:
        note = "the model returns no energy"
        yield left_out("conserved", "energy of a release", "energy", note)
        return
    drift = float(np.abs(energy / energy[0] - 1.0).max())
    yield outside.finding("conserved", "energy of a release", drift, "energy")


def _invariance(outside: Outside) -> Iterator[Finding]:
    base, alpha = outside.run(_release()), _PIER.alpha
    large = Cylinder(semidiagonal=4.0 * _PIER.semidiagonal, tan_alpha=_PIER.tan_alpha)
    other = outside.run(_release(body=large))
    value = apart(base, other, alpha, _LENGTH, stretch=2.0)
    yield outside.finding("invariance", "four times the size, half as fast", value, "units, or a tolerance")
    if base.lean is None:
        for name in ("another azimuth", "the mirror image"):
            note = "the model returns no azimuth"
            yield left_out("invariance", name, "the frame", note)
        return
    value = apart(base.turned(1.0), outside.run(_release(azimuth=1.3)), alpha, _LENGTH)
    yield outside.finding("invariance", "another azimuth", value, "the frame")
    mirrored = outside.run(_release(-_SPIN, -0.3))
    value = apart(base.turned(0.0, mirrored=True), mirrored, alpha, _LENGTH)
    yield outside.finding("invariance", "the mirror image", value, "the frame")


def _standing(outside: Outside) -> Iterator[Finding]:
    push = 0.99 * G * _PIER.tan_alpha
    motion = GroundMotion([[0.0, 0.0], [0.6 * push, 0.8 * push], [0.0, 0.0]], 1.0)
    tilt = float(outside.run(Case(_PIER, motion, gravity=G)).tilt.max()) / _PIER.alpha
    yield outside.finding("rest", "tilt where it must stand", tilt, "(25)")


def _uplift(outside: Outside) -> Iterator[Finding]:
    push = 1.5 * G * _PIER.tan_alpha
    case = Case(_PIER, GroundMotion([[0.0, 0.0], [0.6 * push, 0.8 * push]], 1.5), gravity=G)
    seen = [rises(given, _LEVEL * _PIER.alpha) for given in (outside.run(case), ours(case, outside.support))]
    off = abs(seen[0] - seen[1])
    yield outside.finding("rest", "time of an uplift [s]", off, "(25) and the start of (18)")


def _record(outside: Outside) -> Iterator[Finding]:
    body = Cylinder(semidiagonal=10.0, tan_alpha=0.1)
    case = Case(body, el_centro_1940(), duration=12.0, gravity=G)
    value = apart(outside.run(case), ours(case, outside.support), body.alpha, 12.0)
    yield outside.finding("agreement", "lean under El Centro, 12 s", value, "a_r and a_t of (18), (19)")


_CHECKS: tuple[tuple[str, str, Check], ...] = (
    ("exact", "free response", _free_response),
    ("exact", "steady wobble", _steady),
    ("conserved", "energy", _energy),
    ("rest", "standing", _standing),
    ("rest", "uplift", _uplift),
    ("invariance", "size, azimuth and mirror image", _invariance),
    ("agreement", "El Centro", _record),
)
