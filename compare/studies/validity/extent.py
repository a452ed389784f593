"""How far and how finely the limits are mapped: a quick look, and the full report."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """The points at which each part measures.

    Attributes
    ----------
    name : str
    tan_alphas, releases, spins : tuple of float
        Of the maps of free response: slenderness, tilt over alpha, and rolling rate over that of steady
        wobble at the tilt.
    sizes, intensities : tuple of float
        Of the maps under shaking: semidiagonal [m], and peak resultant over g tan(alpha).
    shaken_tan_alphas : tuple of float
    motions : tuple of str
        Of the maps under shaking, by name; the first has a vertical component.
    engine_points : tuple
        (tan(alpha), release, spin) at which engines verify the maps of free response.
    slip_points : tuple
        The same, where friction is lowered until the engine slips.
    slip_shares : tuple of float
        Friction over that which the recess model needs.
    trace_points : tuple
        (tan(alpha), semidiagonal, intensity) at which traces are followed.
    trace_length : float
        [s]
    ring_tan_alphas, ring_clearances, ring_inclinations, ring_turns : tuple of float
        Clearance [b]; inclination [rad], 0 for alpha; azimuth by which the problem is turned [rad].
    ring_length : float
        [s]
    contacts : tuple
        (time constant of contact at R = 6 m [s], damping ratio).
    contact_tan_alphas : tuple of float
    members : int
        Records of the ensemble.
    levels : tuple of float
        Their peak resultant over g tan(alpha).
    member_step : float
        Time step of the engine there [s]; distributions need less than traces.
    """

    name: str
    tan_alphas: tuple[float, ...]
    releases: tuple[float, ...]
    spins: tuple[float, ...]
    sizes: tuple[float, ...]
    intensities: tuple[float, ...]
    shaken_tan_alphas: tuple[float, ...]
    motions: tuple[str, ...]
    engine_points: tuple[tuple[float, float, float], ...]
    slip_points: tuple[tuple[float, float, float], ...]
    slip_shares: tuple[float, ...]
    trace_points: tuple[tuple[float, float, float], ...]
    trace_length: float
    ring_tan_alphas: tuple[float, ...]
    ring_clearances: tuple[float, ...]
    ring_inclinations: tuple[float, ...]
    ring_turns: tuple[float, ...]
    ring_length: float
    contacts: tuple[tuple[float, float], ...]
    contact_tan_alphas: tuple[float, ...]
    members: int
    levels: tuple[float, ...]
    member_step: float


QUICK = Extent(
    name="quick",
    tan_alphas=(0.1, 0.2, 0.4, 0.7, 1.0),
    releases=(0.1, 0.3, 0.5, 0.7, 0.9),
    spins=(0.01, 0.05, 0.1, 0.25, 0.5, 0.9),
    sizes=(1.0, 2.0, 4.0, 8.0, 16.0, 32.0),
    intensities=(1.2, 1.5, 2.0, 3.0, 4.0, 6.0),
    shaken_tan_alphas=(0.1, 0.2, 0.4, 0.7),
    motions=("El Centro 1940",),
    engine_points=((0.1, 0.5, 0.1), (0.2, 0.5, 0.1), (0.4, 0.5, 0.25), (1.0, 0.3, 0.5)),
    slip_points=((0.2, 0.5, 0.25), (0.7, 0.5, 0.25)),
    slip_shares=(0.6, 0.8, 0.9, 0.95, 1.05, 1.2),
    trace_points=((0.1, 10.0, 3.0), (0.2, 6.0, 2.0), (0.4, 6.0, 1.5)),
    trace_length=15.0,
    ring_tan_alphas=(0.2, 0.7),
    ring_clearances=(1e-3, 1e-2),
    ring_inclinations=(0.0,),
    ring_turns=(0.0,),
    ring_length=8.0,
    contacts=((2e-4, 1.0), (2e-3, 1.0), (2e-2, 1.0), (2e-2, 0.1)),
    contact_tan_alphas=(0.2,),
    members=8,
    levels=(2.0,),
    member_step=2e-4,
)

FULL = Extent(
    name="full",
    tan_alphas=(0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0, 1.25),
    releases=(0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95),
    spins=(0.001, 0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9),
    sizes=(0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0),
    intensities=(1.05, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0),
    shaken_tan_alphas=(0.1, 0.2, 0.3, 0.4, 0.7, 1.0),
    motions=("El Centro 1940", "record 1", "record 2", "record 3"),
    engine_points=tuple(
        (tan_alpha, release, spin)
        for tan_alpha in (0.1, 0.2, 0.4, 0.7, 1.0)
        for release, spin in ((0.3, 0.5), (0.5, 0.1), (0.7, 0.25), (0.5, 0.01))
    ),
    slip_points=tuple((tan_alpha, 0.5, 0.25) for tan_alpha in (0.1, 0.2, 0.4, 0.7, 1.0)),
    slip_shares=(0.4, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.99, 1.01, 1.05, 1.2),
    trace_points=tuple(
        (tan_alpha, size, intensity)
        for tan_alpha, intensities in ((0.1, (2.0, 3.0)), (0.2, (1.5, 2.0, 3.0)), (0.4, (1.3, 1.6, 2.0)))
        for size in (6.0, 12.0)
        for intensity in intensities
    ),
    trace_length=25.0,
    ring_tan_alphas=(0.1, 0.2, 0.4, 0.7, 1.0),
    ring_clearances=(1e-4, 1e-3, 1e-2, 5e-2),
    ring_inclinations=(0.0, 0.8),
    ring_turns=(0.0, 0.1),
    ring_length=12.0,
    contacts=(
        (2e-4, 1.0),
        (1e-3, 1.0),
        (2e-3, 1.0),
        (1e-2, 1.0),
        (2e-2, 1.0),
        (5e-2, 1.0),
        (2e-2, 0.3),
        (2e-2, 0.1),
        (5e-2, 0.1),
    ),
    contact_tan_alphas=(0.1, 0.2, 0.4),
    members=22,
    levels=(2.0, 3.5),
    member_step=2e-4,
)
