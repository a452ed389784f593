"""Fragilities for other programs: NRML 0.5 of OpenQuake, and damage functions of pelicun.

Both take limit states of which each contains the next: uplift, tilts and overturned are written, as far as
they were asked for. Intensities are in g, velocities in cm/s (NRML) or m/s (pelicun). A limit is its
lognormal curve where it is fitted, else the shares that were counted, linear between levels, from 0 at the
least uplift on; a share that falls with the intensity (a safe gap) stays what it was.
"""

from __future__ import annotations

import csv
import io
import itertools
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.etree import ElementTree as Tree

import numpy as np

from .fit import FITTED, Array
from .intensity import OVER_FRICTION
from .tables import LIMITS, OVERTURNED

if TYPE_CHECKING:
    from .study import Fragility

_NESTED = tuple(name for name, tilt in LIMITS.items() if not math.isnan(tilt) or name == OVERTURNED)
_NAMES = {"0.1 alpha": "tenth_alpha", "0.25 alpha": "quarter_alpha"}
_NAMES |= {"0.5 alpha": "half_alpha", "1 alpha": "alpha"}
# measure of a fragility: intensity measure type and words
_TYPES = {
    "peak_acceleration": ("PGA", "peak of the horizontal resultant"),
    OVER_FRICTION: ("PGA", "peak of the horizontal resultant"),
    "peak_velocity": ("PGV", "peak of the horizontal resultant"),
    "pga": ("PGA", "geometric mean of both components"),
    "pgv": ("PGV", "geometric mean of both components"),
    "sa": ("SA", "horizontal resultant, 5 % damped"),
    "sa_mean": ("SA", "geometric mean of both components, 5 % damped"),
}
_PELICUN = {
    "PGA": "Peak Ground Acceleration",
    "PGV": "Peak Ground Velocity",
    "SA": "Spectral Acceleration|{:g}",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """One limit state of one body by one method.

    Attributes
    ----------
    name : str
    median, dispersion : float
        Of the lognormal curve [g or m/s, -]; NaN where it is not fitted.
    intensity, share : ndarray, shape (n,)
        Levels [g or m/s] and the share that exceeds it, not falling; the first is 0.
    """

    name: str
    median: float
    dispersion: float
    intensity: Array
    share: Array

    @property
    def fitted(self) -> bool:
        """Whether the limit state has a lognormal curve."""
        return math.isfinite(self.median)


def limits_by_function(results: Fragility) -> Iterator[tuple[str, list[Limit]]]:
    """Yield the name and limit states of each body and method.

    Raises
    ------
    ValueError
        If motions are not scaled to levels, where nothing is fitted either.
    """
    facts, measure = results.facts, str(results.facts["measure"])
    names = [name for name in _NESTED if name in facts["limits"]]
    for (cylinder, method), of_limit in results.fits.groupby(["cylinder", "method"], sort=False):
        body = facts["cylinders"][cylinder]
        unit = {
            "peak_acceleration": body["tan_alpha"],
            OVER_FRICTION: float(facts["friction"]),
            "peak_velocity": body["velocity_unit"],
        }.get(measure, 1.0)
        points = results.points[results.points["cylinder"] == cylinder]
        uplift = unit * float((points[measure] / points["scale"] * points["uplift_scale"]).min())
        limits = []
        for fit in of_limit[of_limit["limit"].isin(names)].to_dict("records"):
            known = fit["kind"] == FITTED
            if not known and not facts["levels"]:
                raise ValueError(
                    f"{fit['limit']} of {method} has no curve, and no levels whose shares could stand for it"
                )
            counts = results.counts
            own = (counts["cylinder"] == cylinder) & (counts["method"] == method)
            counts = counts[own & (counts["limit"] == fit["limit"])].sort_values("intensity")
            x = unit * counts["intensity"].to_numpy(float)
            share = np.maximum.accumulate((counts["k"] / counts["n"]).to_numpy(float))
            # a level below uplift has a share of 0 already
            if uplift < x[0]:
                x, share = np.r_[uplift, x], np.r_[0.0, share]
            name = _NAMES.get(fit["limit"], fit["limit"])
            median, spread = (unit * fit["median"], fit["dispersion"]) if known else (math.nan, math.nan)
            limits.append(Limit(name=name, median=median, dispersion=spread, intensity=x, share=share))
        # identifiers of OpenQuake hold no blanks
        yield ":".join(re.sub(r"\W+", "_", str(name)) for name in (cylinder, method)), limits


#: File of each format.
EXPORTS = {"nrml": "fragility.nrml.xml", "pelicun": "fragility.pelicun.csv"}


def exported(results: Fragility, form: str) -> tuple[str, bytes]:
    """File name and content of an export format of `EXPORTS`.

    Raises
    ------
    ValueError
        If a limit state has neither a curve nor shares of levels.
    """
    return EXPORTS[form], {"nrml": nrml, "pelicun": pelicun}[form](results)


def nrml(results: Fragility) -> bytes:
    """NRML 0.5 fragility model of OpenQuake: continuous if all limit states have a fit."""
    imt, words = _TYPES[str(results.facts["measure"])]
    factor, unit = (100.0, "cm/s") if imt == "PGV" else (1.0, "g")
    root = Tree.Element("nrml", xmlns="http://openquake.org/xmlns/nrml/0.5")
    model = Tree.SubElement(
        root, "fragilityModel", id="rockwobble", assetCategory="structure", lossCategory="structural"
    )
    Tree.SubElement(model, "description").text = f"{imt} in {unit}, {words}. {results.facts['source']}"
    functions = list(limits_by_function(results))
    Tree.SubElement(model, "limitStates").text = " ".join(each.name for each in functions[0][1])
    name = f"SA({results.facts['period']:g})" if imt == "SA" else imt
    for label, limits in functions:
        continuous = all(each.fitted for each in limits)
        x = factor * limits[0].intensity
        kind = {"format": "continuous", "shape": "logncdf"} if continuous else {"format": "discrete"}
        function = Tree.SubElement(model, "fragilityFunction", {"id": label, **kind})
        low, high = f"{x[0]:.9g}", f"{x[-1]:.9g}"
        ends = {"minIML": low, "maxIML": high} if continuous else {}
        imls = Tree.SubElement(function, "imls", {"imt": name, "noDamageLimit": low, **ends})
        # OpenQuake adds a 0 at the noDamageLimit itself
        if not continuous:
            imls.text = " ".join(f"{each:.9g}" for each in x[1:])
        for limit in limits:
            if continuous:
                mean = factor * limit.median * math.exp(0.5 * limit.dispersion**2)
                spread = mean * math.sqrt(math.expm1(limit.dispersion**2))
                Tree.SubElement(function, "params", ls=limit.name, mean=f"{mean:.9g}", stddev=f"{spread:.9g}")
            else:
                shares = " ".join(f"{each:.9g}" for each in limit.share[1:])
                Tree.SubElement(function, "poes", ls=limit.name).text = shares
    Tree.indent(root)
    return bytes(Tree.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def pelicun(results: Fragility) -> bytes:
    """Return damage functions as pelicun reads them.

    Empty is a limit state without a curve that not all motions reach: pelicun takes no distribution of which
    the end is not known.
    """
    imt, _ = _TYPES[str(results.facts["measure"])]
    demand = _PELICUN[imt].format(results.facts["period"])
    functions = list(limits_by_function(results))
    head = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    for place in range(1, len(functions[0][1]) + 1):
        head += [f"LS{place}-{name}" for name in ("Family", "Theta_0", "Theta_1")]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    for label, limits in functions:
        states = itertools.chain(*map(_family, limits))
        writer.writerow([label, 0, demand, "mps" if imt == "PGV" else "g", 0, 0, *states])
    return text.getvalue().encode()


def _family(limit: Limit) -> list[object]:
    """Return family and both parameters of a limit state."""
    if limit.fitted:
        return ["lognormal", f"{limit.median:.9g}", f"{limit.dispersion:.9g}"]
    share = limit.share
    if len(share) < 2 or share[0] > 0.0 or share[-1] < 1.0:
        return ["", "", ""]
    # shares must increase strictly: of equal ones keep the last 0 and else the first
    rises = np.diff(share) > 0.0
    keep = np.where(share > 0.0, np.r_[False, rises], np.r_[rises, False])
    x, y = (",".join(f"{each:.9g}" for each in values[keep]) for values in (limit.intensity, share))
    return ["multilinear_CDF", f"{x}|{y}", ""]
