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


@dataclass(frozen=True, slots=True, kw_only=True)
class AdvicePlan(Copies):
    """Advice on one case: its copies, of which 5 % have to be a run or more, and its support."""

    copies: int = option(100, "Number of perturbed copies.", group="Members", least=20, most=10_000)
    seed: int = option(1, "Seed of the perturbations.", group="Members", least=0)
    support: str = option(
        "recess",
        "Support: recess (ideal recess), flat (flat ground) or ring (recess with clearance).",
        group="Method",
    )

    def __post_init__(self) -> None:
        from rockwobble.models.support import support_named  # with numpy, which help can do without

        Plan.__post_init__(self)
        support_named(self.support)
