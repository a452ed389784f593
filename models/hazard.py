"""Seismic hazard: the annual frequency with which an intensity is exceeded at a site, and files of it.

A file is a table of two named columns, or the CSV of OpenQuake. A table says by its header which column is
the intensity, in which unit, and whether the other is an annual frequency, a probability of exceedance in how
many years, or a return period. What it does not say is asked for, and a title in other words is refused: a
curve in another unit is wrong by powers of it.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .argument_kinds import with_argument_kinds
from .diagnostic import Diagnostic
from .number_checks import quoted, require_increasing, require_numbers, require_one_of, require_positive
from .record_source import METRES_PER_SECOND_SQUARED, UNITS
from .records.component import bytes_of
from .records.units import unit_of
from .shown import CompactRepr

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
# [g] or [m/s]: a curve with half of its points above is probably in another unit
LARGEST_MIDDLE = 3.0


@with_argument_kinds
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class HazardCurve(CompactRepr):
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
    source : str, optional
        Names of its columns in a file, and what they were read as.

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
    source: str = field(default="", kw_only=True)

    def __post_init__(self) -> None:
        measure_of(self.measure, self.period)
        x = require_increasing("intensity of a hazard curve", self.intensity)
        frequency = require_numbers("annual_frequency", self.annual_frequency)
        if len(x) < 2 or frequency.shape != x.shape:
            raise ValueError(
                "a hazard curve needs an annual frequency for each of two or more intensities, got "
                f"{frequency.size} for {len(x)}"
            )
        falls = np.append(True, frequency[1:] < frequency[:-1])
        wrong = np.flatnonzero(~(np.isfinite(frequency) & (frequency > 0.0) & falls))
        if len(wrong):
            raise ValueError(
                f"annual_frequency must be positive, finite and decrease with intensity, got "
                f"{frequency[wrong[0]]:g} at {x[wrong[0]]:g}"
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

    @property
    def doubts(self) -> tuple[Diagnostic, ...]:
        """Doubt about its unit, "large_hazard": half of its points lie above 3 g or 3 m/s."""
        middle = float(np.median(self.intensity))
        if middle <= LARGEST_MIDDLE:
            return ()
        unit = HAZARD_MEASURES[self.measure][1]
        return (Diagnostic(code="large_hazard", size=middle, bound=LARGEST_MIDDLE, detail=unit),)

    def exceedance(self, intensity: ArrayLike) -> Array:
        """Return annual frequencies of exceedance [1/year] at intensities; NaN beyond the ends."""
        x = np.log(np.asarray(intensity, dtype=np.float64))
        return np.exp(
            np.interp(x, np.log(self.intensity), np.log(self.annual_frequency), left=np.nan, right=np.nan)
        )

    def intensity_at(self, annual_frequency: float) -> float:
        """Return the intensity that is exceeded with an annual frequency [1/year]; NaN beyond the ends."""
        y = -np.log(self.annual_frequency)
        logs = np.interp(-math.log(annual_frequency), y, np.log(self.intensity), left=np.nan, right=np.nan)
        return float(np.exp(logs))


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


_HEADER = '"PGA (g),annual frequency of exceedance"'
_VELOCITIES: Mapping[str, float] = {"m/s": 1.0, "cm/s": 0.01, "mm/s": 1e-3, "in/s": 0.0254, "ft/s": 0.3048}
# titles of columns in small letters, without brackets, underscores and commas
_NUMBER, _YEARS, _PER_YEAR = r"\d+(?:\.\d+)?", "(?:years?|yrs?|y|a)", "(?: (?:1/|per )(?:years?|yr|a))"
_KINDS = {"pga": "(?:pga|peak ground acceleration)", "pgv": "pgv", "sa": "(?:p?sa|spectral acceleration)"}
_INTENSITY = re.compile(
    "(?:" + "|".join(f"(?P<{kind}>{words})" for kind, words in _KINDS.items()) + "|intensity|iml?)"
    rf"(?: (?:t1? ?=? ?)?(?P<period>{_NUMBER})(?: ?s(?:ec)?)?)?(?: in)?(?: (?P<unit>.+))?"
)
_EXCEEDED = "(?: of exceedance)?"
_QUANTITIES = {
    "annual frequency": rf"(?:mean )?annual (?:exceedance )?(?:frequency|rate){_EXCEEDED}{_PER_YEAR}?|"
    rf"(?:frequency|rate|lambda){_EXCEEDED}{_PER_YEAR}|m?afo?e{_PER_YEAR}?",
    "annual probability": f"annual (?:exceedance )?(?:probability|poe){_EXCEEDED}|aep",
    "probability": rf"(?:probability|poe){_EXCEEDED}(?: (?:in )?({_NUMBER})[ -]?{_YEARS})?",
    "return period": rf"return period(?: (?:in )?{_YEARS})?|tr(?: {_YEARS})?",
}
_THOUSANDS = re.compile(r"[1-9]\d*,\d{3}")


@with_argument_kinds
def read_hazard(
    path: str | Path,
    *,
    measure: str,
    period: float | None = None,
    units: str | None = None,
    years: float | None = None,
    site: int | None = None,
    name: str | None = None,
) -> HazardCurve:
    r"""Read a hazard curve: a table of two named columns, or the CSV of OpenQuake.

    Parameters
    ----------
    path : str or Path
        CSV of two columns in either order with a header line: the intensity with its unit, and the annual
        frequency of exceedance, its probability in so many years, or the return period in years. The files
        of OpenQuake are in g, velocities in cm/s.
    measure : str
        One of `HAZARD_MEASURES`: whether a curve is of the geometric mean or of the resultant no file says.
    period : float, optional
        For "sa" and "sa_mean" [s].
    units : str, optional
        Unit of the intensity, such as "g", "cm/s2" or "cm/s", where the header does not state it.
    years : float, optional
        Years of a probability of exceedance p, where the header does not state them: -ln(1 - p)/years is
        taken.
    site : int, optional
        Which site of a file of OpenQuake with several, from 1.
    name : str, optional
        Default: the name of the file without its ending.

    Returns
    -------
    HazardCurve
        Of levels with one frequency the highest; without levels of probability 1 at its beginning, and of
        frequency 0 at its end, which say nothing.

    Raises
    ------
    ValueError
        If the file is missing, neither of these, of another measure or period, does not state something that
        is not given either, or contradicts what is given.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> path = Path(mkdtemp()) / "site.csv"
    >>> _ = path.write_text("PGA (cm/s2),probability in 50 years\n98.1,0.4\n196.2,0.1\n392.4,0.02\n")
    >>> site = read_hazard(path, measure="pga")
    >>> [round(float(each), 6) for each in site.annual_frequency]
    [0.010217, 0.002107, 0.000404]
    >>> site.source
    "columns 'PGA (cm/s2)' in cm/s2 and 'probability in 50 years', probability in 50 years"
    """
    place = Path(path)
    measure_of(measure, period)
    if units is not None and _unit(units) is None:
        allowed = ", ".join([*UNITS, *_VELOCITIES])
        raise ValueError(f"units of a hazard curve must be one of {allowed}, got {quoted(units)}")
    if years is not None:
        require_positive("hazard years", years, "years")
    try:
        text = bytes_of(place).decode("utf-8-sig")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is no text in UTF-8"
        raise ValueError(f"cannot read the hazard curve {place}: {reason}") from None
    given = _Given(kind=measure.split("_")[0], period=period, unit=units and _unit(units), years=years)
    try:
        x, frequency, unit, source = _columns(given, text, site)
        factor = _VELOCITIES.get(unit) or METRES_PER_SECOND_SQUARED[unit] / METRES_PER_SECOND_SQUARED["g"]
        x, frequency = _telling(factor * x, frequency)
        name = name or place.stem
        return HazardCurve(x, frequency, measure=measure, period=period, name=name, source=source)
    except ValueError as error:
        raise ValueError(f"{place.name}: {error}") from None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Given:
    """Statements of the caller about a file, which the file may confirm or contradict."""

    kind: str
    period: float | None
    unit: str | None
    years: float | None

    def unit_beside(self, title: str) -> str | None:
        """Unit in the title of an intensity, which must be of the kind, period and unit given."""
        match = _INTENSITY.fullmatch(_plain(title))
        stated = match and match["unit"]
        unit = _unit(stated) if stated else None
        if match is None or (stated and unit is None):
            raise ValueError(
                f"{title[:60]!r} is no intensity in a known unit; PGA, PGV, SA(T) are read, as in {_HEADER}"
            )
        kind, period = next((each for each in _KINDS if match[each]), self.kind), match["period"]
        differs = period and not math.isclose(float(period), self.period or 0.0, rel_tol=1e-6)
        if kind != self.kind or differs:
            at = f" at {self.period:g} s" if self.period else ""
            raise ValueError(f"is of {title[:60]!r}, not of {self.kind.upper()}{at}: choose the measure")
        if unit and self.unit not in (None, unit):
            raise ValueError(f"is in {unit}, got units {self.unit}")
        unit = unit or self.unit
        if unit and (unit in _VELOCITIES) != (self.kind == "pgv"):
            raise ValueError(f"is in {unit}, which is no unit of {self.kind.upper()}")
        return unit

    def frequencies(self, quantity: str, stated: float | None, values: Array) -> tuple[Array, str]:
        """Annual frequencies, infinite for a probability of 1, and the quantity of the values in words."""
        if (values < 0.0).any():
            raise ValueError(f"values must not be negative, got {values.min():g}: a logarithm?")
        if "probability" not in quantity:
            if self.years is not None:
                raise ValueError(f"years belong to a probability, got {quantity}")
            if quantity == "annual frequency":
                return values, quantity
            if not values.all():
                raise ValueError("a return period must be positive, got 0")
            return 1.0 / values, "return period in years"
        years = stated or self.years
        if years is None:
            raise ValueError("gives probabilities: say in how many years (--hazard-years, years=)")
        if self.years not in (None, years):
            raise ValueError(f"is of {years:g} years, got years {self.years:g}")
        if values.max() > 1.0:
            raise ValueError(f"a probability must be from 0 to 1 (no percent), got {values.max():g}")
        with np.errstate(divide="ignore"):
            return -np.log1p(-values) / years, f"probability in {years:g} years"


def _columns(given: _Given, text: str, site: int | None) -> tuple[Array, Array, str, str]:
    """Levels, annual frequencies, unit of the levels, and the statements of the file about them."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    data = [line for line in lines if not line.startswith("#")]
    rows, comments = [_cells(line) for line in data], [line for line in lines if line not in data]
    if any("investigation_time" in line for line in comments):
        return _openquake(given, " ".join(comments), rows, site)
    if site is not None:
        raise ValueError(f"is no file of OpenQuake, of which a site is chosen, got site {site}")
    if rows and comments and math.isfinite(_number(rows[0][0])):  # titles in the comment above the numbers
        titles = _cells(lines[max(lines.index(data[0]), 1) - 1].lstrip("# "))
    else:
        titles = rows.pop(0) if rows else []
    if len(titles) != 2 or not rows:
        raise ValueError(f"expected two columns below a header line such as {_HEADER}, one curve a file")
    values = np.array([[_number(cell) for cell in row] if len(row) == 2 else [math.nan] * 2 for row in rows])
    if not np.isfinite(values).all():
        wrong = rows[int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])]
        raise ValueError(f"expected two numbers in two columns, got {' '.join(wrong)[:60]!r}")
    cells = "".join(cell for row in rows for cell in row)
    if "," in cells and "." in cells:
        raise ValueError("has numbers with commas and with points: write one of them")
    matches = [
        (at, quantity, match)
        for at, title in enumerate(titles)
        for quantity, words in _QUANTITIES.items()
        if (match := re.fullmatch(words, _plain(title)))
    ]
    if len(matches) != 1:
        raise ValueError(
            "must name one column as annual frequency, probability or return period and the other as "
            f"intensity, as in {_HEADER}, got {', '.join(map(repr, titles))[:120]}"
        )
    ((at, quantity, match),) = matches
    x, other = values[:, 1 - at], titles[at]
    unit = given.unit_beside(titles[1 - at])
    if unit is None:
        such = "cm/s" if given.kind == "pgv" else "g"
        raise ValueError(f"does not say the unit of its intensity: give --hazard-units (units=), as {such}")
    if len({*np.sign(np.diff(x))} - {0.0}) > 1:
        raise ValueError("levels must rise, or fall, throughout: one curve a file")
    stated = match[1] if match.re.groups else None
    years = 1.0 if quantity == "annual probability" else float(stated) if stated else None
    frequency, words = given.frequencies(quantity, years, values[:, at])
    return x, frequency, unit, f"columns {titles[1 - at]!r} in {unit} and {other!r}, {words}"


def _openquake(
    given: _Given, comment: str, rows: list[list[str]], site: int | None
) -> tuple[Array, Array, str, str]:
    """Curve from the CSV of OpenQuake: a comment with imt and investigation_time, then a site a line."""
    stated = dict(re.findall(r"(\w+)='?([^',\"]+)'?", comment))
    head, *sites = rows or [[]]
    places = [at for at, cell in enumerate(head) if cell.startswith("poe-")]
    if not places or not sites:
        raise ValueError(
            "is no hazard curve of OpenQuake but, for instance, a map or a uniform hazard spectrum: export "
            "hazard curves (hcurves), a file of each measure"
        )
    imt, time = stated.get("imt", "no imt"), stated.get("investigation_time", "")
    unit = given.unit_beside(imt) or ("cm/s" if given.kind == "pgv" else "g")
    if not _number(time) > 0.0:
        raise ValueError(f"investigation_time must be a positive number, got {time!r}")
    row = 1 if site is None else site
    if (site is None and len(sites) > 1) or not 1 <= row <= len(sites):
        chosen = "choose one by --hazard-site (site=)" if site is None else f"got site {site}"
        raise ValueError(f"holds {len(sites)} sites, from 1 to {len(sites)}: {chosen}")
    cells = [(head[at].removeprefix("poe-"), "".join(sites[row - 1][at : at + 1])) for at in places]
    x, p = np.array([[*map(_number, pair)] for pair in cells]).T
    if not np.isfinite([x, p]).all():
        raise ValueError(f"expected a number in each column poe-LEVEL of site {row}")
    frequency, words = given.frequencies("probability", _number(time), p)
    convention = "as given" if given.unit else "by the program's convention"
    kind = stated.get("kind", "kind not stated")
    return x, frequency, unit, f"OpenQuake, {imt}, {kind}, {words}; in {unit}, {convention}"


def _telling(x: Array, frequency: Array) -> tuple[Array, Array]:
    """Levels in order, the highest of each frequency, without those of probability 1 and 0 at the ends."""
    order = np.argsort(x, kind="stable")
    x, frequency = x[order], frequency[order]
    if not (frequency > 0.0).any():
        raise ValueError("has no hazard at this site: no level is ever exceeded")
    first, last = np.cumprod(np.isinf(frequency)).sum(), np.flatnonzero(frequency > 0.0)[-1]
    x, frequency = x[first : last + 1], frequency[first : last + 1]
    highest = np.append(frequency[1:] != frequency[:-1], True)[: len(x)]  # last point of each plateau
    if highest.sum() < 2:
        raise ValueError(
            "has fewer than two levels of different frequencies, beside probabilities of 0 and 1: export more"
        )
    return x[highest], frequency[highest]


def _plain(title: str) -> str:
    """Title of a column in small letters, without brackets, underscores and commas."""
    return " ".join(re.sub(r"[\[\]()_,]", " ", title.lower()).split())


def _unit(word: str) -> str | None:
    """Unit of acceleration or velocity that a word spells."""
    plain = word.lower().replace(" ", "").replace("sec", "s")
    return plain if plain in _VELOCITIES else unit_of(word)


def _cells(line: str) -> list[str]:
    delimiter = next((each for each in ";\t," if each in line), None)
    cells = line.split() if delimiter is None else next(csv.reader([line], delimiter=delimiter))
    return [cell.strip() for cell in cells]


def _number(cell: str) -> float:
    """Number with a point or a comma; NaN for other text, also for a comma that may separate thousands."""
    try:
        return math.nan if _THOUSANDS.fullmatch(cell) else float(cell.replace(",", "."))
    except ValueError:
        return math.nan
