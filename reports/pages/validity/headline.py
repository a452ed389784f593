"""The report in one breath, from the numbers of its limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rockwobble.compare.metrics.distributions import MARGIN
from rockwobble.compare.studies.validity import Limit
from rockwobble.compare.studies.validity.limits.limit import percent, short

# the engine is no better than this in the peak of a record; worse, and the model is not what it stands for
_SAME_PEAK = 0.05


def headline(limits: Sequence[Limit]) -> str:
    """Return whether the model holds in its own world, and what it is worth outside of it."""
    numbers = {limit.subject: limit.numbers for limit in limits}
    peaks, members = numbers["Peak tilt under one record"], numbers["Distributions of peak tilt"]
    form, traces = numbers["Free response: rolling out"], numbers["Single traces"]
    doubts = []
    if not peaks["engine"] <= _SAME_PEAK:
        doubts.append(f"the engine's peak tilt is off by {percent(peaks['engine'])} (median)")
    if members["recess_beyond"]:
        doubts.append(
            f"over {members['members']:.0f} records its peaks do not agree within {percent(MARGIN)} "
            "in the median"
        )
    if form["contradicted"] > 0.0:
        doubts.append(
            f"it contradicts the models at {form['contradicted']:.0f} of {form['points']:.0f} releases"
        )
    if doubts:
        return f"The reduced model is not established even in an ideal recess: {'; '.join(doubts)}."
    records = f"over {members['members']:.0f} records"
    return (
        f"In an ideal recess the reduced model is right: the engine has the same peak tilt to "
        f"{percent(peaks['engine'])} (median), and {records} {_known(members, 'recess')}. A cylinder on open "
        f"ground leaves its trace after {short(traces['open'])} s, and nine in ten single peaks are within "
        f"{percent(peaks['nine_in_ten'])}; {records} {_known(members, 'open')}."
    )


def _known(members: Mapping[str, float], place: str) -> str:
    """Return what is known of the median ratio of the peaks of a record."""
    known = f"agree within {percent(MARGIN)} in the median"
    if members[f"{place}_within"]:
        return f"peaks {known}"
    if members[f"{place}_beyond"]:
        return f"peaks do not {known}"
    return f"it is undecided whether peaks {known}"
