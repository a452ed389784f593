"""Tilt rate kept at a pass by rods rolling on their rim, compared with Housner and rolling resistance.

`python tests/benchmarks measured_rods` prints the table from reports/published/measured/rods.csv, and with
``--tracks FOLDER``, a checkout of the measurement, makes that file first. The tracks are positions of one
mark on the free end, seen along the vertical by one camera without calibration: lengths are pixels, and only
ratios of speeds at the same place, the pass, mean something.

Two estimators of the share of the tilt rate that is kept, both a geometric mean over two neighbouring passes,
which cross the picture in opposite directions, so that a scale that differs from side to side cancels:

at the pass
    the speed after over the speed before, each extrapolated to the pass from its own side.
pass to pass
    the speed at a pass over that at the pass before: it holds the loss at a pass and that of a swing.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockwobble import reduced
from rockwobble.models import Cylinder

from .console import options_of, show

if TYPE_CHECKING:
    import pandas as pd

TABLE = Path(__file__).parents[2] / "reports" / "published" / "measured" / "rods.csv"
# SHA-256 of all tracks in the order of their names, at commit 3be9f52e1687b6a5763b216faf7538a02b905547
TRACKS_SHA256 = "d0e57469d301c4147035bcec61cd796d3b3a7486a493805b22620705c7682ae5"
_NAME = re.compile(r"d_(\d+)mm_l_(\d+)mm_(\d+)deg\.txt")
_LEAST_AMPLITUDE = 60.0  # [px], a tenth of the largest: below it the noise of the track outweighs the loss
_CENTRAL = 0.35  # share of the amplitude: tracks that stay farther out did not pass the centre
_SMALL, _LARGE = 120.0, 200.0  # amplitudes of the small and the large swings [px]
_BETWEEN = 2.5  # times its ends that the radius must reach between two minima to be a swing
# of the samples from a pass to the turning point: which are fitted. The nearest is left out, where the rim
# changes sides
_SHARE, _MOST, _FEWEST, _SKIPPED = 0.6, 16, 5, 2


def track_of(path: Path) -> NDArray[np.float64]:
    """Time [s] and position [px] of a track (n, 3), without samples of a lost mark."""
    lines = [line.split(",")[:3] for line in path.read_text(encoding="utf-8").splitlines()[2:]]
    return np.array([[float(value) for value in line] for line in lines if len(line) == 3 and all(line)])


def passes_of(track: NDArray[np.float64]) -> Iterator[tuple[int, float, float, float, float, float]]:
    """Yield number, time [s], amplitude before and after [px], speed before and after [px/s] of each pass."""
    radius = np.hypot(track[:, 1], track[:, 2])
    minima = _minima(radius)
    for number, (last, at, following) in enumerate(
        zip(minima, minima[1:], minima[2:], strict=False), start=1
    ):
        before = last + int(radius[last : at + 1].argmax())
        after = at + int(radius[at : following + 1].argmax())
        amplitude = min(radius[before], radius[after])
        if amplitude < _LEAST_AMPLITUDE or radius[at] > _CENTRAL * amplitude:
            continue
        speeds = _speed(track, at, before), _speed(track, at, after)
        if np.isfinite(speeds).all():
            yield number, float(track[at, 0]), float(radius[before]), float(radius[after]), *speeds


def _minima(radius: NDArray[np.float64]) -> list[int]:
    """Samples nearest to the centre, one per crossing."""
    minima: list[int] = []
    for i in range(1, len(radius) - 1):
        if radius[i] > radius[max(i - 6, 0) : i + 7].min():
            continue
        if minima and radius[minima[-1] : i + 1].max() < _BETWEEN * max(radius[minima[-1]], radius[i]):
            if radius[i] < radius[minima[-1]]:
                minima[-1] = i
            continue
        minima.append(i)
    return minima


def _speed(track: NDArray[np.float64], at: int, turning: int) -> float:
    """Speed at sample `at` [px/s], by a parabola from the side of `turning`."""
    count = int(min(_SHARE * abs(turning - at), _MOST))
    if count < _FEWEST:
        return float("nan")
    side = 1 if turning > at else -1
    fitted = at + side * np.arange(_SKIPPED, _SKIPPED + count)
    velocity = np.polyfit(track[fitted, 0] - track[at, 0], track[fitted, 1:], 2)[1]
    return float(np.hypot(*velocity))


def table_of(folder: Path) -> pd.DataFrame:
    """Passes of all tracks below `folder`, one row each; duplicate tracks are skipped."""
    import pandas as pd

    paths = sorted(folder.glob("**/*deg.txt"), key=lambda path: path.name)
    contents = [path.read_bytes() for path in paths]
    digest = hashlib.sha256(b"".join(contents)).hexdigest()
    if digest != TRACKS_SHA256:
        raise ValueError(
            f"the tracks must have the SHA-256 {TRACKS_SHA256}, got {digest} of {len(paths)} tracks"
        )
    rows = []
    for i, path in enumerate(paths):
        named = _NAME.search(path.name)
        if named is None or contents[i] in contents[:i]:
            continue
        rows += [(*map(int, named.groups()), *each) for each in passes_of(track_of(path))]
    names = ["diameter_mm", "length_mm", "release_deg", "pass", "time_s", "amplitude_before_px"]
    names += ["amplitude_after_px", "speed_before_px_s", "speed_after_px_s"]
    digits = {"time_s": 4, names[5]: 1, names[6]: 1, names[7]: 0, names[8]: 0}
    table = pd.DataFrame(rows, columns=names).round(digits)
    return table.astype({names[7]: int, names[8]: int})


def kept(table: pd.DataFrame) -> pd.DataFrame:
    """Share of the tilt rate kept by each geometry, by both estimators.

    Returns
    -------
    DataFrame
        diameter_mm, length_mm, tracks, passes; at_pass and pass_to_pass (median [-]), each with its quartiles
        (_low, _high); small and large (pass_to_pass of swings below 120 and from 200 px); housner;
        times_housner (loss of pass_to_pass over his); delta_mm: length of the rolling resistance that loses
        as much as pass_to_pass at the pass alone, an upper bound, since the load takes a part.
    """
    import pandas as pd

    rows = []
    for (diameter, length), rod in table.groupby(["diameter_mm", "length_mm"]):
        b, h = 0.5 * float(str(diameter)), 0.5 * float(str(length))
        at_pass, between, amplitude = [], [], []
        tracks = rod.groupby("release_deg")
        for _, track in tracks:
            number = track["pass"].to_numpy()
            before, after = np.log(track[["speed_before_px_s", "speed_after_px_s"]].to_numpy(float)).T
            next_one = number[1:] == number[:-1] + 1
            change = after - before
            at_pass.append((0.5 * (change[1:] + change[:-1]))[next_one])
            speed = 0.5 * (before + after)
            three = next_one[1:] & next_one[:-1]
            between.append((0.5 * (speed[2:] - speed[:-2]))[three])
            amplitude.append(track["amplitude_after_px"].to_numpy()[1:-1][three])
        low, middle, high = np.exp(np.percentile(np.concatenate(at_pass), [25, 50, 75]))
        swings, size = np.concatenate(between), np.concatenate(amplitude)
        low_2, middle_2, high_2 = np.exp(np.percentile(swings, [25, 50, 75]))
        small, large = (float(np.exp(np.median(swings[part]))) for part in (size < _SMALL, size >= _LARGE))
        housner = reduced.restitution_from_momentum(
            Cylinder(semidiagonal=float(np.hypot(b, h)), tan_alpha=b / h)
        )
        A = (3.0 * b * b + 4.0 * h * h) / 12.0 + b * b + h * h
        delta = A * (1.0 - middle_2) / (b * (1.0 + middle_2))
        row = {"diameter_mm": diameter, "length_mm": length, "tracks": tracks.ngroups, "passes": len(rod)}
        row |= {"at_pass": middle, "at_pass_low": low, "at_pass_high": high}
        row |= {"pass_to_pass": middle_2, "pass_to_pass_low": low_2, "pass_to_pass_high": high_2}
        row |= {"small": small, "large": large, "housner": housner}
        rows.append(row | {"times_housner": (1.0 - middle_2) / (1.0 - housner), "delta_mm": delta})
    return pd.DataFrame(rows)


def main(arguments: Sequence[str]) -> int:
    """Print the table, from the tracks if they are given."""
    import pandas as pd

    parser = options_of("measured_rods", "What rolling rods keep at a pass, measured.")
    parser.add_argument(
        "--tracks", type=Path, help="folder of the tracks, from which the table is made first"
    )
    given = parser.parse_args(arguments)
    if given.tracks is not None:
        table_of(given.tracks).to_csv(TABLE, index=False, lineterminator="\n")
    columns = {"diameter_mm": ".0f", "length_mm": ".0f", "tracks": "d", "passes": "d"}
    for name in ("at_pass", "pass_to_pass"):
        columns |= {name: ".4f", f"{name}_low": ".3f", f"{name}_high": ".3f"}
    columns |= {"small": ".3f", "large": ".3f", "housner": ".4f", "times_housner": ".2f", "delta_mm": ".2f"}
    note = "Another potential, one camera without calibration: compared with measurement, not validated."
    show(kept(pd.read_csv(TABLE)), "Share of the tilt rate kept, with quartiles", columns, note)
    return 0
