"""Small files of the formats of networks with invented values, by the documentation of each format."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

COUNT, STEP = 203, 0.01  # not a multiple of a line of 8 or 10 numbers
STATED = 1.0  # what headers state as a peak, over the peak of the samples


def motion(factor: float = 1.0) -> dict[str, NDArray[np.float64]]:
    """Return invented accelerations of three directions, rounded to what every format can print."""
    time = STEP * np.arange(COUNT)
    shape = np.exp(-(((time - 1.0) / 0.4) ** 2))
    return {
        "x": np.round(factor * 91.0 * shape * np.sin(19.0 * time), 2),
        "y": np.round(factor * 62.0 * shape * np.cos(23.0 * time), 2),
        "z": np.round(factor * 33.0 * shape * np.sin(31.0 * time), 2),
    }


def lines_of(values: Sequence[float] | NDArray[np.float64], columns: int, form: str) -> list[str]:
    """Return numbers printed in fixed columns."""
    cells = [format(value, form) for value in values]
    return ["".join(cells[at : at + columns]) for at in range(0, len(cells), columns)]


def extremes(values: NDArray[np.float64]) -> tuple[float, float]:
    """Return the largest and the smallest value, as a header states them."""
    return STATED * float(values.max()), STATED * float(values.min())


def peak(values: NDArray[np.float64]) -> float:
    """Return the value that is largest in size, with its sign, as a header states it."""
    return max(extremes(values), key=abs)


def knet(code: str, counts: NDArray[np.int64], *, scale: str = "3920(gal)/6182761", rate: int = 100) -> str:
    numerator, denominator = scale.split("(gal)/")
    gal = counts * float(numerator) / float(denominator)
    header = {
        "Origin Time": "2001/02/03 04:05:06",
        "Lat.": "35.0",
        "Long.": "135.0",
        "Depth. (km)": "10",
        "Mag.": "6.0",
        "Station Code": "TST001",
        "Station Lat.": "35.1",
        "Station Long.": "135.1",
        "Station Height(m)": "10",
        "Record Time": "2001/02/03 04:05:16",
        "Sampling Freq(Hz)": f"{rate}Hz",
        "Duration Time(s)": f"{len(counts) / rate:.0f}",
        "Dir.": code,
        "Scale Factor": scale,
        "Max. Acc. (gal)": f"{abs(peak(gal - gal.mean())):.3f}",
        "Last Correction": "2001/02/03 04:05:16",
        "Memo.": "",
    }
    lines = [f"{key:<18}{value}" for key, value in header.items()]
    cells = [f"{count:8d} " for count in counts]
    return "\n".join([*lines, *("".join(cells[at : at + 8]) for at in range(0, len(cells), 8))]) + "\n"


def esm(
    values: NDArray[np.float64], *, key: str = "STREAM", name: str = "HNE", kind: str = "ACCELERATION"
) -> str:
    header = [
        "EVENT_NAME: INVENTED",
        "EVENT_TIME_HHMMSS: 04:05:06.75",
        "STATION_CODE: TST",
        f"SAMPLING_INTERVAL_S: {STEP:.6f}",
        f"NDATA: {len(values)}",
        f"{key}: {name}",
        "UNITS: cm/s^2",
        f"PGA_CM/S^2: {abs(peak(values)):.6f}",
        "HEADER_FORMAT: DYNA 1.2",
        f"DATA_TYPE: {kind}",
        "USER5: ",
    ]
    return "\n".join([*header, *(f"{value:.6f}" for value in values)]) + "\n"


def afad(parts: dict[str, NDArray[np.float64]], order: str = "yxz") -> str:
    names = {"x": "E-W", "y": "N-S", "z": "U-D"}
    header = [
        "STRONG GROUND MOTION RECORDS OF TURKIYE",
        "PLACE                   : INVENTED",
        f"NUMBER OF DATA          : {COUNT}",
        f"SAMPLING INTERVAL (sec) : {STEP}",
        "RAW PGA VALUES (gal)    : "
        + " ".join(f"({names[axis]}) {abs(peak(parts[axis])):.6f}" for axis in order),
        "".join(f"{names[axis]:>13}" for axis in order),
    ]
    rows = zip(*(parts[axis] for axis in order), strict=True)
    return "\r\n".join([*header, *("".join(f"{cell:13.6f}" for cell in row) for row in rows)]) + "\r\n"


def cwa(parts: dict[str, NDArray[np.float64]], *, formats: bool = True) -> str:
    """`formats`: whether the header states them; without, numbers fill their columns."""
    names = {"z": "U", "y": "N", "x": "E"}
    header = [
        "#Earthquake Information",
        "",
        "#StationCode: TST",
        f"#RecordLength(sec): {STEP * COUNT:.0f}",
        f"#SampleRate(Hz): {1.0 / STEP:g}",
        "#AmplitudeUnit:  gal. DCoffset(corr)",
        *(
            "#AmplitudeMAX. {}: {:8.3f}~ {:8.3f}".format(names[axis], *extremes(parts[axis]))
            for axis in "zyx"
        ),
        "#DataSequence: Time U(+); N(+); E(+)",
        *(["#Data: 4F10.3 "] if formats else []),
    ]
    digits = 3 if formats else 6
    rows = zip(STEP * np.arange(COUNT), parts["z"], parts["y"], parts["x"], strict=True)
    return "\r\n".join([*header, *("".join(f"{cell:10.{digits}f}" for cell in row) for row in rows)]) + "\r\n"


def geonet(parts: dict[str, NDArray[np.float64]], names: dict[str, str], *, corrected: bool) -> str:
    lines: list[str] = []
    for axis, name in names.items():
        values = 10.0 * parts[axis]  # mm/s^2
        header = [
            f"{'Corrected' if corrected else 'Uncorrected'} accelerogram 20010203_040506_TSTS_20 GNS Science",
            "Site TSTS      40 00 00S  176 00 00E     Basalt file:  invented",
            "Invented Council",
            "Instrument Basalt_0001",
            "Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700",
            "Accelerogram invented                 Processed 2001 February 04",
            "6 km south of nowhere",
            "2001 February 03         04:05:06 UT",
            "Epicentre  40 00 00S 176 00 00E  Bearing S15W  Dist   13km  Depth    9km M  6.00",
            f"Number of points  {COUNT}    Duration {STEP * (COUNT - 1):.2f} s",
            f"Instrument corrected data at {STEP:.3f} sec intervals"
            if corrected
            else f"Raw readings in units of 1.00 mm/s/s  at intervals of {STEP:.3f} s",
            "Data is unfiltered",
            f"Component {name}  Accelerometer Axis",
            f"Acceleration:  peak {peak(values):9.1f} mm/s/s at   1.00 s     rms   1.0 mm/s/s",
            "Velocity record unevaluated",
            "Displacement record unevaluated",
        ]
        blocks = lines_of(np.zeros(100), 10, "8.1f") + lines_of(values, 10, "8.1f")
        if corrected:
            blocks += lines_of(np.full(COUNT, 7.0), 10, "8.2f") + lines_of(np.full(COUNT, 9.0), 10, "8.3f")
        lines += header + blocks
    return "\n".join(lines) + "\n"


def csmip(
    parts: dict[str, NDArray[np.float64]],
    names: dict[str, str],
    *,
    volume: int,
    capitals: bool = True,
    formats: bool = True,
) -> str:
    """`formats`: whether the headers of volume 1 state them."""
    lines: list[str] = []
    for number, (axis, name) in enumerate(names.items(), start=1):
        values = parts[axis]
        title = [
            "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 02/03/01, CGS",
            "RECORD OF INVENTED EARTHQUAKE",
            "(ORIGIN: TO BE DETERMINED)",
            "00001-S0001-01034.01               TRIGGER TIME: 02/03/01, 04:05:06.0 UTC",
            "STATION NO. 00001   36.000N, 120.000W     SMA-1  S/N 0001",
            "INVENTED",
            f"CHAN  {number}: {name}",
        ]
        headers = lines_of([0] * 100, 16, "5d")
        end = f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------"
        if volume == 1:
            in_g = values / 980.665
            lines += [
                *title,
                f"NO. OF POINTS = {COUNT}  RECORD LENGTH = 2.0 SEC",
                f"UNITS OF UNCOR DATA ARE SEC AND G.         MAX  = {peak(in_g):7.3f} G, AT   1.000 SEC.",
                *headers,
                *lines_of(np.zeros(50), 8, "10.3f"),
                f" {COUNT} ACCELEROGRAM POINTS AT {1.0 / STEP:.0f} PTS/SEC IN UNITS OF G."
                + "   FORMAT: (8F9.6)" * formats,
                *lines_of(in_g, 8, "9.6f"),
                end,
            ]
            continue
        lines += [
            f"CORRECTED ACCELEROGRAM   00001-S0001-01034.01       CHAN  {number}: {name}     FROM",
            *title,
            f"PEAK ACCELERATION = {peak(values):10.3f}    CM/SEC/SEC  AT   1.000   SEC.",
            *headers,
            *lines_of(np.zeros(100), 8, "10.3f"),
            f" {COUNT} POINTS OF ACCEL DATA EQUALLY SPACED AT  {STEP:.3f} SEC.  (UNITS: CM/SEC/SEC)",
            *lines_of(values, 8, "10.3f"),
            f" {COUNT} POINTS OF VELOC DATA EQUALLY SPACED AT  {STEP:.3f} SEC.  (UNITS: CM/SEC)",
            *lines_of(np.full(COUNT, 7.0), 8, "10.3f"),
            f" {COUNT} POINTS OF DISPL DATA EQUALLY SPACED AT  {STEP:.3f} SEC.  (UNITS: CM)",
            *lines_of(np.full(COUNT, 9.0), 8, "10.3f"),
            end,
        ]
    return "\n".join(lines if capitals else [line.capitalize() for line in lines]) + "\n"


def cosmos(
    parts: dict[str, NDArray[np.float64]],
    names: dict[str, tuple[str, int, str]],
    *,
    unit: str = "cm/sec2(04)",
    kind: str = "acceleration",
    formats: bool = True,
) -> str:
    """`names`: text, code of the azimuth and SCNL channel of each direction; `formats`: whether stated."""
    columns, form = (6, "13.6f") if formats else (5, "15.8E")
    lines: list[str] = []
    for number, (axis, (text, code, channel)) in enumerate(names.items(), start=1):
        values = parts[axis]
        integers, reals = [-999] * 100, [-999.0] * 100
        integers[53] = code
        reals[61], reals[62], reals[63] = 1e3 * STEP, STEP * COUNT, peak(values)
        lines += [
            f"Corrected {kind}    (Format v01.20 with 13 text lines)",
            *("invented" for _ in range(7)),
            f"Sta Chan  {number}: {text} (Rcrdr Chan  {number})",
            *("invented" for _ in range(4)),
            " 100 Integer-header values follow on  10 lines" + ", Format= (10I8)" * formats,
            *lines_of(integers, 10, "8d"),
            " 100 Real-header values follow on  17 lines" + ", Format= (6F13.6)" * formats,
            *lines_of(reals, columns, form),
            '   1 Comment line(s) follow, each starting with a "|":',
            f"|<SCNL>TST.{channel}.XX.--   <AUTH> invented",
            f"   {COUNT}  {kind} pts, approx    2 secs, units={unit}" + ",Format=(8F10.3)" * formats,
            *lines_of(values, 8, "10.3f"),
            f"End-of-data for Chan{number} {kind}",
        ]
    return "\n".join(lines) + "\n"


def smc(
    values: NDArray[np.float64], *, inclination: int = 90, azimuth: int = 90, title: str = "2 CORRECTED"
) -> str:
    integers, reals = [-32768] * 48, [1.7e38] * 50
    integers[12], integers[13], integers[15], integers[16] = inclination, azimuth, 2, len(values)
    reals[1], (reals[29], reals[31]) = 1.0 / STEP, extremes(values)

    def exponential(value: float) -> str:  # 1P8E10.4E1
        mantissa, exponent = f"{value:.4e}".split("e")
        return f"{mantissa}E{int(exponent):+d}".rjust(10)

    cells = [exponential(value) for value in values]
    return (
        "\r\n".join(
            [
                f"{title} ACCELEROGRAM",
                "*",
                "TST0A",
                *("invented" for _ in range(5)),
                *("*" for _ in range(3)),
                *lines_of(integers, 8, "10d"),
                *lines_of(reals, 5, "15.7E"),
                "|invented",
                "|",
                *("".join(cells[at : at + 8]) for at in range(0, len(cells), 8)),
            ]
        )
        + "\r\n"
    )


def bbp(parts: dict[str, NDArray[np.float64]], header: Sequence[str]) -> str:
    rows = zip(STEP * np.arange(COUNT), parts["y"], parts["x"], parts["z"], strict=True)
    return "\n".join([*header, *("\t".join(f"{cell:.6e}" for cell in row) for row in rows)]) + "\n"


def csmnc(values: NDArray[np.float64], name: str = "EW") -> str:
    header = [
        "00010203040506",
        "INVENTED EARTHQUAKE",
        "EPICENTER  31.000N 103.400E",
        "MAGNITUDE 6.0(Ms)",
        "STATION: INVENTED 31.0N 103.0E",
        "SITE CONDITION: SOIL",
        "INSTRUMENT TYPE: INVENTED",
        "OBSERVING POINT: G",
        f"COMP. {name}",
        "UNCORRECTED ACCELERATION  UNIT: CM/SEC/SEC",
        f"NO. OF POINTS: {len(values)}  EQUALLY SPACED INTERVALS OF: {STEP:.3f} SEC",
        f"PEAK VALUE: {peak(values):.3f} AT 1.00 SEC  DURATION: 2 SEC",
        "PRE-EVENT TIME: 20 SEC  RECORDER TIME: 2001.02.03 04:05:06",
        "CSMNC",
        "",
    ]
    return "\n".join([*header, *lines_of(values, 8, "10.3f")]) + "\n"


def jma(parts: dict[str, NDArray[np.float64]]) -> bytes:
    header = [
        "SITE CODE= TST\u30c6\u30b9\u30c8,37.5,137.2,16,7.6",
        " LAT.= 37.0",
        " LON.= 137.0",
        f" SAMPLING RATE= {1.0 / STEP:.0f}Hz",
        " UNIT  = gal(cm/s/s)",
        "INITIAL TIME = 2001 02 03 04 05 06",
        "NS,EW,UD",
    ]
    rows = zip(parts["y"], parts["x"], parts["z"], strict=True)
    return "\r\n".join([*header, *(",".join(f"{cell:.3f}" for cell in row) for row in rows)]).encode(
        "shift-jis"
    )


def sac(
    values: NDArray[np.float64],
    *,
    channel: str = "HNE",
    azimuth: float = 90.0,
    inclination: float = 90.0,
    kind: int = 8,
) -> bytes:
    """Write the binary form, little-endian, of version 6."""
    floats, integers = [-12345.0] * 70, [-12345] * 40
    floats[0], floats[5], floats[6] = STEP, 0.0, STEP * (len(values) - 1)
    floats[57], floats[58] = azimuth, inclination
    integers[0:6] = [2001, 34, 4, 5, 6, 0]
    integers[6], integers[9], integers[15], integers[16] = 6, len(values), 1, kind
    integers[35:40] = [
        1,
        1,
        1,
        1,
        0,
    ]  # evenly spaced, polarity, may be overwritten, distances computed, unused
    words = [b"-12345  "] * 24
    words[0] = b"TST     "
    words[1:3] = [b"-12345  ", b"        "]
    words[20] = channel.encode().ljust(8)
    words[21] = b"XX      "
    head = struct.pack("<70f40i", *floats, *integers) + b"".join(words)
    return head + np.asarray(values, dtype="<f4").tobytes()


def miniseed(
    values: NDArray[np.float64] | NDArray[np.int32], *, channel: str = "HNE", start: int = 0, rate: int = 100
) -> bytes:
    """Write one record of 2048 bytes, big-endian, of 32-bit floats or integers; `start` [0.1 ms]."""
    whole = values.dtype.kind == "i"
    # SEED manual 2.4: year, day, hour, minute, second, unused, fraction
    time = struct.pack(">HHBBBBH", 2001, 34, 4, 5, 6 + start // 10000, 0, start % 10000)
    fixed = (
        b"000001D TST    "
        + channel.encode()
        + b"XX"
        + time
        + struct.pack(">HhhBBBBiHH", len(values), rate, 1, 0, 0, 0, 1, 0, 64, 48)
    )
    blockette = struct.pack(">HHBBBB", 1000, 0, 3 if whole else 4, 1, 11, 0)
    body = values.astype(">i4" if whole else ">f4").tobytes()
    return (fixed + blockette).ljust(64, b"\0") + body.ljust(2048 - 64, b"\0")
