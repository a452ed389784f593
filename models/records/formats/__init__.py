"""Formats of record files, one a module, behind one protocol.

A reader turns a file into components. It knows nothing of the other files of a record, of directions that the
user states, of lengths and clocks that must agree: `files` puts components together.

Writing one
-----------
Write a module here with the members of `Reader`, and name it in READERS. What it must hold:

* `NAME` is the format as its users call it, printed with every record that was read.
* `recognizes` looks for what only this format has, mostly in `RecordFile.head` (the first lines in capitals),
  raises nothing, whatever stands in the file, and takes no more than some microseconds: it is asked of every
  file. A binary file has no lines; look at `content`.
* READERS are asked in their order and the first that recognises the file reads it: a format with a signature
  stands before that of free text, which takes what is left.
* `read` returns every component that the file holds, in the order of the file, in the unit of the file after
  its own scale factor (counts times gal per count are gal). It guesses nothing: what the file does not say
  stays None, and what contradicts itself is refused.
* Directions are stated where the file states them: x for east, y for north, z for up; `azimuth` where it
  gives degrees, of the positive sense (the positive sense of a component named W is 270). `label` is the
  component as the file has it ("HNE", "Chan 2: 90 Deg").
* `reading` is what the user says. A reader of a format that says its own unit leaves `reading.units` alone:
  `files` compares the two.
* Bad input raises ValueError in one printable line below 250 characters that begins with `file.name`, has
  the line where there is one, and says what was expected and what stands there.
* Time grows linearly with the size of the file, also of a damaged one: no pattern that can match in two ways,
  no text that is cut again for each number. `numbers` reads blocks of numbers, `units` the unit of a header.

A new format is its module, its test in tests/models (a small file of invented values, and each refusal), and
its line in the table of the page docs/guide/records.md.
"""

from __future__ import annotations

from typing import Protocol

from ..component import Component, RecordFile
from ..directions import as_named
from ..numbers import without_filled_end
from ..reading import Reading
from . import (
    afad,
    at2,
    bbp,
    cosmos,
    csmip,
    csmnc,
    cwa,
    esm,
    geonet,
    jma,
    knet,
    miniseed,
    others,
    sac,
    smc,
    text,
)


class Reader(Protocol):
    """Interface of a module that reads one format."""

    NAME: str

    def recognizes(self, file: RecordFile) -> bool:
        """Return whether a file is of this format."""

    def read(self, file: RecordFile, reading: Reading) -> list[Component]:
        """Return the components of a file.

        Raises
        ------
        ValueError
            If the file is damaged, or holds something else than accelerations.
        """


# formats in the order in which they are tried
READERS: tuple[Reader, ...] = (
    knet,
    jma,
    esm,
    afad,
    cwa,
    geonet,
    cosmos,
    others,
    csmip,
    csmnc,
    smc,
    bbp,
    miniseed,
    sac,
    at2,
    text,
)


def read_components(file: RecordFile, reading: Reading) -> list[Component]:
    """Return the components of a file by the first reader that recognises it.

    Raises
    ------
    ValueError
        If no reader does, or its reader refuses it.
    """
    for reader in READERS:
        if reader.recognizes(file):
            components = reader.read(file, reading)
            if reading.columns and reader is not text and len(components) > 1:
                components = as_named(components, reading.column_texts, file.name)
            for component in components:  # a step given by the user must be that of the file
                reading.settled_step(component.path.name, component.time_step)
            return [without_filled_end(component, cut=reader is not text) for component in components]
    file.text  # noqa: B018 - says that the file is binary where it is
    raise ValueError(f"{file.name} has no format that can be read")
