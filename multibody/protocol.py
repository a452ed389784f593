"""Protocol of an engine, one small interface known to everything else in this folder, and its facts.

An engine runs one rigid body on rigid ground at the reference size. It opens a scene, and then advances
it by a number of steps at a time under given ground accelerations. How it steps (a rollout in C, a loop
in Python) is its own affair; so are its settings, which it resolves from the time step.

Writing one
-----------
Write a class with the members of `Engine`, whose constructor takes no argument and imports nothing
heavy, and declare it in the metadata of its package:

    [project.entry-points."rockwobble.engines"]
    mine = "my_package.my_module:MyEngine"

From then on "mine" is the name of an engine wherever one is asked for. What it must hold:

* The scene is complete: body, start, friction, gravity and time step in SI units at the reference size,
  mass 1, origin in the centre O of the original base circle, z up. Nothing is to be scaled; only settings
  that are times come in the time of the user, `Scene.unit_time` of it in a second of the scene.
* The ground keeps still, and its acceleration a acts as the body force -a at the mass centre.
* Every step takes the time step of the scene and gives one row, whatever happens. Rows that it could not
  compute are NaN, and `Stepper.warnings` then says why: that ends the run as "failed".
* The poses are those after each step; their order in time is that of the calls, and it makes no
  difference how many steps one call takes.
* The velocity of a step is the mean over it, that is the displacement over h, and the rotation over h.
  Recorded so, the velocity at a pose is the mean of those before and after it, to second order. In an
  engine that steps as leapfrog does (the new velocity moves the pose: MuJoCo's Euler, Bullet) it is the
  engine's own, which starts half a step back; in one that knows both at the pose (Runge-Kutta, the
  trapezoidal rule) it is the mean of both ends.
* The force of step n is the mean of the ground acceleration over one step about the time (n + c) h,
  where c is `Stepper.hold_centre`: 0 in leapfrog, whose velocity moves from half a step before the pose
  n to half a step after it; 1/2 where the force is held over the step ahead; 1 where it is taken at the
  end of the step.
* The same run gives the same bits, nothing is printed or written, and what was opened is closed.

`rockwobble.check(engine="mine")` checks all that, by physics, for any engine.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from rockwobble.models.shown import CompactRepr

from .scene import Array, Scene

Settings = Mapping[str, Any]

_NOTHING: Settings = MappingProxyType({})


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class EngineFacts(CompactRepr):
    """Measured facts of one engine, for plans and predictions; the defaults suit an unknown engine.

    Attributes
    ----------
    title : str
        Name as its makers write it.
    step_time : float
        Computing time of a step on one core of a two-core machine [s].
    order : float
        Order of the error in the time step.
    release_error : float
        Root mean square error of the tilt in the first second after a release, over alpha tan^2(alpha), at
        the default step; see `compare.comparison.prediction`.
    uplift_error : float
        The same after an uplift from rest, over alpha.
    smooth_uplift : bool
        Whether the error of a run that uplifts is a power series in the step, so that finer steps tell its
        limit.
    rounding : float
        Relative rounding error of its arithmetic, 2^-53 in double and 2^-24 in single precision.
    carries_slab : bool
        Whether its scenes hold the slab of a frame: one column, under a slab that only translates.
    terms : frozenset of str
        Which of `Case.terms` its scenes have, by their names there; a case with any other is refused.
    contact_time : str
        Name of the setting that is the time in which contact removes a velocity [s]; empty without one.
    alternatives : mapping
        Settings worth a price of their own in a table of costs, by what they are called there; for a
        release.
    standing_alternatives : mapping
        The same for a cylinder that stands.
    """

    title: str = ""
    step_time: float = 3e-5
    order: float = 1.0
    release_error: float = 2e-6
    uplift_error: float = 2.5e-5
    smooth_uplift: bool = False
    rounding: float = 2.0**-53
    carries_slab: bool = False
    terms: frozenset[str] = frozenset()
    contact_time: str = ""
    alternatives: Mapping[str, Settings] = field(default_factory=lambda: _NOTHING)
    standing_alternatives: Mapping[str, Settings] = field(default_factory=lambda: _NOTHING)


MEMBERS = ("supports", "uplifts", "facts", "version", "settings", "open")  # members of an Engine


@dataclass(frozen=True, slots=True, eq=False)
class Wall:
    """Contact with walls at n poses.

    Attributes
    ----------
    touching : ndarray of bool, shape (n,)
    force : ndarray, shape (n,)
        Size of the sum of all forces of walls on the cylinder, per unit mass [m/s^2].
    depth : ndarray, shape (n,)
        Depth of the deepest contact [m].
    """

    touching: NDArray[np.bool_]
    force: Array
    depth: Array


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """Poses after each of n steps, and the velocities that led to them.

    Attributes
    ----------
    position : ndarray, shape (n, 3)
        Position of the mass centre [m].
    quaternion : ndarray, shape (n, 4)
        Scalar first.
    velocity, angular_velocity : ndarray, shape (n, 3)
        Means over the step that ends at the pose, world axes [m/s], [rad/s].
    wall : Wall, optional
        Contact with walls at the poses from which the steps start. None without walls.
    unsolved : bool, optional
        Whether the solver stopped before it converged, in the last of these steps.
    """

    position: Array
    quaternion: Array
    velocity: Array
    angular_velocity: Array
    wall: Wall | None = None
    unsolved: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneCounts:
    """Sizes of the problem that the last step solved.

    Attributes
    ----------
    degrees_of_freedom : int
    contacts : int
        Points.
    constraint_rows : int
        Scalar constraints, normal and of friction.
    """

    degrees_of_freedom: int
    contacts: int
    constraint_rows: int


class Stepper(Protocol):
    """An open scene."""

    @property
    def hold_centre(self) -> float:
        """Centre c of the time of the mean force of step n, in steps after pose n: 0 to 1."""
        ...

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`, shape (n, 3), of the ground [m/s^2]."""
        ...

    def warnings(self) -> str:
        """Warnings of the engine so far, empty if none; a warning ends the run."""
        ...


class Engine(Protocol):
    """A physics engine."""

    @property
    def supports(self) -> tuple[str, ...]:
        """Names of its supports: "recess" (ideal recess), "flat" (flat ground), "ring" (walls, clearance)."""
        ...

    @property
    def uplifts(self) -> bool:
        """Whether it can start from a standing cylinder; otherwise a run needs a release with a tilt."""
        ...

    @property
    def facts(self) -> EngineFacts:
        """Facts of the engine, measured beforehand; `EngineFacts()` where nothing was measured."""
        ...

    def version(self) -> str:
        """Version of the package, for the record: results differ between versions."""
        ...

    def settings(self, given: Settings, scene: Scene) -> Mapping[str, object]:
        """All settings, from those `given` (in the units of the user) and the time step.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        ...

    def open(self, scene: Scene, settings: Settings) -> AbstractContextManager[Stepper]:
        """Context manager that opens the scene at its start and closes it also after an exception."""
        ...
