"""What a MuJoCo run costs over the bare steps of its scene in C.

`multibody.simulate`, with all that it follows at every step (guard, passes, uplift, energy, slip), against
`mj_step` on the same compiled scene from the same start, in turn, in processor time of this thread.
``python tests/benchmarks run_overhead`` prints the table.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import mujoco  # type: ignore[import-untyped]
import numpy as np

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, el_centro_1940
from rockwobble.multibody.simulation import open_scene

from .console import options_of

if TYPE_CHECKING:
    import pandas as pd

ROUNDS = 15
SECONDS = 20.0  # of the run
_STEP = 1e-4  # the default for this size [s]

_PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def run_overheads(
    *, rounds: int = ROUNDS, seconds: float = SECONDS, say: Callable[[str], None] | None = None
) -> pd.DataFrame:
    """Measure the overhead for each support, released, on still ground and under a tenth of El Centro.

    Parameters
    ----------
    rounds : int
        Times that each is measured; the ratio is taken inside each round, and its median over them.
    seconds : float
        Length of the run [s].
    say : callable, optional
        Told what happens, line by line.

    Returns
    -------
    DataFrame
        One row for each scene: support, ground, steps, bare and run (microseconds of a step), ratio.
    """
    import pandas as pd

    release = InitialState(0.5 * _PIER.alpha, rolling_rate=0.5)
    grounds: dict[str, GroundMotion | None] = {"still": None, "El Centro / 10": el_centro_1940().scaled(0.1)}
    cases = [
        (support, ground, Case(_PIER, motion, initial=release, duration=seconds, name=f"{support}, {ground}"))
        for support in ("recess", "flat")
        for ground, motion in grounds.items()
    ]
    steps = round(seconds / _STEP)
    times = np.empty((rounds, len(cases), 2))
    for number in range(rounds):
        if say is not None:
            say(f"round {number + 1} of {rounds}, {len(cases)} runs of {steps} steps")
        for place, (support, _, case) in enumerate(cases):
            times[number, place] = _bare(case, support, steps), _whole(case, support)
    ratio = np.median(times[:, :, 1] / times[:, :, 0], axis=0)
    bare, whole = 1e6 * np.median(times, axis=0).T / steps
    return pd.DataFrame(
        {
            "support": [support for support, _, _ in cases],
            "ground": [ground for _, ground, _ in cases],
            "steps": steps,
            "bare": bare,
            "run": whole,
            "ratio": ratio,
        }
    )


def _bare(case: Case, support: str, steps: int) -> float:
    with open_scene(case, "mujoco", support, {}) as stepper:
        inside: Any = stepper
        begin = time.thread_time()
        mujoco.mj_step(inside._model, inside._data, nstep=steps)  # and nothing else
        return time.thread_time() - begin


def _whole(case: Case, support: str) -> float:
    begin = time.thread_time()
    multibody.simulate(
        Case(case.cylinder, case.motion, initial=case.initial, duration=case.duration),
        support=support,
        time_step=_STEP,
    )
    return time.thread_time() - begin


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    import sys

    parser = options_of(
        "run_overhead",
        "Cost of a MuJoCo run over the bare steps of its scene in C. Example: --rounds 5",
    )
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="times each run is measured (%(default)s)")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="length of a run [s] (%(default)s)")
    given = parser.parse_args(arguments)
    table = run_overheads(
        rounds=given.rounds, seconds=given.seconds, say=lambda line: print(line, file=sys.stderr)
    )
    print(f"{'support':8} {'ground':15} {'steps':>8} {'bare [us]':>10} {'run [us]':>9} {'ratio':>6}")
    for row in table.to_dict("records"):
        print(
            f"{row['support']:8} {row['ground']:15} {row['steps']:8d} {row['bare']:10.2f} {row['run']:9.2f} "
            f"{row['ratio']:6.3f}"
        )
    return 0
