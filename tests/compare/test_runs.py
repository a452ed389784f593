from __future__ import annotations

import importlib.util
import re

import pytest

from rockwobble import comparison
from rockwobble.compare import default_runs
from rockwobble.compare.runs.choice import (
    labels_beside_references,
    missing_engines,
    omissions,
    references_of,
    require_runnable,
    reserved_engines,
    run_labels,
    runs_here,
)
from rockwobble.models import Case, Cylinder, InitialState, Run
from rockwobble.multibody import available_engines
from rockwobble.multibody.engines.registry import engine_packages, standard_engines

# of two seconds: 3e-7 of the tilt by its own model was measured, 5e-4 by the other
FOLLOWS = 1e-2


@pytest.fixture
def case(cylinder):
    return Case(cylinder, duration=1.0, name="still")


def test_default_runs_cover_installed_engines_in_recess_and_flat():
    first, second = standard_engines()
    if second not in available_engines():
        pytest.skip(f"{second} is not installed")
    runs = default_runs(engines=(first, second))
    assert [(run.engine, run.support) for run in runs] == [
        (first, "recess"),
        (second, "recess"),
        (first, "flat"),
        (second, "flat"),
    ]


def test_an_engine_without_a_wheel_is_left_out_and_refused_by_name(monkeypatch, case):
    name = standard_engines()[1]  # PyBullet, or its replacement where it has no wheel
    package, find = engine_packages()[name], importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda asked: None if asked == package else find(asked))
    assert name not in available_engines()
    assert name in missing_engines()
    assert name not in {run.engine for run in default_runs()}
    with pytest.raises(ValueError, match=f"'{name}' is not installed here: pip install '?{package}"):
        require_runnable(case, Run(name, "recess"))


def test_a_suite_replaces_an_engine_that_has_no_wheel(monkeypatch):
    if "dart" not in available_engines():
        pytest.skip("dart is not installed")
    place = {"pybullet": "dart"}.get
    monkeypatch.setattr("rockwobble.compare.runs.choice.stand_in", place)
    lacks = {"pybullet": "is not installed here"}
    monkeypatch.setattr("rockwobble.compare.runs.choice.engine_fault", lambda name: lacks.get(name, ""))
    runs = [Run(name, place) for name in ("mujoco", "pybullet", "dart") for place in ("recess", "ring")]
    chosen, said = runs_here(runs)
    assert chosen == [
        Run("mujoco", "recess"),
        Run("mujoco", "ring"),
        Run("dart", "recess"),  # in place of PyBullet, and once
        Run("dart", "ring"),  # unchanged, to be refused
    ]
    assert said == ["pybullet has no wheel here, dart takes its place"]
    assert Run("pybullet", "recess") in runs_here(runs, ["pybullet"])[0]  # to be refused by name


def test_a_suite_drops_missing_engines_but_not_extras(monkeypatch):
    packages, find = engine_packages().values(), importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name in packages else find(name))
    name = standard_engines()[0]
    runs = [Run(name, "recess"), Run(None, "recess"), Run("drake", "recess")]
    chosen, (said,) = runs_here(runs)
    assert chosen == runs[1:]
    assert re.fullmatch(rf"{name} is not installed here: pip install .*; it is left out", said)


def test_exudyn_is_no_default_and_is_refused_where_unsuitable(monkeypatch, case):
    if "exudyn" not in available_engines():
        pytest.skip("exudyn is not installed")
    assert "exudyn" not in {run.engine for run in default_runs()}
    assert reserved_engines()["exudyn"] == "exudyn has no recess support and no uplift"
    # a named engine runs on flat ground; a named support is unchanged, and refused
    assert default_runs(engines=("exudyn",)) == (Run("exudyn", "flat"),)
    (recess,) = default_runs(engines=("exudyn",), supports=("recess",))
    with pytest.raises(ValueError, match="support must be flat in exudyn, got 'recess'"):
        require_runnable(case, recess)
    with pytest.raises(ValueError, match="exudyn cannot uplift a cylinder that stands"):
        require_runnable(case, Run("exudyn", "flat"))
    released = Case(case.cylinder, initial=InitialState(0.1), duration=1.0, name="released")
    require_runnable(released, Run("exudyn", "flat"))
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "exudyn" else find(name))
    # an extra that is not installed is an error only where it is named
    assert "exudyn" not in missing_engines()
    with pytest.raises(ValueError, match=r"'exudyn' is not installed here: pip install 'exudyn"):
        require_runnable(released, Run("exudyn", "flat"))


def labels(case: Case, run: Run, reference: Run | None = None) -> list[str]:
    return list(references_of(case, run, str(run), reference))


def test_each_run_is_compared_with_the_references_of_its_support(case):
    recess, flat = Run(None, "recess"), Run(None, "flat")
    assert labels(case, Run("mujoco", "recess")) == ["recess model"]
    assert labels(case, Run("mujoco", "flat")) == ["recess model", "flat-ground model"]
    assert labels(case, Run("mujoco", "flat"), flat) == ["flat-ground model"]
    assert labels(case, Run("mujoco", "flat"), Run("pybullet", "flat")) == ["pybullet flat"]
    assert labels(case, recess, recess) == []
    references = references_of(case, Run("mujoco", "ring", 2e-4), "mujoco ring")
    assert list(references) == ["recess model", "mujoco ring, half the step"]
    assert references["mujoco ring, half the step"] == Run("mujoco", "ring", 1e-4)
    for sought in ("auto", "extrapolated"):  # of the default, as the step is unknown beforehand
        assert labels(case, Run("mujoco", "ring", sought))[1].endswith(", half the default step")


@pytest.mark.slow
def test_an_untouched_ring_follows_the_flat_ground_model():
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    case = Case(pier, initial=InitialState(0.5 * pier.alpha, rolling_rate=0.5), duration=2.0, name="release")
    ring = Run("mujoco", "ring")
    assert ring.own_model == Run(None, "flat")
    own, other = (
        comparison(case, runs=[ring], reference=Run(None, support), workers=1).summary.iloc[0]
        for support in ("flat", "recess")
    )
    assert "wall_contact" not in own["diagnostics"]
    assert own["tilt_rms"] < FOLLOWS * other["tilt_rms"]


def test_a_ring_runs_by_default_on_engines_that_support_it(case):
    assert [(run.engine, run.support) for run in default_runs(supports=["ring"])] == [("mujoco", "ring")]
    both = default_runs(supports=["ring", "flat"])
    assert ("pybullet", "ring") not in [(run.engine, run.support) for run in both]
    if "pybullet" in available_engines():
        assert omissions(["ring", "flat"]) == ("pybullet has no ring support and is left out there",)
        assert ("pybullet", "flat") in [(run.engine, run.support) for run in both]
        with pytest.raises(ValueError, match=r"one of recess, flat in pybullet, got 'ring'"):
            require_runnable(case, *default_runs(["pybullet"], ["ring"]))


def test_labels_are_as_short_as_distinct_labels_can_be():
    runs = [
        Run("mujoco", "recess"),
        Run("mujoco", "flat", 1e-4),
        Run("mujoco", "flat", 5e-5),
        Run("mujoco", "flat", 5e-5, integrator="RK4"),
        Run("mujoco", "flat", 5e-5, integrator="Euler"),
    ]
    assert run_labels(runs) == (
        "mujoco recess",
        "mujoco flat 0.0001 s",
        "mujoco flat 5e-05 s",
        "mujoco flat 5e-05 s integrator=RK4",
        "mujoco flat 5e-05 s integrator=Euler",
    )
    with pytest.raises(ValueError, match=r"must differ, got 'mujoco flat' twice"):
        run_labels([Run("mujoco", "flat")] * 2)


def test_labels_are_unique_beside_references_and_models_of_one_name() -> None:
    fine, coarse = Run("mujoco", "recess", 5e-4), Run("mujoco", "recess", 1e-3)
    assert labels_beside_references([coarse], fine) == (("mujoco recess 0.001 s",), "mujoco recess 0.0005 s")
    assert labels_beside_references([coarse], None) == (("mujoco recess",), "")
    loose = Run(None, "recess", rtol=1e-3)
    assert labels_beside_references([loose, coarse], loose) == (
        ("recess model rtol=0.001", "mujoco recess"),
        "recess model rtol=0.001",
    )
