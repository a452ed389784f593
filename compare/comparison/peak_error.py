"""Error of a peak tilt: the largest of the errors by its method, its data and its model.

A run has the error of its time step, a reduced model that of its tolerance; input that is known to 1 % leaves
the spread of perturbed copies; and another reduced model may have another peak.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockwobble.models import Case, Run, Trace
from rockwobble.models.members import perturbed_in_strength

from .prediction import Simulate

PERTURBATION = 0.01  # relative perturbation of the input
RTOL = 1e-8  # default of `reduced.simulate`
COARSER = 10.0  # tolerance of the coarser run for the integration error, over that of the run
# diagnostics with estimates from several time steps, in `rockwobble.models.diagnostic`
_OF_STEPS = ("settled", "unsettled", "extrapolated")


class PeakError(NamedTuple):
    """Error of a peak tilt.

    Attributes
    ----------
    size : float
        [alpha]; infinite where one stands and another overturns; NaN where there is no peak.
    source : {"", "integration", "step", "copies", "model form"}
        What it is the error of; "" where all are 0, as of what never uplifts, or unknown.
    """

    size: float
    source: str


NO_ERROR = PeakError(math.nan, "")


def peak_error(
    case: Case, trial: Trace, own: Trace, reference: Trace, *, copies: Sequence[Trace], simulate: Simulate
) -> PeakError:
    """Largest of the errors of a peak tilt.

    Parameters
    ----------
    case : Case
    trial : Trace
        The run.
    own : Trace
        Response of the reduced model that it would follow without an error.
    reference : Trace
        Another reduced model, or another run of the engine.
    copies : sequence of Trace
        `own` with input perturbed by 1 %; the root mean square of their differences counts.
    simulate : callable
        Runs a reduced model on a case; for the coarser tolerance.
    """
    if not math.isfinite(trial.peak_tilt):
        return NO_ERROR

    def apart(*others: Trace, of: Trace = own) -> float:
        fell = {each.outcome == "overturned" for each in (of, *others)}
        if fell != {False}:  # the final tilt of an overturned run is no peak
            return math.inf if len(fell) > 1 else 0.0
        return math.sqrt(float(np.mean([(other.peak_tilt - of.peak_tilt) ** 2 for other in others])))

    alpha = case.cylinder.alpha
    parts = {"copies": apart(*copies) if copies else math.nan}
    if trial.run.is_model:
        parts["integration"] = apart(simulate(case, _coarser(trial.run)), of=trial)
    else:
        sizes = [fact.size * alpha for fact in trial.facts if fact.code in _OF_STEPS]
        parts["step"] = max(sizes) if sizes else apart(own if reference.run.is_model else reference, of=trial)
    if reference.run.is_model:
        parts["model form"] = apart(reference)
    known = {"": 0.0} | {name: size for name, size in parts.items() if not math.isnan(size)}
    source = max(known, key=known.__getitem__)
    return PeakError(known[source] / alpha, source)


def copies_of_input(case: Case) -> list[Case]:
    """Copies of a case with its motion or release 1 % stronger and 1 % weaker."""
    return [perturbed_in_strength(case, share) for share in (PERTURBATION, -PERTURBATION)]


def _coarser(run: Run) -> Run:
    settings = {**run.settings, "rtol": COARSER * run.settings.get("rtol", RTOL)}
    return Run(None, run.support, **settings)
