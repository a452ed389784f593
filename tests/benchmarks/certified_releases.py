"""Distance of an installation from a certificate by case: the rows of certificates/releases.csv.

`rockwobble verify` answers with one word and stops at the first change. This runs all cases and says by how
much each differs, before and after the time when agreement must end. Another release of an engine is found
first where PYTHONPATH names its folder:

    pip install --no-deps --target /tmp/3.17.0 mujoco==3.17.0
    PYTHONPATH=/tmp/3.17.0 python tests/benchmarks certified_releases CERTIFICATE --add releases.csv
"""

from __future__ import annotations

import math
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rockwobble.compare.check.baseline import subject_of
from rockwobble.compare.check.fingerprint import repeat
from rockwobble.compare.check.verdict import Entry, Sample, compare_entries, read_certificate
from rockwobble.compare.storage.provenance import package_versions
from rockwobble.multibody.engines.registry import engine_packages, find_engine

from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = {
    "engine": "",
    "certified": "",
    "verified": "",
    "python": "",
    "numpy": "",
    "case": "",
    "word": "",
    "agreement_time": ".3g",
    "before": ".1e",
    "of_allowed": ".1e",
    "after": ".1e",
    "tilt_after": ".1e",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the rows; add them to a file."""
    parser = options_of("certified_releases", "An installation against a certificate, case by case.")
    parser.add_argument("certificate", type=Path)
    parser.add_argument("--add", type=Path, help="file of rows; those of this installation are made anew")
    given = parser.parse_args(arguments)
    table = rows(given.certificate)
    if given.add is not None:
        _add(table, given.add)
    show(table, f"Against {given.certificate}", COLUMNS)
    return 0


def rows(path: Path) -> pd.DataFrame:
    """One row for each case: verdict, and the largest differences of its samples.

    `before` is the largest of all signals (over alpha, g R, weights) before the agreement time, `of_allowed`
    the largest share of what is allowed there; `after` and `tilt_after` are those of all and of the tilt from
    then on.
    """
    import pandas as pd

    certificate = read_certificate(path)
    subject, old = subject_of(certificate), certificate["fingerprint"]
    engine = None if subject.run is None else subject.run.engine
    about = {
        "engine": engine or "reduced",
        "certified": certificate["versions"][engine_packages()[engine] if engine else "rockwobble"],
        "verified": find_engine(engine).version() if engine else package_versions()["rockwobble"],
        "python": platform.python_version(),
        "numpy": np.__version__,
    }
    differences = [
        about | _differences(one, other) | {"case": one["name"], "word": compare_entries(one, other).word}
        for one, other in zip(old, repeat(subject, old), strict=True)
    ]
    return pd.DataFrame(differences, columns=list(COLUMNS))


def _differences(one: Entry, other: Sample) -> dict[str, float]:
    end = math.inf if one["agreement_time"] is None else one["agreement_time"]
    before = of_allowed = after = tilt_after = 0.0
    for name, values in one["signals"].items():  # the tilt comes first
        count = min(len(values), len(other["signals"][name]))
        wanted, got = (np.array(v[:count], dtype=float) for v in (values, other["signals"][name]))
        apart, early = np.abs(wanted - got), np.array(one["time"][:count]) < end
        share = apart / np.array(one["allowed"][name][:count])
        before = max(before, np.nanmax(apart[early], initial=0.0))
        of_allowed = max(of_allowed, np.nanmax(share[early], initial=0.0))
        after = max(after, np.nanmax(apart[~early], initial=0.0))
        if name == "tilt":
            tilt_after = after
    rounded = {"before": before, "of_allowed": of_allowed, "after": after, "tilt_after": tilt_after}
    return {"agreement_time": end} | {name: float(f"{value:.2g}") for name, value in rounded.items()}


def _add(table: pd.DataFrame, path: Path) -> None:
    import pandas as pd

    if path.exists():
        known = pd.read_csv(path, dtype={"certified": str, "verified": str, "python": str, "numpy": str})
        keys = ["engine", "verified", "python", "numpy"]
        same = (known[keys] == table[keys].iloc[0]).all(axis=1)
        table = pd.concat([known[~same], table])
    table.to_csv(path, index=False)
