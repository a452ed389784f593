"""Ctrl-C in compiled code raises KeyboardInterrupt after it, and does not kill the process."""

from __future__ import annotations

import math
import os
import signal
import threading

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = InitialState(math.radians(5.0), rolling_rate=0.5)
SHAKEN = np.random.default_rng(1).normal(0.0, 2.0, (400_000, 2))


def case_of(kind: str, seconds: float) -> Case:
    if kind != "slides":
        return Case(PIER, initial=RELEASE, duration=seconds)
    return Case(PIER, GroundMotion(SHAKEN[: round(100.0 * seconds)], 0.01), friction=0.1)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals of threads are POSIX")
@pytest.mark.parametrize("kind", ["recess", "flat", "slides"])
def test_an_interrupt_within_compiled_code_is_raised_after_it(kind: str) -> None:
    support = "recess" if kind == "recess" else "flat"
    reduced.simulate(case_of(kind, 1.0), support=support)  # compiles
    case = case_of(kind, 30_000.0)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
    try:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            reduced.simulate(case, support=support)
    finally:
        timer.cancel()
        signal.signal(signal.SIGINT, before)
