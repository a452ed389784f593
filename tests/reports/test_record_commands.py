"""Commands with a record: equal statements on the input, and equal refusals."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from showing import call as exit_code

from rockwobble.models import read_record
from rockwobble.reports.pages.page import Page

GOOD = "Zeit [ms];Nord [mg];Ost [mg]\n" + "".join(
    f"{10 * at};{30 * (at % 7)},5;{-40 * (at % 5)},25\n" for at in range(60)
)
BAD = {
    "missing.csv": (None, "No such file"),
    "empty.csv": ("", "is empty"),
    "lengths.csv": (GOOD.replace("[mg]", "[mm]"), "Ost [mm]"),
    "columns.csv": (GOOD.replace("Ost", "H1"), "--record-columns"),
    "damaged.csv": (GOOD.replace("300;", "300;x"), "line 32"),
    "silent.csv": (GOOD.replace("[mg]", ""), "does not say its unit"),
    "array.npy": ("\x93NUMPY", "packed or binary"),
}
# quick ones; a study reads its record before anything else
COMMANDS = {
    "compare": ["compare", "--engine", "mujoco", "--duration", "0.3"],
    "advise": ["advise", "--engine", "mujoco"],
    "simulate": ["simulate", "--duration", "0.3"],
    "explore": ["explore"],
    "spectrum": ["spectrum", "--semidiagonal", "5:6:2", "--intensity", "2:3:2"],
    "sweep": ["sweep", "--semidiagonal", "5,6"],
    "ensemble": ["ensemble", "--engine", "none"],
    "view": ["view", "--engine", "mujoco"],
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, text in {"good.csv": GOOD, **{name: text for name, (text, _) in BAD.items()}}.items():
        if text is not None:
            Path(name).write_bytes(text.encode("latin-1" if name.endswith("npy") else "utf-8"))
    return tmp_path


@pytest.mark.parametrize(
    ("command", "name"),
    [
        *(("simulate", name) for name in BAD),
        *((command, "damaged.csv") for command in COMMANDS if command != "simulate"),
    ],
)
def test_bad_record_gives_one_line_and_no_output(
    folder: Path, capsys: pytest.CaptureFixture[str], command: str, name: str
) -> None:
    before = sorted(folder.iterdir())
    assert exit_code(*COMMANDS[command], "--record", name, "--out", "out") == 2
    written = capsys.readouterr()
    assert written.out == ""
    (line,) = written.err.splitlines()
    assert line.startswith("rockwobble: ")
    assert name in line
    assert BAD[name][1] in line
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize("name", BAD)
def test_bad_record_in_a_folder_gives_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    Path("records.csv").write_text(f"name,record\nfirst,good.csv\nsecond,{name}\n")
    for command in (["fragility", "--engine", "none"], ["ensemble", "--engine", "none"], ["explore"]):
        assert exit_code(*command, "--records", ".", "--out", "out") == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert "records.csv, line 3: " in line
        assert BAD[name][1] in line
        assert not (folder / "out").exists()


@pytest.mark.slow
@pytest.mark.usefixtures("folder")
def test_check_of_a_suite_states_its_record_sources(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.suite.toml").write_text(
        '[[runs]]\nengine = "mujoco"\nsupport = "recess"\n[[cases]]\nname = "pier"\n'
        'cylinder = { semidiagonal = 6.0, tan_alpha = 0.2 }\nmotion = { files = "good.csv" }\n'
    )
    exit_code("check", "--suite", "a.suite.toml", "--workers", "1")
    text = "".join(capsys.readouterr().out.split())
    assert "".join(str(read_record("good.csv").source).split()) in text


@pytest.mark.parametrize("command", ["compare", "simulate", "explore", "sweep"])
@pytest.mark.usefixtures("folder", "in_this_process")
def test_all_commands_describe_a_record_in_equal_words(
    capsys: pytest.CaptureFixture[str],
    no_engines: Callable[..., None],
    monkeypatch: pytest.MonkeyPatch,
    command: str,
) -> None:
    no_engines()
    monkeypatch.setattr(Page, "files", lambda *_, **__: {})  # the pages have their own test
    assert exit_code(*COMMANDS[command], "--record", "good.csv", "--out", "out") == 0
    written = capsys.readouterr()
    # a terminal breaks lines where they are full
    text = "".join((written.out + written.err).replace("│", "").split())
    assert "".join(str(read_record("good.csv").source).split()) in text
