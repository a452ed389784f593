"""The process that compiles a model gives the same bits as those that load its machine code.

Of planar motion with rolling resistance, where that was not so: compiling takes half a minute a model."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

_RUNS = """
import hashlib
import rockwobble as rw
from rockwobble import reduced

pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
found = hashlib.sha256()
for scale in (1.2, 1.5, 2.5):
    for share in (0.003, 0.02):
        motion = rw.el_centro_1940().scaled(scale)
        case = rw.Case(pier, motion, duration=20.0, rolling_resistance=share * pier.base_radius)
        trace = reduced.simulate(case, plane=0.3)
        found.update(trace.tilt.tobytes())
        found.update(repr((trace.outcome, trace.peak_tilt)).encode())
print(found.hexdigest())
"""


def bits(folder: Path) -> str:
    """Return the digest of the runs of a process whose machine code is kept in a folder."""
    done = subprocess.run(
        [sys.executable, "-c", _RUNS],
        env={**os.environ, "NUMBA_CACHE_DIR": str(folder)},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def test_the_first_process_gives_the_bits_of_the_next(tmp_path: Path) -> None:
    first = bits(tmp_path)
    assert list(tmp_path.rglob("*.nbc"))
    assert bits(tmp_path) == first
