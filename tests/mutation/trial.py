"""What the check and the tests say of one copy of the checkout, each in a process with limits of its own."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

NOTHING, CRASH, TIMEOUT, TESTS = "nothing", "crash", "timeout", "tests"
PROBE = Path("tests/mutation/probe.py")

# what a layer may take: this many times what it took in the unchanged copy, and the time to compile all
# kernels, because a fault may make any layer the first that needs them
_TIMES, _COMPILING = 3.0, 60.0
# of the processor's time: a machine may be busy with other things as well
_WALL = 8.0
_MEMORY = 8 * 2**30  # [bytes] many times what the check needs: a list without end is to end soon


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """How much processor time a trial may take.

    Parameters
    ----------
    layers : mapping
        By layer of the check [s].
    other : float
        For everything else [s].
    tests : mapping
        By folder of tests [s].
    """

    layers: Mapping[str, float] = field(default_factory=dict)
    other: float = 600.0
    tests: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What found a fault.

    Parameters
    ----------
    found_by : str
        A layer of the check, "tests", "crash", "timeout" or "nothing".
    detail : str
        The check or test that failed, the last line before a crash, or where the time ran out.
    seconds : float
        It took, on the clock.
    by_layer : mapping
        Processor time of the layers that passed [s].
    """

    found_by: str
    detail: str
    seconds: float
    by_layer: Mapping[str, float] = field(default_factory=dict)


def limits_from(check: Verdict, tests: Mapping[str, float]) -> Limits:
    """Return the limits for copies with a fault, from what the unchanged copy took."""
    return Limits(
        layers={layer: _TIMES * seconds + _COMPILING for layer, seconds in check.by_layer.items()},
        other=_COMPILING,
        tests={folder: _TIMES * seconds + _COMPILING for folder, seconds in tests.items()},
    )


def ask_check(root: Path, layers: Sequence[str], limits: Limits, *, keep_compiled: bool = False) -> Verdict:
    """Ask all layers of the check, those in `layers` first, to the first failure.

    Parameters
    ----------
    root : Path
        Of the copy.
    layers : sequence of str
    limits : Limits
    keep_compiled : bool, optional
        Leave Python's own compiled files in the copy: for one without a fault.
    """
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.jsonl"
        wanted = {
            "layers": list(layers),
            "allowances": dict(limits.layers),
            "other": limits.other,
            "root": str(root),
            "report": str(report),
        }
        command = [sys.executable, "-P", str(root / PROBE), json.dumps(wanted)]
        most = sum(limits.layers.values()) + 2.0 * limits.other
        code, output, seconds = _run(command, root, most, keep_compiled=keep_compiled)
        lines = report.read_text(encoding="utf-8").splitlines() if report.exists() else []
    events = [json.loads(line) for line in lines]
    by_layer = {each["layer"]: float(each["seconds"]) for each in events if each["event"] == "passed"}
    last = events[-1] if events else {"event": "started", "layer": "start"}
    if last["event"] == "failed":
        found, detail = str(last["layer"]), str(last["check"])
        if last["note"]:
            detail += f" ({last['note']})"
    elif last["event"] == "finished" and code == 0:
        found, detail = NOTHING, ""
    else:
        found, detail = _ending(code, output)
        detail = f"{detail} in {last.get('layer', 'the end')}"
    return Verdict(found_by=found, detail=detail, seconds=seconds, by_layer=by_layer)


def ask_tests(root: Path, folder: str, limits: Limits, *, module: str = "") -> Verdict:
    """Ask the tests of one folder, those that name a module first, to the first failure."""
    files = sorted((root / "tests" / folder).glob("test_*.py"))
    files.sort(key=lambda path: module not in path.read_text(encoding="utf-8"))
    chosen = [str(path.relative_to(root)) for path in files]
    command = [sys.executable, "-P", "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *chosen]
    code, output, seconds = _run(command, root, limits.tests.get(folder, 3600.0))
    if code == 0:
        return Verdict(found_by=NOTHING, detail="", seconds=seconds)
    if code == 1:
        failed = [line for line in output.splitlines() if line.startswith(("FAILED", "ERROR"))]
        detail = failed[-1].split(" - ")[0].split(" ", 1)[1] if failed else "a test"
        return Verdict(found_by=TESTS, detail=detail, seconds=seconds)
    found, detail = _ending(code, output)
    return Verdict(found_by=found, detail=f"{detail} in tests/{folder}", seconds=seconds)


def _run(
    command: Sequence[str], root: Path, most: float, *, keep_compiled: bool = False
) -> tuple[int | None, str, float]:
    """Return the exit code (None: out of time), the output, and the time on the clock [s]."""
    environment = os.environ | {"PYTHONPATH": str(root / ".editable")}
    environment |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    environment["PYTHONDONTWRITEBYTECODE"] = "" if keep_compiled else "1"
    begun = time.monotonic()
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(
            command,
            cwd=root,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # what it starts itself ends with it
        )
        _limit(process.pid, most)
        code: int | None
        try:
            code = process.wait(timeout=_WALL * most)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            _end(process)
        output.seek(0)
        text = output.read().decode(errors="replace")
    if code is not None and code == -signal.SIGXCPU:
        code = None
    return code, text, time.monotonic() - begun


def _limit(pid: int, seconds: float) -> None:
    if not hasattr(resource, "prlimit"):  # Linux alone has it; elsewhere the clock limits
        return
    try:
        resource.prlimit(pid, resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 10))
        resource.prlimit(pid, resource.RLIMIT_AS, (_MEMORY, _MEMORY))
        resource.prlimit(pid, resource.RLIMIT_CORE, (0, 0))
    except ProcessLookupError:
        return  # it has ended before


def _end(process: subprocess.Popen[bytes]) -> None:
    with suppress(ProcessLookupError):  # it has ended, and nothing is left of it
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _ending(code: int | None, output: str) -> tuple[str, str]:
    if code is None:
        return TIMEOUT, "out of time"
    if code < 0:
        return CRASH, signal.Signals(-code).name
    lines = [line for line in output.splitlines() if line.strip()]
    return CRASH, " ".join(lines[-1].split())[:200] if lines else f"exit code {code}"
