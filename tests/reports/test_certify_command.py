"""`rockwobble certify`, `verify`, `check --model` and `check --trajectory`, and the item of pytest."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
from showing import call

from rockwobble.compare.check import Result, Subject
from rockwobble.compare.check import baseline as certificate_package

pytest_plugins = ["pytester"]
Run = Callable[..., int]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    monkeypatch.chdir(tmp_path)

    return call


@pytest.fixture(scope="module")
def certificate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("certified") / "certificate.json"
    assert call("certify", "--only", "conserved", "--out", str(path)) == 0
    return path


def changed(certificate: Path, folder: Path) -> Path:
    stored = json.loads(certificate.read_text())
    stored["fingerprint"][5]["signals"]["tilt"][30] += 1e-5
    path = folder / "changed.json"
    path.write_text(json.dumps(stored))
    return path


def test_certificate_lists_verified_claims_and_what_is_not_covered(certificate: Path) -> None:
    stored = json.loads(certificate.read_text())
    assert len(stored["fingerprint"]) == 14
    assert {claim["status"] for claim in stored["claims"]} == {"verified"}
    assert all(claim["measured"] <= claim["bound"] for claim in stored["claims"])
    assert any("no experiment" in point for point in stored["not_covered"])
    assert {"python", "numpy", "rockwobble"} <= set(stored["versions"])


def test_verify_prints_one_verdict_with_its_exit_code(
    run: Run, certificate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("verify", str(certificate)) == 0
    assert capsys.readouterr().out.startswith("same; versions")
    assert run("verify", str(changed(certificate, tmp_path)), "--json") == 1
    answer = json.loads(capsys.readouterr().out)
    verdict, versions = answer["findings"]
    assert (verdict["key"], verdict["level"]) == ("certificate.changed", "not satisfied")
    assert verdict["values"]["name_quantity"]["value"] == "tilt"
    assert verdict["values"]["name_term"]["value"]
    assert versions["key"] == "certificate.same_versions"
    older = json.loads(certificate.read_text())
    older["versions"] |= {"numpy": "1.0", "mujoco": "0.1"}  # unrelated engine
    (tmp_path / "older.json").write_text(json.dumps(older))
    assert run("verify", str(tmp_path / "older.json")) == 0
    said = capsys.readouterr().out
    assert re.fullmatch(r"same; versions: numpy 1\.0 -> [^,]+\n", said)


def test_nothing_is_certified_where_a_check_fails(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    failed = Result(group="conserved", name="energy", value=2.0, bound=1.0, reason="", outcome="FAILED")
    monkeypatch.setattr("rockwobble.compare.check.run_checks", lambda *_, **__: iter([failed]))
    assert run("certify") == 1
    assert "certified: energy" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_certified_without_a_claim() -> None:
    with pytest.raises(ValueError, match="a certificate needs a claim"):
        certificate_package.certify(certificate_package.models(), [])


@pytest.mark.slow
def test_certificate_of_an_engine_has_only_claims_of_that_engine(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    claims: list[Result] = []

    def make(_: Subject, results: Iterable[Result], __: object) -> dict[str, list[str]]:
        claims.extend(results)
        return {"claims": [], "fingerprint": []}

    monkeypatch.setattr(certificate_package, "certify", make)
    assert run("certify", "--engine", "mujoco", "--only", "conserved") == 0
    assert {result.subject for result in claims} == {"mujoco"}


def test_pytest_has_an_item_for_the_certificate(pytester: pytest.Pytester, certificate: Path) -> None:
    result = pytester.runpytest_inprocess("--rockwobble-certificate", str(certificate))
    result.assert_outcomes(passed=1)
    other = changed(certificate, pytester.path)
    result = pytester.runpytest_inprocess("--rockwobble-certificate", str(other))
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*changed: tilt of*"])


MODEL = """
from rockwobble import reduced

def good(case, support):
    trace = reduced.simulate(case, support=support, sample_step=case.length / 1000)
    return {"time": trace.time, "tilt": trace.tilt, "azimuth": trace.rolling_angle}

def wrong(case, support):
    return {**good(case, support), "tilt": 1.01 * good(case, support)["tilt"]}
"""


@pytest.mark.slow
def test_external_model_is_checked(run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "rocking_of_mine.py").write_text(MODEL)
    assert run("check", "--model", "rocking_of_mine:good", "--json", "good.json") == 0
    assert "return energy" in capsys.readouterr().out
    assert run("check", "--model", "rocking_of_mine:wrong") == 1
    assert "FAILED" in capsys.readouterr().out
    stored = json.loads((tmp_path / "good.json").read_text())
    assert "of a release" in json.dumps(stored)
    groups = {result["group"] for result in stored["results"]}
    assert groups == {"exact", "conserved", "rest", "invariance", "trace", "agreement"}


def test_external_trajectory_is_checked(run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "one.suite.toml").write_text(
        '[[runs]]\nengine = "mujoco"\nsupport = "recess"\n[[cases]]\nname = "release"\n'
        "cylinder = { semidiagonal = 6, tan_alpha = 0.2 }\n"
        "release = { tilt_over_alpha = 0.5, rolling_rate = 0.5 }\nduration = 5\n"
    )
    from rockwobble import reduced
    from rockwobble.models import read_suite

    (case,) = read_suite(str(tmp_path / "one.suite.toml")).cases
    trace = reduced.simulate(case)
    rows = zip(trace.time, trace.tilt, trace.rolling_angle, strict=True)
    lines = ["time,tilt [rad],azimuth [rad]", *(",".join(map(repr, map(float, row))) for row in rows)]
    (tmp_path / "mine.csv").write_text("\n".join(lines) + "\n")
    assert run("check", "--trajectory", "mine.csv", "--suite", "one.suite.toml") == 0
    assert "one motion" in capsys.readouterr().out
    assert run("check", "--trajectory", "mine.csv") == 2  # of the suite that ships, which case?
