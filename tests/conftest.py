from __future__ import annotations

import os


def pytest_configure() -> None:
    """Give every run of the tests the same terminal, whatever the shell or the CI service sets."""
    # the command line reads these once, when it is imported
    for name in ("FORCE_COLOR", "PY_COLORS", "CLICOLOR_FORCE", "GITHUB_ACTIONS"):
        os.environ.pop(name, None)
    os.environ["COLUMNS"] = "100"
