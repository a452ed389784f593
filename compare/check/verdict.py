"""Verdict on two fingerprints, in one word: same, chaotic or changed. Needs numpy only.

    python verdict.py CERTIFICATE OTHER_CERTIFICATE

same: every number repeats as closely as the certificate says. chaotic: what differs does so after the time
when agreement must end, and the largest tilts of many perturbed copies from then on agree in distribution.
changed: something differs before that, or in distribution; claim and term of the first such case are named.
Of the other certificate only the cases of the first count. Exit code 0, 0 and 1; 2 if a file cannot be read,
or the other lacks a case.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Literal, NotRequired, TypedDict

import numpy as np

SAME, CHAOTIC, CHANGED = "same", "chaotic", "changed"
KIND, FORMAT = "rockwobble certificate", 3
# Kolmogorov-Smirnov distance of two samples that chance exceeds once in a hundred times, over sqrt(1/n + 1/m)
_ONE_PERCENT = 1.63


class Sample(TypedDict):
    """Numbers of one case; None for an unknown number."""

    name: str
    claim: str
    term: str
    support: str
    outcome: str
    uplift_time: float | None
    uplift_direction: float | None
    peak_tilt: float | None
    time: list[float]
    signals: dict[str, list[float | None]]
    copies: NotRequired[list[list[float | None]]]  # tilts of each copy, over alpha, at the times above


class Entry(Sample):
    """Sample with the end of the comparison and, by signal, the repeatability of its numbers."""

    agreement_time: float | None
    repeats: float
    allowed: dict[str, list[float]]


class Described(TypedDict):
    """Description of a method."""

    engine: str | None
    time_step: float | Literal["auto", "extrapolated"] | None
    settings: dict[str, float | int | str | bool | None]


class Certificate(TypedDict):
    """Content of a certificate."""

    kind: str
    format: int
    method: Described
    versions: dict[str, str]
    commit: str
    claims: list[dict[str, object]]
    not_covered: list[str]
    fingerprint: list[Entry]
    plan: NotRequired[str]  # hash of the command


@dataclass(frozen=True)
class FingerprintVerdict:
    """Verdict on two fingerprints: the word, and the case that decides it.

    Parameters
    ----------
    word : {"same", "chaotic", "changed"}
    case, claim, term : str
        Case, claim and term of the case that decides; empty where all are the same.
    quantity : str
        What differs there.
    time : float
        From when [s]; NaN where it has no time.
    difference, allowed : float
        How much there, and how much may be.
    """

    word: str
    case: str = ""
    claim: str = ""
    term: str = ""
    quantity: str = ""
    time: float = math.nan
    difference: float = math.nan
    allowed: float = math.nan

    @property
    def exit_code(self) -> int:
        """1 where it changed."""
        return int(self.word == CHANGED)

    def __str__(self) -> str:
        """The word, and the numbers of the case that decides, by the names of the parameters."""
        known = {name: value for name, value in asdict(self).items() if value == value != ""}
        return "; ".join([known.pop("word"), *(f"{name}: {value}" for name, value in known.items())])


def compare(old: Iterable[Entry], new: Iterable[Sample]) -> FingerprintVerdict:
    """Verdict on two fingerprints; the entries of `new` are computed only up to the first change."""
    verdict = FingerprintVerdict(SAME)
    for one, other in zip(old, new, strict=True):
        case_verdict = compare_entries(one, other)
        if case_verdict.word == CHANGED:
            return case_verdict
        if verdict.word == SAME:
            verdict = case_verdict
    return verdict


def compare_entries(old: Entry, new: Sample) -> FingerprintVerdict:
    """Return the verdict on one case."""
    decided = partial(FingerprintVerdict, case=old["name"], claim=old["claim"], term=old["term"])
    end = math.inf if old["agreement_time"] is None else old["agreement_time"]
    if old["name"] != new["name"]:
        return decided(CHANGED, quantity="the case itself")
    for name in ("uplift_time", "uplift_direction"):
        apart = _difference(old[name], new[name])
        if apart > 10.0 * old["repeats"]:
            return decided(CHANGED, quantity=name, difference=apart, allowed=10.0 * old["repeats"])
    first = _first_difference(old, new)
    if first is not None and first[1] < end:
        return decided(CHANGED, quantity=first[0], time=first[1], difference=first[2], allowed=first[3])
    apart = _difference(old["peak_tilt"], new["peak_tilt"])
    if end == math.inf:
        allowed = 10.0 * max(old["allowed"]["tilt"])
        if old["outcome"] != new["outcome"]:
            return decided(CHANGED, quantity=f"outcome {old['outcome']}, now {new['outcome']}")
        if apart > allowed:
            return decided(CHANGED, quantity="peak_tilt", difference=apart, allowed=allowed)
        return FingerprintVerdict(SAME)
    if first is None and old["outcome"] == new["outcome"]:
        return FingerprintVerdict(SAME)
    old_peaks, new_peaks = (late_peaks(one, end) for one in (old, new))
    if not len(new_peaks):
        return decided(CHANGED, quantity="agreement time, which no longer ends")
    gap = largest_gap(old_peaks, new_peaks)
    most = _ONE_PERCENT * math.sqrt(1.0 / len(old_peaks) + 1.0 / len(new_peaks))
    time = first[1] if first else math.nan
    word = CHAOTIC if gap <= most else CHANGED
    return decided(word, quantity="distribution of the late peaks", difference=gap, allowed=most, time=time)


def late_peaks(entry: Sample, end: float) -> np.ndarray:
    """Largest sampled tilt of each copy from a time on; its last tilt if it ended before."""
    entries = []
    for copy in entry.get("copies", ()):
        known = [tilt for tilt in copy if tilt is not None]
        late = [tilt for time, tilt in zip(entry["time"], known, strict=False) if time >= end]
        if known:
            entries.append(max(late, default=known[-1]))
    return np.array(entries)


def _first_difference(old: Entry, new: Sample) -> tuple[str, float, float, float] | None:
    """Signal, time, difference and allowed difference where the first sample differs."""
    entries = []
    for name, wanted in old["signals"].items():
        got = new["signals"][name]
        for k in range(max(len(wanted), len(got))):
            last = min(k, len(wanted) - 1)
            # a motion that has ended has no sample
            there = k < min(len(wanted), len(got))
            apart = _difference(wanted[k], got[k]) if there else math.inf
            moved = there and abs(old["time"][k] - new["time"][k]) > 10.0 * old["repeats"]
            if apart > old["allowed"][name][last] or moved:
                entries.append((old["time"][last], name, apart, old["allowed"][name][last]))
                break
    time, name, apart, allowed = min(entries, default=(math.nan, "", 0.0, 0.0))
    return (name, time, apart, allowed) if entries else None


def _difference(one: float | None, other: float | None) -> float:
    """Difference of two numbers: none where neither is known, infinite where only one is."""
    if one is None or other is None:
        return 0.0 if one is other else math.inf
    return abs(one - other)


def largest_gap(first: np.ndarray, second: np.ndarray) -> float:
    """Return the Kolmogorov-Smirnov distance of two samples."""
    both = np.concatenate([first, second])
    below = [np.searchsorted(np.sort(one), both, side="right") / len(one) for one in (first, second)]
    return float(np.max(np.abs(below[0] - below[1])))


def read_certificate(path: Path) -> Certificate:
    """Return the content of a certificate.

    Raises
    ------
    ValueError
        If the file cannot be read, is no certificate, a part of one, or of another format.
    """
    try:
        content: Certificate = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(f"{path} cannot be read: {error.strerror or error}") from None
    except ValueError:
        raise ValueError(f"{path} is not a certificate (JSON, written by rockwobble certify)") from None
    if not isinstance(content, dict) or content.get("kind") != KIND:
        raise ValueError(f"{path} is no certificate: its kind must be {KIND!r}")
    lacks = [
        name for name, kind in (("format", int), ("method", dict)) if not isinstance(content.get(name), kind)
    ]
    entries = content.get("fingerprint")
    if not lacks and content["format"] != FORMAT:
        raise ValueError(f"{path} has format {content['format']}, this version reads {FORMAT}: make it anew")
    if not lacks and not (isinstance(entries, list) and all(isinstance(one, dict) for one in entries)):
        raise ValueError(f"{path} is no whole certificate: its fingerprint must be a list of cases")
    for place, one in enumerate([] if lacks else entries, start=1):
        names = sorted({*Entry.__annotations__} - {"copies", *one})
        lacks += [f"{names[0]} in case {place} of its fingerprint"] if names else []
    if lacks:
        raise ValueError(f"{path} is no whole certificate: it has no {lacks[0]}")
    return content


def main(arguments: list[str]) -> int:
    """Compare two certificates; return the exit code."""
    if len(arguments) != 2:
        print(__doc__)
        return 2
    try:
        old, new = (read_certificate(Path(argument)) for argument in arguments)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    if old["method"] != new["method"]:
        print(f"{CHANGED}: the method was {old['method']}, and is {new['method']}")
        return 1
    cases = {one["name"]: one for one in new["fingerprint"]}
    missing = [one["name"] for one in old["fingerprint"] if one["name"] not in cases]
    if missing:
        print(f"{arguments[1]} has no case {missing[0]}: make both anew", file=sys.stderr)
        return 2
    verdict = compare(old["fingerprint"], [cases[one["name"]] for one in old["fingerprint"]])
    print(verdict)
    return verdict.exit_code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
