"""Releases on the balance and next to it: fall, return, or undecided by rounding."""

import math

import pytest

from rockwobble.models import Case, Cylinder, InitialState, Tendon, Trace, WobblingFrame
from rockwobble.reduced import balance_tilt_of_case, simulate
from rockwobble.reduced.body import body_of

SHAPES = [(0.5, 0.05), (2.0, 0.2), (math.hypot(0.5, 2.5), 0.2), (30.0, 1.0)]


def case(
    size: float, tan_alpha: float, tilts: float, times: float, *, slab: float = 0.0, **start: float
) -> Case:
    """A release at some tilt over alpha, with a duration in 1/p."""
    cylinder = WobblingFrame(Cylinder(semidiagonal=size, tan_alpha=tan_alpha), slab)
    duration = times / body_of(cylinder, 9.81).p
    return Case(cylinder, initial=InitialState(tilts * cylinder.alpha, **start), duration=duration)


@pytest.mark.parametrize("times", [1.0, 17.0, 200.0])
@pytest.mark.parametrize(("size", "tan_alpha"), SHAPES)
def test_a_body_at_balance_is_undecided_for_any_duration(size: float, tan_alpha: float, times: float) -> None:
    for slab in (0.0, 1.0):
        trace = simulate(case(size, tan_alpha, 1.0, times, slab=slab))
        assert trace.outcome == "undecided"
        assert math.isnan(trace.peak_tilt)
        assert [fact.code for fact in trace.facts] == ["undecided"]


@pytest.mark.parametrize("support", ["recess", "flat"])
@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize(("size", "tan_alpha"), SHAPES)
def test_a_release_on_either_side_of_the_balance_falls_or_returns(
    size: float, tan_alpha: float, distance: float, support: str
) -> None:
    for times in (1.0, 15.0, 200.0):
        above = simulate(case(size, tan_alpha, 1.0 + distance, times), support=support)
        assert (above.outcome, above.peak_tilt) == ("overturned", 0.5 * math.pi)
    below = case(size, tan_alpha, 1.0 - distance, 1.0)
    trace = simulate(below, support=support)
    assert (trace.outcome, trace.peak_tilt) == ("stands", below.initial.tilt if below.initial else 0.0)


@pytest.mark.parametrize("support", ["recess", "flat"])
@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-9, 1e-12])
def test_a_release_below_the_balance_never_falls(distance: float, support: str) -> None:
    # undamped, each swing returns to the balance, which the error of the solution may exceed
    for times in (10.0, 17.0, 30.0, 60.0, 200.0):
        for rate in (0.0, 1e-7):
            trace = simulate(case(2.0, 0.2, 1.0 - distance, times, rolling_rate=rate), support=support)
            assert trace.outcome in ("stands", "undecided")
            assert trace.outcome == "undecided" or trace.peak_tilt <= trace.case.cylinder.alpha


def test_rolling_resistance_holds_a_body_on_its_balance() -> None:
    on = case(2.0, 0.2, 1.0, 100.0)
    trace = simulate(Case(on.cylinder, initial=on.initial, duration=on.duration, rolling_resistance=0.01))
    assert (trace.outcome, trace.peak_tilt) == ("stands", trace.tilt[0])


@pytest.mark.parametrize("slab", [0.0, 1.3])
@pytest.mark.parametrize("tendon", [Tendon(prestress=0.5), Tendon(prestress=0.3, stiffness=1.0)])
def test_a_tendon_moves_the_balance_away_from_alpha(tendon: Tendon, slab: float) -> None:
    pier = WobblingFrame(Cylinder(semidiagonal=6.0, tan_alpha=0.2), slab)

    def released(tilt: float) -> Trace:
        return simulate(Case(pier, initial=InitialState(tilt), duration=10.0, tendon=tendon))

    balance = balance_tilt_of_case(Case(pier, initial=InitialState(0.1), duration=1.0, tendon=tendon))
    assert balance > 1.2 * pier.alpha
    ends = [released(share * balance).outcome for share in (0.99, 1.0, 1.01)]
    assert ends == ["stands", "undecided", "overturned"]
    back = released(pier.alpha)
    assert (back.outcome, back.peak_tilt) == ("stands", pier.alpha)


@pytest.mark.parametrize("excess", [-1e-3, -1e-6, 1e-6, 1e-4, 3e-4, 1e-3])
@pytest.mark.parametrize(
    ("size", "tan_alpha", "prestress", "stiffness"),
    [(6.0, 0.2, 0.5, 8.0), (6.0, 0.3, 0.5, 5.0), (17.5, 0.441, 1.96, 3.194)],
)
def test_energy_at_ninety_degrees_alone_decides_without_a_balance(
    size: float, tan_alpha: float, prestress: float, stiffness: float, excess: float
) -> None:
    pier = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
    tied = Tendon(prestress=prestress, stiffness=stiffness)
    b, g = pier.base_radius, 9.81

    def potential(tilt: float) -> float:
        gap = 2.0 * math.sin(0.5 * tilt)  # [b]
        spring = b * g * (prestress * gap + 0.5 * stiffness * gap**2)
        return g * (b * math.sin(tilt) + pier.half_height * math.cos(tilt)) + spring

    start, side = 0.5 * pier.alpha, 0.5 * math.pi
    barrier = (1.0 + excess) * potential(side) - potential(start)
    rate = math.sqrt(2.0 * barrier / body_of(pier, g).A)
    release = Case(pier, initial=InitialState(start, tilt_rate=rate), duration=20.0, tendon=tied)
    assert math.isinf(balance_tilt_of_case(release))
    trace = simulate(release)
    assert trace.outcome == ("overturned" if excess > 0.0 else "stands")
    assert trace.peak_tilt <= side
    assert trace.tilt.max() <= side
