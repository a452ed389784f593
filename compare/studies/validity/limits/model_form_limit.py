"""Free response: how far recess and flat differ, and whether an engine tells them apart."""

from __future__ import annotations

import math

import numpy as np

from .limit import Limit, Tables, column, first_failing, largest, percent, quantile, short, up_to

SMALL = 0.01  # of period or angle of turn: below what a test on a shake table would see
# an engine confirms a model if it is nearer to it than this share of the difference of the models
_TEETH = 0.5
# and contradicts it where turn or period is off by more than this; the step of an engine errs by less
_CONTRADICTS = 1e-3


def model_form(tables: Tables) -> Limit:
    """Draw the limit from the maps of free response and the engine at some of their points."""
    table = tables["free_response"]
    tan_alpha = column(table, "tan_alpha")
    turn, flat_turn = column(table, "turn"), column(table, "flat_turn")
    turns = np.abs(flat_turn / turn - 1.0)
    periods = np.abs(column(table, "flat_period") / column(table, "period") - 1.0)
    gained = column(table, "flat_peak") - 1.0
    holds = (turns <= SMALL) & (periods <= SMALL)
    alike, apart = up_to(tan_alpha, holds), first_failing(tan_alpha, holds)
    worst = int(np.nanargmax(np.abs(flat_turn - turn)))
    point = table.iloc[worst]
    confirmed, contradicted, points = _confirmed(tables)
    numbers = {
        "alike_up_to": alike,
        "apart_from": apart,
        "turn_median": quantile(turns, 0.5),
        "turn_largest": largest(turns),
        "turn_largest_deg": math.degrees(largest(np.abs(flat_turn - turn))),
        "period_largest": largest(periods),
        "peak_gain": largest(gained),
        "confirmed": confirmed,
        "contradicted": contradicted,
        "points": points,
    }
    return Limit(
        subject="Free response: rolling out",
        use=_use(numbers),
        error=f"Period off by at most {percent(numbers['period_largest'])}, angle of turn by "
        f"{percent(numbers['turn_median'])} (median) and at most {percent(numbers['turn_largest'])}, peak "
        "tilt in "
        f"ten periods by {percent(max(numbers['peak_gain'], 0.0))}. The engine, in an ideal recess and on "
        "open "
        f"ground, tells the two models apart and confirms the right one at {confirmed:.0f} of {points:.0f} "
        "points.",
        avoid=(
            f"For directions after many passes: a pass turns up to {short(numbers['turn_largest_deg'])}° "
            f"differently (tan α {point['tan_alpha']:g}, released at {point['release']:g} α with "
            f"{point['spin']:g} of the steady rate)"
            + (
                f"; from tan α = {apart:g} on a pass can be off by more than {percent(SMALL)}."
                if math.isfinite(apart)
                else "."
            )
        ),
        numbers=numbers,
    )


def _use(numbers: dict[str, float]) -> str:
    if numbers["contradicted"] > 0.0:
        return (
            f"Not established: the engine contradicts the reduced models at "
            f"{numbers['contradicted']:.0f} of {numbers['points']:.0f} points."
        )
    if math.isnan(numbers["alike_up_to"]):
        return "For no slenderness mapped are period and angle of turn of a single pass within "
        f"{percent(SMALL)}."
    return (
        f"Up to tan α = {numbers['alike_up_to']:g}: period and angle of turn of a pass are those of a "
        f"cylinder on open ground to {percent(SMALL)}, at every release and spin mapped."
    )


def _confirmed(tables: Tables) -> tuple[float, float, float]:
    """Count the runs that confirm their model, those that contradict it, and all whose pass is resolved."""
    table = tables["verification"]
    keys = ["tan_alpha", "release", "spin"]
    models = table.pivot_table("turn", keys, "model", dropna=False)
    apart = (models["recess"] - models["flat"]).abs()
    resolved = table[table["resolved"].astype(bool)]
    error = np.abs(column(resolved, "engine_turn") - column(resolved, "turn"))
    limits = apart.reindex(resolved.set_index(keys).index).to_numpy(dtype=np.float64)
    turn_off = error / np.abs(column(resolved, "turn"))
    period_off = np.abs(column(resolved, "engine_half_period") / column(resolved, "half_period") - 1.0)
    contradicts = ~((turn_off <= _CONTRADICTS) & (period_off <= _CONTRADICTS))
    confirms = ~contradicts & (error < _TEETH * limits)
    return float(confirms.sum()), float(contradicts.sum()), float(len(resolved))
