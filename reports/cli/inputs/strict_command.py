"""A command that refuses what was typed wrongly, before any option is used."""

from __future__ import annotations

from typing import Any

from typer.core import TyperCommand


class StrictCommand(TyperCommand):
    """A command that takes no empty text: as a folder, it would be the one it is run in."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Return the arguments that are left when the options are taken.

        Raises
        ------
        UsageError
            If a text is empty.
        """
        given, _, order = self.make_parser(ctx).parse_args(args=list(args))
        for option in [] if ctx.resilient_parsing else order:
            texts = given.get(option.name)
            for text in texts if isinstance(texts, list | tuple) else [texts]:
                if isinstance(text, str) and not text.strip():
                    ctx.fail(f"{_name(option)} must not be empty, got {text!r}")
        return super().parse_args(ctx, args)


def _name(option: Any) -> str:
    """Name of an option or argument, as help says it."""
    return str(option.opts[-1] if option.param_type_name == "option" else option.name.upper())
