"""Coverage of stated requirements in few runs; the command runs more."""

from __future__ import annotations

import pandas as pd

from benchmarks.needs_coverage import coverage
from rockwobble.models import el_centro_1940


def test_demand_ignores_overturned_runs() -> None:
    stated = pd.DataFrame({"tan_alpha": 0.2, "intensity": [2.0, 60.0], "friction": [9.0, 9.0], "moment": 0.0})
    table = coverage(stated, (20.0, 30.0), [el_centro_1940()], 3, seed=1)
    assert table["standing"].to_list() == [3, 0]
    assert table["friction_covered"].to_list() == [3, 0]
    assert table["moment_covered"].to_list() == [0, 0]
