"""Plan of the validity report: parts, extent and resolution of maps, releases and ground motions."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cache

from rockwobble import reduced
from rockwobble.models import (
    Case,
    Cylinder,
    GroundMotion,
    InitialState,
    RockingBody,
    WobblingFrame,
    el_centro_1940,
    p695_far_field,
    synthetic_motions,
)
from rockwobble.models.records.p695 import missing_packages
from rockwobble.models.support import RING
from rockwobble.multibody.ring import RingSettings

from ..plans import TendonPlan

# coordinates of a point, by name
RELEASE = ("tan_alpha", "release", "spin")
POINT = ("tan_alpha", "semidiagonal", "intensity")
# names of motions and methods in tables
FREE, EL_CENTRO = "free response", "El Centro 1940"
PERTURBED = "perturbed copy"
HALVED = f"{RING}, half the step"


@dataclass(frozen=True, slots=True, kw_only=True)
class Structure(TendonPlan):
    """Slab and tendon of a column.

    Attributes
    ----------
    tendon_prestress, tendon_stiffness : float
        Prestress and stiffness of a tendon, see `Tendon`; both 0 are none.
    slab_mass_ratio : float
        Mass of a slab that only translates over that of the column under it; 0 is a cylinder alone.
    """

    slab_mass_ratio: float = 0.0

    @property
    def uplift(self) -> float:
        """Horizontal acceleration at uplift over g tan(alpha)."""
        return 1.0 if self.tendon is None else self.tendon.uplift_factor(self.column(REFERENCE_SIZE, 1.0))

    def column(self, semidiagonal: float, tan_alpha: float) -> RockingBody:
        """Cylinder alone, or the frame of one column under the slab."""
        cylinder = Cylinder(semidiagonal=semidiagonal, tan_alpha=tan_alpha)
        return WobblingFrame(cylinder, self.slab_mass_ratio, columns=1) if self.slab_mass_ratio else cylinder


ALONE = Structure()
_RING = RingSettings(ring_inclination=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ring:
    """Walls of a ring; see `RingSettings`.

    Attributes
    ----------
    clearance : float
        [b]
    inclination : float
        [rad]; 0 stands for alpha.
    friction : float
        [-]
    """

    clearance: float = _RING.ring_clearance
    inclination: float = 0.0
    friction: float = _RING.ring_friction


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """Measured points of each part.

    Attributes
    ----------
    name : str
    tan_alphas, releases, spins : tuple of float
        Tan alphas, releases and spins of the maps of free response: slenderness, tilt over alpha, and
        rolling rate over that of steady wobble at the tilt.
    members : int
        Records.
    shaken_tan_alphas, sizes, intensities : tuple of float
        Shaken tan alphas, sizes and intensities of the maps under these records: slenderness, semidiagonal
        [m], and peak resultant over g tan(alpha), as far as an earthquake reaches it: see `LARGEST_PEAK`.
    engine_points : tuple
        (tan(alpha), release, spin) at which engines verify the maps of free response.
    record_points : tuple
        (tan(alpha), semidiagonal, intensity) at which the engine runs under all records in every support.
    record_step : float
        Time step of the engine there [s]; peaks need less than traces.
    slip_points, slip_shares : tuple
        (tan(alpha), release, spin), where friction is lowered until the engine slips; friction over that
        which the recess model needs.
    trace_points, trace_length : tuple, float
        (tan(alpha), semidiagonal, intensity) at which traces are followed, for so long [s].
    ring_tan_alphas, rings, ring_turns, ring_length : tuple of float, tuple of Ring, tuple of float, float
        Slenderness; walls; azimuth by which the problem is turned [rad]; [s].
    contact_tan_alphas, time_constants, dampings : tuple of float
        Contact tan alphas, time constants and dampings of soft contact: slenderness, time constant at R = 6
        m [s], damping ratio.
    structure : Structure, optional
        Structure of every column.
    """

    name: str
    tan_alphas: tuple[float, ...]
    releases: tuple[float, ...]
    spins: tuple[float, ...]
    members: int
    shaken_tan_alphas: tuple[float, ...]
    sizes: tuple[float, ...]
    intensities: tuple[float, ...]
    engine_points: tuple[tuple[float, float, float], ...]
    record_points: tuple[tuple[float, float, float], ...]
    record_step: float
    slip_points: tuple[tuple[float, float, float], ...]
    slip_shares: tuple[float, ...]
    trace_points: tuple[tuple[float, float, float], ...]
    trace_length: float
    ring_tan_alphas: tuple[float, ...]
    rings: tuple[Ring, ...]
    ring_turns: tuple[float, ...]
    ring_length: float
    contact_tan_alphas: tuple[float, ...]
    time_constants: tuple[float, ...]
    dampings: tuple[float, ...]
    structure: Structure = ALONE

    def of(self, structure: Structure) -> Extent:
        """Extent for a structure: a tendon raises the intensities as it raises that of uplift.

        Raises
        ------
        ValueError
            If no shaking of at most `LARGEST_PEAK` is strong enough.
        """
        factor = structure.uplift

        def raised(points: tuple[tuple[float, float, float], ...]) -> tuple[tuple[float, float, float], ...]:
            strong = [(tan_alpha, size, _digits(factor * level)) for tan_alpha, size, level in points]
            return tuple(point for point in strong if point[0] * point[2] <= LARGEST_PEAK)

        records, traces = raised(self.record_points), raised(self.trace_points)
        if not (records and traces):
            raise ValueError(
                f"a tendon must leave shaking of {LARGEST_PEAK:g} g something to rock, got one that raises "
                f"uplift to {factor:.3g} g tan alpha"
            )
        levels = tuple(_digits(factor * level) for level in self.intensities)
        return replace(
            self, structure=structure, intensities=levels, record_points=records, trace_points=traces
        )


def _digits(value: float) -> float:
    """Number rounded to the digits that tables show."""
    return float(f"{value:.3g}")


# largest plausible peak of a record [g]
LARGEST_PEAK = 1.5

QUICK = Extent(
    name="quick",
    tan_alphas=(0.1, 0.2, 0.4, 0.7, 1.0),
    releases=(0.1, 0.3, 0.5, 0.7, 0.9),
    spins=(0.01, 0.05, 0.1, 0.25, 0.5, 0.9),
    members=6,
    shaken_tan_alphas=(0.1, 0.2, 0.4),
    sizes=(2.0, 8.0, 32.0),
    intensities=(1.2, 2.0, 3.0),
    engine_points=((0.1, 0.5, 0.1), (0.2, 0.5, 0.1), (0.4, 0.5, 0.25), (1.0, 0.3, 0.5)),
    record_points=((0.2, 6.0, 2.0),),
    record_step=4e-4,
    slip_points=((0.2, 0.5, 0.25), (0.7, 0.5, 0.25)),
    slip_shares=(0.6, 0.8, 0.9, 0.95, 1.05, 1.2),
    trace_points=((0.1, 10.0, 3.0), (0.2, 6.0, 2.0)),
    trace_length=12.0,
    ring_tan_alphas=(0.2,),
    rings=(Ring(), Ring(clearance=1e-2)),
    ring_turns=(0.0,),
    ring_length=6.0,
    contact_tan_alphas=(0.2,),
    time_constants=(2e-4, 2e-2),
    dampings=(0.1, 1.0),
)

FULL = Extent(
    name="full",
    tan_alphas=(0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0, 1.25),
    releases=(0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95),
    spins=(0.001, 0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9),
    members=22,
    shaken_tan_alphas=(0.1, 0.2, 0.4),
    sizes=(1.0, 2.0, 4.0, 8.0, 16.0, 32.0),
    intensities=(1.1, 1.5, 2.0, 2.5, 3.0, 3.75, 5.0, 7.5),
    engine_points=tuple(
        (tan_alpha, release, spin)
        for tan_alpha in (0.1, 0.2, 0.4, 0.7, 1.0)
        for release, spin in ((0.3, 0.5), (0.5, 0.1), (0.7, 0.25), (0.5, 0.01))
    ),
    record_points=tuple(itertools.product((0.1, 0.2, 0.4), (6.0, 16.0), (2.0, 3.5))),
    record_step=2e-4,
    slip_points=tuple((tan_alpha, 0.5, 0.25) for tan_alpha in (0.1, 0.2, 0.4, 0.7, 1.0)),
    slip_shares=(0.4, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.99, 1.01, 1.05, 1.2),
    trace_points=tuple(
        (tan_alpha, size, intensity)
        for tan_alpha, intensities in ((0.1, (2.0, 3.0)), (0.2, (1.5, 2.0, 3.0)), (0.4, (1.3, 1.6, 2.0)))
        for size in (6.0, 12.0)
        for intensity in intensities
    ),
    trace_length=25.0,
    ring_tan_alphas=(0.1, 0.2, 0.4, 1.0),
    rings=(
        *(Ring(clearance=clearance) for clearance in (1e-4, 1e-3, 1e-2, 5e-2)),
        *(Ring(inclination=inclination) for inclination in (0.3, 0.8)),
        *(Ring(friction=friction) for friction in (0.0, 1.0)),
    ),
    ring_turns=(0.0, 0.1),
    ring_length=10.0,
    contact_tan_alphas=(0.1, 0.2, 0.4),
    time_constants=(2e-4, 2e-3, 1e-2, 2e-2, 5e-2),
    dampings=(0.1, 0.3, 1.0),
)


REFERENCE_SIZE = 6.0  # [m] of free responses: they scale with size (Froude)
GRAVITY = 9.81
AMPLE = 3.0  # friction, so that a squat cylinder uplifts and does not slip
_SYNTHETIC_SEED = 1940


def release_case(
    tan_alpha: float, release: float, spin: float, periods: float = 1.0, *, structure: Structure
) -> Case:
    """Free response.

    Parameters
    ----------
    tan_alpha : float
    release : float
        Tilt over alpha.
    spin : float
        Rolling rate over that of steady wobble at the tilt; below 1 the release is a tilt maximum.
    periods : float, optional
        Length, in times from tilt maximum to next maximum of the recess model.
    structure : Structure
    """
    cylinder, tendon = structure.column(REFERENCE_SIZE, tan_alpha), structure.tendon
    tilt = release * cylinder.alpha
    steady = reduced.steady_wobble_rate(cylinder, tilt, tendon=tendon)
    initial = InitialState(tilt=tilt, rolling_rate=spin * steady)
    period = reduced.free_response(cylinder, initial, tendon=tendon).period
    return Case(cylinder, initial=initial, duration=periods * period, tendon=tendon)


def shaken_case(
    name: str,
    tan_alpha: float,
    semidiagonal: float,
    intensity: float,
    *,
    duration: float | None = None,
    vertical: bool = False,
    turn: float = 0.0,
    structure: Structure = ALONE,
) -> Case:
    """Cylinder or frame at rest under a motion by name.

    Its peak resultant is `intensity` times g tan(alpha), and it is turned by an azimuth [rad].
    """
    motion = motion_named(name)
    if not vertical:
        motion = GroundMotion(motion.acceleration[:, :2], motion.time_step, motion.name)
    motion = motion.scaled(intensity * GRAVITY * tan_alpha / motion.peak)
    length = motion.duration if duration is None else min(duration, motion.duration)
    label = f"{name}, tan α {tan_alpha:g}, R {semidiagonal:g} m, {intensity:g} g tan α"
    return Case(
        structure.column(semidiagonal, tan_alpha),
        motion.rotated(turn) if turn else motion,
        duration=length,
        friction=AMPLE,
        tendon=structure.tendon,
        name=label,
    )


def record_names(members: int) -> list[str]:
    """Names of an ensemble's motions: records where they are installed, else synthetic ones."""
    kind = "synthetic" if missing_packages() else "record"
    return [f"{kind} {number}" for number in range(1, members + 1)]


def source_of(name: str) -> str:
    """Source of the motion of this name and of its group, in words."""
    return "FEMA P-695 far-field records" if name.startswith("record") else "synthetic records"


@cache
def motion_named(name: str) -> GroundMotion:
    """Motion: El Centro with its vertical component, "record n" or "synthetic n" without one."""
    if name == EL_CENTRO:
        return el_centro_1940(vertical=True)
    kind, number = name.rsplit(" ", 1)
    if kind == "record" and not missing_packages():
        return p695_far_field(int(number))
    # separate seeds, so that a larger ensemble begins with the smaller one
    return synthetic_motions(2, peak=1.0, seed=_SYNTHETIC_SEED + int(number))[0]
