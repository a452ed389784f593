"""Extent and resolution of the maps of the limits: a quick look, and the full report."""

from __future__ import annotations

from dataclasses import dataclass

from rockwobble.multibody.scene.ring_settings import RingSettings

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
    """The points at which each part measures.

    Attributes
    ----------
    name : str
    tan_alphas, releases, spins : tuple of float
        Of the maps of free response: slenderness, tilt over alpha, and rolling rate over that of steady
        wobble at the tilt.
    members : int
        Records.
    shaken_tan_alphas, sizes, intensities : tuple of float
        Of the maps under these records: slenderness, semidiagonal [m], and peak resultant over g tan(alpha),
        as far as an earthquake reaches it: see `LARGEST_PEAK`.
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
        Of soft contact: slenderness, time constant at R = 6 m [s], damping ratio.
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


# of a record: hardly any was ever measured above it [g]
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
    record_points=tuple(
        (tan_alpha, size, intensity)
        for tan_alpha in (0.1, 0.2, 0.4)
        for size in (6.0, 16.0)
        for intensity in (2.0, 3.5)
    ),
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
