"""Engines that other packages declare: found, run, held to the contract, and kept from breaking ours."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from rockwobble import multibody
from rockwobble.compare import default_runs, require_runnable, reserved_engines
from rockwobble.models import Case, Cylinder, InitialState, Run
from rockwobble.multibody.contract import interface, mechanics, sweep
from rockwobble.multibody.engines.registry import find_engine
from rockwobble.multibody.testing import ContractCheck, check_engine, leaves_no_trace

# MuJoCo on flat ground under another name, and with one fault each
SOURCE = """
import contextlib, dataclasses, random
import numpy as np
from rockwobble.multibody.engines.mujoco_engine import MujocoEngine

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
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)

Install = Callable[..., None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Install:
    """Install a distribution that declares engines by name."""

    def put(distribution: str = "external", **engines: str) -> None:
        place = tmp_path / distribution
        about = place / f"{distribution}-1.0.dist-info"
        about.mkdir(parents=True)
        (place / "external_engine.py").write_text(SOURCE)
        (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 1.0\n")
        lines = [f"{name} = {value}" for name, value in engines.items()]
        (about / "entry_points.txt").write_text("\n".join(["[rockwobble.engines]", *lines]) + "\n")
        monkeypatch.delitem(sys.modules, "external_engine", raising=False)
        monkeypatch.syspath_prepend(str(place))

    return put


def test_an_engine_of_another_package_is_found_runs_and_keeps_the_contract(
    install: Install, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(sound="external_engine:Sound")
    assert multibody.engine_names() == ("mujoco", "pybullet", "dart", "drake", "exudyn", "sound")
    assert multibody.available_engines()[-1] == "sound"
    release = InitialState(PIER.alpha / 2, rolling_rate=0.5)
    run = multibody.simulate(Case(PIER, initial=release, duration=0.5), engine="sound", support="flat")
    assert (run.run.engine, run.outcome) == ("sound", "stands")
    # it is MuJoCo, which the sweep takes into more directions under its own name
    monkeypatch.setattr(sweep, "SWEEP_SLENDERNESS", (0.2,))
    monkeypatch.setattr(sweep, "SWEEP_DIRECTIONS", 3)
    check_engine("sound")


@pytest.mark.parametrize(
    ("fault", "rule", "words"),
    [
        ("Backwards", mechanics.takes_the_work_of_the_ground, "energy less work over its scale changes: by"),
        ("OneSided", mechanics.does_not_tell_left_from_right, "the tilt of the mirror image differs: by"),
        ("Heavy", mechanics.wobbles_steadily, "the tilt of a steady wobble over alpha changes: by"),
        ("Heavy", mechanics.keeps_its_energy, "energy of the free response over its scale changes: by"),
        ("Random", interface.repeats_bit_for_bit, "two runs of the same differ"),
        ("Loud", leaves_no_trace, r"it printed 'version 1\\n'"),
        ("Careless", interface.refuses_what_it_does_not_know, "it is not refused: .*no_such_setting"),
        ("Absolute", interface.is_the_same_at_every_size, "the tilt depends on the size: by"),
        ("Early", interface.starts_as_stated, "the first step does not go on from the start: by"),
        ("Slippery", mechanics.keeps_momentum_or_rolls, "slip over b: by"),
    ],
)
def test_a_fault_is_found(install: Install, fault: str, rule: Callable[[str, str], None], words: str) -> None:
    install(faulty=f"external_engine:{fault}")
    with pytest.raises(AssertionError, match=f"faulty flat {rule.__name__}: {words}"):
        check_engine("faulty", [ContractCheck("faulty", "flat", rule)])


@pytest.mark.parametrize(
    ("factory", "words"),
    [
        ("external_engine:Missing", "does not load: AttributeError: "),
        ("no_such_module:Engine", "does not load: ModuleNotFoundError: No module named 'no_such_module'"),
        ("external_engine:fails", "does not load: RuntimeError: no licence"),
        ("external_engine:Half", "is no engine: it has no uplifts, facts, settings, open"),
        ("not an object reference", "does not load: "),
    ],
)
def test_a_broken_engine_is_named_and_breaks_no_other(install: Install, factory: str, words: str) -> None:
    ours = default_runs()
    install(broken=factory)
    with pytest.raises(multibody.BrokenEngineError) as caught:
        find_engine("broken")
    assert str(caught.value).startswith(f"engine 'broken' of the package external {words}")
    assert "\n" not in str(caught.value)
    assert default_runs() == ours
    assert reserved_engines()["broken"] == str(caught.value)
    with pytest.raises(ValueError, match=r"engine must be one of mujoco, .*broken, got 'chrono'"):
        find_engine("chrono")
    still = Case(PIER, duration=1.0, name="still")
    require_runnable(still, Run("mujoco", "recess"))


def test_a_name_that_two_packages_claim_is_nobodys(install: Install) -> None:
    install("one", shared="external_engine:Sound")
    install("two", shared="external_engine:Loud")
    assert multibody.engine_names().count("shared") == 1
    with pytest.raises(multibody.BrokenEngineError, match="declared more than once, by one, two: uninstall"):
        find_engine("shared")


def test_our_names_are_taken(install: Install) -> None:
    install(mujoco="external_engine:fails")
    assert multibody.engine_names() == ("mujoco", "pybullet", "dart", "drake", "exudyn")
    assert type(find_engine("mujoco")).__module__ == "rockwobble.multibody.engines.mujoco_engine"
