from __future__ import annotations

import pickle

import numpy as np

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def test_an_unpickled_response_reuses_the_compiled_code():
    # compiled code that travels with a response would be compiled again where it arrives, for many seconds
    response = reduced.simulate(Case(PIER, initial=InitialState(tilt=0.1, rolling_rate=0.1), duration=1.0))
    sent = pickle.loads(pickle.dumps(response))
    assert (
        sent.source.problem.solve(np.empty(0))[0].peak == response.source.problem.solve(np.empty(0))[0].peak
    )
    assert sent.source.problem._set_up.integrate is response.source.problem._set_up.integrate


def test_a_deferred_field_is_the_same_before_and_after_a_journey():
    response = reduced.simulate(Case(PIER, initial=InitialState(tilt=0.1, rolling_rate=0.1), duration=1.0))
    sent = pickle.loads(pickle.dumps(response))
    np.testing.assert_array_equal(sent.centre_of_mass, response.centre_of_mass)
    assert sent.contact_point.shape == (len(sent.time), 2)
    assert sent.passes.equals(response.passes)
    assert sent.peak_displacement == response.peak_displacement == np.hypot(*response.displacement.T).max()
