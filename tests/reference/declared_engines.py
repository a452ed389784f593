"""Engines of another package: MuJoCo on flat ground under another name, and with one fault each."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

SOURCE = """
import contextlib, dataclasses, random
import numpy as np
from rockwobble.multibody.engines.mujoco import MujocoEngine

class Wrapped:
    def __init__(self, stepper, change):
        self._stepper, self._change = stepper, change
    hold_centre = property(lambda self: self._stepper.hold_centre)
    def advance(self, acceleration):
        return self._stepper.advance(self._change(acceleration))
    def warnings(self):
        return self._stepper.warnings()

class Sound(MujocoEngine):
    supports = ("flat",)
    def change(self, acceleration):
        return acceleration
    @contextlib.contextmanager
    def open(self, scene, settings):
        with super().open(dataclasses.replace(scene, components="xyz"), settings) as stepper:
            yield Wrapped(stepper, self.change)

class Backwards(Sound):
    def change(self, acceleration):
        return -acceleration

class OneSided(Sound):
    def change(self, acceleration):
        return acceleration + np.array([0.0, 1e-4, 0.0])

class Random(Sound):
    def change(self, acceleration):
        return acceleration + 1e-6 * random.random()

class Loud(Sound):
    def version(self):
        print("version 1")
        return "1"

class Careless(Sound):
    def settings(self, given, scene):
        return super().settings({}, scene)

class Heavy(Sound):
    @contextlib.contextmanager
    def open(self, scene, settings):
        with super().open(dataclasses.replace(scene, gravity=1.001 * scene.gravity), settings) as stepper:
            yield stepper

class Absolute(Sound):
    def settings(self, given, scene):
        return super().settings({"contact_time_constant": 1e-3, **given}, scene)

class Early(Sound):
    @contextlib.contextmanager
    def open(self, scene, settings):
        with super().open(scene, settings) as stepper:
            stepper.advance(np.zeros((3, 3)))
            yield stepper

class Slippery(Sound):
    @contextlib.contextmanager
    def open(self, scene, settings):
        with super().open(dataclasses.replace(scene, friction=0.02), settings) as stepper:
            yield stepper

class Half:
    supports = ("flat",)
    def version(self):
        return "1"

def fails():
    raise RuntimeError("no licence\\nand more lines")
"""

Install = Callable[..., None]


def installer(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Install:
    """Return a function that installs a distribution which declares engines by name."""

    def put(distribution: str = "external", **engines: str) -> None:
        place = folder / distribution
        about = place / f"{distribution}-1.0.dist-info"
        about.mkdir(parents=True)
        (place / "external_engine.py").write_text(SOURCE)
        (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 1.0\n")
        lines = [f"{name} = {value}" for name, value in engines.items()]
        (about / "entry_points.txt").write_text("\n".join(["[rockwobble.engines]", *lines]) + "\n")
        monkeypatch.delitem(sys.modules, "external_engine", raising=False)
        monkeypatch.syspath_prepend(str(place))

    return put
