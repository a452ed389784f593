"""Tasks for other processes, where a test file cannot be imported by name."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd


def multiples(task: int) -> pd.DataFrame:
    # imported here: at module level each process of a test would import them at its start
    import numpy as np
    import pandas as pd

    return pd.DataFrame({"multiple": np.arange(1000.0) * task})


def refuse(task: int) -> None:
    raise ValueError(f"must be at least 1, got {task}")


def signalled(number: int) -> None:
    if number:
        os.kill(os.getpid(), number)


def die_once(mark: str) -> str:
    if not Path(mark).exists():
        Path(mark).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return mark


def process_of(task: object) -> int:
    return os.getpid()


def killed(task: int) -> pd.DataFrame:
    os.kill(os.getpid(), signal.SIGKILL)
    return multiples(task)


def never_the_same() -> dict[str, str]:
    return {"call": str(time.monotonic_ns())}
