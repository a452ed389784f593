"""Free response: recess against flat ground, what the recess needs, and an engine at some of the releases."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from rockwobble import multibody, reduced
from rockwobble.compare.metrics.pair import make_pair, tilt_rms
from rockwobble.compare.runs.execution import simulate_run
from rockwobble.models import Run, Trace
from rockwobble.models.support import FLAT
from rockwobble.multibody import DEFAULT_ENGINE

from .plan import ALONE, RELEASE, Part, Row, Structure, grid, inputs_at, modelled, needs_of, release_case

_RTOL = 1e-10
_CYCLES = 10.0  # over which the flat-ground model may gather tilt
_MAXIMUM = 1.0  # in the fourth column of `Trace.extrema`


def measure_free_response(
    tan_alpha: float, releases: Sequence[float], spins: Sequence[float], structure: Structure = ALONE
) -> list[Row]:
    """Return one row for each release and spin.

    The columns: tan_alpha, release, spin; period [s] and turn [rad] from tilt maximum to next maximum, exact
    (recess) and integrated (flat_period, flat_turn; NaN where it overturns first), flat_peak, the
    largest tilt of the flat-ground model in ten periods over the release, all three NaN with a tendon;
    `needs_of` the recess model in one period.
    """
    return [_row(tan_alpha, release, spin, structure) for release in releases for spin in spins]


def _row(tan_alpha: float, release: float, spin: float, structure: Structure) -> Row:
    case = release_case(tan_alpha, release, spin, structure=structure)
    assert case.initial is not None
    exact = reduced.free_response(case.cylinder, case.initial, tendon=case.tendon)
    period = turn = peak = math.nan
    if not case.anchor:  # which the flat-ground model does not have
        flat = reduced.simulate(replace(case, duration=_CYCLES * exact.period), support=FLAT, rtol=_RTOL)
        (period, turn), peak = next_maximum(flat), flat.peak_tilt
    return {
        "release": release,
        "spin": spin,
        "period": exact.period,
        "flat_period": period,
        "turn": exact.angle_of_turn,
        "flat_turn": turn,
        "flat_peak": peak / case.initial.tilt,
        **needs_of(reduced.simulate(case, rtol=_RTOL)),
    }


def next_maximum(trace: Trace) -> tuple[float, float]:
    """Return time and rolling angle from the release, a tilt maximum, to the next; NaN if there is none."""
    maxima = trace.extrema[trace.extrema[:, 3] == _MAXIMUM]
    if len(maxima) < 2:
        return math.nan, math.nan
    return float(maxima[1, 0] - maxima[0, 0]), float(maxima[1, 2] - maxima[0, 2])


FREE_RESPONSE = Part(
    name="free_response",
    tasks=lambda extent: grid(tan_alpha=extent.tan_alphas, releases=[extent.releases], spins=[extent.spins]),
    measure=measure_free_response,
    keys=("tan_alpha",),
    cost=lambda releases, spins, **_: 0.02 * len(releases) * len(spins),
    engine="",
)


_VERIFIED_PERIODS = 2.2  # the second maximum, and a little more, so that it is seen to be one
_FRICTION = 10.0  # whatever the motion needs: friction is another limit


def measure_verification(
    tan_alpha: float, release: float, spin: float, structure: Structure = ALONE
) -> list[Row]:
    """Return a row for each support that has a model: the first pass by model and engine, and the tilts.

    The columns: tan_alpha, release, spin, support; turn, engine_turn [rad], half_period, engine_half_period
    [s] to the first tilt minimum; tilt_rms over alpha; resolved, whether the contact of the engine resolves
    the pass; outcome.
    """
    case = release_case(tan_alpha, release, spin, _VERIFIED_PERIODS, structure=structure)
    case = replace(case, friction=_FRICTION)
    rows: list[Row] = []
    for support in modelled(structure):
        trial = Run(DEFAULT_ENGINE, support)
        own = simulate_run(case, Run(None, trial.own_model.support, rtol=_RTOL))
        run = simulate_run(case, trial)
        none = {"time": math.nan, "angle_of_turn": math.nan, "resolved": False}
        first, own_first = (next(iter(each.passes.to_dict("records")), none) for each in (run, own))
        rows.append(
            {
                "support": support,
                "turn": next_maximum(own)[1],
                "engine_turn": first["angle_of_turn"],
                "half_period": own_first["time"],
                "engine_half_period": first["time"],
                "tilt_rms": tilt_rms(make_pair(case.cylinder, own, run)),
                "resolved": first["resolved"],
                "outcome": run.outcome,
            }
        )
    return rows


VERIFICATION = Part(
    name="verification",
    tasks=lambda extent: inputs_at(RELEASE, extent.engine_points),
    measure=measure_verification,
    keys=RELEASE,
    cost=lambda **_: 1.5,
)


_SLIP_PERIODS = 1.1  # one pass: the friction of the next is the same


def measure_slip(
    tan_alpha: float, release: float, spin: float, shares: Sequence[float], structure: Structure = ALONE
) -> list[Row]:
    """Return a row for each friction, as a share of what the recess model needs.

    The columns: tan_alpha, release, spin, needed, share, friction, slip of the engine in a recess in one
    period [b], tilt_rms against the recess model over alpha, outcome. No row where the model loses contact:
    no friction is enough.
    """
    period = release_case(tan_alpha, release, spin, structure=structure)
    needed = needs_of(reduced.simulate(period, rtol=_RTOL))["friction"]
    if not math.isfinite(needed):
        return []
    case = release_case(tan_alpha, release, spin, _SLIP_PERIODS, structure=structure)
    recess = reduced.simulate(case, rtol=_RTOL)
    rows: list[Row] = []
    for share in shares:
        run = multibody.simulate(replace(case, friction=share * needed))
        rows.append(
            {
                "needed": needed,
                "share": share,
                "friction": share * needed,
                "slip": float(run.slip[-1]) / case.cylinder.base_radius,
                "tilt_rms": tilt_rms(make_pair(case.cylinder, recess, run)),
                "outcome": run.outcome,
            }
        )
    return rows


SLIP = Part(
    name="slip",
    tasks=lambda extent: inputs_at(RELEASE, extent.slip_points, shares=extent.slip_shares),
    measure=measure_slip,
    keys=RELEASE,
    cost=lambda shares, **_: 0.5 * len(shares),
)
