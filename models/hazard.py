"""Seismic hazard: the annual frequency with which an intensity is exceeded at a site."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .argument_kinds import with_argument_kinds
from .diagnostic import Diagnostic
from .number_checks import require_increasing, require_numbers, require_one_of, require_positive
from .shown import CompactRepr

Array = NDArray[np.float64]

# name: words and unit
HAZARD_MEASURES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "pga": ("PGA, geometric mean of both components", "g"),
        "pga_resultant": ("PGA of the horizontal resultant", "g"),
        "pgv": ("PGV, geometric mean of both components", "m/s"),
        "pgv_resultant": ("PGV of the horizontal resultant", "m/s"),
        "sa": ("Sa of the horizontal resultant, 5 % damping", "g"),
        "sa_mean": ("Sa, geometric mean of both components, 5 % damping", "g"),
    }
)
_SPECTRAL = ("sa", "sa_mean")
# g or m/s: half of a site's curve above it is rather one in another unit
LARGEST_MIDDLE = 3.0


@with_argument_kinds
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class HazardCurve(CompactRepr):
    """Hazard curve of a site: annual frequency of exceedance against intensity.

    Between its points it is a straight line in logarithms of both. Beyond its ends nothing is known.

    Parameters
    ----------
    intensity : array_like, shape (n,)
        Increasing, positive [g, or m/s for velocities]; n >= 2.
    annual_frequency : array_like, shape (n,)
        Mean annual frequency with which each is exceeded, decreasing, positive [1/year].
    measure : str
        What the intensity is: "pga", "pgv" and "sa_mean" are geometric means of both horizontal components,
        "pga_resultant", "pgv_resultant" and "sa" are of the horizontal resultant.
    period : float, optional
        Period of the oscillator, for "sa" and "sa_mean" alone [s].
    name : str, optional
        Name of site and source.
    source : str, optional
        Names of its columns in a file, and what they were read as.

    Raises
    ------
    ValueError
        If the arrays differ in length, are not strictly ordered or not positive, the measure is none of
        these, or a period is missing or does not belong to it.

    Examples
    --------
    >>> site = HazardCurve([0.1, 0.2, 0.4], [1e-2, 2e-3, 2e-4], measure="pga", name="site")
    >>> site
    HazardCurve(intensity=array(3,), annual_frequency=array(3,), measure='pga', name='site')
    >>> site.exceedance([0.05, 0.2, 0.3])
    array([       nan, 0.002     , 0.00052008])
    >>> round(site.intensity_at(-math.log(0.98) / 50.0), 4)
    0.3237
    """

    intensity: Array
    annual_frequency: Array
    measure: str = field(kw_only=True)
    period: float | None = field(default=None, kw_only=True)
    name: str = field(default="", kw_only=True)
    source: str = field(default="", kw_only=True)

    def __post_init__(self) -> None:
        measure_of(self.measure, self.period)
        x = require_increasing("intensity of a hazard curve", self.intensity)
        frequency = require_numbers("annual_frequency", self.annual_frequency)
        if len(x) < 2 or frequency.shape != x.shape:
            raise ValueError(
                "a hazard curve needs an annual frequency for each of two or more intensities, got "
                f"{frequency.size} for {len(x)}"
            )
        wrong = np.flatnonzero(~(np.isfinite(frequency) & (frequency > 0.0)))
        if len(wrong):
            raise ValueError(
                f"annual_frequency must be positive and finite, got {frequency[wrong[0]]:g} at "
                f"{x[wrong[0]]:g}"
            )
        rising = np.flatnonzero(np.diff(frequency) >= 0.0)
        if len(rising):
            at = rising[0]
            raise ValueError(
                f"annual_frequency must decrease with intensity, got {frequency[at]:g} at {x[at]:g} and "
                f"{frequency[at + 1]:g} at {x[at + 1]:g}"
            )
        for name, values in (("intensity", x), ("annual_frequency", frequency)):
            values = values.copy()
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    @property
    def title(self) -> str:
        """Measure in words, with its period and unit."""
        words, unit = HAZARD_MEASURES[self.measure]
        return f"{words}, T = {self.period:g} s [{unit}]" if self.period else f"{words} [{unit}]"

    @property
    def doubts(self) -> tuple[Diagnostic, ...]:
        """Doubt about its unit, "large_hazard": half of its points lie above 3 g or 3 m/s."""
        middle = float(np.median(self.intensity))
        if middle <= LARGEST_MIDDLE:
            return ()
        unit = HAZARD_MEASURES[self.measure][1]
        return (Diagnostic(code="large_hazard", size=middle, bound=LARGEST_MIDDLE, detail=unit),)

    def exceedance(self, intensity: ArrayLike) -> Array:
        """Return annual frequencies of exceedance [1/year] at intensities; NaN beyond the ends."""
        x = np.log(np.asarray(intensity, dtype=np.float64))
        return np.exp(
            np.interp(x, np.log(self.intensity), np.log(self.annual_frequency), left=np.nan, right=np.nan)
        )

    def intensity_at(self, annual_frequency: float) -> float:
        """Return the intensity that is exceeded with an annual frequency [1/year]; NaN beyond the ends."""
        y = -np.log(self.annual_frequency)
        found = np.interp(-math.log(annual_frequency), y, np.log(self.intensity), left=np.nan, right=np.nan)
        return float(np.exp(found))


def measure_of(measure: str, period: float | None) -> tuple[str, float | None]:
    """Return a measure of hazard and its period, checked.

    Raises
    ------
    ValueError
        If it is none of `HAZARD_MEASURES`, or a period is missing or does not belong to it.
    """
    require_one_of("the measure of a hazard curve", measure, HAZARD_MEASURES)
    if measure in _SPECTRAL:
        if period is None:
            raise ValueError(f"a hazard curve of {measure} needs the period of its oscillator [s]")
        require_positive("period", period, "s")
    elif period is not None:
        raise ValueError(f"a period belongs to sa and sa_mean, got {period:g} s with {measure}")
    return measure, period
