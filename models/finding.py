"""Findings: sentences as data, which programs read and one file of words puts into English."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import entry_points
from types import MappingProxyType
from typing import TYPE_CHECKING, Literal

from . import plain_json
from .plain_json import JsonObject
from .shown import CompactRepr

if TYPE_CHECKING:
    import pandas as pd

_WRITERS = "rockwobble.words"  # group of entry points in which a package with the words of findings registers

Level = Literal["note", "satisfied", "not tested", "caution", "not satisfied"]
Grade = Literal["satisfied", "not tested", "caution", "not satisfied"]
#: Grades, the best first; a finding without a grade is a note.
GRADES: tuple[Grade, ...] = ("satisfied", "not tested", "caution", "not satisfied")
#: A number, a text, a list of texts, or a number with the ends of its 95 % interval.
Value = float | int | str | tuple[str, ...] | tuple[float, float, float] | None

#: Unit and meaning of each value of a finding, by its name; a name may end in a number or in
#: `_` and a word that distinguishes two of one kind, as ``share_vertical``.
QUANTITIES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        # value of a finding: (unit, meaning)
        "given": ("", "what the case states"),
        "demand": ("", "what the motion asks for, in the unit of what is given"),
        "size": ("", "size of a difference, in the unit of its bound"),
        "bound": ("", "limit that a size is compared with"),
        "factor": ("", "factor on the shaking as given"),
        "ratio": ("", "ratio of two sizes"),
        "p": ("p", "probability of a difference as large by chance"),
        "intensity": ("", "intensity of shaking in the measure of the study"),
        "share": ("share", "share of a whole, 0 to 1"),
        "time": ("s", "time from the start of the motion"),
        "until": ("s", "end of a span that begins with the motion"),
        "predicted": ("s", "predicted end of such a span"),
        "duration": ("s", "length of time"),
        "years": ("a", "mean time between two such events"),
        "tilt": ("rad", "tilt of the axis from vertical"),
        "angle": ("rad", "an azimuth, or an angle about the vertical"),
        "peak": ("alpha", "largest tilt"),
        "difference": ("alpha", "difference of two tilts"),
        "displacement": ("m", "distance of the base centre from its place"),
        "force": ("weights", "a force over the weight of the body"),
        "length": ("m", "a length of the body or its support"),
        "rate": ("rad/s", "a rate of rolling"),
        "mass": ("t", "a mass"),
        "stress": ("MPa", "a stress of a tendon"),
        "frequency": ("1/a", "annual frequency"),
        "runs": ("count", "number of runs"),
        "overturned": ("count", "number of runs that overturn"),
        "count": ("count", "number of things"),
        "code": ("", "code of a diagnostic"),
        "name": ("", "name of a case, a run, a record or a quantity"),
        "names": ("", "such names"),
        "reason": ("", "key of a reason in the table of words"),
        "detail": ("", "what a file or an engine says, word for word"),
    }
)


def unit_of(name: str) -> str:
    """Unit of the value of a finding by its name, as `QUANTITIES` states it.

    Raises
    ------
    ValueError
        If the name, without the part after its first underscore, is none of `QUANTITIES`.

    Examples
    --------
    >>> unit_of("tilt"), unit_of("share_vertical")
    ('rad', 'share')
    """
    quantity = name if name in QUANTITIES else name.partition("_")[0]
    if quantity not in QUANTITIES:
        raise ValueError(f"values must be named by models.finding.QUANTITIES, got {name!r}")
    return QUANTITIES[quantity][0]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Finding(CompactRepr):
    """A sentence as data; programs read key, level and values, one file of words says it.

    Attributes
    ----------
    key : str
        What is found, as ``friction.too_little``: group and name.
    level : Level
        A grade, or "note" where nothing is graded.
    values : mapping of str to Value
        Numbers and texts of the sentence by the names of `QUANTITIES`, in the units stated there; NaN or None
        where one is not known.
    runs : str
        Which runs it is of: their group, or the label of a run. Empty: of the case as given.

    Raises
    ------
    ValueError
        If a value has no name of `QUANTITIES`.

    Examples
    --------
    >>> Finding(key="friction.too_little", level="caution", values={"given": 0.3, "share": 0.12})
    Finding(key='friction.too_little', level='caution', values={'given': 0.3, 'share': 0.12})
    """

    key: str
    level: Level = "note"
    values: Mapping[str, Value] = field(default_factory=dict)
    runs: str = ""

    def __post_init__(self) -> None:
        for name in self.values:
            unit_of(name)

    def quantities(self) -> list[tuple[str, Value, str]]:
        """Name, value and unit of each value."""
        return [(name, value, unit_of(name)) for name, value in self.values.items()]

    def to_json(self) -> JsonObject:
        """Key, level, runs, and each value with its unit."""
        values = {name: {"value": value, "unit": unit} for name, value, unit in self.quantities()}
        return {"key": self.key, "level": self.level, "runs": self.runs, "values": values}


class Findings(tuple[Finding, ...]):
    """Findings in order of weight; the repr is their text on a page."""

    __slots__ = ()

    def __new__(cls, findings: Iterable[Finding] = ()) -> Findings:
        """Findings from any iterable of them."""
        return super().__new__(cls, findings)

    def __repr__(self) -> str:
        for entry in entry_points(group=_WRITERS):
            text: str = entry.load()(self)
            return text
        return super().__repr__()

    def of(self, group: str) -> Findings:
        """Findings whose key begins with ``group.``."""
        return Findings(each for each in self if each.key.startswith(f"{group}."))

    def to_frame(self) -> pd.DataFrame:
        """Table with a row for each value: finding, key, level, runs, name, value, unit."""
        import pandas as pd

        rows = [
            {"finding": number, "key": each.key, "level": each.level, "runs": each.runs}
            | {"name": name, "value": value, "unit": unit}
            for number, each in enumerate(self)
            for name, value, unit in each.quantities() or [("", None, "")]
        ]
        return pd.DataFrame(rows, columns=["finding", "key", "level", "runs", "name", "value", "unit"])

    def to_json(self, kind: str) -> bytes:
        """File KIND.json: the kind of results, and their findings as `Finding.to_json` gives them."""
        content = {"kind": kind, "findings": [each.to_json() for each in self]}
        return (plain_json.dumps(content, indent=1) + "\n").encode()
