"""What a comparison found, in sentences made from its numbers."""

from __future__ import annotations

import math
from typing import Any

PEAK_WORTH_A_WORD = 0.01  # difference of peak tilts, relative


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
    return f"{_agreement(row, run, model, length)} {_peaks(row)}"


def _agreement(row: Any, run: str, model: str, length: float) -> str:
    passes = f"{row.agreed_passes} pass{'' if row.agreed_passes == 1 else 'es'} by the apex"
    if not row.parted:
        return (
            f"{run} stays within 1 % of alpha of {model} for the whole run "
            f"({row.agreement_horizon:.1f} s, {passes})."
        )
    return (
        f"{run} stays within 1 % of alpha of {model} for {seconds(row.agreement_horizon)} from uplift or "
        f"release ({passes}), then they part: {_reason(row, length)}."
    )


def _reason(row: Any, length: float) -> str:
    foretold = row.predicted_horizon
    if row.support == "free" and row.reference == "recess":
        return (
            "on open ground the cylinder may roll out of its place, which the recess of that model "
            "forbids; the difference is one of support, not of accuracy"
        )
    if foretold < length and row.agreement_horizon >= foretold:
        return (
            f"at {seconds(foretold)} a pass comes closer to the apex than the contact resolves "
            f"({row.contact_resolution:.1g} rad); what is left to chance there grows from then on"
        )
    if math.isfinite(row.closest_pass):
        return (
            f"the contact resolves every pass until then, the closest of which comes within "
            f"{row.closest_pass:.1g} alpha of the apex; near passes amplify what small difference there is"
        )
    return "without a pass by the apex, so that it is an error of the method and not of chance"


def _peaks(row: Any) -> str:
    ours, theirs = row.peak_tilt, row.reference_peak_tilt
    if "only" in row.message and "overturned" in row.message:
        return f"{row.message[0].upper()}{row.message[1:]}."
    if row.outcome == row.reference_outcome == "overturned":
        return "Both overturn."
    relative = abs(ours - theirs) / theirs if theirs > 0.0 else math.inf
    if relative < PEAK_WORTH_A_WORD:
        return f"Peak tilt is the same to {100.0 * relative:.1g} % ({ours:.3g} alpha)."
    return f"Peak tilt is {ours:.3g} alpha against {theirs:.3g} alpha."


def seconds(value: float) -> str:
    """Return a time with as many digits as say something."""
    return f"{value:.2f} s" if value < 1.0 else f"{value:.1f} s"


def headline(summary: Any, length: float) -> str:
    """Return the one sentence that stands above everything."""
    like = summary[summary["reference"] == summary["support"].map(own_model)]
    rows = like if len(like) else summary
    good = rows[rows["outcome"] != "failed"]
    if not len(good):
        return "No run could be compared."
    shortest, longest = good["agreement_horizon"].min(), good["agreement_horizon"].max()
    if not bool(good["parted"].any()):
        return (
            f"Every engine agrees with the reduced model of its support for the whole run ({length:.1f} s)."
        )
    span = seconds(longest) if shortest == longest else f"{seconds(shortest)} to {seconds(longest)}"
    return (
        f"Engines and the reduced models of their supports agree within 1 % of alpha for {span} from uplift "
        "or release; beyond that, compare distributions and not traces."
    )


def own_model(support: str) -> str:
    """Return the reduced model that describes a support."""
    return "rolling" if support == "free" else "recess"
