"""Options of the studies, apart from what they run: help is there before anything heavy is imported."""

from __future__ import annotations

from dataclasses import dataclass

from ..runs.plan import Plan, option


@dataclass(frozen=True, slots=True, kw_only=True)
class Copies(Plan):
    """Perturbed copies of a case: how many, and how different."""

    copies: int = option(20, "Number of perturbed copies.", group="Members", least=2)
    perturbation: float = option(
        0.01,
        "Relative standard deviation of tilt and rolling rate at release, or of the two components of the "
        "ground motion.",
        group="Members",
        above=0.0,
        most=0.1,
    )
    seed: int = option(0, "Seed of the perturbations.", group="Members", least=0)
