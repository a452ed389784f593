"""Seismic hazard: the annual frequency with which an intensity is exceeded at a site, and its files."""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .argument_kinds import with_argument_kinds
from .number_checks import require_increasing, require_numbers, require_one_of, require_positive
from .shown import Brief

Array = NDArray[np.float64]

# name: words and unit
HAZARD_MEASURES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "pga": ("PGA, geometric mean of both components", "g"),
        "pga_resultant": ("PGA of the horizontal resultant", "g"),
        "pgv": ("PGV, geometric mean of both components", "m/s"),
        "pgv_resultant": ("PGV of the horizontal resultant", "m/s"),
        "sa": ("Sa of the horizontal resultant, 5 % damping", "g"),
        "sa_mean": ("Sa, geometric mean of both components, 5 % damping", "g"),
    }
)
_SPECTRAL = ("sa", "sa_mean")
_NAMES = ", ".join(HAZARD_MEASURES)


@with_argument_kinds
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class HazardCurve(Brief):
    """Hazard curve of a site: annual frequency of exceedance against intensity.

    Between its points it is a straight line in logarithms of both. Beyond its ends nothing is known.

    Parameters
    ----------
    intensity : array_like, shape (n,)
        Increasing, positive [g, or m/s for velocities]; n >= 2.
    annual_frequency : array_like, shape (n,)
        Mean annual frequency with which each is exceeded, decreasing, positive [1/year].
    measure : str
        What the intensity is: "pga", "pgv" and "sa_mean" are geometric means of both horizontal components,
        "pga_resultant", "pgv_resultant" and "sa" are of the horizontal resultant.
    period : float, optional
        Period of the oscillator, for "sa" and "sa_mean" alone [s].
    name : str, optional
        Name of site and source.

    Raises
    ------
    ValueError
        If the arrays differ in length, are not strictly ordered or not positive, the measure is none of
        these, or a period is missing or does not belong to it.

    Examples
    --------
    >>> site = HazardCurve([0.1, 0.2, 0.4], [1e-2, 2e-3, 2e-4], measure="pga", name="site")
    >>> site
    HazardCurve(intensity=array(3,), annual_frequency=array(3,), measure='pga', name='site')
    >>> site.exceedance([0.05, 0.2, 0.3])
    array([       nan, 0.002     , 0.00052008])
    >>> round(site.intensity_at(-math.log(0.98) / 50.0), 4)
    0.3237
    """

    intensity: Array
    annual_frequency: Array
    measure: str = field(kw_only=True)
    period: float | None = field(default=None, kw_only=True)
    name: str = field(default="", kw_only=True)

    def __post_init__(self) -> None:
        measure_of(self.measure, self.period)
        x = require_increasing("intensity of a hazard curve", self.intensity)
        frequency = require_numbers("annual_frequency", self.annual_frequency)
        if len(x) < 2 or frequency.shape != x.shape:
            raise ValueError(
                "a hazard curve needs an annual frequency for each of two or more intensities, got "
                f"{frequency.size} for {len(x)}"
            )
        wrong = np.flatnonzero(~(np.isfinite(frequency) & (frequency > 0.0)))
        if len(wrong):
            raise ValueError(
                f"annual_frequency must be positive and finite, got {frequency[wrong[0]]:g} at "
                f"{x[wrong[0]]:g}"
            )
        rising = np.flatnonzero(np.diff(frequency) >= 0.0)
        if len(rising):
            at = rising[0]
            raise ValueError(
                f"annual_frequency must decrease with intensity, got {frequency[at]:g} at {x[at]:g} and "
                f"{frequency[at + 1]:g} at {x[at + 1]:g}"
            )
        for name, values in (("intensity", x), ("annual_frequency", frequency)):
            values = values.copy()
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    @property
    def title(self) -> str:
        """Measure in words, with its period and unit."""
        words, unit = HAZARD_MEASURES[self.measure]
        return f"{words}, T = {self.period:g} s [{unit}]" if self.period else f"{words} [{unit}]"

    def exceedance(self, intensity: ArrayLike) -> Array:
        """Return annual frequencies of exceedance [1/year] at intensities; NaN beyond the ends."""
        x = np.log(np.asarray(intensity, dtype=np.float64))
        return np.exp(
            np.interp(x, np.log(self.intensity), np.log(self.annual_frequency), left=np.nan, right=np.nan)
        )

    def intensity_at(self, annual_frequency: float) -> float:
        """Return the intensity that is exceeded with an annual frequency [1/year]; NaN beyond the ends."""
        y = -np.log(self.annual_frequency)
        found = np.interp(-math.log(annual_frequency), y, np.log(self.intensity), left=np.nan, right=np.nan)
        return float(np.exp(found))


def measure_of(measure: str, period: float | None) -> tuple[str, float | None]:
    """Return a measure of hazard and its period, checked.

    Raises
    ------
    ValueError
        If it is none of `HAZARD_MEASURES`, or a period is missing or does not belong to it.
    """
    require_one_of("the measure of a hazard curve", measure, HAZARD_MEASURES)
    if measure in _SPECTRAL:
        if period is None:
            raise ValueError(f"a hazard curve of {measure} needs the period of its oscillator [s]")
        require_positive("period", period, "s")
    elif period is not None:
        raise ValueError(f"a period belongs to sa and sa_mean, got {period:g} s with {measure}")
    return measure, period


@with_argument_kinds
def read_hazard(
    path: str | Path,
    *,
    measure: str,
    period: float | None = None,
    units: str | None = None,
    years: float | None = None,
    site: int = 1,
    name: str | None = None,
) -> HazardCurve:
    r"""Read a hazard curve: CSV of two columns, the CSV of OpenQuake, or the JSON of the USGS.

    Parameters
    ----------
    path : str or Path
        CSV with a header line: intensity, and annual frequency of exceedance, or its probability in `years`.
        The file of OpenQuake says its years and its measure itself, that of the USGS its measures.
    measure : str
        One of `HAZARD_MEASURES`: whether a curve is of the geometric mean or of the resultant no file says.
    period : float, optional
        For "sa" and "sa_mean" [s]; chooses among several curves of a file.
    units : {"g", "m/s2", "cm/s2", "m/s", "cm/s"}, optional
        Units of the intensity. Default: g, and m/s for velocities.
    years : float, optional
        The second column is the probability p of exceedance in so many years: -ln(1 - p)/years is taken.
    site : int, optional
        Which site of a file of OpenQuake, from 1.
    name : str, optional
        Default: the name of the file without its ending.

    Returns
    -------
    HazardCurve
        Without points of frequency zero at its end, and of several with one frequency at its beginning, where
        the calculation saturates, with the last.

    Raises
    ------
    ValueError
        If the file is missing, none of these, or of another measure or period.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> path = Path(mkdtemp()) / "site.csv"
    >>> _ = path.write_text("pga_g,poe_50\n0.1,0.4\n0.2,0.1\n0.4,0.02\n")
    >>> site = read_hazard(path, measure="pga", years=50.0)
    >>> [round(float(each), 6) for each in site.annual_frequency]
    [0.010217, 0.002107, 0.000404]
    """
    place = Path(path)
    measure_of(measure, period)
    try:
        text = place.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is no text"
        raise ValueError(f"cannot read the hazard curve {place}: {reason}") from None
    if text.lstrip().startswith("{"):
        x, frequency = _usgs(place, text, measure, period)
    elif "investigation_time" in text[:2000] or re.search(r"(?m)^lon,lat.*poe-", text[:5000]):
        x, frequency = _openquake(place, text, measure, period, years, site)
    else:
        x, frequency = _two_columns(place, text, years)
    keep = frequency > 0.0
    x, frequency = x[keep] * _unit_factor(measure, units), frequency[keep]
    if len(frequency) and np.all(np.diff(frequency) <= 0.0):
        first = np.flatnonzero(frequency == frequency[0])[-1]
        x, frequency = x[first:], frequency[first:]
    try:
        return HazardCurve(x, frequency, measure=measure, period=period, name=name or place.stem)
    except ValueError as error:
        raise ValueError(f"{place.name}: {error}") from None


_UNITS = {"g": ("g", 1.0), "m/s2": ("g", 1.0 / 9.81), "cm/s2": ("g", 0.01 / 9.81)} | {
    "m/s": ("m/s", 1.0),
    "cm/s": ("m/s", 0.01),
}


def _unit_factor(measure: str, units: str | None) -> float:
    own = HAZARD_MEASURES[measure][1]
    if units is None:
        return 1.0
    require_one_of(
        "units of a hazard curve", units, [each for each, (unit, _) in _UNITS.items() if unit == own]
    )
    return _UNITS[units][1]


def _frequencies(path: Path, values: Array, years: float | None) -> Array:
    """Return annual frequencies from these, or from probabilities in `years`."""
    if years is None:
        return values
    require_positive("hazard years", years, "years")
    if np.any((values < 0.0) | (values >= 1.0)):
        raise ValueError(f"{path.name}: a probability must be at least 0 and below 1, got {values.max():g}")
    return np.asarray(-np.log1p(-values) / years, dtype=np.float64)


def _two_columns(path: Path, text: str, years: float | None) -> tuple[Array, Array]:
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    rows = [_cells(line) for line in lines]
    titled = bool(rows) and not _is_number(rows[0][0])
    if len(rows) == titled or any(len(row) != 2 for row in rows[titled:]):
        raise ValueError(
            f"{path.name} is no hazard curve: expected two columns, intensity and annual frequency of "
            "exceedance"
        )
    if titled:
        header = " ".join(rows.pop(0)).lower()
        if years is None and re.search(r"poe|prob|p_", header):
            raise ValueError(
                f"{path.name} gives probabilities of exceedance: say in how many years (--hazard-years, "
                "years=)"
            )
    return _numbers(path, rows, years)


def _cells(line: str) -> list[str]:
    """Cells of a line; beside semicolons and tabs a comma is that of a decimal."""
    if ";" in line or "\t" in line:
        return [cell.strip().replace(",", ".") for cell in re.split("[;\t]", line.strip())]
    return [cell.strip() for cell in (line.split(",") if "," in line else line.split())]


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _numbers(path: Path, rows: Sequence[Sequence[str]], years: float | None) -> tuple[Array, Array]:
    wrong = next((row for row in rows if not all(map(_is_number, row))), None)
    if wrong is not None:
        raise ValueError(f"{path.name}: expected two numbers, got {' '.join(wrong)[:60]!r}")
    table = np.array([[float(cell) for cell in row] for row in rows], dtype=np.float64).reshape(-1, 2)
    return table[:, 0], _frequencies(path, table[:, 1], years)


def _openquake(
    path: Path, text: str, measure: str, period: float | None, years: float | None, site: int
) -> tuple[Array, Array]:
    """Read the CSV of OpenQuake: a comment with imt and investigation_time, then a site a line."""
    comment = "\n".join(line for line in text.splitlines()[:20] if line.startswith("#"))
    imt = re.search(r"imt='([^']*)'", comment)
    stated = re.search(r"investigation_time=([0-9.eE+-]+)", comment)
    if imt is not None:
        _require_measure(path, [imt[1]], measure, period)
    span = float(stated[1]) if stated is not None and _is_number(stated[1]) else years
    if span is None:
        raise ValueError(f"{path.name} does not say its investigation time: give it (--hazard-years, years=)")
    head, *sites = csv.reader(line for line in text.splitlines() if line.strip() and not line.startswith("#"))
    places = [index for index, cell in enumerate(head) if cell.startswith("poe-")]
    if not places or not 1 <= site <= len(sites):
        raise ValueError(
            f"{path.name} holds {len(sites)} sites: site must be from 1 to {len(sites)}, got {site}"
        )
    row = sites[site - 1]
    return _numbers(path, [(head[index].removeprefix("poe-"), row[index]) for index in places], span)


def _usgs(path: Path, text: str, measure: str, period: float | None) -> tuple[Array, Array]:
    """Read the JSON of the hazard service of the USGS, whose values are annual frequencies."""
    try:
        response = json.loads(text)["response"]
        curves = response["hazardCurves"] if isinstance(response, dict) else response
        named = {str(_head(each)["imt"]["value"]): each for each in curves}
        chosen = named[_require_measure(path, named, measure, period)]
        total = next(part for part in chosen["data"] if part.get("component", "Total") == "Total")
        x = total["values"]["xs"] if "values" in total else _head(chosen)["xvalues"]
        y = total["values"]["ys"] if "values" in total else total["yvalues"]
        return np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    except (KeyError, TypeError, StopIteration, json.JSONDecodeError):
        raise ValueError(
            f"{path.name} is no hazard curve of the USGS: it has no response with curves"
        ) from None


def _head(curve: Mapping[str, Any]) -> Mapping[str, Any]:
    head: Mapping[str, Any] = curve.get("metadata", curve)
    return head


def _require_measure(path: Path, names: Iterable[str], measure: str, period: float | None) -> str:
    """Return the name of a curve that is of a measure and a period: PGA, SA(0.2) or SA0P2."""
    kind, known = measure.split("_")[0], list(names)
    for name in known:
        own = re.fullmatch(r"(PGA|PGV|SA)\(?([0-9P.]*)\)?", name.upper())
        if own is not None and own[1].lower() == kind:
            at = float(own[2].replace("P", ".")) if own[2] else None
            if (at is None and period is None) or (at and period and abs(at - period) <= 1e-6 * period):
                return name
    wanted = kind.upper() + (f" at {period:g} s" if period else "")
    raise ValueError(
        f"{path.name} is of {', '.join(known)}, not of {wanted}: choose measure (and period) of it"
    )
