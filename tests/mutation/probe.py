"""Run in a copy of the checkout with a fault: ask the groups of checks one by one, to the first failure.

Takes one argument, a JSON object: "layers" that are asked first, "allowances" of processor time by layer
[s], beyond which the process is ended by the system, "other", the allowance of the rest and of the import,
"root" of the copy, and "report", a file of one JSON object a line. Nothing in it comes from the package of
the faults: what is on trial is only what the copy holds.
"""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path
from typing import Any


def main(wanted: dict[str, Any]) -> None:
    """Ask, and write what was found."""
    with Path(wanted["report"]).open("a", encoding="utf-8", buffering=1) as report:
        _allow(wanted["other"])
        print(json.dumps({"event": "started", "layer": "import"}), file=report)
        from rockwobble.compare.check import GROUPS, check

        _require_copy(Path(wanted["root"]))
        order = [name for name in wanted["layers"] if name in GROUPS]
        for layer in order + [name for name in GROUPS if name not in order]:
            begun = _used()
            _allow(wanted["allowances"].get(layer, wanted["other"]))
            print(json.dumps({"event": "started", "layer": layer}), file=report)
            for result in check(only=[layer]).failures:
                told = {"event": "failed", "layer": layer, "check": result.name, "note": result.note}
                print(json.dumps(told), file=report)
                return
            print(json.dumps({"event": "passed", "layer": layer, "seconds": _used() - begun}), file=report)
        print(json.dumps({"event": "finished"}), file=report)


def _used() -> float:
    own, below = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + below.ru_utime + below.ru_stime


def _allow(seconds: float) -> None:
    own = resource.getrusage(resource.RUSAGE_SELF)
    _, most = resource.getrlimit(resource.RLIMIT_CPU)
    soft = int(own.ru_utime + own.ru_stime + seconds) + 1
    resource.setrlimit(
        resource.RLIMIT_CPU, (soft if most == resource.RLIM_INFINITY else min(soft, most), most)
    )


def _require_copy(root: Path) -> None:
    """Refuse to try another package than that of the copy, such as one that is installed."""
    for name, module in sorted(sys.modules.items()):
        file = getattr(module, "__file__", None)
        if (
            name.startswith("rockwobble.")
            and file
            and not Path(file).resolve().is_relative_to(root.resolve())
        ):
            raise RuntimeError(f"{name} must come from the copy {root}, got {file}")


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
