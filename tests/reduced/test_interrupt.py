"""Ctrl-C while compiled code runs is a KeyboardInterrupt after it, and no end of the process."""

from __future__ import annotations

import math
import os
import signal
import threading
from dataclasses import replace

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
RELEASE = InitialState(math.radians(5.0), rolling_rate=0.5)
SHAKEN = GroundMotion(np.random.default_rng(1).normal(0.0, 2.0, (400_000, 2)), 0.01)
CASES = {
    "recess": Case(PIER, initial=RELEASE, duration=30_000.0),
    "flat": Case(PIER, initial=RELEASE, duration=30_000.0),
    "slides": Case(PIER, SHAKEN, friction=0.1),
}


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals of threads are POSIX")
@pytest.mark.parametrize("kind", CASES)
def test_an_interrupt_within_compiled_code_is_raised_after_it(kind: str) -> None:
    case = CASES[kind]
    support = "recess" if kind == "recess" else "flat"
    short = replace(
        case, motion=case.motion and replace(case.motion, acceleration=case.motion.acceleration[:99])
    )
    reduced.simulate(replace(short, duration=1.0), support=support)  # compiles
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
    try:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            reduced.simulate(case, support=support)
    finally:
        timer.cancel()
        signal.signal(signal.SIGINT, before)
