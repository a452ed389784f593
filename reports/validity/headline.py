"""The report in one breath, from the numbers of its limits."""

from __future__ import annotations

from collections.abc import Sequence

from rockwobble.compare.validity import Limit
from rockwobble.compare.validity.limits.limit import percent, short

# the engine is no better than this in the peak of a record; worse, and the model is not what it stands for
_SAME_PEAK = 0.05
_TOLD_APART = 0.05


def headline(limits: Sequence[Limit]) -> str:
    """Return whether the model holds in its own world, and what it is worth outside of it."""
    numbers = {limit.subject: limit.numbers for limit in limits}
    peaks, members = numbers["Peak tilt under one record"], numbers["Distributions of peak tilt"]
    form, traces = numbers["Free response: rolling out"], numbers["Single traces"]
    doubts = []
    if not peaks["engine"] <= _SAME_PEAK:
        doubts.append(f"the engine's peak tilt is off by {percent(peaks['engine'])} (median)")
    if not members["guided_p"] >= _TOLD_APART:
        doubts.append(f"its distribution of peak tilt is another (p = {short(members['guided_p'])})")
    if form["contradicted"] > 0.0:
        doubts.append(
            f"it contradicts the models at {form['contradicted']:.0f} of {form['points']:.0f} releases"
        )
    if doubts:
        return f"The reduced model is not established even in an ideal recess: {'; '.join(doubts)}."
    statistics = (
        "its distribution of peak tilt cannot be told from that on open ground"
        if members["open_p"] >= _TOLD_APART
        else "its distribution of peak tilt can be told from that on open ground"
    )
    return (
        f"In an ideal recess the reduced model is right: the engine has the same peak tilt to "
        f"{percent(peaks['engine'])} (median) and the same distribution. A cylinder on open ground leaves "
        "its trace "
        "after "
        f"{short(traces['open'])} s, and nine in ten single peaks are within "
        f"{percent(peaks['nine_in_ten'])}; "
        f"over {members['members']:.0f} records {statistics}."
    )
