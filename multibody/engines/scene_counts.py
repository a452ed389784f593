"""Counts of degrees of freedom, contacts and constraint rows of a scene, per step."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneCounts:
    """Sizes of the problem that the last step solved.

    Attributes
    ----------
    degrees_of_freedom : int
    contacts : int
        Points.
    constraint_rows : int
        Scalar constraints, normal and of friction.
    """

    degrees_of_freedom: int
    contacts: int
    constraint_rows: int
