"""What a comparison found of an external trajectory: a table of numbers, and sentences made from codes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd
    from rich.table import Table

EXTERNAL = "external"  # support of what was not run here: nothing is known of its contact and its errors
_PARTS = ("azimuth", "path")
_NAMES = {
    "azimuth": "azimuth",
    "path": "path of the mass centre",
    "uplift_time": "time of uplift",
    "uplift_direction": "direction of uplift",
}
_AXES = {
    "turned_back": (
        "turned by 180 deg, as where the side that lifts is given for the side it leans to, the quaternion "
        "is that of the inverse turn, or the ground acceleration has the other sign"
    ),
    "x_reversed": "mirrored: x has the other sign",
    "y_reversed": "mirrored: y has the other sign, or azimuths are counted clockwise",
    "axes_exchanged": "mirrored: x and y are exchanged, or azimuths are counted clockwise from y (north)",
    "axes_exchanged_reversed": (
        "mirrored: x and y are exchanged and have the other sign, as where x is north, y east and z down"
    ),
}
_LENGTHS = {
    1e3: "in mm, read as m",
    1e2: "in cm, read as m",
    1e-2: "100 times too small: m read as cm",
    1e-3: "1000 times too small: m read as mm",
}
_TITLES = (
    ("run", ""),
    ("azimuth", "deg"),
    ("from", "s"),
    ("path", "b"),
    ("from", "s"),
    ("uplift", "s"),
    ("±", "s"),
    ("towards", "deg"),
    ("±", "deg"),
    ("noise", "α"),
    ("differs in", ""),
    ("likely mistake", ""),
)
LEGEND = (
    "External trajectories against the model. azimuth, path: root mean square of the difference while the "
    "tilts agree, and from when it is above its bound (- it is not, or nothing is known). uplift, towards: "
    "difference of time and azimuth of the uplift, ± what the samples leave open. noise: scatter of samples."
)


def external_table(summary: pd.DataFrame) -> Table | None:
    """Return one line of numbers and codes for each external trajectory; None where there is none."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    rows = summary[summary["support"] == EXTERNAL]
    if not len(rows) or "differs_in" not in rows:
        return None
    table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False)
    for title, unit in _TITLES:
        numbers = bool(unit)
        # as a text, because brackets are markup
        table.add_column(
            Text(f"{title}\n[{unit}]" if numbers else title),
            justify="right" if numbers else "left",
            no_wrap=numbers,
        )
    for _, row in rows.iterrows():
        uplifts = math.isfinite(row.uplift_time_uncertainty)
        leads = math.isfinite(row.uplift_direction_uncertainty)
        table.add_row(
            row.run,
            _fixed(row.azimuth_rms, 1),
            _fixed(row.azimuth_differs_from, 2),
            _fixed(row.path_rms, 3),
            _fixed(row.path_differs_from, 2),
            _fixed(row.uplift_time_difference, 3) if uplifts else "-",
            _fixed(row.uplift_time_uncertainty, 3),
            _fixed(math.degrees(row.uplift_direction_difference), 1) if leads else "-",
            # beyond half a turn there is nothing left to tell
            _fixed(min(math.degrees(row.uplift_direction_uncertainty), 180.0), 1) if leads else "-",
            _fixed(row.noise, 4),
            row.differs_in or "-",
            row.likely_mistake or "-",
        )
    return table


def within(row: Any) -> str:
    """Return what agreement of the tilts means for a run."""
    bound = getattr(row, "tilt_bound", math.nan)
    return f"{100.0 * bound:.2g} % of alpha (1 % and the noise)" if bound > 0.0101 else "1 % of alpha"


def scope(row: Any) -> str:
    """Return what of an external trajectory agrees while the tilts do, and what does not, for a headline."""
    differs, missing = _listed(row, "differs_in"), [part for part, _ in _missing(row)]
    known = [part for part in _PARTS if math.isfinite(getattr(row, f"{part}_rms", math.nan))]
    agrees = [part for part in known if part not in differs]
    words = f", in {_and(['tilt', *agrees])}"
    if wrong := [_NAMES[part] for part in differs if part in _NAMES]:
        words += f" but not in {_and(wrong)}"
    if missing:
        words += f" (not compared: {_and(missing)})"
    mistakes = mistake_words(row)
    return f"{words}. Likely mistake: {'; '.join(mistakes)}" if mistakes else words


def external_sentences(row: Any) -> str:
    """Return the sentences on azimuth, path, uplift and likely mistakes of an external trajectory."""
    differs = _listed(row, "differs_in")
    sentences = []
    if math.isfinite(getattr(row, "azimuth_rms", math.nan)):
        sentences.append(
            f"The azimuth differs by {row.azimuth_rms:.1f} deg (rms while the tilts agree)"
            + (
                f", from {row.azimuth_differs_from:.2f} s on."
                if "azimuth" in differs
                else ", which is agreement."
            )
        )
    if math.isfinite(getattr(row, "path_rms", math.nan)):
        sentences.append(
            f"The path of the mass centre differs by {row.path_rms:.2g} b"
            + (f", from {row.path_differs_from:.2f} s on." if "path" in differs else ", which is agreement.")
        )
    if missing := [f"{_NAMES[part]} ({reason})" for part, reason in _missing(row)]:
        sentences.append(f"Not compared: {_and(missing)}.")
    sentences += _uplift(row, differs)
    mistakes = mistake_words(row)
    if mistakes:
        left = _listed(row, "differs_without_mistake")
        rest = f", but it differs in {_and(left)}" if {"azimuth", "path"} & set(left) else ""
        sentences.append(
            f"Likely mistake: {'; '.join(mistakes)}. Without it, the tilt follows the model for "
            f"{row.agreement_without_mistake:.1f} s{rest}."
        )
        if others := mistake_words(row, "alternative_mistake"):
            sentences.append(f"Or, which here is the same: {'; or '.join(others)}.")
    elif {"azimuth", "path"} & set(differs):
        sentences.append("No mistake of axes, units, clock or origin explains that.")
    return " ".join(sentences)


def mistake_words(row: Any, column: str = "likely_mistake") -> list[str]:
    """Return each mistake that explains the differences, in words."""
    if not (codes := _listed(row, column)):
        return []
    values = str(getattr(row, f"{column}_value", "")).split("; ")
    return [
        _mistake(*code.split(": ", 1), value=float(value) if value else math.nan)
        for code, value in zip(codes, values, strict=True)
    ]


def _uplift(row: Any, differs: list[str]) -> list[str]:
    if not math.isfinite(getattr(row, "uplift_time_uncertainty", math.nan)):
        return []
    words = (
        f"It uplifts {abs(row.uplift_time_difference):.3f} s "
        f"{'after' if row.uplift_time_difference >= 0.0 else 'before'} the model, where its samples tell "
        f"± {row.uplift_time_uncertainty:.3f} s"
    )
    if "uplift_direction" in differs:
        words += (
            f", and {abs(math.degrees(row.uplift_direction_difference)):.0f} deg from its direction, where "
            f"they tell ± {math.degrees(row.uplift_direction_uncertainty):.0f} deg"
        )
    return [f"{words}."]


def _mistake(concerns: str, code: str, *, value: float) -> str:
    if code == "time_offset":
        side = "late" if value < 0.0 else "early"
        return f"its clock is {abs(value):.3f} s {side}: an offset of {value:.3f} s takes that back"
    if code == "angle_unit":
        units = ("degrees", "radians") if value > 1.0 else ("radians", "degrees")
        verb = "are" if " and " in concerns else "is"
        return f"its {concerns} {verb} in {units[0]}, read as {units[1]}"
    if code == "length_unit":
        return f"x, y and z are {_LENGTHS[value]}"
    if code == "z_reversed":
        return "z points down"
    if code == "origin":
        return f"x, y and z are counted from a point {value:.3g} m from the original base centre"
    what = {"axes": "its axes are", "azimuth": "its azimuth is", "path": "its path is"}[concerns]
    if code == "turned":
        return f"{what} turned by {value:.1f} deg (counter-clockwise)"
    if code == "mirrored":
        return f"{what} mirrored in the line at {value:.1f} deg, so that it rolls the other way round"
    return f"{what} {_AXES[code]}"


def _listed(row: Any, column: str) -> list[str]:
    return [part for part in str(getattr(row, column, "")).split("; ") if part]


def _missing(row: Any) -> list[tuple[str, str]]:
    return [
        (part, reason) for part, _, reason in (each.partition(": ") for each in _listed(row, "not_compared"))
    ]


def _and(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _fixed(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"
