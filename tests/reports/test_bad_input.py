"""Bad input of the commands of many runs: exit 2, one line, nothing written.

What a class refuses is tested at the class; here stands what only a command knows.
"""

from __future__ import annotations

import pytest

from rockwobble.reports.cli.main import main

BAD = {
    "advise": {
        "--copies 5": "copies must be a whole number from 20 to 10000, got 5",
        "--engine none --time-step 1e-4": "--time-step belongs to an engine",
        "--gap 0.1 --support recess": "a gap is for a slide on flat ground, got 0.1 m with support 'recess'",
    },
    "ensemble": {
        "--synthetic 2 --p695": "got more than one",
        "quick --copies 4": "--copies does not go with a suite",
        "--synthetic 2 --peak 0": "--peak must be positive [g tan alpha], got 0",
        "--peak 2": "--peak scales many motions",
        "--synthetic 2 --record-x a.csv": "--record-x does not go with --synthetic",
        "--synthetic 2 --perturbation 0.1": "--perturbation does not go with --synthetic",
        "--engine none --support ring": "--support belongs to engines, got it with --engine none",
        "--engine mujoco --engine none": "'--engine': none stands alone, got mujoco and none",
        "--engine all": "all is for compare; name each engine here, or none",
    },
    "spectrum": {
        "--semidiagonal 1:2:9999": "--semidiagonal must be at most 2000 numbers, got 9999",
        "--intensity 3,2": "--intensity must be positive, finite and increasing, got [3.0, 2.0]",
        "--support ring": "support must be one of recess, flat, got 'ring'",
        "--rolling-resistance 0.3": "to 0.1 base radii, 0.00497519 m, got 0.3 m",
        "--diameter 1.6 --height 9 --tan-alpha 0.2": "stand in place of --tan-alpha",
        "--record-x x.csv": "both horizontal components are needed",
        "--out taken": "the output folder must be a folder",
    },
    "fragility": {
        "--units g": "--units belongs to --records",
        "--records nowhere": "the table of records nowhere cannot be read",
        "--cylinder pier=6": "--cylinder must be NAME=R,TAN_ALPHA such as pier=6,0.2, got 'pier=6'",
        "--cylinder a=6,0.2 --cylinder a=3,0.2": "--cylinder a is given twice",
        "--cylinder a=6,0.2 --diameter 3": "--diameter does not go with --cylinder",
        "--support ring": "for engines, give --engine as well",
        "--engine mujoco --support bowl": "mujoco has no support bowl",
        "--engine none --model none": "a fragility needs at least one method, got none",
        "--levels 0:2": "'--levels': must be a number, a list",
        "--synthetic 1": "--synthetic must be a whole number, at least 2, got 1",
        "--restitution soft": 'must be a number or "momentum"',
    },
    "sweep": {
        "--semidiagonal a": "'--semidiagonal': must be a number, a list such as 1,2,6 or a range",
        "--tan-alpha 1:2:1": "'--tan-alpha': must be a number",
        "--model glued": "a model of a grid must be one of recess, flat, planar, got 'glued'",
        "no-such-suite": "no-such-suite",
        "quick --units g": "--units does not go with a suite, got quick",
        "--plane 1": "plane belongs to planar motion, got models recess",
        "--chunk 0": "'--chunk': must be at least 1, got 0",
        "--record-z up.at2": "--record-z belongs to a record",
    },
    "validity": {"--workers 0": "'--workers': must be at least 1, got 0"},
}


@pytest.mark.parametrize(("command", "line"), [(name, line) for name, rows in BAD.items() for line in rows])
def test_bad_input_is_one_line_and_writes_nothing(command, line, tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").touch()
    with pytest.raises(SystemExit) as ended:
        main([command, *line.split()])
    printed = capsys.readouterr()
    assert (ended.value.code, printed.out, printed.err.count("\n")) == (2, "", 1)
    assert BAD[command][line] in printed.err
    assert [path.name for path in tmp_path.iterdir()] == ["taken"]
