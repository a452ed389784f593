"""Hazard curves: what is refused, and the files of three sources."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import HazardCurve, read_hazard

X, RATE = [0.05, 0.1, 0.2, 0.4, 0.8], [2e-2, 7e-3, 2e-3, 4e-4, 5e-5]


def test_between_its_points_a_curve_is_a_power_law() -> None:
    x = np.geomspace(0.01, 1.0, 7)
    site = HazardCurve(x, 1e-4 * x**-2.3, measure="pga")
    at = np.geomspace(0.01, 1.0, 50)
    assert site.exceedance(at) == pytest.approx(1e-4 * at**-2.3, rel=1e-12)  # rounding
    assert site.intensity_at(1e-3) == pytest.approx(10.0 ** (-1.0 / 2.3), rel=1e-12)


def test_beyond_its_ends_nothing_is_known() -> None:
    site = HazardCurve(X, RATE, measure="pga")
    assert np.isnan(site.exceedance([0.049, 0.81])).all()
    assert math.isnan(site.intensity_at(1e-5))


@pytest.mark.parametrize(
    ("intensity", "frequency", "options", "words"),
    [
        (X, RATE[:-1], {}, "two or more intensities, got 4 for 5"),
        (X[:1], RATE[:1], {}, "two or more intensities"),
        ([0.1, 0.1, 0.2], RATE[:3], {}, "increasing"),
        (X, [2e-2, 7e-3, 7e-3, 4e-4, 5e-5], {}, "must decrease with intensity, got 0.007 at 0.1"),
        (X, [2e-2, 7e-3, 2e-3, 4e-4, 0.0], {}, "must be positive and finite, got 0 at 0.8"),
        (X, [2e-2, 7e-3, math.nan, 4e-4, 1e-5], {}, "must be positive and finite"),
        (X, RATE, {"measure": "pgd"}, "the measure of a hazard curve"),
        (X, RATE, {"measure": "sa"}, "needs the period"),
        (X, RATE, {"period": 1.0}, "a period belongs to sa"),
        (X, RATE, {"measure": "sa", "period": -1.0}, "period must be positive"),
    ],
)
def test_what_is_no_curve_is_refused(
    intensity: list[float], frequency: list[float], options: dict[str, object], words: str
) -> None:
    with pytest.raises(ValueError, match=words):
        HazardCurve(intensity, frequency, **{"measure": "pga", **options})  # type: ignore[arg-type]


def usgs(newer: bool) -> str:
    imt = {"value": "SA0P2", "display": "0.20 Second Spectral Acceleration"}
    other = {"component": "Fault", "yvalues": [1e-9] * 5, "values": {"xs": X, "ys": [1e-9] * 5}}
    total = {"component": "Total", "yvalues": RATE, "values": {"xs": X, "ys": RATE}}
    if newer:
        return json.dumps({"response": {"hazardCurves": [{"imt": imt, "data": [other, total]}]}})
    return json.dumps({"response": [{"metadata": {"imt": imt, "xvalues": X}, "data": [other, total]}]})


def openquake(imt: str) -> str:
    probabilities = [-math.expm1(-50.0 * rate) for rate in RATE]
    head = ",".join(f"poe-{x:.7f}" for x in X)
    row = ",".join(f"{p!r}" for p in probabilities)
    stated = f"generated_by='OpenQuake engine 3.16.3', kind='mean', investigation_time=50.0, imt='{imt}'"
    comment = f'#,,,,,,,"{stated}"'
    return f"{comment}\nlon,lat,depth,{head}\n1.0,2.0,0.0,{row}\n"


@pytest.mark.parametrize(
    ("text", "options"),
    [
        ("pga_g,annual_frequency\n" + "\n".join(f"{x},{y}" for x, y in zip(X, RATE, strict=True)), {}),
        ("# site\n" + "\n".join(f"{x} {y}" for x, y in zip(X, RATE, strict=True)), {}),
        (
            "pga;poe\n" + "\n".join(f"{x};{-math.expm1(-50 * y)!r}" for x, y in zip(X, RATE, strict=True)),
            {"years": 50.0},
        ),
        ("a,f\n" + "\n".join(f"{9.81 * x!r},{y}" for x, y in zip(X, RATE, strict=True)), {"units": "m/s2"}),
        ("PGA (g), rate [1/a]\n" + "\n".join(f"{x}, {y}" for x, y in zip(X, RATE, strict=True)), {}),
        (
            "PGA in g;Rate\n" + "\n".join(f"{x};{y}" for x, y in zip(X, RATE, strict=True)).replace(".", ","),
            {},
        ),
        (openquake("PGA"), {}),
        (openquake("SA(0.2)"), {"measure": "sa_mean", "period": 0.2}),
        (usgs(newer=False), {"measure": "sa_mean", "period": 0.2}),
        (usgs(newer=True), {"measure": "sa", "period": 0.2}),
    ],
)
def test_each_source_gives_the_same_curve(text: str, options: dict[str, object], tmp_path: Path) -> None:
    path = tmp_path / "site.txt"
    path.write_text(text)
    site = read_hazard(path, **{"measure": "pga", **options})  # type: ignore[arg-type]
    assert site.intensity == pytest.approx(X, rel=1e-12)
    assert site.annual_frequency == pytest.approx(RATE, rel=1e-9)  # of the logarithm of 1 - p
    assert site.name == "site"


def test_a_saturated_beginning_and_an_empty_end_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "site.csv"
    path.write_text("x,f\n0.01,0.05\n0.02,0.05\n0.1,0.01\n0.5,0.0001\n1,0\n2,0\n")
    assert read_hazard(path, measure="pga").intensity == pytest.approx([0.02, 0.1, 0.5])


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (openquake("PGA"), {"measure": "pgv"}, "is of PGA, not of PGV"),
        (openquake("SA(0.2)"), {"measure": "sa", "period": 1.0}, r"is of SA\(0.2\), not of SA at 1 s"),
        (usgs(newer=True), {}, "is of SA0P2, not of PGA"),
        (openquake("PGA"), {"site": 2}, "site must be from 1 to 1, got 2"),
        ('{"response": {}}', {}, "no hazard curve of the USGS"),
        ("{", {}, "no hazard curve of the USGS"),
        ("pga,poe_50\n0.1,0.1\n0.2,0.01\n", {}, "in how many years"),
        ("pga,poe\n0.1,1.0\n0.2,0.01\n", {"years": 50.0}, "below 1, got 1"),
        ("1,2,3\n", {}, "two columns"),
        ("", {}, "two columns"),
        ("0.1,x\n0.2,1\n", {}, "expected two numbers"),
        ("0.1,0.2\n0.2,0.1\n", {"units": "m/s"}, "units of a hazard curve"),
    ],
)
def test_a_file_that_is_not_what_was_asked_for_is_refused(
    text: str, options: dict[str, object], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "site.txt"
    path.write_text(text)
    with pytest.raises(ValueError, match=words):
        read_hazard(path, **{"measure": "pga", **options})  # type: ignore[arg-type]


def test_a_missing_file_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"cannot read the hazard curve .*none\.csv: No such file"):
        read_hazard(tmp_path / "none.csv", measure="pga")


GRAVITY = 9.81  # [m/s^2] of 1 g in every file
# measure: units of its intensity in those of the curve, g or m/s
UNITS = {
    "pga": {"g": 1.0, "m/s2": 1.0 / GRAVITY, "cm/s2": 0.01 / GRAVITY},
    "pga_resultant": {"g": 1.0, "m/s2": 1.0 / GRAVITY, "cm/s2": 0.01 / GRAVITY},
    "pgv": {"m/s": 1.0, "cm/s": 0.01},
    "pgv_resultant": {"m/s": 1.0, "cm/s": 0.01},
    "sa": {"g": 1.0, "m/s2": 1.0 / GRAVITY, "cm/s2": 0.01 / GRAVITY},
    "sa_mean": {"g": 1.0, "m/s2": 1.0 / GRAVITY, "cm/s2": 0.01 / GRAVITY},
}
ALL_UNITS = ["g", "m/s2", "cm/s2", "m/s", "cm/s"]


@pytest.mark.parametrize("measure", UNITS)
@pytest.mark.parametrize("years", [None, 1.0, 50.0, 475.0])
def test_any_curve_is_read_in_every_unit_of_its_measure(
    measure: str, years: float | None, tmp_path: Path
) -> None:
    chance = np.random.default_rng(6)
    period = 0.7 if measure.startswith("sa") else None
    intensity = np.cumsum(chance.uniform(0.01, 0.2, 12))
    frequency = np.cumprod(chance.uniform(0.2, 0.9, 12)) * 0.02
    second = frequency if years is None else 1.0 - np.exp(-frequency * years)
    path = tmp_path / "site.csv"
    for units in [None, *ALL_UNITS]:
        factor = UNITS[measure].get(units or "", 1.0)
        rows = zip((intensity / factor).tolist(), second.tolist(), strict=True)
        path.write_text("x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in rows))
        options = {"measure": measure, "period": period, "years": years, "units": units}
        if units is not None and units not in UNITS[measure]:
            with pytest.raises(
                ValueError, match=rf"must be one of {', '.join(UNITS[measure])}, got '{units}'"
            ):
                read_hazard(path, **options)
            continue
        site = read_hazard(path, **options)
        assert site.intensity == pytest.approx(intensity, rel=1e-12)
        assert site.annual_frequency == pytest.approx(frequency, rel=1e-9)  # digits of 1 - p
        assert site.title.endswith(f"[{'m/s' if 'pgv' in measure else 'g'}]")
        assert ("T = 0.7 s" in site.title) == (period is not None)
        # a point of the curve is met from both sides, and halfway in both logarithms its geometric mean
        for one, two in zip(range(11), range(1, 12), strict=True):
            middle = math.sqrt(intensity[one] * intensity[two])
            rate = math.sqrt(frequency[one] * frequency[two])
            assert site.exceedance([intensity[one], middle]) == pytest.approx(
                [frequency[one], rate], rel=1e-8
            )
            assert site.intensity_at(rate) == pytest.approx(middle, rel=1e-8)


@pytest.mark.parametrize("site", [1, 2, 3])
@pytest.mark.parametrize("years", [1.0, 50.0])
def test_each_site_of_a_file_of_openquake_has_its_own_curve(site: int, years: float, tmp_path: Path) -> None:
    rates = np.outer([1.0, 0.5, 0.25], RATE)
    head = ",".join(f"poe-{x:.7f}" for x in X)
    rows = "".join(
        f"{place},2.0,0.0," + ",".join(repr(-math.expm1(-years * rate)) for rate in of_site) + "\n"
        for place, of_site in enumerate(rates.tolist())
    )
    path = tmp_path / "hazard.csv"
    path.write_text(f"#,\"investigation_time={years}, imt='SA(0.7)'\"\nlon,lat,depth,{head}\n{rows}")
    found = read_hazard(path, measure="sa", period=0.7, site=site)
    assert found.annual_frequency == pytest.approx(rates[site - 1], rel=1e-9)
    for period in (0.69, 0.71, 7.0):
        with pytest.raises(ValueError, match=r"is of SA\(0\.7\), not of SA"):
            read_hazard(path, measure="sa", period=period)
    for beyond in (0, 4):
        with pytest.raises(ValueError, match=f"site must be from 1 to 3, got {beyond}"):
            read_hazard(path, measure="sa", period=0.7, site=beyond)
