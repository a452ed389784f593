"""The limits measured on a tiny grid, once for all tests of a process; engine runs once for all processes."""

from __future__ import annotations

import dataclasses
import os
import pickle
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest

from rockwobble import multibody
from rockwobble.compare.storage.provenance import fingerprint
from rockwobble.studies.validity.plan import QUICK, Ring
from rockwobble.studies.validity.study import Validity, measure_all, validity_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    import pandas as pd

    from rockwobble.models import Case, Trace

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
    record_points=((0.2, 24.0, 2.0),),  # a larger cylinder may have longer steps
    record_step=2e-3,
    slip_points=((0.2, 0.5, 0.25),),
    slip_shares=(0.9, 1.05),
    trace_points=((0.2, 6.0, 2.0),),
    trace_length=2.5,
    rings=(Ring(),),
    ring_length=2.2,
    time_constants=(2e-3,),
    dampings=(1.0,),
)


@cache
def tiny_tables(base: Path) -> dict[str, pd.DataFrame]:
    """Tables of all parts; `base` is pytest's temporary folder of this process."""
    with kept_engine_runs(base):
        return measure_all(TINY, base / "tiny-validity", workers=1)


@contextmanager
def kept_engine_runs(base: Path) -> Iterator[None]:
    """Keep every engine run beside the folders of all processes, and make none twice: they take most time."""
    make = multibody.simulate
    shared = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "engine-runs"
    shared.mkdir(exist_ok=True)

    def once(case: Case, **options: Any) -> Trace:
        kept = shared / fingerprint([case, options])
        if not kept.exists():
            part = kept.with_suffix(f".{os.getpid()}")  # another process finds it whole or not at all
            part.write_bytes(pickle.dumps(make(case, **options)))
            part.replace(kept)
        trace: Trace = pickle.loads(kept.read_bytes())
        return trace

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(multibody, "simulate", once)
        yield


@cache
def tiny_validity(base: Path) -> Validity:
    """The study of these tables."""
    return validity_of(tiny_tables(base), TINY)
