"""Published validity report compared with its tables, counted independently here."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockwobble.models.finding import Finding
from rockwobble.reports.figures.picture import Picture
from rockwobble.reports.figures.validity import map_pictures, pictures
from rockwobble.reports.pages import page_of
from rockwobble.reports.pages.table import number
from rockwobble.reports.pages.wording import sentence
from rockwobble.studies.validity.limits import cells, contrasts
from rockwobble.studies.validity.study import Validity

pytestmark = [pytest.mark.slow, pytest.mark.checkout]

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "validity"
POINT = ["tan_alpha", "semidiagonal", "intensity"]


@pytest.fixture(scope="module")
def validity() -> Validity:
    return Validity.load(PUBLISHED)


def test_published_validity_page_is_redrawn_exactly(validity: Validity) -> None:
    """Golden page of its kind; `python reports/published/remake.py --redraw` rebuilds it."""
    assert page_of(validity).markdown() == (PUBLISHED / "validity.md").read_text(encoding="utf-8")


def test_map_captions_state_the_records_per_cell(validity: Validity) -> None:
    peaks = validity.tables["peaks"]
    peaks = peaks[peaks["motion"] != "El Centro 1940"]
    fell = peaks[["flat", "recess", "copy"]].mul(np.arctan(peaks["tan_alpha"]), axis="index") >= 1.57
    moves = peaks["least_normal"].notna()
    shown = {
        "bias": ("flat_ratio", ~(fell["flat"] & fell["recess"])),
        "spread": ("flat_90", ~(fell["flat"] & fell["recess"])),
        "sensitivity": ("copy_90", ~(fell["copy"] & fell["recess"])),
        "need-friction": ("friction_90", moves),
        "need-contact": ("normal_10", moves),
        "need-moment": ("moment_90", moves),
    }
    table = cells(validity.tables).set_index(POINT)
    drawn = {picture.name: picture for picture in map_pictures(validity.tables)}
    for name, (column, known) in shown.items():
        counts = known.groupby([peaks[axis] for axis in POINT]).sum()
        assert counts.max() == peaks.groupby(POINT).size().max() > counts.min()
        (fewest,) = re.findall(r"up to 22 .*; gray: (?:fewer than (\d+)|none)", worded(drawn[name]))
        pd.testing.assert_series_equal(
            table[column].isna(), (counts < int(fewest or 1)).reindex(table.index), check_names=False
        )
    shades = drawn["bias"].shades
    assert shades is not None
    assert (shades.low, shades.high) == (-50.0, 50.0)
    assert "beyond ±50 %" in worded(drawn["bias"])


def worded(picture: Picture) -> str:
    assert isinstance(picture.caption, Finding)
    return sentence(picture.caption)


def test_open_marks_are_explained_if_drawn(validity: Validity) -> None:
    table = validity.tables["verification"]
    for resolved in (True, False):
        other = table.assign(resolved=[resolved, *table["resolved"][1:]])
        drawn = pictures(dataclasses.replace(validity, tables={**validity.tables, "verification": other}))
        (picture,) = (each for each in drawn if each.name == "verification")
        assert ("Open marks" in worded(picture)) is not resolved


def test_guide_on_contact_and_clearance_matches_the_tables(validity: Validity) -> None:
    guide = (PUBLISHED.parents[2] / "docs" / "guide" / "limits.md").read_text(encoding="utf-8")
    table = validity.tables["contact"]
    failed = (table[["free_outcome", "outcome"]] != "stands").any(axis="columns")
    stiffer, stiff = (table[np.isclose(table["time_constant"], each)] for each in (2e-4, 2e-3))
    off = (stiff["peak"] / stiff["recess_peak"] - 1.0).abs().max()
    assert not failed[stiff.index].any()
    assert f"errs by at most {number(off, 'most percent')} in all {len(stiff)} runs" in guide
    ended = stiffer[~failed[stiffer.index]]
    (damping,) = set(ended["damping"])
    words = f"only {len(ended)} of {len(stiffer)} ended, all at a damping ratio of {damping:g}"
    assert f"with 0.2 ms {words}" in guide
    table = contrasts(validity.tables)
    ring = table[table["method"] == "ring"]
    assert np.isposinf(ring["ratio_95_high"]).all()
    assert f"in samples of {ring['count'].max()} records (no upper bound is known)" in guide


SIZES = [1.0, 0.07, 0.0996, 0.2, 9.96, 150.0, *10.0 ** np.random.default_rng(7).uniform(-9.0, 9.0, 200)]


@pytest.mark.parametrize("form", [".2g", ".3g", ".2f", "percent"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_bounds_rounded_for_text_hold_and_are_close(form: str, sign: float) -> None:
    for size in SIZES:
        value = sign * float(size)

        def read(bound: str, value: float = value) -> float:
            text = number(value, f"{bound}{form}")
            return float(text.removesuffix(" %")) / (100.0 if text.endswith("%") else 1.0)

        most, least = read("most "), read("least ")
        rounding = 1e-11 * size  # insignificant digits
        assert least - rounding <= value <= most + rounding
        near = [math.isclose(end, read(""), rel_tol=1e-9, abs_tol=1e-15) for end in (least, most)]
        assert any(near), value


def test_exactly_printable_numbers_are_not_rounded() -> None:
    for bound in ("most", "least"):
        assert [number(0.07, f"{bound} percent"), number(0.3, f"{bound} .2g")] == ["7 %", "0.3"]
        assert [number(math.nan, f"{bound} .2g"), number(math.inf, f"{bound} .2f")] == ["–", "∞"]
        assert number(0.0, f"{bound} .2g") == "0"
    assert number(0.1 + 0.2, "most .2g") == "0.3"
