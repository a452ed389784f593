"""Rolling contact in successive releases of an engine, each in its own process; see script.py.

Every version is installed by pip into a folder of its own, without its dependencies, and found there first.
The figures are angle of turn, the static uplift sweep of the contract, a release, and El Centro. Rows of
engines that are not named stay.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from rockwobble.compare import Results
from rockwobble.reports.pages.page import Page
from rockwobble.reports.published.script import run

HERE = Path(__file__).resolve().parent
TITLES = {"mujoco": "MuJoCo", "dart": "DART", "drake": "Drake", "rapier": "Rapier (single precision)"}
PACKAGES = {"mujoco": "mujoco", "dart": "dartpy", "drake": "drake", "rapier": "rapier3d"}
# the oldest minor release that is asked for, and how many to go on by: a wheel of Drake has 170 MB
SINCE = {"mujoco": ((3, 3), 1), "dart": ((6, 0), 1), "drake": ((1, 12), 10), "rapier": ((0, 36), 1)}
# packages of the same version that the wheel leans on
_COMPANIONS: Mapping[str, Mapping[int, tuple[str, ...]]] = {"mujoco": {4: ("mujoco-core",)}}
_LONGEST = 1800.0  # [s] for one version
COLUMNS = ("engine", "version", "turn", "uplift", "release", "el_centro", "seconds", "remark")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class EngineVersions(Results, kind="engine versions"):
    """Rolling contact in the releases of engines: the table `versions`, a row for each release."""

    def headline(self) -> dict[str, int]:
        """Number of releases of each engine."""
        counts = self.versions["engine"].value_counts()
        return {f"releases of {name}": int(count) for name, count in counts.items()}

    def sheets(self) -> dict[str, bytes]:
        """Table as CSV."""
        return {"versions.csv": self.versions.to_csv(index=False).encode()}


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("--engine", action="append", choices=tuple(SINCE), help="default: all of them")
    parser.add_argument("--version", action="append", help="of the one --engine; default: each minor release")
    parser.add_argument("--no-sweep", action="store_true", help="leave out the uplift sweep, a minute each")
    parser.add_argument("--keep", type=Path, help="folder that keeps what is installed; default: none does")


def measure(given: argparse.Namespace) -> EngineVersions:
    """Figures of each minor release, with stored rows of other engines."""
    with tempfile.TemporaryDirectory() as place:
        folder = given.keep or Path(place)
        rows = [
            _row(engine, version, folder, sweep=not given.no_sweep)
            for engine in given.engine or SINCE
            for version in given.version or minor_releases(listed(engine), *SINCE[engine])
        ]
    return with_earlier(table_of(rows), HERE)


def with_earlier(table: pd.DataFrame, folder: Path) -> EngineVersions:
    """Table with the stored rows of other engines, which have their dates."""
    earlier: dict[str, dict[str, str]] = {}
    before = EngineVersions.load(folder) if (folder / "manifest.json").exists() else None
    if before is not None and before.manifest is not None:
        kept = before.versions[~before.versions["engine"].isin(table["engine"])]
        origin = {"date": before.manifest.date, "commit": before.manifest.commit}
        known = before.facts.get("earlier", {})
        earlier = {str(name): known.get(name, origin) for name in kept["engine"].unique()}
        table = pd.concat([kept, table], ignore_index=True)
    return EngineVersions(tables={"versions": table}, facts={"earlier": earlier})


def listed(engine: str) -> list[str]:
    """Versions of an engine available to pip here, newest first."""
    package = PACKAGES[engine]
    command = [sys.executable, "-m", "pip", "index", "versions", package, "--only-binary", ":all:"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    (line,) = (line for line in shown.splitlines() if line.startswith("Available versions:"))
    return [version.strip() for version in line.partition(":")[2].split(",")]


def minor_releases(versions: Sequence[str], since: tuple[int, int], step: int = 1) -> list[str]:
    """Last patch of each minor release, oldest first; every `step`th counted from the newest.

    Examples
    --------
    >>> minor_releases(["4.0.0", "3.4.1", "3.4.0", "3.3.7", "3.2.0"], (3, 3))
    ['3.3.7', '3.4.1', '4.0.0']
    """
    newest: dict[tuple[int, int], str] = {}
    for version in sorted(versions, key=_parts):
        newest[_parts(version)[:2]] = version
    chosen = [version for minor, version in newest.items() if minor >= since]
    return chosen[::-1][::step][::-1]


def _parts(version: str) -> tuple[int, int, int]:
    numbers = [int(part) for part in version.split(".")[:3] if part.isdigit()]
    major, minor, patch = (*numbers, 0, 0, 0)[:3]
    return major, minor, patch


def _row(engine: str, version: str, folder: Path, *, sweep: bool) -> dict[str, Any]:
    print(f"{engine} {version} ...", file=sys.stderr, flush=True)
    row: dict[str, Any] = dict.fromkeys(COLUMNS, math.nan) | {"engine": engine, "version": version}
    row |= {"uplift": "" if sweep else "not run", "remark": ""}
    place = folder / f"{engine}-{version}"
    package = PACKAGES[engine]
    names = (package, *_COMPANIONS.get(engine, {}).get(_parts(version)[0], ()))
    if not place.exists():
        install = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--only-binary", ":all:"]
        wanted = [f"{name}=={version}" for name in names]
        made = subprocess.run(
            [*install, "--target", str(place), *wanted], capture_output=True, text=True, check=False
        )
        if made.returncode:
            return row | {"remark": "does not install here"}
    paths = [str(place), os.environ.get("PYTHONPATH", "")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}
    command = [sys.executable, str(HERE / "figures.py"), engine]
    command += [] if sweep else ["--no-sweep"]
    try:
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=_LONGEST, check=False
        )
    except subprocess.TimeoutExpired:
        return row | {"remark": f"not done within {_LONGEST:.0f} s"}
    if done.returncode:
        said = done.stderr.strip().splitlines() or ["crashes without a word"]
        return row | {"remark": said[-1]}
    answer = json.loads(done.stdout.splitlines()[-1])
    if answer.pop("version") != version:
        return row | {"remark": "another version was found in its place"}
    # one reason usually prevents all figures
    reasons = dict.fromkeys(remark.partition(": ")[2] for remark in answer.pop("remarks", []))
    row.update(remark="; ".join(reasons), **answer)
    return row


def table_of(rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Table of the rows."""
    numbers = dict.fromkeys(("turn", "release", "el_centro", "seconds"), float)
    return pd.DataFrame(rows, columns=list(COLUMNS)).astype({**numbers, "uplift": str, "remark": str})


def page_of(results: EngineVersions) -> Page:
    """Page of the table."""
    rows: list[dict[str, Any]] = [
        {**{str(name): value for name, value in row.items()}, "title": TITLES[row["engine"]]}
        for row in results.versions.to_dict("records")
    ]
    values = {
        "rows": rows,
        "about": results.manifest,
        "answer": _answer(_changes(results.versions)),
        "earlier": _earlier(results.facts.get("earlier", {})),
    }
    return Page(name="versions", template=Path(__file__).with_name("page.md.j2"), values=values)


def _answer(moved: Sequence[Mapping[str, Any]]) -> str:
    """Releases between which the error changed, or that none did."""
    if not moved:
        return "No release has moved the error under El Centro by more than a tenth."
    each = [f"{row['engine']} {row['since']} ({row['ratio']:.2g} times)" for row in moved]
    count = f"{len(moved)} releases have" if len(moved) > 1 else "1 release has"
    return f"{count} moved the error under El Centro by more than a tenth: {', '.join(each)}."


def _earlier(origins: Mapping[str, Mapping[str, str]]) -> str:
    """Versions of the earlier runs whose rows are kept; empty without such rows."""
    each = [
        f"{TITLES[name]} ({made['date']}, commit {made['commit'][:12]})" for name, made in origins.items()
    ]
    return f"Rows of earlier runs: {', '.join(each)}." if each else ""


def _changes(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Releases between which the El Centro error changed by more than a tenth."""
    entries: list[dict[str, Any]] = []
    for engine, own in table.groupby("engine", sort=False):
        known = own[own["el_centro"].notna()]
        pairs = zip(known.to_dict("records"), known.to_dict("records")[1:], strict=False)
        for before, after in pairs:
            ratio = after["el_centro"] / before["el_centro"]
            if not 0.9 < ratio < 1.1:
                entries.append({"engine": TITLES[str(engine)], "since": after["version"], "ratio": ratio})
    return entries


if __name__ == "__main__":
    sys.exit(run(__file__, EngineVersions, measure, page_of, options=options))
