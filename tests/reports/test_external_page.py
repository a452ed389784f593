"""What a page says of an external trajectory: of each code its words and value."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pandas as pd
import pytest

from rockwobble.compare.external.mistakes import WORDS, Mistake
from rockwobble.compare.external.verdict import NO_VERDICT
from rockwobble.reports.pages.comparison import external_rows

WRONG = {
    "differs_in": ("azimuth", "path"),
    "azimuth_rms": 10.0,
    "path_rms": 0.001,
    "azimuth_differs_from": 2.8,
    "path_differs_from": 5.96,
    "likely_mistake": ("turned_back",),
    "likely_mistake_in": ("axes",),
    "likely_mistake_value": (math.nan,),
}


def row(**values: Any) -> Any:
    common = {"run": "table", "support": "external", "uplift_time_difference": 0.004}
    return SimpleNamespace(**common | {"uplift_direction_difference": -0.5} | NO_VERDICT | values)


def table(*rows: Any) -> pd.DataFrame:
    return pd.DataFrame([vars(each) for each in rows])


@pytest.mark.parametrize("code", WORDS)
def test_each_code_has_words_with_its_value(code: str) -> None:
    values = {"length_unit": (1e-2, 1e3)}.get(code, (0.905, 1.005))
    low, high = (Mistake(code=code, concerns="axes", value=value).words for value in values)
    assert "{" not in low + high
    has_value = "{" in "".join(WORDS[code]).replace("{its}", "")
    assert (low != high) == (has_value or not isinstance(WORDS[code], str))


def test_the_table_has_the_numbers_and_codes_of_each_external_trajectory() -> None:
    engine = row(support="recess", run="mujoco recess")
    (line,) = external_rows(table(engine, row(**WRONG, uplift_time_uncertainty=0.012)))
    names = ("run", "azimuth_rms", "azimuth_differs_from", "path_rms", "path_differs_from", "uplift")
    assert [line[name] for name in names] == ["table", 10.0, 2.8, 0.001, 5.96, 0.004]
    assert (line["differs_in"], line["likely_mistake"]) == ("azimuth; path", "axes: turned_back")
    # of the direction nothing is known
    assert (line["direction"], line["direction_uncertainty"]) == (None, None)
    (other,) = external_rows(table(row(uplift_direction_uncertainty=4.0)))
    assert (other["direction"], other["direction_uncertainty"]) == (math.degrees(-0.5), 180.0)
    assert external_rows(table(engine)) == []
