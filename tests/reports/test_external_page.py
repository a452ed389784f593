"""What a page says of an external trajectory: of each code its words and value, and what it explains."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import pandas as pd
import pytest

from rockwobble.compare.external.mistakes import AXES_WORDS, WORDS, Mistake
from rockwobble.compare.external.verdict import NO_VERDICT
from rockwobble.reports.pages.comparison import external_rows
from rockwobble.reports.pages.findings import agreement_words, cause, explains_divergence, headline, notes

if TYPE_CHECKING:
    from rockwobble.reports.figures.case_view import CaseView

AGREES = {"azimuth_rms": 0.2, "path_rms": 0.001, "tilt_bound": 0.01, "noise": 0.0}
WRONG = {
    "differs_in": ("azimuth", "path"),
    "azimuth_rms": 10.0,
    "azimuth_differs_from": 2.8,
    "path_differs_from": 5.96,
    "likely_mistake": ("turned",),
    "likely_mistake_in": ("axes",),
    "likely_mistake_value": (10.0,),
    "agreement_without_mistake": 8.0,
}
SLOWER = WRONG | {
    "differs_in": ("tilt",),
    "likely_mistake": ("time_scale",),
    "likely_mistake_in": ("time",),
    "likely_mistake_value": (1.005,),
}


def row(**values: Any) -> Any:
    common = {
        "run": "table",
        "engine": "table",
        "support": "external",
        "reference": "recess model",
        "reference_engine": "reduced",
        "reference_support": "recess",
        "case": "El Centro",
        "predicted_by": "",
        "outcome": "stands",
        "reference_outcome": "stands",
        "peak_tilt": 0.25,
        "reference_peak_tilt": 0.25,
        "agreement_time": 8.0,
        "diverged": False,
        "agreed_passes": 3,
        "predicted_agreement_time": 8.0,
        "contact_resolution": math.nan,
        "closest_pass": 0.003,
        "divergence": "",
        "whole_rms": math.nan,
        "uplift_time_difference": 0.004,
        "uplift_direction_difference": -0.5,
    }
    values = common | NO_VERDICT | AGREES | values
    until = 1.7 if values["diverged"] else 0.0  # the uplift, where a length counts from it
    tolerances = {
        "reference_uplift_time": 1.7,
        "tolerance": 0.01,
        "left_tolerance": values["diverged"],
        "within_tolerance_until": values["agreement_time"] + until,
        "predicted_until": values["predicted_agreement_time"],
    }
    return SimpleNamespace(**(tolerances | values))


def page(given: Any) -> str:
    case = SimpleNamespace(length=8.0, name="El Centro", cylinder=None)
    facts: dict[str, tuple[()]] = {given.run: (), given.reference: ()}
    return notes(cast("CaseView", SimpleNamespace(case=case, rows=table(given), traces={}, facts=facts)))


def table(*rows: Any) -> pd.DataFrame:
    return pd.DataFrame([vars(each) for each in rows])


def test_numbers_of_a_row_stand_on_its_page() -> None:
    assert "8.0 s" in headline(table(row()), 8.0)
    assert "azimuth" in headline(table(row(**WRONG)), 8.0)
    assert "azimuth" in headline(table(row(not_compared=("azimuth",), azimuth_rms=math.nan)), 8.0)
    assert "9.7 s" in page(row(**WRONG))  # the uplift at 1.7 s and 8 s without the mistake
    assert "3.4 %" in agreement_words(row(tilt_bound=0.034))


CODES = {
    "time_offset": (-0.3, "0.300 s late"),
    "time_scale": (1.005, "R +1.00 %"),
    "time_unit": (1e3, "ms"),
    "angle_unit": (math.degrees(1.0), "degrees"),
    "length_unit": (1e2, "cm"),
    "origin": (5.88, "5.88 m"),
    "turned": (12.5, "12.5 deg"),
    "mirrored": (25.0, "25.0 deg"),
    **dict.fromkeys((*WORDS, *AXES_WORDS), (math.nan, "")),
}


@pytest.mark.parametrize("code", CODES)
def test_each_code_has_its_words_and_value_on_the_page(code: str) -> None:
    value, part = CODES[code]
    given = row(**WRONG | {"likely_mistake": (code,), "likely_mistake_value": (value,)})
    words = Mistake(code=code, concerns="axes", value=value).words
    assert part in words
    assert words in page(given)
    assert words in headline(table(given), 8.0)


def test_only_what_changes_tilts_is_a_reason_for_them_to_diverge() -> None:
    slower, turned = (
        row(**{**given, "diverged": True, "differs_in": ("tilt",)}) for given in (SLOWER, WRONG)
    )
    assert (explains_divergence(slower), explains_divergence(turned)) == (True, False)
    assert (cause(slower, 8.0), cause(turned, 8.0)) == ("mistake", "near passes")
    # without a reason that can be taken back, only distributions compare
    assert "distributions" not in page(slower)
    assert "distributions" in page(turned)


def test_the_table_has_the_numbers_and_codes_of_each_external_trajectory() -> None:
    engine = row(support="recess", run="mujoco recess")
    (line,) = external_rows(table(engine, row(**WRONG, uplift_time_uncertainty=0.012)))
    names = ("run", "azimuth_rms", "azimuth_differs_from", "path_rms", "path_differs_from", "uplift")
    assert [line[name] for name in names] == ["table", 10.0, 2.8, 0.001, 5.96, 0.004]
    assert (line["differs_in"], line["likely_mistake"]) == ("azimuth; path", "axes: turned")
    # of the direction nothing is known
    assert (line["direction"], line["direction_uncertainty"]) == (None, None)
    (other,) = external_rows(table(row(uplift_direction_uncertainty=4.0)))
    assert (other["direction"], other["direction_uncertainty"]) == (math.degrees(-0.5), 180.0)
    assert external_rows(table(engine)) == []
