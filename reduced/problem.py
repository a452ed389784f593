"""A problem in the form that the compiled time integration takes, and its ground motion in three columns."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass, fields, replace
from functools import cached_property, lru_cache
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockwobble.models import Case, GroundMotion, InitialState
from rockwobble.models.mode import PLANE_TOLERANCE, plane_of, stays_in_plane
from rockwobble.models.number_checks import quoted, require_in_range, require_one_of
from rockwobble.models.support import MODELLED, RECESS, support_named

from . import kernels
from .body import Body, restitution_from_momentum
from .integration.balance import decide
from .integration.result import Driver, IntegrationResult, Options, Task
from .restoring import TERMS, constants_of
from .rolling import impact_ratio

SUPPORTS: tuple[str, ...] = MODELLED
_OUT_OF_PLANE = 1e-9  # [rad] above the rounding of an azimuth

# Tilt (over alpha) below which the base is closed again. A rest discards the direction of the tilt and a
# speed that grows with the root of this tilt. Of 1291 problems (El Centro and FEMA P-695, R from 0.3 to 50 m,
# tan alpha from 0.1 to 0.4) whose peaks at two tolerances agree, the peak differs by more than 2 % from that
# of a hundred times smaller tilt in 10.1, 3.9, 1.4, 0.5, 0.3 and 0.3 % at 1e-5, 1e-6, 1e-7, 1e-8, 1e-9 and
# 1e-10: from 1e-8 on the tolerance decides. The steps grow by a sixth from 1e-5 to 1e-8, and the longest
# chatter from 59 to 251 steps a sample.
REST_TILT = 1e-8
# With energy lost at each impact the impacts accumulate in finite time: some bound is needed.
_LEAST_WITH_LOSS = 1e-9
# Steps allowed before a run is given up, at least and per record sample or time 1/p: two orders above what a
# record of strong shaking takes. Rocking at the rest threshold without end takes 5e4 in a time 1/p.
_BUDGET, _BUDGET_PER_SAMPLE, _BUDGET_PER_TIME = 500_000, 50, 100_000
# Spin (over p) whose passes are as near to upright as a double can be to zero. A weaker spin turns by the
# same angle, that of vanishing spin, and is solved as this one.
_LEAST_SPIN = 1e-100
LARGEST_REST_TILT = 0.1  # tilt of the rest rule over alpha


def ground_at(case: Case, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the ground acceleration (n, 3) [m/s^2] at `times` (n,) [s]; zero outside record and run."""
    motion = case.motion
    record = three_columns(motion)
    if motion is None:
        return np.zeros((len(times), 3))
    at = np.arange(len(record)) * motion.time_step
    # rounding may place the end of a run beyond the last sample
    inside = times <= min(motion.duration, case.length) * (1.0 + 1e-12)
    return np.column_stack([np.where(inside, np.interp(times, at, column), 0.0) for column in record.T])


@lru_cache(maxsize=4)
def is_spatial(motion: GroundMotion) -> bool:
    """Whether the motion leaves every vertical plane by more than rounding."""
    record = three_columns(motion)
    largest = record[int(np.square(record[:, :2]).sum(axis=1).argmax())]
    return not stays_in_plane(record, math.atan2(largest[1], largest[0]), 1e4 * PLANE_TOLERANCE)


def in_plane(record: NDArray[np.float64], azimuth: float) -> NDArray[np.float64]:
    """Return a record (n, 3) without its component across the vertical plane at `azimuth` [rad]."""
    cosine, sine = math.cos(azimuth), math.sin(azimuth)
    along = record[:, 0] * cosine + record[:, 1] * sine
    return np.column_stack([along * cosine, along * sine, record[:, 2]])


def sample_times(duration: float, sample_step: float) -> NDArray[np.float64]:
    """Multiples of `sample_step` before `duration`, and `duration` itself (n,) [s]."""
    # a multiple within rounding of the end is the end
    count = math.ceil(duration / sample_step * (1.0 - 1e-12))
    times = np.arange(count + 1, dtype=float)
    times *= sample_step
    times[-1] = duration
    return times


# cached for further runs with the same motion: it takes a tenth of the time of a short one
@lru_cache(maxsize=4)
def three_columns(motion: GroundMotion | None) -> NDArray[np.float64]:
    """Return the samples of a motion (n, 3) [m/s^2], zeros where it has no vertical component."""
    if motion is None:
        return np.empty((0, 3))
    record = np.zeros((len(motion.acceleration), 3))
    record[:, : motion.acceleration.shape[1]] = motion.acceleration
    return record


class Plane(NamedTuple):
    """A vertical plane of motion, and the motion in it."""

    azimuth: float  # [rad]
    record: NDArray[np.float64]  # (n, 3): acceleration along the plane, 0, up [m/s^2]


class SetUp(NamedTuple):
    """Inputs of a time integration; independent of the size of a cylinder that starts at rest."""

    integrate: Driver
    task: Task
    azimuth: float  # zero of the angles of the result [rad]


@dataclass(frozen=True, eq=False)
class Problem:
    """One run of a reduced model, solved again for each further quantity; options as of `simulate`.

    Raises
    ------
    ValueError
        If an option is out of range.
    """

    case: Case
    _: KW_ONLY
    support: str = RECESS
    plane: float | None = None
    restitution: float | str = 1.0
    rtol: float = 1e-8
    rest_tilt: float = REST_TILT

    def __post_init__(self) -> None:
        plane, initial = self.plane, self.case.initial
        require_one_of("support", self.support, SUPPORTS)
        require_in_range("rtol", self.rtol, least=1e-13, most=1e-2)
        require_in_range("rest_tilt", self.rest_tilt, least=0.0, most=LARGEST_REST_TILT)
        if plane is not None:
            require_in_range("plane", plane)
        factor = self.restitution
        if not (factor == "momentum" or (isinstance(factor, Real) and 0.0 <= factor <= 1.0)):
            raise ValueError(f"restitution must be from 0 to 1 or 'momentum', got {quoted(factor)}")
        if plane is None and self.rebound != 1.0:
            raise ValueError(f"restitution belongs to planar motion, got {factor!r} without a plane")
        if plane is not None and initial is not None:
            _require_in_plane(initial, plane)
        for term in self.case.terms.keys() - TERMS:
            raise ValueError(f"the reduced models know no {term}, got {self.case.terms[term]!r}")
        if self.slides and self.case.cylinder.slab_mass_ratio:
            body = self.case.cylinder
            raise ValueError(
                f"the sliding model is of a cylinder alone, got a slab on columns, which slide at both ends: "
                f"friction {self.case.friction:g} is below b/h = {body.tan_alpha:g}"
            )
        if self.case.anchor and self.free_twist:
            raise ValueError(
                f"{self.case.anchor} is part of the models in the recess and in a plane, got support "
                f"{self.support!r}: there the base wanders from its anchor"
            )

    def __getstate__(self) -> dict[str, Any]:
        # cached properties are not pickled: compiled code would be compiled again in the other process
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def model(self) -> str:
        """The model that was asked for: planar, recess or flat."""
        return self.support if self.plane is None else "planar"

    @cached_property
    def rebound(self) -> float:
        """Ratio of tilt rates at an impact."""
        if isinstance(self.restitution, str):
            return restitution_from_momentum(self.case.cylinder)
        return float(self.restitution)

    @cached_property
    def body(self) -> Body:
        """The constants of the equations."""
        return constants_of(self.case.cylinder, self.case.gravity, **self.case.terms)

    def solve(
        self,
        times: NDArray[np.float64],
        *,
        record_steps: bool = False,
    ) -> tuple[IntegrationResult, float]:
        """Return the result with states at `times` (n,) [s], and the azimuth its angles count from."""
        integrate, task, azimuth = self._set_up
        # numba would compile the time integration again for a strided column
        task = task._replace(times=np.ascontiguousarray(times))
        with kernels.interrupted_after():
            result = integrate(self.body, self._options._replace(record_steps=record_steps), task)
        return self._decide(result), azimuth

    def shaking(self, factor: float) -> SetUp:
        """Integration of a run from rest under ``motion.scaled(factor)``, for its peak only."""
        motion = self.case.motion
        assert motion is not None
        if self.plane is not None or not is_spatial(motion) or not math.isfinite(factor * self._peak):
            scaled = replace(self, case=replace(self.case, motion=motion.scaled(factor)))
            return scaled._set_up._replace(task=scaled._set_up.task._replace(later=scaled._later))
        # clearly spatial, so that the search for a plane is skipped: a third of the time of a short run
        task = self._set_up.task
        task = task._replace(record=task.record * factor, later=self._later * factor)
        return self._set_up._replace(task=task)

    def solve_under(self, shaking: SetUp) -> IntegrationResult:
        """Result for this body under a motion of another size, for the peak only."""
        with kernels.interrupted_after():
            result = shaking.integrate(self.body, self._options, shaking.task)
        return self._decide(result)

    def _decide(self, result: IntegrationResult) -> IntegrationResult:
        # rolling resistance holds a body that stands on its balance
        return result if self.case.rolling_resistance else decide(self.body, result)

    @property
    def free_twist(self) -> bool:
        """Whether the model has a twist: on flat ground, unless planar by choice."""
        return self.plane is None and not support_named(self.support).guided

    @property
    def slides(self) -> bool:
        """Whether friction decides the mode: from rest on flat ground, below b/h."""
        case = self.case
        return self.free_twist and not case.is_release and case.friction < case.friction_of_uplift

    def is_planar(self) -> bool:
        """Return whether the run stays in one vertical plane."""
        return self._plane is not None

    @cached_property
    def kernel(self) -> str:
        """Name of the compiled model of this problem."""
        model = "planar" if self.is_planar() else self.model
        return f"resisted {model}" if self.case.rolling_resistance > 0.0 else model

    @cached_property
    def _peak(self) -> float:
        motion = self.case.motion
        return 0.0 if motion is None else float(np.abs(motion.acceleration).max())

    @cached_property
    def _options(self) -> Options:
        case, restitution = self.case, self.rebound
        if case.rolling_resistance > 0.0:
            restitution = impact_ratio(self.body, restitution)
        rest_tilt = max(float(self.rest_tilt), _LEAST_WITH_LOSS if restitution < 1.0 else 0.0)
        budget = _BUDGET + _BUDGET_PER_TIME * case.length * self.body.p
        if case.motion is not None:
            budget += _BUDGET_PER_SAMPLE * len(case.motion.acceleration)
        steps = int(min(budget, 2**62))
        return Options(float(self.rtol), rest_tilt, restitution, case.length, steps, record_steps=False)

    @cached_property
    def _set_up(self) -> SetUp:
        """Choose the model that is integrated: motion that stays in one vertical plane is solved as planar.

        Rounding would otherwise choose on which side such motion passes upright.
        """
        motion = self.case.motion
        azimuth, record = self._plane or Plane(0.0, three_columns(motion))
        time_step = 1.0 if motion is None else motion.time_step
        task = Task(record, time_step, self._start(azimuth), np.empty(0), np.empty((0, 2)))
        return SetUp(kernels.INTEGRATORS[self.kernel], task, azimuth)

    @cached_property
    def _later(self) -> NDArray[np.float64]:
        """Largest |a| and least az from each sample on (m, 2) [m/s^2]; none where a fall may stop."""
        record = self._set_up.task.record
        if self.free_twist and not self.is_planar():
            return np.empty((0, 2))
        strongest = np.maximum.accumulate(np.hypot(record[::-1, 0], record[::-1, 1]))[::-1]
        # the ground is still after the record, so az reaches 0
        lightest = np.minimum(np.minimum.accumulate(record[::-1, 2])[::-1], 0.0)
        return np.column_stack([strongest, lightest])

    def _start(self, azimuth: float) -> tuple[float, ...]:
        """State at time zero; psi' = -phi', so neither twist nor twist rate."""
        initial, body, size = self.case.initial, self.body, kernels.SIZES[self.kernel]
        if initial is None or initial.tilt == 0.0:
            return (0.0,) * size
        start = float(initial.tilt), float(initial.tilt_rate)
        if self.is_planar():
            # the angle is the azimuth of the plane or its opposite
            angle = 0.0 if math.cos(initial.rolling_angle - azimuth) >= 0.0 else math.pi
            return (*start, angle, *(0.0,) * (size - 3))
        rate = float(initial.rolling_rate)
        if 0.0 < abs(rate) < _LEAST_SPIN * body.p:
            rate = math.copysign(_LEAST_SPIN * body.p, rate)
        L = float(kernels.momentum_of_release(body, float(initial.tilt), rate))
        return (*start, float(initial.rolling_angle), L, *(0.0,) * (size - 4))

    @cached_property
    def _plane(self) -> Plane | None:
        """Vertical plane that contains the whole motion, if there is one."""
        azimuth = plane_of(self.case) if self.plane is None else float(self.plane)
        if azimuth is None:
            return None
        record = three_columns(self.case.motion)
        x, y = record[:, 0], record[:, 1]
        along = x * math.cos(azimuth) + y * math.sin(azimuth)
        return Plane(azimuth, np.column_stack([along, np.zeros_like(along), record[:, 2]]))


def balance_tilt_of_case(case: Case) -> float:
    """Return the tilt at which the static couple of a case vanishes: alpha without a tendon.

    Parameters
    ----------
    case : Case
        Case of a cylinder or frame, with or without a tendon.

    Returns
    -------
    float
        Balance tilt [rad]; infinite where there is none below pi/2, so that nothing but shaking or spin
        overturns the body.

    Examples
    --------
    >>> from rockwobble.models import Cylinder, Tendon
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> case = Case(pier, duration=1.0, tendon=Tendon(prestress=0.5))
    >>> round(balance_tilt_of_case(case) / pier.alpha, 3)
    1.492
    """
    return float(Problem(case).body.balance)


def _require_in_plane(initial: InitialState, plane: float) -> None:
    if initial.rolling_rate != 0.0:
        raise ValueError(f"planar motion has no rolling_rate, got {initial.rolling_rate!r}")
    if initial.tilt > 0.0 and abs(math.sin(initial.rolling_angle - plane)) > _OUT_OF_PLANE:
        raise ValueError(
            f"the release must lean in the plane {plane:g} rad or opposite to it, got a rolling_angle of "
            f"{initial.rolling_angle:g} rad"
        )
