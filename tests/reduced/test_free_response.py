"""Free response: conserved quantities, the reference tables, the paper's printed equations."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from paper_equations import PaperModel

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState
from rockwobble.reduced.equations import energy

TABLES = Path(__file__).parents[1] / "reference"
PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
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


def rows_of_finite_release():
    lines = [line for line in (TABLES / "finite_release.csv").read_text().splitlines() if line[0] != "#"]
    return list(csv.DictReader(lines))


@pytest.mark.parametrize("model", ["recess", "flat"])
@pytest.mark.parametrize(
    "row", rows_of_finite_release(), ids=lambda row: f"{row['h_over_b']}-{row['phi_rate']}"
)
def test_turn_and_period_of_the_reference_table(model, row):
    h = float(row["h_over_b"])
    column = {"flat": "rolling"}.get(model, model)  # as the table names it
    cylinder = Cylinder.from_dimensions(base_radius=1.0, height=2.0 * h)
    # the table's release: at rest in tilt, rolling rate phi_rate
    initial = release(cylinder, float(row["phi_rate"]))
    response = reduced.simulate(
        Case(cylinder, initial=initial, duration=4.0), rtol=1e-12, **reduced.MODELS[model]
    )
    maxima = response.extrema[response.extrema[:, 3] > 0.0]
    # the table has six decimals: half a digit, and as much again for the tolerance
    assert math.degrees(response.passes.angle_of_turn[0]) == pytest.approx(
        float(row[f"{column}_turn_deg"]), abs=2e-6
    )
    assert maxima[1, 0] - maxima[0, 0] == pytest.approx(float(row[f"{column}_period_s"]), abs=2e-6)


@pytest.mark.parametrize("tan_alpha", [0.1, 0.2, 1.0, 3.0])
@pytest.mark.parametrize("tilt_over_alpha", [0.3, 0.8])
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
    response = reduced.simulate(
        Case(PIER, initial=InitialState(tilt=tilt, rolling_rate=rate), duration=30.0), rtol=1e-11
    )
    # an error of the tolerance in the balance makes the tilt oscillate by as much
    assert np.abs(response.tilt - tilt).max() <= 1e-9 * tilt
    assert len(response.passes) == 0


def test_samples_do_not_influence_the_solution():
    coarse = reduced.simulate(Case(PIER, initial=release(PIER, 0.001), duration=10.0), sample_step=0.5)
    fine = reduced.simulate(Case(PIER, initial=release(PIER, 0.001), duration=10.0), sample_step=0.003)
    assert coarse.step_count == fine.step_count
    assert np.array_equal(coarse.extrema, fine.extrema)
    assert coarse.tilt[-1] == fine.tilt[-1]
