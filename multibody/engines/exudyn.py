"""Exudyn: the rim is an ideal rolling disc, a joint without contact and without its parameters.

The joint holds the lowest point of the rim on the ground and its material point at rest: three
constraints, exact up to the integration. So it is a check of the flat-ground model that shares neither
contact nor friction with the other engines. What it cannot do follows from the same: the rim neither
leaves the ground nor slips, whatever force that takes, and a cylinder that stands has no lowest point. The
slab of a frame rolls on the rim of the top in the same way; its orientation is held. A tendon is a spring at
each gap.
"""

from __future__ import annotations

import contextlib
import importlib
from collections.abc import Iterator
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, Annotated

import numpy as np

from rockwobble.models.support import FLAT

from ..kinematics import axis_of
from ..protocol import EngineFacts, SceneCounts, Settings, Stepper, Steps
from ..scene import Array, Scene, Start
from ..settings import Count, EngineSettings, Small, one_of, positive
from .declared import Declared

if TYPE_CHECKING:
    from exudyn import MainSystem, SimulationSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class ExudynSettings(EngineSettings):
    """Settings of Exudyn: its integrator; an ideal rim leaves nothing else to set.

    Attributes
    ----------
    integrator : {"trapezoidal", "generalized-alpha"}
        The trapezoidal rule with constraints on velocities (index 2), or the generalized alpha method with
        constraints on positions (index 3). Both are second order. The second is cheaper; the first holds
        what rolling is, a rim whose velocity is zero at the contact. Exudyn's explicit
        integrators, though of high order, do not take constraints.
    spectral_radius : float
        Spectral radius of the generalized alpha method at infinite frequency. An ideal rim has no high
        frequency that would have to be damped, and what damps one errs more. 0.9 is the engine's default.
    relative_tolerance, absolute_tolerance : float
        Relative tolerance and absolute tolerance at which Newton's iteration stops. The engine's own, 1e-8
        and 1e-10, show at small steps.
    iterations : int
        At most. With three, no step reaches these tolerances.
    """

    integrator: Annotated[str, one_of("trapezoidal", "generalized-alpha")] = "trapezoidal"
    spectral_radius: Annotated[float, positive(most=1.0, or_zero=True)] = 1.0
    relative_tolerance: Small = 1e-12
    absolute_tolerance: Small = 1e-13
    iterations: Count = 25

    @staticmethod
    def defaults(time_step: float) -> dict[str, float]:
        """No default depends on the time step."""
        return {}


_FACTS = EngineFacts(
    title="Exudyn", step_time=1.2e-5, order=2.0, carries_slab=True, terms=frozenset({"tendon"})
)


class ExudynEngine(Declared):
    """Exudyn: rigid body on Euler parameters, joint of a rolling disc, implicit integration."""

    package, settings_type, facts = "exudyn", ExudynSettings, _FACTS  # both rules are of second order
    supports = (FLAT,)  # flat ground only: the joint lets the rim roll out
    uplifts = False  # the joint knows the rim only, not the base

    @contextlib.contextmanager
    def open(self, scene: Scene, settings: Settings) -> Iterator[Stepper]:
        """Open the scene at its start."""
        import exudyn

        # a failed step is reported in words on standard output; here it is data
        printing = exudyn.config.printToConsole
        exudyn.config.printToConsole = False
        try:
            yield _ExudynStepper(exudyn, scene, ExudynSettings(**settings))
        finally:
            exudyn.config.printToConsole = printing


class _ExudynStepper:
    def __init__(self, exudyn: ModuleType, scene: Scene, settings: ExudynSettings) -> None:
        self._exudyn, self._step = exudyn, scene.time_step
        self._start = scene.start
        self._forces: list[list[float]] = []
        self._excited = bool(scene.components)
        self._container = exudyn.SystemContainer()
        self._system, self._sensors = self._build(scene)
        self._how = _simulation_settings(exudyn, settings)
        kinds = exudyn.DynamicSolverType
        self._solver = (
            kinds.TrapezoidalIndex2 if settings.integrator == "trapezoidal" else kinds.GeneralizedAlpha
        )
        self._force_now: list[float] | None = None
        self._last = scene.start.velocity, scene.start.angular_velocity
        self._lean = _leans(scene.start.quaternion[None])[0]
        self._warning = ""

    @property
    def hold_centre(self) -> float:
        """A whole step: its force is the mean about its end, as both rules take the force at both ends."""
        return 1.0

    def advance(self, acceleration: Array) -> Steps:
        """Take one step for each row of `acceleration`."""
        count = len(acceleration)
        rows = np.full((count, 14), np.nan)
        if not self._warning:
            stepped = self._integrate(acceleration)
            rows[: len(stepped)] = stepped
            self._check_upright(rows)
        place, turn, velocity, rates = np.split(rows, (3, 7, 10), axis=1)
        quaternion = self._start.quaternion + turn
        # normalised to the tolerance of the iteration
        quaternion /= np.linalg.norm(quaternion, axis=1)[:, None]
        spin = _spin(quaternion, rates)
        before, self._last = self._last, (velocity[-1], spin[-1])
        return Steps(
            self._start.position + place, quaternion, _means(before[0], velocity), _means(before[1], spin)
        )

    def warnings(self) -> str:
        """Message of the fault that ended the run, if there is one."""
        return self._warning

    def counts(self) -> SceneCounts:
        """Constraint counts of a step: three of the joint on the velocity of one point."""
        return SceneCounts(degrees_of_freedom=6, contacts=0, constraint_rows=3)

    def _check_upright(self, rows: Array) -> None:
        """Drop the rows (n, 14) from the first that has jumped over upright."""
        leans = np.vstack([self._lean, _leans(self._start.quaternion + rows[:, 3:7])])
        self._lean = leans[-1]
        # more than a quarter turn in one step: the step is longer than twice the distance from upright
        over = np.flatnonzero((leans[1:] * leans[:-1]).sum(axis=1) < 0.0)
        if len(over):
            rows[over[0] :] = np.nan
            self._warning = "the rim rolled through upright, where it has no lowest point"

    def _integrate(self, acceleration: Array) -> Array:
        """Rows (n, 14) of Euler coordinates and their rates after each step; fewer where a step fails."""
        forces = (-acceleration).tolist()
        # the first step starts with the force of its end, which is second order; a zero force would be first
        # order
        self._forces = [self._force_now or forces[0], *forces]
        self._force_now = self._forces[-1]
        integration = self._how.timeIntegration
        integration.numberOfSteps = len(acceleration)
        integration.endTime = len(acceleration) * self._step
        self._how.solution.sensors.writePeriod = self._step
        try:
            self._system.SolveDynamic(
                self._how,
                solverType=self._solver,
                updateInitialValues=True,
                storeSolver=False,
                showCausingItems=False,
            )
        except (RuntimeError, ValueError):
            self._warning = "Newton's iteration did not converge"
        # accelerations continue from one call to the next
        integration.generalizedAlpha.computeInitialAccelerations = False
        stored = [self._system.GetSensorStoredData(sensor) for sensor in self._sensors]
        # the first row is the start; the first column the time
        return np.hstack([np.asarray(table)[1:, 1:] for table in stored])

    def _build(self, scene: Scene) -> tuple[MainSystem, list[int]]:
        """Make ground, cylinder, rim and forces; return the system and its sensors."""
        # its functions are not typed
        items = importlib.import_module("exudyn.itemInterface")
        body, start = scene.body, scene.start
        system = self._container.AddSystem()
        ground = system.AddObject(items.ObjectGround())

        def add_body(
            mass: float, inertia: list[float], pose: list[float], rates: list[float]
        ) -> tuple[int, int]:
            """Numbers of the node and the object of a rigid body under gravity and excitation."""
            node = system.AddNode(
                items.NodeRigidBodyEP(
                    referenceCoordinates=pose, initialCoordinates=[0.0] * 7, initialVelocities=rates
                )
            )
            body = system.AddObject(
                items.ObjectRigidBody(mass=mass, inertia=[*inertia, 0.0, 0.0, 0.0], nodeNumber=node)
            )
            centre = system.AddMarker(items.MarkerBodyMass(bodyNumber=body))
            fall = [0.0, 0.0, -scene.gravity]
            system.AddLoad(items.LoadMassProportional(markerNumber=centre, loadVector=fall))
            if self._excited:
                push = items.LoadMassProportional(
                    markerNumber=centre, loadVectorUserFunction=self._excitation
                )
                system.AddLoad(push)
            return int(node), int(body)

        def add_rim(plane: int, up: float) -> int:
            """Let the base, or the top, roll on the plane of a body; return the marker of that body."""
            place = [0.0, 0.0, -up * body.mass_centre_height]
            rim = [
                system.AddMarker(items.MarkerBodyRigid(bodyNumber=plane)),
                system.AddMarker(items.MarkerBodyRigid(bodyNumber=cylinder, localPosition=place)),
            ]
            system.AddObject(
                items.ObjectJointRollingDisc(
                    markerNumbers=rim,
                    discRadius=body.base_radius,
                    discAxis=[0.0, 0.0, 1.0],
                    planeNormal=[0.0, 0.0, up],
                )
            )
            return int(rim[0])

        inertia = [body.transverse_inertia, body.transverse_inertia, body.axial_inertia]
        node, cylinder = add_body(
            1.0, inertia, [*start.position, *start.quaternion], [*start.velocity, *_rates(start)]
        )
        still = add_rim(ground, 1.0)
        share = body.slab_mass_ratio
        if share > 0.0:
            above = [0.0, 0.0, 2.0 * float(start.position[2]), 1.0, 0.0, 0.0, 0.0]
            _, slab = add_body(share, [share] * 3, above, [*2.0 * start.velocity, 0.0, 0.0, 0.0, 0.0])
            both = [still, add_rim(slab, -1.0)]
            system.AddObject(items.ObjectJointGeneric(markerNumbers=both, constrainedAxes=[0, 0, 0, 1, 1, 1]))
        tendon = scene.restraint
        if tendon.is_active:
            # the rims do not slip, so both gaps open alike and each has its share of the tension
            height = body.mass_centre_height
            gaps = [[(ground, [0.0, 0.0, -tendon.depth]), (cylinder, [0.0, 0.0, -height])]]
            if share > 0.0:
                # the slab stands over the origin at the start, and its anchor twice as far off as the column
                x, y, _ = (2.0 * start.position).tolist()
                gaps.append([(slab, [x, y, tendon.depth]), (cylinder, [0.0, 0.0, height])])
            for gap in gaps:
                points = [
                    system.AddMarker(items.MarkerBodyPosition(bodyNumber=each, localPosition=place))
                    for each, place in gap
                ]
                system.AddObject(
                    items.ObjectConnectorSpringDamper(
                        markerNumbers=points,
                        referenceLength=tendon.depth,
                        stiffness=tendon.gaps * tendon.stiffness,
                        force=tendon.prestress,
                    )
                )
        kinds = self._exudyn.OutputVariableType
        sensors = [
            system.AddSensor(items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kind))
            for kind in (kinds.Coordinates, kinds.Coordinates_t)
        ]
        system.Assemble()
        return system, sensors

    def _excitation(self, system: object, time: float, load: object) -> list[float]:
        """Force for each unit of mass: -a."""
        return self._forces[round(time / self._step)]


def _simulation_settings(exudyn: ModuleType, settings: ExudynSettings) -> SimulationSettings:
    how: SimulationSettings = exudyn.SimulationSettings()
    how.solution.file.write = False
    integration = how.timeIntegration
    # a step that does not converge ends the run: shorter steps would not be those of the time grid
    integration.adaptiveStep = False
    integration.verboseMode = 0
    newton = integration.newton
    newton.relativeTolerance = settings.relative_tolerance
    newton.absoluteTolerance = settings.absolute_tolerance
    newton.maxIterations = settings.iterations
    integration.generalizedAlpha.spectralRadius = settings.spectral_radius
    return how


def _rates(start: Start) -> Array:
    """Rates of the Euler parameters, shape (4,), of the angular velocity at the start."""
    scalar, imaginary, spin = start.quaternion[0], start.quaternion[1:], start.angular_velocity
    turning = scalar * spin + np.cross(spin, imaginary)
    return np.asarray(0.5 * np.concatenate([[-spin @ imaginary], turning]))


def _leans(quaternion: Array) -> Array:
    """Horizontal parts (n, 2) of the axes, of quaternions (n, 4)."""
    return axis_of(quaternion)[:, :2]


def _means(first: Array, values: Array) -> Array:
    """Mean over each step of a quantity at its ends: `first` (3,), then `values` (n, 3)."""
    return np.asarray(0.5 * (np.vstack([first, values[:-1]]) + values))


def _spin(quaternion: Array, rates: Array) -> Array:
    """Angular velocities (n, 3), world axes, of Euler parameters and their rates (n, 4)."""
    scalar, imaginary = quaternion[:, :1], quaternion[:, 1:]
    return np.asarray(
        2.0 * (scalar * rates[:, 1:] - rates[:, :1] * imaginary - np.cross(rates[:, 1:], imaginary))
    )
