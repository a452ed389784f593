"""What a fragility takes: methods by name, folders of records, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rockwobble import fragility
from rockwobble.compare.runs.plan import options_of
from rockwobble.models import Cylinder, Run, el_centro_1940, read_records, synthetic_motions
from rockwobble.studies import LIMITS, MEASURES
from rockwobble.studies.fragility.runs import methods_of, own_model
from rockwobble.studies.plans import FragilityPlan

COLUMN = Cylinder(semidiagonal=3.0, tan_alpha=0.15)
MOTIONS = synthetic_motions(12, peak=1.0, seed=4)
RECORDS = Path(__file__).parents[2] / "models" / "records"


def test_methods_by_name():
    methods = methods_of(["worse-plane", "recess", Run("mujoco", "flat"), "flat"], restitution="momentum")
    assert [each.label for each in methods] == [
        "planar x",
        "planar y",
        "worse plane",
        "recess model",
        "mujoco flat",
        "flat-ground model",
    ]
    assert [each.support for each in methods] == ["planar", "planar", "planar", "recess", "flat", "flat"]
    assert methods[0].run == Run(None, "recess", plane=0.0, restitution="momentum")
    assert own_model(methods[4], methods) == "flat-ground model"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"methods": ["planar"]}, "a reduced model must be one of recess, flat"),
        ({"methods": ["recess", "recess"]}, None),
        ({"methods": [Run("mujoco", "recess"), Run("mujoco", "recess")]}, "must differ"),
        ({"limits": ["2 alpha"]}, "limits must be one of uplift"),
        ({"margin": 0.0}, "margin must be above 0, got 0.0"),
        ({"resamples": 1}, "resamples must be a whole number, at least 2, got 1"),
        ({"restitution": 0.9, "methods": ["recess"]}, "restitution is of planar models, got 0.9"),
        ({"step_factor": -1.0}, "step_factor must be above 0, got -1.0"),
        ({"step_factor": 2.0, "methods": ["recess"]}, "step_factor is for engines at their default"),
        (
            {"step_factor": 2.0, "methods": [Run("mujoco", "recess", 1e-4)]},
            "step_factor is for engines at their default",
        ),
    ],
)
def test_bad_input(options, words):
    if words is None:
        assert [each.label for each in methods_of(options["methods"])] == ["recess model"]
        return
    with pytest.raises(ValueError, match=words):
        fragility(COLUMN, MOTIONS, **{"workers": 1, "levels": None, **options})


def test_a_plan_allows_every_measure_and_limit_that_there_is() -> None:
    stated = options_of(FragilityPlan)
    assert (stated["measure"].choices, stated["limits"].choices) == (tuple(MEASURES), tuple(LIMITS))


def test_motions_need_names_and_cylinders_too():
    with pytest.raises(ValueError, match="at least two ground motions with different names, got 2 with 1"):
        fragility(COLUMN, [el_centro_1940()] * 2, levels=[1.0])
    with pytest.raises(ValueError, match="need names"):
        fragility([COLUMN, COLUMN], MOTIONS)


def test_a_folder_of_records_with_its_table(tmp_path):
    for name in ("RSN6_IMPVALL.I_I-ELC270-hor2.AT2", "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"):
        (tmp_path / name).write_bytes((RECORDS / name).read_bytes())
    east, north = "RSN6_IMPVALL.I_I-ELC270-hor2.AT2", "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"
    table = tmp_path / "records.csv"
    table.write_text(f"name,x,y,scale\nas it is,{east},{north},\ndoubled,{east},{north},2\n")
    one, two = read_records(tmp_path)
    assert (one.name, two.name) == ("as it is", "doubled")
    np.testing.assert_array_equal(one.acceleration, el_centro_1940().acceleration)
    assert two.peak == pytest.approx(2.0 * one.peak)
    for text, words in (
        ("x,north\n", "must have the columns x and y"),
        (f"x,y\n{east},\n", "line 2: both horizontal components"),
        (f"x,y,scale\n{east},{north},-1\n", "line 2: scale must be a positive number, got '-1'"),
        (f"x,y\n\n{east},none.AT2\n", "line 3: cannot read the record"),
        (f"x,y,name,scale\n{east},{north},El Centro, 1940,2\n", "line 2: must have 4 cells, got 5"),
        ("x,y\n", "must list ground motions, one in a line, got none"),
    ):
        table.write_text(text)
        with pytest.raises(ValueError, match=words):
            read_records(tmp_path)
    with pytest.raises(ValueError, match="cannot be read"):
        read_records(tmp_path / "nowhere.csv")
