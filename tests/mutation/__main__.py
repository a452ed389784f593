"""The command `python tests/mutation`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent))  # in place of this folder, where the modules of the package lie open
CHECKOUT = FOLDER.parents[1]
_EXAMPLES = """examples:
  python tests/mutation listed                             each listed fault, until a check finds it
  python tests/mutation generated --count 60 --seed 1      a sample of all, by check and tests
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one of the commands, and return the exit code: 0 done, 1 a fault was missed, 2 bad input."""
    parser = argparse.ArgumentParser(
        prog="python tests/mutation",
        description="Put faults into the sources, and see what finds them.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND", dest="command")
    listed = commands.add_parser(
        "listed", help="the faults chosen by hand, each of which the check must find"
    )
    listed.add_argument("--only", default="", help="faults whose name holds this text")
    generated = commands.add_parser("generated", help="a sample of the faults generated from the sources")
    generated.add_argument("--count", type=int, default=60, help="how many (default: %(default)s)")
    generated.add_argument("--seed", type=int, default=1, help="of the sample (default: %(default)s)")
    generated.add_argument("--only", default="", help="files whose path holds this text")
    generated.add_argument("--table", type=Path, default=Path("faults.csv"), help="default: %(default)s")
    options = parser.parse_args(arguments)
    if options.command == "listed":
        from mutation import listed as faults

        return faults.run(only=options.only)
    from mutation import generated as sample

    try:
        return sample.run(
            CHECKOUT,
            options.table,
            count=options.count,
            seed=options.seed,
            only=options.only,
        )
    except ValueError as error:
        print(f"python tests/mutation: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
