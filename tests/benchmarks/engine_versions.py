"""How rolling contact moves between releases of an engine: versions side by side, each in its own process.

Every version is installed by pip into a folder of its own, without its dependencies, and found there first.
The figures are angle of turn, the static uplift sweep of the contract, a release, and El Centro.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from rockwobble.multibody.engines.registry import engine_packages
from rockwobble.reports.pages.versions import EngineVersions, page_of

from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

# the oldest minor release that is asked for, and how many to go on by: a wheel of Drake has 170 MB
SINCE: Mapping[str, tuple[tuple[int, int], int]] = MappingProxyType(
    {"mujoco": ((3, 3), 1), "dart": ((6, 0), 1), "drake": ((1, 12), 10), "rapier": ((0, 36), 1)}
)
# packages of the same version that the wheel leans on
_COMPANIONS: Mapping[str, Mapping[int, tuple[str, ...]]] = MappingProxyType({"mujoco": {4: ("mujoco-core",)}})
_LONGEST = 1800.0  # [s] for one version
COLUMNS = ("engine", "version", "turn", "uplift", "release", "el_centro", "seconds", "remark")


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure each minor release, print the table and write it to a folder."""
    parser = options_of("engine_versions", "Figures of each minor release of the engines.")
    parser.add_argument("--engine", action="append", choices=tuple(SINCE), help="default: all of them")
    parser.add_argument("--version", action="append", help="of the one --engine; default: each minor release")
    parser.add_argument("--no-sweep", action="store_true", help="leave out the uplift sweep, a minute each")
    parser.add_argument(
        "--out", type=Path, help="folder for table, page and manifest; rows of other engines stay"
    )
    parser.add_argument("--keep", type=Path, help="folder that keeps what is installed; default: none does")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as place:
        folder = given.keep or Path(place)
        rows = [
            _row(engine, version, folder, sweep=not given.no_sweep)
            for engine in given.engine or SINCE
            for version in given.version or minor_releases(listed(engine), *SINCE[engine])
        ]
    table = made_table(rows)
    formats = {
        "turn": ".2e",
        "uplift": "",
        "release": ".2e",
        "el_centro": ".2e",
        "seconds": ".0f",
        "remark": "",
    }
    show(table, "Releases of the engines", {"engine": "", "version": "", **formats})
    if given.out is not None:
        _write(table, given.out)
    return 0


def listed(engine: str) -> list[str]:
    """Return the versions of an engine that pip can install here, the newest first."""
    package = engine_packages()[engine]
    command = [sys.executable, "-m", "pip", "index", "versions", package, "--only-binary", ":all:"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    (line,) = (line for line in shown.splitlines() if line.startswith("Available versions:"))
    return [version.strip() for version in line.partition(":")[2].split(",")]


def minor_releases(versions: Sequence[str], since: tuple[int, int], step: int = 1) -> list[str]:
    """Return the last patch of each minor release, the oldest first; every `step`th back from the newest.

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
    package = engine_packages()[engine]
    names = (package, *_COMPANIONS.get(engine, {}).get(_parts(version)[0], ()))
    if not place.exists():
        install = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--only-binary", ":all:"]
        wanted = [f"{name}=={version}" for name in names]
        made = subprocess.run(
            [*install, "--target", str(place), *wanted], capture_output=True, text=True, check=False
        )
        if made.returncode:
            return row | {"remark": "does not install here"}
    paths = [str(place), str(Path(__file__).resolve().parents[1]), os.environ.get("PYTHONPATH", "")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}
    command = [sys.executable, "-m", "benchmarks.version_figures", engine]
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
    found = json.loads(done.stdout.splitlines()[-1])
    if found.pop("version") != version:
        return row | {"remark": "another version was found in its place"}
    # most of the time one reason keeps all figures from running
    reasons = dict.fromkeys(remark.partition(": ")[2] for remark in found.pop("remarks", []))
    row.update(remark="; ".join(reasons), **found)
    return row


def made_table(rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return the table of the rows."""
    import pandas as pd

    numbers = dict.fromkeys(("turn", "release", "el_centro", "seconds"), float)
    return pd.DataFrame(rows, columns=list(COLUMNS)).astype({**numbers, "uplift": str, "remark": str})


def _write(table: pd.DataFrame, out: Path) -> None:
    import pandas as pd

    earlier: dict[str, dict[str, str]] = {}
    before = EngineVersions.load(out) if (out / "manifest.json").exists() else None
    if before is not None and before.manifest is not None:
        kept = before.versions[~before.versions["engine"].isin(table["engine"])]
        origin = {"date": before.manifest.date, "commit": before.manifest.commit}
        known = before.facts.get("earlier", {})
        earlier = {str(name): known.get(name, origin) for name in kept["engine"].unique()}
        table = pd.concat([kept, table], ignore_index=True)
    command = "python tests/benchmarks engine_versions --out " + str(out)
    found = EngineVersions(tables={"versions": table}, facts={"earlier": earlier}).made_by(command)
    pages = page_of(found).files()
    found.save(out, pages=pages)
    print(f"Written to {out}: manifest.json, versions.csv, versions.parquet, {', '.join(pages)}")
