"""The suites that ship."""

from __future__ import annotations

from pathlib import Path

import pytest

from rockwobble import models
from rockwobble.models import read_suite, shipped_suites


@pytest.mark.parametrize("name", ["quick", "canon"])
def test_the_suites_that_ship_can_be_read_by_name(name):
    suite = read_suite(name)
    folder = Path(str(models.__path__[0])) / "suites"
    again = read_suite(folder / f"{name}.suite.toml")
    assert [case.name for case in suite.cases] == [case.name for case in again.cases]
    assert {run.engine for run in suite.runs} == {"mujoco", "pybullet"}
    assert name in shipped_suites()


def test_the_canon_is_as_large_and_as_various_as_it_says():
    cases = read_suite("canon").cases
    assert len(cases) >= 40
    groups = {case.name.split(":")[0].split(",")[0] for case in cases}
    assert {"free response", "steady wobble", "one-sine pulse from rest", "El Centro"} <= groups


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ValueError, match=r"none\.toml: No such file.*that ship are canon, p695, quick"):
        read_suite(tmp_path / "none.toml")
