"""Options that the commands have in common.

Units stand in words: square brackets are markup in a help text.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from .method_values import time_step

_BODY, _GROUND, _RELEASE, _METHOD = "Cylinder", "Ground motion", "Release", "Method"
_EXTERNAL = "Trajectory of a shake table or another code"

Semidiagonal = Annotated[
    float | None,
    typer.Option("--semidiagonal", help="R = sqrt(b^2 + h^2), in m. Default: 6.", rich_help_panel=_BODY),
]
TAN_ALPHA = typer.Option(
    "--tan-alpha", help="Slenderness b/h, radius over half the height.", rich_help_panel=_BODY
)
TanAlpha = Annotated[float, TAN_ALPHA]
Diameter = Annotated[
    float | None,
    typer.Option(
        "--diameter", help="2b, in m; with --height in place of the two above.", rich_help_panel=_BODY
    ),
]
Height = Annotated[float | None, typer.Option("--height", help="2h, in m.", rich_help_panel=_BODY)]
MassCentreHeight = Annotated[
    float | None,
    typer.Option(
        "--mass-centre-height",
        help="Of the mass centre above the base, in m; with --diameter and --height. Default: half of that.",
        rich_help_panel=_BODY,
    ),
]
TransverseInertia = Annotated[
    float | None,
    typer.Option(
        "--transverse-inertia",
        help="I1/m about the mass centre, in m2. Default: of a homogeneous solid cylinder.",
        rich_help_panel=_BODY,
    ),
]
AxialInertia = Annotated[
    float | None, typer.Option("--axial-inertia", help="I2/m about the axis, in m2.", rich_help_panel=_BODY)
]
Gravity = Annotated[float, typer.Option("--gravity", help="g, in m/s2.", rich_help_panel=_GROUND)]
Friction = Annotated[
    float,
    typer.Option(
        "--friction",
        help="Coefficient of cylinder and ground. The reduced models assume that it suffices and say where "
        "it would not.",
        rich_help_panel=_GROUND,
    ),
]
RecordX = Annotated[
    Path | None,
    typer.Option(
        "--record-x",
        help="East-west component: PEER AT2, two-column text or CSV. Default: El Centro 1940.",
        rich_help_panel=_GROUND,
    ),
]
RecordY = Annotated[
    Path | None, typer.Option("--record-y", help="North-south component.", rich_help_panel=_GROUND)
]
RecordZ = Annotated[
    Path | None,
    typer.Option("--record-z", help="Vertical component, may be left out.", rich_help_panel=_GROUND),
]
Units = Annotated[
    str | None,
    typer.Option(
        "--units", help="g, m/s2 or cm/s2; required where the files do not say.", rich_help_panel=_GROUND
    ),
]
Scale = Annotated[float, typer.Option("--scale", help="Factor on all components.", rich_help_panel=_GROUND)]
ReleaseTilt = Annotated[
    float | None,
    typer.Option(
        "--release-tilt-deg",
        help="Release at this tilt, in deg; without a record the ground is then still.",
        rich_help_panel=_RELEASE,
    ),
]
RollingRate = Annotated[
    float,
    typer.Option("--rolling-rate", help="Rolling rate at release, in rad/s.", rich_help_panel=_RELEASE),
]
Duration = Annotated[
    float | None,
    typer.Option(
        "--duration",
        help="Length of the run, in s. Default: that of the ground motion, 10 s without one.",
        rich_help_panel=_RELEASE,
    ),
]
Engines = Annotated[
    list[str] | None,
    typer.Option(
        "--engine",
        help="mujoco, pybullet or exudyn; may be repeated. Default: all that serve any case.",
        rich_help_panel=_METHOD,
    ),
]
Supports = Annotated[
    list[str] | None,
    typer.Option(
        "--support",
        help="recess (ideal recess), flat (flat ground) or ring (walls, MuJoCo only); may be repeated. "
        "Default: recess and flat.",
        rich_help_panel=_METHOD,
    ),
]
TimeStep = Annotated[
    Any,  # a number, "auto" or None: typer knows no type for that, `time_step` makes it
    typer.Option(
        "--time-step",
        parser=time_step,
        metavar="FLOAT|auto",
        help="Time step of the engines, in s. Default: 1e-4 s at R = 6 m, with the root of the size. auto "
        "halves it until the tilt has settled, and says what error is left.",
        rich_help_panel=_METHOD,
    ),
]
Engine = Annotated[
    str | None,
    typer.Option(
        "--engine", help="mujoco, pybullet or exudyn. Default: the reduced model.", rich_help_panel=_METHOD
    ),
]
Support = Annotated[
    str,
    typer.Option(
        "--support",
        help="recess (ideal recess), flat (flat ground) or ring (walls, MuJoCo only).",
        rich_help_panel=_METHOD,
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Setting of the method, such as ring_clearance=0.01, integrator=discrete or rtol=1e-10, for "
        "each run that has one of that name; may be repeated.",
        rich_help_panel=_METHOD,
    ),
]
SuiteName = Annotated[
    str | None,
    typer.Argument(
        metavar="[SUITE]",
        help="A suite of cases and runs: a TOML file, or one that ships: canon, p695, quick.",
        show_default=False,
    ),
]
Trajectories = Annotated[
    list[Path] | None,
    typer.Option(
        "--trajectory",
        help="CSV of time and: tilt and azimuth, or qw, qx, qy, qz, or x, y, z of the mass centre; from a "
        "shake table or another code. What it does not hold is not compared; may be repeated.",
        rich_help_panel=_EXTERNAL,
    ),
]
TrajectoryAngles = Annotated[
    str | None,
    typer.Option(
        "--trajectory-angles",
        help="deg or rad, where its header does not say.",
        rich_help_panel=_EXTERNAL,
    ),
]
TrajectoryOffset = Annotated[
    float,
    typer.Option(
        "--trajectory-offset",
        help="Added to its times, in s, so that 0 is the start of the run.",
        rich_help_panel=_EXTERNAL,
    ),
]
TrajectoryNoise = Annotated[
    float | None,
    typer.Option(
        "--trajectory-noise-deg",
        help="Tilt below which it counts as standing, in deg. Default: as its scatter asks for, at least "
        "1e-4 alpha.",
        rich_help_panel=_EXTERNAL,
    ),
]
Budget = Annotated[
    bool,
    typer.Option(
        "--budget",
        help="Split each difference into model form, numerics and what stays unexplained, by runs at finer "
        "steps: takes some seven times as long.",
        rich_help_panel=_METHOD,
    ),
]
Out = Annotated[Path, typer.Option("--out", help="Folder for the results.")]
