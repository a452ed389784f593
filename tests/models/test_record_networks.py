"""Records of the networks, each by a small file of its documented form with invented values."""

from __future__ import annotations

import itertools
import math
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path

import network_files as networks
import numpy as np
import pytest
from network_files import COUNT, STEP
from numpy.typing import NDArray

from rockwobble.models import read_record
from rockwobble.models.records.component import Component, open_record
from rockwobble.models.records.formats import READERS, read_components
from rockwobble.models.records.reading import Reading

Values = NDArray[np.float64]
Parts = dict[str, Values]

ROUNDING = 1e-9  # of doubles that were printed and read
SMC_DIGITS = 5e-5 * 1.01  # relative; four digits behind the first
SINGLE = 6e-8 * 1.01  # relative; of a 32-bit float


def components(folder: Path, name: str, content: str | bytes, **options: str) -> list[Component]:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_components(open_record(path), Reading(**options))  # type: ignore[arg-type]


def refusal(folder: Path, name: str, content: str | bytes, **options: str) -> str:
    with pytest.raises(ValueError, match=re.escape(name)) as caught:
        components(folder, name, content, **options)
    message = str(caught.value)
    assert message.startswith(name) or message.startswith("the record")
    assert message.isprintable()
    assert len(message) < 250
    return message


def assert_read(part: Component, values: np.ndarray, unit: str, error: float = ROUNDING) -> None:
    assert part.unit == unit
    assert part.time_step == pytest.approx(STEP, rel=1e-12)
    np.testing.assert_allclose(part.values, values, rtol=0, atol=error)


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
    """Random values in three directions [gal] with two digits and unequal peaks of both signs."""
    rise = np.minimum(1.0, 4.0 * np.arange(networks.COUNT) / networks.COUNT)
    parts = {}
    for axis in "xyz":
        values = chance.uniform(20.0, 80.0) * rise * chance.uniform(-1.0, 1.0, networks.COUNT)
        parts[axis] = np.round(np.where(values < 0.0, 0.7, 1.0) * values, 2)
    return parts


PARTS = networks.motion()
COUNTS = np.round(1e4 * PARTS["x"]).astype(np.int64) - 12000
FILES = {name: build(PARTS) for name, build in ALL.items()} | {
    "a.EW": networks.knet("E-W", np.tile(COUNTS, 3))
}


def test_knet_is_counts_times_the_scale_factor_with_the_offset(tmp_path: Path) -> None:
    codes = {"E-W": "x", "N-S": "y", "U-D": "z", "1": "y", "2": "x", "3": "z", "4": "y", "5": "x", "6": "z"}
    for code, direction in codes.items():
        (part,) = components(tmp_path, f"TST0010102030405.{code}", networks.knet(code, COUNTS))
        assert part.direction == direction
        assert ("borehole" in part.label, "surface" in part.label) == (code in "123", code in "456")
        assert_read(part, COUNTS * 3920.0 / 6182761.0, "cm/s2")
        assert part.notes == ("offset of the sensor not removed",)


def test_corrected_smc_is_oriented_by_its_header(tmp_path: Path) -> None:
    for inclination, azimuth, direction, stated, sign in (
        *((90, 90, "x", 90.0, 1), (90, 360, "y", 0.0, 1), (90, 133, None, 133.0, 1)),
        *((0, 0, "z", None, 1), (180, 0, "z", None, -1)),
    ):
        content = networks.smc(PARTS["x"], inclination=inclination, azimuth=azimuth)
        (part,) = components(tmp_path, "a.smc", content.replace("TST0A", "TST0\0"))
        assert (part.direction, part.azimuth) == (direction, stated)
        assert_read(part, sign * PARTS["x"], "cm/s2", SMC_DIGITS * np.abs(PARTS["x"]).max())


def test_an_azimuth_in_degrees_is_stored_and_stated(tmp_path: Path) -> None:
    (part,) = components(tmp_path, "a.V2", networks.csmip(PARTS, {"x": "106 DEG"}, volume=2))
    assert (part.direction, part.azimuth) == (None, 106.0)
    (part,) = components(tmp_path, "a.V2c", networks.cosmos(PARTS, {"x": ("106 DEG", 106, "HN1")}))
    assert (part.direction, part.azimuth) == (None, 106.0)
    assert_read(part, PARTS["x"], "cm/s2")


def test_horizontal_sensors_without_azimuth_have_no_direction(tmp_path: Path) -> None:
    parts = components(tmp_path, "a.V2", networks.csmip(PARTS, {"x": "H1", "z": "UP", "y": "H2"}, volume=2))
    assert [part.direction for part in parts] == [None, "z", None]


def test_a_downward_sensor_is_turned_up_with_a_note(tmp_path: Path) -> None:
    for name, content in {
        "a.V2": networks.csmip(PARTS, {"z": "DOWN"}, volume=2),
        "a.V2A": networks.geonet(PARTS, {"z": "Down"}, corrected=True),
        "a.V2c": networks.cosmos(PARTS, {"z": ("Down", 401, "HNZ")}),
    }.items():
        (part,) = components(tmp_path, name, content)
        assert part.direction == "z"
        assert "down" in part.notes[0]
        assert_read(part, -PARTS["z"], "cm/s2")


def test_channels_of_cosmos_are_read_by_their_unit_and_stream_codes(tmp_path: Path) -> None:
    for unit, name, factor in (
        *(("g.     (02)", "g", 1.0), ("gal(10)", "cm/s2", 1.0), ("in/sec2(07)", "cm/s2", 2.54)),
        ("mg(11)", "g", 1e-3),
    ):
        channel = networks.cosmos(PARTS, {"x": CHANNELS["x"]}, unit=unit)
        (part,) = components(tmp_path, "a.V2c", channel)
        assert_read(part, factor * PARTS["x"], name)
    # as the files of CESMD for Alaska have it: code 0, which is none, and "Other"
    (part,) = components(tmp_path, "a.V2c", networks.cosmos(PARTS, {"z": ("Other", 0, "BNZ")}))
    assert (part.direction, part.azimuth) == ("z", None)


class TestRefusals:
    def test_counts_are_refused(self, tmp_path: Path) -> None:
        counts = networks.cosmos(PARTS, CHANNELS, unit="counts(50)", kind="raw accel.")
        assert "V1 or V2" in refusal(tmp_path, "a.V0c", counts)

    def test_files_of_velocities_or_displacements_are_refused(self, tmp_path: Path) -> None:
        velocity = ["#    time(sec)      N-S(cm/s)      E-W(cm/s)      U-D(cm/s)"]
        assert "velocities" in refusal(tmp_path, "s.vel.bbp", networks.bbp(PARTS, velocity))
        assert "velocities" in refusal(tmp_path, "s.acc.bbp", networks.bbp(PARTS, velocity))
        assert "velocities" in refusal(tmp_path, "s.bbp", networks.bbp(PARTS, []))
        assert "velocity" in refusal(tmp_path, "TST.VEL.ASC", networks.esm(PARTS["x"], kind="VELOCITY"))
        velocity_of = networks.cosmos(PARTS, CHANNELS, unit="cm/sec(05)", kind="velocity")
        assert "no samples of acceleration" in refusal(tmp_path, "a.vel.V2c", velocity_of)
        assert "4 DISPLACEMENT" in refusal(
            tmp_path, "a.smc", networks.smc(PARTS["x"], title="4 DISPLACEMENT")
        )

    def test_a_file_without_names_of_columns_needs_its_unit(self, tmp_path: Path) -> None:
        parts = components(tmp_path, "s.bbp", networks.bbp(PARTS, []), units="cm/s2")
        assert [part.direction for part in parts] == ["y", "x", "z"]

    def test_unevenly_spaced_film_is_refused(self, tmp_path: Path) -> None:
        assert "2 CORRECTED" in refusal(tmp_path, "a.smc", networks.smc(PARTS["x"], title="1 UNCORRECTED"))
        content = networks.csmip(PARTS, DEGREES_AND_UP, volume=1).replace("ACCELEROGRAM POINTS", "")
        assert "CSMIP" in refusal(tmp_path, "a.V1", content)

    def test_spectra_are_refused(self, tmp_path: Path) -> None:
        content = "RESPONSE AND FOURIER AMPLITUDE SPECTRA\n" + networks.csmip(PARTS, DEGREES_AND_UP, volume=2)
        assert "spectra" in refusal(tmp_path, "a.V3", content)

    def test_orientations_that_contradict_each_other_are_refused(self, tmp_path: Path) -> None:
        vertical = networks.cosmos(PARTS, {"x": ("340 deg", 400, "HNE")})
        other = networks.cosmos(PARTS, {"x": ("340 deg", 90, "HNE")})
        assert "340 deg" in refusal(tmp_path, "a.V2c", vertical)
        assert "340 deg" in refusal(tmp_path, "a.V2c", other)

    def test_other_formats_are_refused_by_name(self, tmp_path: Path) -> None:
        for name, content, network in (
            ("a.v1", "UNCORRECTED ACCELEROGRAM DATA\nX\nUNIVERSIDAD DE CHILE - RENADIC\n", "RENADIC"),
            ("a.V1", "* VOL1DS FILE:  5520/01\n", "BHRC"),
            ("a.v2", "CORRECTED ACCELEROGRAM  IIA001  40.1.0 COMP S00E\nDATA OF VOLUME I\n", "Volume I"),
            ("a.044", " SAMPLES/SEC=200 FILTER TYPE=BUTTERWORTH DATA TYPE=AC\n", "USGS"),
            ("a.VT2", "PEER\nX\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 2, DT= .01\n 1 2\n", "VT2"),
            ("a.vol", "invented\n", "GeoNet"),
            ("a.zip", b"PK\x03\x04\0\0", "packed or binary"),
            ("a.gse", "WID2 2001/02/03\n", "GSE2"),
            ("a.html", "<!DOCTYPE html>\n", "web page"),
        ):
            message = refusal(tmp_path, name, content)
            assert network in message
            assert ": " in message  # what to do

    # the last third of the lines is lost, or a cell in the middle is damaged
    @pytest.mark.parametrize("name", [name for name in ALL if name not in BINARY])
    @pytest.mark.parametrize("damage", ["cut", "letters", "infinite"])
    def test_a_damaged_file_is_refused_by_its_format(self, tmp_path: Path, name: str, damage: str) -> None:
        content = FILES[name]
        lines = (content if isinstance(content, str) else content.decode("shift-jis")).splitlines()
        # in the middle of the samples of the last component
        titles = [
            at
            for at, line in enumerate(lines)
            if re.search("points|pts|component ", line[:40], re.IGNORECASE)
        ]
        accelerations = [at for at in titles if "accel" in lines[at].lower() or "Component" in lines[at]]
        at = accelerations[-1] + 20 if accelerations and len(accelerations) > 1 else len(lines) - 5
        if damage == "cut":
            if name.endswith(("bbp", "csv")):
                return  # the format announces no length
            lines = lines[: at if accelerations else -len(lines) * 2 // 3]
        else:
            lines[at] = ("damage" if damage == "letters" else "inf").rjust(8) + lines[at][8:]
        message = refusal(tmp_path, name, "\n".join(lines) + "\n")
        if damage != "cut":
            assert f"line {at + 1}" in message


class TestWaveforms:
    """Of SAC and miniSEED, which obspy reads."""

    def test_sac_is_oriented_by_its_header_else_by_its_channel(self, tmp_path: Path) -> None:
        for azimuth, inclination, channel, direction, stated in (
            *((90.0, 90.0, "HNE", "x", 90.0), (0.0, 90.0, "HN1", "y", 0.0), (90.0, 0.0, "HNZ", "z", None)),
            *((138.5, 90.0, "HNR", None, 138.5), (-12345.0, -12345.0, "HNN", "y", None)),
            (-12345.0, -12345.0, "HN1", None, None),
        ):
            content = networks.sac(PARTS["x"], channel=channel, azimuth=azimuth, inclination=inclination)
            (part,) = components(tmp_path, "a.sac", content)
            assert (part.direction, part.azimuth, part.unit) == (direction, stated, None)
            assert part.time_step == STEP
            np.testing.assert_allclose(part.values, PARTS["x"], rtol=SINGLE, atol=0)

    def test_sac_of_velocities_or_counts_is_refused(self, tmp_path: Path) -> None:
        assert "velocities" in refusal(tmp_path, "a.sac", networks.sac(PARTS["x"], kind=7))
        (part,) = components(tmp_path, "a.sac", networks.sac(np.round(PARTS["x"])))
        assert "whole numbers" in part.notes[0]

    def test_miniseed_of_floats_is_read(self, tmp_path: Path) -> None:
        content = networks.miniseed(PARTS["x"]) + networks.miniseed(PARTS["y"], channel="HNN")
        parts = {str(part.direction): part for part in components(tmp_path, "a.mseed", content)}
        for axis in "xy":
            np.testing.assert_allclose(parts[axis].values, PARTS[axis], rtol=SINGLE, atol=0)
            assert (parts[axis].unit, parts[axis].time_step) == (None, STEP)

    def test_miniseed_of_counts_needs_a_unit(self, tmp_path: Path) -> None:
        counts = np.round(PARTS["x"]).astype(np.int32)
        assert "remove the response" in refusal(tmp_path, "a.mseed", networks.miniseed(counts), units="m/s2")

    def test_miniseed_with_a_gap_is_refused(self, tmp_path: Path) -> None:
        due = round(COUNT * STEP * 1e4)
        whole = networks.miniseed(PARTS["x"]) + networks.miniseed(PARTS["x"], start=due)
        (part,) = components(tmp_path, "a.mseed", whole)
        assert len(part.values) == 2 * COUNT
        gap = networks.miniseed(PARTS["x"]) + networks.miniseed(PARTS["x"], start=due + 5000)
        assert "0.5 s" in refusal(tmp_path, "a.mseed", gap)

    def test_a_damaged_waveform_is_refused(self, tmp_path: Path) -> None:
        assert "SAC" in refusal(tmp_path, "a.sac", networks.sac(PARTS["x"])[:-90])
        assert "miniSEED" in refusal(tmp_path, "a.mseed", networks.miniseed(PARTS["x"])[:90])

    def test_missing_obspy_names_the_extra(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setitem(sys.modules, "obspy", None)
        for name, content in {
            "a.sac": networks.sac(PARTS["x"]),
            "a.mseed": networks.miniseed(PARTS["x"]),
        }.items():
            assert "which needs obspy: pip install obspy" in refusal(tmp_path, name, content)


def test_every_reader_has_files_that_it_alone_recognises(tmp_path: Path) -> None:
    without_file = {reader.NAME for reader in READERS}
    for name, content in FILES.items():
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        file = open_record(path)
        claims = [reader.NAME for reader in READERS if reader.recognizes(file)]
        assert len(set(claims) - {"columns"}) == 1, (name, claims)
        without_file -= {*claims}
    # test_record_at2 has files of it; others are refused by their names, above
    assert without_file == {"PEER AT2", "format that is not read"}


def test_a_folder_of_kiknet_gives_the_surface_sensor(tmp_path: Path) -> None:
    for place, code in enumerate("213546"):
        ending = ("EW1", "NS1", "UD1", "EW2", "NS2", "UD2")[place]
        scaled = COUNTS * (place + 1)
        (tmp_path / f"TSTH010102030405.{ending}").write_text(networks.knet(code, scaled))
    motion = read_record(tmp_path)
    factors = np.array([4, 5, 6]) * 3920.0 / 6182761.0 / 100.0
    np.testing.assert_allclose(motion.acceleration, COUNTS[:, None] * factors, rtol=1e-12)
    assert "borehole left aside" in str(motion.source)


def test_three_files_of_esm_are_one_record(tmp_path: Path) -> None:
    for axis, name in {"x": "HNE", "y": "HNN", "z": "HNZ"}.items():
        (tmp_path / f"XX.TST..{name}.D.ACC.ASC").write_text(networks.esm(PARTS[axis], name=name))
        (tmp_path / f"XX.TST..{name}.D.VEL.ASC").write_text(
            networks.esm(PARTS[axis], name=name, kind="VELOCITY")
        )
    motion = read_record(tmp_path)
    for place, axis in enumerate("xyz"):
        np.testing.assert_allclose(motion.acceleration[:, place], PARTS[axis] / 100.0, rtol=0, atol=1e-12)


def test_fill_values_after_the_last_sample_are_dropped(tmp_path: Path) -> None:
    filled = {axis: np.append(values[:-2], [-9999.9, -9999.9]) for axis, values in PARTS.items()}
    for part in components(tmp_path, "jma.csv", networks.jma(filled)):
        assert_read(part, PARTS[str(part.direction)][:-2], "cm/s2")
        assert "2 fill values of -9999.9" in part.notes[-1]


def test_a_step_that_contradicts_the_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "afad.txt"
    path.write_text(networks.afad(PARTS))
    with pytest.raises(ValueError, match=r"time step of 0\.01 s"):
        read_record(path, time_step=0.02)


@pytest.mark.slow
def test_a_header_with_few_samples_or_noise_is_refused(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    # tables of .bbp announce no length
    for content in (each for name, each in FILES.items() if isinstance(each, str) and "bbp" not in name):
        lines = content.splitlines()
        for kept in range(1, 22, 2):  # headers, and a line or two of samples
            for noise in (b"", random.bytes(300), bytes(random.choice(list(b"0123456789.-+ \nEe:,()"), 300))):
                head = "\n".join(lines[:kept]).encode() + b"\n"
                path = tmp_path / "noise.txt"
                path.write_bytes(head + noise)
                with pytest.raises(ValueError, match=r"noise\.txt"):
                    read_record(path, "zero")


# lengths that fill the last line and lengths that do not
SHAPES = [(16, 0.02), (37, 0.01), (80, 0.005), (121, 0.02), (240, 0.01)]


@pytest.mark.parametrize("name", ALL)
def test_any_motion_is_read_with_its_directions_and_signs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    count, step = SHAPES[list(ALL).index(name) % len(SHAPES)]
    monkeypatch.setattr(networks, "COUNT", count)
    monkeypatch.setattr(networks, "STEP", step)
    parts = any_motion(np.random.default_rng(count))
    for sign in (1.0, -1.0):
        motion = {axis: sign * values for axis, values in parts.items()}
        record = components(tmp_path, name, ALL[name](motion))
        assert {part.direction for part in record} in ({"x"}, {"x", "y", "z"})
        for part in record:
            due = motion[str(part.direction)]
            assert part.time_step == pytest.approx(step, rel=1e-7)  # of single precision
            assert len(part.values) == count
            error = PRINTED * np.abs(due).max()
            assert part.values * IN_GAL[part.unit] == pytest.approx(due, abs=error)
            assert part.notes == (("offset of the sensor not removed",) if name == "a.EW" else ())


# the largest sample may differ by 2 % from the stated peak of either sign; by a factor of 2 the file is
# damaged
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
                components(tmp_path, name, WITH_PEAKS[name](parts))
            continue
        for part in components(tmp_path, name, WITH_PEAKS[name](parts)):
            said = [match for note in part.notes if (match := NOTE_OF_A_PEAK.fullmatch(note))]
            assert len(said) == (VERDICTS[ratio] == "noted")
            due = parts[str(part.direction)]
            due = due - due.mean() if name == "a.EW" else due  # NIED states the peak without the mean
            for match in said:
                printed = (float(match[1]), float(match[2]))
                assert printed == pytest.approx((ratio * np.abs(due).max(), np.abs(due).max()), rel=1e-3)


@pytest.mark.parametrize("name", WITH_PEAKS)
def test_a_stated_peak_is_compared_in_every_network(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr(networks, "STATED", 0.45)
    with pytest.raises(ValueError, match="the file is damaged"):
        components(tmp_path, name, WITH_PEAKS[name](any_motion(np.random.default_rng(5))))


SPELLINGS = {
    "x": ("E", "EW", "E-W", "WE", "East", "East-West", "e_w"),
    "y": ("N", "NS", "N-S", "S-N", "North", "North-South"),
    "z": ("U", "UD", "U-D", "Z", "V", "Up", "Vert", "Vertical", "Up-Down"),
}
STREAMS = {f"{band}{kind}{axis}": axis for band in "HBE" for kind in "NLHG" for axis in "ENZ"}
NO_DIRECTIONS = ("H1", "HN1", "HXE", "BDZ", "L", "T", "Radial", "")


@pytest.mark.parametrize("key", ["STREAM", "COMPONENT"])
def test_esm_names_a_component_by_its_direction_or_by_a_stream(tmp_path: Path, key: str) -> None:
    """In a stream the third letter is the direction, if the second is that of a seismic instrument."""
    values = any_motion(np.random.default_rng(7))["x"]
    names: dict[str, str | None] = {name: axis for axis, words in SPELLINGS.items() for name in words}
    names |= {name: {"E": "x", "N": "y", "Z": "z"}[letter] for name, letter in STREAMS.items()}
    names |= dict.fromkeys(NO_DIRECTIONS)
    for name, direction in names.items():
        (part,) = components(tmp_path, "a.ASC", networks.esm(values, key=key, name=name))
        assert (part.direction, part.label) == (direction, name)


def test_csmnc_names_a_component_by_its_direction(tmp_path: Path) -> None:
    values = any_motion(np.random.default_rng(7))["x"]
    for axis, name in [(axis, name) for axis, words in SPELLINGS.items() for name in words]:
        (part,) = components(tmp_path, "a.dat", networks.csmnc(values, name))
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
            (part,) = components(tmp_path, file, content)
            azimuth = math.radians(part.azimuth or 0.0)
            assert 0.0 <= azimuth < 2.0 * math.pi
            assert (math.cos(azimuth), math.sin(azimuth)) == pytest.approx((north, east), abs=1e-12)
            assert part.direction == ("x" if east > 1.0 - 1e-12 else "y" if north > 1.0 - 1e-12 else None)


@pytest.mark.parametrize("columns", ["H1,H2,Up", [1, 3, 2], "time,Chan 1: H1,h2,up"])
def test_channels_named_by_the_user_take_precedence(tmp_path: Path, columns: str | list[str | int]) -> None:
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
    components(
        tmp_path, "a.sac", BINARY["a.sac"](networks.motion())
    )  # imports obspy, with its warnings left out
    import obspy

    def fail(*args: object, **options: object) -> None:
        raise RuntimeError("the header\n\tis 3 bytes\x00 too short " + 40 * "and short ")

    monkeypatch.setattr(obspy, "read", fail)
    for name, format_name in (("a.sac", "SAC"), ("a.mseed", "miniSEED")):
        with pytest.raises(ValueError, match="is damaged") as caught:
            components(tmp_path, name, BINARY[name](networks.motion()))
        words = "the header is 3 bytes too short " + 40 * "and short "
        assert str(caught.value) == f"{name} ({format_name}) is damaged: {words[:120]}"
