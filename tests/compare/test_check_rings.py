"""The part rings of the layer traces holds, and finds walls in a wrong place and falls that lose samples."""

from __future__ import annotations

from typing import Any

import pytest

from rockwobble import reduced
from rockwobble.compare.check import Bench, bench
from rockwobble.compare.check.engines import rings
from rockwobble.models import read_suite
from rockwobble.multibody.recording.forces import ForceSamples
from rockwobble.multibody.recording.recorder import Recorder
from rockwobble.multibody.scene import ring_geometry


def failed(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    monkeypatch.setattr(bench, "ENGINES", ("mujoco",))
    made = Bench(reduced=reduced, suite=read_suite("quick"), workers=1)
    return [finding.name for finding in rings.check(made) if finding.failed]


def test_rings_and_falls_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    assert failed(monkeypatch) == []


def test_a_wall_for_a_body_without_a_top_stands_too_near(monkeypatch: pytest.MonkeyPatch) -> None:
    needed = ring_geometry._needed

    def low(eta: float, tilt: float, inclination: float) -> float:
        return needed(0.9 * eta, tilt, inclination)

    monkeypatch.setattr(ring_geometry, "_needed", low)
    assert failed(monkeypatch) == ["clearance that a ring needs"]


def test_walls_at_the_circle_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    placed = ring_geometry.wall_feet

    def near(ring: Any, base_radius: float) -> Any:
        return placed(ring, base_radius) / (1.0 + ring.ring_clearance)

    monkeypatch.setattr("rockwobble.multibody.engines.mujoco_scene.wall_feet", near)
    assert "first contact with a wall, mujoco" in failed(monkeypatch)


def test_forces_of_the_record_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ForceSamples, "extend", lambda self, samples: None)
    assert "contact force of a fall that the record cuts off, mujoco" in failed(monkeypatch)


def test_a_sample_that_is_none_of_the_model(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Recorder, "off_grid", property(lambda self: False, lambda self, value: None), False)
    assert "samples of a fall that the record cuts off, mujoco" in failed(monkeypatch)
