"""Metadata in headers of networks: orientation of a sensor, peak of a component."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from .component import Direction

# names of components; W, WE and EW stand for the component with positive sense east
TURNED_UP = "positive is down in the file, turned to up"  # note on a vertical component
_DIRECTIONS: dict[str, Direction] = {
    **dict.fromkeys(("E", "EW", "WE", "EAST", "EASTWEST", "WESTEAST"), "x"),
    **dict.fromkeys(("N", "NS", "SN", "NORTH", "NORTHSOUTH", "SOUTHNORTH"), "y"),
    **dict.fromkeys(("U", "UD", "DU", "Z", "V", "UP", "UPDOWN", "VERT", "VERTICAL"), "z"),
}
_QUADRANT = re.compile(r"([NS])\s*(\d{1,3})\s*([EW])")
_DEGREES = re.compile(r"(\d{1,3})(?:\.\d*)?\s*(?:DEG|$)")
_AGREEMENT = 0.02  # relative: printed peaks are rounded, and some are of finer samples
_CONTRADICTION = 2.0  # factor between peaks beyond which the header describes another motion


def direction_of(name: str) -> Direction | None:
    """Direction in the name of a component: "E-W", "NS", "Up"; None for any other name.

    Examples
    --------
    >>> direction_of("E-W"), direction_of("U-D"), direction_of("H1")
    ('x', 'z', None)
    """
    return _DIRECTIONS.get(re.sub(r"[\s_+-]", "", name[:20]).upper())


def azimuth_of(text: str) -> float | None:
    """Azimuth in a text: "N80W", "360 Deg", "15" [deg, clockwise from north, 0 to 360).

    Examples
    --------
    >>> azimuth_of("S16W"), azimuth_of("N80W"), azimuth_of("360 Deg"), azimuth_of("Up")
    (196.0, 280.0, 0.0, None)
    """
    text = text[:40].strip().upper()
    quadrant = _QUADRANT.match(text)
    if quadrant:
        angle = float(quadrant[2])
        if angle > 90.0:
            return None
        angle = 180.0 - angle if quadrant[1] == "S" else angle
        return (angle if quadrant[3] == "E" else -angle) % 360.0
    degrees = _DEGREES.match(text)
    return float(degrees[1]) % 360.0 if degrees and float(degrees[1]) <= 360.0 else None


def direction_at(azimuth: float | None) -> Direction | None:
    """Direction of an azimuth [deg] that is exactly east or north, else None."""
    return None if azimuth is None else {90.0: "x", 0.0: "y"}.get(azimuth % 360.0)  # type: ignore[return-value]


def compare_peak(
    name: str, values: NDArray[np.float64], stated: float | None, unit: str, resolution: float = 0.0
) -> tuple[str, ...]:
    """Note if the largest sample differs from the peak in the header, else empty.

    Parameters
    ----------
    name : str
        File and component, for the message.
    values : ndarray, shape (n,)
        Samples [`unit`].
    stated : float or None
        Peak of the header, of any sign [`unit`]; None where it has none.
    unit : str
        For the message.
    resolution : float
        Last digit of the peak [`unit`].

    Raises
    ------
    ValueError
        If the two differ by a factor of 2: then the file is damaged, or is not what its header says.
    """
    if not stated or not len(values):
        return ()
    peak, stated = float(np.abs(values).max()), abs(stated)
    off = abs(peak - stated)
    if off <= _AGREEMENT * stated + 2.0 * resolution:
        return ()
    text = f"a peak of {stated:.5g} {unit}, its samples have {peak:.5g}"
    if max(peak, stated) > _CONTRADICTION * min(peak, stated) + 2.0 * resolution:
        raise ValueError(f"{name}: the header states {text}: the file is damaged")
    return (f"its header states {text}",)
