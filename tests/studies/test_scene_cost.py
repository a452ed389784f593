"""What a scene costs: the counts are exact, the times are times."""

from __future__ import annotations

import pytest

from rockwobble import multibody
from rockwobble.compare.runs.progress import Progress, stages
from rockwobble.studies.scene_cost import scene_costs

ENGINES = multibody.available_engines()


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES)
def test_every_scene_is_counted(engine: str) -> None:
    events: list[Progress] = []
    table = scene_costs([engine], rounds=2, steps=20, stage=stages(events.append, [1.0, 1.0]))
    assert [each.label for each in events[::2]] == ["scenes, round 1 of 2", "scenes, round 2 of 2"]
    assert set(table["engine"]) == {engine}
    assert (table["degrees_of_freedom"] == 6).all()
    assert (table["microseconds"] > 0.0).all()
    assert (table["ratio"] == 1.0).any()
    counts = {
        (row.support, row.option): (row.contacts, row.constraint_rows)
        for row in table.itertuples(index=False)
    }
    assert len(counts) == len(table)
    # a rim stands on one point, with a normal and two directions of friction
    contacts = {key: value for key, value in counts.items() if key[1] == "released"}
    assert set(contacts.values()) == {(0, 3) if engine == "exudyn" else (1, 3)}  # a joint has no contact
    if engine == "mujoco":
        # a prism stands on four corners, and the cylinder itself is not in contact while it has them
        for corners in (4, 12, 48):
            assert counts["recess", f"standing on {corners} corners"] == (corners, 3 * corners)
        # a pyramid of four edges
        assert counts["recess", "pyramidal cone"] == (1, 4)
        # walls that are out of reach are no contact
        assert counts["ring", "32 walls"] == (1, 3)


def test_bad_input_is_refused() -> None:
    with pytest.raises(ValueError, match="engine must be one of mujoco, pybullet"):
        scene_costs(["chrono"])
    with pytest.raises(ValueError, match="rounds and steps must be positive, got 0 and 5"):
        scene_costs(rounds=0, steps=5)
