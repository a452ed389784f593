"""Free response: recess against flat ground, what the recess needs, and an engine at some of the releases."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from rockwobble import multibody, reduced
from rockwobble.models import Assumptions, Case, Run, Trace
from rockwobble.multibody import DEFAULT_ENGINE

from ...metrics.pair import make_pair, tilt_rms
from ...runs.choice import SUPPORTS, own_model
from ...runs.execution import simulate_run
from .plan import Extent, Inputs, Part, Row, release_case

_RTOL = 1e-10
_CYCLES = 10.0  # over which the flat-ground model may gather tilt
_MAXIMUM = 1.0  # in the fourth column of `Trace.extrema`


def _free_response_tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha in extent.tan_alphas:
        yield {"tan_alpha": tan_alpha, "releases": extent.releases, "spins": extent.spins}


def measure_free_response(tan_alpha: float, releases: Sequence[float], spins: Sequence[float]) -> list[Row]:
    """Return one row for each release and spin.

    The columns: tan_alpha, release, spin; period [s] and turn [rad] from tilt maximum to next maximum, exact
    (recess) and integrated (flat_period, flat_turn; NaN where it overturns first), flat_peak, the
    largest tilt of the flat-ground model in ten periods over the release; needs of the recess model in one
    period: friction, least_normal [weights], moment, the restraining moment over weight and base radius.
    """
    return [_row(tan_alpha, release, spin) for release in releases for spin in spins]


def _row(tan_alpha: float, release: float, spin: float) -> Row:
    case = release_case(tan_alpha, release, spin)
    assert case.initial is not None
    exact = reduced.free_response(case.cylinder, case.initial)
    flat = reduced.simulate(replace(case, duration=_CYCLES * exact.period), support="flat", rtol=_RTOL)
    period, turn = next_maximum(flat)
    needs = needs_of(case)
    return {
        "release": release,
        "spin": spin,
        "period": exact.period,
        "flat_period": period,
        "turn": exact.angle_of_turn,
        "flat_turn": turn,
        "flat_peak": flat.peak_tilt / case.initial.tilt,
        "friction": needs.largest_friction_needed,
        "least_normal": needs.least_normal_force,
        "moment": needs.largest_restraining_moment / case.cylinder.base_radius,
    }


def next_maximum(trace: Trace) -> tuple[float, float]:
    """Return time and rolling angle from the release, a tilt maximum, to the next; NaN if there is none."""
    maxima = trace.extrema[trace.extrema[:, 3] == _MAXIMUM]
    if len(maxima) < 2:
        return math.nan, math.nan
    return float(maxima[1, 0] - maxima[0, 0]), float(maxima[1, 2] - maxima[0, 2])


def needs_of(case: Case) -> Assumptions:
    """Return the needs of the recess model of ground and recess in a case."""
    needs = reduced.simulate(case, rtol=_RTOL).assumptions
    assert needs is not None
    return needs


FREE_RESPONSE = Part(
    name="free_response",
    title="free response, recess against flat ground",
    tasks=_free_response_tasks,
    measure=measure_free_response,
    keys=("tan_alpha",),
    cost=lambda releases, spins, **_: 0.02 * len(releases) * len(spins),
)


_VERIFIED_PERIODS = 2.2  # the second maximum, and a little more, so that it is seen to be one
_FRICTION = 10.0  # whatever the motion needs: friction is another limit


def _verification_tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha, release, spin in extent.engine_points:
        yield {"tan_alpha": tan_alpha, "release": release, "spin": spin}


def measure_verification(tan_alpha: float, release: float, spin: float) -> list[Row]:
    """Return a row for each support: what model and engine say of the first pass, and how far tilts differ.

    The columns: tan_alpha, release, spin, support; turn, engine_turn [rad], half_period, engine_half_period
    [s] to the first tilt minimum; tilt_rms over alpha; resolved, whether the contact of the engine resolves
    the pass; outcome.
    """
    case = replace(release_case(tan_alpha, release, spin, _VERIFIED_PERIODS), friction=_FRICTION)
    rows: list[Row] = []
    for support in SUPPORTS:
        trial = Run(DEFAULT_ENGINE, support)
        own = simulate_run(case, Run(None, own_model(trial).support, rtol=1e-10))
        run = simulate_run(case, trial)
        passes, own_passes = run.passes, own.passes
        rows.append(
            {
                "support": support,
                "turn": next_maximum(own)[1],
                "engine_turn": float(passes["angle_of_turn"].iloc[0]) if len(passes) else math.nan,
                "half_period": float(own_passes["time"].iloc[0]) if len(own_passes) else math.nan,
                "engine_half_period": float(passes["time"].iloc[0]) if len(passes) else math.nan,
                "tilt_rms": tilt_rms(make_pair(case.cylinder, own, run)),
                "resolved": bool(passes["resolved"].iloc[0]) if len(passes) else False,
                "outcome": run.outcome,
            }
        )
    return rows


VERIFICATION = Part(
    name="verification",
    title="free response in the engine",
    tasks=_verification_tasks,
    measure=measure_verification,
    keys=("tan_alpha", "release", "spin"),
    cost=lambda **_: 1.5,
    engine=DEFAULT_ENGINE,
)


_SLIP_PERIODS = 1.1  # one pass: the friction of the next is the same


def _slip_tasks(extent: Extent) -> Iterable[Inputs]:
    for tan_alpha, release, spin in extent.slip_points:
        yield {"tan_alpha": tan_alpha, "release": release, "spin": spin, "shares": extent.slip_shares}


def measure_slip(tan_alpha: float, release: float, spin: float, shares: Sequence[float]) -> list[Row]:
    """Return a row for each friction, as a share of what the recess model needs.

    The columns: tan_alpha, release, spin, needed, share, friction, slip of the engine in a recess in one
    period [b], tilt_rms against the recess model over alpha, outcome. No row where the model loses contact:
    no friction is enough.
    """
    needed = needs_of(release_case(tan_alpha, release, spin)).largest_friction_needed
    if not math.isfinite(needed):
        return []
    case = release_case(tan_alpha, release, spin, _SLIP_PERIODS)
    recess = reduced.simulate(case, rtol=1e-10)
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
    title="the friction at which the engine slips",
    tasks=_slip_tasks,
    measure=measure_slip,
    keys=("tan_alpha", "release", "spin"),
    cost=lambda shares, **_: 0.5 * len(shares),
    engine=multibody.DEFAULT_ENGINE,
)
