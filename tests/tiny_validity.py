"""The limits measured on a tiny grid, once for all tests that ask for it."""

from __future__ import annotations

import dataclasses
import tempfile
from functools import cache
from typing import TYPE_CHECKING

from rockwobble.compare.studies.validity.extent import QUICK, Ring
from rockwobble.compare.studies.validity.study import Validity, measure_all, validity_of

if TYPE_CHECKING:
    import pandas as pd

TINY = dataclasses.replace(
    QUICK,
    name="tiny",
    tan_alphas=(0.2, 0.7),
    releases=(0.5,),
    spins=(0.1, 0.5),
    members=2,
    shaken_tan_alphas=(0.2, 0.4),
    sizes=(4.0, 12.0),
    intensities=(1.5, 3.0),
    engine_points=((0.4, 0.5, 0.25),),
    record_step=1e-3,
    slip_points=((0.2, 0.5, 0.25),),
    slip_shares=(0.9, 1.05),
    trace_points=((0.2, 6.0, 2.0),),
    trace_length=3.0,
    rings=(Ring(),),
    ring_length=4.0,
    time_constants=(2e-3,),
    dampings=(1.0,),
)


@cache
def tiny_tables() -> dict[str, pd.DataFrame]:
    """Return the tables of all parts."""
    return measure_all(TINY, tempfile.mkdtemp(), workers=1)


@cache
def tiny_validity() -> Validity:
    """Return the study."""
    return validity_of(tiny_tables(), TINY, "rockwobble validity")
