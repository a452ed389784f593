"""Trajectories travel between processes."""

import pickle

from rockwobble import multibody
from rockwobble.models import Case, Cylinder, InitialState


def test_a_trajectory_survives_pickling():
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    initial = InitialState(0.5 * pier.alpha, rolling_rate=0.5)
    trajectory = multibody.simulate(Case(pier, initial=initial, duration=0.5))
    copy = pickle.loads(pickle.dumps(trajectory))
    assert (copy.tilt == trajectory.tilt).all()
    assert copy.settings == trajectory.settings
