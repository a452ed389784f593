"""What a comparison found, in sentences made from its numbers."""

from __future__ import annotations

import math
from typing import Any

from rockwobble.compare import own_model

from .external_words import EXTERNAL, external_sentences, mistake_words, scope, within

PEAK_WORTH_A_WORD = 0.01  # difference of peak tilts, relative
PLACES = {
    "recess": "In an ideal recess (guided)",
    "flat": "On open ground (free)",
    "ring": "In a recess of walls (ring)",
    "external": "Brought from elsewhere (external)",
}
TOUCHED = "touched a wall"  # in the message of a run
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def finding(row: Any, length: float) -> str:
    """Return one or two sentences on a row of the summary: how long it agrees, and why it parts.

    Parameters
    ----------
    row : Series
        Row of `Comparison.summary`.
    length : float
        Length of the run [s].
    """
    run = f"{row.engine} {row.support}"
    model = f"the {row.reference} model"
    if row.outcome == "failed" or row.reference_outcome == "failed":
        return f"{run} against {model}: {row.message}."
    if "neither uplifted" in row.message:
        return f"{run} and {model} both stay at rest: this excitation does not uplift the cylinder."
    sentences = f"{_agreement(row, run, model, length)} {_peaks(row)}"
    return f"{sentences} {external_sentences(row)}".strip() if row.support == EXTERNAL else sentences


def _agreement(row: Any, run: str, model: str, length: float) -> str:
    passes = f"{row.agreed_passes} pass{'' if row.agreed_passes == 1 else 'es'} by upright"
    if not row.diverged:
        return (
            f"{run} stays within {within(row)} of {model} for the whole run "
            f"({row.agreement_time:.1f} s, {passes})."
        )
    return (
        f"{run} stays within {within(row)} of {model} for {seconds(row.agreement_time)} from uplift or "
        f"release ({passes}), then they part: {_reason(row, length)}."
    )


def _reason(row: Any, length: float) -> str:
    predicted = row.predicted_agreement_time
    if row.support == "flat" and row.reference == "recess":
        return (
            "on open ground the cylinder may roll out of its place, which a recess forbids; this is a "
            "difference of support, not of accuracy"
        )
    if row.support == "ring" and (row.reference == "recess" or TOUCHED in row.message):
        return (
            "the walls of a ring hold the cylinder only where it has rolled out as far as their clearance, "
            "and each touch takes energy, which neither model knows; this is a difference of support, not of "
            "accuracy"
        )
    if row.support == EXTERNAL:
        return _external_reason(row)
    by_pass = getattr(row, "predicted_by", "pass") == "pass"
    if by_pass and predicted < length and row.agreement_time >= predicted:
        return (
            f"at {seconds(predicted)} a pass comes closer to upright than the contact resolves "
            f"({small(row.contact_resolution)} rad); what is left to chance there grows from then on"
        )
    if math.isfinite(row.closest_pass):
        return (
            f"the contact resolves every pass until then, the closest of which comes within "
            f"{small(row.closest_pass)} alpha of upright; near passes amplify what small difference there is"
        )
    return "without a pass, so that it is an error of the method and not of chance"


def _external_reason(row: Any) -> str:
    if mistake_words(row):
        return "see the likely mistake"
    differs = "the body, its start, the ground motion or the method"
    if math.isfinite(row.closest_pass):
        return (
            f"the closest pass until then comes within {small(row.closest_pass)} alpha of upright; near "
            f"passes amplify what small difference there is in {differs}"
        )
    return f"without a pass, so that not chance but {differs} differs"


def _peaks(row: Any) -> str:
    ours, theirs = row.peak_tilt, row.reference_peak_tilt
    if "only" in row.message and "overturned" in row.message:
        said = [part for part in row.message.split("; ") if part.startswith(("only ", "compared up to "))]
        return f"{said[0][0].upper()}{'; '.join(said)[1:]}."
    if row.outcome == row.reference_outcome == "overturned":
        return "Both overturn."
    relative = abs(ours - theirs) / theirs if theirs > 0.0 else math.inf
    if relative < PEAK_WORTH_A_WORD:
        return f"Peak tilt is the same to {100.0 * relative:.1g} % ({ours:.3g} alpha)."
    return f"Peak tilt is {ours:.3g} alpha against {theirs:.3g} alpha."


def seconds(value: float) -> str:
    """Return a time with as many digits as say something."""
    return f"{value:.2f} s" if value < 1.0 else f"{value:.1f} s"


def small(value: float) -> str:
    """Return a positive number with one digit, as a power of ten where it is small."""
    if value >= 1e-3 or value <= 0.0:
        return f"{value:.1g}"
    digit, exponent = f"{value:.0e}".split("e")
    # spaces that do not break
    return f"{digit}\u00a0×\u00a010{str(int(exponent)).translate(_SUPERSCRIPTS)}"


def headline(summary: Any, length: float) -> str:
    """Return what stands above everything: how long the runs of each support follow their own model."""
    parts = []
    diverged = False
    for support in summary["support"].unique():
        rows = summary[(summary["support"] == support) & (summary["outcome"] != "failed")]
        own = rows[rows["reference"] == own_model(support)]
        rows = own if len(own) else rows
        if not len(rows):
            continue
        if support == EXTERNAL:
            # each is something else
            parts += [
                f"{_followed(rows[rows.index == at], length)}{scope(row)}." for at, row in rows.iterrows()
            ]
            diverged = diverged or any(row.diverged and not mistake_words(row) for _, row in rows.iterrows())
            continue
        diverged = diverged or bool(rows["diverged"].any())
        parts.append(f"{_followed(rows, length)}.")
    if not parts:
        return "No run could be compared."
    if diverged:
        parts.append("Once traces have diverged, compare distributions.")
    return " ".join(parts)


def _followed(rows: Any, length: float) -> str:
    support = rows["support"].iloc[0]
    models = " and ".join(rows["reference"].unique())
    follow = "follow" if len(rows) > 1 else "follows"
    engines = " and ".join(rows["engine"].unique())
    bound = within(rows.iloc[0]) if support == EXTERNAL else "1 % of alpha"
    return (
        f"{PLACES.get(support, f'With support {support}')}, {engines} {follow} the {models} model within "
        f"{bound} {_span(rows, length)}"
    )


def _span(rows: Any, length: float) -> str:
    if not bool(rows["diverged"].any()):
        return f"for the whole run ({length:.1f} s)"
    shortest, longest = rows["agreement_time"].min(), rows["agreement_time"].max()
    span = seconds(longest) if shortest == longest else f"{seconds(shortest)} to {seconds(longest)}"
    return f"for {span} from uplift or release"
