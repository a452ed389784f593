"""Typer command from a function: its options, checks of its input, and saving of its results."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer
from typer.core import TyperCommand

from rockwobble.compare.runs.plan import Option, options_of

from ..console import FAILED, echo, interruptible, open_page, save_with_page, shown_progress, user_input
from .options import Out, Overwrite, levels, numbers, restitution
from .outputs import claim_folder

if TYPE_CHECKING:
    from rockwobble.compare.storage.results import Results

# form of the text of an option: what reads it, and what help calls it
_FORMS: Mapping[str, tuple[Callable[[str], object], str]] = {
    "numbers": (numbers, "LIST|FROM:TO:COUNT"),
    "levels": (levels, "LIST|FROM:TO:COUNT"),
    "restitution": (restitution, "FLOAT|momentum"),
}


def takes_options(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the fields of each dataclass parameter as options.

    A field is annotated with an option of typer, or is an option of a plan, whose numbers are checked when
    the plan is made. Two dataclasses may share a field: it is one option, and both get its value.
    """
    own = get_type_hints(command, include_extras=True)
    stated: dict[str, Any] = {name: kind for name, kind in own.items() if is_dataclass(kind)}
    parameters: dict[str, inspect.Parameter] = {}
    for name, parameter in inspect.signature(command).parameters.items():
        if name in stated:
            parameters |= {each.name: each for each in _parameters(stated[name])}
        else:
            parameters[name] = parameter.replace(kind=parameter.KEYWORD_ONLY, annotation=own[name])

    @wraps(command)
    def with_options(**given: object) -> None:
        with user_input():
            made = {name: _make(kind, given) for name, kind in stated.items()}
        others = {name: value for name, value in given.items() if name in own and name not in stated}
        command(**made, **others)

    with_options.__signature__ = inspect.Signature(list(parameters.values()))  # type: ignore[attr-defined]
    with_options.__annotations__ = {name: each.annotation for name, each in parameters.items()}
    return with_options


@dataclass(frozen=True, slots=True)
class Work:
    """Work of a command after its input is checked.

    Attributes
    ----------
    run : callable
        Takes `progress`, and where it resumes the folder as `resume`; yields the results.
    lines : iterable of str
        What was understood of the input.
    what : str
        Its tasks in words.
    resumes : bool
        Whether finished runs are kept in the folder.
    details : bool
        Whether what is folded on the page is printed, too.
    failed : callable
        Whether results are none, so that the exit code is 1.
    opened : bool, optional
        Whether the page is opened in the browser; None: in a terminal.
    """

    run: Callable[..., Results]
    lines: Iterable[str] = ()
    what: str = "runs"
    resumes: bool = False
    details: bool = False
    failed: Callable[[Any], object] = lambda results: False
    opened: bool | None = False


def saves_results(command: Callable[..., Work]) -> Callable[..., None]:
    """Give a command --out and --overwrite, run its work, write the results with their page, and print it."""

    def save(context: typer.Context, **given: Any) -> None:
        out = context.params["out"]
        with interruptible(), user_input():
            work = command(context, **{name: given[name] for name in given if name not in written})
            claim_folder(context)
        with interruptible(out if work.resumes else None):
            echo(work.lines)
            with user_input(), shown_progress(work.what) as progress:
                results = work.run(progress=progress, **({"resume": out} if work.resumes else {}))
            save_with_page(results, out)(details=work.details)
        open_page(out / f"{command.__name__}.html", work.opened)
        if work.failed(results):
            raise typer.Exit(FAILED)

    stated, keyword = inspect.signature(command), inspect.Parameter.KEYWORD_ONLY
    written = {"out": (Out, Path(f"rockwobble-{command.__name__}")), "overwrite": (Overwrite, False)}
    added = [
        inspect.Parameter(name, keyword, default=default, annotation=kind)
        for name, (kind, default) in written.items()
    ]
    wraps(command)(save)
    save.__signature__ = stated.replace(  # type: ignore[attr-defined]
        parameters=[*(each.replace(kind=keyword) for each in stated.parameters.values()), *added]
    )
    kinds = {name: kind for name, (kind, _) in written.items()}
    save.__annotations__ = command.__annotations__ | kinds | {"return": None}
    return takes_options(save)


def _make(kind: Any, given: Mapping[str, object]) -> object:
    """Dataclass from the given options; errors name an option as it is typed."""
    try:
        return kind(**{each.name: given[each.name] for each in fields(kind)})
    except ValueError as error:
        name, _, why = str(error).partition(" ")
        if (option := options_of(kind).get(name)) is None:
            raise
        raise ValueError(f"{option.flag or '--' + name.replace('_', '-')} {why}") from None


def _parameters(kind: type) -> Iterator[inspect.Parameter]:
    types, options = get_type_hints(kind, include_extras=True), options_of(kind)
    for each in fields(kind):
        annotation = types[each.name]
        if each.name in options:
            annotation = _annotation(annotation, options[each.name])
        yield inspect.Parameter(
            each.name, inspect.Parameter.KEYWORD_ONLY, default=each.default, annotation=annotation
        )


def _annotation(kind: Any, stated: Option) -> Any:
    """Annotation of an option, with the metadata for typer."""
    names = (stated.flag,) if stated.flag else ()
    more: dict[str, Any] = {"help": stated.help, "rich_help_panel": stated.group}
    if stated.form:  # typer has no such type
        read, metavar = _FORMS[stated.form]
        return Annotated[Any, typer.Option(*names, parser=read, metavar=metavar, **more)]
    if kind == Sequence[str] | None:
        kind = list[str] | None
    return Annotated[kind, typer.Option(*names, **more)]


class ShownCommand(TyperCommand):
    """Command that states the given value in each error."""

    def parse_args(self, ctx: object, args: list[str]) -> list[str]:
        """Arguments left after the options are parsed.

        Raises
        ------
        UsageError
            If a value is none of its kind.
        """
        context: Any = ctx
        given, _, _ = self.make_parser(context).parse_args(args=list(args))
        try:
            return super().parse_args(context, args)
        except typer.BadParameter as error:
            text = given.get(getattr(error.param, "name", None) or "")
            if isinstance(text, str) and text not in error.message and ", got " not in error.message:
                # "Input should be a valid number, unable to parse string as a number"
                error.message = f"{error.message.partition(', unable')[0]}, got {text!r}"
            raise
