"""Engine results: each possible case, judged by check.py like any submission.

`results/NAME` holds one file a case and about.json: code, version, settings, time step, processor time of a
step, what it cannot do or was left out and why, until when the runs of each case could be extrapolated, and
the commit that ran it.
"""

from __future__ import annotations

import json
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Collection
from pathlib import Path
from typing import Any

from rockwobble import multibody
from rockwobble.compare.runs.choice import own_model_of
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.compare.storage.provenance import commit
from rockwobble.models import Case, Run, Trace
from rockwobble.multibody.scene import REFERENCE_SEMIDIAGONAL, REFERENCE_TIME_STEP, default_step

from .submission import cases_of, spacing, submit, tilt_and_azimuth

DEFAULT, BEST = VARIANTS = ("default", "extrapolated")
REDUCED = "rockwobble"
_SHARES = {DEFAULT: (1.0,), BEST: (1.0, 0.5, 0.25)}  # time steps over the default
_LONG = 60.0  # [s] of all runs of a case: those with a finer step stay below


def results_of(engine: str, variant: str, folder: Path, only: Collection[str] = ()) -> None:
    """Run the cases of a benchmark folder, shortest first, and write the judgements of check.py."""
    target = folder / "results" / f"{engine}-{variant}"
    target.mkdir(parents=True, exist_ok=True)
    costs: list[float] = []
    known = target / "about.json"
    old = json.loads(known.read_text()) if only and known.exists() else {}
    cannot: dict[str, str] = old.get("cannot", {})
    commits: dict[str, str] = old.get("commits", {})
    left_out: dict[str, str] = old.get("left_out", {})
    until: dict[str, float] = old.get("extrapolated_until", {})
    version, words = old.get("version", ""), variant.replace("-", " ")
    problems = {path: cases_of(path) for path in (folder / "cases").iterdir()}
    lengths = {path: sum(case.length for case, _ in cases.values()) for path, cases in problems.items()}
    for path in sorted(problems, key=lambda path: lengths[path]):
        if only and path.name not in only:
            continue
        if variant == BEST and lengths[path] > _LONG:
            left_out[path.name], problems[path] = f"its runs last over {_LONG:g} s", {}
        traces: dict[str, Trace] = {}
        for name, (case, support) in problems[path].items():
            start = time.process_time()  # processor time: other work on the machine does not count
            try:
                trace = traces[name] = _simulate(engine, case, support, variant)
            except ValueError as error:  # tasks an engine cannot do
                cannot[path.name] = str(error)
                continue
            if engine != REDUCED:
                steps = sum(1.0 / share for share in _SHARES[variant]) * trace.time[-1] / _default_step(case)
                costs.append((time.process_time() - start) / steps)
        if traces:
            commits[path.name] = commit()
            if variant == BEST:
                until[path.name] = min(_extrapolated_until(trace) for trace in traces.values())
            version = next(iter(traces.values())).version
            label = f"{engine} {version}, {words}"
            with tempfile.TemporaryDirectory() as scratch:
                tables = {name: tilt_and_azimuth(trace) for name, trace in traces.items()}
                file = submit(tables, Path(scratch) / "trajectory.csv")
                command = [sys.executable, str(folder / "check.py"), path.name, str(file)]
                command += ["--label", label, "--out", str(target / f"{path.name}.json")]
                subprocess.run(command, check=False)
        about = {
            "code": engine,
            "version": version,
            "settings": words,
            "time_step": _step_in_words(variant) if engine != REDUCED else "of its tolerance, 1e-8 relative",
            # mean over all cases, as one is not representative
            "seconds_a_step": old.get("seconds_a_step") or (statistics.median(costs) if costs else None),
            "cannot": cannot,
            "left_out": left_out,
            "extrapolated_until": until,
            "machine": f"{platform.machine()}, {platform.system()}, Python {platform.python_version()}",
            "commits": commits,
        }
        known.write_text(json.dumps(about, indent=1) + "\n")  # also where the next case is interrupted


def _step_in_words(variant: str) -> str:
    default = f"{REFERENCE_TIME_STEP:g} s at R = {REFERENCE_SEMIDIAGONAL:g} m, as sqrt(R)"
    return default if variant == DEFAULT else f"{default}; a half and a quarter of it; extrapolated"


def _extrapolated_until(trace: Trace) -> float:
    """Time [s] from which a run is its finest of three, as no halving improved it."""
    return next((fact.duration for fact in trace.facts if fact.code == "extrapolated"), 0.0)


def _default_step(case: Case) -> float:
    return default_step(case.cylinder.semidiagonal, case.gravity)


def _simulate(engine: str, case: Case, support: str, variant: str) -> Trace:
    spaced = min(0.01, spacing(case))
    if engine == REDUCED:
        return simulate_run(case, own_model_of(case, Run("mujoco", support)), sample_step=spaced)
    given: dict[str, Any] = {"engine": engine, "support": support, "sample_step": spaced}
    if variant == BEST:
        given |= {"time_step": "extrapolated", "finest_step": 0.25 * _default_step(case)}
    return multibody.simulate(case, **given)
