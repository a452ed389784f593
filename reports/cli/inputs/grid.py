"""From the options of a grid to its axes, ground motions and models."""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated

import rockwobble as rw
from rockwobble.compare.studies.plans import GridPlan

from . import options

_motion = options.panel("Ground motion")


@dataclass(frozen=True, kw_only=True)
class GridOptions(GridPlan):
    """The options that state a grid."""

    record_x: Annotated[
        list[Path] | None,
        _motion(
            "East-west component, or zero; may be repeated for several records. Default: El Centro 1940."
        ),
    ] = None
    record_y: Annotated[list[Path] | None, _motion("North-south component of each, or zero.")] = None
    record_z: Annotated[list[Path] | None, _motion("Vertical component of each, or of none.")] = None
    units: options.Units = None
    resample: options.Resample = False

    def grid(self, models: list[str] | None) -> rw.Grid:
        """Return the grid of these axes by some reduced models, the recess model without any.

        Raises
        ------
        ValueError
            If one is out of range, two do not go together, or a record cannot be read.
        """
        import numpy as np

        given = {each.name: getattr(self, each.name) for each in fields(GridPlan)}
        given |= {name: np.linspace(*of) for name, of in self.DEFAULTS.items() if given[name] is None}
        return rw.Grid(**given, motions=self._motions(), models=models or ("recess",))

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
