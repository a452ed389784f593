"""The command `python tests/benchmarks NAME`: one of the scripts beside this file."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
SCRIPTS = (
    "certified_releases",
    "decks",
    "engine_settings",
    "fragility_coverage",
    "frames",
    "loss_effects",
    "measured_rods",
    "needs_coverage",
    "risk_coverage",
    "tendons",
    "who_can_rock",
    "who_can_slide",
    "witnesses",
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the script that is asked for; return its exit code."""
    parser = argparse.ArgumentParser(
        prog="python tests/benchmarks",
        description="Measure cost and error. tests/benchmarks/README.md says what each script prints.",
    )
    parser.add_argument("name", choices=SCRIPTS)
    parser.add_argument("options", nargs=argparse.REMAINDER, help="of that script: --help tells them")
    given = parser.parse_args(arguments)
    script = importlib.import_module(f"benchmarks.{given.name}")
    return int(script.main(given.options))


if __name__ == "__main__":
    # package folder ahead of its modules, for the processes of a script, too
    sys.path[0] = str(TESTS)
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(TESTS), os.environ.get("PYTHONPATH")]))
    sys.exit(main())
