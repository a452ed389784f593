"""From the options of a grid to its axes, ground motions and models."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import rockwobble as rw

from . import options
from .method_values import numbers

_grid = options.panel("Grid: each a number, a list 1,2,6 or a range FROM:TO:COUNT")
_NUMBERS: dict[str, Any] = {"parser": numbers, "metavar": "LIST|FROM:TO:COUNT"}


@dataclass(frozen=True, kw_only=True)
class GridOptions:
    """The options that state a grid."""

    semidiagonal: Annotated[Any, _grid("R, in m.", **_NUMBERS)] = "0.5:30:100"
    tan_alpha: Annotated[Any, _grid("Slenderness b/h.", **_NUMBERS)] = "0.2"
    scale: Annotated[Any, _grid("Factors on the records.", **_NUMBERS)] = "0.5:6:100"
    record_x: Annotated[
        list[Path] | None,
        _grid("East-west component, or zero; may be repeated for several records. Default: El Centro 1940."),
    ] = None
    record_y: Annotated[list[Path] | None, _grid("North-south component of each, or zero.")] = None
    record_z: Annotated[list[Path] | None, _grid("Vertical component of each, or of none.")] = None
    units: options.Units = None
    resample: options.Resample = False
    gravity: options.Gravity = 9.81
    slab_mass_ratio: options.SlabMassRatio = None
    plane: options.Plane = None
    restitution: options.Restitution = None

    def grid(self, models: list[str] | None) -> rw.Grid:
        """Return the grid of these axes by some reduced models, the recess model without any.

        Raises
        ------
        ValueError
            If one is out of range, two do not go together, or a record cannot be read.
        """
        given = {name: getattr(self, name) for name in ("plane", "restitution", "slab_mass_ratio")}
        if self.gravity != 9.81:  # the default of every case
            given["gravity"] = self.gravity
        return rw.Grid(
            semidiagonals=self.semidiagonal,
            tan_alphas=self.tan_alpha,
            scales=self.scale,
            motions=self._motions(),
            models=models or ("recess",),
            **{name: value for name, value in given.items() if value is not None},
        )

    def _motions(self) -> list[rw.GroundMotion]:
        x, y, z = self.record_x or [], self.record_y or [], self.record_z or []
        if not x and not y:
            named = {"--record-z": z, "--units": self.units, "--resample": self.resample}
            if lone := next((name for name, value in named.items() if value), ""):
                raise ValueError(f"{lone} belongs to a record, give --record-x and --record-y as well")
            return [rw.el_centro_1940()]
        if len(x) != len(y) or len(z) not in (0, len(x)):
            raise ValueError(
                "each record needs both horizontal components (zero for one: planar motion), and all a "
                f"vertical one or none: got {len(x)}, {len(y)} and {len(z)} files"
            )
        ups: list[Path | None] = list(z) if z else [None] * len(x)
        return [
            rw.read_record(east, north, up, units=self.units, resample=self.resample)
            for east, north, up in zip(x, y, ups, strict=True)
        ]
