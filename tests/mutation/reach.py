"""Functions of the packages that each test calls, recorded by one run of the tests.

`python -m pytest -p mutation.reach` writes the table, of JSON, to the file that the environment names in
`REACH`; of several processes it joins what each wrote. Tests that fail are left out and named: they find
nothing. Compiled functions are not seen: what is compiled is called by no test.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import pytest

PACKAGES = ("models", "reduced", "multibody", "compare", "studies")


@dataclass(frozen=True, slots=True, kw_only=True)
class Reach:
    """One test.

    Parameters
    ----------
    test : str
        Its node in pytest.
    seconds : float
        Processor time.
    calls : frozenset of str
        Functions, as `reduced/body.py:12` by the first of their lines.
    """

    test: str
    seconds: float
    calls: frozenset[str]


def read(table: Path) -> list[Reach]:
    """Return what was recorded."""
    rows = json.loads(table.read_text(encoding="utf-8"))
    return [Reach(test=test, seconds=seconds, calls=frozenset(calls)) for test, seconds, calls in rows]


def near(tests: Sequence[Reach], file: str, function: int | None) -> list[Reach]:
    """Return the tests that may see a fault in a function (in a file, for None), fastest first.

    Where no test is seen to call it, those of the file, and of the package where there are none either.
    """
    package = file.split("/")[0]
    found = [each for each in tests if f"{file}:{function}" in each.calls]
    found = found or [each for each in tests if any(call.startswith(f"{file}:") for call in each.calls)]
    found = found or [each for each in tests if each.test.startswith(f"tests/{package}/")]
    return sorted(found, key=lambda each: (not each.test.startswith(f"tests/{package}/"), each.seconds))


class Recorder:
    """Notes the functions that run, apart for each test and for each fixture that several tests share."""

    def __init__(self, root: Path) -> None:
        self._folders = {f"{(root / name).resolve()}/": f"{name}/" for name in PACKAGES}
        self._folders |= {f"{root / 'src/rockwobble' / name}/": f"{name}/" for name in PACKAGES}
        self._running: dict[int, CodeType] = {}
        self._fixtures: dict[str, set[str]] = {}
        self._tests: dict[str, tuple[float, set[str], Sequence[str]]] = {}
        self._failed: dict[str, None] = {}

    @pytest.hookimpl(hookwrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Generator[None]:
        """Note what a shared fixture calls for each of its tests: it is set up in the first alone."""
        if fixturedef.scope == "function":
            yield
            return
        before, self._running = self._running, {}
        yield
        self._fixtures.setdefault(fixturedef.argname, set()).update(self._names())
        self._running = before

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Generator[None]:
        """Note what a test calls."""
        self._running = {}

        def note(frame: FrameType, event: str, argument: object) -> None:
            self._running[id(frame.f_code)] = frame.f_code

        started = time.process_time()
        threading.settrace(note)
        sys.settrace(note)
        yield
        sys.settrace(None)
        threading.settrace(None)
        self._tests[item.nodeid] = time.process_time() - started, self._names(), item.fixturenames

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note what fails."""
        if report.failed:
            self._failed[report.nodeid] = None

    def pytest_sessionfinish(self) -> None:
        """Write the table."""
        rows: list[Any] = [
            (
                test,
                round(seconds, 3),
                sorted(calls.union(*(self._fixtures.get(name, ()) for name in fixtures))),
            )
            for test, (seconds, calls, fixtures) in self._tests.items()
        ]
        table = Path(os.environ["REACH"])
        if worker := os.environ.get("PYTEST_XDIST_WORKER"):
            table = table.with_suffix(f".{worker}")
        else:
            for part in table.parent.glob(f"{table.stem}.gw*"):
                rows += json.loads(part.read_text(encoding="utf-8"))
                part.unlink()
        rows = [row for row in rows if row[0] not in self._failed]
        table.write_text(json.dumps(rows), encoding="utf-8")
        for test in self._failed:
            print(f"\nleft out, since it fails without a fault: {test}")

    def _names(self) -> set[str]:
        return {
            f"{short}{code.co_filename.removeprefix(folder)}:{code.co_firstlineno}"
            for code in list(self._running.values())  # which itself is a call
            for folder, short in self._folders.items()
            if code.co_filename.startswith(folder)
        }


def pytest_configure(config: pytest.Config) -> None:
    """Record."""
    config.pluginmanager.register(Recorder(config.rootpath))
