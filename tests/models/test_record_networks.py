"""Records of the networks, each by a small file of its documented form with invented values."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import network_files as networks
import numpy as np
import pytest
from network_files import COUNT, STEP

from rockwobble.models import read_record
from rockwobble.models.records.component import Component, open_record
from rockwobble.models.records.formats import READERS, read_components
from rockwobble.models.records.reading import Reading

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


def by_direction(parts: list[Component]) -> dict[str, Component]:
    assert len({part.direction for part in parts}) == len(parts)
    return {str(part.direction): part for part in parts}


def assert_read(part: Component, values: np.ndarray, unit: str, error: float = ROUNDING) -> None:
    assert part.unit == unit
    assert part.time_step == pytest.approx(STEP, rel=1e-12)
    np.testing.assert_allclose(part.values, values, rtol=0, atol=error)


PARTS = networks.motion()
AZIMUTHS = {"y": "360 DEG", "z": "UP", "x": "90 DEG"}
COSMOS_NAMES = {"y": ("360 deg", 360, "HNN"), "z": ("Up", 400, "HNZ"), "x": ("90 deg", 90, "HNE")}
BBP_HEADERS = {
    "names": ["#    time(sec)      N-S(cm/s/s)      E-W(cm/s/s)      U-D(cm/s/s)"],
    "numbers": [
        "# Column 1: Time (s)",
        "# Column 2: North-south acceleration (cm/s/s) (+ is northward)",
        "# Column 3: East-west acceleration (cm/s/s) (+ is eastward)",
        "# Column 4: Up-down acceleration (cm/s/s) (+ is upward)",
    ],
    "none": [],
}
# all three components in one file, in cm/s^2
WHOLE = {
    "afad.txt": networks.afad(PARTS),
    "afad_turned.txt": networks.afad(PARTS, "zxy"),
    "cwa.dat": networks.cwa(PARTS),
    "geonet.V2A": networks.geonet(PARTS, {"y": "N00E", "x": "N90E", "z": "Up"}, corrected=True),
    "geonet.V1A": networks.geonet(PARTS, {"x": "S90E", "y": "N00W", "z": "Up"}, corrected=False),
    "csmip.V2": networks.csmip(PARTS, AZIMUTHS, volume=2),
    "csmip_small.V2": networks.csmip(PARTS, AZIMUTHS, volume=2, capitals=False),
    "cosmos.V2c": networks.cosmos(PARTS, COSMOS_NAMES),
    "station.bbp": networks.bbp(PARTS, BBP_HEADERS["names"]),
    "station2.bbp": networks.bbp(PARTS, BBP_HEADERS["numbers"]),
    "station.acc.bbp": networks.bbp(PARTS, BBP_HEADERS["none"]),
    "jma.csv": networks.jma(PARTS),
}


COUNTS = np.round(1e4 * PARTS["x"]).astype(np.int64) - 12000
ALL = WHOLE | {
    "knet.EW": networks.knet("E-W", np.tile(COUNTS, 3)),
    "esm.ASC": networks.esm(PARTS["x"]),
    "smc.smc": networks.smc(PARTS["x"]),
    "csmip.V1": networks.csmip(PARTS, AZIMUTHS, volume=1),
    "csmnc.dat": networks.csmnc(PARTS["x"]),
}


def test_knet_is_counts_times_the_scale_factor_with_the_offset(tmp_path: Path) -> None:
    codes = {"E-W": "x", "N-S": "y", "U-D": "z", "1": "y", "2": "x", "3": "z", "4": "y", "5": "x", "6": "z"}
    for code, direction in codes.items():
        (part,) = components(tmp_path, f"TST0010102030405.{code}", networks.knet(code, COUNTS))
        assert part.direction == direction
        assert ("borehole" in part.label, "surface" in part.label) == (code in "123", code in "456")
        assert_read(part, COUNTS * 3920.0 / 6182761.0, "cm/s2")
        assert part.notes == ("offset of the sensor not removed",)


@pytest.mark.parametrize(
    ("inclination", "azimuth", "direction", "stated", "sign"),
    [
        (90, 90, "x", 90.0, 1),
        (90, 360, "y", 0.0, 1),
        (90, 133, None, 133.0, 1),
        (0, 0, "z", None, 1),
        (180, 0, "z", None, -1),
    ],
)
def test_corrected_smc(
    tmp_path: Path, inclination: int, azimuth: int, direction: str | None, stated: float | None, sign: int
) -> None:
    content = networks.smc(PARTS["x"], inclination=inclination, azimuth=azimuth)
    (part,) = components(tmp_path, "a.smc", content.replace("TST0A", "TST0\0"))
    assert (part.direction, part.azimuth) == (direction, stated)
    assert_read(part, sign * PARTS["x"], "cm/s2", SMC_DIGITS * np.abs(PARTS["x"]).max())


def test_an_azimuth_in_degrees_is_kept_and_stated(tmp_path: Path) -> None:
    (part,) = components(tmp_path, "a.V2", networks.csmip(PARTS, {"x": "106 DEG"}, volume=2))
    assert (part.direction, part.azimuth) == (None, 106.0)
    (part,) = components(tmp_path, "a.V2c", networks.cosmos(PARTS, {"x": ("106 DEG", 106, "HN1")}))
    assert (part.direction, part.azimuth) == (None, 106.0)
    assert_read(part, PARTS["x"], "cm/s2")


def test_horizontal_sensors_without_azimuth_have_no_direction(tmp_path: Path) -> None:
    parts = components(tmp_path, "a.V2", networks.csmip(PARTS, {"x": "H1", "z": "UP", "y": "H2"}, volume=2))
    assert [part.direction for part in parts] == [None, "z", None]


def test_down_is_turned_up_and_said(tmp_path: Path) -> None:
    for name, content in {
        "a.V2": networks.csmip(PARTS, {"z": "DOWN"}, volume=2),
        "a.V2A": networks.geonet(PARTS, {"z": "Down"}, corrected=True),
        "a.V2c": networks.cosmos(PARTS, {"z": ("Down", 401, "HNZ")}),
    }.items():
        (part,) = components(tmp_path, name, content)
        assert part.direction == "z"
        assert "down" in part.notes[0]
        assert_read(part, -PARTS["z"], "cm/s2")


def test_channels_of_cosmos_by_codes_of_unit_and_stream(tmp_path: Path) -> None:
    for unit, name, factor in (
        *(("g.     (02)", "g", 1.0), ("gal(10)", "cm/s2", 1.0), ("in/sec2(07)", "cm/s2", 2.54)),
        ("mg(11)", "g", 1e-3),
    ):
        channel = networks.cosmos(PARTS, {"x": COSMOS_NAMES["x"]}, unit=unit)
        (part,) = components(tmp_path, "a.V2c", channel)
        assert_read(part, factor * PARTS["x"], name)
    # as the files of CESMD for Alaska have it: code 0, which is none, and "Other"
    (part,) = components(tmp_path, "a.V2c", networks.cosmos(PARTS, {"z": ("Other", 0, "BNZ")}))
    assert (part.direction, part.azimuth) == ("z", None)


class TestRefusals:
    def test_counts(self, tmp_path: Path) -> None:
        counts = networks.cosmos(PARTS, COSMOS_NAMES, unit="counts(50)", kind="raw accel.")
        assert "V1 or V2" in refusal(tmp_path, "a.V0c", counts)

    def test_files_of_velocities_or_displacements_are_refused(self, tmp_path: Path) -> None:
        velocity = ["#    time(sec)      N-S(cm/s)      E-W(cm/s)      U-D(cm/s)"]
        assert "velocities" in refusal(tmp_path, "s.vel.bbp", networks.bbp(PARTS, velocity))
        assert "velocities" in refusal(tmp_path, "s.acc.bbp", networks.bbp(PARTS, velocity))
        assert "velocities" in refusal(tmp_path, "s.bbp", networks.bbp(PARTS, []))
        assert "velocity" in refusal(tmp_path, "TST.VEL.ASC", networks.esm(PARTS["x"], kind="VELOCITY"))
        velocity_of = networks.cosmos(PARTS, COSMOS_NAMES, unit="cm/sec(05)", kind="velocity")
        assert "no samples of acceleration" in refusal(tmp_path, "a.vel.V2c", velocity_of)
        assert "4 DISPLACEMENT" in refusal(
            tmp_path, "a.smc", networks.smc(PARTS["x"], title="4 DISPLACEMENT")
        )

    def test_a_file_without_names_of_columns_needs_its_unit(self, tmp_path: Path) -> None:
        parts = components(tmp_path, "s.bbp", networks.bbp(PARTS, []), units="cm/s2")
        assert [part.direction for part in parts] == ["y", "x", "z"]

    def test_uneven_film(self, tmp_path: Path) -> None:
        assert "2 CORRECTED" in refusal(tmp_path, "a.smc", networks.smc(PARTS["x"], title="1 UNCORRECTED"))
        content = networks.csmip(PARTS, AZIMUTHS, volume=1).replace("ACCELEROGRAM POINTS", "")
        assert "CSMIP" in refusal(tmp_path, "a.V1", content)

    def test_spectra(self, tmp_path: Path) -> None:
        content = "RESPONSE AND FOURIER AMPLITUDE SPECTRA\n" + networks.csmip(PARTS, AZIMUTHS, volume=2)
        assert "spectra" in refusal(tmp_path, "a.V3", content)

    def test_orientations_that_contradict_each_other(self, tmp_path: Path) -> None:
        vertical = networks.cosmos(PARTS, {"x": ("340 deg", 400, "HNE")})
        other = networks.cosmos(PARTS, {"x": ("340 deg", 90, "HNE")})
        assert "340 deg" in refusal(tmp_path, "a.V2c", vertical)
        assert "340 deg" in refusal(tmp_path, "a.V2c", other)

    def test_others_are_refused_by_their_names(self, tmp_path: Path) -> None:
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
    @pytest.mark.parametrize("name", ALL)
    @pytest.mark.parametrize("damage", ["cut", "letters", "infinite"])
    def test_damage_is_refused_by_the_format(self, tmp_path: Path, name: str, damage: str) -> None:
        content = ALL[name]
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
                return  # they do not announce their length
            lines = lines[: at if accelerations else -len(lines) * 2 // 3]
        else:
            lines[at] = ("damage" if damage == "letters" else "inf").rjust(8) + lines[at][8:]
        message = refusal(tmp_path, name, "\n".join(lines) + "\n")
        if damage != "cut":
            assert f"line {at + 1}" in message


class TestWaveforms:
    """Of SAC and miniSEED, which obspy reads."""

    @pytest.mark.parametrize(
        ("azimuth", "inclination", "channel", "direction", "stated"),
        [
            (90.0, 90.0, "HNE", "x", 90.0),
            (0.0, 90.0, "HN1", "y", 0.0),
            (90.0, 0.0, "HNZ", "z", None),
            (138.5, 90.0, "HNR", None, 138.5),
            (-12345.0, -12345.0, "HNN", "y", None),
            (-12345.0, -12345.0, "HN1", None, None),
        ],
    )
    def test_sac(
        self,
        tmp_path: Path,
        azimuth: float,
        inclination: float,
        channel: str,
        direction: str | None,
        stated: float | None,
    ) -> None:
        content = networks.sac(PARTS["x"], channel=channel, azimuth=azimuth, inclination=inclination)
        (part,) = components(tmp_path, "a.sac", content)
        assert (part.direction, part.azimuth, part.unit) == (direction, stated, None)
        assert part.time_step == STEP
        np.testing.assert_allclose(part.values, PARTS["x"], rtol=SINGLE, atol=0)

    def test_sac_of_velocities_or_counts(self, tmp_path: Path) -> None:
        assert "velocities" in refusal(tmp_path, "a.sac", networks.sac(PARTS["x"], kind=7))
        (part,) = components(tmp_path, "a.sac", networks.sac(np.round(PARTS["x"])))
        assert "whole numbers" in part.notes[0]

    def test_miniseed_of_floats(self, tmp_path: Path) -> None:
        content = networks.miniseed(PARTS["x"]) + networks.miniseed(PARTS["y"], channel="HNN")
        parts = by_direction(components(tmp_path, "a.mseed", content))
        for axis in "xy":
            np.testing.assert_allclose(parts[axis].values, PARTS[axis], rtol=SINGLE, atol=0)
            assert (parts[axis].unit, parts[axis].time_step) == (None, STEP)

    def test_miniseed_of_counts(self, tmp_path: Path) -> None:
        counts = np.round(PARTS["x"]).astype(np.int32)
        assert "remove the response" in refusal(tmp_path, "a.mseed", networks.miniseed(counts), units="m/s2")

    def test_miniseed_with_a_gap(self, tmp_path: Path) -> None:
        due = round(COUNT * STEP * 1e4)
        whole = networks.miniseed(PARTS["x"]) + networks.miniseed(PARTS["x"], start=due)
        (part,) = components(tmp_path, "a.mseed", whole)
        assert len(part.values) == 2 * COUNT
        gap = networks.miniseed(PARTS["x"]) + networks.miniseed(PARTS["x"], start=due + 5000)
        assert "0.5 s" in refusal(tmp_path, "a.mseed", gap)

    def test_damage(self, tmp_path: Path) -> None:
        assert "SAC" in refusal(tmp_path, "a.sac", networks.sac(PARTS["x"])[:-90])
        assert "miniSEED" in refusal(tmp_path, "a.mseed", networks.miniseed(PARTS["x"])[:90])

    def test_without_obspy_the_extra_is_named(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setitem(sys.modules, "obspy", None)
        for name, content in {
            "a.sac": networks.sac(PARTS["x"]),
            "a.mseed": networks.miniseed(PARTS["x"]),
        }.items():
            assert "which needs obspy: pip install obspy" in refusal(tmp_path, name, content)


def test_every_reader_recognises_its_own_files_alone(tmp_path: Path) -> None:
    binary = {"a.sac": networks.sac(PARTS["x"]), "a.mseed": networks.miniseed(PARTS["x"])}
    for name, content in (ALL | binary).items():
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        file = open_record(path)
        claims = [reader.NAME for reader in READERS if reader.recognizes(file)]
        assert len(set(claims) - {"columns"}) == 1, (name, claims)


def test_a_folder_of_kiknet_is_its_sensor_at_the_surface(tmp_path: Path) -> None:
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


def test_a_step_that_contradicts_the_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "afad.txt"
    path.write_text(WHOLE["afad.txt"])  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"time step of 0\.01 s"):
        read_record(path, time_step=0.02)


@pytest.mark.slow
def test_a_header_with_nothing_or_noise_behind_it_is_refused(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    # tables of .bbp announce no length
    for content in (each for name, each in ALL.items() if isinstance(each, str) and "bbp" not in name):
        lines = content.splitlines()
        for kept in range(1, 22, 2):  # headers, and a line or two of samples
            for noise in (b"", random.bytes(300), bytes(random.choice(list(b"0123456789.-+ \nEe:,()"), 300))):
                head = "\n".join(lines[:kept]).encode() + b"\n"
                path = tmp_path / "noise.txt"
                path.write_bytes(head + noise)
                with pytest.raises(ValueError, match=r"noise\.txt"):
                    read_record(path, "zero")
