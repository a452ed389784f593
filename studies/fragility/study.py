"""Fragility: probability that shaking of an intensity exceeds a limit, by several methods."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pandas as pd

from rockwobble.compare.metrics.statistics import FEWEST
from rockwobble.compare.runs.progress import ProgressCallback
from rockwobble.compare.storage.manifest import Number
from rockwobble.compare.storage.provenance import fingerprint
from rockwobble.compare.storage.results import Results
from rockwobble.models import GroundMotion, HazardCurve, RockingBody, Run
from rockwobble.models.argument_kinds import with_argument_kinds
from rockwobble.models.doubts import doubts_about
from rockwobble.models.finding import Findings
from rockwobble.models.ground_motion import sources_of
from rockwobble.models.number_checks import require_each, require_one_of, require_positive
from rockwobble.models.plain_json import Facts, fields_of, plain
from rockwobble.models.support import RECESS
from rockwobble.models.trace import NO_PEAK

from ..plans import FragilityPlan
from .findings import FEWEST_LEVELS, fragility_findings
from .fit import TOO_FEW
from .intensity import velocity_unit
from .risk import RARE, TARGET, exposures_of, measure_factor, risk_findings, risk_tables
from .runs import (
    MODEL_LABELS,
    Method,
    RunPlan,
    default_levels,
    default_models,
    methods_of,
    motions_by_level,
    own_model,
)
from .tables import (
    DEFAULT_LIMITS,
    LIMITS,
    OVERTURNED,
    SLIDES,
    TENDON_YIELDS,
    Row,
    blocks_of,
    contrast_table,
    count_table,
    curve_table,
    curves_of,
    efficiency_table,
    fit_table,
    gap_table,
    rows_of,
)

KIND = "fragility"
_COUNTED = ("cylinder", "method", "limit", "runs", "exceeded", "failed")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Fragility(Results, kind=KIND):
    """Probabilities of exceeding limits by several methods, under the same motions.

    Intervals are of 95 %, by resampling the motions; their ends are in columns NAME_low and NAME_high.

    Attributes
    ----------
    runs : DataFrame
        One row for each cylinder, motion, step (place of the level) and method: peak_tilt [alpha], outcome,
        contact_lost and slides (1, 0, NaN where nobody asked).
    points : DataFrame
        One row for each cylinder, motion and step: scale, and every intensity of `MEASURES`,
        "peak_over_friction" where it is the measure.
    counts : DataFrame
        n runs and k that exceed a limit, by cylinder, method, limit and intensity.
    fits : DataFrame
        One row for each cylinder, method and limit: kind ("fitted", "never", "always", "separated", "not
        increasing"; "extrapolated", where the median lies beyond the intensities that were run; "one motion",
        where all that exceed the limit, or all that do not, are of one; of fewer motions or levels than a
        curve takes "too few", and no number but counts; then the tables below are empty), median (infinite or
        0 where it lies beyond the intensities that were run, and so is that end of its interval),
        median_if_exceeded and median_if_not (were all failed runs to exceed the limit, or none), dispersion,
        runs, exceeded, failed, extrapolated, without_curve (share of the resamples), and of the goodness of
        fit deviance, degrees, p and largest (difference of share and curve).
    curves : DataFrame
        The curves point by point: intensity, probability, low, high.
    contrasts : DataFrame
        One row for each two methods: ratio of the medians, dispersion_difference, within (least margin that
        holds the interval of the ratio), verdict for the margin of the facts, ratio_least and ratio_most
        (whatever the failed runs of both would have done).
    efficiency : DataFrame
        Dispersion of the first method by each measure, and over that of the best.
    gaps : DataFrame
        Gaps in the overturning region: motions that overturn a cylinder which stands under the same motion
        made stronger, and bias of the median of an analysis that stops at the first overturning.

    Its facts are cylinders, methods, measure, levels, margin, seed, and the hash of all inputs.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> shaking = rw.synthetic_motions(6, peak=1.0, seed=1)
    >>> study = rw.fragility(pier, shaking, methods=["recess"], levels=[2, 4, 8], resamples=20, workers=1)
    >>> overturned = study.fits[study.fits["limit"] == "overturned"]
    >>> overturned[["method", "runs", "exceeded"]].to_dict("records")
    [{'method': 'recess model', 'runs': 18, 'exceeded': 10}]
    """

    def headline(self) -> dict[str, Number]:
        """Medians of overturning, or counts if there are too few motions, and ratios of the medians."""
        fits, contrasts = (
            [row for row in rows_of(table) if row["limit"] == OVERTURNED]
            for table in (self.fits, self.contrasts)
        )
        medians: dict[str, Number] = {
            f"{row['cylinder']}, {row['method']}, overturned of {row['runs']}": row["exceeded"]
            if row["kind"] == TOO_FEW
            else self.median_or_bound(row["cylinder"], row["median"])
            for row in fits
        }
        return medians | {
            f"{row['cylinder']}, {row['method']} / {row['against']}": known_ratio(row["ratio"])
            for row in contrasts
        }

    def median_or_bound(self, cylinder: str, median: float) -> float | str:
        """Median; a bound in words, such as "> 12", if it lies beyond the intensities run."""
        if math.isnan(median) or 0.0 < median < math.inf:
            return float(median)
        run = self.counts.loc[self.counts["cylinder"] == cylinder, "intensity"]
        return f"> {run.max():.3g}" if median > 0.0 else f"< {run.min():.3g}"

    def risk(
        self,
        hazard: HazardCurve,
        years: float = 50.0,
        *,
        total_dispersion: float | None = None,
        limit: str = OVERTURNED,
        target: float = TARGET,
    ) -> pd.DataFrame:
        """Mean annual frequency of overturning at a site, with and without a fitted curve.

        The first is the integral of the share of the motions that overturn over the hazard curve, exact for
        a hazard that is a power law between its points and shares that are linear in the logarithm between
        levels; so safe gaps count as they are.

        Parameters
        ----------
        hazard : HazardCurve
            Hazard of a measure that the motions of this fragility have.
        years : float, optional
            For the probability [years].
        total_dispersion : float, optional
            Dispersion of the lognormal curves, as that of FEMA P-695 which holds uncertainty of design, tests
            and modelling. Default: that of the motions.
        limit : str, optional
            Limit state, one of `LIMITS`.
        target : float, optional
            Annual frequency that is compared with the interval [1/year]. Default: 2e-4, the collapse of 1 %
            in 50 years of ASCE/SEI 7-16, 21.2.1.2.

        Returns
        -------
        DataFrame
            For each cylinder and method annual_frequency [1/year] and its 95 % interval by resampling the
            motions, wider by what the levels and the ends of the hazard leave open (where fewer than five
            overturn: from 0 to the bound of Clopper and Pearson at each level); annual_frequency_most, if
            what overturns at the lowest level did so from uplift on and all overturned beyond the last level
            or the last point of the hazard; annual_frequency_fit by the lognormal curve; verdict ("below" the
            target, "above", or "inconclusive"); probability of one or more in so many years; margin, the
            median over the intensity that is exceeded with 2 % in 50 years; head_share, the part of motions
            that overturn at the lowest level, or at the first point of the hazard, already; tail_share, that
            rests on intensities beyond the last level or point; far_share, on factors above 5 on the motions;
            ratio to the first method, its interval of the same resamples; motions, overturning_motions,
            failed (runs).

        Raises
        ------
        ValueError
            If the hazard is of a measure or a period that this fragility does not have.
        """
        return self.with_risk(
            hazard, years, total_dispersion=total_dispersion, limit=limit, target=target
        ).tables["risk"]

    def with_risk(
        self,
        hazard: HazardCurve,
        years: float = 50.0,
        *,
        total_dispersion: float | None = None,
        limit: str = OVERTURNED,
        target: float = TARGET,
    ) -> Fragility:
        """Fragility with the tables risk and contributions, and the hazard among its facts."""
        require_positive("years", years, "years")
        require_positive("target", target, "1/year")
        facts = self.facts
        allowed = [name for name in LIMITS if name in (OVERTURNED, *facts["limits"])]
        require_one_of("the limit of a risk", limit, allowed)
        if total_dispersion is not None:
            require_positive("total_dispersion", total_dispersion)
        of_hazard = {
            name: measure_factor(hazard, body, facts["period"]) for name, body in facts["cylinders"].items()
        }
        blocks = blocks_of(self.runs, self.points, facts["limits"], str(facts["measure"]))
        exposures = exposures_of(blocks, of_hazard, total_dispersion, limit)
        weights = blocks.weights(int(facts["resamples"]), int(facts["seed"]))
        risk, contributions = risk_tables(
            blocks, exposures, hazard, weights=weights, years=years, target=target
        )
        site = {"name": hazard.name, "title": hazard.title, "years": years, "rare": hazard.intensity_at(RARE)}
        site |= {"source": hazard.source, "total_dispersion": total_dispersion}
        site |= {"limit": limit, "target": target}
        doubts = [{"record": hazard.name or "hazard"} | fields_of(fact) for fact in hazard.doubts]
        return replace(
            self,
            tables={**self.tables, "risk": risk, "contributions": contributions},
            facts=plain({**facts, "hazard": site, "doubts": [*facts.get("doubts", ()), *doubts]}),
            manifest=None,
        )

    def findings(self) -> Findings:
        """Findings on medians or their bounds, ratios of methods, input, and risk."""
        contrasts, risk = main_contrasts(self), rows_of(self.tables.get("risk", pd.DataFrame()))
        own = fragility_findings(self.facts, rows_of(self.fits), contrasts, self.median_or_bound)
        return Findings([*own, *(risk_findings(risk, self.facts["hazard"]) if risk else ())])

    def sheets(self) -> dict[str, bytes]:
        """Counts as CSV and as JSON, for tools that fit curves of their own."""
        rows = self.counts.to_dict("records")
        return {
            "counts.csv": self.counts.to_csv(index=False).encode(),
            "counts.json": (json.dumps(rows, indent=0, ensure_ascii=False) + "\n").encode(),
        }

    def _main_facts(self) -> dict[str, str]:
        runs = self.runs
        counts = {
            "cylinders": runs["cylinder"].nunique(),
            "motions": runs["motion"].nunique(),
            "runs": len(runs),
            "failed": runs["outcome"].isin(NO_PEAK).sum(),
        }
        methods = ", ".join(dict.fromkeys(runs["method"]))
        return {name: str(count) for name, count in counts.items()} | {"methods": methods}


def known_ratio(ratio: float) -> float | None:
    """Ratio of medians; None if one of them is only a bound."""
    return float(ratio) if 0.0 < ratio < math.inf else None


def fragility_of(runs: pd.DataFrame, points: pd.DataFrame, facts: Facts) -> Fragility:
    """Fragility from the runs of the plan in `facts`."""
    if runs["outcome"].isin(NO_PEAK).all():
        raise ValueError(f"a fragility needs runs that do not fail, got {len(runs)} runs that all failed")
    blocks = blocks_of(runs, points, facts["limits"], str(facts["measure"]))
    weights = blocks.weights(int(facts["resamples"]), int(facts["seed"]))
    fitted, drawn = curves_of(blocks), curves_of(blocks, weights)
    tables = {
        "runs": runs,
        "points": points,
        "counts": count_table(blocks),
        "fits": fit_table(blocks, fitted, drawn),
        "curves": curve_table(blocks, fitted, drawn),
        "contrasts": contrast_table(blocks, fitted, drawn, weights, float(facts["margin"])),
        "efficiency": efficiency_table(blocks, blocks.methods[0], weights),
        "gaps": gap_table(blocks, weights),
    }
    levels = points.groupby("cylinder")[blocks.measure].nunique()
    if blocks.fewest < FEWEST or levels.min() < FEWEST_LEVELS:
        fits = tables["fits"]
        counts = fits[[*_COUNTED]].reindex(columns=fits.columns)
        tables |= {name: tables[name].iloc[:0] for name in ("curves", "contrasts", "efficiency", "gaps")}
        tables["fits"] = counts.assign(kind=TOO_FEW, extrapolated=False)
    return Fragility(tables=tables, facts=plain(facts))


def main_contrasts(fragility: Fragility) -> dict[str, list[Row]]:
    """Contrasts that answer the three questions on overturning, by question.

    "planar": each planar method against the recess model; "support": the same method on another support
    against the recess; "engine": an engine against the model of its support, and another engine on it.
    """
    methods: Mapping[str, Mapping[str, Any]] = fragility.facts["methods"]
    answers: dict[str, list[Row]] = {"planar": [], "support": [], "engine": []}
    for row in rows_of(fragility.contrasts):
        question, turned = _question(methods, row["method"], row["against"])
        if question and row["limit"] == OVERTURNED:
            answers[question].append(_inverse(row) if turned else row)
    return answers


def _question(methods: Mapping[str, Mapping[str, Any]], method: str, against: str) -> tuple[str, bool]:
    """Question that a pair answers, and whether its order is reversed; "" for none."""
    one, other = methods[method], methods[against]
    engines, supports = ([each[name] for each in (one, other)] for name in ("engine", "support"))
    if engines[0] == engines[1]:
        recess = [support == RECESS for support in supports]
        question = "planar" if engines[0] is None and "planar" in supports else "support"
        return (question, recess[0]) if recess[0] != recess[1] else ("", False)
    turned = engines[0] is None
    if None in engines:
        model, engine = (method, other) if turned else (against, one)
        return ("engine", turned) if engine["own_model"] == model else ("", False)
    return ("engine", False) if supports[0] == supports[1] else ("", False)


def _inverse(row: Row) -> Row:
    """Contrast with its methods exchanged."""
    ratios = {"ratio": "ratio", "ratio_low": "ratio_high", "ratio_high": "ratio_low"}
    ratios |= {"ratio_least": "ratio_most", "ratio_most": "ratio_least"}
    spread = "dispersion_difference"
    spreads = {spread: spread, f"{spread}_low": f"{spread}_high", f"{spread}_high": f"{spread}_low"}
    return (
        row
        | {"method": row["against"], "against": row["method"]}
        | {name: 1.0 / row[other] if row[other] else math.inf for name, other in ratios.items()}
        | {name: -row[other] for name, other in spreads.items()}
    )


_ALL = tuple(MODEL_LABELS)


@with_argument_kinds
def fragility(
    cylinders: RockingBody | Mapping[str, RockingBody] | Sequence[RockingBody],
    motions: Sequence[GroundMotion] | Mapping[float, Sequence[GroundMotion]],
    *,
    methods: Iterable[str | Run] = _ALL,
    measure: str = "peak_acceleration",
    levels: Sequence[float] | None = None,
    scales: Sequence[float] | None = None,
    period: float = 1.0,
    limits: Sequence[str] | None = None,
    margin: float = 0.1,
    resamples: int = 1000,
    seed: int = 0,
    restitution: float | str = 1.0,
    step_factor: float = 1.0,
    friction: float = 1.0,
    gap: float | None = None,
    rolling_resistance: float = 0.0,
    tendon_prestress: float = 0.0,
    tendon_stiffness: float = 0.0,
    tendon_yield: float | None = None,
    gravity: float = 9.81,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: ProgressCallback | None = None,
    resume: str | Path | None = None,
    source: str = "ground motions",
) -> Fragility:
    """Fit the probability of exceeding limits by several methods under the same motions.

    Parameters
    ----------
    cylinders : Cylinder, or mapping of names or sequence of them
    motions : sequence of GroundMotion, or mapping of levels to them
        At least two, with different names, each scaled to every level. A mapping gives each level motions of
        its own, which are scaled to it (multiple stripes): at least two a level, and no `levels` beside it.
    methods : iterable of str or Run, optional
        Reduced models by name, "recess", "flat", "planar-x", "planar-y", "worse-plane" (of the two, motion
        by motion), and runs of engines with any support. Default: all five models, with a tendon all but
        flat, for the limit "slides" alone flat. The first is the one whose efficient measure is sought. In a
        ring, whose walls have no top, a cylinder that leans on a wall beyond its balance at the end has
        overturned.
    measure : str, optional
        Intensity, one of `MEASURES`.
    levels : sequence of float, optional
        Intensities to which every motion is scaled (stripes). Default: 20, from a little above uplift to
        where most overturn.
    scales : sequence of float, optional
        Factors on the motions as they are (a cloud), in the place of levels.
    period : float, optional
        Period of "sa" and "sa_mean" [s].
    limits : sequence of str, optional
        Limits, from `LIMITS`. Default: all but contact_lost, "tendon yields" without a yield force and
        "slides" without a gap.
    margin : float, optional
        Relative difference within which two medians are equivalent.
    resamples, seed : int, optional
        Number of resamples, and seed, of the bootstrap.
    restitution : float or "momentum", optional
        Restitution of the planar models.
    step_factor : float, optional
        On the default time step of engines.
    friction : float, optional
        Coefficient of cylinder and ground, also of the measure "peak_over_friction".
    gap : float, optional
        Displacement on flat ground that the limit "slides" asks for [m].
    rolling_resistance : float, optional
        Length of the couple against rolling [m].
    tendon_prestress, tendon_stiffness : float, optional
        Tendon prestress and tendon stiffness of a tendon in each body [weights of one column, and these per
        base radius].
    tendon_yield : float, optional
        Its yield force [weights of one column]: a run that passes it is no answer.
    gravity : float, optional
        g [m/s^2].
    workers, scheduler, progress : optional
        As in `run_tasks`.
    resume : str or Path, optional
        Folder that keeps each finished run: a second call, after whatever ended the first, repeats none.
    source : str, optional
        Name of the set of motions.

    Returns
    -------
    Fragility
        Failed runs are left out and counted, with bounds of what they may have changed.

    Raises
    ------
    ValueError
        If an argument is out of range, or an engine cannot run.
    IncompleteError
        If the Dask cluster cannot do the runs, as where a worker has another version of an engine.

    Examples
    --------
    >>> from rockwobble.models import synthetic_motions
    >>> from rockwobble.models import Cylinder
    >>> column = Cylinder(semidiagonal=3.0, tan_alpha=0.15)
    >>> shaking = synthetic_motions(8, peak=1.0, seed=1)
    >>> study = fragility(column, shaking, methods=["recess"], levels=[1.5, 3, 6], resamples=50, workers=1)
    >>> overturned = study.counts[study.counts["limit"] == "overturned"]
    >>> list(zip(overturned["intensity"], overturned["k"], overturned["n"]))
    [(1.5, 0, 8), (3.0, 6, 8), (6.0, 8, 8)]
    """
    stripes: dict[str, tuple[int, ...]] | None = None
    if isinstance(motions, Mapping):
        if levels is not None or scales is not None:
            raise ValueError("motions by level have levels of their own: leave out levels and scales")
        levels, motions, stripes = motions_by_level(motions)
    require_each("motions", motions, GroundMotion)
    bodies = _by_name(cylinders)
    asked = FragilityPlan(
        measure=measure,
        levels=levels,
        scales=scales,
        period=period,
        limits=limits,
        margin=margin,
        resamples=resamples,
        seed=seed,
        restitution=restitution,
        step_factor=step_factor,
        friction=friction,
        gap=gap,
        rolling_resistance=rolling_resistance,
        tendon_prestress=tendon_prestress,
        tendon_stiffness=tendon_stiffness,
        tendon_yield=tendon_yield,
        gravity=gravity,
    )
    if methods is _ALL:
        methods = default_models(asked)
    chosen = methods_of(methods, restitution=asked.restitution)
    if asked.levels is None and asked.scales is None and motions:  # without, the plan says what is missing
        asked = replace(asked, levels=default_levels(bodies, motions, asked))
    plan = RunPlan(cylinders=bodies, motions=motions, methods=chosen, options=asked, stripes=stripes)
    doubts = doubts_about(motions=motions, cylinders=bodies.values(), gravities=[asked.gravity])
    facts = _facts(plan) | {"source": source, "doubts": doubts, "record_sources": sources_of(motions)}
    runs = plan.run(folder=resume, workers=workers, scheduler=scheduler, progress=progress)
    return fragility_of(runs, plan.points, facts)


def _facts(plan: RunPlan) -> dict[str, object]:
    asked = plan.options
    named = ("measure", "period", "margin", "resamples", "seed", "gravity", "friction", "step_factor")
    return {
        "cylinders": {
            name: {
                "semidiagonal": body.semidiagonal,
                "tan_alpha": body.tan_alpha,
                "velocity_unit": velocity_unit(body, asked.gravity),
            }
            | ({"slab_mass_ratio": body.slab_mass_ratio} if body.slab_mass_ratio else {})
            for name, body in plan.cylinders.items()
        },
        "motions": len(plan.motions),
        "methods": {method.label: _description(method, plan.methods) for method in plan.methods},
        "levels": None if asked.levels is None else list(map(float, asked.levels)),
        "scales": list(plan.scales) if asked.levels is None else None,
        # motions by level, where each level has its own
        "motions_of_levels": None if plan.stripes is None else plan.motions_of_levels(),
        "limits": [name for name in LIMITS if name in limits_of(asked)],
        **{name: getattr(asked, name) for name in named},
        **({"rolling_resistance": asked.rolling_resistance} if asked.rolling_resistance else {}),
        **({} if asked.gap is None else {"gap": asked.gap}),
        **({} if asked.tendon is None else {"tendon": fields_of(asked.tendon)}),
        "inputs": fingerprint([(task.name, task.label, plan.key(task)) for task in plan.tasks()]),
    }


def limits_of(asked: FragilityPlan) -> Sequence[str]:
    """Limits of a plan; by default those without contact forces, and "tendon yields" if it can.

    Raises
    ------
    ValueError
        If a tendon without a yield force is to yield: a plan may get its tendon later, from a drawing.
    """
    if asked.tendon_yield is None and TENDON_YIELDS in (asked.limits or ()):
        raise ValueError(f'the limit "{TENDON_YIELDS}" needs the yield force (--tendon-yield, tendon_yield=)')
    more = {TENDON_YIELDS: asked.tendon_yield, SLIDES: asked.gap}
    return asked.limits or (*DEFAULT_LIMITS, *(name for name, given in more.items() if given is not None))


def _description(method: Method, methods: Sequence[Method]) -> dict[str, object]:
    return {
        "support": method.support,
        "engine": method.run.engine if method.run is not None else None,
        "own_model": own_model(method, methods),
        "run": None if method.run is None else fields_of(method.run),
    }


def _by_name(
    cylinders: RockingBody | Mapping[str, RockingBody] | Sequence[RockingBody],
) -> dict[str, RockingBody]:
    if isinstance(cylinders, Mapping):
        return dict(cylinders)
    several = [cylinders] if isinstance(cylinders, RockingBody) else cylinders
    named = {f"R = {each.semidiagonal:g} m, tan α = {each.tan_alpha:g}": each for each in several}
    if len(named) < len(several):
        raise ValueError("cylinders of the same size and slenderness need names: give them as a mapping")
    return named
