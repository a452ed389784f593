"""Demands of a motion on ground and recess, and breaches: where they could not be met."""

from __future__ import annotations

from dataclasses import dataclass, field

from .diagnostic import Diagnostic
from .shown import Brief


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Assumptions(Brief):
    """The demands of a solution on ground and recess, as extrema of the continuous motion.

    In a frame those of base and top of a column, whichever asks for more, each over the weight it carries.

    Attributes
    ----------
    breaches : tuple of Diagnostic
        "tension", with the least normal force as its size [weights], and "friction_needed".
    least_normal_force, largest_normal_force : float
        In weights, while the cylinder is in motion; 1 if it never is.
    largest_friction_needed : float
        In motion; inf where contact is lost, 0 if it never moves.
    largest_restraining_moment : float
        Kappa of the moment kappa (z_world + z_body) of the recess, over the weight [m].
    friction : float
        The coefficient it was held against.

    Examples
    --------
    >>> import rockwobble as rw
    >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    >>> held = rw.simulate(rw.Case(pier, rw.el_centro_1940(), duration=15.0)).assumptions
    >>> held.held, round(held.largest_friction_needed, 3), round(held.least_normal_force, 2)
    (True, 0.221, 0.94)
    """

    breaches: tuple[Diagnostic, ...]
    least_normal_force: float
    largest_normal_force: float = field(repr=False)
    largest_friction_needed: float
    largest_restraining_moment: float
    friction: float

    @property
    def held(self) -> bool:
        """Whether contact and friction held throughout."""
        return not self.breaches
