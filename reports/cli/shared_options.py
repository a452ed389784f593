"""Repeated and multi-valued options: cylinders, ground motions, grids and methods."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import rockwobble as rw
import rockwobble.compare as rc
from rockwobble.compare.runs.plan import OptionsIn, Plan
from rockwobble.studies.plans import GridPlan

from ..pages.wording import written
from . import options
from .options import settings
from .problem import WAYS, Body, ReadingOptions, excludes, first_given, needs, under_slab

if TYPE_CHECKING:
    from rockwobble.models import RockingBody
    from rockwobble.studies import Fragility

DEFAULT_COUNT = 100  # default number of synthetic motions
_motions = OptionsIn("Many ground motions")


@dataclass(frozen=True, kw_only=True)
class ManyMotions(ReadingOptions):
    """Options that name many ground motions."""

    p695: bool = _motions(
        False, "The 22 far-field pairs of FEMA P-695 (needs the extra records).", flag="--p695"
    )
    records: Path | None = _motions(
        None,
        "Folder of records: a PEER download with its _SearchResults.csv, or files with a table "
        "records.csv (columns x and y, or record; optional z, name, units, scale and level).",
    )
    synthetic: int | None = _motions(None, "Number of synthetic motions.", least=2)

    @property
    def option(self) -> str:
        """Name of the option that gives the motions; empty without one."""
        return first_given(self, "p695", "records", "synthetic")

    @property
    def source(self) -> str:
        """Kind of the motions of --records."""
        return _kind("records", "" if self.records is None else self.records.name)

    def by_level(self) -> dict[float, list[rw.GroundMotion]]:
        """Motions of each level; empty if the table of --records has no levels."""
        return {} if self.records is None else rw.read_records_by_level(self.records, self.reading())

    def read(self, seed: int) -> tuple[list[rw.GroundMotion], str]:
        """Ground motions with their description; by default synthetic ones.

        Raises
        ------
        ValueError
            If two sources are asked for, or one cannot be read.
        """
        from rockwobble.models.records.p695 import recorded_far_field

        excludes(self, ["p695"], "records", "synthetic")
        excludes(self, ["records"], "synthetic")
        needs(self, WAYS, "records")
        if self.p695:
            return recorded_far_field(), _kind("p695")
        if self.records is not None:
            return rw.read_records(self.records, self.reading()), self.source
        count = DEFAULT_COUNT if self.synthetic is None else self.synthetic
        return rw.synthetic_motions(count, peak=1.0, seed=seed), _kind("synthetic", str(seed))


def _kind(option: str, name: str = "") -> str:
    return written(f"motions.{option}", {"name": name}, {})


def cylinders_of(given: Sequence[str] | None, body: Body) -> dict[str, RockingBody]:
    """Cylinders of texts NAME=R,TAN_ALPHA; without any, the cylinder of the options.

    Raises
    ------
    ValueError
        If a text has another form, or a name comes twice.
    """
    if not given:
        one = body.cylinder()
        return {f"R = {one.semidiagonal:g} m, tan α = {one.tan_alpha:g}": one}
    entries: dict[str, RockingBody] = {}
    for text in given:
        name, sign, numbers = (part.strip() for part in text.partition("="))
        sizes = numbers.split(",")
        try:
            size, slenderness = map(float, sizes)
        except ValueError:
            name = ""
        if not (name and sign):
            raise ValueError(f"--cylinder must be NAME=R,TAN_ALPHA such as pier=6,0.2, got {text!r}")
        if name in entries:
            raise ValueError(f"--cylinder {name} is given twice")
        cylinder = rw.Cylinder(semidiagonal=size, tan_alpha=slenderness)
        entries[name] = under_slab(cylinder, body.slab_mass_ratio, body.columns)
    return entries


@dataclass(frozen=True, kw_only=True)
class ManyMethods:
    """Options that name many methods."""

    model: Annotated[
        list[str] | None,
        options.method(
            "Reduced model: recess, flat, planar-x, planar-y, worse-plane (larger of the two planar "
            "peaks) or none; may be repeated. Default: all; for --limit slides alone flat."
        ),
    ] = None
    engine: Annotated[
        list[str] | None, options.method(f"{options.ENGINES}. Default: none.", callback=options.engine_names)
    ] = None
    support: options.Supports = None
    setting: options.Settings = None
    time_step: options.TimeStep = None

    def methods(self, body: RockingBody, default: Sequence[str]) -> list[str | rw.Run]:
        """Methods: reduced models by name, and each engine with its supports.

        Parameters
        ----------
        body : Cylinder
            On which the settings are tried.
        default : sequence of str
            Models where none is named.

        Raises
        ------
        ValueError
            If an engine has none of the supports, or nothing has a setting.
        """
        from rockwobble.compare.runs.choice import with_settings
        from rockwobble.multibody.engines.registry import find_engine

        given, supports = settings(self.setting), self.support
        chosen: list[str | rw.Run] = [] if self.model == ["none"] else list(self.model or default)
        if not self.engine or self.engine == [options.NO_ENGINE]:
            if supports or given or self.time_step is not None:
                raise ValueError("--support, --set and --time-step are for engines, give --engine as well")
            return chosen
        runs: list[rw.Run] = []
        for name in self.engine:
            able = [each for each in supports or () if each in find_engine(name).supports]
            if supports and len(able) < len(supports):
                lacks = [each for each in supports if each not in able]
                if not able:
                    raise ValueError(f"{name} has no support {', '.join(lacks)}")
                print(f"{name} has no support {', '.join(lacks)} and is left out there")
            runs += rc.default_runs([name], able or None)
        if self.time_step is not None:
            runs = [rw.Run(run.engine, run.support, self.time_step) for run in runs]
        if given:
            runs = list(with_settings(rw.Case(body, rw.el_centro_1940()), runs, given))
        return [*chosen, *runs]


_hazard = OptionsIn("Hazard")


@dataclass(frozen=True, kw_only=True)
class Hazard(Plan):
    """Options of the seismic hazard of a site."""

    hazard: Path | None = _hazard(
        None, "Hazard curve, for the annual frequency: CSV of two named columns or of OpenQuake."
    )
    hazard_measure: str | None = _hazard(
        None,
        "Its measure: pga, pgv, sa_mean (geometric means), pga_resultant, pgv_resultant or sa (resultants).",
    )
    hazard_units: str | None = _hazard(
        None, "Unit of the intensity, such as g or cm/s2, where the header of the file does not state it."
    )
    hazard_years: float | None = _hazard(
        None,
        "Period, in years, of probabilities of exceedance, where the header of the file does not state it.",
        above=0.0,
    )
    hazard_site: int | None = _hazard(None, "Number of the site in an OpenQuake file of several.", least=1)
    risk_years: float = _hazard(50.0, "Period of the overturning probability, in years.", above=0.0)
    risk_limit: str = _hazard("overturned", 'Limit state of the annual frequency, such as "tendon yields".')
    target: float = _hazard(
        2e-4,
        "Annual frequency to compare with. Default: 2e-4, collapse of 1 % in 50 years (ASCE/SEI 7-16).",
        above=0.0,
    )
    total_dispersion: float | None = _hazard(
        None,
        "Dispersion of the lognormal curves, such as the total of FEMA P-695. Default: record to record.",
        above=0.0,
    )

    def curve(self, period: float, limits: Sequence[str]) -> rw.HazardCurve | None:
        """Hazard curve, None without a file; `period`: period of Sa [s], `limits`: given limits.

        Raises
        ------
        ValueError
            If an option stands without what it belongs to, or the file cannot be read.
        """
        from rockwobble.models.hazard import HAZARD_MEASURES
        from rockwobble.models.number_checks import require_one_of

        needs(self, [each.name for each in fields(self)], "hazard")
        if self.hazard is None:
            return None
        if self.hazard_measure is None:
            raise ValueError(f"--hazard needs --hazard-measure, one of {', '.join(HAZARD_MEASURES)}")
        require_one_of("--risk-limit", self.risk_limit, dict.fromkeys(["overturned", *limits]))
        return rw.read_hazard(
            self.hazard,
            measure=self.hazard_measure,
            period=period if self.hazard_measure in ("sa", "sa_mean") else None,
            units=self.hazard_units,
            years=self.hazard_years,
            site=self.hazard_site,
        )

    def with_risk(self, results: Fragility, site: rw.HazardCurve) -> Fragility:
        """Fragility with its annual frequencies at the site."""
        return results.with_risk(
            site,
            self.risk_years,
            total_dispersion=self.total_dispersion,
            limit=self.risk_limit,
            target=self.target,
        )


_motion = OptionsIn("Ground motion")


@dataclass(frozen=True, kw_only=True)
class GridOptions(GridPlan, ReadingOptions):
    """Options of a grid."""

    record: list[Path] | None = _motion(
        None, "File or folder with all components of a record; may be repeated."
    )
    record_x: list[Path] | None = _motion(
        None, "East-west component of a record, or zero; may be repeated. Default: El Centro 1940."
    )
    record_y: list[Path] | None = _motion(None, "North-south component of each record, or zero.")
    record_z: list[Path] | None = _motion(None, "Vertical component of each record. Default: none.")

    def grid(self, models: list[str] | None) -> rw.Grid:
        """Grid of these axes for some reduced models; default: the recess model.

        Raises
        ------
        ValueError
            If one is out of range, two do not go together, or a record cannot be read.
        """
        import numpy as np

        from rockwobble.models.support import RECESS

        given = {each.name: getattr(self, each.name) for each in fields(GridPlan)}
        given |= {name: np.linspace(*of) for name, of in self.DEFAULTS.items() if given[name] is None}
        return rw.Grid(**given, motions=self._motions(), models=models or (RECESS,))

    def _motions(self) -> list[rw.GroundMotion]:
        excludes(self, ["record"], "record_x", "record_y", "record_z")
        needs(self, ["record_z", *WAYS], "record", "record_x", "record_y")
        x, y, z = self.record_x or [], self.record_y or [], self.record_z or []
        if len(x) != len(y) or len(z) not in (0, len(x)):
            raise ValueError(
                "each record needs both horizontal components (zero for one: planar motion), and all a "
                f"vertical one or none: got {len(x)}, {len(y)} and {len(z)} files"
            )
        ups: list[Path | None] = [*z] if z else [None] * len(x)
        files = [(path, None, None) for path in self.record or ()] + [*zip(x, y, ups, strict=True)]
        return [rw.read_record(*each, **asdict(self.reading())) for each in files] or [rw.el_centro_1940()]
