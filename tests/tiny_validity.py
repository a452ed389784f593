"""The limits measured on a tiny grid, once for all tests that ask for it, in whatever process they run."""

from __future__ import annotations

import dataclasses
import os
import pickle
import time
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

_PATIENCE = 300.0  # for the process that measures [s]

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
    """Return the tables of all parts; of several processes of a session the first to ask measures for all.

    `base` is pytest's temporary folder of this process, beside those of the others.
    """
    folder = _shared(base)
    ended = folder / "ended"
    try:
        folder.mkdir()
    except FileExistsError:
        deadline = time.monotonic() + _PATIENCE
        while not ended.exists():
            assert time.monotonic() < deadline, f"whoever measures in {folder} does not come to an end"
            time.sleep(0.2)
    try:
        with kept_engine_runs(base):
            return measure_all(TINY, folder, workers=1)  # and nothing of what is kept there
    finally:
        ended.touch()


def _shared(base: Path) -> Path:
    return (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "tiny-validity"


@contextmanager
def kept_engine_runs(base: Path) -> Iterator[None]:
    """Keep every engine run of the measurement beside it, and make none twice: they take most of its time."""
    make = multibody.simulate

    def once(case: Case, **options: Any) -> Trace:
        kept = _shared(base) / fingerprint([case, options])
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
    """Return the study."""
    return validity_of(tiny_tables(base), TINY)
