"""The wobbling frame as a value, in place of a cylinder."""

from __future__ import annotations

import pickle
from typing import Any

import pytest

from rockwobble.models import Case, Cylinder, RockingBody, WobblingFrame, read_suite
from rockwobble.models.trace_file import case_from_plain

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2, axial_inertia=1.1)
SUITE = """
[[cases]]
name = "pier"
cylinder = { base_radius = 1, height = 10, slab_mass_ratio = [0, 4], columns = COUNT }
release = { tilt_over_alpha = 0.5 }
duration = 4
"""


def test_a_frame_has_the_dimensions_of_its_columns() -> None:
    frame = WobblingFrame(PIER, slab_mass_ratio=2.0, columns=4)
    for name in ("semidiagonal", "tan_alpha", "alpha", "base_radius", "mass_centre_height", "half_height"):
        assert getattr(frame, name) == getattr(PIER, name)
    assert (frame.cylinder, frame.slab_mass_ratio, frame.columns) == (PIER, 2.0, 4)
    assert (frame.axial_inertia, frame.transverse_inertia) == (1.1, None)


def test_a_frame_is_frozen_hashable_and_pickled() -> None:
    frame = WobblingFrame(PIER, 2.0)
    assert frame == WobblingFrame(PIER, slab_mass_ratio=2, columns=3) != WobblingFrame(PIER, 2.0, 4)
    assert PIER != WobblingFrame(PIER, 0.0) != PIER
    assert len({frame, pickle.loads(pickle.dumps(frame)), frame.cylinder, PIER}) == 2
    with pytest.raises(AttributeError):
        frame.columns = 5  # type: ignore[misc]


def test_the_repr_of_a_frame_evaluates_to_it() -> None:
    frame = WobblingFrame(PIER, 0.25, 5)
    assert eval(repr(frame)) == frame
    assert "slab_mass_ratio=0.25" in repr(Case(frame, duration=1.0))


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"slab_mass_ratio": 1e308}, "slab_mass_ratio must be from 0 to 1e"),
        ({"columns": 0}, "columns"),
        ({"columns": 2}, "columns"),
        ({"columns": 3.5}, "columns"),
        ({"columns": True}, "columns"),
        ({"cylinder": WobblingFrame(PIER)}, "cylinder"),
        ({"cylinder": Cylinder(semidiagonal=6.0, tan_alpha=0.2, height=8.0)}, "mass centre"),
    ],
)
def test_an_invalid_frame_is_refused_in_one_line(given: dict[str, Any], named: str) -> None:
    with pytest.raises(ValueError, match=named) as refused:
        WobblingFrame(**{"cylinder": PIER, **given})
    assert "\n" not in str(refused.value)


def test_a_case_of_a_frame_comes_back_from_plain_values() -> None:
    frame = WobblingFrame(PIER, 0.5, 1)
    plain = {"cylinder": {**dict.fromkeys(("height", "transverse_inertia")), "semidiagonal": 6.0,
                          "tan_alpha": 0.2, "axial_inertia": 1.1, "slab_mass_ratio": 0.5, "columns": 1},
             "motion": None, "initial": None, "duration": 2.0, "gravity": 9.81, "friction": 1.0,
             "name": "a"}  # fmt: skip
    assert case_from_plain(plain).cylinder == frame


def test_a_suite_file_holds_frames(tmp_path: Any) -> None:
    path = tmp_path / "frame.suite.toml"
    path.write_text(SUITE.replace("COUNT", "4"))
    bodies = [case.cylinder for case in read_suite(path).cases]
    pier = Cylinder.from_dimensions(base_radius=1.0, height=10.0)
    assert bodies == [WobblingFrame(pier, ratio, 4) for ratio in (0.0, 4.0)]
    path.write_text(SUITE.replace("COUNT", "2"))
    with pytest.raises(ValueError, match=r"cases\[0\].cylinder: columns"):
        read_suite(path)


def test_frames_and_cylinders_share_an_interface_but_not_a_class() -> None:
    frame = WobblingFrame(PIER, 0.0)
    assert not isinstance(frame, Cylinder)
    assert (PIER.slab_mass_ratio, PIER.columns) == (0.0, 1)
    asked = [name for name in dir(RockingBody) if not name.startswith("_")]
    for name in asked:
        assert (getattr(PIER, name) == getattr(frame, name)) == (name not in ("carries_slab", "columns")), (
            name
        )
