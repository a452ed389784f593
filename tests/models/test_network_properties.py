"""What holds of every format of the networks: any motion, length and step, whatever the header leaves out."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path

import network_files as networks
import numpy as np
import pytest
from numpy.typing import NDArray

from rockwobble.models import read_record
from rockwobble.models.records.component import Component, open_record
from rockwobble.models.records.formats import read_components
from rockwobble.models.records.reading import Reading

Values = NDArray[np.float64]
Parts = dict[str, Values]

HORIZONTAL_AND_UP = {"y": "N00E", "x": "N90E", "z": "Up"}
DEGREES_AND_UP = {"y": "360 DEG", "z": "UP", "x": "90 DEG"}
CHANNELS = {"y": ("360 deg", 360, "HNN"), "z": ("Up", 400, "HNZ"), "x": ("90 deg", 90, "HNE")}
BBP_NAMES = ["#    time(sec)      N-S(cm/s/s)      E-W(cm/s/s)      U-D(cm/s/s)"]
BBP_NUMBERS = [
    "# Column 1: Time (s)",
    "# Column 2: North-south acceleration (cm/s/s) (+ is northward)",
    "# Column 3: East-west acceleration (cm/s/s) (+ is eastward)",
    "# Column 4: Up-down acceleration (cm/s/s) (+ is upward)",
]
GAL_PER_COUNT = 1e-2


def knet(parts: Parts) -> str:
    counts = np.round(parts["x"] / GAL_PER_COUNT).astype(np.int64)
    return networks.knet("E-W", counts, scale="1000(gal)/100000", rate=round(1.0 / networks.STEP))


# files of all three components, or of x alone, that state a peak
WITH_PEAKS: Mapping[str, Callable[[Parts], str | bytes]] = {
    "a.EW": knet,
    "a.ASC": lambda parts: networks.esm(parts["x"]),
    "afad.txt": networks.afad,
    "afad_turned.txt": lambda parts: networks.afad(parts, "zxy"),
    "cwa.dat": networks.cwa,
    "cwa_without_format.dat": lambda parts: networks.cwa(parts, formats=False),
    "geonet.V1A": lambda parts: networks.geonet(parts, HORIZONTAL_AND_UP, corrected=False),
    "geonet_quadrants.V1A": lambda parts: networks.geonet(
        parts, {"x": "S90E", "y": "N00W", "z": "Up"}, corrected=False
    ),
    "geonet.V2A": lambda parts: networks.geonet(parts, HORIZONTAL_AND_UP, corrected=True),
    "csmip.V2": lambda parts: networks.csmip(parts, DEGREES_AND_UP, volume=2),
    "csmip_small.V2": lambda parts: networks.csmip(parts, DEGREES_AND_UP, volume=2, capitals=False),
    "cosmos.V2c": lambda parts: networks.cosmos(parts, CHANNELS),
    "cosmos_without_formats.V2c": lambda parts: networks.cosmos(parts, CHANNELS, formats=False),
    "a.smc": lambda parts: networks.smc(parts["x"]),
    "csmnc.dat": lambda parts: networks.csmnc(parts["x"]),
    "csmnc_close.dat": lambda parts: networks.csmnc(parts["x"]).replace("COMP. EW", "COMP.EW"),
    "csmnc_colon.dat": lambda parts: networks.csmnc(parts["x"]).replace("COMP. EW", "COMP. : EW"),
}
WITHOUT_PEAKS: Mapping[str, Callable[[Parts], str | bytes]] = {
    "jma.csv": networks.jma,
    "names.bbp": lambda parts: networks.bbp(parts, BBP_NAMES),
    "numbers.bbp": lambda parts: networks.bbp(parts, BBP_NUMBERS),
    "without_names.acc.bbp": lambda parts: networks.bbp(parts, []),
}
IN_G: Mapping[str, Callable[[Parts], str | bytes]] = {
    "csmip.V1": lambda parts: networks.csmip(parts, DEGREES_AND_UP, volume=1),
    "csmip_without_format.V1": lambda parts: networks.csmip(parts, DEGREES_AND_UP, volume=1, formats=False),
}
BINARY: Mapping[str, Callable[[Parts], bytes]] = {
    "a.sac": lambda parts: networks.sac(parts["x"]),
    "a.mseed": lambda parts: networks.miniseed(parts["x"], rate=round(1.0 / networks.STEP)),
}
ALL = {**WITH_PEAKS, **WITHOUT_PEAKS, **IN_G, **BINARY}
PRINTED = 5e-5  # relative to the peak; of the format with the fewest digits, SMC
NOTE_OF_A_PEAK = re.compile(r"its header states a peak of (\S+) \S+, its samples have (\S+)")
IN_GAL = {"cm/s2": 1.0, "g": 980.665, None: 1.0}


def any_motion(chance: np.random.Generator) -> Parts:
    """Return values of three directions [gal] in two digits, whose peaks to both sides are not alike."""
    rise = np.minimum(1.0, 4.0 * np.arange(networks.COUNT) / networks.COUNT)
    parts = {}
    for axis in "xyz":
        values = chance.uniform(20.0, 80.0) * rise * chance.uniform(-1.0, 1.0, networks.COUNT)
        parts[axis] = np.round(np.where(values < 0.0, 0.7, 1.0) * values, 2)
    return parts


def read(folder: Path, name: str, content: str | bytes) -> list[Component]:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_components(open_record(path), Reading())


# lengths that fill the last line and lengths that do not
SHAPES = [(16, 0.02), (37, 0.01), (80, 0.005), (121, 0.02), (240, 0.01)]


@pytest.mark.parametrize("name", ALL)
def test_any_motion_is_read_and_turned_round_with_its_sign(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    count, step = SHAPES[list(ALL).index(name) % len(SHAPES)]
    monkeypatch.setattr(networks, "COUNT", count)
    monkeypatch.setattr(networks, "STEP", step)
    parts = any_motion(np.random.default_rng(count))
    for sign in (1.0, -1.0):
        motion = {axis: sign * values for axis, values in parts.items()}
        components = read(tmp_path, name, ALL[name](motion))
        assert {part.direction for part in components} in ({"x"}, {"x", "y", "z"})
        for part in components:
            due = motion[str(part.direction)]
            assert part.time_step == pytest.approx(step, rel=1e-7)  # of single precision
            assert len(part.values) == count
            error = PRINTED * np.abs(due).max()
            assert part.values * IN_GAL[part.unit] == pytest.approx(due, abs=error)
            assert part.notes == (("offset of the sensor not removed",) if name == "a.EW" else ())


# the largest sample may be off by 2 % of the stated peak of either sign; by a factor of 2 the file is damaged
VERDICTS = {0.49: "refused", 0.51: "noted", 0.985: "agrees", 1.03: "noted", 2.05: "refused", -1.0: "agrees"}


@pytest.mark.parametrize("ratio", VERDICTS)
def test_the_peak_of_the_header_is_compared_with_that_of_the_samples(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ratio: float
) -> None:
    monkeypatch.setattr(networks, "STATED", ratio)
    parts = any_motion(np.random.default_rng(5))
    for name in ("a.EW", "csmip.V2"):
        if VERDICTS[ratio] == "refused":
            with pytest.raises(ValueError, match=r"the header states a peak of .*: the file is damaged"):
                read(tmp_path, name, WITH_PEAKS[name](parts))
            continue
        for part in read(tmp_path, name, WITH_PEAKS[name](parts)):
            said = [match for note in part.notes if (match := NOTE_OF_A_PEAK.fullmatch(note))]
            assert len(said) == (VERDICTS[ratio] == "noted")
            due = parts[str(part.direction)]
            due = due - due.mean() if name == "a.EW" else due  # NIED states it without the mean
            for match in said:
                found = (float(match[1]), float(match[2]))
                assert found == pytest.approx((ratio * np.abs(due).max(), np.abs(due).max()), rel=1e-3)


@pytest.mark.parametrize("name", WITH_PEAKS)
def test_every_network_that_states_a_peak_has_it_compared(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr(networks, "STATED", 0.45)
    with pytest.raises(ValueError, match="the file is damaged"):
        read(tmp_path, name, WITH_PEAKS[name](any_motion(np.random.default_rng(5))))


SPELLINGS = {
    "x": ("E", "EW", "E-W", "WE", "East", "East-West", "e_w"),
    "y": ("N", "NS", "N-S", "S-N", "North", "North-South"),
    "z": ("U", "UD", "U-D", "Z", "V", "Up", "Vert", "Vertical", "Up-Down"),
}
STREAMS = {f"{band}{kind}{axis}": axis for band in "HBE" for kind in "NLHG" for axis in "ENZ"}
NO_DIRECTIONS = ("H1", "HN1", "HXE", "BDZ", "L", "T", "Radial", "")


@pytest.mark.parametrize("key", ["STREAM", "COMPONENT"])
def test_esm_names_a_component_by_its_direction_or_by_a_stream(tmp_path: Path, key: str) -> None:
    """Of a stream the third letter is the direction, if the second is that of a seismic instrument."""
    values = any_motion(np.random.default_rng(7))["x"]
    names: dict[str, str | None] = {name: axis for axis, words in SPELLINGS.items() for name in words}
    names |= {name: {"E": "x", "N": "y", "Z": "z"}[letter] for name, letter in STREAMS.items()}
    names |= dict.fromkeys(NO_DIRECTIONS)
    for name, direction in names.items():
        (part,) = read(tmp_path, "a.ASC", networks.esm(values, key=key, name=name))
        assert (part.direction, part.label) == (direction, name)


def test_csmnc_names_a_component_by_its_direction(tmp_path: Path) -> None:
    values = any_motion(np.random.default_rng(7))["x"]
    for axis, name in [(axis, name) for axis, words in SPELLINGS.items() for name in words]:
        (part,) = read(tmp_path, "a.dat", networks.csmnc(values, name))
        assert (part.direction, part.azimuth, part.label) == (axis, None, name.upper())


def test_a_quadrant_bearing_is_converted_to_an_azimuth(tmp_path: Path) -> None:
    parts = {"x": any_motion(np.random.default_rng(7))["x"]}
    for first, angle, second in itertools.product("NS", (0, 30, 90), "EW"):
        name = f"{first}{angle:02d}{second}"
        north = math.cos(math.radians(angle)) * (1.0 if first == "N" else -1.0)
        east = math.sin(math.radians(angle)) * (1.0 if second == "E" else -1.0)
        for file, content in {
            "a.V1A": networks.geonet(parts, {"x": name}, corrected=False),
            "a.dat": networks.csmnc(parts["x"], name),
            "a.V2": networks.csmip(parts, {"x": name}, volume=2),
        }.items():
            (part,) = read(tmp_path, file, content)
            azimuth = math.radians(part.azimuth or 0.0)
            assert 0.0 <= azimuth < 2.0 * math.pi
            assert (math.cos(azimuth), math.sin(azimuth)) == pytest.approx((north, east), abs=1e-12)
            assert part.direction == ("x" if east > 1.0 - 1e-12 else "y" if north > 1.0 - 1e-12 else None)


@pytest.mark.parametrize("columns", ["H1,H2,Up", [1, 3, 2], "time,Chan 1: H1,h2,up"])
def test_the_channels_that_the_user_names_win(tmp_path: Path, columns: str | list[str | int]) -> None:
    parts = any_motion(np.random.default_rng(7))
    path = tmp_path / "a.V2"
    path.write_text(networks.csmip(parts, {"x": "H1", "z": "Up", "y": "H2"}, volume=2))
    with pytest.raises(ValueError, match=r"--record-columns.*CHAN 1: H1"):
        read_record(path)
    motion = read_record(path, columns=columns)
    assert motion.acceleration == pytest.approx(
        0.01 * np.column_stack([parts[axis] for axis in "xyz"]), abs=1e-4
    )
    swapped = read_record(path, columns="H2,H1").acceleration
    assert swapped == pytest.approx(motion.acceleration[:, [1, 0]], rel=1e-12)
    for wrong in ("H1,H3", "1,1", "1,2,3,3", "4,1"):
        with pytest.raises(ValueError, match="must name each of its components"):
            read_record(path, columns=wrong)


def test_damage_is_refused_with_the_words_of_obspy_in_a_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read(tmp_path, "a.sac", BINARY["a.sac"](networks.motion()))  # imports it, with its warnings left out
    import obspy

    def fail(*args: object, **options: object) -> None:
        raise RuntimeError("the header\n\tis 3 bytes\x00 too short " + 40 * "and short ")

    monkeypatch.setattr(obspy, "read", fail)
    for name, format_name in (("a.sac", "SAC"), ("a.mseed", "miniSEED")):
        with pytest.raises(ValueError, match="is damaged") as caught:
            read(tmp_path, name, BINARY[name](networks.motion()))
        words = "the header is 3 bytes too short " + 40 * "and short "
        assert str(caught.value) == f"{name} ({format_name}) is damaged: {words[:120]}"
