"""A command that refuses what was typed wrongly, before any option is used."""

from __future__ import annotations

from typing import Any

import typer
from typer.core import TyperCommand


class StrictCommand(TyperCommand):
    """A command whose options take no empty text, and whose refusals say what was given.

    An empty folder would be the one the command is run in.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Return the arguments that are left when the options are taken.

        Raises
        ------
        UsageError
            If a text is empty, or a value is none of its kind.
        """
        given, _, order = self.make_parser(ctx).parse_args(args=list(args))
        for option in [] if ctx.resilient_parsing else order:
            texts = given.get(option.name)
            for text in texts if isinstance(texts, list | tuple) else [texts]:
                if isinstance(text, str) and not text.strip():
                    ctx.fail(f"{_name(option)} must not be empty, got {text!r}")
        try:
            return super().parse_args(ctx, args)
        except typer.BadParameter as error:
            text: str | None = given.get(getattr(error.param, "name", None))
            said = text is None or text in error.message or ", got " in error.message
            if not said:
                # "Input should be a valid number, unable to parse string as a number"
                error.message = f"{error.message.partition(', unable')[0]}, got {text!r}"
            raise


def _name(option: Any) -> str:
    """Name of an option or argument, as help says it."""
    return str(option.opts[-1] if option.param_type_name == "option" else option.name.upper())
