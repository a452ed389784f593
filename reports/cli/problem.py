"""Options that state a problem, equal in every command, and the case built from them."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import typer

import rockwobble as rw
from rockwobble.compare.runs.plan import OptionsIn, Plan, option
from rockwobble.studies.plans import (
    FRICTION,
    GRAVITY,
    MASS,
    PRESTRESS,
    ROLLING,
    SLAB,
    STIFFNESS,
    YIELD,
    TendonPlan,
    YieldPlan,
    tendon_of,
)

from ..pages.command_line import command_line
from ..pages.wording import written
from . import options

if TYPE_CHECKING:
    from rockwobble.models import RockingBody

# length of a free response where the user does not say [s]
FREE_DURATION = 10.0
_cylinder, _ground, _release, _tendon = map(OptionsIn, ("Cylinder", "Ground motion", "Release", "Tendon"))
SEMIDIAGONAL, TAN_ALPHA = 6.0, 0.2  # [m], [-]


@dataclass(frozen=True, kw_only=True)
class Body(Plan):
    """Options of a cylinder, or of a slab on cylinders."""

    semidiagonal: float | None = _cylinder(None, "Semidiagonal R = sqrt(b^2 + h^2), in m. Default: 6.")
    tan_alpha: float | None = _cylinder(None, options.SLENDERNESS)
    diameter: float | None = _cylinder(
        None, "Diameter 2b, in m; with --height, instead of --semidiagonal and --tan-alpha.", above=0.0
    )
    height: float | None = _cylinder(None, "Height 2h, in m.")
    mass_centre_height: float | None = _cylinder(
        None, "Height of the mass centre, in m; with --diameter and --height. Default: half the height."
    )
    transverse_inertia: float | None = _cylinder(
        None,
        "Transverse inertia per mass about the mass centre, I1/m, in m2. Default: homogeneous and solid.",
    )
    axial_inertia: float | None = _cylinder(
        None, "Axial moment of inertia per mass, I2/m, in m2. Default: homogeneous solid cylinder."
    )
    slab_mass_ratio: float | None = _cylinder(None, f"{SLAB} Default: no slab.")
    columns: int | None = _cylinder(
        None,
        "Number of columns under the slab: 3 or more, or 1 for a slab that cannot rotate. Engines "
        "always run one column under a slab that only translates. Default: 3.",
    )

    def cylinder(self) -> RockingBody:
        """Cylinder by semidiagonal and slenderness or by diameter and height, or the frame.

        Raises
        ------
        ValueError
            If an option is out of range, or two do not go together.
        """
        inertias = {name: getattr(self, name) for name in ("transverse_inertia", "axial_inertia")}
        needs(self, ["height", "mass_centre_height"], "diameter")
        needs(self, ["diameter"], "height")
        excludes(self, ["diameter"], "semidiagonal", "tan_alpha")
        needs(self, ["columns"], "slab_mass_ratio")
        if self.diameter is not None and self.height is not None:
            cylinder = rw.Cylinder.from_dimensions(
                base_radius=0.5 * self.diameter,
                height=self.height,
                mass_centre_height=self.mass_centre_height,
                **inertias,
            )
        else:
            cylinder = rw.Cylinder(
                semidiagonal=SEMIDIAGONAL if self.semidiagonal is None else self.semidiagonal,
                tan_alpha=TAN_ALPHA if self.tan_alpha is None else self.tan_alpha,
                **inertias,
            )
        return under_slab(cylinder, self.slab_mass_ratio, self.columns)


def under_slab(cylinder: rw.Cylinder, slab_mass_ratio: float | None, columns: int | None) -> RockingBody:
    """Cylinder, or with a slab the frame of such cylinders."""
    if slab_mass_ratio is None:
        return cylinder
    return rw.WobblingFrame(cylinder, slab_mass_ratio, 3 if columns is None else columns)


def first_given(stated: Plan, *names: str) -> str:
    """First option that differs from its default, as it is typed; empty if none does."""
    defaults = {each.name: each.default for each in fields(stated)}  # type: ignore[arg-type]
    return next((_flag(name) for name in names if getattr(stated, name) != defaults[name]), "")


def _flag(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def needs(stated: Plan, names: Iterable[str], *needed: str) -> None:
    """Refuse options that need another option.

    Raises
    ------
    ValueError
        If one of them has a value, and none of the needed.
    """
    if (lone := first_given(stated, *names)) and not first_given(stated, *needed):
        raise ValueError(f"{lone} needs {' or '.join(map(_flag, needed))} as well")


def excludes(stated: Plan, names: Iterable[str], *others: str) -> None:
    """Refuse options that exclude one another.

    Raises
    ------
    ValueError
        If one of the names and one of the others have a value.
    """
    if (given := first_given(stated, *names)) and (other := first_given(stated, *others)):
        raise ValueError(f"{given} stands in place of {other}, got both")


@dataclass(frozen=True, kw_only=True)
class ReadingOptions(Plan):
    """Options of record reading, equal for one record and for many."""

    units: str | None = _ground(None, options.UNITS)
    record_columns: str | None = _ground(None, options.RECORD_COLUMNS)
    record_step: float | None = _ground(None, options.RECORD_STEP, above=0.0)
    lengths: str | None = _ground(None, options.LENGTHS, choices=("pad", "cut"))
    remove_mean: bool = _ground(False, options.REMOVE_MEAN, flag="--remove-mean")
    rotate: str | None = _ground(None, options.ROTATE)
    resample: bool = _ground(False, options.RESAMPLE, flag="--resample")

    def reading(self) -> rw.Reading:
        """Reading options as a value.

        Raises
        ------
        ValueError
            If one is out of range.
        """
        names = {"record_columns": "columns", "record_step": "time_step"}
        return rw.Reading(**{names.get(name, name): getattr(self, name) for name in WAYS})


WAYS = tuple(field.name for field in fields(ReadingOptions))


@dataclass(frozen=True, kw_only=True)
class Record(ReadingOptions):
    """Options of one ground motion."""

    record: Path | None = _ground(
        None, "File, or folder of a station, with all components; instead of --record-x, -y and -z."
    )
    record_x: Path | None = _ground(
        None,
        "East-west component: a file of the guide Records, or zero (planar motion). Default: El Centro 1940.",
    )
    record_y: Path | None = _ground(None, "North-south component: a file, or zero.")
    record_z: Path | None = _ground(None, "Vertical component. Default: none.")
    scale: float = _ground(1.0, "Scale factor of all components.", above=0.0)

    @property
    def names_record(self) -> bool:
        """Whether record files are named, so that the command states how they were read."""
        return any(path is not None for path in (self.record, self.record_x, self.record_y))

    def motion(self, *, still: bool = False) -> rw.GroundMotion | None:
        """Ground motion; without a record El Centro, or None on `still` ground.

        Raises
        ------
        ValueError
            If an option is out of range, two do not go together, or the record cannot be read.
        """
        excludes(self, ["record"], "record_x", "record_y", "record_z")
        needs(self, ["record_z", *WAYS, *(["scale"] if still else [])], "record", "record_x", "record_y")
        paths = [self.record] if self.record else [self.record_x, self.record_y, self.record_z]
        if self.record is None and (self.record_x is None) != (self.record_y is None):
            given, missing = ("--record-x", "--record-y") if self.record_x else ("--record-y", "--record-x")
            raise ValueError(
                f"both horizontal components are needed, got {given} without {missing}: for planar motion "
                f"give {missing} zero, one file of all by --record"
            )
        if paths[0] is not None:
            return rw.read_record(*paths, **asdict(self.reading())).scaled(self.scale)
        return None if still else rw.el_centro_1940().scaled(self.scale)


@dataclass(frozen=True, kw_only=True)
class Release(Plan):
    """Options of a release."""

    release_tilt_deg: float | None = _release(
        None, "Tilt at release, in deg. Without a record the ground is then still.", least=0.0, below=90.0
    )
    release_azimuth_deg: float = _release(
        0.0, "Tilt direction at release, in deg, counter-clockwise from x (east).", least=-360.0, most=360.0
    )
    rolling_rate: float = _release(0.0, "Rolling rate at release, in rad/s.")
    duration: float | None = _release(
        None,
        "Duration, in s; motion goes on over still ground to its next peak. Default: the record's, or 10 s.",
    )

    def initial(self) -> rw.InitialState | None:
        """State at release; None from rest.

        Raises
        ------
        ValueError
            If an option is out of range, or two do not go together.
        """
        needs(self, ["rolling_rate", "release_azimuth_deg"], "release_tilt_deg")
        if self.release_tilt_deg is None:
            return None
        return rw.InitialState(
            tilt=math.radians(self.release_tilt_deg),
            rolling_angle=math.radians(self.release_azimuth_deg),
            rolling_rate=self.rolling_rate,
        )


@dataclass(frozen=True, kw_only=True)
class Steel(Plan):
    """Options of the tendon of one body by its steel data."""

    tendon_force: float | None = _tendon(
        None, "Prestress, in N; with --tendon-rigidity, --tendon-length and --mass.", least=0.0
    )
    tendon_rigidity: float | None = _tendon(None, "Axial rigidity E A of the tendon, in N.", above=0.0)
    tendon_length: float | None = _tendon(
        None, "Free length of the tendon between its anchors, in m.", above=0.0
    )
    tendon_yield_force: float | None = _tendon(
        None, "Yield force of the tendon, in N. Default: no yielding.", above=0.0
    )
    tendon_area: float | None = _tendon(
        None, "Area of the steel of the tendon, in mm2: stresses in MPa.", above=0.0
    )
    tendon_yield_stress: float | None = _tendon(
        None, "Yield stress of the steel, in MPa; with --tendon-area. Default: no yielding.", above=0.0
    )
    mass: float | None = option(None, MASS, group="Cylinder", above=0.0)

    def of_steel(self, bodies: Sequence[RockingBody], gravity: float) -> rw.Tendon | None:
        """Tendon of one column from steel data; None without steel options.

        Raises
        ------
        ValueError
            If an option is out of range, one is missing, or there are several bodies, each with a mass.
        """
        for needed in ("tendon_rigidity", "tendon_length", "mass"):
            needs(self, _STEEL, needed)
        needs(self, ["tendon_yield_stress"], "tendon_area")
        excludes(self, ["tendon_yield_stress"], "tendon_yield_force")
        if self.tendon_rigidity is None or self.tendon_length is None or self.mass is None:
            return None
        if len(bodies) != 1:
            raise ValueError(
                f"{first_given(self, *_STEEL)} states the tendon of one body, got {len(bodies)}: give "
                "--tendon-prestress and --tendon-stiffness, multiples of weight and base radius of each"
            )
        force, area = self.tendon_yield_force, self.tendon_area
        if self.tendon_yield_stress is not None and area is not None:
            force = self.tendon_yield_stress * area  # MPa mm2
        return rw.Tendon.from_steel(
            prestress=self.tendon_force or 0.0,
            axial_rigidity=self.tendon_rigidity,
            length=self.tendon_length,
            column_mass=1e3 * self.mass,
            base_radius=bodies[0].base_radius,
            yield_force=force,
            area=None if area is None else 1e-6 * area,
            gravity=gravity,
        )


_OF_YIELD = ("tendon_yield_force", "tendon_area", "tendon_yield_stress")
_STEEL = ("tendon_force", "tendon_rigidity", "tendon_length", *_OF_YIELD)
_RATIOS = ("tendon_prestress", "tendon_stiffness", "tendon_yield")
TiedPlan = TypeVar("TiedPlan", bound=TendonPlan)


def with_steel(
    context: typer.Context, plan: TiedPlan, steel: Steel, bodies: Sequence[RockingBody], gravity: float
) -> TiedPlan:
    """Plan of a study with the tendon from steel data, as multiples for the one body.

    Raises
    ------
    ValueError
        As `Steel.of_steel`, or if the tendon is stated in weights, too.
    """
    tendon = steel.of_steel(bodies, gravity)
    if tendon is None:
        refuse(context, {"mass"}, "belongs to a tendon in N, give --tendon-rigidity and --tendon-length")
        return plan
    refuse(context, _RATIOS, f"states a tendon in weights, got {first_given(steel, *_STEEL)} in N beside it")
    values = {"tendon_prestress": tendon.prestress, "tendon_stiffness": tendon.stiffness}
    if isinstance(plan, YieldPlan):
        return replace(plan, **values, tendon_yield=tendon.yield_force)
    refuse(context, _OF_YIELD, "belongs to fragility, spectrum and runs of one case")
    return replace(plan, **values)


@dataclass(frozen=True, kw_only=True)
class Restraint(Steel):
    """Options of a tendon: by ratios, or by steel data."""

    tendon_prestress: float | None = _tendon(None, PRESTRESS, least=0.0)
    tendon_stiffness: float | None = _tendon(None, STIFFNESS, least=0.0)
    tendon_yield: float | None = _tendon(None, f"{YIELD}. Default: no yielding.", above=0.0)

    def tendon(self, cylinder: RockingBody, gravity: float) -> rw.Tendon | None:
        """Tendon of one column; None without tendon options.

        Raises
        ------
        ValueError
            If an option is out of range, one is missing, or two do not go together.
        """
        excludes(self, _STEEL, *_RATIOS)
        if not first_given(self, *_RATIOS):
            return self.of_steel([cylinder], gravity)
        return tendon_of(self.tendon_prestress or 0.0, self.tendon_stiffness or 0.0, self.tendon_yield)


@dataclass(frozen=True, kw_only=True)
class Problem(Release, Record, Restraint, Body):
    """Options of a problem."""

    gravity: float = _ground(9.81, GRAVITY)
    friction: float = _ground(
        1.0, f"{FRICTION} The reduced models assume no sliding and warn where it would occur."
    )
    rolling_resistance: float = _ground(0.0, ROLLING)

    def case(self) -> rw.Case:
        """Case from the options.

        Raises
        ------
        ValueError
            If an option is out of range, or two do not go together.
        """
        initial, cylinder = self.initial(), self.cylinder()
        motion = self.motion(still=initial is not None)
        return rw.Case(
            cylinder,
            motion,
            initial=initial,
            duration=FREE_DURATION if motion is None and self.duration is None else self.duration,
            gravity=self.gravity,
            friction=self.friction,
            rolling_resistance=self.rolling_resistance,
            tendon=self.tendon(cylinder, self.gravity),
            name="free response" if motion is None else scaled_name(motion, self.scale),
        )


def scaled_name(motion: rw.GroundMotion, scale: float) -> str:
    """Name of a case: name of its ground motion and scale."""
    factor = scale if scale != 1.0 else None
    return written("motions.scaled", {"name": motion.name, "factor": factor}, {})


def unread(problem: Problem) -> Problem:
    """Problem without the reading options, which belong to other motions."""
    defaults: dict[str, Any] = {each.name: each.default for each in fields(ReadingOptions)}
    return replace(problem, **defaults)


def given_options(context: typer.Context) -> list[str]:
    """Options given by the user, by parameter name."""
    sources = {name: context.get_parameter_source(name) for name in context.params}
    return [name for name, source in sources.items() if source is not None and source.name == "COMMANDLINE"]


def stated_options(context: typer.Context, *, also: Collection[str] = ()) -> dict[str, str | bool]:
    """Options of the problem given by the user, by name; `also`: further options of the command."""
    return {
        name: context.params[name] if isinstance(context.params[name], bool) else str(context.params[name])
        for name in given_options(context)
        if name in PROBLEM or name in also
    }


def next_command(context: typer.Context, command: str, *, also: Collection[str] = ()) -> str:
    """Command line of another command for the given problem; `also`: its further options."""
    return command_line(command, stated_options(context, also=also))


def refuse(context: typer.Context, names: Collection[str], why: str) -> None:
    """Refuse given options that would be ignored.

    Raises
    ------
    ValueError
        Naming the first of them.
    """
    flags = {each.name: each.opts[0] for each in context.command.params}
    for name in given_options(context):
        if name in names:
            raise ValueError(f"{flags[name]} {why}")


def refuse_options_of_engines(context: typer.Context, engines: list[str] | None) -> None:
    """Refuse engine options if no engine runs."""
    if engines == [options.NO_ENGINE]:
        refuse(context, {"support", "time_step"}, "belongs to engines, got it with --engine none")


BODY, PROBLEM = (frozenset(field.name for field in fields(each)) for each in (Body, Problem))
