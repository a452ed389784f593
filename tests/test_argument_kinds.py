"""No value of a wrong kind ends a public function in an error of its inside.

Each argument of each public name in turn takes values of many kinds; the other arguments are right. What
comes is a result, or a ValueError of one line that names the argument or quotes the value.
"""

from __future__ import annotations

import inspect
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
STILL = rw.GroundMotion([[0.0, 0.0], [3.0, 1.0], [0.0, 0.0]], 0.1, "push")
CASE = rw.Case(PIER, STILL, duration=0.5, name="a case")
OTHER = rw.Case(PIER, STILL, duration=0.4, name="another case")
MODEL = rw.Run(None, "recess")
TRACE = rw.simulate(CASE)
HAZARD = "PGA (g),annual frequency\n0.1,0.01\n0.2,0.001\n"
RECORD = "0.00, 0.0\n0.01, 0.5\n0.02, 0.0\n"

WRONG: dict[str, Any] = {
    "none": None,
    "number": 3.5,
    "negative": -7,
    "zero": 0,
    "truth": True,
    "text": "no such thing",
    "empty text": "",
    "bytes": b"x",
    "not a number": math.nan,
    "infinite": math.inf,
    "huge": 10**400,
    "complex": 1j,
    "object": object(),
    "class": dict,
    "function": lambda: 1,
    "list of kinds": [1, "a", None],
    "list of none": [None],
    "nothing": [],
    "ragged": [[1.0], [2.0, 3.0]],
    "set": {1},
    "mapping": {"a": 1},
    "matrix": np.zeros((2, 2)),
    "text array": np.array(["a"]),
    "table": pd.DataFrame({"a": [1]}),
    "cylinder": PIER,
    "motion": STILL,
    "case": CASE,
    "run": MODEL,
    "trace": TRACE,
}
VALID: dict[str, dict[str, Any]] = {
    "Case": {"cylinder": PIER, "motion": STILL, "initial": None, "duration": 0.5},
    "Cylinder": {"semidiagonal": 6.0, "tan_alpha": 0.2},
    "Diagnostic": {"code": "slip"},
    "External": {"path": Path("trajectory.csv")},
    "Grid": {"semidiagonals": [6.0], "tan_alphas": [0.2], "scales": [1.0], "motions": [STILL]},
    "GroundMotion": {"acceleration": [[0.0, 0.0], [1.0, 0.0]], "time_step": 0.1},
    "HazardCurve": {"intensity": [0.1, 0.2], "annual_frequency": [0.01, 0.001], "measure": "pga"},
    "InitialState": {"tilt": 0.1},
    "Reading": {"units": "g"},
    "Run": {"engine": None, "support": "recess"},
    "Suite": {"cases": [CASE], "runs": [MODEL]},
    "Tendon": {},
    "WobblingFrame": {"cylinder": PIER},
    "advise": {"case": CASE, "copies": 20},
    "check": {"model": lambda case, support: {}, "only": ["rest"]},
    "comparison": {"case_or_suite": CASE, "runs": [rw.Run(None, "flat")], "workers": 1},
    "el_centro_1940": {},
    "ensemble": {"case_or_members": [CASE, OTHER], "runs": [], "workers": 1},
    "far_field_motions": {"peak": 3.0},
    "fragility": {
        "cylinders": PIER,
        "motions": [STILL, rw.GroundMotion([[0.0, 0.0], [2.0, 1.0], [0.0, 0.0]], 0.1, "other")],
        "methods": ["recess"],
    }
    | {"scales": [1.0, 2.0], "resamples": 5},
    "p695_far_field": {"pair": 1},
    "perturbed_copies": {"case": CASE, "count": 2, "perturbation": 0.01, "seed": 0},
    "pulse": {"kind": "one-sine", "amplitude": 3.0, "period": 1.0},
    "read_hazard": {"path": "hazard.csv", "measure": "pga"},
    "read_record": {"x_path": "east.csv", "y_path": "zero", "units": "m/s2"},
    "read_records": {"folder": "records"},
    "read_records_by_level": {"folder": "records"},
    "read_suite": {"path": "quick"},
    "shipped_suites": {},
    "simulate": {"case": CASE},
    "spectrum": {"tan_alpha": 0.2, "motion": STILL, "semidiagonals": [6.0], "intensities": [1.0, 2.0]}
    | {"probes": 0, "workers": 1},
    "sweep": {"plan": rw.Grid(semidiagonals=[6.0], tan_alphas=[0.2], scales=[1.0], motions=[STILL])}
    | {"workers": 1},
    "synthetic_motions": {"count": 2, "peak": 3.0, "seed": 0},
    "with_motions": {"case": CASE, "motions": [STILL]},
}
# results, which only the package makes; and the parts
MADE_HERE = {"Comparison", "Trace", "compare", "models", "multibody", "reduced", "reports", "studies"}
# how much work is asked for is no kind, and ends a test late
COSTLY = {("Grid", "huge")}
# what runs whole studies where a value is right after all takes fewer
# whose records are not installed with the tests: what comes then is the line that says how to
OF_AN_EXTRA = {"far_field_motions", "p695_far_field"}
STUDIES = {"advise", "check", "comparison", "ensemble"}
FEW = ("none", "number", "text", "object", "list of kinds", "mapping", "matrix", "cylinder")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("hazard.csv").write_text(HAZARD)
    Path("east.csv").write_text(RECORD)
    Path("records").mkdir()
    Path("records/east.csv").write_text(RECORD)
    Path("records/records.csv").write_text("x,y,name,units\neast.csv,zero,pulse,m/s2\n")


def test_every_public_name_is_here() -> None:
    assert set(VALID) | MADE_HERE == set(rw.__all__)


def arguments() -> list[tuple[str, str]]:
    found: list[tuple[str, str]] = []
    for name in VALID:
        parameters = inspect.signature(getattr(rw, name)).parameters.values()
        found += [(name, each.name) for each in parameters if each.kind is not each.VAR_KEYWORD]
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", VALID)
def test_arguments_of_the_right_kind_are_accepted(name: str) -> None:
    lacking = name in OF_AN_EXTRA and p695.missing_packages()
    refused = pytest.raises(ValueError, match=re.escape(p695.REMEDY)) if lacking else nullcontext()
    with refused:
        getattr(rw, name)(**VALID[name])


@pytest.mark.slow
@pytest.mark.parametrize(("name", "argument"), arguments(), ids=lambda part: part)
def test_a_wrong_kind_is_one_line(name: str, argument: str) -> None:
    function: Callable[..., Any] = getattr(rw, name)
    for kind, value in WRONG.items():
        if (name, kind) in COSTLY or (name in STUDIES and kind not in FEW):
            continue
        if argument in ("progress", "save") and callable(value):
            continue  # what it raises is its own
        error = None
        try:
            function(**VALID[name] | {argument: value})
        except ValueError as refusal:
            error = refusal
        if error is not None:
            text = str(error)
            assert type(error) is ValueError, (kind, repr(error))
            assert text, (kind, text)
            assert "\n" not in text, (kind, text)
            assert len(text) < 400, (kind, text)
            for inside in ("object has no attribute", "ambiguous", "setting an array", "unhashable"):
                assert inside not in text, (kind, text)


BEYOND: dict[str, list[Any]] = {
    "positive": [0.0, -1.0, math.nan, math.inf, "1"],
    "not negative": [-1e-9, math.nan, math.inf, "1"],
    "finite": [math.nan, -math.inf, "1", True],
}
RANGES = {
    ("Case", "positive"): ("duration", "gravity"),
    ("Case", "not negative"): ("friction",),
    ("Cylinder", "positive"): ("semidiagonal", "tan_alpha", "height", "transverse_inertia", "axial_inertia"),
    ("GroundMotion", "positive"): ("time_step",),
    ("InitialState", "finite"): ("tilt", "tilt_rate", "rolling_angle", "rolling_rate"),
    ("Run", "positive"): ("time_step",),
    ("WobblingFrame", "not negative"): ("slab_mass_ratio",),
}


@pytest.mark.parametrize(("name", "kind"), RANGES)
def test_a_number_out_of_its_range_is_refused_by_name(name: str, kind: str) -> None:
    for argument in RANGES[name, kind]:
        for value in BEYOND[kind]:
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
