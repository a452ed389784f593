"""Assignment of components to x, y and z by the directions and azimuths in their files."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .column_names import comparison_key
from .component import COLUMNS_OPTION, Component, Direction

NORTH = "north"  # value of rotate: x to the east and y to the north, by the azimuths
_LEAST_ANGLE = 30.0  # [deg] between two horizontal components that span the plane


class DirectionError(ValueError):
    """Error of a component whose file states neither direction nor azimuth."""


def in_order(components: Sequence[Component], name: str) -> list[Component]:
    """Return the components of a record as x, y and, where there is one, z.

    Parameters
    ----------
    components : sequence of Component
        All of a file or folder; those that state azimuths alone are x and y by the one that is nearer to
        east and west.
    name : str
        Name of the file or folder, for messages.

    Raises
    ------
    DirectionError
        If one has neither direction nor azimuth.
    ValueError
        If a direction is missing or there twice.
    """
    parts = _with_directions(components)
    listed = ", ".join(
        f"{part.label or part.path.name}{f' ({part.direction})' if part.direction else ''}" for part in parts
    )[:140]
    if len(parts) == 1:
        raise ValueError(
            f"{name} holds one component: give one file for each horizontal direction, or zero for the other "
            "(planar motion)"
        )
    if any(part.direction is None for part in parts):
        raise DirectionError(
            f"{name} does not say which component is east, north and up: name them by {COLUMNS_OPTION}; "
            f"it has {listed}"
        )
    for axis, word in (("x", "east"), ("y", "north"), ("z", "up")):
        count = sum(part.direction == axis for part in parts)
        if count > 1 or (count == 0 and axis != "z"):
            raise ValueError(
                f"{name} must hold one component of each direction, got {count or 'none'} for {axis} "
                f"({word}) among {listed}"
            )
    return sorted(parts, key=lambda part: str(part.direction))


def as_named(components: Sequence[Component], names: Sequence[str], file: str) -> list[Component]:
    """Components chosen by the user as x, y and z: by label, its last word, or number from 1.

    Raises
    ------
    ValueError
        If a name is that of none or of several components, or two are of the same.
    """
    forms = [
        {comparison_key(part.label), comparison_key(f" {part.label}".split()[-1]), str(at)}
        for at, part in enumerate(components, start=1)
    ]
    wanted = [comparison_key(name) for name in names if name.casefold() not in ("time", "t")]
    places = [[at for at, form in enumerate(forms) if name in form] for name in wanted]
    chosen = [matches[0] for matches in places if len(matches) == 1]
    if not len(set(chosen)) == len(wanted) <= 3:
        listed = ", ".join(f"{at} {part.label}" for at, part in enumerate(components, start=1))
        raise ValueError(
            f"{file}: {COLUMNS_OPTION} must name each of its components of x, y and z once, got "
            f"{','.join(names)[:60]}; it has {listed[:110]}"
        )
    axes: tuple[Direction, ...] = ("x", "y", "z")
    return [replace(components[at], direction=axis) for at, axis in zip(chosen, axes, strict=False)]


def at_the_surface(components: Sequence[Component]) -> tuple[list[Component], tuple[str, ...]]:
    """Components of a station without those of its borehole, and a note if there were some.

    A download of KiK-net holds both sensors; what stands on the ground is moved by the one at the surface.
    """
    surface = [part for part in components if "borehole" not in part.label]
    if not surface or len(surface) == len(components):
        return list(components), ()
    return surface, ("the sensor in the borehole left aside",)


def _with_directions(components: Sequence[Component]) -> list[Component]:
    """Components with the directions that follow from their azimuths."""
    open_ones = [part for part in components if part.direction is None and part.azimuth is not None]
    others = {part.direction for part in components}
    if len(open_ones) == 2 and not others & {"x", "y"}:
        one, two = open_ones
        # distance from north or south; of two alike, x is clockwise of y
        far = [abs(math.sin(math.radians(part.azimuth or 0.0))) for part in open_ones]
        first_is_x = far[0] > far[1]
        if abs(far[0] - far[1]) < 1e-6:
            first_is_x = ((one.azimuth or 0.0) - (two.azimuth or 0.0)) % 360.0 < 180.0
        axes: dict[int, Direction] = {
            id(one): "x" if first_is_x else "y",
            id(two): "y" if first_is_x else "x",
        }
        return [replace(part, direction=axes.get(id(part), part.direction)) for part in components]
    if len(open_ones) == 1 and len(others & {"x", "y"}) == 1:
        left: Direction = "y" if "x" in others else "x"
        return [replace(part, direction=left) if part is open_ones[0] else part for part in components]
    return list(components)


def for_place(components: Sequence[Component], axis: Direction, name: str) -> Component:
    """Component of a file that was given for one direction.

    Raises
    ------
    ValueError
        If it holds several and not exactly one of them has that direction.
    """
    if len(components) == 1:
        return components[0]
    matches = [part for part in _with_directions(components) if part.direction == axis]
    if len(matches) != 1:
        labels = ", ".join(part.label or "one without a name" for part in components)[:120]
        raise ValueError(
            f"{name} holds {len(components)} components, {len(matches)} of them for {axis}: {labels}"
        )
    return matches[0]


def turned_to_north(
    acceleration: NDArray[np.float64], azimuths: Sequence[float | None]
) -> NDArray[np.float64]:
    """Accelerations with x east and y north, from those at two azimuths.

    Parameters
    ----------
    acceleration : ndarray, shape (n, 2) or (n, 3)
    azimuths : sequence of float or None
        Azimuths of the first two columns [deg, clockwise from north].

    Raises
    ------
    ValueError
        If an azimuth is not known, or both are less than 30 deg from one line.

    Examples
    --------
    >>> abs(turned_to_north(np.array([[1.0, 0.0]]), [270.0, 180.0])).round(12).tolist()
    [[1.0, 0.0]]
    """
    first, second = azimuths[:2]
    if first is None or second is None:
        raise ValueError(
            f"rotate {NORTH} needs the azimuths of both horizontal components, which the files do not state"
        )
    angles = np.radians([first, second])
    between = abs(math.sin(angles[1] - angles[0]))
    if between < math.sin(math.radians(_LEAST_ANGLE)):
        raise ValueError(
            f"rotate {NORTH} needs two horizontal directions, got azimuths {first:g} and {second:g} deg"
        )
    # each column is the motion along its azimuth: east sin + north cos
    along = np.column_stack([np.sin(angles), np.cos(angles)])
    turned = np.array(acceleration)
    turned[:, :2] = np.linalg.solve(along, acceleration[:, :2].T).T
    return turned
