"""A trace as a Parquet file and back, with the same bits: samples as the table, the rest in its metadata."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .case import Case, InitialState, Run
from .cylinder import cylinder_of
from .diagnostic import Assumptions, Diagnostic
from .ground_motion import GroundMotion
from .parquet_file import pack, read
from .trace_source import Array, Known

if TYPE_CHECKING:
    import pandas as pd

# name: (unit, meaning), of the samples as a table
COLUMNS = {
    "time": ("s", "from the start of the run"),
    "tilt": ("rad", "of the axis from the vertical"),
    "tilt_rate": ("rad/s", "its rate"),
    "rolling_angle": ("rad", "azimuth of the lean, unwrapped; empty at rest"),
    "rolling_rate": ("rad/s", "its rate"),
    "twist": ("rad", "rolling angle plus spin about the axis"),
    "contact_x": ("m", "contact point, relative to the original base centre, which moves with the ground"),
    "contact_y": ("m", "likewise"),
    "centre_x": ("m", "mass centre, relative to the same point"),
    "centre_y": ("m", "likewise"),
    "centre_z": ("m", "likewise, up"),
    "force_x": ("weights", "contact force on the cylinder"),
    "force_y": ("weights", "likewise"),
    "force_z": ("weights", "likewise, up"),
    "top_force_x": (
        "weights",
        "of a frame: contact force of a column on its share of the slab",
    ),
    "top_force_y": ("weights", "likewise"),
    "top_force_z": ("weights", "likewise, up"),
    "friction_needed": ("", "horizontal over normal force; infinite where the normal force is not positive"),
    "restraining_moment": ("m", "of the recess: kappa in kappa (z_world + z_body), over the weight"),
    "energy": ("m2/s2", "relative to the ground, per unit mass, zero standing"),
    "energy_lost": ("m2/s2", "energy that rolling resistance and impacts took so far, per unit mass"),
    "energy_error": ("m2/s2", "energy that neither the start nor the excitation supplied"),
    "slip": ("m", "distance slipped so far"),
    "wall_contact": ("s", "time at walls so far"),
    "wall_impulse": ("m/s", "size of the force of those walls, summed over time so far, per unit mass"),
}
PASS_COLUMNS = {
    "time": ("s", "of the least tilt"),
    "minimum_tilt": ("rad", "the least tilt"),
    "angle_of_turn": ("rad", "of the azimuth, from maximum to maximum"),
    "resolved": ("", "whether contact was stiff and steps short enough for it"),
}
VECTORS = {
    "contact_point": ("contact_x", "contact_y"),
    "centre_of_mass": ("centre_x", "centre_y", "centre_z"),
    "contact_force": ("force_x", "force_y", "force_z"),
    "top_contact_force": ("top_force_x", "top_force_y", "top_force_z"),
}
OF_FRAMES = VECTORS["top_contact_force"]  # columns that only the trace of a frame has
_FIELDS = ("time", "tilt", "tilt_rate", "rolling_angle", "twist", "contact_point", "centre_of_mass")
_LATE = (
    *("rolling_rate", "energy", "contact_force", "top_contact_force", "restraining_moment"),
    *("energy_lost", "energy_error", "slip", "wall_contact", "wall_impulse"),
)
NUMBERS = (
    *("version", "outcome", "rests", "peak_tilt", "uplift_time", "uplift_direction", "time_step"),
    *("wall_time", "step_count", "contact_resolution", "residual_displacement", "error_estimate"),
    *("settled_until", "followed_until"),
)


def restored(facts: Mapping[str, Any], samples: pd.DataFrame) -> dict[str, Any]:
    """Return the arguments of a trace, but its case, of what `Trace.to_plain` and its samples hold."""
    import pandas as pd

    def array(name: str) -> Array:
        columns = VECTORS.get(name)
        return samples[name].to_numpy() if columns is None else samples[list(columns)].to_numpy()

    if "rest_intervals" not in facts:  # of up to 0.2: "rest" is an outcome, and rests are the intervals
        word = facts["outcome"]
        facts = {
            **facts,
            "rests": word == "rest",
            "rest_intervals": facts["rests"],
            "followed_until": math.nan,
        }
        facts["outcome"] = "stands" if word in ("rest", "completed") else word
    held = facts["assumptions"]
    passes = {
        name: np.array(column, dtype=bool if name == "resolved" else float)
        for name, column in facts["passes"].items()
    }
    return {
        "run": run_from_plain(facts["run"]),
        **{name: array(name) for name in _FIELDS},
        **{name: facts[name] for name in NUMBERS},
        "settings": facts["settings"],
        "facts": _diagnostics(facts["facts"]),
        "rest_intervals": np.array(facts["rest_intervals"], dtype=float).reshape(-1, 2),
        "extrema": np.array(facts["extrema"], dtype=float).reshape(-1, 4),
        "passes": pd.DataFrame(passes),
        "source": Known(
            # a file of another version lacks what it did not know
            {name: array(name) for name in _LATE if set(VECTORS.get(name, (name,))) <= set(samples.columns)},
            None if held is None else Assumptions(**held | {"breaches": _diagnostics(held["breaches"])}),
        ),
    }


def _diagnostics(given: Iterable[Mapping[str, Any]]) -> tuple[Diagnostic, ...]:
    return tuple(Diagnostic(**each) for each in given)


def run_to_plain(run: Run) -> dict[str, object]:
    """Return a run for JSON."""
    return {
        "engine": run.engine,
        "support": run.support,
        "time_step": run.time_step,
        "settings": dict(run.settings),
    }


def run_from_plain(given: Mapping[str, Any]) -> Run:
    """Return the run that `run_to_plain` was given."""
    return Run(given["engine"], given["support"], given["time_step"], **given["settings"])


def case_to_plain(case: Case) -> dict[str, object]:
    """Return a case for JSON, with the samples of its motion."""
    fields = {field.name: getattr(case, field.name) for field in dataclasses.fields(case)}
    return {**fields, "motion": case.motion and dataclasses.asdict(case.motion)}


def case_from_plain(given: Mapping[str, Any]) -> Case:
    """Return the case that `case_to_plain` was given."""
    motion, initial = given["motion"], given["initial"]
    fields = {
        "cylinder": cylinder_of(given["cylinder"]),
        "motion": motion and GroundMotion(**motion),
        "initial": initial and InitialState(**initial),
    }
    return Case(**{**given, **fields})


def packed(samples: pd.DataFrame, facts: Mapping[str, object], case: Case) -> bytes:
    """Return a trace as the bytes of a Parquet file."""
    return pack(samples, {"case": case_to_plain(case), "trace": facts})


def unpacked(path: str | Path) -> tuple[dict[str, Any], pd.DataFrame, Case]:
    """Return facts, samples and case of a file that `packed` made.

    Raises
    ------
    ValueError
        If it is not one.
    """
    try:
        samples, about = read(Path(path).read_bytes())
        return about["trace"], samples, case_from_plain(about["case"])
    except (OSError, ValueError, KeyError) as error:
        why = str(error).partition("\n")[0] or type(error).__name__
        raise ValueError(f"{path} must be the file of a trace, cannot read it as one: {why}") from None
