"""From the options that name many ground motions to the motions and what they are."""

from __future__ import annotations

from pathlib import Path

import rockwobble as rw
import rockwobble.compare as rc

DEFAULT_COUNT = 100  # of made-up motions, where the user does not say


def motions_of(
    p695: bool, records: Path | None, synthetic: int | None, units: str | None, seed: int
) -> tuple[list[rw.GroundMotion], str]:
    """Return the ground motions and what they are.

    Raises
    ------
    ValueError
        If two sources are asked for, or one cannot be read.
    """
    from rockwobble.compare.studies.fragility.motions import read_records, recorded_far_field

    if p695 + (records is not None) + (synthetic is not None) > 1:
        raise ValueError("the motions are those of --p695, of --records or --synthetic, got more than one")
    if units is not None and records is None:
        raise ValueError("--units belongs to --records")
    if p695:
        return recorded_far_field(), "far-field pairs of FEMA P-695"
    if records is not None:
        return read_records(records, units=units), f"records of {records.name}"
    count = DEFAULT_COUNT if synthetic is None else synthetic
    return rc.synthetic_motions(count, peak=1.0, seed=seed), f"made-up ground motions, seed {seed}"
