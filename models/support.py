"""Supports of a cylinder, and the properties of each."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from types import MappingProxyType
from typing import Any, Self

from .number_checks import require_one_of


class Support(str):
    """A support: the text that is its name, with its facts.

    As text it goes into tables, files and arguments, and equals its name; whoever needs a fact asks for it.

    Attributes
    ----------
    words : str
        For people.
    place : str
        Where the cylinder stands, in a sentence.
    model : str
        Label of its reduced model; "" without one.
    own_model : str
        Support of the reduced model that an exact engine would follow: for a recess with clearance the one of
        flat ground, on which the cylinder rolls until it first touches a wall.
    compared_with : tuple of str
        Supports of the reduced models that an engine's run is compared with; the last is the nearest to it.
    guided : bool
        Whether the twist is held at zero: the ideal recess.
    walls : bool
        Whether the cylinder may touch walls, which no reduced model has: the run is compared with the same at
        a finer step, too.

    Examples
    --------
    >>> RING
    'ring'
    >>> RING.words, RING.walls, RING == "ring"
    ('recess with clearance', True, True)
    """

    __slots__ = _FACTS = ("words", "place", "model", "own_model", "compared_with", "guided", "walls")
    words: str
    place: str
    model: str
    own_model: str
    compared_with: tuple[str, ...]
    guided: bool
    walls: bool

    def __new__(
        cls,
        name: str,
        *,
        words: str,
        place: str,
        model: str = "",
        own_model: str,
        compared_with: tuple[str, ...],
        guided: bool = False,
        walls: bool = False,
    ) -> Self:
        """Support of a name with its facts."""
        support = super().__new__(cls, name)
        facts = words, place, model, own_model, compared_with, guided, walls
        for fact, value in zip(cls._FACTS, facts, strict=True):
            object.__setattr__(support, fact, value)
        return support

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a support does not change, got {value!r} for {name}")

    def __reduce__(self) -> tuple[Any, ...]:
        # text is pickled without its attributes, and runs go to worker processes
        return partial(Support, **{fact: getattr(self, fact) for fact in self._FACTS}), (str(self),)

    @property
    def has_model(self) -> bool:
        """Whether a reduced model has exactly this support."""
        return bool(self.model)

    @property
    def is_recess(self) -> bool:
        """Whether it keeps the cylinder in its place, by guidance or by walls."""
        return self.guided or self.walls

    @property
    def lets_slide(self) -> bool:
        """Whether friction alone keeps the base in its place."""
        return self.has_model and not self.is_recess


RECESS = Support(
    "recess",
    words="ideal recess",
    place="in an ideal recess",
    model="recess model",
    own_model="recess",
    compared_with=("recess",),
    guided=True,
)
FLAT = Support(
    "flat",
    words="flat ground",
    place="on flat ground",
    model="flat-ground model",
    own_model="flat",
    compared_with=("recess", "flat"),
)
RING = Support(
    "ring",
    words="recess with clearance",
    place="in a recess with clearance",
    own_model="flat",
    compared_with=("recess",),
    walls=True,
)
EXTERNAL = Support(
    "external",
    words="external trajectory",
    place="in a test or another program",
    own_model="recess",
    compared_with=("recess",),
)
SUPPORTS: Mapping[str, Support] = MappingProxyType({each: each for each in (RECESS, FLAT, RING)})
MODELLED = tuple(each for each in SUPPORTS.values() if each.has_model)  # supports with a reduced model
RECESSES_FIRST = tuple(sorted(SUPPORTS.values(), key=lambda each: not each.is_recess))


def support_named(name: str) -> Support:
    """Support of a name.

    Raises
    ------
    ValueError
        If there is none.

    Examples
    --------
    >>> support_named("ring").own_model
    'flat'
    """
    require_one_of("support", name, SUPPORTS)
    return SUPPORTS[name]
