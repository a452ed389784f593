"""Exported fragilities, read back, give the curves and shares of the tables."""

from __future__ import annotations

import csv
import math
import re
from xml.etree import ElementTree as Tree

import numpy as np
import pytest

import rockwobble as rw
from rockwobble.studies import Fragility
from rockwobble.studies.fragility.export import exported

LIMITS = {"uplift": "uplift", "half_alpha": "0.5 alpha", "overturned": "overturned"}
NRML = "{http://openquake.org/xmlns/nrml/0.5}"
AT = np.geomspace(0.2, 1.5, 7)  # [g], within the levels


def study(limits: list[str], measure: str = "peak_acceleration", friction: float = 1.0) -> Fragility:
    bodies = {
        "pier": rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2),
        "column": rw.Cylinder(semidiagonal=3.0, tan_alpha=0.15),
    }
    levels = [1.5, 2, 3, 4.5, 7, 10] if measure == "peak_acceleration" else [0.1, 0.3, 0.6, 1.2, 2.4]
    motions = rw.synthetic_motions(12, peak=1.0, seed=4)
    return rw.fragility(
        bodies,
        motions,
        methods=["recess"],
        measure=measure,
        friction=friction,
        levels=levels,
        limits=limits,
        resamples=20,
        workers=1,
    )


def expected(study: Fragility, cylinder: str, limit: str, *, curve: bool) -> np.ndarray:
    """Probabilities at intensities `AT` from the tables: curve, or else shares."""
    unit = study.facts["cylinders"][cylinder]["tan_alpha"]
    rows = {
        name: table[(table["cylinder"] == cylinder) & (table["limit"] == limit)]
        for name, table in study.tables.items()
        if name in ("fits", "counts")
    }
    if curve:
        fit = rows["fits"].iloc[0]
        z = np.log(AT / unit / fit["median"]) / fit["dispersion"]
        return np.array([0.5 * math.erfc(-each / math.sqrt(2.0)) for each in z])
    shares = np.maximum.accumulate(rows["counts"]["k"] / rows["counts"]["n"])
    return np.interp(AT, np.r_[unit, unit * rows["counts"]["intensity"]], np.r_[0.0, shares])


def poes_of_nrml(text: bytes) -> dict[tuple[str, str], np.ndarray]:
    """Probabilities at `AT` by the rules of NRML 0.5, by a reader independent of the writer."""
    model = Tree.fromstring(text).find(f"{NRML}fragilityModel")
    assert model is not None
    poes = {}
    for function in model.iter(f"{NRML}fragilityFunction"):
        imls = function.find(f"{NRML}imls")
        assert imls is not None
        assert imls.get("imt") == "PGA"
        for row in [*function.iter(f"{NRML}poes"), *function.iter(f"{NRML}params")]:
            if function.get("format") == "discrete":
                x, y = (np.array(str(each.text).split(), dtype=float) for each in (imls, row))
                poe = np.interp(AT, np.r_[float(imls.attrib["noDamageLimit"]), x], np.r_[0.0, y])
            else:
                mean, spread = float(row.attrib["mean"]), float(row.attrib["stddev"])
                sigma = math.sqrt(math.log(spread**2 / mean**2 + 1.0))
                z = np.log(AT * math.sqrt(spread**2 + mean**2) / mean**2) / sigma
                poe = np.array([0.5 * math.erfc(-each / math.sqrt(2.0)) for each in z])
            poes[str(function.get("id")), row.attrib["ls"]] = np.where(
                float(imls.attrib["noDamageLimit"]) > AT, 0.0, poe
            )
    assert str(model.findtext(f"{NRML}limitStates")).split() == list(dict.fromkeys(ls for _, ls in poes))
    return poes


@pytest.fixture(scope="module")
def all_limits() -> Fragility:
    return study(list(LIMITS.values()))


@pytest.mark.parametrize("fitted", [False, True])
def test_nrml_export_reproduces_the_tables(fitted: bool, all_limits: Fragility) -> None:
    table = study(["0.5 alpha", "overturned"]) if fitted else all_limits
    name, text = exported(table, "nrml")
    assert name == "fragility.nrml.xml"
    poes = poes_of_nrml(text)
    assert len(poes) == 2 * len(table.facts["limits"])
    assert all(re.fullmatch(r"[\w:-]+", label) for label, _ in poes)
    for (label, ls), poe in poes.items():
        right = expected(table, label.split(":")[0], LIMITS[ls], curve=fitted)
        inside = AT > 0.2 if fitted else AT > 0.0  # 0 below uplift in the file, unlike the curve
        assert poe[inside] == pytest.approx(right[inside], abs=1e-7)  # nine digits of the parameters


def rows_of_pelicun(text: bytes) -> list[dict[str, str]]:
    return list(csv.DictReader(text.decode().splitlines()))


def test_pelicun_export_has_curves_or_else_observed_shares(all_limits: Fragility) -> None:
    name, text = exported(all_limits, "pelicun")
    assert name == "fragility.pelicun.csv"
    for row in rows_of_pelicun(text):
        cylinder = row["ID"].split(":")[0]
        assert (row["Demand-Type"], row["Demand-Unit"]) == ("Peak Ground Acceleration", "g")
        for place, limit in enumerate(LIMITS.values(), start=1):
            family, first, second = (row[f"LS{place}-{each}"] for each in ("Family", "Theta_0", "Theta_1"))
            right = expected(all_limits, cylinder, limit, curve=family == "lognormal")
            if family == "lognormal":
                z = np.log(AT / float(first)) / float(second)
                cdf = np.array([0.5 * math.erfc(-each / math.sqrt(2.0)) for each in z])
            else:
                x, y = (np.array(each.split(","), dtype=float) for each in first.split("|"))
                assert (y[0], y[-1]) == (0.0, 1.0)
                assert (np.diff(x) > 0.0).all()
                assert (np.diff(y) > 0.0).all()
                cdf = np.interp(AT, x, y)
            assert cdf == pytest.approx(right, abs=1e-7)


def test_velocities_are_in_the_units_of_each_program() -> None:
    table = study(["overturned"], "pgv")
    fit = table.fits.iloc[0]
    row = rows_of_pelicun(exported(table, "pelicun")[1])[0]
    assert (row["Demand-Type"], row["Demand-Unit"]) == ("Peak Ground Velocity", "mps")
    text = exported(table, "nrml")[1].decode()
    assert 'imt="PGV"' in text
    assert "cm/s" in text
    levels = text.partition("</imls>")[0].rpartition(">")[2].split() or [
        text.partition('maxIML="')[2].partition('"')[0]
    ]
    assert float(levels[-1]) == pytest.approx(240.0)
    if fit["kind"] == "fitted":
        assert float(row["LS1-Theta_0"]) == pytest.approx(fit["median"])


def test_a_limit_with_neither_curve_nor_levels_is_refused() -> None:
    pier, motions = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2), rw.synthetic_motions(4, peak=1.0, seed=1)
    cloud = rw.fragility(pier, motions, methods=["recess"], scales=[2.0, 6.0], resamples=2, workers=1)
    with pytest.raises(ValueError, match="no levels"):
        exported(cloud, "nrml")


def test_a_peak_over_friction_is_exported_in_g() -> None:
    levels = exported(study(["overturned"], "peak_over_friction", friction=0.5), "nrml")[1].decode()
    assert 'imt="PGA"' in levels
    assert float(levels.partition("</imls>")[0].rpartition(">")[2].split()[-1]) == pytest.approx(1.2)
