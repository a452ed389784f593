"""Names of columns: what a column holds by its name and unit, in the languages of the networks.

Names are compared without case, accents, units and punctuation. A name that is in no list of
column_words.toml is unknown, and an unknown column is never taken for a component.
"""

from __future__ import annotations

import itertools
import math
import re
import tomllib
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Literal

from .component import Direction, RecordFile
from .units import unit_of

Kind = Literal["time", "index", "acceleration", "velocity", "displacement", "other", "unknown"]

_LETTERS = str.maketrans(
    {"ł": "l", "ø": "o", "đ": "d", "ı": "i", "æ": "ae", "ð": "d", "þ": "th", "œ": "oe", "№": "no"}
)


def plain(text: str) -> str:
    """Return a text in small letters without accents.

    Examples
    --------
    >>> plain("Verschiebung Süd"), plain("İvme DOĞU")
    ('verschiebung sud', 'ivme dogu')
    """
    parts = unicodedata.normalize("NFKD", text.casefold())
    return "".join(part for part in parts if not unicodedata.combining(part)).translate(_LETTERS)


@dataclass(frozen=True, slots=True)
class _Words:
    """Words of column_words.toml, without accents.

    Attributes
    ----------
    kinds : mapping
        Kind of a word.
    stems : tuple
        Beginnings of words and their kinds.
    senses : mapping
        Direction and sign of a word.
    noise : frozenset
        Words that say nothing.
    joined : tuple of str
        Words that are written without blanks before the next.
    seconds : mapping
        Units of time [s], NaN for those that are refused.
    """

    kinds: Mapping[str, Kind]
    stems: tuple[tuple[str, Kind], ...]
    senses: Mapping[str, tuple[Direction, float]]
    noise: frozenset[str]
    joined: tuple[str, ...]
    seconds: Mapping[str, float]


_SENSES: Mapping[str, tuple[Direction, float]] = {
    **{"east": ("x", 1.0), "west": ("x", -1.0), "north": ("y", 1.0), "south": ("y", -1.0)},
    **{"up": ("z", 1.0), "down": ("z", -1.0)},
}
_SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "refused": math.nan}


@cache
def _vocabulary() -> _Words:
    text = (files("rockwobble.models") / "records" / "column_words.toml").read_text(encoding="utf-8")
    tables = tomllib.loads(text)
    kinds = {plain(word): kind for kind, words in tables["quantities"].items() for word in words.split()}
    return _Words(
        kinds={word: kind for word, kind in kinds.items() if not word.endswith("*")},
        stems=tuple((word[:-1], kind) for word, kind in kinds.items() if word.endswith("*")),
        senses={
            plain(word): _SENSES[name] for name, words in tables["senses"].items() for word in words.split()
        },
        noise=frozenset(plain(tables["others"]["noise"]).split()),
        joined=tuple(plain(tables["others"]["joined"]).split()),
        seconds={word: _SECONDS[name] for name, words in tables["times"].items() for word in words.split()},
    )


_CHANNEL = re.compile(r"[behcdfgms][nlgh]([enz])")  # of SEED, as HNE
_AXIS_OF_ACCELERATION = re.compile(
    r"(?:a|acc|accel|acceleration|lin|linacc|gf|gforce)([xyz]|ew|ns|ud)|([xyz]|ew|ns|ud)acc(?:el)?"
)
_VELOCITIES = re.compile(r"(?:[cmkdµμn]?m|in|ft)/(?:s|sec)|kines?")
_LENGTHS = frozenset(
    ["mm", "cm", "m", "dm", "µm", "μm", "um", "nm", "km", "in", "inch", "inches", "ft", "feet", "mils"]
)
_OTHER_UNITS = frozenset(
    [
        "deg",
        "°",
        "rad",
        "rad/s",
        "deg/s",
        "°/s",
        "hz",
        "mv",
        "v",
        "volt",
        "volts",
        "pa",
        "kpa",
        "n",
        "kn",
        "kg",
        "°c",
        "%",
        "µt",
        "ut",
        "db",
        "count",
        "counts",
        "cts",
    ]
)
# "acc_e_cm_s2", "ax_m_per_s2", "az_mps2", of names that allow no slash
_UNIT_IN_NAME = re.compile(
    r"[\s_]([cmkµμ]?m|ft|in)(?:_per_|_p_|p|_)?s(?:ec)?(?:_?\^?-?[2²]|_s)$", re.IGNORECASE
)
_BRACKETS = re.compile(r"[\[({<]([^\[\](){}<>]*)[\])}>]")


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnName:
    """A column by its name.

    Attributes
    ----------
    text : str
        As the file has it.
    kind : Kind
        Quantity; "acceleration" also of a column that is named by its direction alone.
    direction : "x", "y", "z" or None
    sign : float
        -1 of a column whose positive sense is west, south or down.
    azimuth : float or None
        [deg, clockwise from north]
    unit : str
        As the name states it; empty without one.
    seconds : float or None
        Of a column of time whose unit is stated: its unit [s].
    """

    text: str
    kind: Kind
    direction: Direction | None = None
    sign: float = 1.0
    azimuth: float | None = None
    unit: str = ""
    seconds: float | None = None

    @property
    def label(self) -> str:
        """The name without its unit in brackets."""
        return (
            re.sub(rf"\s?[\[(]\s?{re.escape(self.unit)}\s?[\])]$", "", self.text) if self.unit else self.text
        )


def column_name(text: str) -> ColumnName:
    """Return what a name says of its column.

    Examples
    --------
    >>> name = column_name("Beschl. Ost-West [cm/s²]")
    >>> name.kind, name.direction, name.unit
    ('acceleration', 'x', 'cm/s²')
    >>> column_name("Zeit_ms").seconds, column_name("V (cm/s)").kind, column_name("V").direction
    (0.001, 'velocity', 'z')
    """
    words, unit = _unit_apart(text[:80])
    if unit.casefold() in ("deg", "°") and _azimuth(text[:80]) is not None:  # "CHAN 1: 90 DEG"
        words, unit = text[:80], ""
    quantity = _quantity_of_unit(unit)
    named = _by_words(words)
    found = replace(named, text=text.strip(), unit=unit)
    seconds = _vocabulary().seconds.get(unit.casefold(), math.nan)
    if quantity == "time":
        # "t (s)", and "Denbora [s]": a unit of time belongs to a time in any language
        kind: Kind = "time" if named.kind in ("time", "unknown", "index") or not words else named.kind
        if plain(words).strip() in ("t", "s", ""):
            kind = "time"
        return replace(found, kind=kind, direction=None, seconds=None if math.isnan(seconds) else seconds)
    if quantity in ("velocity", "displacement", "other"):
        if named.kind == "acceleration" and named.direction is None and quantity != "other":
            return found  # `files` refuses a unit that is none of an acceleration
        kind = named.kind if named.kind in ("velocity", "displacement", "time", "index") else quantity
        return replace(found, kind=kind, direction=None)
    if quantity == "acceleration" and named.kind in ("unknown", "index", "time"):
        return replace(found, kind="acceleration")
    return found


_NORTH_SOUTH = "ns"  # a direction, unless it stands in brackets or behind a time: then nanoseconds


def _unit_apart(text: str) -> tuple[str, str]:
    """Return the words of a name and its unit: in brackets, behind "in", an underscore or a blank."""
    unit = ""
    if len(text.strip()) > 1 and _quantity_of_unit(text) and text.strip().casefold() != _NORTH_SOUTH:
        return "", text.strip()

    def keep(match: re.Match[str]) -> str:
        nonlocal unit
        inner = match[1].strip()
        if not unit and _quantity_of_unit(inner):
            unit = inner
            return " "
        return " " if inner in ("+", "-", "") else f" {inner} "

    words = _BRACKETS.sub(keep, text)
    if unit:
        return words.strip(), unit
    in_name = _UNIT_IN_NAME.search(words)
    if in_name:
        return words[: in_name.start()].strip(), f"{in_name[1]}/s2"
    behind = re.search(r"(?:[\s_,:]+in\s+|[\s_,:/]+)([^\s_]+)$", words.strip())
    if behind and _quantity_of_unit(behind[1]):
        rest = words.strip()[: behind.start()]
        # a_g is a symbol; "acc g", "time_ms" and "acc_E cm/s2" state units; V E N S W D are directions
        letters = re.sub(r"[^\w]|_", "", rest)
        if behind[1].casefold() == _NORTH_SOUTH and _by_words(rest).kind != "time":
            return words.strip(), ""
        # "t/s" is a quantity over its unit, "N/S" a direction
        over = "/" in words[behind.start() : behind.end()] and letters.casefold() not in ("", "n")
        if len(behind[1]) > 1 or (behind[1].casefold() in "sg" and (over or len(letters) > 2)):
            return rest, behind[1]
    return words.strip(), ""


def _quantity_of_unit(unit: str) -> Kind | None:
    word = unit.strip().casefold()
    if word in _vocabulary().seconds:
        return "time"
    if unit_of(word) is not None:
        return "acceleration"
    if _VELOCITIES.fullmatch(word.replace("sec", "s")):
        return "velocity"
    if word in _LENGTHS:
        return "displacement"
    if word in _OTHER_UNITS:
        return "other"
    if re.fullmatch(r"(?:[a-zµμ]{1,2}/s(?:ec)?(?:\^|\*\*)?[2²]|%\s?g|milli-?g|mg|[a-z]{1,2}/s/s)", word):
        return "acceleration"
    return None


def _by_words(words: str) -> ColumnName:
    """Return what the words of a name say, without its unit."""
    unknown = ColumnName(text=words, kind="unknown")
    azimuth = _azimuth(words)
    if azimuth is not None:
        return replace(unknown, kind="acceleration", azimuth=azimuth)
    for joined in _vocabulary().joined:
        words = plain(words).replace(joined, " ") if joined in plain(words) else words
    accelerates = len(words.strip()) < 1 or any(joined in plain(words) for joined in _vocabulary().joined)
    tokens = re.findall(r"[^\W\d_]+|\d+", plain(re.sub(r"(?<=[a-zа-я])(?=[A-ZА-Я])", " ", words)))
    if not tokens:
        return replace(unknown, kind="acceleration" if accelerates and words else "index")
    kinds = [_kind(token) for token in tokens]
    if len(tokens) > 1:  # "a" and "i" are articles, "t" a transverse direction, where more stands there
        kinds = [
            None if token in ("i", "k", "no") and tokens[0] != token else kind
            for token, kind in zip(tokens, kinds, strict=True)
        ]
    for kind in ("velocity", "displacement", "other"):
        if kind in kinds and not ("acceleration" in kinds and kind != "other"):
            return replace(unknown, kind=kind)
    directions = _directions(
        [t for t, k in zip(tokens, kinds, strict=True) if k not in ("acceleration", "time") or t in ("t",)]
    )
    if len(directions) == 1:
        ((direction, sign),) = directions
        return replace(unknown, kind="acceleration", direction=direction, sign=sign)
    if directions:
        return unknown
    if "acceleration" in kinds:
        return replace(unknown, kind="acceleration")
    for kind in ("time", "index"):
        if kind in kinds and all(
            k is not None or t in _vocabulary().noise or t.isdigit()
            for t, k in zip(tokens, kinds, strict=True)
        ):
            return replace(unknown, kind=kind)
        if kind in kinds and kinds[0] == kind:
            return replace(unknown, kind=kind)
    return unknown


def _kind(token: str) -> Kind | None:
    return _vocabulary().kinds.get(token) or next(
        (kind for stem, kind in _vocabulary().stems if token.startswith(stem)), None
    )


def _directions(tokens: Sequence[str]) -> set[tuple[Direction, float]]:
    """Return the senses that words name: one where the name is clear."""
    words = [token for token in tokens if token not in _vocabulary().noise]
    for joined in ("".join(words), *words):
        axis = _AXIS_OF_ACCELERATION.fullmatch(joined) or _CHANNEL.fullmatch(joined)
        if joined in _vocabulary().senses and (joined == "".join(words)):
            return {_vocabulary().senses[joined]}
        if axis:
            return {_vocabulary().senses[next(filter(None, axis.groups()))]}
    pairs = {a + b for a, b in itertools.pairwise(words)}
    of_pairs = {_vocabulary().senses[pair] for pair in pairs if pair in _vocabulary().senses}
    return of_pairs or {_vocabulary().senses[word] for word in words if word in _vocabulary().senses}


_QUADRANT = re.compile(r"\b([NS])\s?(\d{1,2})\s?([EW])\b")
_DEGREES = re.compile(r"(?<![\d.])(\d{3}|\d{1,3}(?:\.\d{1,3})?(?=\s?DEG))(?![\d.])")


def _azimuth(words: str) -> float | None:
    """Return the azimuth in a name: "N30E", "090", "H2 (105 deg)" [deg]."""
    text = words.strip().upper().replace("°", " DEG")
    quadrant = _QUADRANT.search(text)
    if quadrant:
        angle = float(quadrant[2]) if quadrant[1] == "N" else 180.0 - float(quadrant[2])
        return (angle if quadrant[3] == "E" else -angle) % 360.0
    degrees = _DEGREES.search(text)
    return float(degrees[1]) % 360.0 if degrees and float(degrees[1]) <= 360.0 else None


_STATEMENT = re.compile(r"=\s?[-+.\d]")  # "dt=0.005 s" names no column
_TOTALS = ("at", "tgf", "gft", "gforcet")  # of phones: the size of a vector whose components stand beside it
_GERMAN = ("zeit", "beschl")  # words beside which "O" is Ost; in French, Spanish and Italian it is west


def settle(names: Sequence[ColumnName]) -> list[ColumnName]:
    """Return names, with those corrected whose meaning depends on the others.

    "T" beside "Time" is no time but a transverse component, "O" beside "N" and German words is east, and "aT"
    beside x, y and z is their resultant.

    Examples
    --------
    >>> [name.kind for name in settle([column_name(word) for word in ("Time", "L", "T")])]
    ['time', 'unknown', 'unknown']
    """
    letters = [re.sub(r"[\W\d_]+", "", plain(name.label)) for name in names]
    named = [
        name.kind == "time" and letter not in ("t", "") for name, letter in zip(names, letters, strict=True)
    ]
    directions = {name.direction for name in names}
    german = any(letter.startswith(_GERMAN) for letter in letters)

    def in_company(name: ColumnName, letter: str) -> ColumnName:
        if name.kind == "time" and letter == "t" and any(named):
            return replace(name, kind="unknown", seconds=None)
        if letter == "o" and german and "y" in directions and "x" not in directions:
            return replace(name, kind="acceleration", direction="x")
        if letter in _TOTALS and {"x", "y", "z"} <= directions:
            return replace(name, kind="other", direction=None)
        return name

    return [in_company(name, letter) for name, letter in zip(names, letters, strict=True)]


_MOST_LINES = 60  # of a header, at each of its ends, in which names are looked for
_LONGEST_LINE = 400  # [characters]


def names_of(header: Sequence[str], width: int) -> tuple[list[ColumnName] | None, list[str]]:
    """Return the names of `width` columns by the line of a header that has them, and the other lines.

    Parameters
    ----------
    header : sequence of str
        Lines without marks of comments.
    width : int
        Number of columns.

    Returns
    -------
    names : list of ColumnName or None
        None where no line has names.
    others : list of str
        The lines that are not about single columns.
    """
    lines = [*header[:_MOST_LINES], *header[max(_MOST_LINES, len(header) - _MOST_LINES) :]]
    best: list[ColumnName] | None = None
    units: list[str] | None = None
    most, used = 0, set[int]()
    of_units: set[int] = set()
    for place in range(len(lines) - 1, -1, -1):
        last = place == max(set(range(len(lines))) - of_units, default=0)
        for cells in _splittings(lines[place][:_LONGEST_LINE], width):
            if any(_STATEMENT.search(cell) or cell.endswith("=") for cell in cells):
                continue
            stated = [cell.strip(" []()") for cell in cells]
            of_all = all(_quantity_of_unit(cell) or cell in ("-", "") for cell in stated)
            are_names = all(cell in _vocabulary().senses or cell == "t" for cell in map(plain, stated))
            if last and width > 1 and units is None and of_all and not are_names:
                units, of_units = stated, {place}
                break
            names = [column_name(cell) for cell in cells]
            known = sum(name.kind != "unknown" and name.text not in ("", name.unit) for name in names)
            separated = re.search(r"[,;|\t]|\s{2}", lines[place].strip()) is not None  # else a sentence
            # the lower of two lines that know as much; of the last, which mostly names them, a part is enough
            if known > most and (2 * known > width or (last and separated)):
                best, most, used = names, known, {place}
    place = max(set(range(len(lines))) - of_units, default=-1)
    if best is None and place >= 0 and width > 1:
        cells_of_last = next(iter(_splittings(lines[place][:_LONGEST_LINE], width, strict=True)), None)
        if cells_of_last is not None and not any(map(_STATEMENT.search, cells_of_last)):
            best, used = [column_name(cell) for cell in cells_of_last], {place}
    if best is not None and units is not None:
        best = [
            column_name(f"{name.text} [{unit}]") if unit and not name.unit else name
            for name, unit in zip(best, units, strict=True)
        ]
    return best and settle(best), [line for at, line in enumerate(lines) if at not in used | of_units]


def names_that_hold(header: Sequence[str], width: int, words: Sequence[str]) -> list[ColumnName] | None:
    """Return the names of `width` columns by the line of a header that holds all words; None without one.

    For words that the user gives, which may be names that say nothing by themselves, such as HN1; numbers
    of columns are passed over.
    """
    wanted = {comparison_key(word) for word in words if not word.strip().isdecimal()}
    for line in reversed(header[:_MOST_LINES] if wanted else ()):
        for cells in _splittings(line[:_LONGEST_LINE], width):
            if wanted <= {
                form for cell in cells for form in (comparison_key(cell), comparison_key(without_unit(cell)))
            }:
                return settle([column_name(cell) for cell in cells])
    return None


def comparison_key(name: str) -> str:
    """Return a name as names are compared: without case, accents, blanks and punctuation."""
    return re.sub(r"[\W_]+", "", plain(name))


def without_unit(name: str) -> str:
    """Return a name up to its first bracket."""
    return re.sub(r"[\[(].*", "", name)


def quantities_of(line: str) -> set[Kind]:
    """Return the quantities that the words of a line name."""
    words = plain(line[:_LONGEST_LINE])
    kinds: set[Kind] = (
        {"acceleration"} if any(joined in words for joined in _vocabulary().joined[:2]) else set()
    )
    tokens = re.findall(r"[^\W\d_]{3,}|[^\x00-\x7f]{2,}", words)
    return kinds | {kind for token in tokens if (kind := _kind(token)) is not None}


def refuse_other_quantity(file: RecordFile, lines: Sequence[str]) -> None:
    """Refuse a file whose header is about velocities or displacements, and not about accelerations.

    Raises
    ------
    ValueError
        Naming the line that says so.
    """
    kinds = [quantities_of(line) for line in lines[:_MOST_LINES]]
    if any("acceleration" in of_line for of_line in kinds):
        return
    for line, of_line in zip(lines, kinds, strict=False):
        if of_line & {"velocity", "displacement"}:
            raise ValueError(f"{file.name} is not an acceleration record, it says {line.strip()[:60]!r}")


def refuse_scale(file: RecordFile, lines: Sequence[str]) -> None:
    """Refuse numbers whose header states a factor or counts: they are no accelerations yet.

    Raises
    ------
    ValueError
        Naming the line that says so.
    """
    for line in lines[:_MOST_LINES]:
        if _SCALE.search(line[:_LONGEST_LINE]):
            raise ValueError(
                f"{file.name} has numbers to be multiplied by a factor, it says {line.strip()[:60]!r}: its "
                "format is not known here, write its accelerations as columns"
            )


_SCALE = re.compile(
    r"scal(?:e|ing)[ _]?factor|conversion[ _]?factor|\bcounts?\b(?!\s?[:=]?\s?\d)|\blsb\b|factor de escala"
    r"|\bg\s?(?:[*x×]\s?|/\s?)10|10\s?(?:\^|\*\*)?\s?-\s?\d\s?\*?\s?(?:g|m|cm)\b",  # "g*100", "10^-3 g"
    re.IGNORECASE,
)


def unit_of_time(word: str) -> bool:
    """Return whether a word is a unit of time."""
    return _quantity_of_unit(word) == "time"


_BLANK = "\ue000"  # inside of a cell, where blanks part cells


def _splittings(line: str, width: int, *, strict: bool = False) -> list[list[str]]:
    """Return the ways to cut a line into `width` cells; `strict`: by commas, semicolons and tabs alone."""
    ways: list[list[str]] = []
    # "time (sec)" is one cell
    joined = re.sub(r"\s{0,3}[\[(][^\[\]()]*[\])]", lambda match: re.sub(r"\s", _BLANK, match[0]), line)
    behind = joined.partition(":")[2]
    patterns = (";", "[,;|]", r"\t") if strict else (";", "[,;|]", r"\t", r"\s{2,}", r"[\s,;|]+")
    for text in (joined.strip(" "), behind.strip(" ")):
        for pattern in patterns if text else ():
            cells = [cell.replace(_BLANK, " ").strip() for cell in re.split(pattern, text.rstrip(",;| \t"))]
            if len(cells) == width and cells not in ways:
                ways.append(cells)
    return ways


def column_list(names: Sequence[ColumnName] | None, width: int) -> str:
    """Return the columns of a file for a message: their numbers, and their names where they have some."""
    if names is None:
        return f"{width} columns without names"
    return ", ".join(f"{at} {name.text[:16] or '(no name)'}" for at, name in enumerate(names, start=1))[:110]
