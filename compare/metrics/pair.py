"""Two motions of one case on one time axis, and their differences: tilt, contact, turning, energy, agreement.

Each near pass of upright may turn one motion to the left and its neighbour to the right, so two
traces of one problem diverge at some time however good both are. What counts is when.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockwobble.models import AGREEMENT, Case, GroundMotion, RockingBody, Trace
from rockwobble.models.bounds import OVERTURNED_TILT
from rockwobble.models.mode import ROCKS_IN_PLANE, SLIDES
from rockwobble.models.shown import CompactRepr

FloatArray = NDArray[np.float64]

# samples are multiples of one step; two that differ by less are the same [s]
_SAME_TIME = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Pair(CompactRepr):
    """A trial compared with a reference, sample by sample.

    The samples are those of the reference, up to the earliest of: the end of either trace, the
    first value that is not finite, and the window that was asked for.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
    start : float
        Uplift or release of the reference [s]; 0 where it never uplifts.
    time : ndarray, shape (n,)
        [s].
    tilt, reference_tilt : ndarray, shape (n,)
        [rad].
    rolling_angle, reference_rolling_angle : ndarray, shape (n,)
        Unwrapped [rad]; NaN at rest.
    contact_point, reference_contact_point : ndarray, shape (n, 2)
        Relative to O [m]; NaN at rest.
    displacement, reference_displacement : ndarray, shape (n, 2)
        Of the base centre over the ground [m].
    slides_by : float
        Peak displacement of a reference that slides and does not rock [m]; 0 of others.
    in_plane : bool
        Whether the reference rocks in one plane: each pass goes through the upright position, on either side.
    """

    cylinder: RockingBody
    start: float
    time: FloatArray
    tilt: FloatArray
    reference_tilt: FloatArray
    rolling_angle: FloatArray
    reference_rolling_angle: FloatArray
    contact_point: FloatArray
    reference_contact_point: FloatArray
    displacement: FloatArray
    reference_displacement: FloatArray
    slides_by: float
    in_plane: bool

    @property
    def tilt_difference(self) -> FloatArray:
        """Trial minus reference, shape (n,), in units of alpha."""
        return (self.tilt - self.reference_tilt) / self.cylinder.alpha

    @property
    def motion_difference(self) -> FloatArray:
        """Difference that ends an agreement, shape (n,).

        Of the tilt in units of alpha; where the reference slides that of the displacement over its peak, if
        it is more.
        """
        tilted = np.abs(self.tilt_difference)
        if not self.slides_by:
            return tilted
        apart = np.linalg.norm(self.displacement - self.reference_displacement, axis=1)
        return np.asarray(np.maximum(tilted, apart / self.slides_by))

    @property
    def end(self) -> float:
        """Time up to which both are compared [s]."""
        return float(self.time[-1])


def make_pair(cylinder: RockingBody, reference: Trace, trial: Trace, *, until: float | None = None) -> Pair:
    """Motions of `trial` and `reference` at the samples of the latter, as far as both reach.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
    reference, trial : Trace
    until : float, optional
        End of the window, in the time of the run [s]. Default: all that both have.

    Returns
    -------
    Pair

    Raises
    ------
    ValueError
        If `until` leaves no sample, or a trace has none.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = rw.Case(pier, initial=release, duration=4.0)
    >>> pair = make_pair(pier, rw.simulate(case), rw.simulate(case, support="flat"))
    >>> pair.time.shape == pair.tilt.shape == pair.reference_tilt.shape
    True
    """
    end = min(_finite_end(reference), _finite_end(trial))
    if until is not None:
        end = min(end, until)
    keep = int(np.searchsorted(reference.time, end + _SAME_TIME, side="right"))
    if keep == 0:
        raise ValueError(f"there must be at least one sample to compare, got none up to {end:g} s")
    time = reference.time[:keep]
    fields: dict[str, FloatArray] = {}
    for name in ("tilt", "rolling_angle", "contact_point", "displacement"):
        fields[name] = _resample(trial.time, getattr(trial, name), time)
        fields[f"reference_{name}"] = getattr(reference, name)[:keep]
    slides_by = reference.peak_displacement if reference.mode == SLIDES else 0.0
    return Pair(
        cylinder=cylinder,
        start=start_of(reference),
        time=time,
        slides_by=slides_by,
        in_plane=reference.mode == ROCKS_IN_PLANE,
        **fields,
    )


def start_of(trace: Trace) -> float:
    """Uplift or release of a trace, or the start of its slide [s]; 0 without any."""
    if trace.mode == SLIDES:
        return float(trace.time[max(int((trace.displacement != 0.0).any(axis=1).argmax()) - 1, 0)])
    return trace.uplift_time if math.isfinite(trace.uplift_time) else 0.0


def _finite_end(trace: Trace) -> float:
    """Time of the last sample before the first tilt that is not a number [s]."""
    bad = np.flatnonzero(~np.isfinite(trace.tilt))
    count = int(bad[0]) if len(bad) else len(trace.tilt)
    return float(trace.time[count - 1]) if count else -math.inf


def _resample(times: FloatArray, values: FloatArray, time: FloatArray) -> FloatArray:
    """Values at the times `times` interpolated linearly to those of `time`."""
    count = len(time)
    if len(times) >= count and bool(np.all(np.abs(times[:count] - time) < _SAME_TIME)):
        return values[:count]
    if values.ndim == 1:
        return np.interp(time, times, values)
    return np.column_stack([np.interp(time, times, column) for column in values.T])


def overturned(peak_tilts: ArrayLike) -> NDArray[np.bool_]:
    """Mask of the runs of a reduced model that overturned, by peak tilt [rad]; False for failed runs.

    The models decide, also where a run ends in the middle of a fall, and then give pi/2 and no less.
    """
    return np.asarray(peak_tilts, dtype=np.float64) >= OVERTURNED_TILT


def beyond_yield(peak_tilts: ArrayLike, case: Case) -> NDArray[np.bool_]:
    """Mask of the runs, by peak tilt [rad], in which the tendon yields: an elastic model has no answer.

    Where it yields only beyond the balance, a run that overturns does so before.
    """
    tilts = np.asarray(peak_tilts, dtype=np.float64)
    limit = math.inf if case.tendon is None else case.tendon.yield_tilt(case.cylinder)
    if math.isinf(limit):
        return np.zeros(tilts.shape, dtype=bool)
    decided = overturned(tilts) & (limit >= balance_of(case))
    return (tilts > limit) & ~decided


def outcome_of_peak(peak: float) -> str:
    """Outcome of a run of a reduced model by its peak tilt [rad], NaN where it failed."""
    return "failed" if math.isnan(peak) else "overturned" if overturned(peak) else "stands"


def balance_of(case: Case) -> float:
    """Balance tilt of a case, at most pi/2 [rad]; alpha where no term of it moves the balance."""
    from rockwobble import reduced

    return min(reduced.balance_tilt_of_case(case), OVERTURNED_TILT)


def outcome_of(trace: Trace) -> str:
    """Outcome of a run for a study; rest on a wall beyond balance counts as overturned.

    One that leans on a wall beyond its balance at the end of its run counts as overturned: after it the
    ground is still, as where a fall is decided.
    """
    leans = trace.run.support.walls and len(trace.tilt) and trace.tilt[-1] > balance_of(trace.case)
    return "overturned" if leans and trace.outcome != "failed" else trace.outcome


def rms(values: NDArray[np.float64]) -> float:
    """Return the root mean square of values (n,); NaN of none."""
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else math.nan


def tilt_rms(pair: Pair) -> float:
    """Root mean square of the tilt difference over all samples, in units of alpha."""
    return rms(pair.tilt_difference)


def tilt_rms_relative(pair: Pair) -> float:
    """RMS(difference)/RMS(tilt of the reference); NaN where the reference never tilts."""
    scale = rms(pair.reference_tilt) / pair.cylinder.alpha
    return tilt_rms(pair) / scale if scale > 0.0 else math.nan


# share of the reference peak below which a contact point is too poorly defined to compare
TILTED = 0.05


def _well_tilted(pair: Pair) -> NDArray[np.bool_]:
    """Samples in which both tilts exceed 5 % of the reference's peak (n,).

    Nearer to upright the whole base is close to the ground, and where the rim touches says nothing.
    """
    least = TILTED * float(pair.reference_tilt.max())
    return (pair.tilt > least) & (pair.reference_tilt > least)


def _contact_difference(pair: Pair) -> FloatArray:
    """Distance of the two contact points (n,) [b]; NaN where a rim does not carry."""
    distance = np.linalg.norm(pair.contact_point - pair.reference_contact_point, axis=1)
    return np.asarray(distance / pair.cylinder.base_radius)


def contact_rms(pair: Pair) -> float:
    """RMS of the contact-point difference where both are well tilted [b]; NaN where they never are."""
    distance = _contact_difference(pair)
    return rms(distance[_well_tilted(pair) & np.isfinite(distance)])


_HALF_A_TURN = 1e-9  # [rad] rounding of half a turn: motion with spin takes longer than a sample for it


def direction_difference(reference: Trace, trial: Trace) -> float:
    """Difference of the directions of uplift or release, in (-pi, pi] [rad]."""
    return -math.remainder(reference.uplift_direction - trial.uplift_direction, 2.0 * math.pi)


def turn_difference(pair: Pair, *, until: float, direction_difference: float = 0.0) -> float:
    """Difference of the angles rolled by the contact points at `until`; `largest_differences`: the largest.

    Rolling angles are unwrapped from uplift on, so their difference counts the turns that one
    motion made more than the other since then. Only the whole turn by which the two started apart
    is taken off: an azimuth is known up to that.

    Parameters
    ----------
    pair : Pair
    until : float
        Time of the run [s]; the last sample at which both are tilted counts.
    direction_difference : float, optional
        Difference of the directions at uplift, in (-pi, pi] [rad].

    Returns
    -------
    float
        Trial minus reference [rad]; NaN where they are never tilted at the same time.
    """
    difference = _turn_difference(pair, direction_difference)
    both = np.flatnonzero(np.isfinite(difference) & (pair.time <= until))
    return float(difference[both[-1]]) if len(both) else math.nan


def _turn_difference(pair: Pair, direction_difference: float) -> FloatArray:
    """Trial minus reference (n,) [rad], without the whole turns between their starts.

    In one plane the side of each pass is chance, so that no whole turn counts.
    """
    difference = pair.rolling_angle - pair.reference_rolling_angle
    if pair.in_plane:
        known = direction_difference if math.isfinite(direction_difference) else 0.0
        return np.asarray(difference - 2.0 * math.pi * np.round((difference - known) / (2.0 * math.pi)))
    both = np.flatnonzero(np.isfinite(difference))
    if not len(both):
        return difference
    offset = float(difference[both[0]]) - (
        direction_difference if math.isfinite(direction_difference) else 0.0
    )
    return np.asarray(difference - 2.0 * math.pi * round(offset / (2.0 * math.pi)))


def largest_differences(
    pair: Pair, agreement: Agreement, *, unresolved: float, direction_difference: float = 0.0
) -> tuple[float, ...]:
    """Largest differences of tilt [alpha], contact point [b] and angle of turn [rad] within an agreement.

    Parameters
    ----------
    pair : Pair
    agreement : Agreement
    unresolved : float
        First pass that leaves the side to chance [s]: after it angles of turn are known up to whole turns.
    direction_difference : float, optional
        As of `turn_difference`.

    Returns
    -------
    tuple of float
        The three; NaN where there is no sample: contact point and angle of turn count where both are well
        tilted, as in `contact_rms`.
    """
    within = pair.time < agreement.end - _SAME_TIME if agreement.diverged else pair.time <= agreement.end
    tilted = within & _well_tilted(pair)
    turn = _turn_difference(pair, direction_difference)
    by_chance = (pair.time > unresolved) & np.isfinite(turn)
    turn[by_chance] -= 2.0 * math.pi * np.round(turn[by_chance] / (2.0 * math.pi))
    parts = (
        np.abs(pair.tilt_difference)[within],
        _contact_difference(pair)[tilted],
        np.abs(turn)[tilted],
    )
    return tuple(float(np.nanmax(part)) if np.isfinite(part).any() else math.nan for part in parts)


def first_unresolved_pass(trial: Trace, *, start: float = 0.0) -> float:
    """Time of the engine's first pass below its contact resolution [s]; inf if none.

    Passes before `start`, the uplift of the reference, are those of a base that settles in its contact.
    """
    passes = trial.passes
    if "resolved" not in passes:
        return math.inf
    times = np.asarray(passes["time"], dtype=np.float64)
    counts = ~np.asarray(passes["resolved"], dtype=bool) & (times > start)
    return float(times[counts][0]) if counts.any() else math.inf


def landings(response: Trace) -> FloatArray:
    """Times at which a reduced model passes exactly upright (n,) [s], to a sample.

    Its contact then jumps to the other end of the diameter. A fall that follows makes no pass of it.
    """
    turned = np.abs(np.diff(response.rolling_angle))
    return np.asarray(response.time)[1:][np.abs(turned - np.pi) < _HALF_A_TURN]


# share of the peak tilt: motions below 1 % of alpha would always agree within that
PEAK_SHARE = 0.1
# least change of a tilt in tolerances: half of a small peak; less is known to a fifth at best
TESTING = 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """The length of an agreement.

    Parameters
    ----------
    length : float
        From uplift or release to the divergence [s]; the length of the run where there is none.
    end : float
        The same in the time of the run [s].
    diverged : bool
        Whether there was a divergence.
    tested : bool
        Whether the tilt of the reference changes within it by more than `TESTING` tolerances; where it
        changes by less, anything that moves as little agrees.
    """

    length: float
    end: float
    diverged: bool
    tested: bool


def tolerance_of(reference: Trace, trial: Trace | None = None) -> float:
    """Smaller of 1 % of alpha and a tenth of the peak tilt [alpha].

    The peak is that of the reference, or of the trial where the reference stays at rest.
    """
    if reference.mode == SLIDES:
        return AGREEMENT  # as a share of the peak displacement
    for trace in (reference, trial):
        if trace is not None and math.isfinite(trace.uplift_time) and trace.peak_tilt > 0.0:
            return min(AGREEMENT, PEAK_SHARE * trace.peak_tilt / trace.case.cylinder.alpha)
    return AGREEMENT


def agreement_time(
    pair: Pair, *, tolerance: float = AGREEMENT, broken: bool = False, allowance: float = 0.0
) -> Agreement:
    """Time from uplift, release or slide to the first difference above a tolerance.

    See `Pair.motion_difference`.

    Parameters
    ----------
    pair : Pair
    tolerance : float, optional
        [alpha]
    broken : bool, optional
        Whether one of the two traces is broken off by a failure: agreement ends with it at the latest.
    allowance : float, optional
        For the noise of a measurement, added to the tolerance [alpha].
    """
    beyond = np.flatnonzero(pair.motion_difference > tolerance + allowance)
    count = int(beyond[0]) if len(beyond) else len(pair.time)
    end = float(pair.time[count]) if len(beyond) else pair.end
    diverged = broken or len(beyond) > 0
    moved = pair.reference_tilt[:count] / pair.cylinder.alpha
    if pair.slides_by:
        moved = np.hypot(*pair.reference_displacement[:count].T) / pair.slides_by
    return Agreement(
        # a trial that moves before the reference uplifts has no agreement at all
        length=max(0.0, end - pair.start) if diverged else end,
        end=end,
        diverged=diverged,
        tested=count > 0 and float(np.ptp(moved)) > TESTING * tolerance,
    )


def agreement_of(
    reference: Trace, trial: Trace, *, until: float | None = None, tolerance: float = AGREEMENT
) -> Agreement:
    """Agreement of two traces of one case, see `make_pair` and `agreement_time`."""
    return agreement_time(
        make_pair(reference.case.cylinder, reference, trial, until=until), tolerance=tolerance
    )


def displacement_difference(pair: Pair) -> float:
    """Largest distance of the base centres over the peak of the slide; NaN of other references."""
    if not pair.slides_by:
        return math.nan
    return float(
        np.linalg.norm(pair.displacement - pair.reference_displacement, axis=1).max() / pair.slides_by
    )


def agreed_passes(reference: Trace, agreement: Agreement) -> int:
    """Number of passes of the reference within the agreement time."""
    times = np.asarray(reference.passes["time"], dtype=np.float64)
    return int(np.count_nonzero(times <= agreement.end))


def closest_pass(reference: Trace, agreement: Agreement) -> float:
    """Smallest minimum tilt of the passes within the agreement [rad]; NaN without a pass."""
    minima = np.asarray(reference.passes["minimum_tilt"], dtype=np.float64)[
        : agreed_passes(reference, agreement)
    ]
    return float(minima.min()) if len(minima) else math.nan


def energy_loss(trace: Trace, motion: GroundMotion | None) -> float:
    """Energy lost over the run, relative to the largest energy reached.

    In the frame of the ground the excitation is the body force -m a, so what was lost is the energy
    at the start, plus the work of that force, minus the energy at the end.

    Returns
    -------
    float
        Dimensionless, negative where energy was gained; 0 where there was never any; NaN for a
        trace with an energy that is not finite.
    """
    energy = trace.energy
    if not (len(energy) and bool(np.isfinite(energy).all())):
        return math.nan
    largest = float(energy.max())
    if largest <= 0.0:
        return 0.0
    work = 0.0 if motion is None else _work(motion, trace.time, trace.centre_of_mass)
    return (float(energy[0]) + work - float(energy[-1])) / largest


def _work(motion: GroundMotion, time: FloatArray, place: FloatArray) -> float:
    """Work of -a along the path of the centre of mass, per unit mass [m^2/s^2].

    Between two samples the mean acceleration is exact; its slope meets the change of velocity,
    which adds (a1 - a0)(v1 - v0) h/12.
    """
    if len(time) < 2:
        return 0.0
    work = 0.0
    step = np.diff(time)
    for axis, samples in enumerate(motion.acceleration.T):
        a, mean = _sampled_and_mean(samples, motion.time_step, time)
        velocity = np.gradient(place[:, axis], time)
        work -= float((mean * np.diff(place[:, axis])).sum())
        work -= float((np.diff(a) * np.diff(velocity) * step).sum()) / 12.0
    return work


def _sampled_and_mean(
    samples: FloatArray, time_step: float, time: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Acceleration at the times `time`, and its exact mean between each two of them [m/s^2]."""
    # linear between samples, zero after the last: one more knot at the jump
    times = np.arange(len(samples)) * time_step
    times = np.append(times, np.nextafter(times[-1], math.inf))
    values = np.append(samples, 0.0)
    knots = np.union1d(times, time)
    at_knots = np.interp(knots, times, values)
    impulse = np.concatenate([[0.0], np.cumsum(0.5 * (at_knots[1:] + at_knots[:-1]) * np.diff(knots))])
    mean = np.diff(np.interp(time, knots, impulse)) / np.diff(time)
    return np.interp(time, times, values), mean
