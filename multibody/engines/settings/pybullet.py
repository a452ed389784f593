"""Settings of PyBullet, each with its reason by measurement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .values import GUIDE, build, positive, whole


@dataclass(frozen=True, slots=True, kw_only=True)
class PybulletSettings:
    """Settings of Bullet: its contact solver; its step and its cone leave no choice.

    Attributes
    ----------
    guide_stiffness : float
        As for MuJoCo [1/s^2]; from (0.05/h)^2/4 to (0.2/h)^2/4 nothing changes, stiffer ones are worse.
    friction_damping : float
        As for MuJoCo: share of the slip velocity that one step removes. Bullet knows no other than 1, which
        is made up for by a velocity of the ground, a plane that may move along itself unseen. At 1.8 the
        error of a free response is a tenth to a seventieth of that at 1, for a quarter more time a step.
    solver_residual : float
        At which an iteration stops. Bullet's own 1e-7 leaves an error fifty times that of the step.
    iterations : int
        At most. One contact takes a few; four contacts of a standing cylinder take all, and with fewer
        it creeps and uplifts early.
    contact_slop : float
        Depth that is not corrected, at the reference size [m]. Bullet's own is 1e-5.
    contact_erp : float
        Share of a depth that one step corrects. Under El Centro, turned by three azimuths, no value from
        0.02 to 0.2 is better by more than chance; 0.8 is worse.
    collision_margin : float
        Rounds the rim, at the reference size [m]. Bullet's own, 0.04, leaves a bias that no step removes.
    """

    guide_stiffness: float
    friction_damping: float = 1.8
    solver_residual: float = 1e-16
    iterations: int = 100
    contact_slop: float = 0.0
    contact_erp: float = 0.2
    collision_margin: float = 0.0

    @classmethod
    def resolve(cls, given: Mapping[str, Any], time_step: float) -> PybulletSettings:
        """Return the settings for a time step [s], with those `given` in place of the defaults.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        settings = build(cls, "pybullet", given, {"guide_stiffness": (GUIDE / time_step) ** 2 / 4.0})
        positive(settings, "guide_stiffness")
        positive(settings, "friction_damping", most=2.0)
        positive(settings, "solver_residual")
        positive(settings, "contact_slop", most=0.1, or_zero=True)
        positive(settings, "contact_erp", most=1.0)
        positive(settings, "collision_margin", most=0.1, or_zero=True)
        whole(settings, "iterations")
        return settings
