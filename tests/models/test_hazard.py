"""Hazard curves: refusals, and one curve in every form of a file."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest

from rockwobble.models import HazardCurve, read_hazard

X, RATE = [0.05, 0.1, 0.2, 0.4, 0.8], [2e-2, 7e-3, 2e-3, 4e-4, 5e-5]
G = 9.81  # [m/s^2] of 1 g in every file
UNITS = {
    "pga": {"g": 1.0, "m/s2": G, "cm/s2": 100.0 * G, "Gal": 100.0 * G, "%g": 100.0},
    "pgv": {"m/s": 1.0, "cm/s": 100.0, "in/s": 1.0 / 0.0254},
}


def test_between_its_points_a_curve_is_a_power_law() -> None:
    x = np.geomspace(0.01, 1.0, 7)
    site = HazardCurve(x, 1e-4 * x**-2.3, measure="pga")
    at = np.geomspace(0.01, 1.0, 50)
    assert site.exceedance(at) == pytest.approx(1e-4 * at**-2.3, rel=1e-12)  # rounding
    assert site.intensity_at(1e-3) == pytest.approx(10.0 ** (-1.0 / 2.3), rel=1e-12)
    assert np.isnan(site.exceedance([0.009, 1.1])).all()
    assert math.isnan(site.intensity_at(1e-5))


def test_an_invalid_hazard_curve_is_refused() -> None:
    for intensity, frequency, options, words in (
        (X, RATE[:-1], {}, "got 4 for 5"),
        (X[:1], RATE[:1], {}, "two or more intensities"),
        ([0.1, 0.1, 0.2], RATE[:3], {}, "increasing"),
        (X, [2e-2, 7e-3, 7e-3, 4e-4, 5e-5], {}, "got 0.007 at 0.2"),
        (X, [2e-2, 7e-3, 2e-3, 4e-4, 0.0], {}, "got 0 at 0.8"),
        (X, [2e-2, 7e-3, math.nan, 4e-4, 1e-5], {}, "got nan at 0.2"),
        (X, RATE, {"measure": "pgd"}, "the measure of a hazard curve"),
        (X, RATE, {"measure": "sa"}, "needs the period"),
        (X, RATE, {"period": 1.0}, "a period belongs to sa"),
    ):
        with pytest.raises(ValueError, match=words):
            HazardCurve(intensity, frequency, **{"measure": "pga", **options})  # type: ignore[arg-type]


@pytest.mark.parametrize(("measure", "doubtful"), [("pga", True), ("pgv", True), ("sa", False)])
def test_half_a_curve_beyond_strong_shaking_is_doubted(measure: str, doubtful: bool) -> None:
    more = 16.0 if doubtful else 14.0  # the middle is at 0.2
    site = HazardCurve(more * np.array(X), RATE, measure=measure, period=1.0 if measure == "sa" else None)
    assert [fact.code for fact in site.doubts] == ["large_hazard"] * doubtful


def read(tmp_path: Path, text: str, **options: object) -> HazardCurve:
    path = tmp_path / "site.csv"
    path.write_text(text, encoding="utf-8")
    return read_hazard(path, **{"measure": "pga", **options})  # type: ignore[arg-type]


def quantities(rate: np.ndarray) -> list[tuple[str, np.ndarray]]:
    in_50, in_475 = (-np.expm1(-years * rate) for years in (50.0, 475.0))
    return [
        ("annual frequency of exceedance", rate),
        ("Rate [1/yr]", rate),
        ("AFE", rate),
        ("lambda (1/a)", rate),
        ("annual_probability", -np.expm1(-rate)),
        ("probability of exceedance in 50 years", in_50),
        ("PoE (475 yr)", in_475),
        ("return period (years)", 1.0 / rate),
        ("TR", 1.0 / rate),
    ]


def table(columns: list[tuple[str, np.ndarray]], separator: str, *, falls: bool) -> str:
    names, values = zip(*columns, strict=True)
    rows = np.column_stack(values)[:: -1 if falls else 1]
    lines = [separator.join(f"{each!r}" for each in row) for row in rows.tolist()]
    text = "\n".join(lines)
    return separator.join(names) + "\n" + (text.replace(".", ",") if separator == ";" else text) + "\n"


def test_one_curve_in_any_form_is_the_same_curve(tmp_path: Path) -> None:
    """Any unit, order of columns and rows, separator, and frequency, probability or return period."""
    chance = np.random.default_rng(6)
    for measure, (unit, factor), form in itertools.product(
        UNITS, [*UNITS["pga"].items(), *UNITS["pgv"].items()], range(9)
    ):
        x, rate = np.cumsum(chance.uniform(0.01, 0.2, 8)), np.cumprod(chance.uniform(0.2, 0.9, 8)) * 0.02
        name = ("{} ({})", "{} in {}", "{}_{}")[form % 3].format(measure.upper(), unit)
        columns = [(name, factor * x), quantities(rate)[form]]
        text = table(columns[:: 1 - 2 * chance.integers(2)], ",;\t"[form // 3], falls=chance.random() < 0.5)
        if unit not in UNITS[measure]:
            with pytest.raises(ValueError, match="is no unit of"):
                read(tmp_path, text, measure=measure)
            continue
        site = read(tmp_path, text, measure=measure)
        assert site.intensity == pytest.approx(x, rel=1e-12)
        assert site.annual_frequency == pytest.approx(rate, rel=1e-8)  # digits of 1 - p
        assert name in site.source
        assert site.title.endswith(f"[{'m/s' if measure == 'pgv' else 'g'}]")


ROWS = "\n" + "".join(f"{x},{y}\n" for x, y in zip(X, RATE, strict=True))


def test_facts_missing_from_a_header_are_asked_for(tmp_path: Path) -> None:
    gal, rate = X[0] / UNITS["pga"]["Gal"], -math.log1p(-RATE[0]) / 50.0
    for header, option, value, first in (
        ("PGA,AFE", "units", "Gal", (gal, RATE[0])),
        ("PGA (g),probability", "years", 50.0, (X[0], rate)),
    ):
        with pytest.raises(ValueError, match=option):
            read(tmp_path, header + ROWS)
        site = read(tmp_path, header + ROWS, **{option: value})
        assert (site.intensity[0], site.annual_frequency[0]) == pytest.approx(first)


MISNAMED = (
    *("x,y", "PGA,PGA", "AFE,TR", "0.01,0.9", "PGA (g),rate", "PGA (g),AFE x 1e-3"),
    *("PGA (g),10% in 50 years", "PGA (g),poe 50 years (%)", "PGA (g),return period (days)"),
    *("PGA (g),annual probability of non-exceedance", "PGA (g),annual probability in 50 years"),
)
INTENSITIES = ("ln(PGA)", "PGD (cm)", "site (g)", "Sa (5%) (g)")


def test_a_table_that_could_be_read_wrongly_is_refused(tmp_path: Path) -> None:
    sa: dict[str, object] = {"measure": "sa", "period": 0.6}
    for header, options, words in (
        *((header, {"units": "g"}, "must name one column") for header in MISNAMED),
        *(
            (f"{title},AFE", {}, "no intensity")
            for title in ("ln(PGA)", "PGD (cm)", "site (g)", "Sa (5%) (g)")
        ),
        ("PGV (cm/s),AFE", {}, "is of 'PGV"),
        ("PGA (0.5 s) (g),AFE", {}, "is of 'PGA"),
        ("Sa(0.5 s) (g),AFE", sa, "is of 'Sa"),
        ("PGA (g),AFE", {"units": "m/s2"}, "is in g, got units m/s2"),
        ("PGA (g),AFE", {"units": "inch"}, "units of a hazard curve"),
        ("PGA (g),AFE", {"years": 50.0}, "years belong to a probability"),
        ("PGA (g),probability in 50 years", {"years": 10.0}, "is of 50 years"),
        ("PGA (g),AFE", {"site": 1}, "no file of OpenQuake"),
        ("PGA (g),TR", {}, "decrease"),
        ("name,lon,lat,0.1,0.2", {}, "two columns"),
        ('{"response":', {}, "two columns"),
    ):
        with pytest.raises(ValueError, match=words) as refusal:
            read(tmp_path, header + ROWS, **options)
        assert "\n" not in str(refusal.value)
        assert "array" not in str(refusal.value)


def test_rows_that_are_no_hazard_curve_are_refused(tmp_path: Path) -> None:
    for rows, words in (
        ("g,1/yr\n0.1,0.1\n", "two numbers"),
        ("0.1,0.2,0.3\n", "two columns"),
        ("0.1,2\n0.2,nan\n", "two numbers"),
        ("0.1,0\n0.2,0\n", "no hazard at this site"),
        ("0.1,0.1\n0.2,0.1\n0.2,0.05\n", "positive, finite and increasing"),
        ("0,0.1\n0.2,0.05\n", "positive, finite and increasing"),
        ("", "two columns"),
        ("0.05,0.1\n0.2,0.01\n0.1,0.05\n", "rise, or fall, throughout"),
        ("0.1,-2\n0.2,-3\n", "a logarithm"),
    ):
        with pytest.raises(ValueError, match=words):
            read(tmp_path, "PGA (g),AFE\n" + rows)
    with pytest.raises(ValueError, match=r"must be positive, got 0"):
        read(tmp_path, "PGA (g),TR\n0.1,0\n0.2,10\n")


def test_a_comma_that_may_part_thousands_is_refused(tmp_path: Path) -> None:
    assert read(tmp_path, "PGA (g);TR\n0,1;475\n0,2;2475\n").intensity[1] == 0.2
    with pytest.raises(ValueError, match="two numbers"):
        read(tmp_path, "PGA (g);TR\n0,1;475\n0,2;2,475\n")
    with pytest.raises(ValueError, match="commas and with points"):
        read(tmp_path, "PGA (g);TR\n0,1;1.000\n0,2;2.475\n")


def test_a_curve_drops_its_plateaus_or_is_refused_in_a_line(tmp_path: Path) -> None:
    """Levels of probability 1 before it and 0 behind it are left out, and of a plateau all but the last."""
    chance = np.random.default_rng(58)
    read_so_far = 0
    for _ in range(80):
        p = chance.choice([0.0, 0.01, 0.1, 0.5, 1.0], chance.integers(1, 6))
        p = np.sort(p)[::-1] if chance.random() < 0.7 else p
        text = "PGA (g),poe in 50 years\n" + "".join(f"{k + 1},{each}\n" for k, each in enumerate(p))
        levels = {each: k + 1.0 for k, each in enumerate(p) if 0.0 < each < 1.0}
        if len(levels) > 1 and (np.diff(p) <= 0.0).all():
            site = read(tmp_path, text)
            assert site.intensity == pytest.approx(list(levels.values()))
            assert site.annual_frequency == pytest.approx([-math.log1p(-each) / 50.0 for each in levels])
            read_so_far += 1
            continue
        with pytest.raises(
            ValueError, match=r"fewer than two|no hazard at this|finite and decrease"
        ) as refusal:
            read(tmp_path, text)
        assert refusal.value.args[0].startswith("site.csv")
    assert read_so_far > 10
    with pytest.raises(ValueError, match=r"got 1\.5"):
        read(tmp_path, text + "9,1.5\n")


def test_a_header_may_be_the_last_comment_above_the_numbers(tmp_path: Path) -> None:
    rows = "".join(f"{x} {y}\n" for x, y in zip(X, RATE, strict=True))
    curve = read(tmp_path, "# site, a = 1\n# PGA(g) AFE\n" + rows)
    assert curve.intensity == pytest.approx(X)
    assert "site" not in curve.source
    with pytest.raises(ValueError, match="must name one column"):
        read(tmp_path, rows)


def openquake(imt: str, sites: int = 1, years: float = 50.0, columns: str = "poe-{:.7f}") -> str:
    comment = f"#,,\"generated_by='OpenQuake engine 3.16.3', kind='mean', investigation_time={years}"
    head = ",".join(columns.format(x) for x in X)
    rows = (
        f"{place},2.0,0.0," + ",".join(repr(-math.expm1(-years * rate / place)) for rate in RATE)
        for place in range(1, sites + 1)
    )
    return (
        comment + (f", imt='{imt}'\"" if imt else '"') + f"\nlon,lat,depth,{head}\n" + "\n".join(rows) + "\n"
    )


@pytest.mark.parametrize(
    ("measure", "period", "imt", "unit"),
    [("pga", None, "PGA", 1.0), ("sa_mean", 0.2, "SA(0.2)", 1.0), ("pgv_resultant", None, "PGV", 0.01)],
)
def test_files_of_openquake_are_in_the_units_of_its_convention(
    measure: str, period: float | None, imt: str, unit: float, tmp_path: Path
) -> None:
    text = openquake(imt)
    site = read(tmp_path, text, measure=measure, period=period)
    assert site.intensity == pytest.approx(unit * np.array(X), rel=1e-12)
    assert site.annual_frequency == pytest.approx(RATE, rel=1e-9)
    assert "convention" in site.source
    stated = read(tmp_path, text, measure=measure, period=period, units="m/s" if "pgv" in measure else "%g")
    assert stated.intensity == pytest.approx(np.array(X) * (1.0 if "pgv" in measure else 0.01))
    with pytest.raises(ValueError, match="is of "):
        read(tmp_path, text, measure="sa", period=0.3)


def test_one_of_several_sites_is_chosen(tmp_path: Path) -> None:
    text = openquake("PGA", sites=3, years=1.0)
    with pytest.raises(ValueError, match="3 sites, from 1 to 3: choose one"):
        read(tmp_path, text)
    for site in (1, 3):
        curve = read(tmp_path, text, site=site)
        assert curve.annual_frequency == pytest.approx(np.array(RATE) / site, rel=1e-9)
    for beyond in (0, 4):
        with pytest.raises(ValueError, match=f"from 1 to 3: got site {beyond}"):
            read(tmp_path, text, site=beyond)


def test_a_file_of_openquake_without_a_hazard_curve_is_refused(tmp_path: Path) -> None:
    pga = openquake("PGA")
    for text, options, words in (
        (pga, {"measure": "pgv"}, "is of 'PGA', not of PGV"),
        (openquake("AvgSA(0.2)"), {}, "no intensity"),
        (pga, {"years": 1.0}, "is of 50 years"),
        (openquake("PGA", columns="PGA~{}"), {}, "no hazard curve of OpenQuake"),
        (pga.replace("1,2.0,0.0,", "1,2.0,0.0,-"), {}, "must not be negative"),
        (pga.replace("1,2.0,0.0,", "1,2.0,0.0,x"), {}, "expected a number in each"),
        (pga.replace("investigation_time=50", "investigation_time=-50"), {}, "positive number"),
        (pga.replace("imt='PGA'", ""), {}, "'no imt' is no intensity"),
    ):
        with pytest.raises(ValueError, match=words):
            read(tmp_path, text, **options)


def test_a_file_that_cannot_be_opened_is_named(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"none\.csv: No such file"):
        read_hazard(tmp_path / "none.csv", measure="pga")
    (tmp_path / "no.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ValueError, match="it is no text"):
        read_hazard(tmp_path / "no.csv", measure="pga")
