"""How a result was made."""

from __future__ import annotations

import shlex
import sys


def command_line() -> str:
    """Return the command that runs, as it would be typed."""
    return shlex.join(["rockwobble", *sys.argv[1:]])
