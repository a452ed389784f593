"""The scene of Drake."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..protocol import Scene
from ..scene.friction import body_friction
from .settings.drake import DrakeSettings

POINTS = 4  # of the rim, which carry a flat base
_POINT_SIZE = 1e-9  # of b: a sphere this small reaches out of the rim by 1e-9 theta^2/2


def build(scene: Scene, settings: DrakeSettings) -> tuple[Any, Any]:
    """Make ground and cylinder; return the diagram and its plant."""
    from pydrake.geometry import AddContactMaterial, Cylinder, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform
    from pydrake.multibody import plant as plants
    from pydrake.multibody.tree import RotationalInertia, SpatialInertia
    from pydrake.systems.framework import DiagramBuilder

    shape = scene.body
    builder = DiagramBuilder()
    plant, _ = plants.AddMultibodyPlantSceneGraph(builder, scene.time_step)
    kinds = plants.DiscreteContactApproximation
    names = {"lagged": kinds.kLagged, "similar": kinds.kSimilar, "tamsi": kinds.kTamsi, "sap": kinds.kSap}
    plant.set_discrete_contact_approximation(names[settings.approximation])
    plant.set_stiction_tolerance(settings.stiction_tolerance)
    transverse, axial = shape.transverse_inertia, shape.axial_inertia
    inertia = RotationalInertia(transverse, transverse, axial)
    origin: Any = np.zeros(3)
    body = plant.AddRigidBody("cylinder", SpatialInertia.MakeFromCentralInertia(1.0, origin, inertia))
    friction, _ = body_friction(scene.friction, "pair")
    contact = ProximityProperties()
    # two bodies in series are half as stiff as each
    cone = plants.CoulombFriction(friction, friction)
    AddContactMaterial(settings.dissipation, 2.0 * settings.contact_stiffness, cone, contact)
    middle: Any = np.array([0.0, 0.0, 0.5 * shape.height - shape.mass_centre_height])
    size = _POINT_SIZE * shape.base_radius
    plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform(), HalfSpace(), "ground", contact)
    outline = Cylinder(shape.base_radius, shape.height)
    plant.RegisterCollisionGeometry(body, RigidTransform(middle), outline, "outline", contact)
    for index in range(POINTS):
        azimuth = 2.0 * math.pi * index / POINTS
        x, y = shape.base_radius * math.cos(azimuth), shape.base_radius * math.sin(azimuth)
        place: Any = np.array([x, y, size - shape.mass_centre_height])
        plant.RegisterCollisionGeometry(body, RigidTransform(place), Sphere(size), f"point {index}", contact)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -scene.gravity])
    plant.Finalize()
    return builder.Build(), plant
