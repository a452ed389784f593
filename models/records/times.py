"""Time steps of records: from columns of times, and from the words of a header."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .component import STEP_OPTION, RecordFile
from .numbers import NUMBER

# printed times are rounded, as 0.0167 for 1/60: a sample may stand this much of a step off its place
_UNEVENNESS = 0.05
_EPOCH = 1e6  # [s], 11 days: no record begins so late, times since an epoch do
_LEAST, _LARGEST = 1e-5, 2.0  # [s]; a number beyond is no time step
_MOST_LINES, _LONGEST_LINE = 200, 200
_SAME = 3e-3  # relative: 0.0167 for 1/60
_GAP = r"[^\d\n.+-]{0,30}?"
_STEP_WORDS = "|".join(
    (
        r"(?<![a-zα-ω])(?:dt|d_t)(?![a-z\d])",
        r"[Δ∆]\s?t|delta[ _-]?t|time[ _-]?step|timestep|step[ _-]?size|^\W{0,9}step(?=\s?[=:])",
        r"spacing|interval\w*|sampling|sample[ _-]?(?:period|time)",
        r"zeitschritt\w*|abtast\w*|schrittweite|paso(?: de)?(?: tiempo)?|pas de temps",
        r"passo(?: temporale| de tempo)?|muestreo|campionamento|échantillonnage|örnekleme",
        "adim|krok|askel|шаг|步长|間隔|间隔|刻み",
    )
)
_RATE_WORDS = "|".join(
    (
        r"(?:sampl\w*|abtast\w*)[ _-]?(?:rate|freq\w*)|samplerate|(?<![a-z])fs(?![a-z])|sps\b",
        "abtastrate|abtastfrequenz|tasa de muestreo|frecuencia de muestreo|frequenza di campionamento",
        r"fréquence d.échantillonnage|örnekleme frekansı|sampling(?=\W{0,3}\d+(?:\.\d+)?\s?hz)",
    )
)
_UNIT = r"(?:\s{0,3}[\[(]?\s?(?P<unit>hz|sps|ms|msec|milliseconds?|us|µs|μs|s|sec|seconds?)\b)?"
_RATE = re.compile(rf"(?:{_RATE_WORDS}){_GAP}(?P<number>{NUMBER}){_UNIT}", re.IGNORECASE)
_STEP = re.compile(rf"(?:{_STEP_WORDS})(?P<gap>{_GAP})(?P<number>{NUMBER}){_UNIT}", re.IGNORECASE)
_PER_SECOND = re.compile(
    rf"(?P<number>{NUMBER})\s?(?:sps\b|(?:samples?|muestras?|campioni)\s?(?:per|por|al|/)\s?s)", re.IGNORECASE
)
_POINTS_AT = re.compile(
    r"\d{2,9}\s(?:points|samples|values|pts)\b[a-z \t]{0,40}\bat\s{1,3}"
    rf"(?P<number>{NUMBER})\s?(?P<unit>ms|s|sec|seconds?)\b",
    re.IGNORECASE,
)
# "MUESTREO (muestras/seg) : 100"
_UNIT_IN_GAP = re.compile(
    r"(?<![a-z])(hz|ms|msec|us|µs|sps|(?:samples?|muestras?|campioni)\s?/\s?s(?:e[cg])?)(?![a-z])"
)
_COUNT_AND_STEP = re.compile(rf"\s*(\d{{2,9}})[\s,;]+({NUMBER})\s*")


def stated_step(file: RecordFile, header: Sequence[str], count: int | None = None) -> float | None:
    """Return the time step that the lines of a header state in words [s], None where they are silent.

    "dt=0.005 sec", "equal spacing of 0.02 sec", "Time Step: 0.005", "Sampling rate (Hz): 200", and
    "4096 0.025" where there are 4096 samples.

    Parameters
    ----------
    file : RecordFile
        For messages.
    header : sequence of str
    count : int, optional
        Number of samples.

    Raises
    ------
    ValueError
        If two are stated that differ.
    """
    steps: dict[float, str] = {}
    for line in header[:_MOST_LINES]:
        step = _step_of(line[:_LONGEST_LINE].replace("\\", " "), count)
        if step is not None and _LEAST <= step <= _LARGEST:
            steps.setdefault(step, line.strip())
    values = sorted(steps)
    if values and values[-1] - values[0] > _SAME * values[0]:
        raise ValueError(f"{file.name} states two time steps: {values[0]:g} and {values[-1]:g} s")
    return values[0] if values else None


def _step_of(line: str, count: int | None) -> float | None:
    pair = _COUNT_AND_STEP.fullmatch(line)
    if pair:
        return (
            float(pair[2].upper().replace("D", "E")) if count is not None and int(pair[1]) == count else None
        )
    rate = _RATE.search(line) or _PER_SECOND.search(line)
    if rate:
        number = _number(rate)
        unit = (rate.groupdict().get("unit") or "").lower()
        return None if not number else number if unit.startswith("s") and unit != "sps" else 1.0 / number
    step = _STEP.search(line) or _POINTS_AT.search(line)
    if step is None or not (number := _number(step)):
        return None
    unit = (step["unit"] or "").lower()
    in_gap = _UNIT_IN_GAP.search((step.groupdict().get("gap") or "").lower())
    word = unit or (in_gap[1] if in_gap else "")
    if word in ("hz", "sps") or "/" in word:
        return 1.0 / number
    return number * {"m": 1e-3, "u": 1e-6, "µ": 1e-6, "μ": 1e-6}.get(word[:1], 1.0)


def _number(match: re.Match[str]) -> float:
    try:
        return float(re.sub("[Dd]", "E", match["number"]))
    except OverflowError:
        return 0.0


def rises_evenly(time: NDArray[np.float64]) -> bool:
    """Return whether numbers rise in even steps, as times do."""
    return len(time) > 1 and _uneven(time)[0] is None


def is_counting(time: NDArray[np.float64]) -> bool:
    """Return whether numbers are whole and rise by 1, as row numbers do."""
    return bool((np.diff(time) == 1.0).all() and (time[0] == round(time[0])))


def _uneven(time: NDArray[np.float64]) -> tuple[int | None, float]:
    """Return the place of the largest jump of the step, None where all are even, and the mean step."""
    # halves, because the difference of two large floats overflows
    step = 2.0 * float(0.5 * time[-1] - 0.5 * time[0]) / (len(time) - 1)
    if not 0.0 < step < np.inf:
        return 0, step
    with np.errstate(over="ignore", invalid="ignore"):  # an infinite distance is refused like any other
        off = np.abs((time - time[0]) / step - np.arange(len(time)))
        # the place where the step changes, not the one where the error has grown largest
        jump = np.abs(np.diff(time) / step - 1.0)
    even = off.max() <= _UNEVENNESS and jump.max() <= 2.0 * _UNEVENNESS
    return (None if even else int(jump.argmax())), step


def even_step(file: RecordFile, time: NDArray[np.float64], lines: Sequence[int], seconds: float) -> float:
    """Return the step of a column of times [s].

    Parameters
    ----------
    file : RecordFile
        For messages.
    time : ndarray, shape (n,)
        [`seconds`]
    lines : sequence of int
        Line of each.
    seconds : float
        Unit of the column [s].

    Raises
    ------
    ValueError
        If the times do not rise in even steps, or count from an epoch.
    """
    at, step = _uneven(time)
    if not 0.0 < step < np.inf:
        raise ValueError(f"{file.name}: times must rise [s], got {time[0]:g} s first and {time[-1]:g} s last")
    if at is not None:
        raise ValueError(
            f"{file.name}, line {lines[at + 1]}: times must rise in even steps, got {time[at + 1]:g} s "
            f"after {time[at]:g} s where the mean step is {step:.6g} s"
        )
    if since_epoch(time, seconds):
        raise ValueError(
            f"{file.name}: its times begin at {time[0]:.12g}, as times since an epoch do: give times from "
            f"the start of the record, or the step by {STEP_OPTION}"
        )
    return float(f"{step * seconds:.12g}")  # 0.01 and not 0.010000000000000002


def since_epoch(time: NDArray[np.float64], seconds: float) -> bool:
    """Return whether times, in a unit of `seconds`, count from an epoch such as 1970."""
    return bool(abs(time[0]) * seconds > _EPOCH)


_SECONDS = {"m": 1e-3, "u": 1e-6, "µ": 1e-6, "μ": 1e-6}
_OTHER_UNIT = r"((?:m|milli|[uµμ]|micro)s(?:ec(?:ond)?s?)?|min(?:ute)?s?)"
_OTHER_TIME = re.compile(
    rf"\b(?:time|times|t|zeit|tiempo|temps|tempo|zaman)(?:\s{{0,3}}[\[(]\s?{_OTHER_UNIT}\s?[\])]|(?:\s{{1,3}}in\s{{1,3}}|_){_OTHER_UNIT}\b)",
    re.IGNORECASE,
)


def stated_seconds(file: RecordFile, header: Sequence[str]) -> float | None:
    """Return the unit of time that the words of a header state, as "time in ms" [s]; None where silent.

    Raises
    ------
    ValueError
        If it is none that is read.
    """
    for line in header[:_MOST_LINES]:
        other = _OTHER_TIME.search(line[:_LONGEST_LINE])
        if other is not None:
            word = other[1] or other[2]
            if word.lower().startswith("min"):
                raise ValueError(f"{file.name} gives times in {word}, allowed are s, ms, us and ns")
            return _SECONDS[word[0].lower()]
    return None
