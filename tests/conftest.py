from __future__ import annotations

import gc
import os

import pytest


def pytest_configure() -> None:
    """Give every run of the tests the same terminal, whatever the shell or the CI service sets."""
    # the command line reads these once, when it is imported
    for name in ("FORCE_COLOR", "PY_COLORS", "CLICOLOR_FORCE", "GITHUB_ACTIONS"):
        os.environ.pop(name, None)
    os.environ["COLUMNS"] = "100"


def pytest_sessionstart(session: pytest.Session) -> None:
    """Share the models out to the workers to compile, so that on a fresh installation no two do the same."""
    given = getattr(session.config, "workerinput", None)
    if given is None:
        return
    from rockwobble.reduced.kernels import INTEGRATORS
    from rockwobble.reduced.simulation import make_ready

    worker, count = int(given["workerid"].removeprefix("gw")), given["workercount"]
    for place, model in enumerate(INTEGRATORS):  # to and fro: what comes first takes longest
        turn = place % (2 * count)
        if worker == min(turn, 2 * count - 1 - turn):
            make_ready(model)


def pytest_collection_finish() -> None:
    """Leave out of the garbage collector's rounds what stays until the end: libraries and tests."""
    gc.freeze()
