"""Values as a list of a program: Tcl "set accel { ... }", Python "acc = [ ... ]", MATLAB "acc = [ ... ];"."""

from __future__ import annotations

import re

from ..component import Component, ReadingOptions, RecordFile
from . import columns, values

NAME = "list of values"
_FACTOR = re.compile(r"-factor\s{1,9}([^\s;}]{1,20})")
# 1 g in some unit, by which numbers in g are multiplied in OpenSees; another factor makes another motion
_GRAVITIES = re.compile(
    r"\$g|1\.?0*|9\.8(?:0|1|07|0?665|066|0665)?|98[01](?:\.\d*)?|386(?:\.\d*)?|32\.(?:2|17\d*)"
)
_CLOSING = {"{": "}", "[": "]", "(": ")", '"': '"'}
_BEGIN = re.compile(
    r"(?:\bset\s{1,9}\w{1,40}(?:\(\w{1,40}\))?\s{1,9}|-values\s{1,9}|=\s{0,9}(?:\w{1,20}\.)?(?:array\()?\s{0,9}|^\s{0,9})"
    r"(?P<open>[{\[(\"])\s{0,9}(?:list\s)?[\s\\]{0,9}\[?(?=[-+.\d])",
    re.MULTILINE,
)
_MOST_LINES = 60  # above the list
_BETWEEN = str.maketrans({",": " ", "\\": " ", "[": " ", "(": " ", ")": " "})


def _begin(file: RecordFile) -> re.Match[str] | None:
    if not any("{" in line or "[" in line or '"' in line for line in file.head):
        return None
    return _BEGIN.search("\n".join(line[:400] for line in file.text[:_MOST_LINES]))


def recognizes(file: RecordFile) -> bool:
    """Return whether a bracket opens before the first number and closes behind the last."""
    match = _begin(file)
    if match is None or (match["open"] == '"' and file.content.count(b'"') > 2):  # cells in quotation marks
        return False
    tail = "".join(line.strip() for line in file.text[-3:]).rstrip(" ;)")
    return tail.endswith(_CLOSING[match["open"]]) or (match["open"] == "{" and "} -factor" in tail[-100:])


def read(file: RecordFile, options: ReadingOptions) -> list[Component]:
    """Read the numbers between the brackets, as columns where semicolons part rows of several.

    Raises
    ------
    ValueError
        If the file holds several lists, scales its numbers, or as the readers of values and columns do.
    """
    match = _begin(file)
    assert match is not None
    text = "\n".join(file.text)
    # the first lines may have been cut for the pattern, numbers stand behind
    begin = (
        match.end() if text[: match.end()] == match.string[: match.end()] else text.index(match["open"]) + 1
    )
    # options of OpenSees may stand behind the list: -factor 9.81
    factor = _FACTOR.search(text[-200:])
    if factor is not None and not _GRAVITIES.fullmatch(factor[1]):
        raise ValueError(
            f"{file.name} scales its numbers, it says {factor[0]!r}: write the accelerations themselves"
        )
    body = re.sub(r"\}[^{}\n]{0,200}$", "}", text[begin:].rstrip()) if match["open"] == "{" else text[begin:]
    body = body.rstrip(" ;)\n").removesuffix(_CLOSING[match["open"]])
    other = re.search(r"[A-DF-Za-df-z={}]{2,}|\bset\b|=", body)
    if other is not None:
        line = text.count("\n", 0, begin + other.start()) + 1
        raise ValueError(
            f"{file.name}, line {line}: expected numbers up to the end of the list, got "
            f"{file.text[line - 1].strip()[:60]!r}: write one list, or columns"
        )
    rows = body.translate(_BETWEEN).replace("...", " ").replace("]", "\n").replace(";", "\n")
    # words in front stay a header, and lines stay where they are
    header = re.sub(r"[{}\[\]]", " ", text[: match.start()])
    inside = RecordFile(file.path, f"# {header.strip()}\n{rows}".replace("\n\n", "\n").encode())
    reader = values if values.recognizes(inside) else columns
    components: list[Component] = reader.read(inside, options)
    return components
