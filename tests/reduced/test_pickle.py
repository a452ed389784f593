from __future__ import annotations

import pickle

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def test_a_response_is_the_same_after_a_journey_and_compiles_nothing():
    # compiled code that travels with a response would be compiled again where it arrives, for many seconds
    response = reduced.simulate(Case(PIER, initial=InitialState(tilt=0.1, rolling_rate=0.1), duration=1.0))
    sent = pickle.loads(pickle.dumps(response))
    there, here = (each.source.problem for each in (sent, response))
    assert there.solve(np.empty(0))[0].peak == here.solve(np.empty(0))[0].peak
    assert there._set_up.integrate is here._set_up.integrate
    np.testing.assert_array_equal(sent.centre_of_mass, response.centre_of_mass)
    assert sent.contact_point.shape == (len(sent.time), 2)
    assert sent.passes.equals(response.passes)
    assert sent.peak_displacement == response.peak_displacement == np.hypot(*response.displacement.T).max()
