"""The layers of checks, tightest first, and running them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence

from rockwobble.models.number_checks import require_one_of

from .bench import Bench
from .engines import (
    agreement,
    engine_baseline,
    engine_equations,
    engine_settings,
    rings,
    time_steps,
    traces,
)
from .finding import Bound, Finding, at_most
from .inputs import ground_motions, record_files, refusals, suites
from .measures import (
    batch,
    exact_functions,
    external_trajectories,
    metrics,
    predicted_times,
    sample_statistics,
    spectra,
    sweeps,
)
from .models import (
    after_record,
    conserved,
    demands,
    equations,
    exact,
    invariance,
    landing,
    order,
    properties,
    reduced_baseline,
    residual,
    rest,
    turning_points,
)

Check = Callable[[Bench], Iterator[Finding]]

# what comes later rests on what comes earlier
PARTS: dict[str, tuple[Check, ...]] = {
    "records": (record_files.check, ground_motions.check, refusals.check),
    "equations": (equations.check, engine_equations.check),
    "conserved": (conserved.check,),
    "exact": (exact.check, exact_functions.check),
    "rest": (rest.check, landing.check, after_record.check),
    "invariance": (invariance.check,),
    "properties": (properties.check, turning_points.check, demands.check),
    "order": (order.check,),
    "residual": (residual.check,),
    "metrics": (metrics.check, predicted_times.check, external_trajectories.check, sample_statistics.check),
    "studies": (batch.check, suites.check, sweeps.check, spectra.check),
    "traces": (traces.check, time_steps.check, rings.check),
    "agreement": (engine_settings.check, agreement.check),
    "baseline": (reduced_baseline.check, engine_baseline.check),
}
LAYERS = tuple(PARTS)
_ENDS = Bound(0.0, "a check must reach its end")


def run_checks(bench: Bench, layers: Sequence[str] = LAYERS) -> Iterator[Finding]:
    """Yield the findings of the layers, in their order whatever that of `layers`, as they are made.

    An exception in a check is a failure of that check: the checks after it still run.

    Parameters
    ----------
    bench : Bench
    layers : sequence of str, optional
        Of `LAYERS`.

    Returns
    -------
    iterator of Finding

    Raises
    ------
    ValueError
        If a layer is unknown.
    """
    for layer in layers:
        require_one_of("a layer", layer, LAYERS)
    for layer in (name for name in LAYERS if name in layers):
        for part in PARTS[layer]:
            for finding in _guarded(part, bench):
                yield dataclasses.replace(finding, layer=layer)


def _guarded(part: Check, bench: Bench) -> Iterator[Finding]:
    try:
        yield from part(bench)
    except Exception as error:  # whatever a broken model or engine raises is a failure, said in its place
        name = part.__module__.rsplit(".", 1)[-1].replace("_", " ")
        suspect = f"whatever raised {type(error).__name__}"
        yield at_most(f"{name} could not be checked", math.nan, _ENDS, suspect, " ".join(str(error).split()))
