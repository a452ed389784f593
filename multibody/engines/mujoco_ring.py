"""The walls of a ring in MuJoCo: planes, in contact with the cylinder through pairs of their own."""

from __future__ import annotations

from typing import Any

from ..scene.ring_geometry import wall_feet, wall_orientations
from ..scene.ring_settings import RingSettings


def set_walls(spec: Any, ring: RingSettings, base_radius: float) -> None:
    """Replace the walls of the scene file by those of `ring`, which may be more, fewer or elsewhere."""
    body, wall = spec.body("ring"), spec.find_default("wall")
    for pair in [pair for pair in spec.pairs if pair.geomname1.startswith("wall")]:
        spec.delete(pair)
    for geom in list(body.geoms):
        spec.delete(geom)
    feet, turns = wall_feet(ring, base_radius), wall_orientations(ring)
    for index, (foot, turn) in enumerate(zip(feet, turns, strict=True)):
        name = f"wall{index:02d}"
        body.add_geom(wall, name=name, pos=foot, quat=turn)
        spec.add_pair(wall, geomname1=name, geomname2="cylinder")
