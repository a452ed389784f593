"""The problem and the method, apart: a case is stated once for every model and engine."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from functools import partial
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from .argument_kinds import with_argument_kinds
from .bounds import OVERTURNED_TILT, Bounds
from .cylinder import RockingBody
from .ground_motion import GroundMotion
from .number_checks import quoted, require_finite, require_not_negative, require_positive
from .shown import CompactRepr, brief, line
from .support import EXTERNAL, FLAT, MODELLED, RECESS, Support, support_named
from .tendon import Tendon

MOST_RESISTANCE = 0.1  # largest length of rolling resistance over the base radius
_UNITS = {"tilt": "rad", "tilt_rate": "rad/s", "rolling_angle": "rad", "rolling_rate": "rad/s"}


@dataclass(frozen=True, slots=True, repr=False)
class InitialState(CompactRepr):
    """Tilt, rolling angle and their rates at time zero; psi' = -phi' in every model and engine.

    Parameters
    ----------
    tilt : float
        theta, angle of the axis from the vertical [rad], 0 <= theta < pi/2.
    tilt_rate : float, optional
        theta' [rad/s].
    rolling_angle : float, optional
        phi, azimuth of the contact point seen from the centre of the base circle [rad].
    rolling_rate : float, optional
        phi' [rad/s].

    Raises
    ------
    ValueError
        If a value is not finite, the tilt is out of range, or a rate is given at zero tilt (where
        the direction of a rate has no meaning).

    Examples
    --------
    >>> InitialState(tilt=0.1, rolling_rate=0.5)
    InitialState(tilt=0.1, rolling_rate=0.5)
    """

    tilt: float
    tilt_rate: float = 0.0
    rolling_angle: float = 0.0
    rolling_rate: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in _UNITS.items():
            object.__setattr__(self, name, require_finite(name, getattr(self, name), unit))
        if not 0.0 <= self.tilt < OVERTURNED_TILT:
            raise ValueError(f"tilt must be at least 0 and below pi/2 [rad], got {self.tilt!r}")
        if self.tilt == 0.0 and (self.tilt_rate or self.rolling_rate):
            raise ValueError("tilt must be above 0 where tilt_rate or rolling_rate is given, got 0")


@dataclass(frozen=True, slots=True, repr=False)
class Case:
    """One problem: a body, its ground motion or release, and the duration.

    Parameters
    ----------
    cylinder : Cylinder or WobblingFrame
        Alone, or the columns of a `WobblingFrame`.
    motion : GroundMotion, optional
        Without it the ground is still.
    initial : InitialState, optional
        Default: standing at rest.
    duration : float, optional
        Length of the run [s]. Default: that of the motion; required without one.
    gravity : float, optional
        g [m/s^2].
    friction : float, optional
        Coulomb coefficient of the pair cylinder and ground, and of cylinder and slab [-]. Each engine
        converts it to its own convention; the reduced models assume that it suffices and say where it would
        not.
    name : str, optional
        For tables, figures and file names. Default: that of the motion, or "free response".
    rolling_resistance : float, optional
        Length delta of the couple of at most delta times the normal force against the rolling of the rim
        [m], at most a tenth of the base radius: above, a model takes millions of steps where it creeps. 0
        loses nothing. The columns of a frame roll with it at both ends.
    tendon : Tendon, optional
        An unbonded tendon along the axis of each column.

    Raises
    ------
    ValueError
        If a number is out of range, or neither motion nor duration is given.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> release = InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    >>> case = Case(pier, initial=release, duration=8.0, friction=0.6)
    >>> case.name, case.length, case.gravity
    ('free response', 8.0, 9.81)
    """

    cylinder: RockingBody
    motion: GroundMotion | None = None
    initial: InitialState | None = None
    duration: float | None = None
    gravity: float = 9.81
    friction: float = 1.0
    name: str = ""
    rolling_resistance: float = 0.0
    tendon: Tendon | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.cylinder, RockingBody):
            raise ValueError(  # noqa: TRY004
                f"cylinder must be a Cylinder or a WobblingFrame, got {quoted(self.cylinder)}"
            )
        kinds: dict[str, type] = {"motion": GroundMotion, "initial": InitialState, "tendon": Tendon}
        for name, kind in kinds.items():
            given = getattr(self, name)
            if given is not None and not isinstance(given, kind):
                raise ValueError(f"{name} must be {kind.__name__} or None, got {quoted(given)}")
        object.__setattr__(self, "gravity", require_positive("gravity", self.gravity, "m/s^2"))
        object.__setattr__(self, "friction", require_not_negative("friction", self.friction))
        length = require_finite("rolling_resistance", self.rolling_resistance, "m")
        object.__setattr__(self, "rolling_resistance", length)
        largest = MOST_RESISTANCE * self.cylinder.base_radius
        if not 0.0 <= length <= largest:
            raise ValueError(
                f"rolling_resistance must be from 0 to {MOST_RESISTANCE:g} base radii, {largest:g} m, got "
                f"{length!r} m"
            )
        if isinstance(self.name, str) and not self.name:
            name = "free response" if self.motion is None else self.motion.name
            object.__setattr__(self, "name", name or "record")
        if not isinstance(self.name, str) or self.name.splitlines() != [self.name]:
            raise ValueError(f"the name of a case must be one line, got {quoted(self.name)}")
        # duration as given, so that a copy with another motion takes the duration of that motion
        run_duration(self.motion, self.duration)

    def __repr__(self) -> str:
        cylinder, motion = self.cylinder, self.motion
        facts = [brief(self.name), f"R={cylinder.semidiagonal:g} m", f"tan_alpha={cylinder.tan_alpha:g}"]
        if cylinder.carries_slab:
            facts += [f"slab_mass_ratio={cylinder.slab_mass_ratio:g}"]
        if motion is not None:
            facts += [brief(motion.name)] if motion.name not in ("", self.name) else []
            facts += [f"peak {motion.peak:.4g} m/s^2"]
        facts += [f"tilt={self.initial.tilt:.4g}"] if self.initial else []
        facts += [f"{self.length:g} s", f"friction={self.friction:g}"]
        facts += [f"gravity={self.gravity:g}"] if self.gravity != 9.81 else []
        length = self.rolling_resistance
        facts += [f"rolling_resistance={length:g} m"] if length else []
        return line("Case", facts + ([f"tendon={self.tendon!r}"] if self.tendon else []))

    @property
    def length(self) -> float:
        """Length of the run [s]: `duration`, or that of the motion."""
        return run_duration(self.motion, self.duration)

    @property
    def terms(self) -> dict[str, Any]:
        """Terms beyond the equations of the paper, by field: tendon and rolling resistance where given.

        Digests take all of them, models and engines refuse what they do not know: a new field is ignored
        nowhere.
        """
        given = {each.name: getattr(self, each.name) for each in fields(self)}
        added = (each for each in fields(self) if each.name not in _OF_THE_PAPER)
        return {each.name: given[each.name] for each in added if given[each.name] != each.default}

    @property
    def anchor(self) -> str:
        """Connection of the base to the ground, such as "a tendon"; empty without one.

        The reduced model on flat ground, where the base wanders, has none of it.
        """
        return "" if self.tendon is None else "a tendon"

    @property
    def friction_at_rest(self) -> float:
        """Largest friction demand at the base while it stays closed [-]; inf where the normal force vanishes.

        ``|a_xy| / (g + a_z)``, with the prestress of a tendon. Exact: between samples it is quasi-convex.
        """
        if self.motion is None:
            return 0.0
        acceleration = self.motion.until(self.length)
        ratio = 0.0 if self.tendon is None else self.tendon.prestress / (1.0 + self.cylinder.slab_mass_ratio)
        vertical = acceleration[:, 2] if self.motion.has_vertical else 0.0
        pressed = self.gravity * (1.0 + ratio) + vertical * np.ones(len(acceleration))
        pushed = np.hypot(acceleration[:, 0], acceleration[:, 1])
        if (pressed[pushed > 0.0] <= 0.0).any():
            return math.inf
        return float((pushed[pushed > 0.0] / pressed[pushed > 0.0]).max(initial=0.0))

    @property
    def friction_of_uplift(self) -> float:
        """Friction below which a body slides before it uplifts [-]: b/h, more under a slab with a tendon."""
        body, tendon = self.cylinder, self.tendon
        if tendon is None:
            return body.tan_alpha
        pressed = 1.0 + tendon.prestress / (1.0 + body.slab_mass_ratio)
        return body.tan_alpha * tendon.uplift_factor(body) / pressed

    @property
    def uplifts(self) -> bool:
        """Whether the shaking uplifts the body from rest without sliding. Exact: convex between samples."""
        if self.motion is None:
            return False
        acceleration, body = self.motion.until(self.length), self.cylinder
        held = self.gravity * (1.0 if self.tendon is None else self.tendon.uplift_factor(body))
        vertical = acceleration[:, 2] if self.motion.has_vertical else 0.0
        pushed = np.hypot(acceleration[:, 0], acceleration[:, 1])
        return bool((pushed >= body.tan_alpha * (held + vertical)).any())

    @property
    def is_release(self) -> bool:
        """Whether the run starts tilted."""
        return self.initial is not None and self.initial.tilt > 0.0


# every other field is a term of the equations
_OF_THE_PAPER = ("cylinder", "motion", "initial", "duration", "gravity", "friction", "name")
TERMS = tuple(each.name for each in fields(Case) if each.name not in _OF_THE_PAPER)


def run_duration(motion: GroundMotion | None, duration: float | None) -> float:
    """Length of a run [s]: `duration` where given, else that of the motion.

    Parameters
    ----------
    motion : GroundMotion or None
    duration : float or None
        [s]

    Returns
    -------
    float
        [s]

    Raises
    ------
    ValueError
        If neither is given, or the duration is not positive and finite.

    Examples
    --------
    >>> run_duration(None, 8)
    8.0
    """
    if duration is not None:
        return require_positive("duration", duration, "s")
    if motion is None:
        raise ValueError("duration [s] must be given where there is no ground motion")
    return motion.duration


_Way = Literal["auto", "extrapolated"]
WAYS_TO_A_STEP: tuple[_Way, ...] = ("auto", "extrapolated")
#: Time step of an engine [s], or the name of a method that chooses it.
TimeStep = float | _Way | None
REDUCED = "reduced"  # engine name of a reduced model, in tables


@dataclass(frozen=True, slots=True, init=False, repr=False)
class Run:
    """One method: an engine or a reduced model, its support, and its settings.

    Parameters
    ----------
    engine : str or None
        Name of the engine, such as "mujoco" or "pybullet"; None is a reduced model.
    support : str
        What holds the cylinder in place: "recess", "flat" or "ring"; kept as the `Support` of that name.
    time_step : float, "auto" or "extrapolated", optional
        [s]; default: the engine's own choice for the size of the cylinder. "auto": halved until the
        result has settled. "extrapolated": what runs at several steps tend to.
    **settings
        Passed to the engine, or to `reduced.simulate`, as they are.

    Raises
    ------
    ValueError
        If the support is unknown, or the time step is neither positive nor one of those words.

    Examples
    --------
    >>> Run("mujoco", "recess", 1e-4, iterations=50)
    Run('mujoco', 'recess', time_step=0.0001, iterations=50)
    >>> str(Run(None, "flat")), str(Run(None, "recess", plane=0.0))
    ('flat-ground model', 'planar model')
    """

    engine: str | None
    support: Support
    time_step: TimeStep
    settings: Mapping[str, Any]

    def __init__(
        self,
        engine: str | None,
        support: str,
        time_step: TimeStep = None,
        **settings: object,
    ) -> None:
        if isinstance(time_step, str):
            if time_step not in WAYS_TO_A_STEP:
                raise ValueError(
                    f'time_step must be "auto", "extrapolated" or a number [s], got {time_step!r}'
                )
        elif time_step is not None:
            time_step = require_positive("time_step", time_step, "s")
        if not isinstance(support, Support):
            external = isinstance(support, str) and support == EXTERNAL
            support = EXTERNAL if external else support_named(support)
        object.__setattr__(self, "engine", engine)
        object.__setattr__(self, "support", support)
        object.__setattr__(self, "time_step", time_step)
        object.__setattr__(self, "settings", MappingProxyType(dict(settings)))

    def __repr__(self) -> str:
        step = [] if self.time_step is None else [f"time_step={self.time_step}"]
        given = [*step, *(f"{name}={brief(value)}" for name, value in self.settings.items())]
        return line("Run", [repr(self.engine), repr(self.support), *given])

    def __str__(self) -> str:
        if not self.is_model:
            return f"{self.engine} {self.support}"
        if self.is_planar:
            return "planar model by momentum" if self.loses_at_impact else "planar model"
        return self.support.model or f"{self.support} model"

    @property
    def is_model(self) -> bool:
        """Whether it is a reduced model, not an engine or an external trajectory."""
        return self.engine is None

    @property
    def is_planar(self) -> bool:
        """Whether it is the planar model: motion in one vertical plane."""
        return self.settings.get("plane") is not None

    @property
    def loses_at_impact(self) -> bool:
        """Whether it is the planar model in which each impact conserves the moment of momentum."""
        return self.is_planar and self.settings.get("restitution") == "momentum"

    @property
    def own_model(self) -> Run:
        """The reduced model of its support, without walls."""
        return Run(None, self.support.own_model)

    @property
    def compared_with(self) -> tuple[Run, ...]:
        """Reduced models with which a run of its support is compared, the nearest to it last."""
        return tuple(Run(None, support) for support in self.support.compared_with)

    @property
    def engine_name(self) -> str:
        """Name of the engine in tables; "reduced" of a reduced model."""
        return self.engine or REDUCED

    def __hash__(self) -> int:
        return hash((self.engine, self.support, self.time_step, frozenset(self.settings.items())))

    def __reduce__(self) -> tuple[object, ...]:
        # a mapping proxy cannot be pickled for a worker process
        return partial(Run, **self.settings), (self.engine, self.support, self.time_step)


RECESS_MODEL, FLAT_MODEL = Run(None, RECESS), Run(None, FLAT)
REDUCED_MODELS = tuple(Run(None, support) for support in MODELLED)


@with_argument_kinds
@dataclass(frozen=True, slots=True, repr=False)
class Suite(CompactRepr):
    """Cases times runs.

    Parameters
    ----------
    cases : iterable of Case
    runs : iterable of Run
    bounds : Bounds, optional
        What tests ask of every run.

    Raises
    ------
    ValueError
        If there is no case, or two cases share a name.

    Examples
    --------
    >>> from rockwobble.models import Cylinder
    >>> pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> low, high = InitialState(0.05), InitialState(0.1)
    >>> cases = [Case(pier, initial=start, duration=8.0, name=str(start)) for start in (low, high)]
    >>> suite = Suite(cases, [Run("mujoco", "recess"), Run("mujoco", "flat")])
    >>> len(suite.cases) * len(suite.runs)
    4
    """

    cases: tuple[Case, ...]
    runs: tuple[Run, ...]
    bounds: Bounds | None = None

    def __init__(self, cases: Iterable[Case], runs: Iterable[Run], bounds: Bounds | None = None) -> None:
        object.__setattr__(self, "bounds", bounds)
        object.__setattr__(self, "cases", tuple(cases))
        object.__setattr__(self, "runs", tuple(runs))
        names = [case.name for case in self.cases]
        if not names:
            raise ValueError("a suite must have at least one case")
        if len(set(names)) != len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise ValueError(f"the cases of a suite must have different names, got {twice!r} twice")
