"""Complete command lines of a problem, for pages and for suggestions of other commands."""

from __future__ import annotations

import shlex
from collections.abc import Mapping

# options of a problem that `rockwobble spectrum` has, too: it states the cylinder by slenderness alone
_OF_SPECTRUM = (
    *("record", "record_x", "record_y", "record_z", "units", "resample", "scale"),
    *("slab_mass_ratio", "gravity", "rolling_resistance", "tendon_prestress", "tendon_stiffness", "support"),
)


_BREAK = " \\"  # ends a line that goes on


def command_line(command: str, options: Mapping[str, object]) -> str:
    """Command line with options by parameter name; True is a flag, None is left out.

    Examples
    --------
    >>> command_line("advise", {"record_x": "E W.AT2", "scale": 0.5, "resample": True, "mass": None})
    "rockwobble advise --record-x 'E W.AT2' --scale 0.5 --resample"
    """
    parts = ["rockwobble", command]
    for name, value in options.items():
        if value is None or value is False:
            continue
        parts += [f"--{name.replace('_', '-')}", *([] if value is True else [str(value)])]
    return shlex.join(parts)


def command_lines(command: str, width: int) -> list[str]:
    r"""Command over indented lines that a shell reads as one, broken only before options.

    A line is longer than `width` only where one option with its value is.

    Examples
    --------
    >>> print("\n".join(command_lines("rockwobble advise --record-x 'E W.AT2' --scale 0.5 --resample", 44)))
      rockwobble advise --record-x 'E W.AT2' \
        --scale 0.5 --resample
    """
    try:
        words = [shlex.quote(word) for word in shlex.split(command)]
    except ValueError:  # Python and no shell command, with other line breaks
        return [f"  {command}"]
    if not words or shlex.join(shlex.split(command)) != command:
        return [f"  {command}"]
    groups: list[str] = []
    for word in words:
        if groups and groups[-1].startswith("--") and " " not in groups[-1] and not word.startswith("--"):
            groups[-1] += f" {word}"
        else:
            groups.append(word)
    lines = [f"  {groups[0]}"]
    for group in groups[1:]:
        if len(lines[-1]) + len(group) + len(_BREAK) + 1 > width:
            lines[-1] += _BREAK
            lines.append(f"    {group}")
        else:
            lines[-1] += f" {group}"
    return lines


def spectrum_line(options: Mapping[str, object], tan_alpha: float) -> str:
    """Spectrum command for the slenderness, slab, ground motion and support of the options."""
    kept = {name: value for name, value in options.items() if name in _OF_SPECTRUM}
    return command_line("spectrum", {"tan_alpha": f"{tan_alpha:.6g}", **kept})
