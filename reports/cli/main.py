"""The command line; heavy imports happen only inside commands, so that --help is fast."""

from __future__ import annotations

import errno
import importlib
import inspect
import os
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

from ..console import BAD_INPUT, FAILED, INTERRUPTED, complain, replace_unencodable_output
from ..registry import COMMANDS, HEADINGS
from .command import ShownCommand


@cache
def _command(name: str) -> TyperCommand:
    """Import a command and build it with typer; its docstring ends with an example."""
    entry = COMMANDS[name]
    group = entry.group
    module = importlib.import_module(f".{'of_study' if entry.study else group}", __package__)
    function = module.command_of(entry) if entry.study else getattr(module, name)
    words, _, example = (inspect.getdoc(function) or "").partition("\n\nExample: ")
    alone = typer.Typer(add_completion=False, rich_markup_mode="rich", pretty_exceptions_enable=False)
    alone.command(cls=ShownCommand, help=_help(words, example), rich_help_panel=HEADINGS[group])(function)
    made = get_command(alone)
    assert isinstance(made, TyperCommand)
    return made


def _help(text: str, *examples: str) -> str:
    """Help text from a docstring, with examples after its first paragraph."""
    first, *others = (" ".join(part.split()) for part in text.split("\n\n"))
    return "\n\n".join([first, "\n".join(f"  {example}" for example in examples), *others])


class _Commands(Mapping[str, TyperCommand]):
    """Commands by name, each imported on first use."""

    def __getitem__(self, name: str) -> TyperCommand:
        return _command(name)

    def __iter__(self) -> Iterator[str]:
        return iter(COMMANDS)

    def __len__(self) -> int:
        return len(COMMANDS)


class _Group(TyperGroup):
    def __init__(self, **stated: Any) -> None:
        super().__init__(**stated | {"commands": _Commands()})


app = typer.Typer(
    cls=_Group,
    name="rockwobble",
    help=_help(
        "Does a free-standing cylinder overturn in an earthquake, and is the model that says so reliable?",
        "rockwobble advise --record-x EW.AT2 --record-y NS.AT2    verdict and demands",
        "rockwobble compare --record-x EW.AT2 --record-y NS.AT2   time of agreement",
        "rockwobble fragility --p695                              fragility curves",
    ),
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
)

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


def main(arguments: list[str] | None = None) -> None:
    """Run the command line; exit code 0 done, 1 a check failed, 2 bad input, 130 interrupted."""
    replace_unencodable_output()
    os.environ["MPLBACKEND"] = "svg"  # pictures are files here, whatever a notebook has set
    try:
        code = get_command(app)(arguments, prog_name="rockwobble", standalone_mode=False)
    except _USAGE_ERROR as error:
        # one clear line, without the box that typer draws around it
        complain(error.format_message())
        sys.exit(BAD_INPUT)
    except MemoryError:
        complain("the memory of this machine does not suffice: give fewer runs, or shorter ones")
        sys.exit(BAD_INPUT)
    except OSError as error:
        if error.errno != errno.ENOSPC:
            raise
        complain(f"the output cannot be printed: {error.strerror}; results that were written stay")
        sys.exit(FAILED)
    except (typer.Abort, KeyboardInterrupt):
        complain("interrupted")
        sys.exit(INTERRUPTED)
    sys.exit(code if isinstance(code, int) else 0)
