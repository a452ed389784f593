"""Blocks of numbers one after another, each under a title: accelerations, velocities, displacements."""

from __future__ import annotations

import re
from dataclasses import replace

from ..column_names import column_name, quantities_of
from ..component import Component, ReadingOptions, RecordFile
from ..table import bare_header, first_row, is_comment
from . import columns, values

NAME = "blocks of numbers"
_NO_WORD = bytes(code for code in range(128) if not chr(code).isalpha() or chr(code) in "eEdD")
_LETTERS = re.compile(rb"[A-Za-z]{2}")
_TITLE = re.compile(r"[^\W\d_]{3}")
_NUMBERS_IN_LETTERS = ("nan", "inf")
_COMPONENT = re.compile(
    r"\b(?:comp\w*|chan\w*|dir\w*|richtung|komponente)\b[\s.:=]{1,4}([^\s,;]{1,20})", re.IGNORECASE
)
_MOST_TITLES = 200  # lines of words; a text with more is no record
_LINE = re.compile(r"(?<=\bline )\d+")


def _blocks(file: RecordFile) -> list[tuple[int, int, int]]:
    """Return for each block the line of its title, the one behind that, and the one behind its last row.

    A comment between rows begins a block where it names a quantity or a component.
    """
    lines, first = file.text, first_row(file.text)
    whole = "\n".join(lines[first:])
    titles: list[int] = []
    at, position = first, 0
    for match in _TITLE.finditer(whole):
        if match[0].lower() in _NUMBERS_IN_LETTERS:
            continue
        at, position = at + whole.count("\n", position, match.start()), match.start()
        text = lines[at].strip()
        if titles[-1:] != [at] and (not is_comment(text) or _names_block(text)):
            titles.append(at)
        if len(titles) > _MOST_TITLES:
            return []
    blocks = []
    title, begin = 0, first
    for line in [*titles, len(lines)]:
        if any(text.strip() and not is_comment(text.strip()) for text in lines[begin:line]):
            blocks.append((title, begin, line))
            title = line
        begin = line + 1
    return blocks


def _names_block(text: str) -> bool:
    return bool(quantities_of(text) or _COMPONENT.search(text[:200]))


def recognizes(file: RecordFile) -> bool:
    """Return whether titles stand between rows of numbers, of which at least one names what follows."""
    if file.lines is None:
        return False
    first = first_row(file.lines)
    if first == len(file.lines):
        return False
    rest = "\n".join(file.lines[first:]).encode("ascii", "replace").translate(None, _NO_WORD)
    if not _LETTERS.search(rest):
        return False
    blocks = _blocks(file)
    return len(blocks) > 1 and any(
        _names_block(line) for title, begin, _ in blocks[1:] for line in file.lines[title:begin]
    )


def _read_block(file: RecordFile, title: int, end: int, options: ReadingOptions) -> list[Component]:
    """Read the lines from a title to the end of its block; what is said names lines of the whole file."""
    part = RecordFile(file.path, "\n".join(file.text[title:end]).encode())

    def in_whole(words: str) -> str:
        return _LINE.sub(lambda number: str(int(number[0]) + title), words)

    try:
        components = values.read(part, options) if values.recognizes(part) else columns.read(part, options)
    except ValueError as error:
        name = file.name if str(error).startswith(file.name) else ""
        words, mark, quoted = str(error).removeprefix(name).partition("got ")
        raise ValueError(f"{name}{in_whole(words)}{mark}{quoted}") from None
    return [replace(each, notes=tuple(map(in_whole, each.notes))) for each in components]


def read(file: RecordFile, options: ReadingOptions) -> list[Component]:
    """Read the blocks of accelerations.

    Raises
    ------
    ValueError
        If none is one, if several are and their titles do not say which component each is, or as the readers
        of values and columns do.
    """
    parts: list[tuple[int, int, str]] = []
    others: list[str] = []
    for title, begin, end in _blocks(file):
        words = " ".join(bare_header(line) for line in file.text[title:begin])
        kinds = quantities_of(words)
        if kinds & {"velocity", "displacement"} and "acceleration" not in kinds:
            others.append(words[:20].strip())
        else:
            parts.append((title, end, words))
    if not parts:
        raise ValueError(
            f"{file.name}: none of its blocks is an acceleration, it has {', '.join(others)[:120]}"
        )
    names = [column_name(match[1]) if (match := _COMPONENT.search(words)) else None for _, _, words in parts]
    places = [name and (name.direction or name.azimuth) for name in names]
    if len(parts) > 1 and (None in places or len(set(places)) < len(places)):
        lines = ", ".join(str(title + 1) for title, _, _ in parts)
        raise ValueError(
            f"{file.name} holds {len(parts)} blocks of numbers, whose titles (lines {lines[:60]}) do not say "
            "which component each is: write each to a file of its own"
        )
    note = (f"velocities and displacements left out ({len(others)} blocks)",) if others else ()
    answer = []
    for (title, end, _), name in zip(parts, names, strict=True):
        for component in _read_block(file, title, end, options):
            if name is not None and name.direction is not None and name.sign > 0.0:
                component = replace(component, direction=name.direction, label=name.text)
            elif name is not None and name.azimuth is not None:
                component = replace(component, azimuth=name.azimuth, label=name.text)
            answer.append(replace(component, notes=(*component.notes, *note)))
    return answer
