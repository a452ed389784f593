"""The scene of Drake."""

from __future__ import annotations

import contextlib
import logging
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..protocol import Array, Scene
from ..scene.friction import body_friction
from .settings.drake import DrakeSettings

POINTS = 4  # of the rim, which carry a flat base
_POINT_SIZE = 1e-9  # of b: a sphere this small reaches out of the rim by 1e-9 theta^2/2


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DrakeScene:
    """Ground and cylinder, and what a step of them is solved by.

    Attributes
    ----------
    plant : pydrake.multibody.plant.MultibodyPlant
    diagram, root, context : pydrake.systems.framework.Diagram, Context, Context
        The diagram that holds the plant, its context, and that of the plant.
    applied : pydrake.systems.framework.FixedInputPortValue
        Torque and force on the cylinder.
    acceleration, contact : pydrake.systems.framework.OutputPort
    no_forces : pydrake.multibody.tree.MultibodyForces
    gravity : ndarray, shape (6,)
        Torque and force.
    """

    plant: Any
    diagram: Any
    root: Any
    context: Any
    applied: Any
    acceleration: Any
    contact: Any
    no_forces: Any
    gravity: Array

    def solve(self, state: Array, applied: Array) -> tuple[Array, Array]:
        """Solve the step from a state: quaternion, position, angular velocity and velocity (13,).

        Returns
        -------
        acceleration : ndarray, shape (6,)
            Change of both velocities over the step.
        left : ndarray, shape (6,)
            Torque and force that the solver left unbalanced.
        """
        self.applied.GetMutableData().get_mutable_value().SetFromVector(applied)
        self.plant.SetPositionsAndVelocities(self.context, state)
        acceleration = self.acceleration.Eval(self.context)
        balanced = self.plant.CalcInverseDynamics(self.context, acceleration, self.no_forces)
        left = applied + self.gravity + self.contact.Eval(self.context) - balanced
        return acceleration, left

    def count_contacts(self) -> int:
        """Return how many the last step solved."""
        results = self.plant.get_contact_results_output_port().Eval(self.context)
        return int(results.num_point_pair_contacts())


def build(scene: Scene, settings: DrakeSettings, points: int) -> DrakeScene:
    """Make ground and cylinder, with points on its rim."""
    from pydrake.geometry import AddContactMaterial, Cylinder, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform
    from pydrake.multibody import plant as plants
    from pydrake.multibody.tree import MultibodyForces, RotationalInertia, SpatialInertia
    from pydrake.systems.framework import DiagramBuilder

    shape = scene.body
    builder = DiagramBuilder()
    plant, _ = plants.AddMultibodyPlantSceneGraph(builder, scene.time_step)
    kinds = plants.DiscreteContactApproximation
    names = {"lagged": kinds.kLagged, "similar": kinds.kSimilar, "tamsi": kinds.kTamsi, "sap": kinds.kSap}
    plant.set_discrete_contact_approximation(names[settings.approximation])
    plant.set_stiction_tolerance(settings.stiction_tolerance)
    plant.SetUseSampledOutputPorts(False)  # an output then solves the step that is ahead
    transverse, axial = shape.transverse_inertia, shape.axial_inertia
    inertia = RotationalInertia(transverse, transverse, axial)
    origin: Any = np.zeros(3)
    body = plant.AddRigidBody("cylinder", SpatialInertia.MakeFromCentralInertia(1.0, origin, inertia))
    friction = body_friction(scene.friction, "pair")
    contact = ProximityProperties()
    # two bodies in series are half as stiff as each
    cone = plants.CoulombFriction(friction, friction)
    AddContactMaterial(settings.dissipation, 2.0 * settings.contact_stiffness, cone, contact)
    middle: Any = np.array([0.0, 0.0, 0.5 * shape.height - shape.mass_centre_height])
    size = _POINT_SIZE * shape.base_radius
    with _quiet():
        plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform(), HalfSpace(), "ground", contact)
        outline = Cylinder(shape.base_radius, shape.height)
        plant.RegisterCollisionGeometry(body, RigidTransform(middle), outline, "outline", contact)
        for index in range(points):
            azimuth = 2.0 * math.pi * index / points
            x, y = shape.base_radius * math.cos(azimuth), shape.base_radius * math.sin(azimuth)
            place: Any = np.array([x, y, size - shape.mass_centre_height])
            name = f"point {index}"
            plant.RegisterCollisionGeometry(body, RigidTransform(place), Sphere(size), name, contact)
        plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -scene.gravity])
        plant.Finalize()
        diagram = builder.Build()
        root = diagram.CreateDefaultContext()
    context = plant.GetMyMutableContextFromRoot(root)
    model = plant.GetModelInstanceByName("DefaultModelInstance")
    return DrakeScene(
        plant=plant,
        diagram=diagram,
        root=root,
        context=context,
        applied=plant.get_applied_generalized_force_input_port().FixValue(context, np.zeros(6)),
        acceleration=plant.get_generalized_acceleration_output_port(),
        contact=plant.get_generalized_contact_forces_output_port(model),
        no_forces=MultibodyForces(plant),
        gravity=np.array([0.0, 0.0, 0.0, 0.0, 0.0, -scene.gravity]),
    )


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep a warning that no half space touches a deformable body off the standard error."""
    logger = logging.getLogger("drake")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)
