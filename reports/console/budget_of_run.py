"""Error budget of one engine run, in lines for a terminal."""

from __future__ import annotations

import math

import rockwobble as rw

_PARTS = {
    "model_form": ("model form", "the model of the support minus the one asked about"),
    "numerics": ("numerics", "the engine minus the engine at a time step of zero"),
    "unexplained": ("unexplained", "the engine at a time step of zero minus the model of its support"),
}
_ADVICE = {
    "model_form": "Most of it is model form: the support moves by another model, which no step changes.",
    "numerics": "Most of it is numerics: a smaller time step removes it.",
    "unexplained": "Most of it is unexplained: contact, settings or support of the engine, or the model.",
}


def budget_of_run(case: rw.Case, run: rw.Run, reference: rw.Run) -> list[str]:
    """Return the lines; they rest on runs at finer time steps, made here."""
    comparison = rw.compare(case, runs=[run], budget=True)
    found = [budget for key, budget in comparison.budgets.items() if key[2] == str(reference)]
    if not found:
        return ["There is no budget of the difference: traces diverge at once, or there is no finer step."]
    budget = found[0]
    rms = {part: budget.rms(part) for part in _PARTS}
    lines = [
        f"What the difference is made of (RMS in alpha until {budget.covered:.3g} s, 80 % of the agreement):",
        f"  {'whole':12} {budget.rms('whole'):8.1e}  engine minus the {reference}",
    ]
    lines += [f"  {name:12} {rms[part]:8.1e}  {meaning}" for part, (name, meaning) in _PARTS.items()]
    steps = ", ".join(f"{step:g}" for step in budget.steps)
    order = "" if math.isnan(budget.order) else f"; measured order {budget.order:.1f}"
    lines.append(f"  known to {budget.rms('limit_error'):.1e}, from time steps of {steps} s{order}")
    row = comparison.summary[comparison.summary["reference"] == str(reference)].iloc[0]
    if row["diverged"]:
        lines.append(
            f"  traces diverge after {row['agreement_time']:.3g} s: {row['divergence']} of the prediction"
        )
    return [*lines, _ADVICE[max(rms, key=lambda part: rms[part])]]
