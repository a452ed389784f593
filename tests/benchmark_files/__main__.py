"""The command `python tests/benchmark_files`: write reports/published/benchmark, or parts of it.

python tests/benchmark_files cases [CASE ...]       the references, and how well each is known
python tests/benchmark_files mistakes               which mistake of a code which case sees
python tests/benchmark_files results [ENGINE ...]   what check.py says of our models and engines, scoreboard
                                     [--only CASE]  these cases alone; the results of the others stay
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
ENGINES = ("rockwobble", "mujoco", "pybullet", "dart", "drake", "exudyn", "rapier")


def cases(names: list[str], only: list[str]) -> None:
    """Write the cases, and print the largest bounds."""
    from benchmark_files.definitions import definitions
    from benchmark_files.references import reference
    from benchmark_files.witnesses import with_witnesses
    from benchmark_files.write import PUBLISHED, write

    for definition in definitions():
        if (names or only) and definition.name not in names + only:
            continue
        computed = reference(definition)
        computed = computed._replace(quantities=with_witnesses(definition, computed.quantities))
        write(definition, computed, PUBLISHED / "cases" / definition.name)
        worst = max((one["bound"] for one in computed.quantities), default=0.0)
        number = len(computed.quantities)
        print(f"{definition.name}: {number} quantities, largest bound {worst:.0e}; traces {computed.bounds}")


def mistakes(names: list[str], only: list[str]) -> None:
    """Write the table of planted mistakes by case."""
    from benchmark_files.planted import table
    from benchmark_files.write import PUBLISHED

    head = """# Which mistake which case sees

The second formulation with one thing wrong, judged by `check.py`: verdict, and the largest error over the
bound of a pass. Nothing stands where a case has nothing of it.

"""
    (PUBLISHED / "mistakes.md").write_text(f"{head}{table()}\n")


def results(names: list[str], only: list[str]) -> None:
    """Write the results, and the scoreboard."""
    from benchmark_files.engines import DEFAULT, REDUCED, VARIANTS, results_of
    from benchmark_files.write import PUBLISHED

    for engine in names or ENGINES:
        for variant in (DEFAULT,) if engine == REDUCED else VARIANTS:
            results_of(engine, variant, PUBLISHED, only)
    subprocess.run([sys.executable, str(PUBLISHED / "scoreboard.py")], check=True)


def main() -> None:
    """Run the named parts."""
    parser = argparse.ArgumentParser(prog="python tests/benchmark_files", description=__doc__)
    parser.add_argument("part", choices=("cases", "mistakes", "results"))
    parser.add_argument("names", nargs="*", help="default: all")
    parser.add_argument("--only", action="append", default=[], metavar="CASE")
    given = parser.parse_args()
    {"cases": cases, "mistakes": mistakes, "results": results}[given.part](given.names, given.only)


if __name__ == "__main__":
    sys.path[0] = str(TESTS)
    sys.path.insert(1, str(TESTS / "reference"))
    main()
