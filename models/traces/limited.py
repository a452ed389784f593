"""Diagnostics of a motion, breaches of the assumptions of its method included."""

from __future__ import annotations

import math
from functools import cached_property

from ..assumptions import Assumptions
from ..diagnostic import Diagnostic
from .trace_source import Source


class Limited:
    """A motion whose source knows whether the assumptions of its method held.

    Attributes
    ----------
    facts : tuple of Diagnostic
        What ended or limits the motion, the assumptions apart.
    source : Source
    """

    facts: tuple[Diagnostic, ...]
    source: Source

    @cached_property
    def assumptions(self) -> Assumptions | None:
        """Whether contact and friction held, from extrema of the continuous motion; None if not known."""
        return self.source.assumptions(math.inf)

    def assumptions_until(self, end: float) -> Assumptions | None:
        """Return whether contact and friction held until the time `end` [s], such as that of a fall.

        A trace that was stored knows it of its whole run alone.

        Parameters
        ----------
        end : float
            In the time of the run [s].

        Returns
        -------
        Assumptions or None
        """
        return self.source.assumptions(end)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What ended or limits the motion, breaches of the model's assumptions included."""
        return self.facts + (self.assumptions.breaches if self.assumptions else ())

    def first(self, *codes: str) -> float:
        """Return the earliest time at which a diagnostic of these codes holds [s]; infinite if none does.

        Parameters
        ----------
        *codes : str
            Of `rockwobble.models.diagnostic.CODES`.

        Returns
        -------
        float
            [s]

        Examples
        --------
        >>> import rockwobble as rw
        >>> pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
        >>> release = rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5)
        >>> case = rw.Case(pier, initial=release, duration=4.0)
        >>> rw.simulate(case).first("slip", "friction_needed")
        inf
        """
        return min((fact.time for fact in self.diagnostics if fact.code in codes), default=math.inf)
