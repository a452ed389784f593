"""Response to the 1940 El Centro record: against the printed equations, and what it must satisfy."""

import math

import numpy as np
import pytest
from paper_equations import PaperModel

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, el_centro_1940

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


@pytest.fixture(scope="module")
def response():
    return reduced.simulate(Case(PIER, el_centro_1940()), rtol=1e-10)


@pytest.mark.slow
def test_uplift_and_motion_follow_the_printed_equations(response):
    motion = el_centro_1940()
    paper = PaperModel(PIER.base_radius, PIER.half_height)
    uplift, direction, states = paper.excited(
        motion.acceleration, motion.time_step, 3.0, rtol=1e-10, start=1e-4
    )
    assert response.uplift_time == pytest.approx(uplift, abs=1e-12)
    assert response.uplift_direction == pytest.approx(direction, abs=1e-10)
    first = math.ceil(uplift / motion.time_step)
    ours = response.tilt[first : first + len(states)]
    # The reference starts 1e-4 s late without the lag of the contact, which oscillates on at 1e-8 rad; each
    # of the three passes at 3e-4 to 9e-4 rad multiplies a difference by ten or more.
    assert np.abs(ours - states[:, 0])[:20].max() <= 1e-8 * PIER.alpha
    assert np.abs(ours - states[:, 0]).max() <= 1e-6 * PIER.alpha


def test_it_stands_in_place_and_tips_about_its_rim(response):
    before = response.time < response.uplift_time
    assert not response.tilt[before].any()
    assert np.isnan(response.rolling_angle[before]).all()
    assert np.isnan(response.contact_point[before]).all()
    assert np.isfinite(response.contact_force).all()
    assert np.array_equal(response.centre_of_mass[0], [0.0, 0.0, PIER.mass_centre_height])
    # 1.5 ms after uplift the resultant passes through the contact point; the load is 0.3 % over the threshold
    just_after = int(np.argmax(response.tilt > 0.0))
    assert response.friction_needed[just_after] == pytest.approx(PIER.tan_alpha, rel=5e-3)
