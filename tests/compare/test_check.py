"""Each check passes for a right subject, and fails for a fault of its kind."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from external_files import ANGLES, PLACE, TURN, columns
from faulty_subjects import answered, asked, field, larger, moved
from newton_euler import State, kinetic_energy, newton_euler, vector

import rockwobble as rw
from rockwobble import reduced
from rockwobble.compare import read_trajectory
from rockwobble.compare.check import (
    FAILED,
    GROUPS,
    NO_BASELINE,
    NOT_RUN,
    PASSED,
    Result,
    Subject,
    agreement,
    baseline,
    engine,
    external_model,
    invariance,
    lagrange,
    laws,
    reduced_model,
    restraint,
    run_checks,
    subject,
    trajectories,
)
from rockwobble.compare.check.cause import CANDIDATES, likely_cause
from rockwobble.compare.check.measurement import RELEASE as MEASURED_RELEASE
from rockwobble.models import Case, Cylinder, GroundMotion, InitialState, Tendon, Trace, WobblingFrame
from rockwobble.reduced.body import body_of

CYLINDER = Cylinder(semidiagonal=6.0, tan_alpha=0.4, transverse_inertia=9.0, axial_inertia=2.0)
SHAPE = lagrange.shape_of(CYLINDER)
ROUNDING = 1e-12


def heavier(case: Case) -> Case:
    return dataclasses.replace(case, gravity=1.001 * case.gravity, duration=case.length)


def lighter_slab(case: Case) -> Case:
    body = case.cylinder
    if isinstance(body, WobblingFrame):
        body = WobblingFrame(body.cylinder, 0.999 * body.slab_mass_ratio, body.columns)
    return dataclasses.replace(case, cylinder=body)


def other_tendon(prestress: float, stiffness: float) -> Callable[[Case], Case]:
    """Subject whose tendon has its constants multiplied by a factor."""

    def other(case: Case) -> Case:
        given = case.tendon
        if given is None:
            return case
        tendon = Tendon(prestress=prestress * given.prestress, stiffness=stiffness * given.stiffness)
        return dataclasses.replace(case, tendon=tendon, duration=case.length)

    return other


def alone(case: Case) -> Case:
    # a tendon without the gap at the slab
    return other_tendon(0.5, 0.25)(case) if case.cylinder.slab_mass_ratio > 0.0 else case


def vertical_reversed(motion: GroundMotion) -> GroundMotion:
    signs = [1.0, 1.0, -1.0][: motion.acceleration.shape[1]]
    return GroundMotion(motion.acceleration * signs, motion.time_step)


def held_after_its_end(motion: GroundMotion) -> GroundMotion:
    last = np.tile(motion.acceleration[-1:], (round(20.0 / motion.time_step) + 1, 1))
    return GroundMotion(np.vstack([motion.acceleration, last]), motion.time_step)


def less_resistance(case: Case) -> Case:
    return dataclasses.replace(case, rolling_resistance=(1.0 - 1e-6) * case.rolling_resistance)


def half_a_sample_late(motion: GroundMotion) -> GroundMotion:
    a = motion.acceleration
    return GroundMotion(np.vstack([a[:1], 0.5 * (a[1:] + a[:-1])]), motion.time_step)


def ends_a_sample_early(motion: GroundMotion) -> GroundMotion:
    a = motion.acceleration
    return GroundMotion(a[:-1], motion.time_step) if len(a) > 2 else motion


def one_sided(motion: GroundMotion) -> GroundMotion:
    return GroundMotion(motion.acceleration[:, :2] + [0.0, 1e-6], motion.time_step)


def lossy(right: Subject) -> Subject:
    # a model with an energy and no rates, so that no other check detects it
    loses = field("energy", lambda energy: energy * (1.0 - 1e-7 * np.arange(len(energy))))
    return dataclasses.replace(loses(right), knows=frozenset({"tilt", "energy"}))


heavy = asked(heavier)


@pytest.fixture(scope="module")
def right() -> Subject:
    return reduced_model()


@pytest.mark.parametrize("group", [name for name in GROUPS if name not in ("agreement", "order", "protocol")])
def test_the_reduced_models_pass_all_checks(right: Subject, group: str) -> None:
    results = list(run_checks(right, [group]))
    assert results
    assert len({result.name for result in results}) == len(results)
    assert [f"{each.name}: {each.value}, {each.note}" for each in results if each.outcome != PASSED] == []
    assert all(each.group == group and each.subject == "reduced model" and each.reason for each in results)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("measure", "support", "fault"),
    [
        (lagrange.residual, "recess", heavy),
        (lagrange.residual, "recess", field("contact_force", lambda force: force * [1.0, 1.0, 1.0 + 1e-8])),
        (lagrange.residual, "recess", field("tilt_rate", lambda rate: (1.0 + 1e-8) * rate)),
        (lagrange.residual, "recess", asked(lighter_slab)),
        (laws.free_response, "recess", asked(larger)),
        (laws.free_response, "recess", asked(lighter_slab)),
        (laws.steady_wobble, "flat", heavy),
        (laws.vanishing_spin, "recess", answered(lambda found: dataclasses.replace(
            found, passes=found.passes.assign(angle_of_turn=1.00001 * found.passes["angle_of_turn"])))),
        (laws.planar_rocking, "planar", heavy),
        (lagrange.free_motion, "recess", field("energy", lambda e: e * (1.0 + 1e-7 * np.arange(len(e))))),
        (lagrange.free_motion, "recess", lossy),
        (lagrange.free_motion, "recess", field("rolling_rate", lambda rate: 1.0001 * rate)),
        (lagrange.rolling_loss, "recess", asked(less_resistance)),
        (lagrange.rolling_loss, "recess", field("energy_lost", lambda lost: (1.0 + 1e-6) * lost)),
        (lagrange.work_of_the_ground, "flat", moved(vertical_reversed)),
        (lagrange.work_of_the_ground, "recess", moved(held_after_its_end)),
        (lagrange.work_of_a_record, "flat", moved(half_a_sample_late)),
        (laws.stands, "recess", moved(lambda motion: motion.scaled(1.02))),
        (laws.uplift, "recess", moved(lambda motion: motion.scaled(1.001))),
        (laws.uplift, "flat", moved(vertical_reversed)),
        (laws.force_at_rest, "recess", field("contact_force", lambda force: force * [1.0, 1.0, 0.9])),
        (laws.falls, "recess", field("peak_tilt", lambda peak: 0.9 * peak)),
        (invariance.frame, "recess", moved(one_sided)),
        (invariance.scale, "flat", answered(lambda found: dataclasses.replace(
            found, tilt=found.tilt + 1e-6 / found.case.cylinder.semidiagonal))),
        (invariance.statement, "recess", moved(half_a_sample_late)),
        (invariance.statement, "flat", moved(ends_a_sample_early)),
        (laws.place, "recess", field("twist", lambda twist: twist + 1e-6)),
        (laws.place, "recess", field("contact_point", lambda point: 1.0001 * point)),
        (laws.place, "recess", field("centre_of_mass", lambda place: 1.0001 * place)),
        (laws.turning, "recess", field("peak_tilt", lambda peak: 0.999 * peak)),
        (laws.turning, "flat", field("extrema", lambda rows: rows * [1.0001, 1.0, 1.0, 1.0])),
        (baseline.same_as_baseline, "recess", field("tilt", lambda tilt: tilt + 1e-6)),
        (baseline.same_as_baseline, "flat", field("twist", lambda twist: twist + 1e-6)),
        (lagrange.residual, "recess", asked(other_tendon(1.0, 1.0 + 1e-7))),
        (restraint.releases, "recess", asked(other_tendon(1.0 + 1e-7, 1.0))),
        (restraint.rocking, "planar", asked(other_tendon(1.0, 1.0 + 1e-6))),
        (restraint.stored_energy, "recess", asked(other_tendon(1.0 + 1e-6, 1.0))),
        (restraint.stored_energy, "recess", asked(alone)),
        (restraint.load_at_rest, "recess", asked(other_tendon(1.01, 1.0))),
        (restraint.raised_uplift, "recess", asked(other_tendon(1.0 + 1e-6, 1.0))),
        (restraint.raised_uplift, "planar", asked(other_tendon(0.0, 1.0))),
        (restraint.balance, "recess", asked(other_tendon(1.05, 1.05))),
    ],
)  # fmt: skip
def test_a_check_detects_a_fault_of_its_kind(right: Subject, measure: Any, support: str, fault: Any) -> None:
    assert not [result for result in measure(right, support) if result.failed]
    assert [result for result in measure(fault(right), support) if result.failed]


def test_a_subject_that_raises_fails_its_checks_and_others_run(right: Subject) -> None:
    def source(case: Case, *_: Any, **__: Any) -> Trace:
        raise ZeroDivisionError("division by zero")

    items = list(run_checks(dataclasses.replace(right, source=source), ["trace"]))
    assert [(each.failed, each.note) for each in items] == [(True, "ZeroDivisionError: division by zero")] * 3


PERIOD, RECORD = "period of a release, tan alpha = 0.2", "tilt and azimuth under El Centro"


def ours(case: Case, support: str) -> Trace:
    return reduced.simulate(case, support=support, rtol=1e-9, sample_step=case.length / 1000)


def without(*names: str) -> Callable[[Case, str], dict[str, Any]]:
    def model(case: Case, support: str) -> dict[str, Any]:
        trace = ours(case, support)
        columns = {"time": trace.time, "tilt": trace.tilt, "azimuth": trace.rolling_angle}
        return {
            name: column for name, column in {**columns, "energy": trace.energy}.items() if name not in names
        }

    return model


def outcomes(results: list[Result], outcome: str) -> set[str]:
    return {result.name.removesuffix(", recess") for result in results if result.outcome == outcome}


@pytest.mark.parametrize("support", ["recess", "flat"])
def test_a_right_external_model_passes_tightly(support: str) -> None:
    results = rw.check(model=without(), support=support, tolerance=1e-5).results
    assert outcomes(results, FAILED) == set()
    assert len(outcomes(results, PASSED)) > 12
    # a check of a missing field states it
    lacking = {"work of the ground", "uplift", "force at rest", "falls", "turning", "fields", "place"}
    assert outcomes(results, NOT_RUN) == lacking
    fewer = rw.check(model=without("azimuth", "energy"), support=support, only=["exact", "conserved"]).results
    assert {"free motion", "work of the ground"} == outcomes(fewer, NOT_RUN)
    assert (PERIOD in outcomes(fewer, PASSED)) == (support == "recess")


def of_another_size(case: Case, support: str) -> Trace:
    return ours(larger(case, 1.01), support)


def left_handed(case: Case, support: str) -> dict[str, Any]:
    trace = ours(case, support)
    azimuth = trace.rolling_angle if case.motion is None else -trace.rolling_angle
    return {"time": trace.time, "tilt": trace.tilt, "azimuth": azimuth}


def restless(case: Case, support: str) -> dict[str, Any]:
    trace = ours(case, support)
    return {"time": trace.time, "tilt": np.maximum(trace.tilt, 1e-3)}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("model", "fails", "holds"),
    [
        (of_another_size, {PERIOD, RECORD}, {"rotated, rocking"}),
        (left_handed, {RECORD}, {"angle of turn of a release, tan alpha = 0.2"}),
        (restless, {"tilt below the threshold of uplift"}, {PERIOD}),
    ],
)
def test_a_wrong_external_model_fails_at_its_fault(
    model: Callable[[Case, str], Any], fails: set[str], holds: set[str]
) -> None:
    checks = rw.check(model=model)
    assert fails <= outcomes(checks.results, FAILED)
    assert holds <= outcomes(checks.results, PASSED)
    assert list(checks.tables["results"]["name"]) == [each.name for each in checks.results]
    assert checks.headline()["FAILED"] == len(checks.failures) == len(outcomes(checks.results, FAILED))
    assert not checks.passed
    assert repr(checks).startswith("Checks(")
    assert f"{checks.failures[0].name} " in repr(checks)


def test_a_model_that_cannot_run_a_case_leaves_the_others_running() -> None:
    def only_releases(case: Case, support: str) -> Trace:
        if case.initial is None:
            raise NotImplementedError("it must be released")
        return ours(case, support)

    results = rw.check(model=only_releases).results
    notes = {each.name: each.note for each in results if "must be released" in each.note}
    assert notes == dict.fromkeys(
        [f"{name}, recess" for name in ("stands", "frame", "scale", "statement", "ramp", "record")],
        "NotImplementedError: it must be released",
    )  # fmt: skip
    assert "tilt and azimuth of a release" in outcomes(results, PASSED)


def test_a_model_that_returns_no_motion_is_reported() -> None:
    for result, reason in (
        ({"tilt": [0.1, 0.2]}, "must return time"),
        ({"time": [0.0, 1.0], "tilt": [0.1, math.nan]}, "finite numbers"),
        ({"time": [0.0, 0.0], "tilt": [0.1, 0.1]}, "time must rise"),
        ({"time": [0.0, 1.0], "tilt": [0.1]}, "as long as time"),
    ):
        model = external_model(lambda case, support, result=result: result)  # type: ignore[misc]
        results = list(run_checks(model, ["exact"]))
        assert results
        assert all(each.outcome == NOT_RUN and reason in each.note for each in results)


def test_a_model_is_loaded_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "my_rocking.py").write_text("def model(case, support):\n    return {}\n")
    monkeypatch.chdir(tmp_path)
    assert subject.load_model("my_rocking:model")(None, "recess") == {}  # type: ignore[arg-type]
    for name, reason in (("my_rocking", "module:function"), ("my_rocking:other", "cannot be imported")):
        with pytest.raises(ValueError, match=reason):
            subject.load_model(name)


RELEASE = Case(
    Cylinder(semidiagonal=6.0, tan_alpha=0.2), initial=InitialState(0.0987, 0.0, 0.3, 0.5), duration=5.0
)


def checked(place: Path, trace: Trace, names: list[str], **given: Any) -> list[Result]:
    columns(trace, spin=0.1)[names].iloc[:: given.pop("every", 1)].to_csv(place / "mine.csv", index=False)
    return list(run_checks(trajectories([read_trajectory(place / "mine.csv", RELEASE)], **given)))


@pytest.mark.parametrize("names", [ANGLES, ANGLES[:2], TURN], ids=["angles", "tilt", "quaternions"])
def test_a_trajectory_is_compared_as_far_as_one_motion_allows(tmp_path: Path, names: list[str]) -> None:
    # at its own samples, 0.03 s apart: interpolation is less exact
    results = checked(tmp_path, ours(RELEASE, "recess"), names, every=6, tolerance=1e-6)
    assert outcomes(results, PASSED) == {"tilt at release", "tilt and azimuth up to 5 s", "peak tilt"}
    assert len(results) == 3


def test_a_trajectory_of_another_body_fails_and_one_without_tilt_is_refused(tmp_path: Path) -> None:
    results = checked(tmp_path, of_another_size(RELEASE, "recess"), ANGLES)
    assert outcomes(results, FAILED) == {"tilt and azimuth up to 5 s"}
    with pytest.raises(ValueError, match="must have tilt, or qw, qx, qy and qz"):
        checked(tmp_path, ours(RELEASE, "recess"), ["time", *PLACE])


def scaled(name: str, scale: float) -> Callable[[Case, str], Trace]:
    """Model with an error in one number, or with a rolling resistance of `scale` b."""

    def model(case: Case, support: str) -> Trace:
        loss = scale * case.cylinder.base_radius
        wrong = (
            dataclasses.replace(case, rolling_resistance=loss)
            if name == "loss"
            else CANDIDATES[name](case, scale)
        )
        return reduced.simulate(wrong, support=support, sample_step=0.01)

    return model


@pytest.mark.slow
@pytest.mark.parametrize("name", [*CANDIDATES, "loss"])
def test_the_wrong_number_is_named(name: str) -> None:
    cases = [MEASURED_RELEASE, agreement.LOW_RELEASE, agreement.RAMP]
    for support, scale in (("recess", 1.05), ("flat", 0.98)):
        words = f"{name} {100.0 * (scale - 1.0):+.2g} %"
        if name == "loss":
            scale, words = 0.02, "a loss as of a rolling resistance of 0.02 b"
        subject = external_model(scaled(name, scale), support=support, tolerance=1e-5)
        assert likely_cause(subject, support, cases) == words


@pytest.mark.slow
def test_a_failure_names_its_cause_or_none() -> None:
    checks = rw.check(model=scaled("axial inertia", 1.05), tolerance=1e-5, only=["exact", "agreement"])
    assert checks.failures
    assert {each.cause for each in checks.failures} == {"axial inertia +5 %"}

    def noisy(case: Case, support: str) -> dict[str, np.ndarray]:
        trace = reduced.simulate(case, support=support, sample_step=0.01)
        noise = 1e-3 * np.random.default_rng(3).normal(size=len(trace.time))
        return {"time": trace.time, "tilt": trace.tilt + noise, "azimuth": trace.rolling_angle}

    checks = rw.check(model=noisy, tolerance=1e-5, only=["agreement"])
    assert {each.cause for each in checks.failures} == {""}


def kept_as(monkeypatch: pytest.MonkeyPatch, right: Subject, **changes: Any) -> baseline.Baseline:
    """Stored baseline with changed versions."""
    kept = baseline.read_baseline(right)
    older = dataclasses.replace(kept, reasons=(*kept.reasons[:-1], {**kept.reasons[-1], **changes}))
    monkeypatch.setattr(baseline, "read_baseline", lambda _: older)
    return older


def test_a_change_by_another_version_is_reported_and_no_failure(
    right: Subject, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept_as(monkeypatch, right, version="0.0.1", versions={"numpy": "1.0"})
    wrong = field("tilt", lambda tilt: tilt + 1e-6)(right)
    for model, outcome in ((right, PASSED), (wrong, NO_BASELINE)):
        results = list(baseline.same_as_baseline(model, "recess"))
        assert {each.outcome for each in results} == {outcome}
        for each in results:
            assert each.note.startswith("the baseline is of reduced model 0.0.1, this is ")
            assert (f"numpy 1.0 -> {np.__version__}" in each.note) == (model is wrong)


def test_a_subject_without_a_baseline_is_reported(right: Subject) -> None:
    (result,) = baseline.same_as_baseline(dataclasses.replace(right, label="another"), "recess")
    assert (result.outcome, result.note) == (NO_BASELINE, "no baseline for another")
    for given in ({"time_step": 1e-4}, {"iterations": 60}):
        (result,) = baseline.same_as_baseline(engine("mujoco", **given), "recess")
        assert (result.outcome, result.note) == (NOT_RUN, "kept at the default time step and settings")


def test_an_update_stores_the_reason_and_names_the_changes(
    right: Subject, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = baseline.read_baseline(right)
    first, second, *others = kept.fingerprint
    signals = {**first["signals"], "tilt": [2.0 * float(tilt or 0.0) for tilt in first["signals"]["tilt"]]}
    new = ({**first, "signals": signals}, second, *others[:-1])
    changed, gone = baseline.baseline_changes(kept, new, right)
    assert changed.startswith("changed; case: tilting; ")
    assert "quantity: tilt; time: 0.0; difference: 0.5; allowed: " in changed
    assert gone == f"gone: {others[-1]['name']}"
    assert baseline.baseline_changes(kept, kept.fingerprint, right) == []
    older = kept_as(monkeypatch, right, version="0.0.1")
    assert baseline.baseline_changes(older, kept.fingerprint, right) == ["version 0.0.1, now "]
    text = baseline.updated_baseline(kept, new, right, reason=" a  new kernel ", date="2026-11-21")
    stored = json.loads(text)
    assert stored["fingerprint"] == list(new)
    assert [each["reason"] for each in stored["reasons"]][-1] == "a new kernel"
    assert len(stored["reasons"]) == len(kept.reasons) + 1
    with pytest.raises(ValueError, match="a reason must be given"):
        baseline.updated_baseline(kept, new, right, reason="  ", date="2026-11-21")


def one(*values: float) -> Any:
    return tuple(np.array([value]) for value in values)


def state_of(*values: float) -> State:
    return State(*(vector(value)[0] for value in values))


def test_kinetic_energy_equals_the_vector_formula() -> None:
    theta, phi, theta_rate, phi_rate = 0.3, 1.1, 0.7, -0.9
    state = state_of(theta, theta_rate, phi, phi_rate, -phi_rate)
    for ratio in (0.0, 1.5):
        expected = kinetic_energy(body_of(CYLINDER, 9.81), state, ratio) / (1.0 + 2.0 * ratio)
        shape = lagrange.shape_of(WobblingFrame(CYLINDER, ratio))
        energy = lagrange.kinetic(shape, *one(theta, phi, theta_rate, phi_rate))[0]
        assert energy == pytest.approx(float(expected), rel=ROUNDING)


def test_accelerations_of_newton_and_euler_leave_no_residual() -> None:
    theta, phi, theta_rate, phi_rate = 0.5, -0.4, 0.3, 0.8
    ground, state = (1.1, -0.7, 0.4), state_of(theta, theta_rate, phi, phi_rate, -phi_rate)
    motion = newton_euler(body_of(CYLINDER, 9.81), state, vector(*ground), True)
    place, rates = one(theta, phi), one(theta_rate, phi_rate)

    def left(factor: float) -> list[float]:
        curves = one(factor * float(motion.theta), float(motion.phi))
        residuals = lagrange.residuals(SHAPE, place, rates, curves, np.array([ground]))
        return [float(abs(value[0])) for value in residuals]

    # rounding of differences 0.01 s apart, of energies of 60 m^2/s^2
    assert max(left(1.0)) < 1e-10
    assert left(1.01)[0] > 1e-2


def test_differences_are_exact_for_polynomials_and_good_for_sines() -> None:
    time = 0.05 * np.arange(17)
    assert lagrange.rate(time**5, 0.05) == pytest.approx(5.0 * time[6:-6] ** 4, rel=1e-10)
    assert lagrange.curve(np.sin(time), 0.05) == pytest.approx(-np.sin(time[6:-6]), abs=1e-12)


def test_quadratures_are_the_exact_solutions_of_the_package() -> None:
    tilt = 0.4 * CYLINDER.alpha
    _, turn = laws.period_and_turn(SHAPE, tilt, 0.3)
    # rounding of the energies near both ends
    stated = reduced.angle_of_turn(CYLINDER, InitialState(tilt=tilt, rolling_rate=0.3))
    assert turn == pytest.approx(stated, abs=1e-9)
    quarter = reduced.planar_quarter_period(CYLINDER, tilt)
    assert laws.planar_quarter(SHAPE, tilt) == pytest.approx(quarter, rel=1e-10)
    assert laws.steady_rate(SHAPE, tilt) == pytest.approx(
        reduced.steady_wobble_rate(CYLINDER, tilt), rel=ROUNDING
    )
    assert laws.tilt_inertia(SHAPE) == pytest.approx(9.0 + 36.0, rel=ROUNDING)


def test_only_a_failed_check_has_a_note() -> None:
    assert [invariance._holds("kept", right, "why").note for right in (True, False)] == ["", "why"]
