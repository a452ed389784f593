"""No value of a wrong kind ends a public function in an error of its inside.

Each argument of each public name in turn takes values of many kinds; the other arguments are right. What
comes is a result, or a ValueError of one line that names the argument or quotes the value.
"""

from __future__ import annotations

import inspect
import itertools
import math
import re
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import rockwobble as rw
from rockwobble.models import Case, Run
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.records import p695

PIER = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
STILL, OTHER_MOTION = (
    rw.GroundMotion([[0.0, 0.0], [3.0, 1.0], [0.0, 0.0]], 0.1, name) for name in ("push", "other")
)
CASE = rw.Case(PIER, STILL, duration=0.5, name="a case")
OTHER = rw.Case(PIER, STILL, duration=0.4, name="another case")
MODEL = rw.Run(None, "recess")
TRACE = rw.simulate(CASE)
GRID: dict[str, Any] = {"semidiagonals": [6.0], "tan_alphas": [0.2], "scales": [1.0], "motions": [STILL]}

HUGE = 10**400
WRONG: list[Any] = [
    *(None, 3.5, -7, 0, True, "no such thing", "", b"x", math.nan, math.inf, HUGE, 1j, object(), dict),
    *(lambda: 1, [1, "a", None], [None], [], [[1.0], [2.0, 3.0]], {1}, {"a": 1}, np.zeros((2, 2))),
    *(np.array(["a"]), pd.DataFrame({"a": [1]}), PIER, STILL, CASE, MODEL, TRACE),
]
VALID: dict[str, dict[str, Any]] = {
    "Case": {"cylinder": PIER, "motion": STILL, "initial": None, "duration": 0.5},
    "Cylinder": {"semidiagonal": 6.0, "tan_alpha": 0.2},
    "Diagnostic": {"code": "slip"},
    "External": {"path": Path("trajectory.csv")},
    "Grid": GRID,
    "GroundMotion": {"acceleration": [[0.0, 0.0], [1.0, 0.0]], "time_step": 0.1},
    "HazardCurve": {"intensity": [0.1, 0.2], "annual_frequency": [0.01, 0.001], "measure": "pga"},
    "InitialState": {"tilt": 0.1},
    "Reading": {"units": "g"},
    "Run": {"engine": None, "support": "recess"},
    "Suite": {"cases": [CASE], "runs": [MODEL]},
    "WobblingFrame": {"cylinder": PIER},
    **{name: {} for name in ("Tendon", "el_centro_1940", "shipped_suites")},
    "advise": {"case": CASE, "copies": 20},
    "check": {"model": lambda case, support: {}, "only": ["rest"]},
    "comparison": {"case_or_suite": CASE, "runs": [rw.Run(None, "flat")], "workers": 1},
    "ensemble": {"case_or_members": [CASE, OTHER], "runs": [], "workers": 1},
    "far_field_motions": {"peak": 3.0},
    "fragility": {"cylinders": PIER, "motions": [STILL, OTHER_MOTION], "methods": ["recess"]}
    | {"scales": [1.0, 2.0], "resamples": 5},
    "p695_far_field": {"pair": 1},
    "perturbed_copies": {"case": CASE, "count": 2, "perturbation": 0.01, "seed": 0},
    "pulse": {"kind": "one-sine", "amplitude": 3.0, "period": 1.0},
    "read_hazard": {"path": "hazard.csv", "measure": "pga"},
    "read_record": {"x_path": "east.csv", "y_path": "zero", "units": "m/s2"},
    **{name: {"folder": "records"} for name in ("read_records", "read_records_by_level")},
    "read_suite": {"path": "quick"},
    "simulate": {"case": CASE},
    "spectrum": {"tan_alpha": 0.2, "motion": STILL, "semidiagonals": [6.0], "intensities": [1.0, 2.0]}
    | {"probes": 0, "workers": 1},
    "sweep": {"plan": rw.Grid(**GRID), "workers": 1},
    "synthetic_motions": {"count": 2, "peak": 3.0, "seed": 0},
    "with_motions": {"case": CASE, "motions": [STILL]},
}
# results, which only the package makes; and the parts
MADE_HERE = {"Comparison", "Trace", "compare", "models", "multibody", "reduced", "reports", "studies"}
# whose records are not installed with the tests: what comes then is the line that says how to
OF_AN_EXTRA = {"far_field_motions", "p695_far_field"}
# what runs whole studies where a value is right after all takes a third of the kinds
STUDIES = {"advise", "check", "comparison", "ensemble"}


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("hazard.csv").write_text("PGA (g),annual frequency\n0.1,0.01\n0.2,0.001\n")
    Path("records").mkdir()
    for path in ("east.csv", "records/east.csv"):
        Path(path).write_text("0.00, 0.0\n0.01, 0.5\n0.02, 0.0\n")
    Path("records/records.csv").write_text("x,y,name,units\neast.csv,zero,pulse,m/s2\n")


def test_every_public_name_is_here() -> None:
    assert set(VALID) | MADE_HERE == set(rw.__all__)


@pytest.mark.slow
@pytest.mark.parametrize("name", VALID)
def test_arguments_of_the_right_kind_are_accepted(name: str) -> None:
    lacking = name in OF_AN_EXTRA and p695.missing_packages()
    refused = pytest.raises(ValueError, match=re.escape(p695.REMEDY)) if lacking else nullcontext()
    with refused:
        getattr(rw, name)(**VALID[name])


@pytest.mark.slow
@pytest.mark.parametrize("name", VALID)
def test_a_wrong_kind_is_one_line(name: str) -> None:
    function: Callable[..., Any] = getattr(rw, name)
    inside = re.compile(r"\n|object has no attribute|ambiguous|setting an array|unhashable|^$")
    parameters = inspect.signature(function).parameters.values()
    arguments = [each.name for each in parameters if each.kind is not each.VAR_KEYWORD]
    for argument, value in itertools.product(arguments, WRONG[:: 3 if name in STUDIES else 1]):
        if (argument in ("progress", "save") and callable(value)) or (name == "Grid" and value is HUGE):
            continue  # what a callback raises is its own; how much work is asked for is no kind
        refusal = ValueError("a line")
        try:
            function(**VALID[name] | {argument: value})
        except ValueError as error:
            refusal = error
        assert type(refusal) is ValueError, (argument, value)
        assert not inside.search(str(refusal)), (argument, value, str(refusal))
        assert len(str(refusal)) < 400, (argument, value, str(refusal))


# a number that is never in range, and the arguments that refuse it by name
RANGES = {
    -1.0: "duration gravity friction time_step semidiagonal tan_alpha height axial_inertia slab_mass_ratio",
    math.nan: "duration gravity friction semidiagonal tan_alpha tilt tilt_rate rolling_angle slab_mass_ratio",
    math.inf: "gravity friction semidiagonal tan_alpha tilt rolling_rate slab_mass_ratio",
    0.0: "duration gravity time_step semidiagonal tan_alpha height",
}


@pytest.mark.parametrize("value", RANGES)
def test_a_number_out_of_its_range_is_refused_by_name(value: float) -> None:
    for name in ("Case", "Cylinder", "GroundMotion", "InitialState", "Run", "WobblingFrame"):
        for argument in set(RANGES[value].split()) & set(inspect.signature(getattr(rw, name)).parameters):
            with pytest.raises(ValueError, match=f"^{argument} must "):
                getattr(rw, name)(**VALID[name] | {argument: value})


def test_a_decorated_function_names_argument_kind_and_value() -> None:
    @with_argument_kinds
    def study(case: Case, runs: list[Run] | None = None, *, share: float = 1.0, **more: object) -> int:
        return len(runs or ())

    assert study(CASE, [MODEL], share=1, other=object()) == 1
    for call, text in (
        (lambda: study(3.0), "case must be Case, got 3.0"),  # type: ignore[arg-type]
        (lambda: study(CASE, share="1"), "share must be float, got '1'"),  # type: ignore[arg-type]
        (lambda: study(CASE, [3]), "runs must be list[Run] | None, got [3]"),  # type: ignore[list-item]
    ):
        with pytest.raises(ValueError, match=f"^{re.escape(text)}$"):
            call()
    with pytest.raises(TypeError, match="missing a required argument: 'case'"):
        study()  # type: ignore[call-arg]
