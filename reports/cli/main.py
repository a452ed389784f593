"""The command line. Nothing heavy is imported before a command needs it: --help answers at once."""

from __future__ import annotations

import os
import sys
from functools import cache
from typing import Annotated, Any

import typer
from typer.main import get_command

from ..console.terminal import BAD_INPUT, INTERRUPTED, complain, forgive_output
from .advise import advise
from .checks.certify import certify, verify
from .checks.check import check
from .compare import compare
from .ensemble import ensemble
from .extremes import extremes
from .figures import figures
from .fragility import fragility
from .inputs.strict_command import StrictCommand
from .results.report import report
from .results.show import show
from .results.view import view
from .simulate import simulate
from .spectrum import spectrum
from .sweep import sweep
from .tradeoff import tradeoff
from .validity import validity

app = typer.Typer(
    name="rockwobble",
    help="How far can a two-degree-of-freedom model of a rocking and wobbling cylinder be trusted?",
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)
for _command, _example in (
    (compare, "rockwobble compare --semidiagonal 10 --tan-alpha 0.1 --engine mujoco"),
    (advise, "rockwobble advise --record-x EW.AT2 --record-y NS.AT2 --friction 0.5"),
    (simulate, "rockwobble simulate --release-tilt-deg 5 --rolling-rate 0.5 --duration 8"),
    (spectrum, "rockwobble spectrum --tan-alpha 0.2 --semidiagonal 1:20:50 --intensity 1:9:50"),
    (sweep, "rockwobble sweep --semidiagonal 0.5:30:100 --scale 1,2,4 --out grid"),
    (show, "rockwobble show rockwobble-sweep"),
    (report, "rockwobble report rockwobble-compare"),
    (view, "rockwobble view --scale 2 --support flat"),
    (ensemble, "rockwobble ensemble --synthetic 40 --peak 3 --engine mujoco"),
    (fragility, "rockwobble fragility --p695 --cylinder pier=6,0.2 --engine mujoco"),
    (check, "rockwobble check --only equations --only conserved"),
    (certify, "rockwobble certify --engine mujoco --out mujoco.json"),
    (verify, "rockwobble verify mujoco.json"),
    (validity, "rockwobble validity --quick --out validity"),
    (figures, "rockwobble figures --out paper"),
    (tradeoff, "rockwobble tradeoff --quick --out tradeoff"),
    (extremes, "rockwobble extremes --quick --out extremes"),
):
    app.command(cls=StrictCommand, epilog=f"Example: {_example}")(_command)

# typer brings its own click in some versions and imports click in others: one base class, two homes
_USAGE_ERROR: Any = next(base for base in typer.BadParameter.__mro__ if base.__name__ == "ClickException")


@app.callback(invoke_without_command=True)
def _root(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version and stop.")] = False,
) -> None:
    if version:
        from importlib.metadata import version as version_of

        print(f"rockwobble {version_of('rockwobble')}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        print(context.get_help())


@cache
def _commands() -> Any:
    """Return what typer makes of all signatures, which takes it longer than most commands take to refuse."""
    return get_command(app)


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; exit code 0 done, 1 a check failed, 2 bad input, 130 interrupted."""
    forgive_output()
    os.environ["MPLBACKEND"] = "svg"  # pictures are files here, whatever a notebook has set
    try:
        code = _commands()(arguments, prog_name="rockwobble", standalone_mode=False)
    except _USAGE_ERROR as error:
        # one clear line, without the box that typer draws around it
        complain(error.format_message())
        sys.exit(BAD_INPUT)
    except MemoryError:
        complain("the memory of this machine does not suffice: give fewer runs, or shorter ones")
        sys.exit(BAD_INPUT)
    except (typer.Abort, KeyboardInterrupt):
        complain("interrupted")
        sys.exit(INTERRUPTED)
    sys.exit(code if isinstance(code, int) else 0)
