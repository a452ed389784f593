"""A command that refuses what was typed wrongly, before any option is used."""

from __future__ import annotations

from typing import Any

import typer
from typer.core import TyperCommand


class StrictCommand(TyperCommand):
    """A command whose options take no empty text and come once, and whose refusals say what was given.

    An empty folder would be the one the command is run in; of an option that comes twice the last would
    count in silence. Options that may be repeated stay so.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Return the arguments that are left when the options are taken.

        Raises
        ------
        UsageError
            If a text is empty, an option comes twice, or a value is none of its kind.
        """
        given, _, order = self.make_parser(ctx).parse_args(args=list(args))
        if not ctx.resilient_parsing:  # not while a shell asks how a line could go on
            _refuse_empty(ctx, given, order)
            _refuse_twice(ctx, order)
        try:
            return super().parse_args(ctx, args)
        except typer.BadParameter as error:
            text = given.get(getattr(error.param, "name", None) or "")
            if isinstance(text, str) and text not in error.message and ", got " not in error.message:
                # "Input should be a valid number, unable to parse string as a number"
                error.message = f"{error.message.partition(', unable')[0]}, got {text!r}"
            raise


def _refuse_empty(ctx: Any, given: dict[str, Any], order: list[Any]) -> None:
    for option in order:
        texts = given.get(option.name)
        for text in texts if isinstance(texts, list | tuple) else [texts]:
            if isinstance(text, str) and not text.strip():
                ctx.fail(f"{_name(option)} must not be empty, got {text!r}")


def _refuse_twice(ctx: Any, order: list[Any]) -> None:
    for place, option in enumerate(order):
        if option in order[:place] and not (option.multiple or option.is_eager):
            ctx.fail(f"{_name(option)} is given twice")


def _name(option: Any) -> str:
    """Name of an option or argument, as help says it."""
    return str(option.opts[-1] if option.param_type_name == "option" else option.name.upper())
