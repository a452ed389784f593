"""Headlines of the published pages, recomputed from their tables by pandas, numpy and scipy alone."""

from __future__ import annotations

import math
import re
import traceback
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.optimize import minimize
from scipy.stats import binomtest, norm, wilcoxon

PUBLISHED = Path(__file__).parent
ENSEMBLES = sorted(path.parent for path in PUBLISHED.glob("ensemble/*/ensemble.md"))
ADVICE = sorted(path.parent for path in PUBLISHED.glob("advice/*/advice.md"))


def table(name: str) -> pd.DataFrame:
    """A published table."""
    return pd.read_parquet(PUBLISHED / f"{name}.parquet")


def headline(name: str) -> str:
    """The first paragraph in bold of a page."""
    match = re.search(r"^\*\*(.*?)\*\*", (PUBLISHED / name).read_text(encoding="utf-8"), re.M | re.S)
    assert match
    return match.group(1)


def numbers(text: str) -> list[float]:
    """The numbers in a text."""
    return [math.inf if each == "∞" else float(each) for each in re.findall(r"\d+(?:\.\d+)?|∞", text)]


def peaks(runs: pd.DataFrame, member: str, peak: str) -> pd.DataFrame:
    """Peaks by member (rows) and method (columns), infinite if overturned."""
    kept = runs[runs["outcome"] != "failed"].copy()
    kept.loc[kept["outcome"] == "overturned", peak] = math.inf
    return kept.pivot_table(index=member, columns="method", values=peak, aggfunc="first")


def ratios(wide: pd.DataFrame, method: str, against: str) -> np.ndarray[Any, Any]:
    """Ratios of the peaks of each member by two methods; none if both overturn or stay at rest."""
    both = wide[[method, against]].dropna()
    ours, theirs = both[method].to_numpy(), both[against].to_numpy()
    alike = (ours == theirs) & (np.isinf(ours) | (ours == 0.0))
    return np.sort(ours[~alike] / theirs[~alike])


def quantile(ordered: np.ndarray[Any, Any], share: float) -> float:
    """Order statistic of index share (n + 1), interpolated between neighbours by their logarithms."""
    with np.errstate(divide="ignore"):
        logs = np.log(ordered)
    index = min(max(share * (len(logs) + 1), 1.0), len(logs)) - 1.0
    low, part = logs[int(index)], index % 1.0
    high = logs[min(int(index) + 1, len(logs) - 1)]
    return math.exp(low if part == 0.0 or low == high else (1.0 - part) * low + part * high)


def check_validity() -> None:
    """Check median ratios and 95th percentiles of the validity page."""
    runs = table("validity/records")
    entries: dict[str, list[list[float]]] = {}
    for _, point in runs.groupby(["tan_alpha", "semidiagonal", "intensity"]):
        wide = peaks(point, "motion", "peak")
        for method in ("recess", "ring", "flat", "perturbed copy"):
            own = ratios(wide, method, "recess model")
            entries.setdefault(method, []).append([quantile(own, share) for share in (0.5, 0.95)])
    said = numbers(headline("validity/validity.md"))
    medians = np.array(entries["recess"])[:, 0]
    assert said[0] == runs["motion"].nunique()
    assert said[1:3] == [round(medians.min(), 3), round(medians.max(), 3)]
    # by point, what one record in twenty exceeds: the least and the largest of each method
    upper = [np.array(points)[:, 1] for points in entries.values()]
    spans = re.findall(r"(\d\.\d\d|∞) to (\d\.\d\d|∞)", headline("validity/validity.md"))
    assert [math.inf if each == "∞" else float(each) for span in spans for each in span] == [
        round(float(end), 2) for each in upper for end in (each.min(), each.max())
    ]


def check_comparison() -> None:
    """Check agreement times in the recess and on flat ground."""
    rows = pd.read_csv(PUBLISHED / "compare" / "summary.csv")
    models = {"recess": "recess model", "flat": "flat-ground model", "ring": "recess model"}
    ends_of = [
        rows[(rows["support"] == support) & (rows["reference"] == model)]["within_tolerance_until"]
        for support, model in models.items()
    ]
    said = re.findall(r"(\d+\.\d) s", headline("compare/report.md"))
    # agreement times closer than 0.1 s are stated once
    ends = [[own.min(), own.max()] if np.ptp(own) > 0.1 else [own.min()] for own in ends_of]
    assert said == [f"{each:.1f}" for own in ends for each in own]


def check_ensemble(folder: Path) -> None:
    """Check median ratio, counts and p value of each contrast."""
    members = pd.read_parquet(folder / "members.parquet")
    wide = peaks(members, "member", "peak_tilt")
    bullets = re.findall(
        r"^- (.+) against (.+): median ratio (\S+) \(.*?higher in (\d+) and lower in (\d+) of (\d+) members "
        r"\(p \S+ (\S+)\)[^;]*; (?:no detectable ratio|smallest detectable ratio \S+ \(power [^)]*\))"
        r"(?:; (\d+) and (\d+) of \d+ overturn, (\d+) by both)?",
        (folder / "ensemble.md").read_text(encoding="utf-8"),
        re.M,
    )
    assert bullets
    for method, against, ratio, higher, lower, compared, p, *fallen in bullets:
        own = ratios(wide, method, against)
        assert ratio == f"{quantile(own, 0.5):.{len(ratio.partition('.')[2])}f}"
        assert [int(higher), int(lower), int(compared)] == [(own > 1).sum(), (own < 1).sum(), len(own)]
        over = np.isinf(wide[[method, against]])
        assert [int(each or 0) for each in fallen] == [*over.sum(), over.all(axis=1).sum()]
        # without members at an end, signed ranks need no special rule
        if np.isfinite(own).all() and (own > 0).all():
            p_value = float(wilcoxon(np.log(own)).pvalue)
            assert abs(float(p) - p_value) <= max(0.1 * p_value, 0.005)


def check_advice(folder: Path) -> None:
    """Check overturning shares with their intervals."""
    members = pd.read_parquet(folder / "members.parquet")
    text = (folder / "advice.md").read_text(encoding="utf-8")
    rows = re.findall(r"\| (\d+) of (\d+) \(([\d.]+) to ([\d.]+) %\) \|", text)
    assert len(rows) >= 3
    for group, row in zip(("copies", "acceleration", "velocity"), rows, strict=False):
        # shares are of the shaking as given: weaker shaking counts for demands alone
        runs = members[(members["group"] == group) & (members["factor"] == 1.0)]
        fell = (runs["outcome"] == "overturned").to_numpy()
        test = binomtest(int(fell.sum()), len(fell)).proportion_ci(0.95)
        assert row[:2] == (str(fell.sum()), str(len(fell)))
        assert row[2:] == tuple(f"{100 * each:.2g}" for each in (test.low, test.high))


def median_of(counts: pd.DataFrame) -> float:
    """Median of a lognormal curve through counts, by maximum likelihood."""
    x, n, k = (counts[name].to_numpy(dtype=float) for name in ("intensity", "n", "k"))

    def loss(at: Any) -> float:
        z = (np.log(x) - at[0]) / math.exp(at[1])
        return -float((k * norm.logcdf(z) + (n - k) * norm.logsf(z)).sum())

    fit = minimize(loss, [float(np.log(x).mean()), -0.5], method="Nelder-Mead",
                     options={"xatol": 1e-8, "fatol": 1e-10})  # fmt: skip
    return math.exp(fit.x[0])


def check_fragility() -> None:
    """Check ratios of the medians of overturning."""
    counts = pd.read_parquet(PUBLISHED / "fragility" / "p695" / "counts.parquet")
    fell = counts[counts["limit"] == "overturned"]
    medians = {key: median_of(rows) for key, rows in fell.groupby(["cylinder", "method"])}
    cylinders = list(fell["cylinder"].unique())
    text = (PUBLISHED / "fragility" / "p695" / "fragility.md").read_text(encoding="utf-8")
    answers = re.findall(r"^- (.+) against (.+): (\d\.\d\d) \(", text, re.M)
    # where runs failed, a pair has those that both methods finished, which counts do not tell
    failed = set(fell[fell["n"] < fell["n"].max()]["method"])
    known = [answer for answer in answers if not failed & {*answer[:2]}]
    assert len(known) >= len(answers) - 1
    for method, against, ratio in known:
        logs = [math.log(medians[each, method] / medians[each, against]) for each in cylinders]
        assert abs(float(ratio) - math.exp(sum(logs) / len(logs))) < 0.0051


def faults() -> list[str]:
    """Headlines that contradict their tables."""
    checks = [
        ("validity", check_validity),
        ("compare", check_comparison),
        ("fragility/p695", check_fragility),
    ]
    checks += [(f"ensemble/{folder.name}", partial(check_ensemble, folder)) for folder in ENSEMBLES]
    checks += [(f"advice/{folder.name}", partial(check_advice, folder)) for folder in ADVICE]
    rows = []
    for name, check in checks:
        try:
            check()
        except AssertionError as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            rows.append(f"{name}: its headline is not what its tables say: {place.line}")
    return rows
