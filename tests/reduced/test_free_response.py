"""Free response: conserved quantities, the reference tables, the paper's printed equations."""

import math

import numpy as np
import pytest
from accuracy_table import is_stated
from paper_equations import PaperModel
from stating import table

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState
from rockwobble.reduced.equations import energy

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
COUNT = 200
SIX_DECIMALS = 0.5e-6 + 1e-9  # the table is rounded to 6 decimals; exact solutions add rounding of 1e-13
SPINS = [1.0, 1e-1, 1e-3, 1e-6, 1e-9, 1e-12]


def release(cylinder, spin, tilt_over_alpha=0.5):
    return InitialState(tilt=tilt_over_alpha * cylinder.alpha, rolling_rate=spin)


@pytest.mark.parametrize("spin", SPINS)
def test_energy_and_momentum_are_conserved_in_every_step(spin):
    response = reduced.simulate(
        Case(PIER, initial=release(PIER, spin), duration=20.0), rtol=1e-10, rest_tilt=0.0
    )
    result, _ = response.source.problem.solve(np.empty(0), record_steps=True)
    body = response.source.problem.body
    energies = np.array([energy(body, *row[[1, 2, 4]], 0.0) for row in result.steps])
    # 20 s take some 5000 steps of tolerance 1e-10, mostly of one sign near upright
    assert np.ptp(energies) <= 1e-8 * energies[0]
    # L' is exactly zero without excitation
    assert np.ptp(result.steps[:, 4]) <= 1e-13 * result.steps[0, 4]
    assert response.outcome == "stands"


@pytest.mark.parametrize("model", ["recess", "flat"])
@pytest.mark.parametrize(
    "row", table("finite_release.csv"), ids=lambda row: f"{row['h_over_b']}-{row['phi_rate']}"
)
def test_turn_and_period_of_the_reference_table(model, row):
    name = {"flat": "rolling"}.get(model, model)  # name of the model in the table
    turn, period = float(row[f"{name}_turn_deg"]), float(row[f"{name}_period_s"])
    cylinder = Cylinder.from_dimensions(base_radius=1.0, height=2.0 * float(row["h_over_b"]))
    # the table's release: at rest in tilt, rolling rate phi_rate
    case = Case(cylinder, initial=release(cylinder, float(row["phi_rate"])), duration=4.0)
    response = reduced.simulate(case, rtol=1e-12, **reduced.MODELS[model])
    maxima = response.extrema[response.extrema[:, 3] > 0.0]
    # the table has six decimals: half a digit, and as much again for the tolerance
    assert math.degrees(response.passes.angle_of_turn[0]) == pytest.approx(turn, abs=2e-6)
    assert maxima[1, 0] - maxima[0, 0] == pytest.approx(period, abs=2e-6)
    if model == "recess":
        exact = reduced.free_response(cylinder, case.initial)
        assert math.degrees(exact.angle_of_turn) == pytest.approx(turn, rel=0.0, abs=SIX_DECIMALS)
        assert exact.period == pytest.approx(period, rel=0.0, abs=SIX_DECIMALS)


def test_period_and_turn_are_within_the_accuracy_of_the_readme():
    """Random cylinders, released at rest in tilt with spins from 1e-8 to that of steady wobble."""
    rng, errors = np.random.default_rng(0), []
    for _ in range(COUNT):
        tan_alpha, size = np.exp(rng.uniform(np.log([0.05, 0.1]), np.log([5.0, 50.0])))
        cylinder = Cylinder(semidiagonal=size, tan_alpha=tan_alpha)
        tilt = rng.uniform(0.1, 0.9) * cylinder.alpha
        fastest = 0.9 * reduced.steady_wobble_rate(cylinder, tilt)
        initial = InitialState(tilt, rolling_rate=math.exp(rng.uniform(math.log(1e-8), math.log(fastest))))
        exact = reduced.free_response(cylinder, initial)
        case = Case(cylinder, initial=initial, duration=1.01 * exact.period)
        response = reduced.simulate(case, rtol=1e-10, rest_tilt=0.0)
        maxima = response.extrema[response.extrema[:, 3] > 0.0]
        errors += [maxima[1, 0] / exact.period - 1.0, maxima[1, 2] / exact.angle_of_turn - 1.0]
    assert is_stated(np.max(np.abs(errors)), f"{COUNT} random cylinders", r"within (\S+)")


@pytest.mark.parametrize(("tan_alpha", "tilt_over_alpha"), [(0.1, 0.8), (0.2, 0.3), (1.0, 0.8), (3.0, 0.3)])
def test_recess_follows_the_printed_equations(tan_alpha, tilt_over_alpha):
    cylinder = Cylinder(semidiagonal=6.0, tan_alpha=tan_alpha)
    initial = release(cylinder, 0.5, tilt_over_alpha)
    response = reduced.simulate(Case(cylinder, initial=initial, duration=8.0), rtol=1e-11)
    paper = PaperModel(cylinder.base_radius, cylinder.half_height)
    reference = paper.free([initial.tilt, 0.0, 0.0, 0.5], response.time)
    # scipy at 1e-12 cannot do better near upright, where the printed sums cancel
    tolerance = 2e-8
    assert np.abs(response.tilt - reference[0]).max() <= tolerance * cylinder.alpha
    assert np.abs(response.rolling_angle - reference[2]).max() <= tolerance * 2.0 * math.pi


def test_steady_wobble_stays_at_its_tilt():
    tilt = 0.6 * PIER.alpha
    rate = float(2.0 * math.pi / reduced.wobbling_period(PIER, tilt))
    case = Case(PIER, initial=InitialState(tilt=tilt, rolling_rate=rate), duration=30.0)
    response = reduced.simulate(case, rtol=1e-11)
    # a balance with an error of the tolerance makes the tilt oscillate by the same amount
    assert np.abs(response.tilt - tilt).max() <= 1e-9 * tilt
    assert response.rolling_angle[-1] == pytest.approx(30.0 * rate, rel=1e-9)
    assert len(response.passes) == 0


def test_samples_do_not_influence_the_solution():
    coarse = reduced.simulate(Case(PIER, initial=release(PIER, 0.001), duration=10.0), sample_step=0.5)
    fine = reduced.simulate(Case(PIER, initial=release(PIER, 0.001), duration=10.0), sample_step=0.003)
    assert coarse.step_count == fine.step_count
    assert np.array_equal(coarse.extrema, fine.extrema)
    assert coarse.tilt[-1] == fine.tilt[-1]
