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
  python tests/mutation listed                                  each listed fault, until a check finds it
  python tests/mutation generated --count 150 --seed 1 --tests  a sample of all, and its page score.md
  python tests/mutation generated --survivors --tests           again, what was not found the last time
  python tests/mutation show reduced/integration/uplift.py:uplift_in:strictness:1
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one of the commands, and return the exit code: 0 done, 2 bad input.

    1 says that a listed fault was missed, or that something fails without a fault.
    """
    options = _parser().parse_args(arguments)
    from mutation.campaign import BrokenCheckoutError

    try:
        return int(options.run(options))
    except (ValueError, BrokenCheckoutError) as error:
        print(f"python tests/mutation: {error}", file=sys.stderr)
        return 2 if isinstance(error, ValueError) else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python tests/mutation",
        description="Put faults into the sources, and see what finds them.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    listed = commands.add_parser(
        "listed", help="the faults chosen by hand, each of which the check must find"
    )
    listed.add_argument("--only", default="", help="faults whose name holds this text")
    listed.set_defaults(run=_listed)
    generated = commands.add_parser("generated", help="a sample of the faults generated from the sources")
    generated.add_argument("--count", type=int, default=150, help="how many (default: %(default)s)")
    generated.add_argument("--seed", type=int, default=1, help="of the sample (default: %(default)s)")
    generated.add_argument("--only", default="", help="sample those whose name holds this text")
    generated.add_argument("--tests", action="store_true", help="put what the check misses to the tests")
    generated.add_argument(
        "--survivors", action="store_true", help="keep what was found in other sources: try the rest again"
    )
    generated.add_argument("--workers", type=int, help="faults side by side (default: the usable cores)")
    generated.add_argument("--list", action="store_true", help="print the sample, and try nothing")
    generated.add_argument("--table", type=Path, default=FOLDER / "score.csv", help="default: %(default)s")
    generated.set_defaults(run=_generated)
    show = commands.add_parser("show", help="the diff of one fault, or of all whose name begins so")
    show.add_argument("fault")
    show.set_defaults(run=_show)
    return parser


def _listed(options: argparse.Namespace) -> int:
    from mutation.listed import run

    return run(only=options.only)


def _generated(options: argparse.Namespace) -> int:
    from mutation.campaign import run, usable_cores
    from mutation.score import page, read_reasons, stale
    from mutation.sites import GeneratedFault
    from mutation.targets import all_faults, sample

    known: set[tuple[str, str]] = set()

    def choose(faults: dict[str, list[GeneratedFault]]) -> list[GeneratedFault]:
        known.update((each.name, each.change) for of in faults.values() for each in of)
        named = {file: [each for each in of if options.only in each.name] for file, of in faults.items()}
        return sample(named, options.count, options.seed)

    if options.list:
        for fault in choose(all_faults(CHECKOUT)):
            print(f"{fault.name}    {fault.change}")
        return 0
    if not options.table.absolute().parent.is_dir():
        raise ValueError(f"the table must be in a folder that exists, got {options.table}")
    rows = run(
        CHECKOUT,
        choose,
        options.table,
        tests=options.tests,
        workers=options.workers or usable_cores(),
        survivors_only=options.survivors,
        tell=lambda line: print(line, flush=True),
    )
    reasons = read_reasons(FOLDER / "equivalent.toml")
    command = f"python tests/mutation generated --count {options.count} --seed {options.seed}"
    command += (f" --only {options.only}" if options.only else "") + (" --tests" if options.tests else "")
    place = options.table.with_suffix(".md")
    place.write_text(page(rows, reasons, command), encoding="utf-8")
    for name in stale(rows, reasons, known):
        print(f"equivalent.toml: the reason for {name} no longer fits", file=sys.stderr)
    print(f"{sum(row.found for row in rows)} of {len(rows)} found; {place}")
    return 0


def _show(options: argparse.Namespace) -> int:
    from mutation.targets import all_faults

    found = [
        each for of in all_faults(CHECKOUT).values() for each in of if each.name.startswith(options.fault)
    ]
    if not found:
        raise ValueError(f"the name of a fault is file:scope:kind:ordinal, got {options.fault}")
    for fault in found:
        print(fault.diff((CHECKOUT / fault.file).read_text(encoding="utf-8")))
    return 0


if __name__ == "__main__":
    sys.exit(main())
