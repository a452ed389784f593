"""Suites as tests: collected items, failures, and their messages."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytest_plugins = ["pytester"]


@pytest.fixture(scope="module", autouse=True)
def modules_of_inner_runs() -> None:
    """Import once the modules of each inner pytest run, and unload all others afterwards."""
    import mujoco  # noqa: F401
    import pandas as pd

    import rockwobble.compare.check
    from rockwobble import reduced
    from rockwobble.models import Case, Cylinder, InitialState
    from rockwobble.reports.pages import comparison  # noqa: F401

    assert rockwobble.compare.check.GROUPS
    body = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    for model in ("recess", "flat"):
        reduced.simulate(Case(body, initial=InitialState(0.1), duration=0.1), **reduced.MODELS[model])
    pd.DataFrame({"text": ["some"]}).astype(str)  # with what pandas imports when it is used


SUITE = """
[[runs]]
engine = "mujoco"
support = ["recess", "flat"]

[[cases]]
name = "release"
cylinder = { semidiagonal = 6, tan_alpha = [0.2, 1] }
release = { tilt_over_alpha = 0.5, rolling_rate = 0.5 }
duration = 0.8
"""


def bounded(bounds: str) -> str:
    return f"[bounds]\n{bounds}\n{SUITE}"


@pytest.fixture
def suite(pytester: pytest.Pytester):
    def write(text: str = SUITE) -> pytest.Pytester:
        pytester.path.joinpath("pier.suite.toml").write_text(text)
        return pytester

    return write


def test_each_case_and_run_is_an_item_that_passes(suite) -> None:
    result = suite().runpytest("--collect-only", "-q")
    runs = [f"{ratio}, mujoco {support}" for ratio in ("0.2", "1") for support in ("recess", "flat")]
    result.stdout.fnmatch_lines([f"*pier.suite.toml::release: tan_alpha {run}" for run in runs])
    suite().runpytest("-W", "error").assert_outcomes(passed=4)


def test_exceeded_bounds_fail_with_the_error_budget(suite, in_this_process) -> None:
    # flat ground moves by another model, which shows on a squat cylinder at once
    pytester = suite(bounded('tilt_rms = 1e-5\nagreement_time = 0.8\nreference = "recess"'))
    result = pytester.runpytest("-k", "alpha and not 0.2", "-W", "error")
    result.assert_outcomes(passed=1, failed=1)
    head = "release: tan_alpha 1, mujoco flat"
    said = [f"*pier.suite.toml: {head}*", f"{head} compared with recess: tilt_rms: *, at most 1e-5 *"]
    result.stdout.fnmatch_lines([*said, "Difference from the recess model, RMS in alpha until * numerics *"])
    result = suite(bounded('tilt_rms = 1e-12\nreference = "flat"')).runpytest("-k", "alpha and 1 and recess")
    result.stdout.fnmatch_lines(["*compared with flat: tilt_rms: *at most 1e-12*", "There is no budget *"])
    assert "Error" not in result.stdout.str()


def test_error_budget_can_be_omitted(suite) -> None:
    pytester = suite(bounded("tilt_rms = 1e-12"))
    result = pytester.runpytest("-k", "0.2 and recess", "--no-rockwobble-budget")
    result.assert_outcomes(failed=1)
    assert "Difference from" not in result.stdout.str()
    result.stdout.fnmatch_lines(["*tilt_rms: *at most 1e-12*"])


def test_failed_engine_run_states_its_reason(suite) -> None:
    text = SUITE.replace('support = ["recess", "flat"]', "settings = { contact_damping_ratio = 0.01 }")
    result = suite(text).runpytest("-k", "0.2")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*contact of mujoco*the engine gained energy*"])


@pytest.mark.slow
def test_bad_suite_file_or_setting_is_reported_as_an_error(suite) -> None:
    result = suite("[[cases]]\nname = 'x'\n").runpytest()
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["pier.suite.toml: cases[[]0].cylinder: must be given"])
    assert "Traceback" not in result.stdout.str()
    text = SUITE.replace('support = ["recess", "flat"]', "settings = { softness = 1 }")
    result = suite(text).runpytest("-k", "0.2")
    result.stdout.fnmatch_lines(["pier.suite.toml: 'softness' is not a setting of mujoco*"])


def test_suite_item_of_a_missing_engine_is_skipped(suite, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rockwobble.compare.runs.choice.engine_fault", lambda name: "is not here")
    suite().runpytest().assert_outcomes(skipped=4)


def test_plugin_ignores_other_files_and_can_be_disabled(suite) -> None:
    pytester = suite()
    pytester.path.joinpath("other.toml").write_text("a = 1")
    assert pytester.runpytest("-p", "no:rockwobble").ret == pytest.ExitCode.NO_TESTS_COLLECTED
    assert pytester.runpytest("other.toml").ret == pytest.ExitCode.USAGE_ERROR


def test_the_plugin_imports_nothing_heavy() -> None:
    code = (
        "import sys, rockwobble.reports.pytest_plugin as p; "
        "print(*sorted({'numpy', 'numba', 'pydantic', 'rich', 'typer', 'mujoco'} & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True, timeout=60)
    assert run.stdout.split() == []
