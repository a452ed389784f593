"""`rockwobble simulate` where its output cannot be printed, each time into a folder of the present one.

Started without standard files, as under some schedulers, this runs it, and then forks for each other output:
a child has loaded what a run needs, and ends as any command does. Writes the exit codes to codes.json.
"""

from __future__ import annotations

import json
import os
import runpy
import sys
from pathlib import Path
from typing import Any

from rockwobble.compare.runs import execution
from rockwobble.compare.runs.scheduler import run_tasks
from rockwobble.models import Case, Cylinder, InitialState, Run


def simulate(name: str) -> None:
    """Run `python -m rockwobble`, which ends this process."""
    sys.argv[1:] = ["simulate", "--release-tilt-deg", "5", "--duration", "1", "--out", name]
    runpy.run_module("rockwobble", run_name="__main__")


def here(*given: Any, **options: Any) -> list[Any]:
    return run_tasks(*given, **options | {"workers": 1})


def in_a_child(name: str, output: int, encoding: str) -> int:
    """Return the exit code of a child that prints to a descriptor, in an encoding."""
    if child := os.fork():
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    os.dup2(output, 1)
    os.dup2(os.open(f"{name}.err", os.O_WRONLY | os.O_CREAT), 2)
    # as Python opens them when it starts
    sys.stdout = open(1, "w", encoding=encoding, closefd=False)  # noqa: SIM115
    sys.stderr = open(2, "w", encoding=encoding, closefd=False)  # noqa: SIM115
    simulate(name)
    raise AssertionError("a command ends its process")


if __name__ == "__main__":
    try:
        simulate("shut")
    except SystemExit as ended:
        codes = {"shut": ended.code}
    # what is left is to print, so the children run in their own process, where the model is loaded
    execution.run_tasks = here
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), initial=InitialState(0.1), duration=0.1)
    execution.simulate_run(case, Run(None, "recess"))
    codes["poor"] = in_a_child("poor", os.open("poor.out", os.O_WRONLY | os.O_CREAT), "ascii")
    codes["full"] = in_a_child("full", os.open("/dev/full", os.O_WRONLY), "utf-8")
    reader, writer = os.pipe()
    os.close(reader)
    codes["closed"] = in_a_child("closed", writer, "utf-8")
    Path("codes.json").write_text(json.dumps(codes))
