"""The command `python tests/benchmark_files [CASE ...]`: write the cases of reports/published/benchmark."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]


def main() -> None:
    """Write the cases that are asked for, and print how well each reference is known."""
    from benchmark_files.definitions import definitions
    from benchmark_files.references import reference
    from benchmark_files.write import PUBLISHED, write

    parser = argparse.ArgumentParser(prog="python tests/benchmark_files", description=__doc__)
    parser.add_argument("case", nargs="*", help="default: all")
    parser.add_argument("--out", type=Path, default=PUBLISHED)
    given = parser.parse_args()
    known = {one.name: one for one in definitions()}
    if unknown := set(given.case) - set(known):
        parser.error(f"the cases are {', '.join(known)}, got {', '.join(sorted(unknown))}")
    for name, definition in known.items():
        if given.case and name not in given.case:
            continue
        found = reference(definition)
        write(definition, found, given.out / "cases" / name)
        worst = max((one["bound"] for one in found.quantities), default=0.0)
        print(f"{name}: {len(found.quantities)} quantities, largest bound {worst:.0e}; traces {found.bounds}")


if __name__ == "__main__":
    sys.path[0] = str(TESTS)
    sys.path.insert(1, str(TESTS / "reference"))
    main()
