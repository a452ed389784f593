"""Motion with a tendon, with and without rolling resistance, against a separate integration by scipy."""

from __future__ import annotations

import numpy as np
import pytest
from tendon import Pier
from tied_motion import Model

import rockwobble as rw
from rockwobble import reduced

G = 9.81
PIER = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
STEEL = rw.Tendon(prestress=0.4, stiffness=3.0)


def model_of(case: rw.Case, plane: float | None) -> Model:
    cylinder, tendon = case.cylinder, case.tendon
    assert tendon is not None
    b = cylinder.base_radius
    pier = Pier(
        b=b,
        h=cylinder.mass_centre_height,
        slab=cylinder.slab_mass_ratio,
        prestress=tendon.prestress * G,
        stiffness=tendon.stiffness * G / b,
    )
    return Model(pier=pier, delta=case.rolling_resistance, plane=plane)


@pytest.mark.parametrize("slab", [0.0, 1.3], ids=["column", "frame"])
@pytest.mark.parametrize("share", [0.0, 0.01], ids=["lossless", "resisted"])
@pytest.mark.parametrize(
    ("plane", "tan_alpha"), [(None, 0.15), (None, 0.9), (0.0, 0.15), (0.0, 0.5)], ids=str
)
def test_a_release_follows_scipy(tan_alpha: float, plane: float | None, share: float, slab: float) -> None:
    column = rw.Cylinder(semidiagonal=3.0, tan_alpha=tan_alpha)
    body = rw.WobblingFrame(column, slab) if slab else column
    spin = 0.7 if plane is None else 0.0
    release = rw.InitialState(0.6 * column.alpha, rolling_rate=spin)
    length = share * column.base_radius
    case = rw.Case(body, initial=release, duration=3.0, tendon=STEEL, rolling_resistance=length)
    trace = reduced.simulate(case, plane=plane, rtol=1e-12)
    solution = model_of(case, plane).released(release.tilt, spin, trace.time)
    # planar motion that reverses meets the jump of the couple, which eps rounds
    limit = 2e-7 if share and plane is not None else 1e-9
    assert np.abs(trace.tilt - solution[:, 0]).max() < limit * column.alpha
    if plane is None:
        assert np.abs(trace.rolling_angle - solution[:, 2]).max() < 1e-8
    if share:
        lost = solution[:, 4] / (1.0 + 2.0 * slab)  # per unit of the mass that gravity moves
        assert lost[-1] > 1e-3 * trace.energy[0]
        assert np.abs(trace.energy_lost - lost).max() < 1e-8 * trace.energy[0]


@pytest.mark.slow
@pytest.mark.parametrize("slab", [0.0, 1.3], ids=["column", "frame"])
@pytest.mark.parametrize("share", [0.0, 0.01], ids=["lossless", "resisted"])
@pytest.mark.parametrize("plane", [None, 0.4], ids=["recess", "planar"])
def test_a_record_follows_scipy(plane: float | None, share: float, slab: float) -> None:
    body = rw.WobblingFrame(PIER, slab) if slab else PIER
    motion = rw.el_centro_1940(vertical=True).scaled(4.0)
    length = share * PIER.base_radius
    case = rw.Case(body, motion, duration=9.0, tendon=STEEL, rolling_resistance=length)
    trace = reduced.simulate(case, plane=plane, rtol=1e-12, sample_step=motion.time_step)
    uplift, times, solution = model_of(case, plane).shaken(motion.acceleration, motion.time_step, 9.0)
    assert trace.uplift_time == pytest.approx(uplift, abs=1e-11)
    same = np.searchsorted(trace.time, times - 1e-9)
    assert trace.tilt.max() > 0.2 * PIER.alpha
    assert np.abs(trace.tilt[same] - solution[:, 0]).max() < 1e-7 * PIER.alpha
