"""What holds a cylinder in its place: the supports, and what is to be known of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from .number_checks import require_one_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Support:
    """A support and its facts; whoever needs one asks this value, not for a name.

    Attributes
    ----------
    name : str
        As in `Run` and in tables.
    words : str
        For people.
    own_model : str
        Support of the reduced model that an exact engine would follow: for a recess with clearance the one of
        flat ground, on which the cylinder rolls until it first touches a wall.
    compared_with : tuple of str
        Supports of the reduced models that an engine's run is compared with.
    guided : bool
        Whether the twist is held at zero: the ideal recess.
    walls : bool
        Whether the cylinder may touch walls, which no reduced model has: the run is compared with the same at
        a finer step, too.
    """

    name: str
    words: str
    own_model: str
    compared_with: tuple[str, ...]
    guided: bool = False
    walls: bool = False

    @property
    def has_model(self) -> bool:
        """Whether there is a reduced model of this support itself."""
        return not self.walls


RECESS = Support(
    name="recess", words="ideal recess", own_model="recess", compared_with=("recess",), guided=True
)
FLAT = Support(name="flat", words="flat ground", own_model="flat", compared_with=("recess", "flat"))
RING = Support(
    name="ring", words="recess with clearance", own_model="flat", compared_with=("recess",), walls=True
)
SUPPORTS: Mapping[str, Support] = MappingProxyType({each.name: each for each in (RECESS, FLAT, RING)})


def support_named(name: str) -> Support:
    """Return the support of a name.

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
