"""Files of hazard curves: a table of two named columns, the CSV of OpenQuake and the JSON of the USGS.

A table says by its header which column is the intensity, in which unit, and whether the other is an annual
frequency, a probability of exceedance in how many years, or a return period. What it does not say is asked
for, and a word of a header that is not known is refused: a curve in another unit is wrong by powers of it.
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .argument_kinds import with_argument_kinds
from .hazard import HAZARD_MEASURES, HazardCurve, measure_of
from .number_checks import quoted, require_positive
from .records.component import METRES_PER_SECOND_SQUARED, UNITS
from .records.units import unit_of

Array = NDArray[np.float64]
_NAMES = ", ".join(HAZARD_MEASURES)
_HEADER = '"PGA (g),annual frequency of exceedance"'
_YEARS_OPTION = "--hazard-years (years=)"
_VELOCITIES: Mapping[str, float] = {"m/s": 1.0, "cm/s": 0.01, "mm/s": 1e-3, "in/s": 0.0254, "ft/s": 0.3048}

# word of a header: what it says of its column
_SAYS: Mapping[str, str] = {
    word: meaning
    for meaning, words in {
        "pga": "pga ag",
        "pgv": "pgv",
        "sa": "sa psa",
        "any": "intensity im iml level levels acceleration x",
        "frequency": "frequency rate lambda λ",
        "annual": "annual yearly year years yr y 1/yr 1/year 1/a /yr /year yr-1 yr^-1 a-1 annum",
        "annual frequency": "afe afoe mafe",
        "probability": "probability prob poe pe p",
        "annual probability": "aep apoe ape",
        "return": "return tr rp",
        "": "of the in for per a at to or exceedance exceeding exceeded being mean total peak ground "
        "horizontal geometric component components motion measure value values site hazard curve period "
        "interval",
    }.items()
    for word in words.split()
}
_PHRASES: Mapping[str, str] = {
    "peak ground acceleration": "pga",
    "peak ground velocity": "pgv",
    "spectral acceleration": "sa",
    "recurrence interval": "return period",
}
_NUMBER = r"\d+(?:\.\d+)?"
_PERIOD = re.compile(rf"\b(?:p?sa)[ (\[]*(?:t1? *= *)?({_NUMBER}|\d+p\d+) *(?:s|sec)?[)\]]?(?![^ (\[,])")
_SPAN = re.compile(rf"(?<![/\d.])({_NUMBER}) *-? *(?:years?|yrs?|y|a)\b")
_CHANCE = re.compile(rf"\b(p|pe|poe|prob|probability) ?({_NUMBER})(?![^ )\],])")
_MEASURE = re.compile(r"(PGA|PGV|SA)\(?(\d*[P.]?\d*)\)?")
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
    r"""Read a hazard curve: a table of two named columns, the CSV of OpenQuake, or the JSON of the USGS.

    Parameters
    ----------
    path : str or Path
        CSV of two columns in either order with a header line: the intensity with its unit, and the annual
        frequency of exceedance, its probability in so many years, or the return period in years. The files
        of OpenQuake and the USGS are in g, velocities in cm/s.
    measure : str
        One of `HAZARD_MEASURES`: whether a curve is of the geometric mean or of the resultant no file says.
    period : float, optional
        For "sa" and "sa_mean" [s]; chooses among several curves of a file.
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
        If the file is missing, none of these, of another measure or period, does not state something that is
        not given either, or contradicts what is given.

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
    try:
        text = place.read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is no text in UTF-8"
        raise ValueError(f"cannot read the hazard curve {place}: {reason}") from None
    given = _Given(place=place, measure=measure, period=period, units=_given_unit(units), years=years)
    if years is not None:
        require_positive("hazard years", years, "years")
    of_openquake = "investigation_time" in text[:2000] or re.search(r"(?m)^lon,lat.*poe-", text[:5000])
    if site is not None and not of_openquake:
        raise ValueError(f"{place.name} is no file of OpenQuake, of which a site is chosen, got site {site}")
    if text.lstrip().startswith("{"):
        columns = _usgs(given, text)
    elif of_openquake:
        columns = _openquake(given, text, site)
    else:
        columns = _table(given, text)
    return _curve(given, columns, name or place.stem)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Given:
    """Statements of the caller about a file."""

    place: Path
    measure: str
    period: float | None
    units: str | None
    years: float | None

    @property
    def kind(self) -> str:
        """Kind of the measure: "pga", "pgv" or "sa"."""
        return self.measure.split("_")[0]

    def unit(self, stated: str | None) -> str:
        """Unit of the intensity, that of the file or the given one, which must be one of the measure."""
        unit = stated or self.units
        if unit is None:
            raise ValueError(
                f"{self.place.name} does not say the unit of its intensity: give it (--hazard-units, "
                f"units=), such as {'cm/s' if self.kind == 'pgv' else 'g'}"
            )
        if self.units not in (None, unit):
            raise ValueError(f"{self.place.name} is in {unit}, got units {self.units}")
        if (unit in _VELOCITIES) != (self.kind == "pgv"):
            raise ValueError(f"{self.place.name} is in {unit}, which is no unit of {self.measure}")
        return unit

    def span(self, stated: float | None) -> float:
        """Years of a probability, those of the file or the given ones."""
        if stated is None and self.years is None:
            raise ValueError(
                f"{self.place.name} gives probabilities of exceedance: say in how many years "
                f"({_YEARS_OPTION})"
            )
        if stated is not None and self.years not in (None, stated):
            raise ValueError(f"{self.place.name} is of {stated:g} years, got years {self.years:g}")
        return stated or self.years or math.nan


@dataclass(frozen=True, slots=True, kw_only=True)
class _Columns:
    """Levels in a unit, their annual frequencies, infinite of a probability of 1, and what they are."""

    x: Array
    frequency: Array
    unit: str
    source: str


def _curve(given: _Given, columns: _Columns, name: str) -> HazardCurve:
    place, order = given.place.name, np.argsort(columns.x, kind="stable")
    x, frequency = columns.x[order], columns.frequency[order]
    if (frequency < 0.0).any():
        raise ValueError(f"{place}: a frequency must not be negative, got {frequency.min():g}: a logarithm?")
    if not (frequency > 0.0).any():
        raise ValueError(f"{place} has no hazard at this site: no level is ever exceeded")
    first, last = np.cumprod(np.isinf(frequency)).sum(), np.flatnonzero(frequency > 0.0)[-1]
    x, frequency = x[first : last + 1], frequency[first : last + 1]
    highest = np.append(frequency[1:] != frequency[:-1], True)[: len(x)]  # last point of each plateau
    x, frequency = x[highest], frequency[highest]
    if len(x) < 2:
        raise ValueError(
            f"{place} has fewer than two levels of different frequencies, but for probabilities of 0 and 1: "
            "export more levels"
        )
    if x[0] <= 0.0:
        raise ValueError(f"{place}: a level must be positive, got {x[0]:g}: leave its row out")
    if len(rising := np.flatnonzero(np.diff(frequency) >= 0.0) + 1):
        at = rising[0]
        raise ValueError(
            f"{place}: frequencies of exceedance must decrease with the level, got {frequency[at - 1]:g} at "
            f"{x[at - 1]:g} and {frequency[at]:g} at {x[at]:g}: one curve a file"
        )
    if len(twice := np.flatnonzero(np.diff(x) == 0.0)):
        raise ValueError(f"{place} has two frequencies at the level {x[twice[0]]:g}: one curve a file")
    unit = columns.unit
    factor = _VELOCITIES.get(unit) or METRES_PER_SECOND_SQUARED[unit] / METRES_PER_SECOND_SQUARED["g"]
    return HazardCurve(
        factor * x,
        frequency,
        measure=given.measure,
        period=given.period,
        name=name,
        source=columns.source,
    )


def _given_unit(units: str | None) -> str | None:
    if units is None:
        return None
    unit = _unit(units)
    if unit is None:
        allowed = ", ".join([*UNITS, *_VELOCITIES])
        raise ValueError(f"units of a hazard curve must be one of {allowed}, got {quoted(units)}")
    return unit


def _unit(word: str) -> str | None:
    """Unit of acceleration or velocity that a word spells."""
    plain = re.sub("sec", "s", word.lower().replace(" ", ""))
    plain = {"cms-1": "cm/s", "ms-1": "m/s"}.get(plain.translate({ord("^"): None}), plain)
    return plain if plain in _VELOCITIES else unit_of(word)


def _rates(given: _Given, p: Array, years: float) -> Array:
    """Annual frequencies of probabilities in some years, infinite of 1."""
    if ((p < 0.0) | (p > 1.0)).any():
        wrong = p[(p < 0.0) | (p > 1.0)][0]
        raise ValueError(f"{given.place.name}: a probability must be from 0 to 1 (no percent), got {wrong:g}")
    with np.errstate(divide="ignore"):
        return np.asarray(-np.log1p(-p) / years, dtype=np.float64)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Title:
    """Parsed title of a column: the words above, a unit, a period [s], and years of a probability."""

    title: str
    says: frozenset[str]
    unit: str | None
    period: float | None
    years: float | None


def _table(given: _Given, text: str) -> _Columns:
    """Read a table of two columns under a header line, which may be the last comment."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    data = [line for line in lines if not line.startswith("#")]
    if data and _is_number(_cells(data[0])[0]):
        above = lines[: lines.index(data[0])]
        header = above[-1].lstrip("# ") if above else ""
    else:
        header = data.pop(0) if data else ""
    titles = _cells(header)
    numbers = [title for title in titles if _is_number(title)]
    if len(numbers) > 1:
        raise ValueError(
            f"{given.place.name} has its levels in the header line: write those and the values of one "
            f"site as two columns, {_HEADER}"
        )
    rows = [_cells(line) for line in data]
    if len(titles) != 2 or any(len(row) != 2 for row in rows):
        raise ValueError(
            f"{given.place.name} is no hazard curve: expected two columns under a header line such as "
            f"{_HEADER}"
        )
    wrong = next((row for row in rows if not all(map(_is_number, row))), None)
    if wrong is not None:
        raise ValueError(f"{given.place.name}: expected two numbers, got {' '.join(wrong)[:60]!r}")
    if not rows:
        raise ValueError(f"{given.place.name} has no rows below its header line")
    cells = [cell for row in rows for cell in row]
    if any("," in cell for cell in cells) and any("." in cell for cell in cells):
        raise ValueError(f"{given.place.name} has numbers with commas and with points: write one of them")
    values = np.array([[_number(cell) for cell in row] for row in rows], dtype=np.float64)
    columns = [_title(given, title) for title in titles]
    quantities = [column.says & {"frequency", "probability", "return"} for column in columns]
    if sorted(map(len, quantities)) != [0, 1]:
        raise ValueError(
            f"{given.place.name} must name one column as annual frequency, probability or return period and "
            f"the other as intensity, as in {_HEADER}, got {', '.join(map(repr, titles))}"
        )
    at = int(bool(quantities[0]))  # place of the intensity
    intensity, other = columns[at], columns[1 - at]
    _require_kind(given, intensity)
    if len({*np.sign(np.diff(values[:, at]))} - {0.0}) > 1:
        raise ValueError(f"{given.place.name}: levels must rise, or fall, throughout: one curve a file")
    frequency, words = _frequency(given, other, values[:, 1 - at])
    unit = given.unit(intensity.unit)
    source = f"columns {intensity.title!r} in {unit} and {other.title!r}, {words}"
    return _Columns(x=values[:, at], frequency=frequency, unit=unit, source=source)


def _cells(line: str) -> list[str]:
    delimiter = next((each for each in ";\t," if each in line), None)
    cells = line.split() if delimiter is None else next(csv.reader([line], delimiter=delimiter))
    return [cell.strip() for cell in cells]


def _is_number(cell: str) -> bool:
    try:
        return math.isfinite(_number(cell))
    except ValueError:
        return False


def _number(cell: str) -> float:
    """Number with a point or a comma, but for a comma that may part thousands."""
    if _THOUSANDS.fullmatch(cell):
        raise ValueError
    return float(cell.replace(",", ".") if cell.count(",") == 1 and "." not in cell else cell)


def _title(given: _Given, title: str) -> _Title:
    text = " ".join(title.lower().replace("_", " ").replace("-yr", " yr").split())
    period = years = None
    if match := _PERIOD.search(text):
        period = float(match[1].replace("p", "."))
        text = text.replace(match[0], " sa ")
    if match := _SPAN.search(text):
        years = float(match[1])
        text = text.replace(match[0], " ")
    elif match := _CHANCE.search(text):  # 50 may be years, or a quantile: it is asked for
        if given.years is not None and given.years != float(match[2]):
            raise ValueError(f"{given.place.name}: {title!r} contradicts years {given.years:g}")
        text = text.replace(match[0], match[1])
    for phrase, word in _PHRASES.items():
        text = text.replace(phrase, word)
    unit, says = None, set[str]()
    words = list[str]()
    for word in re.findall(r"[\[(]([^\])]*)[\])]", text):
        if unit is not None and _unit(word) not in (None, unit):
            raise ValueError(f"{given.place.name}: {title[:40]!r} has two units, {unit} and {_unit(word)}")
        unit = unit or _unit(word)
        words += [] if _unit(word) or word in ("-", "") else word.split()
    outside = re.sub(r"[\[(][^\])]*[\])]", " ", text).replace(",", " ").split()
    ends = (at for at in range(1, len(outside)) if unit is None)
    for at in ends:
        with_slash = "" if outside[at] == "in" else "/".join(outside[at:])
        if spelled := _unit("".join(outside[at:])) or _unit(with_slash):
            unit, outside = spelled, outside[:at]
            break
    for word in [*outside, *words]:
        if word not in _SAYS:
            raise ValueError(
                f"{given.place.name}: {word[:20]!r} in the column {title[:40]!r} is not known: PGA, "
                f"PGV and SA(T) are read, under names as in {_HEADER}"
            )
        says |= set(_SAYS[word].split())
    return _Title(title=title, says=frozenset(says), unit=unit, period=period, years=years)


def _require_kind(given: _Given, intensity: _Title) -> None:
    kinds = intensity.says & {"pga", "pgv", "sa"}
    if not kinds and "any" not in intensity.says:
        raise ValueError(f"{given.place.name}: {intensity.title!r} names no intensity, as in {_HEADER}")
    differs = (
        intensity.period is not None
        and given.period is not None
        and (abs(intensity.period - given.period) > 1e-6 * given.period)
    )
    if kinds not in (set(), {given.kind}) or differs:
        at = f" at {given.period:g} s" if given.period else ""
        raise ValueError(f"{given.place.name} is of {intensity.title!r}, not of {given.measure}{at}")


def _frequency(given: _Given, column: _Title, values: Array) -> tuple[Array, str]:
    """Annual frequencies of a column, and what it holds in words."""
    if "probability" in column.says:
        annual = 1.0 if "annual" in column.says else None
        if annual and column.years not in (None, annual):
            raise ValueError(
                f"{given.place.name}: {column.title!r} says that it is annual and in {column.years:g} years"
            )
        span = given.span(column.years or annual)
        return _rates(given, values, span), f"probability in {span:g} years"
    if given.years is not None or column.years is not None:
        raise ValueError(f"{given.place.name}: years belong to a probability, got {column.title!r}")
    if "return" in column.says:
        if not (values > 0.0).all():
            raise ValueError(f"{given.place.name}: a return period must be positive, got {values.min():g}")
        return 1.0 / values, "return period in years"
    if "annual" not in column.says:
        raise ValueError(f"{given.place.name}: {column.title!r} must say that it is annual, as in {_HEADER}")
    return values, "annual frequency"


def _openquake(given: _Given, text: str, site: int | None) -> _Columns:
    """Read the CSV of OpenQuake: a comment with imt and investigation_time, then a site a line."""
    name = given.place.name
    comment = "\n".join(line for line in text.splitlines()[:20] if line.startswith("#"))
    stated = dict(re.findall(r"(\w+)='?([^',\"]+)'?", comment))
    rows = csv.reader(line for line in text.splitlines() if line.strip() and not line.startswith("#"))
    head, *sites = [*rows] or [[]]
    places = [index for index, cell in enumerate(head) if cell.startswith("poe-")]
    if not places or not sites:
        raise ValueError(
            f"{name} is no hazard curve of OpenQuake but, for instance, a map or a uniform hazard spectrum: "
            "export hazard curves (hcurves), a file of each measure"
        )
    if "imt" in stated:
        _require_measure(given, [stated["imt"]])
    elif given.units is None:
        raise ValueError(f"{name} does not say its measure (imt): give its unit (--hazard-units, units=)")
    try:
        years = require_positive("investigation_time", float(stated["investigation_time"]), "years")
    except KeyError:
        years = None
    except ValueError:
        stating = stated["investigation_time"]
        raise ValueError(f"{name}: investigation_time must be a positive number, got {stating!r}") from None
    span = given.span(years)
    row = 1 if site is None else site
    if (site is None and len(sites) > 1) or not 1 <= row <= len(sites):
        chosen = "choose one by --hazard-site (site=)" if site is None else f"got site {site}"
        raise ValueError(f"{name} holds {len(sites)} sites, from 1 to {len(sites)}: {chosen}")
    try:
        pairs = [(float(head[at].removeprefix("poe-")), float(sites[row - 1][at])) for at in places]
    except (ValueError, IndexError):
        raise ValueError(f"{name}: expected a number in each column poe-LEVEL of site {row}") from None
    unit = given.units or _convention(given)
    of_file = [stated.get(key, f"{key} not stated") for key in ("imt", "kind")]
    source = f"OpenQuake, {', '.join(of_file)}, probabilities in {span:g} years; {_said(given, unit)}"
    x, p = np.array(pairs).T
    return _Columns(x=x, frequency=_rates(given, p, span), unit=unit, source=source)


def _convention(given: _Given) -> str:
    """Unit of the intensities of OpenQuake and of the USGS, which their files do not state."""
    return "cm/s" if given.kind == "pgv" else "g"


def _said(given: _Given, unit: str) -> str:
    return f"in {unit}, as given" if given.units else f"in {unit}, by the program's convention"


def _usgs(given: _Given, text: str) -> _Columns:
    """Read the JSON of the hazard service of the USGS, whose values are annual frequencies."""
    name = given.place.name
    if given.years is not None:
        raise ValueError(f"{name} holds annual frequencies, got years {given.years:g}")
    try:
        response = json.loads(text)["response"]
        curves = response["hazardCurves"] if isinstance(response, dict) else response
        named = [(str(_head(each)["imt"]["value"]), each) for each in curves]
        heads = [_head(each) for each in (response, *curves) if isinstance(each, dict)]
        labels = " ".join(str(head.get(key, "")) for head in heads for key in ("xlabel", "ylabel"))
    except (KeyError, TypeError, AttributeError, json.JSONDecodeError):
        raise ValueError(f"{name} is no hazard curve of the USGS: it has no response with curves") from None
    if "probab" in labels.lower() or ("cm/s" in labels.lower() and given.kind != "pgv"):
        raise ValueError(f"{name} says {labels[:60]!r}: annual frequencies over g, or cm/s of PGV, are read")
    chosen = _require_measure(given, [each for each, _ in named])
    try:
        own, *others = [curve for each, curve in named if each == chosen]
        total, *more = [part for part in own["data"] if part.get("component", "Total") == "Total"]
        x = total["values"]["xs"] if "values" in total else _head(own)["xvalues"]
        y = total["values"]["ys"] if "values" in total else total["yvalues"]
        pairs = np.array(list(zip(x, y, strict=True)), dtype=np.float64)
        single = pairs.ndim == 2 and not others and not more
    except (KeyError, TypeError, AttributeError, ValueError):
        single = False
    if not single:
        raise ValueError(
            f"{name} is not one hazard curve of the USGS: {chosen} must have one total of levels and values"
        )
    unit = given.units or _convention(given)
    source = f"USGS, {chosen}, annual frequencies; {_said(given, unit)}"
    return _Columns(x=pairs[:, 0], frequency=pairs[:, 1], unit=unit, source=source)


def _head(curve: Mapping[str, Any]) -> Mapping[str, Any]:
    head: Mapping[str, Any] = curve.get("metadata", curve)
    return head


def _require_measure(given: _Given, names: Iterable[str]) -> str:
    """Name of a curve that is of the measure and the period: PGA, SA(0.2) or SA0P2."""
    known = list(names)
    for name in known:
        match = _MEASURE.fullmatch(name.upper())
        if match is not None and match[1].lower() == given.kind:
            at, period = float(match[2].replace("P", ".")) if match[2] else None, given.period
            if (at is None and period is None) or (at and period and abs(at - period) <= 1e-6 * period):
                return name
    wanted = f"of {given.kind.upper()}" + (f" at {given.period:g} s" if given.period else "")
    way = "choose measure (and period) of it"
    if not any(_MEASURE.fullmatch(name.upper()) for name in known):
        wanted, way = "read here", "export PGA, PGV or SA(T)"
    raise ValueError(f"{given.place.name} is of {', '.join(known) or 'no measure'}, not {wanted}: {way}")
