"""References and differences by the mode of motion: a slide, and an impact in one plane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rockwobble as rw
from rockwobble import reduced
from rockwobble.compare.metrics.pair import agreement_of, displacement_difference, make_pair, start_of
from rockwobble.compare.runs.choice import models_of, own_model_of

CASK = rw.Cylinder(semidiagonal=3.0, tan_alpha=0.5)
AROUND = rw.GroundMotion(np.array([[0, 0], [0, 0], [6, 0], [0, 6], [-6, 0], [0, 0]]), 0.25)
ALONG = rw.GroundMotion(np.outer([0, 6, -6, 0], [0.6, 0.8]), 0.25)


def test_reference_follows_the_mode() -> None:
    flat, recess, ring = (rw.Run("mujoco", support) for support in ("flat", "recess", "ring"))
    slides, rocks = (rw.Case(CASK, AROUND, friction=friction) for friction in (0.3, 2.0))
    assert models_of(slides, flat) == (rw.Run(None, "flat"),)
    assert models_of(slides, recess) == (rw.Run(None, "recess"),)
    assert models_of(rocks, flat) == (rw.Run(None, "recess"), rw.Run(None, "flat"))
    plane = rw.Case(CASK, ALONG, friction=2.0)
    for run in (flat, recess, ring):
        (model,) = models_of(plane, run)
        assert own_model_of(plane, run) == model
        assert (model.settings["restitution"], model.settings["plane"]) == ("momentum", np.arctan2(0.8, 0.6))
    assert models_of(plane, rw.Run(None, "flat")) == rw.Run(None, "flat").compared_with
    released = replace(plane, initial=rw.InitialState(0.1))
    assert models_of(released, flat) == flat.compared_with


def test_slides_diverge_by_a_share_of_the_peak_displacement() -> None:
    case = rw.Case(CASK, AROUND, friction=0.3)
    slide = reduced.simulate(case, support="flat")
    assert start_of(slide) == pytest.approx(0.25 + 0.25 * 0.3 * 9.81 / 6, abs=0.01)
    for share, diverges in ((0.009, False), (0.011, True)):
        farther = replace(slide, centre_of_mass=slide.centre_of_mass * [1.0 + share, 1.0 + share, 1.0])
        assert displacement_difference(make_pair(CASK, slide, farther)) == pytest.approx(share)
        assert agreement_of(slide, farther).diverged == diverges
        assert agreement_of(slide, farther).tested


def test_engine_closes_as_the_planar_model_by_momentum() -> None:
    case = rw.Case(CASK, ALONG.scaled(1.5), friction=2.0, duration=1.5)
    comparison = rw.comparison(case, runs=[rw.Run("mujoco", "flat", 2e-4)], workers=1)
    (row,) = comparison.summary.itertuples()
    assert (row.reference, row.mode) == ("planar model by momentum", "rocks in one plane")
    assert {label for _, label in comparison.traces} == {row.run, row.reference}  # that model is also its own
    assert not row.diverged
    assert row.peak_tilt_difference == pytest.approx(0.0, abs=0.005)  # of 0.13 alpha
