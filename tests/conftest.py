from __future__ import annotations

import gc
import os
from pathlib import Path

import pytest

import rockwobble.reports

# what is published is part of the package in a checkout alone: the tests find it under an installation, too
rockwobble.reports.__path__.append(str(Path(__file__).parents[1] / "reports"))


def pytest_configure() -> None:
    """Give every run of the tests the same terminal, whatever the shell or the CI service sets."""
    # the command line reads these once, when it is imported
    for name in ("FORCE_COLOR", "PY_COLORS", "CLICOLOR_FORCE", "GITHUB_ACTIONS"):
        os.environ.pop(name, None)
    os.environ["COLUMNS"] = "100"


def pytest_ignore_collect(collection_path: Path) -> bool | None:
    """Leave out files marked `checkout` where what they read is not, as in the source distribution."""
    if collection_path.suffix != ".py" or (Path(__file__).parents[1] / "reports" / "published").exists():
        return None
    return "pytest.mark.checkout" in collection_path.read_text(encoding="utf-8") or None


def pytest_sessionstart(session: pytest.Session) -> None:
    """Share the models out to the workers to compile, so that on a fresh installation no two do the same."""
    from rockwobble.reduced.simulation import make_ready

    for model in models_of_worker(session):
        make_ready(model)


def pytest_collection_finish(session: pytest.Session) -> None:
    """Compile what tests of tendons need, and leave out of the garbage collector what stays until the end."""
    if any(hasattr(getattr(item, "module", None), "Tendon") for item in session.items):
        from rockwobble import reduced
        from rockwobble.models import Case, Cylinder, InitialState, Tendon

        body = Cylinder(semidiagonal=1.0, tan_alpha=0.2)
        initial, tendon = InitialState(0.5 * body.alpha), Tendon(prestress=0.1)
        for model in models_of_worker(session):
            resistance = 0.01 * body.base_radius if model.startswith("resisted") else 0.0
            case = Case(body, initial=initial, duration=0.01, tendon=tendon, rolling_resistance=resistance)
            if not model.endswith("flat"):  # on which a tendon is known to engines alone
                reduced.simulate(case, plane=0.0 if model.endswith("planar") else None)
    gc.freeze()


def models_of_worker(session: pytest.Session) -> list[str]:
    """Return the models that are this worker's to compile; none where there is one process."""
    given = getattr(session.config, "workerinput", None)
    if given is None:
        return []
    from rockwobble.reduced.kernels import INTEGRATORS

    worker, count = int(given["workerid"].removeprefix("gw")), given["workercount"]
    # to and fro: what comes first takes longest
    turns = {model: place % (2 * count) for place, model in enumerate(INTEGRATORS)}
    return [model for model, turn in turns.items() if worker == min(turn, 2 * count - 1 - turn)]
