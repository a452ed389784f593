"""Quantity, component and unit of a column by its name, in the languages of the networks.

Words stand in column_words.toml and are compared without case, accents, units and punctuation. A name that is
in none of its lists is unknown, and an unknown column is never taken for a component.
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
from typing import Literal, cast

from .component import Direction, RecordFile
from .headers import azimuth_of
from .numbers import NUMBER
from .units import unit_of

Kind = Literal["time", "index", "acceleration", "velocity", "displacement", "other", "unknown"]
_LETTERS = str.maketrans(
    {"ł": "l", "ø": "o", "đ": "d", "ı": "i", "æ": "ae", "ð": "d", "þ": "th", "œ": "oe", "№": "no"}
)
_MOST_LINES, _LONGEST_LINE, _LONGEST_NAME = 60, 400, 80  # lines at each end of a header, and characters
_LEAST_STEP, _LARGEST_STEP, _SAME_STEP = 1e-5, 2.0, 3e-3  # [s], and relative: 0.0167 for 1/60
_BRACKETS = re.compile(r"[\[({<]([^\[\](){}<>]*)[\])}>]")
_QUADRANT = re.compile(r"\b[NS]\s?\d{1,2}\s?[EW]\b")
_DEGREES = re.compile(r"(?<![\d.])(\d{3}|\d{1,3}(?:\.\d{1,3})?(?=\s?DEG))(?![\d.])")
_STATEMENT = re.compile(r"=\s?(?:[-+.\d]|$)")  # "dt=0.005 s" names no column
_BLANK = "\ue000"  # stands for a blank inside of a cell, where blanks separate cells
_NORTH_SOUTH = "ns"  # a direction, except in brackets or after a time: then nanoseconds


def plain(text: str) -> str:
    """Text in small letters without accents.

    Examples
    --------
    >>> plain("Verschiebung Süd"), plain("İvme DOĞU")
    ('verschiebung sud', 'ivme dogu')
    """
    parts = unicodedata.normalize("NFKD", text.casefold())
    return "".join(part for part in parts if not unicodedata.combining(part)).translate(_LETTERS)


@cache
def _tables() -> Mapping[str, Mapping[str, str]]:
    text = (files("rockwobble.models") / "records" / "column_words.toml").read_text(encoding="utf-8")
    return cast("Mapping[str, Mapping[str, str]]", tomllib.loads(text))


@cache
def _meanings(table: str) -> Mapping[str, str]:
    """Meaning of each word of a table."""
    return {plain(word): meaning for meaning, words in _tables()[table].items() for word in words.split()}


@cache
def pattern(name: str) -> re.Pattern[str]:
    """Compiled pattern of column_words.toml."""
    patterns = _tables()["patterns"]
    if name != "stated_step":
        return re.compile(patterns[name], re.IGNORECASE)
    unit = rf"(?:\s{{0,3}}[\[(]?\s?(?P<unit>{patterns['unit_of_step']}))?"
    words = rf"(?:(?P<rate>{patterns['rate']})|{patterns['step']})(?P<gap>[^\d\n.+-]{{0,30}}?)"
    return re.compile(f"{words}(?P<number>{NUMBER}){unit}")


@dataclass(frozen=True, slots=True, kw_only=True)
class ColumnName:
    """Quantity, component and unit in the name of a column.

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
        Of a column of time whose unit is stated: its unit [s], NaN of one that is refused.
    """

    text: str = ""
    kind: Kind = "unknown"
    direction: Direction | None = None
    sign: float = 1.0
    azimuth: float | None = None
    unit: str = ""
    seconds: float | None = None


def column_name(text: str) -> ColumnName:
    """Quantity, component and unit of a column, from its name.

    Examples
    --------
    >>> name = column_name("Beschl. Ost-West [cm/s²]")
    >>> name.kind, name.direction, name.unit
    ('acceleration', 'x', 'cm/s²')
    >>> column_name("Zeit_ms").seconds, column_name("V (cm/s)").kind, column_name("V").direction
    (0.001, 'velocity', 'z')
    """
    text = text.strip()
    words, unit = _unit_apart(text[:_LONGEST_NAME])
    if unit.casefold() in ("deg", "°") and _azimuth(text[:_LONGEST_NAME]) is not None:  # "CHAN 1: 90 DEG"
        words, unit = text[:_LONGEST_NAME], ""
    name = replace(_by_words(words), text=text, unit=unit)
    quantity = quantity_of_unit(unit)
    if quantity == "time":  # in any language
        known = name.kind not in ("unknown", "index") and plain(words) not in ("t", "s", "")
        kind = name.kind if known else "time"
        return replace(name, kind=kind, direction=None, seconds=float(_meanings("times")[plain(unit)]))
    if quantity == "acceleration" and name.kind in ("unknown", "index", "time"):
        return replace(name, kind="acceleration")
    undirected = name.kind == "acceleration" and name.direction is None and quantity != "other"
    if quantity in (None, "acceleration") or undirected:  # a unit that is none of an acceleration is refused
        return name
    keeps = name.kind in ("velocity", "displacement", "time", "index")
    return replace(name, kind=name.kind if keeps else quantity, direction=None)


def _unit_apart(text: str) -> tuple[str, str]:
    """Words of a name, and its unit: in brackets, or after "in", an underscore or a blank."""
    if len(text) > 1 and quantity_of_unit(text) and text.casefold() != _NORTH_SOUTH:
        return "", text
    units = [each.strip() for each in _BRACKETS.findall(text) if quantity_of_unit(each)]
    dropped = ("+", "-", *units[:1])
    words = _BRACKETS.sub(lambda match: "" if match[1].strip() in dropped else f" {match[1]} ", text).strip()
    if units:
        return words, units[0]
    in_name = pattern("unit_in_name").search(words)
    if in_name:
        return words[: in_name.start()].strip(), f"{in_name[1]}/s2"
    behind = re.search(r"(?:[\s_,:]+in\s+|[\s_,:/]+)([^\s_]+)$", words)
    if behind is None or quantity_of_unit(behind[1]) is None:
        return words, ""
    rest, unit = words[: behind.start()], behind[1]
    if unit.casefold() == _NORTH_SOUTH and _by_words(rest).kind != "time":
        return words, ""
    # a_g is a symbol; "acc g", "time_ms" and "acc_E cm/s2" state units; V E N S W D are directions; "t/s" is
    # a quantity over its unit, "N/S" a direction
    letters = re.sub(r"[\W_]", "", rest)
    over = "/" in behind[0] and letters.casefold() not in ("", "n")
    states = len(unit) > 1 or (unit.casefold() in "sg" and (over or len(letters) > 2))
    return (rest, unit) if states else (words, "")


def quantity_of_unit(unit: str) -> Kind | None:
    """Quantity of which a word is a unit; None of other words."""
    word = plain(unit.strip())
    if word in _meanings("times"):
        return "time"
    if unit_of(unit.strip().casefold()) is not None:
        return "acceleration"
    other = _meanings("units").get(word.replace("sec", "s"))
    refused = other is None and pattern("acceleration").fullmatch(word)
    return "acceleration" if refused else cast("Kind | None", other)


def _by_words(words: str) -> ColumnName:
    """Quantity and component from the words of a name, without its unit."""
    azimuth = _azimuth(words)
    if azimuth is not None:
        return ColumnName(kind="acceleration", azimuth=azimuth)
    text, noise = plain(re.sub(r"(?<=[a-zа-я])(?=[A-ZА-Я])", " ", words)), _meanings("others")
    joined = [word for word, meaning in noise.items() if meaning == "joined" and word in text]
    for word in joined:
        text = text.replace(word, " ")
    tokens = re.findall(r"[^\W\d_]+|\d+", text)
    if not tokens:
        return ColumnName(kind="acceleration" if joined else "index")
    # "i" and "k" are articles, and "t" a transverse direction, in a name of several words
    kinds = [None if at and token in ("i", "k", "no") else _kind(token) for at, token in enumerate(tokens)]
    for kind in ("velocity", "displacement", "other"):
        if kind in kinds and (kind == "other" or "acceleration" not in kinds):
            return ColumnName(kind=cast("Kind", kind))
    pairs = zip(tokens, kinds, strict=True)
    senses = _senses([token for token, kind in pairs if token == "t" or kind not in ("acceleration", "time")])
    if len(senses) == 1:
        (sense,) = senses
        return ColumnName(
            kind="acceleration", direction=cast("Direction", sense[0]), sign=float(sense[1] + "1")
        )
    first = kinds[0] if kinds[0] in ("time", "index") else "unknown"
    return ColumnName(kind="unknown" if senses else "acceleration" if "acceleration" in kinds else first)


@cache
def _kind(token: str) -> Kind | None:
    kinds = _meanings("quantities")
    stem = next((word for word in kinds if word[-1] == "*" and token.startswith(word[:-1])), "")
    return cast("Kind | None", kinds.get(token) or kinds.get(stem))


def _senses(tokens: Sequence[str]) -> set[str]:
    """Positive senses named by words, such as "x+" for east; exactly one in a clear name."""
    senses = _meanings("senses")
    words = [token for token in tokens if token not in _meanings("others")]
    whole = "".join(words)
    if whole in senses:
        return {senses[whole]}
    for word in (whole, *words):
        axis = pattern("axis").fullmatch(word)
        if axis:
            return {senses[next(filter(None, axis.groups()))]}
    pairs = {senses[a + b] for a, b in itertools.pairwise(words) if a + b in senses}
    return pairs or {senses[word] for word in words if word in senses}


def _azimuth(words: str) -> float | None:
    """The azimuth in a name: "N30E", "090", "H2 (105 deg)" [deg]."""
    text = words.strip().upper().replace("°", " DEG")
    quadrant = _QUADRANT.search(text)
    if quadrant:
        return azimuth_of(quadrant[0])
    degrees = _DEGREES.search(text)
    return float(degrees[1]) % 360.0 if degrees and float(degrees[1]) <= 360.0 else None


def names_of(
    header: Sequence[str], width: int, wanted: Sequence[str] = ()
) -> tuple[list[ColumnName] | None, list[str]]:
    """Names of the `width` columns from the header line that has them, and the other lines.

    Parameters
    ----------
    header : sequence of str
        Lines without marks of comments.
    width : int
        Number of columns.
    wanted : sequence of str, optional
        Words of the user, all of which are in the line of the names.

    Returns
    -------
    names : list of ColumnName or None
        None where no line has names.
    others : list of str
        The lines that are not about single columns.
    """
    lines = [*header[:_MOST_LINES], *header[max(_MOST_LINES, len(header) - _MOST_LINES) :]]
    keys = set(map(comparison_key, wanted))
    units: Sequence[str] = [""] * width
    for cells in _splittings(lines[-1], width) if lines and width > 1 else ():
        stated = [cell.strip(" []()") for cell in cells]
        are_names = all(word in _meanings("senses") or word == "t" for word in map(plain, stated))
        if not are_names and all(cell in ("-", "") or quantity_of_unit(cell) for cell in stated):
            units, lines = stated, lines[:-1]
            break
    best: tuple[int, int, list[ColumnName]] = (0, -1, [])
    for place, line in enumerate(lines):
        separated = place == len(lines) - 1 and re.search(r"[,;|\t]|\s{2}", line.strip())  # else a sentence
        for cells in _splittings(line, width):
            names = [column_name(cell) for cell in cells]
            known = sum(name.kind != "unknown" and name.text not in ("", name.unit) for name in names)
            forms = {comparison_key(form) for cell in cells for form in (cell, without_unit(cell))}
            known = width * (keys <= forms) if keys else known
            # the lower of two lines with as many known names; the last line, which mostly has the names, may
            # hold a part
            if known and (2 * known > width or separated) and (known, place) > best[:2]:
                best = (known, place, names)
    if not best[0]:
        return None, lines
    named = zip(best[2], units, strict=True)
    names = [column_name(f"{name.text} [{unit}]") if unit and not name.unit else name for name, unit in named]
    return names, [*lines[: best[1]], *lines[best[1] + 1 :]]


def comparison_key(name: str) -> str:
    """Name for comparison: without case, accents, blanks and punctuation."""
    return re.sub(r"[\W_]+", "", plain(name))


def without_unit(name: str) -> str:
    """A name up to its first bracket."""
    return re.sub(r"[\[(].*", "", name).strip()


def _splittings(line: str, width: int) -> list[list[str]]:
    """Divisions of a line, or of its part after a colon, into `width` cells without numbers."""
    brackets = r"\s{0,3}[\[(][^\[\]()]*[\])]"  # "time (sec)" is one cell
    joined = re.sub(brackets, lambda match: re.sub(r"\s", _BLANK, match[0]), line[:_LONGEST_LINE])
    texts = [text.strip(" ").rstrip(",;| \t") for text in (joined, joined.partition(":")[2])]
    ways = [re.split(mark, text) for text in texts for mark in (";", "[,;|]", r"\t", r"\s{2,}", r"[\s,;|]+")]
    rows = [[cell.replace(_BLANK, " ").strip() for cell in cells] for cells in ways if len(cells) == width]
    return [cells for cells in rows if not any(map(_STATEMENT.search, cells))]


def refuse_header(
    file: RecordFile, lines: Sequence[str], comments: Sequence[str], *, accelerates: bool
) -> None:
    """Refuse a header of numbers other than accelerations, or of raw counts, and titles between rows.

    Parameters
    ----------
    file : RecordFile
        For the message.
    lines, comments : sequence of str
        Lines of the header, and comments between rows.
    accelerates : bool
        Whether the name or unit of a column is that of an acceleration.

    Raises
    ------
    ValueError
        Naming the line that says so.
    """
    words = [plain(line[:_LONGEST_LINE]) for line in lines[:_MOST_LINES]]
    kinds = [_quantities(line) for line in words]
    accelerates = accelerates or any("acceleration" in each for each in kinds)
    scaled = [line for line, text in zip(lines, words, strict=False) if pattern("scale").search(text)]
    others = [line for line, each in zip(lines, kinds, strict=False) if each & {"velocity", "displacement"}]
    titles = [
        line for line in comments if _quantities(line) or _senses(re.findall(r"[^\W\d_]+", plain(line)))
    ]
    for wrong, why in (
        (scaled, "has numbers to be multiplied by a factor"),
        ([] if accelerates else others, "is not an acceleration record"),
        (titles, "may hold several blocks of numbers"),
    ):
        if wrong:
            raise ValueError(
                f"{file.name} {why}, it says {wrong[0].strip()[:60]!r}: write accelerations "
                "alone, as columns of one file"
            )


def _quantities(line: str) -> set[str]:
    words = plain(line[:_LONGEST_LINE])
    tokens = re.findall(r"[^\W\d_]{3,}|[^\x00-\x7f]{2,}", words)
    joined = {"acceleration" for word in ("加速度", "가속도") if plain(word) in words}
    return joined | {kind for token in tokens if (kind := _kind(token)) is not None}


def stated_step(file: RecordFile, header: Sequence[str]) -> float | None:
    """Time step that a header states [s], as "dt=0.005 sec" or "Sampling rate (Hz): 200"; None without one.

    Raises
    ------
    ValueError
        If two are stated that differ.
    """
    steps = []
    for line in header[:_MOST_LINES]:
        match = pattern("stated_step").search(plain(line[:_LONGEST_LINE].replace("\\", " ")))
        number = float(match["number"].replace("d", "e")) if match else 0.0
        if match is None or not 0.0 < number < math.inf:
            continue
        in_gap = pattern("unit_of_step").search(match["gap"])
        unit = match["unit"] or (in_gap[0] if in_gap else "hz" if match["rate"] else "s")
        rate = unit in ("hz", "sps") or "/" in unit
        step = 1.0 / number if rate else number * {"m": 1e-3, "s": 1.0}.get(unit[0], 1e-6)
        steps += [step] if _LEAST_STEP <= step <= _LARGEST_STEP else []
    if steps and max(steps) - min(steps) > _SAME_STEP * min(steps):
        raise ValueError(f"{file.name} states two time steps: {min(steps):g} and {max(steps):g} s")
    return min(steps, default=None)
