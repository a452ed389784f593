"""Bad input of every command: exit 2, one line, nothing written, before anything runs.

What a class or a reader refuses is tested there; here stands what only a command knows.
"""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
from typer.main import get_command

from rockwobble.compare.runs import execution
from rockwobble.multibody import available_engines, engine_names
from rockwobble.reports.cli.main import app, main
from rockwobble.studies import study

COMMANDS = get_command(app).commands  # type: ignore[attr-defined]
STEEL = "--tendon-force 4e5 --tendon-rigidity 3e7 --tendon-length 10 --mass 45"
RELEASE = "--release-tilt-deg 5 --duration 0.2"
SUITE = """
[[runs]]
engine = "mujoco"
[[cases]]
name = "release"
cylinder = { semidiagonal = 6, tan_alpha = [0.1, 0.2] }
release = { tilt_over_alpha = 0.5 }
duration = 2
"""
FILES = {
    "good.csv": "time [s], acceleration [g]\n0.00, 0.0\n0.01, 0.1\n0.02, 0.0\n",
    "nan.csv": "time [s], acceleration [g]\n0.00, 0.0\n0.01, nan\n0.02, 0.0\n",
    "table.csv": "time,tilt\n0,0.1\n1,0.1\n",
    "mine.suite.toml": SUITE,
    "taken": "",
}
# options of all commands that choose their methods
METHODS = {
    "--time-step fast": 'must be a number [s], "auto" or "extrapolated", got \'fast\'',
    "--time-step 0.5": "time_step must be at most 0.001 s for contact at this size",
    "--set ring_facets": "--set must be NAME=VALUE, got 'ring_facets'",
    "--set cone=a --set cone=b": "--set cone is given twice",
    "--set ring_facets=64": "no run has a setting 'ring_facets'; there are contact_time_constant,",
    "--set impedance=2": "impedance must be above 0 and at most 0.9999, got 2",
    "--set step_tolerance=1e-4": "no run has a setting 'step_tolerance'; there are ",  # of "auto" alone
}
BAD = {
    "simulate": {
        "--record-x nan.csv --record-y good.csv": "nan.csv, line 3: expected 2 finite numbers",
        "--record-x good.csv": "got --record-x without --record-y: for planar",
        "--record good.csv": "zero for the other (planar motion)",
        "--record-z good.csv": "--record-z needs --record or --record-x or --record-y as well",
        "--units g": "--units needs --record",
        "--scale 0": "--scale must be above 0, got 0",
        "--rolling-rate 1": "--rolling-rate needs --release-tilt-deg as well",
        "--release-tilt-deg 95": "--release-tilt-deg must be at least 0 and below 90",
        "--engine bullet": f"engine must be one of {', '.join(engine_names())}, got 'bullet'",
        "--support glued": "support must be one of",
        "--support ring": "support must be one of recess, flat",
        "--engine exudyn --support flat": "exudyn cannot uplift a cylinder that stands",
        "--out taken": "the output folder must be a folder, got taken",
        "--out /proc/1/none": "the output folder /proc/1/none cannot be written",
        "--plane 90": "--plane must be from -6.28319 to 6.28319, got 90",
        "--engine mujoco --plane 0": "--plane belongs to the reduced models",
        "--restitution 0.9": "restitution",
        "--restitution half": "must be a number or \"momentum\", got 'half'",
        f"--plane 0 {RELEASE} --rolling-rate 1": "planar motion has no rolling_rate",
        "--rest-tilt 0 --set rest_tilt=1e-9": "rest_tilt is given twice",
        "--diameter 2": "--diameter needs --height as well",
        "--diameter 2 --height 9 --tan-alpha 0.2": "--diameter stands in place of --tan-alpha, got both",
        "--tendon-force 1e5": "--tendon-force needs --tendon-rigidity as well",
        f"{STEEL} --tendon-yield 2": "--tendon-force stands in place of --tendon-yield, got both",
        "--tendon-yield 1": "tendon_yield needs a prestress or a stiffness of the tendon, got none",
        "--tendon-prestress 2 --tendon-yield 1": "yield_force must be above the prestress, 2 weights, got 1",
        "--support flat --tendon-prestress 1": "",
    }
    | {f"--engine mujoco --support recess {RELEASE} {line}": words for line, words in METHODS.items()},
    "compare": {
        "--out taken": "the output folder must be a folder, got taken",
        "mine": "cannot read the suite mine: No such file or directory; the suites that ship",
        "mine.suite.toml --scale 2": "--scale does not go with a suite, got mine.suite.toml: the file states",
        "mine.suite.toml --engine none": "--engine none is for a case given by options, and mine.suite.toml",
        "mine.suite.toml --trajectory table.csv": "--trajectory belongs to one case, got a suite of 2",
        "--trajectory none.csv": "cannot read the trajectory none.csv",
        f"{RELEASE} --trajectory table.csv": "table.csv does not say the unit of tilt",
        "--trajectory-offset 1": "--trajectory-offset needs --trajectory as well",
        "--engine all --engine mujoco": "all stands alone, got all and mujoco",
        "--engine none": "--engine none leaves nothing to compare, give a --trajectory as well",
    },
    "view": {"--case x": "--case chooses from a folder"},
    "advise": {
        "--engine none --time-step 1e-4": "--time-step belongs to an engine",
        "--gap 0.1 --support recess": "a gap is for a slide on flat ground, got 0.1 m with support 'recess'",
        "--tendon-stiffness 1 --support ring": "an advice on a body with a tendon is for",
    },
    "ensemble": {
        "--synthetic 2 --p695": "--p695 stands in place of --synthetic, got both",
        "quick --copies 4": "--copies does not go with a suite",
        "--synthetic 2 --peak 0": "--peak must be positive [g tan alpha], got 0",
        "--peak 2": "--peak scales many motions",
        "--synthetic 2 --record-x a.csv": "--record-x does not go with --synthetic",
        "--synthetic 2 --perturbation 0.1": "--perturbation does not go with --synthetic",
        "--engine all": "all is for compare; name each engine here, or none",
    },
    "spectrum": {
        "--semidiagonal 1:2:9999": "--semidiagonal must be at most 2000 numbers, got 9999",
        "--intensity 3,2": "--intensity must be positive, finite and increasing, got [3.0, 2.0]",
        STEEL: "--tendon-force states the tendon of one body, got 100: give",
    },
    "fragility": {
        "--synthetic 2 --target 1e-4": "--target needs --hazard as well",
        "--synthetic 2 --risk-limit uplift": "--risk-limit needs --hazard as well",
        "--units g": "--units needs --records as well",
        "--records nowhere": "the table of records nowhere cannot be read",
        "--cylinder pier=6": "--cylinder must be NAME=R,TAN_ALPHA such as pier=6,0.2, got 'pier=6'",
        "--cylinder a=6,0.2 --cylinder a=3,0.2": "--cylinder a is given twice",
        "--cylinder a=6,0.2 --diameter 3": "--diameter does not go with --cylinder",
        "--support ring": "for engines, give --engine as well",
        "--engine mujoco --support bowl": "mujoco has no support bowl",
        "--engine none --model none": "a fragility needs at least one method, got none",
        "--levels 1,2 --scale 1": "got both",
        f"--cylinder low=4,0.2 --cylinder high=8,0.2 {STEEL}": "states the tendon of one body, got 2: give",
    },
    "sweep": {
        "--semidiagonal a": "'--semidiagonal': must be a number, a list such as 1,2,6 or a range",
        "--model glued": "a model of a grid must be one of recess, flat, planar, got 'glued'",
        "--plane 1": "plane belongs to planar motion, got models recess",
        "--chunk 0": "'--chunk': Input should be greater than or equal to 1, got '0'",
        "--record-z up.at2": "--record-z needs --record",
        f"--semidiagonal 6 --tan-alpha 0.1,0.2 {STEEL}": "states the tendon of one body, got 2: give",
        f"--semidiagonal 6 {STEEL} --tendon-prestress 0": "--tendon-prestress states a tendon in weights",
    },
    "explore": {
        "--support ring": "--support must be one of recess, flat, got 'ring'",
        "--plane 0 --support flat": "--plane holds the motion on any support, got --support",
        "--tendon-prestress 1 --support flat": "the models have no tendon on --support flat",
        "--release-tilt-deg 3 --record-x good.csv --record-y good.csv": "takes the place of a record here",
        "--records . --record good.csv": "--records names all ground motions, got --record",
        "--out none/explore.html": "--out must be a file in a folder that exists, got none",
        "--out good.csv": "--out good.csv holds something else than what this command makes with",
    },
    "check": {
        "--only equation": "--only must be one of equations, exact, conserved, ",
        "--reason because": "--reason belongs to --update-baseline",
        "--model nothing": "module:function",
        "--model a:b --suite canon": "--model stands in place of --suite, got both",
        "--trajectory a.csv": "--trajectory needs a --suite with one case, got ",
        "--time-step 1e-4": "--time-step needs --engine as well",
        "--update-baseline --only exact": "--update-baseline goes with no subject and not with --only",
        "--json no/such/a.json --overwrite": "--json must be a file in a folder that exists, got no/such",
    },
    "certify": {
        "--time-step 1e-4": "--time-step needs --engine as well",
        "--only conserved --only baseline": "got 'baseline'",  # of which nothing is claimed
        "--engine exudyn": "recess",  # in which the fingerprint runs
        "--out no/such/folder/certificate.json": "must be a file in a folder that exists",
    },
    "verify": {
        "nowhere.json": "nowhere.json",
        "good.csv": "good.csv is not a certificate (JSON, written by rockwobble certify)",
    },
    "show": {".": "", "nowhere": "nowhere", "good.csv": "good.csv"},
    "report": {".": "", "nowhere": "nowhere", "good.csv": "good.csv is not a folder of results"},
    "validity": {"--workers 0": "'--workers': Input should be greater than or equal to 1"},
}


@pytest.fixture
def refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    """The one line printed by a command that must refuse its input."""
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text)
    for module in (execution, study):
        monkeypatch.setattr(module, "run_tasks", lambda *_, **__: pytest.fail("it ran"))

    def line(*arguments: str) -> str:
        with pytest.raises(SystemExit) as ended:
            main(list(arguments))
        printed = capsys.readouterr()
        assert (ended.value.code, printed.out) == (2, "")
        assert printed.err.startswith("rockwobble: ")
        assert printed.err.count("\n") == 1
        assert {path.name: path.read_text() for path in tmp_path.iterdir()} == FILES
        return printed.err

    return line


@pytest.mark.parametrize(("command", "line"), [(name, line) for name, rows in BAD.items() for line in rows])
def test_bad_input_is_one_line_and_writes_nothing(refused, command: str, line: str) -> None:
    if "exudyn" in line and "exudyn" not in available_engines():
        pytest.skip("exudyn is not installed")
    assert BAD[command][line] in refused(command, *shlex.split(line))


def flags_of(command: str, *annotations: type) -> list[str]:
    """Options with a value of one of these types."""
    options = [option for option in COMMANDS[command].params if option.opts[0].startswith("--")]
    return [each.opts[0] for each in options if each.type_descriptor.annotation in annotations]


@pytest.mark.parametrize("command", COMMANDS)
def test_numeric_options_refuse_values_that_are_not_numbers(refused, command: str) -> None:
    numbers = [*((flag, "2.5x") for flag in flags_of(command, float)),
               *((flag, "2.5") for flag in flags_of(command, int))]  # fmt: skip
    for flag, text in numbers:
        said = refused(command, *(["any"] if command == "verify" else []), flag, text)
        assert f"'{flag}'" in said
        assert said.endswith(f", got {text!r}\n")
