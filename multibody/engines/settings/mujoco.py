"""Settings of MuJoCo, each with its reason by measurement.

Times are in the units of the user, like the time step. Each value was chosen at the reference size
(semidiagonal 6 m, h = 1e-4 s), under El Centro as well as in free response.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .values import GUIDE, build, one_of, positive, whole


@dataclass(frozen=True, slots=True, kw_only=True)
class MujocoSettings:
    """Settings of MuJoCo: its integrator and its contact.

    Attributes
    ----------
    contact_time_constant : float
        Time in which contact removes a normal velocity [s]. 2 h removes it in one step, the stiffest
        that the engine's own safety (refsafe) lets through; from 1.5 h to 4 h nothing changes.
    contact_damping_ratio : float
        1 is critical. Elastic contact chatters and does not converge.
    impedance : float
        Share of a load that contact takes at once; 0.9999 is the engine's maximum. The rest sinks in: with
        0.999 a standing cylinder has leant by the time it uplifts, which adds 2e-5 to the error under El
        Centro at 2e-4 s.
    rolling_impedance : float
        The same of the rim, once the cylinder leans; its friction stays as hard as `impedance` says. Its
        lowest point sinks and rises by a curvature of its path that no velocity shows, and where it rises by
        more than the rim has sunk in, contact is lost for a step, and with it friction. At 0.9999 that lets
        the rim slip by 1e-5 m under El Centro on (10 m, 0.1), and twice that on (6 m, 0.2) doubled, where
        the relative RMS at 1e-4 s is 1.0e-5 and 1.2e-5; at 0.995 they are 3.7e-6 and 6.4e-6, at 0.98 3.7e-6
        and 7.5e-6.
    friction_damping : float
        Share of the slip velocity that one step removes, at most 2. The rim's material point moves on
        while it rolls, and friction, which has no memory, lets it creep by (1/friction_damping - 1/2) h
        times its acceleration. At 1.8 that is a ninth of what it is at 1 (the engine's default), and still
        first order in h: from tan alpha 0.2 to 3 a release in the recess errs by 5e-6 alpha instead of
        1.3e-4. A cylinder that slides hops: friction of this kind lifts it, the more the stiffer it is.
    guide_stiffness : float
        Of each half of the guide, over the axial inertia [1/s^2]. (0.2/h)^2/4: the twist stays below 1e-6
        rad, and a period has 40 steps. In free response the stiffness makes no difference. Under El Centro
        (relative RMS on (10 m, 0.1) and (6 m, 0.2) doubled, at h = 2e-4 s) the error is 3.4e-4 and 8.3e-4 at
        (0.05/h)^2/4, 1.6e-4 and 3.6e-4 at (0.1/h)^2/4, and 1.2e-4 and 3.0e-4 here: as small as with the
        first at half the step, which is twice the cost.
    integrator : str
        Euler. At the cost of its step of 1e-4 s the error under El Centro (recess, relative RMS) is 2.0e-4
        by Euler, 2.5e-4 by implicitfast, 2.3e-4 by implicit, 3.0e-4 by RK4, whose step takes 3.2 times as
        long, and 3.9e-3 by "discrete"; that of a release 5e-6, 3e-5, 4e-5, 5e-4 and 0.5 alpha: "discrete"
        damps the guide, and is sound on flat ground. `python tests/benchmarks engine_settings` prints
        them all.
    cone : str
        The elliptic cone is Coulomb's; the friction damping above exists for it only.
    tolerance, iterations : float, int
        Of the Newton solver. One contact needs two iterations, so a tight tolerance costs nothing.
    standing_corners : int
        Corners of the inscribed prisms that carry a standing cylinder, a multiple of four up to 48. They
        turn until one of them is under the load, and once the base opens under its lean: fixed ones uplift
        early by up to 1 - cos(pi/corners) of it, and roll on as a polygon, which no step removes. Neighbours
        that share the load let the base lean before it opens, which leaves a tilt rate: so where it is about
        to open four are left, which on their own would chatter under a load near the rim. All 48 to the end
        make a relative RMS of 5.8e-5 under El Centro on (10 m, 0.1). Not in the scene of a release.
    """

    contact_time_constant: float
    contact_damping_ratio: float = 1.0
    impedance: float = 0.9999
    rolling_impedance: float = 0.995
    friction_damping: float = 1.8
    guide_stiffness: float
    integrator: str = "Euler"
    cone: str = "elliptic"
    tolerance: float = 1e-12
    iterations: int = 100
    standing_corners: int = 48

    @classmethod
    def resolve(cls, given: Mapping[str, Any], time_step: float) -> MujocoSettings:
        """Return the settings for a time step [s], with those `given` in place of the defaults.

        Raises
        ------
        ValueError
            If a setting is unknown or out of range.
        """
        settings = build(
            cls,
            "mujoco",
            given,
            {"contact_time_constant": 2.0 * time_step, "guide_stiffness": (GUIDE / time_step) ** 2 / 4.0},
        )
        positive(settings, "contact_time_constant")
        positive(settings, "contact_damping_ratio")
        positive(settings, "impedance", most=0.9999)
        positive(settings, "rolling_impedance", most=0.9999)
        positive(settings, "friction_damping", most=2.0)
        positive(settings, "guide_stiffness")
        one_of(settings, "integrator", ("Euler", "implicitfast", "implicit", "RK4", "discrete"))
        one_of(settings, "cone", ("elliptic", "pyramidal"))
        positive(settings, "tolerance", most=1e-3, or_zero=True)
        one_of(settings, "standing_corners", tuple(range(0, 49, 4)))
        whole(settings, "iterations")
        return settings
