"""The 1940 El Centro record that ships with the package."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files

from ..ground_motion import GroundMotion
from .files import read_record

# provenance and orientation: records/README.md
_EAST_WEST = "RSN6_IMPVALL.I_I-ELC270-hor2.AT2"
_NORTH_SOUTH = "RSN6_IMPVALL.I_I-ELC180-hor1.AT2"
_UP = "RSN6_IMPVALL.I_I-ELC-UP.AT2"


@cache
def el_centro_1940(vertical: bool = False) -> GroundMotion:
    """Return the record of El Centro Array #9, Imperial Valley, 18 May 1940 (PEER RSN6).

    Parameters
    ----------
    vertical : bool, optional
        Whether to include the vertical component.

    Returns
    -------
    GroundMotion
        5346 samples of 0.01 s; x is the 270 (east-west) and y the 180 (north-south) component.
        The peak of the horizontal resultant is 0.28648 g.

    Examples
    --------
    >>> motion = el_centro_1940()
    >>> motion.acceleration.shape, round(motion.peak / 9.81, 5)
    ((5346, 2), 0.28648)
    """
    with as_file(files("rockwobble.models") / "records") as folder:
        motion = read_record(folder / _EAST_WEST, folder / _NORTH_SOUTH, folder / _UP if vertical else None)
    # both horizontal components reach to the shortest of them, 5346 samples, with or without z
    return GroundMotion(motion.acceleration, motion.time_step, "El Centro 1940")
