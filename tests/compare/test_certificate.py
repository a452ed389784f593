"""Certificates: repeatability, chaos, changes, and claims."""

from __future__ import annotations

import csv
import dataclasses
import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from faulty_subjects import asked, larger, moved
from mutation.listed import mutations
from mutation.mutant import Fault, mutated
from mutation.places import at_assignment, scaled_argument

from rockwobble import reduced
from rockwobble.compare.check import Result
from rockwobble.compare.check.baseline import (
    certify,
    claims_of,
    models,
    verify,
    write_certificate,
)
from rockwobble.compare.check.fingerprint import cases_of, fingerprint, repeat, short_cases
from rockwobble.compare.check.measurement import Bound, at_most, not_run
from rockwobble.compare.check.verdict import (
    CHANGED,
    CHAOTIC,
    SAME,
    compare,
    compare_entries,
    late_peaks,
    main,
    read_certificate,
)
from rockwobble.models import Case, GroundMotion

pytestmark = pytest.mark.checkout

ROOT = Path(__file__).resolve().parents[2]
# every tenth fault in the sources of the recess model: all of them take minutes in the interpreter
STORED = ("reduced", "mujoco")
WRITTEN = 1e-11  # a signal is stored with twelve digits
# no signal of a certificate includes the force at the top of a column
FAULTS = [one for one in mutations() if one.faults and "at the top" not in one.name][::10]


@pytest.fixture(scope="module")
def certificate() -> dict[str, Any]:
    return certify(models(), [result("exact", "period", 1e-13, 1e-12)])


def result(group: str, name: str, value: float, bound: float) -> Result:
    return dataclasses.replace(at_most(name, value, Bound(bound, "a reason"), "the model"), group=group)


def without(certificate: dict[str, Any], *names: str) -> dict[str, Any]:
    """Certificate of an earlier version, or of an engine without slab or tendon."""
    entries = [one for one in certificate["fingerprint"] if one["name"] not in names]
    return certificate | {"fingerprint": entries}


def test_a_subject_has_only_the_cases_that_it_can_run() -> None:
    cases, features = short_cases(), models().features
    assert len(cases) == len({short.name for short in cases}) == len({short.term for short in cases}) == 15
    for lacking, gone in (
        ({}, {"ring"}),
        ({"supports": ("recess", "flat", "ring")}, set()),
        ({"features": features - {"slab"}}, {"ring", "frame"}),
        ({"features": features - {"tendon"}}, {"ring", "tendon"}),
        ({"supports": ("recess",)}, {"ring", "flat-ground"}),
        (
            {"features": features - {"uplift"}, "supports": ("flat", "ring")},
            {short.name for short in cases} - {"flat-ground", "ring"},
        ),
    ):
        subject = dataclasses.replace(models(), **lacking)  # type: ignore[arg-type]
        names = [short.name for short in cases_of(subject)]
        assert names == [short.name for short in cases if short.name not in gone]
        assert next(fingerprint(subject))["name"] == names[0]


def test_a_certificate_without_a_case_is_verified_by_its_others(certificate: dict[str, Any]) -> None:
    older = without(certificate, "frame", "tendon")
    assert verify(older).word == SAME
    unknown = older["fingerprint"][0] | {"name": "sliding"}
    with pytest.raises(ValueError, match="has a case sliding, this version has none: make it anew"):
        verify(older | {"fingerprint": [unknown]})


def test_one_percent_in_slab_or_tendon_changes_only_its_case(certificate: dict[str, Any]) -> None:
    faults = []
    for name in ("gamma", "w", "mu"):
        # a term of a cylinder alone is 1 with or without the fault
        heavier = f"{name} = {name} if gamma == 0.0 else 1.01 * {name}"
        faults.append(("frame", "body.py", at_assignment("body_of", name, heavier, after=True)))
    faults += [
        ("tendon", "restoring.py", scaled_argument("_tied_body", "TiedBody", name, 1.01))
        for name in ("prestress", "stiffness")
    ]
    for case, file, change in faults:
        with mutated(Fault(file=file, change=change)) as copy:
            answer = verify(certificate, models(copy))
        assert (answer.word, answer.case) == (CHANGED, case)


def test_the_signals_of_a_release_begin_at_its_tilt(certificate: dict[str, Any]) -> None:
    for short, one in zip(cases_of(models()), certificate["fingerprint"], strict=True):
        start = short.case.initial
        if start is not None:
            lean = math.sin(start.tilt) / math.sin(short.case.cylinder.alpha)
            along = [lean * math.cos(start.rolling_angle), lean * math.sin(start.rolling_angle)]
            begins = [one["signals"][name][0] for name in ("lean_x", "lean_y")]
            assert begins == pytest.approx(along, rel=WRITTEN), short.name


def test_a_certificate_follows_its_schema(certificate: dict[str, Any]) -> None:
    published = ROOT / "reports" / "published"
    schema = json.loads((published / "benchmark" / "schemas" / "certificate.schema.json").read_text())
    stored = (json.loads((published / "certificates" / f"{name}.json").read_text()) for name in STORED)
    for content in (certificate, *stored):
        jsonschema.validate(content, schema, cls=jsonschema.Draft202012Validator)
    claims = [{**certificate["claims"][0], "status": "validated"}]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({**certificate, "claims": claims}, schema, cls=jsonschema.Draft202012Validator)


def test_interpreted_kernels_give_the_same_fingerprint(certificate: dict[str, Any]) -> None:
    old = certificate["fingerprint"][:-1]  # the last case takes minutes in the interpreter
    with mutated() as copy:
        for one, new in zip(old, repeat(models(copy), old), strict=False):
            assert compare_entries(one, new).word == SAME, one["name"]
            # rounding is four digits below the allowed difference
            for name, wanted in one["signals"].items():
                apart = np.abs(np.array(wanted) - np.array(new["signals"][name]))
                assert (apart < 1e-3 * np.array(one["allowed"][name])).all()


@pytest.mark.slow
@pytest.mark.parametrize("mutation", FAULTS, ids=lambda mutation: mutation.name)
def test_a_fault_in_the_models_changes_its_claim_and_term(certificate: dict[str, Any], mutation: Any) -> None:
    with mutated(*mutation.faults) as copy:
        answer = verify(certificate, models(copy))
    assert answer.word == CHANGED, mutation.name
    assert answer.claim
    assert answer.term
    assert answer.exit_code == 1


def test_only_the_last_case_is_chaotic_with_peaks_of_copies(certificate: dict[str, Any]) -> None:
    *others, last = certificate["fingerprint"]
    assert all(one["agreement_time"] is None and "copies" not in one for one in others)
    assert last["agreement_time"] < 9.0
    assert len(last["copies"]) == 16


def test_rounding_and_differences_within_accuracy_are_no_change(certificate: dict[str, Any]) -> None:
    """A ground acceleration with a relative error in each sample, as from another version."""
    for size, words in ((1e-15, {SAME, CHAOTIC}), (3e-11, {CHAOTIC}), (1e-10, {CHAOTIC})):
        random = np.random.default_rng(17)

        def jittered(motion: GroundMotion, size: float = size, random: Any = random) -> GroundMotion:
            near = motion.acceleration * (1.0 + size * random.uniform(-1, 1, motion.acceleration.shape))
            return GroundMotion(near, motion.time_step)

        answer = verify(certificate, moved(jittered)(models()))
        assert answer.word in words, str(answer)
        assert answer.exit_code == 0
        if answer.word == CHAOTIC:
            assert answer.case == "close-passes"
            assert answer.time >= certificate["fingerprint"][-1]["agreement_time"]


def test_a_body_a_thousandth_too_large_is_a_change(certificate: dict[str, Any]) -> None:
    answer = verify(certificate, asked(larger)(models()))
    assert (answer.word, answer.case, answer.exit_code) == (CHANGED, "tilting", 1)


def test_copies_are_computed_only_where_something_differs(certificate: dict[str, Any]) -> None:
    runs: list[Case] = []

    def counted(case: Case) -> Case:
        runs.append(case)
        return case

    assert verify(certificate, asked(counted)(models())).word == SAME
    assert len(runs) == 14


def test_late_peaks_are_those_after_the_agreement_time() -> None:
    """The start of a release is its largest tilt, and is no late peak."""
    sample: Any = {
        "time": [0.0, 1.0, 2.0, 3.0],
        "copies": [[0.5, 0.1, 0.2, 0.3], [0.5, 0.0], [0.5, 0.1, 0.4]],
    }
    assert late_peaks(sample, 2.0).tolist() == [0.3, 0.0, 0.4]


def test_changed_peaks_after_the_agreement_time_are_a_change(certificate: dict[str, Any]) -> None:
    last = certificate["fingerprint"][-1]
    late = np.array(last["time"]) >= last["agreement_time"]
    signals = {
        name: [value + 10.0 * far for value, far in zip(values, late.tolist(), strict=True)]
        for name, values in last["signals"].items()
    }
    alike, other = last | {"signals": signals}, [[3.0 * tilt for tilt in copy] for copy in last["copies"]]
    assert compare_entries(last, alike).word == CHAOTIC
    answer = compare_entries(last, alike | {"copies": other})
    assert answer.word == CHANGED
    assert answer.quantity == "distribution of the late peaks"


def test_the_first_change_is_named_and_nothing_after_it_runs(certificate: dict[str, Any]) -> None:
    seen = []

    def entries() -> Any:
        for one in certificate["fingerprint"]:
            seen.append(one["name"])
            signals = dict(one["signals"])
            if one["name"] == "rolling":
                signals["force_y"] = [value + 1e-3 for value in signals["force_y"]]
            yield one | {"signals": signals}

    answer = compare(certificate["fingerprint"], entries())
    assert (answer.word, answer.case, answer.quantity) == (CHANGED, "rolling", "force_y")
    assert answer.difference == pytest.approx(1e-3)
    assert seen == ["tilting", "rolling"]


def test_a_motion_that_ends_earlier_is_a_change(certificate: dict[str, Any]) -> None:
    one = certificate["fingerprint"][0]
    shorter = {name: values[:-5] for name, values in one["signals"].items()}
    assert compare_entries(one, one | {"signals": shorter}).word == CHANGED


HEAD: dict[str, Any] = {"kind": "rockwobble certificate", "format": 3, "method": {}}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ([], "is no certificate: its kind must be 'rockwobble certificate'"),
        ({"kind": "something"}, "is no certificate: its kind must be 'rockwobble certificate'"),
        (HEAD | {"format": "3"}, "is no whole certificate: it has no format"),
        (HEAD | {"method": None}, "is no whole certificate: it has no method"),
        (HEAD, "is no whole certificate: its fingerprint must be a list of cases"),
        (HEAD | {"fingerprint": [1]}, "is no whole certificate: its fingerprint must be a list of cases"),
        (HEAD | {"fingerprint": [{}]}, "it has no agreement_time in case 1 of its fingerprint"),
        (HEAD | {"format": 2}, "has format 2, this version reads 3"),
    ],
)
def test_a_truncated_certificate_is_refused(
    content: Any, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "part.json"
    path.write_text(json.dumps(content))
    with pytest.raises(ValueError, match=words):
        read_certificate(path)
    whole = str(ROOT / "reports" / "published" / "certificates" / "reduced.json")
    assert main([whole, str(path)]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.slow
def test_certificates_are_read_with_numpy_alone(certificate: dict[str, Any], tmp_path: Path) -> None:
    program = ROOT / "compare" / "check" / "verdict.py"
    off = json.loads(json.dumps(certificate))
    off["fingerprint"][2]["signals"]["tilt"][5] += 1e-3
    write_certificate(certificate, tmp_path / "one.json")
    write_certificate(off, tmp_path / "other.json")

    def run(*names: str) -> subprocess.CompletedProcess[str]:
        paths = [str(tmp_path / name) for name in names]
        command = [sys.executable, "-I", str(program), *paths]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    older = {**certificate, "format": certificate["format"] - 1}
    (tmp_path / "older.json").write_text(json.dumps(older))
    write_certificate(without(certificate, "frame"), tmp_path / "no frame.json")
    assert run("no frame.json", "one.json").returncode == 0
    for names in (("older.json", "one.json"), ("one.json", "no frame.json")):
        refused = run(*names)
        assert refused.returncode == 2
        assert "anew" in refused.stderr
    same, changed, bad = run("one.json", "one.json"), run("one.json", "other.json"), run("one.json", "none")
    assert (same.returncode, same.stdout.strip()) == (0, "same")
    assert changed.returncode == 1
    assert changed.stdout.startswith("changed; case: near-pass; ")
    assert bad.returncode == 2


def test_claims_on_releases_match_their_table() -> None:
    """Table of docs/published/certificates.md: chaotic and repeatable cases, and their differences."""
    path = ROOT / "reports" / "published" / "certificates" / "releases.csv"
    rows = list(csv.DictReader(path.read_text().splitlines()))
    assert len(rows) == 12 * 6
    assert all(float(row["of_allowed"]) < 1.0 for row in rows)

    def largest(quantity: str, **given: str) -> float:
        chosen = [row for row in rows if given.items() <= row.items()]
        return max(float(row[quantity]) for row in chosen)

    chaotic = [row for row in rows if row["word"] != SAME]
    assert {row["word"] for row in chaotic} == {CHAOTIC}
    assert {row["verified"] for row in chaotic} == {"3.3.7", "3.10.0", "3.17.0"}
    assert {(row["engine"], row["case"], row["agreement_time"]) for row in chaotic} == {
        ("mujoco", "planar", "1.2")
    }
    assert largest("after", case="planar") == 0.44
    assert largest("tilt_after", case="planar") == 0.0015
    landing = {"resting", "close-passes", "planar"}
    assert (
        1e-7 < max(largest("before", case=row["case"]) for row in rows if row["case"] not in landing) < 2e-7
    )
    assert 0.2 < max(largest("before", case=case) for case in landing) < 0.3
    assert {row["python"][:4] for row in rows if row["engine"] == "reduced"} == {"3.12", "3.13"}
    for engine in ("dart", "reduced"):
        assert largest("before", engine=engine) == largest("after", engine=engine) == 0.0


def test_results_become_claims_and_missing_ones_are_stated() -> None:
    found = [
        result("exact", "period", 1e-13, 1e-12),
        result("agreement", "peak", 1e-3, 1e-2),
        result("protocol", "samples", 0.0, 0.0),
        not_run("peak, pybullet", "not installed here"),
    ]
    claims, not_covered = claims_of(found)
    assert [claim["status"] for claim in claims] == ["verified", "cross-validated"]
    assert "peak, pybullet: not installed here" in not_covered
    assert any("no experiment" in point for point in not_covered)
    with pytest.raises(ValueError, match="nothing is certified"):
        claims_of([result("exact", "period", 1.0, 1e-12)])


def test_the_fingerprint_is_that_of_the_installed_model() -> None:
    one = next(fingerprint(models()))
    short = short_cases()[0]
    trace = reduced.simulate(short.case, support=short.support, sample_step=short.case.length / 40)
    assert one["signals"]["tilt"][-1] == pytest.approx(trace.tilt[-1] / trace.case.cylinder.alpha, rel=1e-11)
