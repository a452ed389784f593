"""Motion of one cylinder, or of one column of a frame, computed or measured."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from . import plain_json, trace_file
from .bounds import AGREEMENT, CLOSED_TILT
from .case import Case, Run
from .diagnostic import Assumptions, Diagnostic, cell_of
from .mode import REST, ROCKS, ROCKS_AND_SLIDES, ROCKS_IN_PLANE, SLIDES
from .shown import Shown, line
from .trace_file import Array, EagerSource, Source, friction_of, no_passes

if TYPE_CHECKING:
    import pandas as pd

# slip, and displacement with a closed base, over b: more than the creep of an engine's contact
_SLIP, _CREEP = 0.01, 1e-3
NO_PEAK = ("failed", "undecided")  # outcomes of runs that neither stand nor overturn for certain


class LazySample:
    """Sampled quantity that its source computes on first use."""

    def __init__(self, width: int) -> None:
        self._width = width

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, trace: None, owner: type) -> LazySample: ...
    @overload
    def __get__(self, trace: Trace, owner: type) -> Array: ...
    def __get__(self, trace: Trace | None, owner: type) -> Array | LazySample:
        if trace is None:
            return self
        array = trace.late.get(self._name)
        count = len(trace.time)
        return (
            np.full(count if self._width == 1 else (count, self._width), math.nan) if array is None else array
        )


T = TypeVar("T")


class Deferred(Generic[T]):
    """Field given as a value, or as a function that computes it on first use.

    A NaN is computed from the trace `otherwise`.
    """

    def __init__(self, default: Any = None, otherwise: Callable[[Any], T] | None = None) -> None:
        self._default, self._otherwise = default, otherwise

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __set__(self, trace: Trace, value: T | Callable[[], T]) -> None:
        trace.__dict__[self._name] = value

    def __get__(self, trace: Trace | None, owner: type) -> T:
        if trace is None:
            if self._default is None:  # a field without a default
                raise AttributeError(self._name)
            return self._default  # type: ignore[no-any-return]
        value = trace.__dict__[self._name]
        if callable(value):
            value = trace.__dict__[self._name] = value()
        elif self._otherwise is not None and math.isnan(value):
            value = trace.__dict__[self._name] = self._otherwise(trace)
        return value  # type: ignore[no-any-return]


def _largest_displacement(trace: Trace) -> float:
    away = np.hypot(*trace.displacement.T)
    return math.nan if trace.outcome in NO_PEAK or not len(away) else float(away.max())


def _last_displacement(trace: Trace) -> float:
    return float(np.hypot(*trace.displacement[-1])) if len(trace.time) else math.nan


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Trace(Shown):
    """Motion of one cylinder at n samples; positions are relative to O, which moves with the ground.

    In a frame it is that of each of its columns.

    What a source does not know is NaN.

    Attributes
    ----------
    case : Case
    run : Run
        The method: an engine, or None for a reduced model; support and settings.
    version : str
        Version of the engine, or of rockwobble for a reduced model.
    time : ndarray, shape (n,)
        Multiples of the sample step and the exact end [s]; the end of a fall may be later than the run.
    tilt, tilt_rate : ndarray, shape (n,)
        theta >= 0 [rad], theta' [rad/s].
    rolling_angle, rolling_rate : ndarray, shape (n,)
        phi, azimuth of the contact point, unwrapped [rad], NaN at rest; phi' [rad/s], 0 at rest.
    twist : ndarray, shape (n,)
        phi + psi, turn of the body about its axis, unwrapped [rad].
    contact_point : ndarray, shape (n, 2)
        On the ground [m]; NaN at rest.
    centre_of_mass : ndarray, shape (n, 3)
        [m]
    energy : ndarray, shape (n,)
        Relative to the ground, per unit mass, zero standing [m^2/s^2]; in a frame per unit of the mass of a
        column and twice its share of the slab, which rises twice as far.
    contact_force : ndarray, shape (n, 3)
        Contact force of the ground, and of walls, on the cylinder, in weights, world axes; in a frame the
        weight of a column and its share of the slab.
    top_contact_force : ndarray, shape (n, 3)
        In a frame with a slab, of a column on the slab, in weights of its share of the slab, world axes.
    displacement : ndarray, shape (n, 2)
        Of the base centre over the ground [m].
    mode : str
        "rest", "slides", "rocks", "rocks in one plane" or "rocks and slides"; "" where that is not known.
    friction_needed, top_friction_needed : ndarray, shape (n,)
        Horizontal over normal force at the base, and at the top of a column of a frame [-]; inf where the
        normal force is not positive.
    slab_displacement : ndarray, shape (n, 3)
        In a frame, of the slab from where it stood, relative to the ground [m].
    open_base : ndarray, shape (n,)
        Where demands on ground and recess are taken [bool]: in motion, from a tilt of `CLOSED_TILT` alpha on.
        Force, friction demand and moment of the other samples are those of a rigid edge as well.
    elongation, tendon_force : ndarray, shape (n,)
        Elongation of a tendon since rest [m], and its tension over the weight of one
        column [-].
    peak_tendon_force : float
        Largest tension of the continuous motion over the same [-].
    restraining_moment : ndarray, shape (n,)
        Kappa of the moment kappa (z_world + z_body) that the recess supplies, over the weight [m]; about the
        vertical, as about the axis, that is 1 + cos(tilt) times kappa.
    energy_lost : ndarray, shape (n,)
        Energy that rolling resistance and impacts took so far, per unit mass [m^2/s^2]; of an engine what
        its couple took by its law, from the load and the turning of each step.
    energy_error : ndarray, shape (n,)
        Energy that neither the start nor the excitation supplied, nor rolling resistance took [m^2/s^2].
    slip, wall_contact, wall_impulse : ndarray, shape (n,)
        Distance slipped so far [m], time in contact with walls so far [s], size of the force of the walls
        summed over time so far, per unit mass [m/s].
    peak_tilt : float
        Largest tilt of the continuous motion that the record causes [rad], a swing that goes on when the run
        ends included; pi/2 if overturned, NaN if failed or undecided.
    outcome : {"stands", "overturned", "undecided", "failed"}
        Undecided is what stays on its balance, where rounding decides whether it falls.
    rests : bool
        Whether it stands still at the end.
    followed_until : float
        When the tilt of one that moves at the end of the run was at its next maximum, or it came to rest or
        overturned, over still ground [s]: of that time only the peak is kept, and all of an overturning. NaN
        if there was nothing to follow: it stands still, or has had a maximum since the ground keeps still.
    facts, diagnostics : tuple of Diagnostic
        What ended or limits the motion; the latter with breaches of the model's assumptions.
    uplift_time, uplift_direction : float
        First uplift [s] and rolling angle there [rad]; 0 and that of the start for a release, NaN without.
    passes : DataFrame
        Tilt minima between two maxima of one motion: time [s], minimum_tilt [rad], angle_of_turn [rad] from
        maximum to maximum, resolved [bool].
    rest_intervals : ndarray, shape (r, 2)
        When it came to rest after it had moved, and when it uplifted again; NaN if it did not [s].
    extrema : ndarray, shape (k, 4)
        Turning points of the tilt: time [s], tilt [rad], rolling angle [rad], 1 for a maximum and -1 for
        a minimum.
    settings : mapping
        Every setting of the method, given or default.
    time_step : float
        Time step of the engine, or between samples of a file [s].
    wall_time : float
        Computing time without compilation [s].
    step_count : int
        Steps tried; 0 where that is not known.
    contact_resolution : float
        Smallest minimum tilt of a pass that the engine resolves [rad]: by which contact gives, or by which
        the tilt changes in a few time steps where it is fastest, whichever is more.
    peak_displacement, residual_displacement : float
        Horizontal distance of the base centre from O: the largest, and that at the end [m].
    error_estimate, settled_until : float
        Error of the tilt that the time step leaves [rad], and until when traces of successive steps agree
        [s]; NaN unless the step was sought, the error also where it cannot be known, as of an unsettled run.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> trace = rw.simulate(rw.Case(pier, rw.el_centro_1940(), duration=15.0))
    >>> trace.outcome, round(trace.peak_tilt / pier.alpha, 4), len(trace.passes)
    ('stands', 0.2471, 18)
    >>> trace.tilt.shape, trace.contact_point.shape
    ((1501,), (1501, 2))
    """

    case: Case
    run: Run
    version: str
    time: Array
    tilt: Array
    tilt_rate: Array
    rolling_angle: Array
    twist: Array
    contact_point: Deferred[Array] = Deferred()
    centre_of_mass: Deferred[Array] = Deferred()
    peak_tilt: float
    outcome: str
    uplift_time: float
    uplift_direction: float
    source: Source
    passes: Deferred[pd.DataFrame] = Deferred(no_passes)
    facts: tuple[Diagnostic, ...] = ()
    rests: bool = False
    followed_until: float = math.nan
    rest_intervals: Array = field(default_factory=lambda: np.empty((0, 2)))
    extrema: Array = field(default_factory=lambda: np.empty((0, 4)))
    settings: plain_json.Facts = field(default_factory=dict)
    time_step: float = math.nan
    wall_time: float = math.nan
    step_count: int = 0
    contact_resolution: float = math.nan
    peak_displacement: Deferred[float] = Deferred(math.nan, _largest_displacement)
    residual_displacement: Deferred[float] = Deferred(math.nan, _last_displacement)
    error_estimate: float = math.nan
    settled_until: float = math.nan

    rolling_rate = LazySample(1)
    energy = LazySample(1)
    contact_force = LazySample(3)
    top_contact_force = LazySample(3)
    restraining_moment = LazySample(1)
    energy_lost = LazySample(1)
    energy_error = LazySample(1)
    slip = LazySample(1)
    wall_contact = LazySample(1)
    wall_impulse = LazySample(1)

    @property
    def displacement(self) -> Array:
        """Displacement of the base centre over the ground (n, 2) [m]: measured, or by (8) from the mass."""
        measured = None if self.run.is_model else self.late.get("displacement")
        if measured is not None:
            return measured
        angle = np.where(np.isnan(self.rolling_angle), 0.0, self.rolling_angle)
        lean = np.sin(self.tilt) * np.stack([np.cos(angle), np.sin(angle)])
        return np.asarray(self.centre_of_mass[:, :2] - self.case.cylinder.mass_centre_height * lean.T)

    @cached_property
    def mode(self) -> str:
        """Mode of motion; of an engine as far as its contact shows it: see `models.mode`."""
        tilt, body = self.peak_tilt, self.case.cylinder
        if math.isnan(tilt) or not len(self.time):
            return ""
        model, b = self.run.is_model, body.base_radius
        if tilt <= (0.0 if model else CLOSED_TILT * body.alpha):
            return SLIDES if self.peak_displacement > (0.0 if model else _CREEP * b) else REST
        if not model and np.nanmax(self.slip, initial=0.0) > _SLIP * b:
            return ROCKS_AND_SLIDES if tilt >= AGREEMENT * body.alpha else SLIDES
        largest = self.rolling_angle[int(np.where(np.isnan(self.rolling_angle), -1.0, self.tilt).argmax())]
        across = np.nan_to_num(self.tilt * np.abs(np.sin(self.rolling_angle - largest)))
        smallest = 0.0 if model else CLOSED_TILT * body.alpha
        return ROCKS_IN_PLANE if across.max() <= max(AGREEMENT * tilt, smallest) else ROCKS

    @property
    def open_base(self) -> NDArray[np.bool_]:
        """Whether demands are taken at the samples (n,): it moves, and tilts by `CLOSED_TILT` alpha or more.

        Below that tilt the base counts as closed. The edge of a rigid body would go on to pass upright there,
        ever closer, with forces that grow without bound and that no joint feels.
        """
        moves = ~np.isnan(self.rolling_angle)
        return np.asarray(moves & (self.tilt >= CLOSED_TILT * self.case.cylinder.alpha))

    @property
    def friction_needed(self) -> Array:
        """Horizontal over normal force (n,) [-]; inf where the normal force is not positive."""
        return friction_of(self.contact_force)

    @property
    def top_friction_needed(self) -> Array:
        """Horizontal over normal force at the top of a column of a frame (n,) [-], as at its base."""
        return friction_of(self.top_contact_force)

    @property
    def elongation(self) -> Array:
        """Elongation of the tendon (n,) since rest [m]; NaN without one.

        In a recess and in a plane it depends on the tilt alone, n 2 b sin(theta/2) over n gaps; elsewhere
        the base wanders from the anchor, and the source says it.
        """
        known, tendon = self.late.get("elongation"), self.case.tendon
        if known is not None or tendon is None:
            return np.full(len(self.time), math.nan) if known is None else known
        body = self.case.cylinder
        return np.asarray(tendon.gaps(body) * 2.0 * body.base_radius * np.sin(0.5 * self.tilt))

    @property
    def tendon_force(self) -> Array:
        """Tension of the tendon (n,) over the weight of one column [-]; NaN without one."""
        tendon, body = self.case.tendon, self.case.cylinder
        if tendon is None:
            return np.full(len(self.time), math.nan)
        return np.asarray(tendon.prestress + tendon.stiffness * self.elongation / body.base_radius)

    @property
    def peak_tendon_force(self) -> float:
        """Largest tension of the continuous motion over the weight of a column [-]; NaN without one."""
        tendon = self.case.tendon
        if tendon is None:
            return math.nan
        if "elongation" in self.late:
            return float(np.nanmax(self.tendon_force))
        return tendon.tension(self.case.cylinder, self.peak_tilt)

    @property
    def slab_displacement(self) -> Array:
        """Displacement of the slab of a frame relative to the ground (n, 3) [m].

        The top of a column moves with twice the velocity of its mass centre, as long as neither end slips.
        """
        cylinder = self.case.cylinder
        stood = np.array([0.0, 0.0, cylinder.mass_centre_height])
        moves = 2.0 if cylinder.carries_slab else math.nan
        return np.asarray(moves * (self.centre_of_mass - stood))

    @property
    def contact_offset(self) -> Array:
        """Distance of the contact point (n,) outwards of the circle of radius b about O [m]; NaN at rest."""
        x, y = self.contact_point.T
        return np.asarray(np.hypot(x, y) - self.case.cylinder.base_radius)

    @property
    def peak_time(self) -> float:
        """Time of the peak tilt [s], to the sample; after the end if the peak is there."""
        later = self.peak_tilt > self.peak_within_run
        return self.followed_until if later else float(self.time[self.tilt.argmax()])

    @property
    def peak_within_run(self) -> float:
        """Largest tilt while the run lasts, of samples and turning points [rad]."""
        if math.isnan(self.followed_until):
            return self.peak_tilt
        return float(max(self.tilt.max(initial=0.0), self.extrema[:, 1].max(initial=0.0)))

    @property
    def residual_twist(self) -> float:
        """Twist at the end, whole turns included [rad]."""
        return float(self.twist[-1]) if len(self.twist) else math.nan

    @cached_property
    def assumptions(self) -> Assumptions | None:
        """Whether contact and friction held, from extrema of the continuous motion; None if unknown."""
        return self.source.assumptions(math.inf)

    def assumptions_until(self, end: float) -> Assumptions | None:
        """Return whether contact and friction held until the time `end` [s], such as that of a fall.

        A trace that was stored knows it of its whole run alone.
        """
        return self.source.assumptions(end)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Diagnostics that ended or limit the motion, breaches of the model's assumptions included."""
        return self.facts + (self.assumptions.breaches if self.assumptions else ())

    def first(self, *codes: str) -> float:
        """Earliest time at which a diagnostic of these codes holds [s]; infinite if there is none.

        Parameters
        ----------
        *codes : str
            Codes, from `rockwobble.models.diagnostic.CODES`.

        Examples
        --------
        >>> import rockwobble as rw
        >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
        >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
        >>> case = rw.Case(pier, initial=release, duration=4.0)
        >>> rw.simulate(case).first("slip", "friction_needed")
        inf
        """
        return min((fact.time for fact in self.diagnostics if fact.code in codes), default=math.inf)

    def to_frame(self) -> pd.DataFrame:
        """Return the samples as a table, one column for each component, SI units and radians.

        Examples
        --------
        >>> import rockwobble as rw
        >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
        >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
        >>> case = rw.Case(pier, initial=release, duration=4.0)
        >>> list(rw.simulate(case).to_frame().columns[:5])
        ['time', 'tilt', 'tilt_rate', 'rolling_angle', 'rolling_rate']
        """
        import pandas as pd

        vectors = trace_file.VECTORS
        parts = {
            name: part
            for field, names in vectors.items()
            for name, part in zip(names, getattr(self, field).T, strict=True)
        }
        left_out = () if self.case.cylinder.carries_slab else trace_file.OF_FRAMES
        left_out += () if self.case.tendon is not None else trace_file.OF_TENDONS
        return pd.DataFrame(
            {
                name: parts[name] if name in parts else getattr(self, name)
                for name in trace_file.COLUMNS
                if name not in left_out
            }
        )

    def to_plain(self) -> dict[str, object]:
        """Fields without case and samples, for JSON."""
        given = plain_json.fields_of(self)
        for name in ("case", "source", *trace_file.FIELDS):
            del given[name]
        return {**given, "assumptions": self.assumptions, "passes": self.passes.to_dict("list")}

    @classmethod
    def from_plain(cls, facts: plain_json.Facts, samples: pd.DataFrame, case: Case) -> Trace:
        """Rebuild a trace from `to_plain`, `to_frame` and its case."""
        given, names = trace_file.trace_arguments(facts, samples), {field.name for field in fields(cls)}
        return cls(case=case, **{name: value for name, value in given.items() if name in names})

    def save(self, path: str | Path) -> None:
        """Write the motion to a Parquet file, from which `load` returns it with the same bits.

        Parameters
        ----------
        path : str or Path
        """
        Path(path).write_bytes(trace_file.to_parquet(self.to_frame(), self.to_plain(), self.case))

    @classmethod
    def load(cls, path: str | Path) -> Trace:
        """Return the motion that `save` wrote.

        Parameters
        ----------
        path : str or Path

        Returns
        -------
        Trace

        Raises
        ------
        ValueError
            If the file is not one of a trace.
        """
        facts, samples, case = trace_file.from_parquet(path)
        return cls.from_plain(facts, samples, case)

    def summary(self) -> dict[str, str]:
        """Return the main facts in words and numbers, by name."""
        alpha = self.case.cylinder.alpha
        facts = {
            "case": self.case.name or str(self.case),
            "run": str(self.run),
            "outcome": f"{self.outcome} at {self.time[-1]:.4g} s" if len(self.time) else self.outcome,
            "mode": self.mode or "not known",
        }
        if "slides" in self.mode:
            facts["displacement"] = (
                f"{self.peak_displacement:.4g} m, at the end {self.residual_displacement:.4g} m"
            )
        if self.mode != SLIDES:
            facts |= {
                "peak tilt": "not known"
                if math.isnan(self.peak_tilt)
                else f"{self.peak_tilt / alpha:.4g} alpha",
                "uplift": "none" if math.isnan(self.uplift_time) else f"{self.uplift_time:.4g} s",
                "passes": str(len(self.passes)),
            }
        if self.outcome == "stands" and not self.rests:
            facts["outcome"] += ", moving"
            if not math.isnan(self.followed_until):
                facts["outcome"] += f", followed to {self.followed_until:.4g} s"
        if self.facts:
            facts["diagnostics"] = cell_of(fact.code for fact in self.facts)
        return facts

    _main_facts = summary

    def __repr__(self) -> str:
        facts = [f"{name} {value}" for name, value in self.summary().items() if name not in ("case", "run")]
        return line("Trace", [f"{self.run}: {facts[0]}", *facts[1:]])

    @cached_property
    def late(self) -> Mapping[str, Array]:
        """Lazily computed samples that are already evaluated."""
        return self.source.quantities()


def lost_trace(case: Case, run: Run, why: str) -> Trace:
    """Trace of a run without a result, such as one whose process died: no samples, outcome "failed"."""
    none = np.empty(0)
    return Trace(
        case=case,
        run=run,
        version="",
        time=none,
        tilt=none,
        tilt_rate=none,
        rolling_angle=none,
        twist=none,
        contact_point=np.empty((0, 2)),
        centre_of_mass=np.empty((0, 3)),
        peak_tilt=math.nan,
        outcome="failed",
        uplift_time=math.nan,
        uplift_direction=math.nan,
        source=EagerSource({}),
        facts=(Diagnostic(code="died", detail=why),),
    )
